// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <system_error>
#include <utility>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/output_folder.hpp>
#include <io/npy.hpp>
#include <io/overlay.hpp>
#include <io/png.hpp>

namespace penumbra::app {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& path, const std::string& why) {
  throw InputError(path.string() + ": cannot be used as output folder (" + why +
                   "); choose another with -o");
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error)) refuse(folder, "it is a file");
  fs::create_directories(folder, error);
  if (error) refuse(folder, error.message());
}

LabelView labels_of(const FrameReport& report) {
  const PixelCounts& pixels = report.pixels;
  const std::size_t all = static_cast<std::size_t>(report.labels.width) *
                          static_cast<std::size_t>(report.labels.height);
  const std::size_t labelled = pixels.front + pixels.occluded + pixels.unknown + pixels.beyond;
  return {report.labels,
          {all - labelled - pixels.uncovered, pixels.front, pixels.occluded, pixels.unknown,
           pixels.beyond},
          nullptr};
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& folder, const Saves& saves,
                           const Rectification* rectification)
    : folder_(folder), saves_(saves), rectification_(rectification) {
  make_folder(folder);
  for (const auto& [kind, wanted] : {std::pair("vdi", saves.vdi),
                                     {"labels", saves.labels},
                                     {"links", saves.links},
                                     {"overlay", saves.overlay}})
    if (wanted) make_folder(folder / kind);
}

void OutputFolder::save(const FrameReport& report, const io::FrameData& frame,
                        const ShownTargets& targets) {
  const VirtualDepthView& virtual_depth = report.virtual_depth;
  const std::size_t index = report.index;
  if (saves_.vdi && !virtual_depth.depth.empty())
    io::write_npy(file("vdi", index, ".npy"), virtual_depth.depth);
  if (saves_.links && !virtual_depth.links.empty())
    io::write_png(file("links", index, ".png"), virtual_depth.links);
  if (saves_.labels) io::write_png(file("labels", index, ".png"), report.labels);
  if (saves_.overlay) save_overlay(report, frame, targets);
}

fs::path OutputFolder::file(const char* kind, std::size_t index, const char* ending) const {
  std::string digits = std::to_string(index);
  digits.insert(0, frame_digits - std::min(digits.size(), frame_digits), '0');
  return folder_ / kind / (digits + ending);
}

void OutputFolder::save_overlay(const FrameReport& report, const io::FrameData& frame,
                                const ShownTargets& targets) {
  io::OverlayInput input;
  input.labels = labels_of(report);
  input.uncovered = report.pixels.uncovered;
  input.index = static_cast<std::int64_t>(report.index);
  input.stamp = report.stamp;
  input.message = report.message;
  input.pose_known = has_pose(report.status);
  if (!frame.color.empty()) {
    input.color = seen(frame.color, color_);
  } else {
    std::visit([&](const auto& depth) { input.depth = seen(depth, depth_of(depth)); }, frame.depth);
  }
  io::draw_overlay(input, overlay_);
  target_overlay_.draw(targets.targets, report, targets.robot, targets.camera, overlay_);
  io::write_png(file("overlay", report.index, ".png"), std::as_const(overlay_).view());
}

template <typename T>
ImageView<const T> OutputFolder::seen(const Image<T>& raw, Image<T>& rectified) {
  if (rectification_ == nullptr || raw.empty()) return raw.view();
  const Intrinsics& pinhole = rectification_->pinhole();
  if (rectified.empty()) rectified = Image<T>(pinhole.width(), pinhole.height());
  remap(rectification_->pinhole_to_raw(), raw.view(), T{}, rectified.view());
  return std::as_const(rectified).view();
}

}  // namespace penumbra::app
