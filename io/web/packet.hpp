// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>

#include <io/files/png.hpp>
#include <io/web/web_types.hpp>

namespace penumbra::io {

/// What a frame's packet may hold beside its report.
enum class Part { color, overlay, labels, links, vdi, depth, cloud };

inline constexpr std::size_t part_count = 7;

[[nodiscard]] std::string_view to_string(Part part);

/// What a client wants of each frame.
struct Wanted {
  std::vector<Part> parts;
  int step = 4;  ///< of the cloud: every step-th pixel in both directions

  static constexpr int max_step = 64;
};

/// Of "color,labels" and "4"; empty texts: none, and the default. Nothing for what is neither.
[[nodiscard]] std::optional<Wanted> parse_wanted(std::string_view parts, std::string_view step);

/// An image, or the cloud, as it is sent: row-major, little endian; metres; 0 is nothing.
struct PartBytes {
  std::string type;  ///< image/jpeg, image/png, u8, u16, f32, xyzlrgb
  int width = 0, height = 0;
  SharedBytes bytes;
};

/// A frame as it is judged and drawn.
class PacketFrame {
 public:
  PacketFrame() = default;
  PacketFrame(const PacketFrame&) = delete;
  PacketFrame& operator=(const PacketFrame&) = delete;
  virtual ~PacketFrame() = default;

  /// Its object of report.json.
  [[nodiscard]] virtual std::string report() const = 0;
  /// "link_poses": [...], "camera_pose": ..., and "marks": [...] where targets can be outlined
  [[nodiscard]] virtual std::string poses() const = 0;
  /// Nothing: the frame has none. Not asked for Part::cloud.
  [[nodiscard]] virtual std::optional<PartBytes> part(Part part) const = 0;
  /// The pixels of Part::color; null: there is none.
  [[nodiscard]] virtual std::shared_ptr<const Image<Rgb8>> color_pixels() const;
};

/// The points that a depth image shows. For several threads.
class CloudMaker {
 public:
  /// Of the images that the parts are.
  explicit CloudMaker(const Camera& camera);

  /// Of every step-th pixel that has a depth: x, y, z in the optical frame, metres, label, colour
  /// (grey where there is none). Nothing without depth or labels.
  [[nodiscard]] std::optional<PartBytes> make(const PacketFrame& frame, int step) const;

 private:
  int width_, height_;
  std::vector<float> rays_;  // x and y for each pixel, z being 1; NaN where there is none
};

/// A frame's packet: length of the JSON, the JSON, the parts. `cloud` may be null; `more` is added
/// to the JSON: empty, or ", " and members.
[[nodiscard]] std::vector<SharedBytes> make_packet(const PacketFrame& frame, const Wanted& wanted,
                                                   const CloudMaker* cloud,
                                                   std::uint64_t scene_version,
                                                   std::string_view more = {});

}  // namespace penumbra::io
