// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>

#include <io/ros/image_codec.hpp>
#include <io/ros/jpeg.hpp>
#include <io/web/live_frame.hpp>
#include <io/web/metres-inl.hpp>
#include <io/web/scene.hpp>

namespace penumbra::io {
namespace {

constexpr int live_jpeg_quality = 85;

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The image without gaps between its rows; nothing where it is another than such messages hold.
std::optional<PartBytes> rows_of(const std::optional<KeptImage>& kept, const std::string& encoding,
                                 std::size_t pixel_bytes, const char* type) {
  if (!kept || !kept->image) return std::nullopt;
  const ImageMessage& image = *kept->image;
  const std::size_t row = pixel_bytes * image.width;
  if (image.encoding != encoding || image.is_bigendian != 0 || row == 0 || image.height == 0 ||
      image.step < row || image.data.size() < std::size_t{image.step} * (image.height - 1) + row)
    return std::nullopt;
  std::string bytes;
  bytes.reserve(row * image.height);
  for (std::size_t v = 0; v < image.height; ++v)
    bytes += text_of(image.data.subspan(v * image.step, row));
  return PartBytes{type, static_cast<int>(image.width), static_cast<int>(image.height),
                   shared_bytes(std::move(bytes))};
}

bool is_jpeg(std::span<const std::byte> bytes) {
  return bytes.size() > 2 && bytes[0] == std::byte{0xFF} && bytes[1] == std::byte{0xD8};
}

}  // namespace

std::optional<PartBytes> LiveScene::depth(const LiveJob& job) {
  const std::lock_guard lock(mutex_);
  DepthView depth;
  std::string fault = job.image.image ? depth_.decode(*job.image.image, depth)
                                      : depth_.decode(*job.image.compressed, depth);
  if (fault.empty()) fault = depth_.check_size(depth);
  if (fault.empty() && depth_.is_of_other_camera()) fault = depth_.bring(job.T_judged_depth, depth);
  if (!fault.empty()) return std::nullopt;
  Image<float> metres;
  std::visit([&](const auto& image) { fill_metres(image, metres); }, depth);
  std::string bytes(metres.size() * sizeof(float), '\0');
  std::memcpy(bytes.data(), metres.data(), bytes.size());
  return PartBytes{"f32", metres.width(), metres.height(), shared_bytes(std::move(bytes))};
}

LiveFrame::LiveFrame(std::shared_ptr<LiveScene> scene, LiveJob job, LiveResults results,
                     std::uint64_t number)
    : scene_(std::move(scene)),
      job_(std::move(job)),
      results_(std::move(results)),
      number_(number) {}

std::string LiveFrame::report() const {
  const auto labels = part(Part::labels);
  std::optional<std::int64_t> age;
  if (job_.pose.pose.status == FrameStatus::ok) age = job_.pose.pose.age;
  return live_report(*results_.targets, number_, age, labels ? *labels->bytes : std::string());
}

std::string LiveFrame::poses() const {
  const PoseAnswer& pose = job_.pose.pose;
  const Robot& robot = job_.setup->posed->robot;
  const std::size_t links = robot.links().size();
  if (pose.status != FrameStatus::ok || !has_live_pose(results_.targets->status))
    return poses_json({}, {}, links);
  std::vector<Eigen::Isometry3d> T_root_link = pose.T_root_link;
  if (pose.by_joints) {
    T_root_link.resize(links);
    robot.forward_kinematics(job_.pose.frame().joints.positions, T_root_link);
  }
  const CameraMount& mount = job_.setup->mount;
  const std::size_t parent = robot.find_link(mount.parent).value_or(0);
  const Eigen::Isometry3d T_root_camera =
      T_root_link[parent] * pose.T_parent_camera.value_or(mount.T_parent_camera);
  return poses_json(T_root_link, T_root_camera, links);
}

std::optional<PartBytes> LiveFrame::part(Part part) const {
  const std::lock_guard lock(mutex_);
  auto& decoded = decoded_[static_cast<std::size_t>(part)];
  if (!decoded) decoded = decode(part);
  return *decoded;
}

std::shared_ptr<const Image<Rgb8>> LiveFrame::color_pixels() const {
  static_cast<void>(part(Part::color));
  const std::lock_guard lock(mutex_);
  return pixels_;
}

std::optional<PartBytes> LiveFrame::decode(Part part) const {
  switch (part) {
    case Part::color:
      return color();
    case Part::labels:
      return rows_of(results_.labels, "8UC1", 1, "u8");
    case Part::vdi:
      return rows_of(results_.virtual_depth, "32FC1", sizeof(float), "f32");
    case Part::depth:
      return scene_->depth(job_);
    case Part::overlay: {
      if (!results_.overlay || !results_.overlay->compressed) return std::nullopt;
      const Intrinsics& size = scene_->cameras.judged.intrinsics;
      return PartBytes{"image/png", size.width(), size.height(),
                       shared_bytes(text_of(results_.overlay->compressed->data))};
    }
    default:
      return std::nullopt;
  }
}

std::optional<PartBytes> LiveFrame::color() const {
  if (!job_.color) return std::nullopt;
  auto decoded = std::make_shared<Image<Rgb8>>();
  Image<Rgb8>& image = *decoded;
  if (!decode_color(*job_.color, scene_->cameras.judged, image).empty()) return std::nullopt;
  pixels_ = std::move(decoded);
  if (job_.color->compressed && is_jpeg(job_.color->compressed->data))
    return PartBytes{"image/jpeg", image.width(), image.height(),
                     shared_bytes(text_of(job_.color->compressed->data))};
  std::vector<std::byte> jpeg;
  encode_jpeg(std::as_const(image).view(), live_jpeg_quality, jpeg);
  return PartBytes{"image/jpeg", image.width(), image.height(), shared_bytes(text_of(jpeg))};
}

}  // namespace penumbra::io
