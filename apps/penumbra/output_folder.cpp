// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <system_error>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file-inl.hpp>

#include <apps/penumbra/output_folder.hpp>
#include <io/files/cloud_file.hpp>
#include <io/files/disk_file.hpp>
#include <io/files/npy.hpp>
#include <io/files/overlay.hpp>
#include <io/files/pending_file.hpp>
#include <io/files/png.hpp>
#include <io/web/report_page.hpp>

namespace penumbra::app {
namespace {

namespace fs = std::filesystem;

struct ImageKind {
  const char *folder, *ending;
  bool Saves::*wanted;
};
constexpr std::array<ImageKind, 7> image_kinds{{{"vdi", ".npy", &Saves::vdi},
                                                {"labels", ".png", &Saves::labels},
                                                {"links", ".png", &Saves::links},
                                                {"overlay", ".png", &Saves::overlay},
                                                {"filtered", ".png", &Saves::filtered},
                                                {"points", ".pcd", &Saves::points},
                                                {"points", ".ply", &Saves::points}}};

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

/// Returns `folder`, which is made if it is not there.
const fs::path& make_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error)) refuse(folder, "it is a file");
  fs::create_directories(folder, error);
  if (error) refuse(folder, error.message());
  return folder;
}

bool starts_with(const fs::path& file, std::string_view start) {
  std::error_code error;
  io::InputFile input;
  if (!fs::is_regular_file(file, error) || !input.open(file).ok()) return false;
  std::string found(start.size(), '\0');
  return input.read(found.data(), found.size()) == start.size() && found == start;
}

bool is_report(const fs::path& file) { return starts_with(file, io::report_json_start); }
bool is_page(const fs::path& file) { return starts_with(file, io::report_page_start); }

/// Whether an earlier run wrote here. Of one that was killed, the report's part is there.
bool is_of_a_run(const fs::path& folder) {
  const fs::path report = folder / "report.json";
  std::error_code error;
  return is_report(report) || fs::exists(io::PendingFile::part_of(report), error);
}

/// Whether there is more than empty folders, as a run that failed leaves them.
bool holds_files(const fs::path& folder) {
  std::error_code error, ignored;
  fs::recursive_directory_iterator entry(folder, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error))
    if (!fs::is_directory(entry->symlink_status(ignored))) return true;
  return static_cast<bool>(error);
}

/// Whether a run gives files such a name: a frame's number.
bool is_frame_number(const std::string& stem) {
  return stem.size() >= frame_digits &&
         std::all_of(stem.begin(), stem.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// Returns the images of an earlier run in one of the folders that it writes.
std::vector<fs::path> images_in(const fs::path& folder, std::string_view ending) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) return {};
  if (fs::is_symlink(folder, error))
    refuse(folder, "it is a link, and nothing behind a link is removed");
  std::vector<fs::path> images;
  std::error_code ignored;
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error))
    if (is_frame_number(entry->path().stem().string()) && entry->path().extension() == ending &&
        fs::is_regular_file(entry->path(), ignored))
      images.push_back(entry->path());
  if (error) refuse(folder, error.message());
  return images;
}

void remove_former(const fs::path& file) {
  std::error_code error;
  if (fs::remove(file, error); error)
    throw InputError(file.string() + ": of an earlier run, cannot be removed (" + error.message() +
                     "); choose another folder with -o");
}

/// The report goes last: as long as images are there it says whose they are.
void remove_former_run(const fs::path& folder) {
  if (!is_of_a_run(folder)) return;
  for (const ImageKind& kind : image_kinds)
    for (const fs::path& image : images_in(folder / kind.folder, kind.ending)) remove_former(image);
  if (is_page(folder / "report.html")) remove_former(folder / "report.html");
  if (is_report(folder / "report.json")) remove_former(folder / "report.json");
}

}  // namespace

void check_output_folder(const RunArguments& arguments) {
  const fs::path& folder = arguments.output;
  std::error_code error;
  if (!fs::exists(folder, error)) return;
  if (!fs::is_directory(folder, error)) refuse(folder, "it is a file");
  if (arguments.force) return;
  if (!is_of_a_run(folder) && holds_files(folder))
    throw InputError(folder.string() +
                     ": holds files, and no report.json of penumbra; choose another folder with "
                     "-o, or write into this one with --force");
  const fs::path page = folder / "report.html";
  if (arguments.report_page && fs::exists(page, error) && !is_page(page))
    throw InputError(page.string() +
                     ": is no page of a run; move it away, or replace it with --force");
}

OutputFolder::OutputFolder(const fs::path& folder, const RunArguments& arguments,
                           const Rectification* rectification)
    : folder_(make_folder(folder)),
      lock_(folder_),
      saves_(arguments.saves),
      has_page_(arguments.report_page),
      points_frame_(arguments.points_frame),
      painter_(rectification) {
  remove_former_run(folder_);
  for (const ImageKind& kind : image_kinds)
    if (saves_.*kind.wanted) make_folder(folder / kind.folder);
}

OutputFolder::~OutputFolder() {
  if (finished_) return;
  std::error_code ignored;
  for (const std::size_t index : saved_)
    for (const ImageKind& kind : image_kinds)
      if (saves_.*kind.wanted) fs::remove(file(kind.folder, index, kind.ending), ignored);
}

void OutputFolder::begin(const io::ReportHead& head) { report_.emplace(report_file(), head); }

void OutputFolder::finish(const Statistics& statistics, std::span<const std::string> notes) {
  report_->finish(statistics, notes);
  finished_ = true;
  if (has_page_) write_page();
}

void OutputFolder::write_page() const {
  const fs::path page = folder_ / "report.html";
  std::error_code error;
  const auto size = fs::file_size(report_file(), error);
  if (error || size > io::most_report_page_bytes)
    throw InputError(page.string() + ": not written, as " + report_file().string() +
                     " is larger than " + std::to_string(io::most_report_page_bytes >> 20U) +
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
  saved_.push_back(report.index);
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
