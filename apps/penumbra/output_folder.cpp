// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file.hpp>

#include <apps/penumbra/output_folder.hpp>
#include <io/cloud_file.hpp>
#include <io/disk_file.hpp>
#include <io/npy.hpp>
#include <io/overlay.hpp>
#include <io/pending_file.hpp>
#include <io/png.hpp>
#include <io/web/report_page.hpp>

namespace penumbra::app {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& path, const std::string& why) {
  throw InputError(path.string() + ": cannot be used as output folder (" + why +
                   "); choose another with -o");
}

/// As 16-bit PNGs hold it; 0: no measurement, or one past 65 m.
ImageView<const std::uint16_t> millimetres_of(const DepthImage& image,
                                              Image<std::uint16_t>& converted) {
  if (const auto* millimetres = std::get_if<Image<std::uint16_t>>(&image))
    return millimetres->view();
  const auto& metres = std::get<Image<float>>(image);
  if (converted.size() != metres.size())
    converted = Image<std::uint16_t>(metres.width(), metres.height());
  for (std::size_t i = 0; i < metres.size(); ++i) {
    const float rounded = std::round(1000.0F * metres.data()[i]);
    const bool fits = rounded > 0.0F && rounded < static_cast<float>(saturated_depth);
    converted.data()[i] = fits ? static_cast<std::uint16_t>(rounded) : std::uint16_t{0};
  }
  return std::as_const(converted).view();
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error)) refuse(folder, "it is a file");
  fs::create_directories(folder, error);
  if (error) refuse(folder, error.message());
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& folder, const RunArguments& arguments,
                           const Rectification* rectification)
    : folder_(folder),
      saves_(arguments.saves),
      has_page_(arguments.report_page),
      points_frame_(arguments.points_frame),
      painter_(rectification),
      unfinished_(folder) {
  make_folder(folder);
  for (const auto& [kind, wanted] : {std::pair("vdi", saves_.vdi),
                                     {"labels", saves_.labels},
                                     {"links", saves_.links},
                                     {"overlay", saves_.overlay},
                                     {"filtered", saves_.filtered},
                                     {"points", saves_.points}})
    if (wanted) make_folder(folder / kind);
}

void OutputFolder::begin(const io::ReportHead& head) { report_.emplace(report_file(), head); }

void OutputFolder::finish(const Statistics& statistics, std::span<const std::string> notes) {
  report_->finish(statistics, notes);
  unfinished_.finish();
  if (has_page_) write_page();
}

void OutputFolder::write_page() const {
  const fs::path page = folder_ / "report.html";
  std::error_code error;
  const auto size = fs::file_size(report_file(), error);
  if (error || size > io::most_report_page_bytes)
    throw InputError(page.string() + ": not written, as " + report_file().string() +
                     ", which is whole, is larger than " +
                     std::to_string(io::most_report_page_bytes >> 20U) +
                     " MB; choose fewer frames with --frames");
  const std::string text = io::report_page(
      read_whole_file(report_file(), io::most_report_page_bytes), key_frames_.json());
  io::PendingFile pending(page);
  io::OutputFile file(pending.part());
  file.write(text.data(), text.size());
  file.close();
  pending.finish();
}

void OutputFolder::save(const FrameReport& report, const io::FrameData& frame,
                        const io::ShownTargets& targets) {
  report_->add(report);
  const VirtualDepthView& virtual_depth = report.virtual_depth;
  const std::size_t index = report.index;
  if (saves_.vdi && !virtual_depth.depth.empty())
    io::write_npy(file("vdi", index, ".npy"), virtual_depth.depth);
  if (saves_.links && !virtual_depth.links.empty())
    io::write_png(file("links", index, ".png"), virtual_depth.links);
  if (saves_.labels)
    io::write_png(file("labels", index, ".png"), report.labels, io::label_palette());
  if (saves_.filtered || saves_.points) save_without_robot(report, frame, targets.camera);
  if (!saves_.overlay && !has_page_) return;
  const auto overlay = painter_.draw(report, {frame.depth_view(), frame.color.view()}, targets);
  if (saves_.overlay) io::write_png(file("overlay", index, ".png"), overlay);
  if (has_page_) key_frames_.add(report, overlay);
}

void OutputFolder::save_without_robot(const FrameReport& report, const io::FrameData& frame,
                                      const Camera& camera) {
  without_robot(report, filtered_);
  if (saves_.filtered)
    io::write_png(file("filtered", report.index, ".png"), millimetres_of(filtered_, millimetres_));
  if (!saves_.points) return;
  Eigen::Isometry3d T_frame_camera = Eigen::Isometry3d::Identity();
  if (!points_frame_.empty()) {
    const auto T = camera_in_link(report, points_frame_);
    if (!T) return;
    T_frame_camera = *T;
  }
  if (!cloud_maker_) cloud_maker_.emplace(camera);
  cloud_maker_->make(filtered_, cloud_, T_frame_camera);
  const ImageView<const io::Rgb8> color = painter_.seen_color(frame.color.view());
  io::write_pcd(file("points", report.index, ".pcd"), cloud_, color);
  io::write_ply(file("points", report.index, ".ply"), cloud_, color);
}

fs::path OutputFolder::file(const char* kind, std::size_t index, const char* ending) const {
  std::string digits = std::to_string(index);
  digits.insert(0, frame_digits - std::min(digits.size(), frame_digits), '0');
  return folder_ / kind / (digits + ending);
}

}  // namespace penumbra::app
