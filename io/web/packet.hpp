// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/cloud/scan.hpp>

#include <io/files/png.hpp>
#include <io/web/web_types.hpp>

namespace penumbra::io {

/// The parts that a frame's packet may have in addition to its report.
enum class Part { color, overlay, labels, links, vdi, depth, cloud, outlines };

inline constexpr std::size_t part_count = 8;

[[nodiscard]] std::string_view to_string(Part part);

/// The parts that a client wants of each frame.
struct Wanted {
  std::vector<Part> parts;
  int step = 4;  ///< for the cloud: every step-th pixel in both directions

  static constexpr int max_step = 64;
};

/// Parses "color,labels" and "4". Empty texts give no parts and the default step. Returns nothing
/// for invalid texts.
[[nodiscard]] std::optional<Wanted> parse_wanted(std::string_view parts, std::string_view step);

/// An image or the cloud in the form that is sent: row-major, little endian, metres; 0 is no value.
struct PartBytes {
  std::string type;  ///< image/jpeg, image/png, u8, u16, f32, xyzlrgb
  int width = 0, height = 0;
  SharedBytes bytes;
  std::shared_ptr<const Image<Rgb8>> pixels = {};  ///< of Part::color, if it is decoded already
};

/// A judged frame, or a labelled scan.
struct PacketFrame {
  std::string report;  ///< its object in report.json
  std::string poses;   ///< of poses_json(), and "marks": [...] where targets can be outlined
  /// Returns a part, or nothing if the frame does not have it. Only scans have Part::cloud; that of
  /// a depth image is made of its other parts.
  std::function<std::optional<PartBytes>(Part)> part;
};

/// An archive of judged frames, which may still grow. Any thread may read the frames meanwhile.
class FrameArchive {
 public:
  FrameArchive() = default;
  FrameArchive(const FrameArchive&) = delete;
  FrameArchive& operator=(const FrameArchive&) = delete;
  virtual ~FrameArchive() = default;

  /// Returns the number of frames so far.
  [[nodiscard]] virtual std::size_t size() const = 0;
  [[nodiscard]] virtual bool is_complete() const = 0;
  /// Returns report.json so far, with the frames from index `from` on.
  [[nodiscard]] virtual SharedBytes report(std::size_t from) const = 0;
  /// Returns frame i in the report's order, or nothing if it does not exist (yet). This must
  /// outlive the frame.
  [[nodiscard]] virtual std::optional<PacketFrame> frame(std::size_t i) const = 0;
  /// Returns what cannot be shown and the command that provides it, one sentence each.
  [[nodiscard]] virtual std::vector<std::string> missing() const = 0;
};

/// Returns the measured points of a scan as Part::cloud, without colour; of more than 100,000
/// points each n-th.
[[nodiscard]] PartBytes cloud_part(const PointsView& points, ImageView<const std::uint8_t> labels);

/// Makes point clouds of depth images. Thread-safe.
class PacketCloud {
 public:
  /// `camera`: the camera of the parts' images.
  explicit PacketCloud(const Camera& camera);

  /// Returns a point for every step-th pixel with depth: x, y, z in the optical frame, metres,
  /// label, and colour (grey if there is none). Returns nothing without depth or labels.
  [[nodiscard]] std::optional<PartBytes> make(const PacketFrame& frame, int step) const;

 private:
  int width_, height_;
  std::vector<float> rays_;  // x and y at z = 1 for each pixel; NaN: no ray
};

/// Converts a depth image to metres.
template <typename T>
void fill_metres(ImageView<const T> from, Image<float>& to) {
  if (to.width() != from.width || to.height() != from.height)
    to = Image<float>(from.width, from.height);
  for (int v = 0; v < from.height; ++v)
    for (int u = 0; u < from.width; ++u) to(u, v) = metres_of(from(u, v));
}

/// Returns a frame's packet: the length of the JSON, the JSON, the parts. `cloud`: of a frame with
/// depth images, or null.
/// `more` is added to the JSON: empty, or ", " and members.
[[nodiscard]] std::vector<SharedBytes> make_packet(const PacketFrame& frame, const Wanted& wanted,
                                                   const PacketCloud* cloud,
                                                   std::uint64_t scene_version,
                                                   std::string_view more = {});

}  // namespace penumbra::io
