// SPDX-License-Identifier: Apache-2.0
// Google Benchmark of ROS 2's messages: what it costs to read and write those of a camera of
// 1280 x 720 pixels and an arm of seven joints. Images are smooth with noise in their last bits, as
// a sensor's are.
#include "../tests/io/ros_rvl.hpp"

#include <random>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include <io/ros/image_codec.hpp>
#include <io/ros/message_decoder.hpp>
#include <io/ros/message_encoder.hpp>

namespace penumbra::bench {
namespace {

constexpr int width = 1280, height = 720;

template <typename T>
Image<T> smooth_image(int scale, int noise) {
  std::mt19937 random(7);
  Image<T> image(width, height);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      image(u, v) = static_cast<T>(scale * (u + 2 * v) + static_cast<int>(random() % 4) * noise);
  return image;
}

Image<io::Rgb8> colour_image() {
  const auto grey = smooth_image<std::uint8_t>(1, 1);
  Image<io::Rgb8> image(width, height);
  for (std::size_t i = 0; i < image.size(); ++i) {
    const std::uint8_t value = grey.data()[i];
    image.data()[i] = {value, static_cast<std::uint8_t>(value / 2), 40};
  }
  return image;
}

const io::MessageHeader header{1'700'000'000'000'000'000, "camera_color_optical_frame"};

io::JointStateMessage joints() {
  io::JointStateMessage message{.header = header};
  for (int i = 1; i <= 7; ++i) {
    message.names.push_back("joint" + std::to_string(i));
    message.positions.push_back(0.1 * i);
    message.velocities.push_back(0.2 * i);
    message.efforts.push_back(i);
  }
  return message;
}

template <typename M>
void decode_message(benchmark::State& state, const M& message) {
  std::vector<std::byte> payload;
  io::encode(message, payload);
  const io::Decoder<M> decoder;
  M out;
  for (auto _ : state) {
    if (const auto fault = decoder.decode(payload, out)) return state.SkipWithError(fault->c_str());
    benchmark::DoNotOptimize(out);
  }
}

template <typename M>
void encode_message(benchmark::State& state, const M& message) {
  std::vector<std::byte> payload;
  for (auto _ : state) {
    io::encode(message, payload);
    benchmark::DoNotOptimize(payload.data());
  }
}

// From the payload to depths that the pipeline takes.
void decode_depth(benchmark::State& state, bool bigendian) {
  const auto image = smooth_image<std::uint16_t>(1, 1);
  auto message = io::image_message(header, "16UC1", image.view());
  message.is_bigendian = bigendian ? 1 : 0;
  std::vector<std::byte> payload;
  io::encode(message, payload);
  const io::Decoder<io::ImageMessage> decoder;
  io::ImageMessage out;
  io::DecodedDepth depth;
  for (auto _ : state) {
    auto fault = decoder.decode(payload, out);
    if (!fault) fault = io::decode_depth(out, depth);
    if (fault) return state.SkipWithError(fault->c_str());
    benchmark::DoNotOptimize(depth.view);
  }
}

void decode_rvl_depth(benchmark::State& state) {
  const auto image = smooth_image<std::uint16_t>(1, 1);
  std::vector<std::byte> data(12);  // parameters, which 16UC1 does not need
  for (const int size : {width, height})
    for (int shift = 0; shift < 32; shift += 8)
      data.push_back(static_cast<std::byte>(size >> shift & 0xff));
  const auto packed = test::RvlPacker::pack(std::span(image.data(), image.size()));
  data.insert(data.end(), packed.begin(), packed.end());
  const io::CompressedImageMessage message{
      .header = header, .format = "16UC1; compressedDepth rvl", .data = data};
  io::DecodedDepth depth;
  for (auto _ : state)
    if (const auto fault = io::decode_depth(message, depth))
      return state.SkipWithError(fault->c_str());
}

void decode_colour(benchmark::State& state, const char* encoding, int bytes) {
  const std::vector<std::byte> data(static_cast<std::size_t>(bytes) * width * height,
                                    std::byte{90});
  const io::ImageMessage message{.header = header,
                                 .height = height,
                                 .width = width,
                                 .encoding = encoding,
                                 .step = static_cast<std::uint32_t>(bytes) * width,
                                 .data = data};
  Image<io::Rgb8> image;
  for (auto _ : state) {
    if (const auto fault = io::decode_colour(message, image))
      return state.SkipWithError(fault->c_str());
    benchmark::DoNotOptimize(image.data());
  }
}

void png_there(benchmark::State& state) {
  const auto image = colour_image();
  std::vector<std::byte> png;
  for (auto _ : state) benchmark::DoNotOptimize(io::png_message(header, image.view(), png));
  state.counters["bytes"] = static_cast<double>(png.size());
}

void png_back(benchmark::State& state) {
  std::vector<std::byte> png;
  const auto source = colour_image();
  const auto message = io::png_message(header, source.view(), png);
  Image<io::Rgb8> image;
  for (auto _ : state) {
    if (const auto fault = io::decode_colour(message, image))
      return state.SkipWithError(fault->c_str());
  }
}

int run(int argc, char** argv) {
  benchmark::RegisterBenchmark("joints/decode", decode_message<io::JointStateMessage>, joints());
  benchmark::RegisterBenchmark("joints/encode", encode_message<io::JointStateMessage>, joints());
  benchmark::RegisterBenchmark("depth/16UC1", decode_depth, false);
  benchmark::RegisterBenchmark("depth/16UC1 of the other byte order", decode_depth, true);
  const auto depth = smooth_image<float>(1, 1);
  benchmark::RegisterBenchmark("depth/encode 32FC1", encode_message<io::ImageMessage>,
                               io::image_message(header, "32FC1", depth.view()));
  benchmark::RegisterBenchmark("depth/RVL", decode_rvl_depth);
  benchmark::RegisterBenchmark("colour/rgb8", decode_colour, "rgb8", 3);
  benchmark::RegisterBenchmark("colour/bgra8", decode_colour, "bgra8", 4);
  benchmark::RegisterBenchmark("colour/yuv422_yuy2", decode_colour, "yuv422_yuy2", 2);
  benchmark::RegisterBenchmark("colour/PNG encode", png_there)->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("colour/PNG decode", png_back)->Unit(benchmark::kMillisecond);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace
}  // namespace penumbra::bench

int main(int argc, char** argv) { return penumbra::bench::run(argc, argv); }
