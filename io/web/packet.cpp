// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

#include <io/files/jpeg.hpp>
#include <io/files/numbers.hpp>
#include <io/files/png.hpp>
#include <io/web/packet.hpp>
#include <io/web/web_types.hpp>

namespace penumbra::io {
namespace {

static_assert(std::endian::native == std::endian::little, "packets are little endian");

constexpr std::array<std::string_view, part_count> part_names{
    "color", "overlay", "labels", "links", "vdi", "depth", "cloud", "outlines"};
constexpr Rgb8 no_color{128, 128, 128};

struct Point {
  std::array<float, 3> position;
  std::uint8_t label;
  Rgb8 color;
};
static_assert(sizeof(Point) == 16);

std::optional<Part> part_of(std::string_view name) {
  const auto* const found = std::find(part_names.begin(), part_names.end(), name);
  if (found == part_names.end()) return std::nullopt;
  return static_cast<Part>(found - part_names.begin());
}

/// Returns the pixels of Part::color, or null if there are none.
std::shared_ptr<const Image<Rgb8>> color_pixels(const std::optional<PartBytes>& color) {
  if (!color || color->pixels) return color ? color->pixels : nullptr;
  auto image = std::make_shared<Image<Rgb8>>();
  return decode_jpeg(std::as_bytes(std::span(*color->bytes)), *image) ? nullptr : image;
}

}  // namespace

std::string_view to_string(Part part) { return part_names[static_cast<std::size_t>(part)]; }

std::optional<Wanted> parse_wanted(std::string_view parts, std::string_view step) {
  Wanted wanted;
  if (!step.empty()) {
    const auto number = parse_number<std::int64_t>(step);
    if (!number || *number < 1 || *number > Wanted::max_step) return std::nullopt;
    wanted.step = static_cast<int>(*number);
  }
  while (!parts.empty()) {
    const std::string_view name = parts.substr(0, parts.find(','));
    parts.remove_prefix(std::min(parts.size(), name.size() + 1));
    const auto part = part_of(name);
    if (!part) return std::nullopt;
    if (std::find(wanted.parts.begin(), wanted.parts.end(), *part) == wanted.parts.end())
      wanted.parts.push_back(*part);
  }
  return wanted;
}

PartBytes cloud_part(const PointsView& points, ImageView<const std::uint8_t> labels) {
  constexpr std::size_t most = 100'000;
  const std::size_t step = std::max<std::size_t>(1, (points.count + most - 1) / most);
  std::string bytes;
  bytes.reserve(sizeof(Point) * (points.count / step + 1));
  for (std::size_t i = 0; i < points.count; i += step) {
    const Eigen::Vector3f& p = points[i];
    if (!p.allFinite()) continue;
    const Point point{{p.x(), p.y(), p.z()}, labels.data[i], no_color};
    bytes.append(reinterpret_cast<const char*>(&point), sizeof point);
  }
  const int count = static_cast<int>(bytes.size() / sizeof(Point));
  return {"xyzlrgb", count, 1, shared_bytes(std::move(bytes))};
}

PacketCloud::PacketCloud(const Camera& camera)
    : width_(camera.intrinsics.width()), height_(camera.intrinsics.height()) {
  rays_.reserve(2 * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  constexpr float no_ray = std::numeric_limits<float>::quiet_NaN();
  for (int v = 0; v < height_; ++v)
    for (int u = 0; u < width_; ++u) {
      const auto ray = camera.distortion.undistort(camera.intrinsics.ray(u, v).head<2>());
      rays_.push_back(ray ? static_cast<float>(ray->x()) : no_ray);
      rays_.push_back(ray ? static_cast<float>(ray->y()) : no_ray);
    }
}

std::optional<PartBytes> PacketCloud::make(const PacketFrame& frame, int step) const {
  const auto depth = frame.part(Part::depth);
  const auto labels = frame.part(Part::labels);
  if (!depth || !labels) return std::nullopt;
  const std::size_t pixels = rays_.size() / 2;
  if (depth->bytes->size() != pixels * sizeof(float) || labels->bytes->size() != pixels)
    return std::nullopt;
  const auto color = color_pixels(frame.part(Part::color));
  const bool is_colored = color && color->width() == width_ && color->height() == height_;

  std::string bytes;
  for (int v = 0; v < height_; v += step)
    for (int u = 0; u < width_; u += step) {
      const std::size_t i = static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) +
                            static_cast<std::size_t>(u);
      float z = 0;
      std::memcpy(&z, depth->bytes->data() + i * sizeof z, sizeof z);
      const float x = rays_[2 * i], y = rays_[2 * i + 1];
      if (!(z > 0) || std::isnan(x)) continue;
      const Point point{{x * z, y * z, z},
                        static_cast<std::uint8_t>((*labels->bytes)[i]),
                        is_colored ? (*color)(u, v) : no_color};
      bytes.append(reinterpret_cast<const char*>(&point), sizeof point);
    }
  const int count = static_cast<int>(bytes.size() / sizeof(Point));
  return PartBytes{"xyzlrgb", count, 1, shared_bytes(std::move(bytes))};
}

std::vector<SharedBytes> make_packet(const PacketFrame& frame, const Wanted& wanted,
                                     const PacketCloud* cloud, std::uint64_t scene_version,
                                     std::string_view more) {
  std::vector<SharedBytes> packet(1);
  std::string parts;
  for (const Part kind : wanted.parts) {
    std::optional<PartBytes> part = frame.part(kind);
    if (kind == Part::cloud && cloud != nullptr) part = cloud->make(frame, wanted.step);
    if (!part) continue;
    parts += (parts.empty() ? "" : ", ") + std::string("{\"name\": \"") +
             std::string(to_string(kind)) + "\", \"type\": \"" + part->type +
             "\", \"size\": " + std::to_string(part->bytes->size()) +
             ", \"width\": " + std::to_string(part->width) +
             ", \"height\": " + std::to_string(part->height) + "}";
    packet.push_back(part->bytes);
  }
  std::string json = "{\"frame\": " + frame.report + ", \"server\": \"" + server_id() +
                     "\", \"scene_version\": " + std::to_string(scene_version) + ", " +
                     frame.poses + ", \"parts\": [" + parts + "]" + std::string(more) + "}";
  const auto length = static_cast<std::uint32_t>(json.size());
  std::string head(sizeof length, '\0');
  std::memcpy(head.data(), &length, sizeof length);
  packet.front() = shared_bytes(head + json);
  return packet;
}

}  // namespace penumbra::io
