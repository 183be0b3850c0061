// SPDX-License-Identifier: Apache-2.0
// Bytes of messages per second through MCAP: 1280x720 depth images with joint states between them,
// as a recorder writes them. The file lies in the system's memory after the first pass.
//   mcap_benchmark                 reading and writing, every compression
//   mcap_benchmark --stream GB     writes a bag of so many GB of messages, reads it, tells the
//   memory
//                                  taken and fails where that is too much or reading too slow
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
#include <string_view>
#include <vector>

#include <benchmark/benchmark.h>

#include <io/mcap/reader.hpp>
#include <io/mcap/writer.hpp>

namespace {

using penumbra::io::mcap::Compression;
using penumbra::io::mcap::Message;
using penumbra::io::mcap::Reader;
using penumbra::io::mcap::Writer;

constexpr int width = 1280, height = 720;
constexpr int states_per_image = 3;
constexpr std::size_t state_bytes = 300;
constexpr std::int64_t image_period = 33'333'333;  // nanoseconds

// A wavy wall with a depth camera's noise: it compresses about as real images do.
std::vector<std::uint16_t> depth_image(int index) {
  std::mt19937 random(static_cast<unsigned>(index));
  std::vector<std::uint16_t> image;
  image.reserve(static_cast<std::size_t>(width) * height);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const double wave = 1500.0 + 300.0 * std::sin(0.01 * (u + 3 * index)) + 0.5 * v;
      const bool hole = u % 97 < 8;
      const auto noise = static_cast<std::uint16_t>((u / 4 + v / 2) % 7 == 0 ? random() % 4 : 0);
      image.push_back(hole ? 0
                           : static_cast<std::uint16_t>(static_cast<std::uint16_t>(wave) + noise));
    }
  return image;
}

const std::vector<std::vector<std::uint16_t>>& images() {
  static const std::vector<std::vector<std::uint16_t>> all = [] {
    std::vector<std::vector<std::uint16_t>> made(8);
    for (std::size_t i = 0; i < made.size(); ++i) made[i] = depth_image(static_cast<int>(i));
    return made;
  }();
  return all;
}

std::filesystem::path bag_file() {
  return std::filesystem::temp_directory_path() / "penumbra_mcap_benchmark.mcap";
}

// Bytes of messages.
std::uint64_t write_bag(Compression compression, std::uint64_t least_bytes) {
  Writer writer(bag_file(), {.compression = compression, .chunk_size = 4 << 20, .profile = "ros2"});
  const auto depth = writer.add_channel("/depth", "cdr", 0);
  const auto joints = writer.add_channel("/joint_states", "cdr", 0);
  const std::array<std::byte, state_bytes> state{};
  std::uint64_t bytes = 0;
  for (std::uint32_t i = 0; bytes < least_bytes; ++i) {
    const std::int64_t time = i * image_period;
    const auto image = std::as_bytes(std::span(images()[i % images().size()]));
    writer.write(depth, time, time, i, image);
    for (int k = 0; k < states_per_image; ++k) writer.write(joints, time + k, time + k, i, state);
    bytes += image.size() + states_per_image * state_bytes;
  }
  writer.close();
  return bytes;
}

std::uint64_t read_bag() {
  Reader reader(bag_file());
  std::uint64_t bytes = 0;
  for (Message message; reader.next(message);) bytes += message.data.size();
  for (const auto& fault : reader.faults()) std::cerr << fault.what << '\n';
  return bytes;
}

constexpr std::uint64_t benchmark_bytes = std::uint64_t{400} << 20;

void read_mcap(benchmark::State& state, Compression compression) {
  const std::uint64_t written = write_bag(compression, benchmark_bytes);
  std::uint64_t bytes = 0;
  for (auto _ : state) bytes += read_bag();
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes));
  state.counters["file_share"] =
      static_cast<double>(std::filesystem::file_size(bag_file())) / static_cast<double>(written);
  std::filesystem::remove(bag_file());
}

void write_mcap(benchmark::State& state, Compression compression) {
  static_cast<void>(images());
  std::uint64_t bytes = 0;
  for (auto _ : state) bytes += write_bag(compression, benchmark_bytes);
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes));
  std::filesystem::remove(bag_file());
}

BENCHMARK_CAPTURE(read_mcap, none, Compression::none)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(read_mcap, lz4, Compression::lz4)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(read_mcap, zstd, Compression::zstd)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(write_mcap, none, Compression::none)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(write_mcap, lz4, Compression::lz4)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(write_mcap, zstd, Compression::zstd)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

constexpr double most_memory = 300.0;  // MB, whatever the bag's size
constexpr double least_rate = 300.0;   // MB/s of messages, from lz4 chunks

// The most memory that this program has had so far, MB, as the kernel tells.
double peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM"))
      return std::stod(line.substr(6)) * 1024e-6;  // the kernel's kB are 1024
  return std::numeric_limits<double>::quiet_NaN();
}

int stream(double gigabytes) {
  using Clock = std::chrono::steady_clock;
  write_bag(Compression::lz4, static_cast<std::uint64_t>(gigabytes * 1e9));
  const double file_gb = static_cast<double>(std::filesystem::file_size(bag_file())) / 1e9;
  std::cout << "written; file " << file_gb << " GB, peak memory " << peak_memory() << " MB"
            << std::endl;
  const auto start = Clock::now();
  const double read_gb = static_cast<double>(read_bag()) / 1e9;
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  const double rate = 1000 * read_gb / seconds;
  std::cout << "read " << read_gb << " GB of messages in " << seconds << " s (" << rate
            << " MB/s; of the file " << 1000 * file_gb / seconds << " MB/s), peak memory "
            << peak_memory() << " MB" << std::endl;
  std::filesystem::remove(bag_file());
  if (peak_memory() < most_memory && rate > least_rate) return 0;
  std::cerr << "wanted: less than " << most_memory << " MB of memory, more than " << least_rate
            << " MB/s\n";
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && std::string_view(argv[1]) == "--stream") return stream(std::atof(argv[2]));
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
