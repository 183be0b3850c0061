// SPDX-License-Identifier: Apache-2.0
// Streams a large bag: mcap_benchmark GB writes a bag of so many GB of messages (1280x720 depth
// images and joint states, lz4), reads it, prints rate and memory, and fails if reading is too slow
// or takes too much memory.
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <io/mcap/reader.hpp>
#include <io/mcap/writer.hpp>

namespace {

namespace mcap = penumbra::io::mcap;

constexpr int width = 1280, height = 720;
constexpr std::int64_t image_period = 33'333'333;  // nanoseconds
constexpr double most_memory = 300.0;              // MB, whatever the bag's size
constexpr double least_rate = 300.0;               // MB/s of messages

/// A wavy wall with a depth camera's noise: it compresses about as real images do.
std::vector<std::uint16_t> depth_image(int index) {
  std::mt19937 random(static_cast<unsigned>(index));
  std::vector<std::uint16_t> image;
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const double wave = 1500.0 + 300.0 * std::sin(0.01 * (u + 3 * index)) + 0.5 * v;
      const bool hole = u % 97 < 8;
      const auto noise = (u / 4 + v / 2) % 7 == 0 ? random() % 4 : 0U;
      image.push_back(hole ? std::uint16_t{0} : static_cast<std::uint16_t>(wave + noise));
    }
  return image;
}

void write_bag(const std::filesystem::path& file, double bytes) {
  std::vector<std::vector<std::uint16_t>> images;
  for (int i = 0; i < 8; ++i) images.push_back(depth_image(i));
  mcap::Writer writer(
      file, {.compression = mcap::Compression::lz4, .chunk_size = 4 << 20, .profile = "ros2"});
  const auto depth = writer.add_channel("/depth", "cdr", 0);
  const auto joints = writer.add_channel("/joint_states", "cdr", 0);
  const std::array<std::byte, 300> state{};
  double written = 0;
  for (std::uint32_t i = 0; written < bytes; ++i) {
    const std::int64_t time = i * image_period;
    const auto image = std::as_bytes(std::span(images[i % images.size()]));
    writer.write(depth, time, time, i, image);
    for (int k = 0; k < 3; ++k) writer.write(joints, time + k, time + k, i, state);
    written += static_cast<double>(image.size() + 3 * state.size());
  }
  writer.close();
}

/// The most memory that this program has had so far, MB.
double peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM")) return std::stod(line.substr(6)) * 1024e-6;
  return std::numeric_limits<double>::quiet_NaN();
}

int stream(double gigabytes) {
  using Clock = std::chrono::steady_clock;
  const auto file = std::filesystem::temp_directory_path() / "penumbra_mcap_benchmark.mcap";
  write_bag(file, 1e9 * gigabytes);
  const auto start = Clock::now();
  mcap::Reader reader(file);
  double bytes = 0;
  for (mcap::Message message; reader.next(message);)
    bytes += static_cast<double>(message.data.size());
  const double rate = 1e-6 * bytes / std::chrono::duration<double>(Clock::now() - start).count();
  std::cout << "file " << 1e-9 * static_cast<double>(std::filesystem::file_size(file))
            << " GB, read " << 1e-9 * bytes << " GB of messages at " << rate
            << " MB/s, peak memory " << peak_memory() << " MB\n";
  std::filesystem::remove(file);
  if (peak_memory() < most_memory && rate > least_rate) return 0;
  std::cerr << "expected less than " << most_memory << " MB of memory, more than " << least_rate
            << " MB/s\n";
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2) return stream(std::atof(argv[1]));
  std::cerr << "usage: mcap_benchmark GB\n";
  return 2;
}
