// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <span>
#include <utility>

#include <io/files/image_size.hpp>
#include <io/files/jpeg.hpp>
#include <io/files/report_json.hpp>
#include <io/web/live_frame.hpp>

namespace penumbra::io {
namespace {

constexpr int live_jpeg_quality = 85;

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool is_jpeg(std::span<const std::byte> bytes) {
  return bytes.size() > 2 && bytes[0] == std::byte{0xFF} && bytes[1] == std::byte{0xD8};
}

/// Returns the image as a part, or nothing if it is empty.
template <typename T>
std::optional<PartBytes> part_of(ImageView<const T> image, const char* type) {
  if (image.empty()) return std::nullopt;
  const std::size_t row = sizeof(T) * static_cast<std::size_t>(image.width);
  std::string bytes;
  bytes.reserve(row * static_cast<std::size_t>(image.height));
  for (int v = 0; v < image.height; ++v)
    bytes.append(reinterpret_cast<const char*>(image.row(v)), row);
  return PartBytes{type, image.width, image.height, shared_bytes(std::move(bytes))};
}

}  // namespace

const Scene& LiveScene::drawn() const {
  std::call_once(drawn_once_, [this] { drawn_ = make_scene(robot(), version); });
  return *drawn_;
}

const PacketCloud* LiveScene::cloud() const {
  if (!camera) return nullptr;
  std::call_once(cloud_once_, [this] { cloud_.emplace(*camera); });
  return &*cloud_;
}

LiveFrame::LiveFrame(std::shared_ptr<const LiveScene> scene, const AssembledFrame& job,
                     const FrameReport& report, const PartSet& kept,
                     CalibrationProgress calibration)
    : scene_(std::move(scene)),
      kept_(kept),
      index_(report.index),
      stamp_(job.stamp.value_or(0)),
      report_(report_frame(report)),
      poses_(poses_json(report.T_root_link, report.T_root_camera, scene_->robot().links().size())),
      pose_(job.pose),
      calibration_(std::move(calibration)) {
  const auto keeps = [&](Part part) { return kept[static_cast<std::size_t>(part)]; };
  if (keeps(Part::labels)) labels_ = part_of(report.labels, "u8");
  if (keeps(Part::links)) links_ = part_of(report.virtual_depth.links, "u16");
  if (keeps(Part::vdi)) virtual_depth_ = part_of(report.virtual_depth.depth, "f32");
  if (keeps(Part::depth))
    std::visit([this](const auto& image) { raw_depth_ = copy_of(image); }, job.depth.view);
  if (keeps(Part::color)) raw_color_ = job.color_image;
  if (keeps(Part::cloud) && job.scan) scan_ = cloud_part(job.scan->points, report.labels);
}

PacketFrame LiveFrame::packet_frame() const {
  return {report_, poses_, [this](Part kind) { return part(kind); }};
}

std::optional<PartBytes> LiveFrame::part(Part part) const {
  switch (part) {
    case Part::color:
      std::call_once(color_once_, [this] { decode_color(); });
      return color_;
    case Part::labels:
      return labels_;
    case Part::links:
      return links_;
    case Part::vdi:
      return virtual_depth_;
    case Part::depth:
      std::call_once(depth_once_, [this] { convert_depth(); });
      return depth_;
    case Part::cloud:
      return scan_;
    case Part::outlines:
      return scene_->outlines(pose_, calibration_);
    default:
      return std::nullopt;
  }
}

void LiveFrame::decode_color() const {
  auto pixels = std::make_shared<Image<Rgb8>>();
  if (!raw_color_ || !io::decode_color(*raw_color_, *scene_->camera, *pixels).empty()) return;
  color_ = {"image/jpeg", pixels->width(), pixels->height(), {}, pixels};
  if (raw_color_->compressed && is_jpeg(raw_color_->compressed->data)) {
    color_->bytes = shared_bytes(text_of(raw_color_->compressed->data));
    return;
  }
  std::vector<std::byte> jpeg;
  encode_jpeg(std::as_const(*pixels).view(), live_jpeg_quality, jpeg);
  color_->bytes = shared_bytes(text_of(jpeg));
}

void LiveFrame::convert_depth() const {
  Image<float> metres;
  std::visit([&](const auto& image) { fill_metres(image.view(), metres); }, raw_depth_);
  depth_ = part_of(std::as_const(metres).view(), "f32");
}

}  // namespace penumbra::io
