// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file-inl.hpp>

#include <io/cloud/cloud_file.hpp>
#include <io/files/disk_file.hpp>
#include <io/files/json-inl.hpp>
#include <io/files/npy.hpp>
#include <io/files/overlay_painter.hpp>
#include <io/files/png.hpp>
#include <io/run/output_folder.hpp>
#include <io/web/report_page.hpp>

namespace penumbra::io {
namespace {

namespace fs = std::filesystem;

struct ImageKind {
  const char *folder, *ending;
  bool Saves::*wanted;
};
constexpr std::array<ImageKind, 8> image_kinds{{{"vdi", ".npy", &Saves::vdi},
                                                {"labels", ".png", &Saves::labels},
                                                {"links", ".png", &Saves::links},
                                                {"robot_mask", ".png", &Saves::robot_mask},
                                                {"overlay", ".png", &Saves::overlay},
                                                {"filtered", ".png", &Saves::filtered},
                                                {"points", ".pcd", &Saves::points},
                                                {"points", ".ply", &Saves::points}}};

[[noreturn]] void refuse(const fs::path& path, const std::string& why) {
  throw InputError(path.string() + ": cannot be used as output folder (" + why +
                   "); choose another with -o");
}

constexpr std::size_t most_writers = 16;  // each has images in memory

std::size_t writers_of(const OutputOptions& options) {
  if (options.threads > 0) return static_cast<std::size_t>(options.threads);
  return std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, most_writers);
}

/// Converts depth for 16-bit PNGs; 0: no measurement, or one beyond 65 m.
Image<std::uint16_t> millimetres_of(const DepthImage& image) {
  if (const auto* millimetres = std::get_if<Image<std::uint16_t>>(&image)) return *millimetres;
  const auto& metres = std::get<Image<float>>(image);
  Image<std::uint16_t> converted(metres.width(), metres.height());
  for (std::size_t i = 0; i < metres.size(); ++i) {
    const float rounded = std::round(1000.0F * metres.data()[i]);
    const bool fits = rounded > 0.0F && rounded < static_cast<float>(saturated_depth);
    converted.data()[i] = fits ? static_cast<std::uint16_t>(rounded) : std::uint16_t{0};
  }
  return converted;
}

/// Returns points with x, y, z and, if there is an image of their pixels, its colour as PCL packs
/// it.
StoredCloud stored_cloud(const PointCloud& points, ImageView<const Rgb8> color) {
  StoredCloud stored;
  stored.cloud.fields = {{"x", 0}, {"y", 4}, {"z", 8}};
  if (!color.empty()) stored.cloud.fields.push_back({"rgb", 12});
  const std::size_t step = sizeof(float) * stored.cloud.fields.size();
  stored.data.resize(step * points.points.size());
  std::byte* to = stored.data.data();
  for (std::size_t i = 0; i < points.points.size(); ++i, to += step) {
    std::memcpy(to, points.points[i].data(), 3 * sizeof(float));
    if (color.empty()) continue;
    const auto width = static_cast<std::uint32_t>(color.width);
    const Rgb8 c = color(static_cast<int>(points.pixels[i] % width),
                         static_cast<int>(points.pixels[i] / width));
    const auto packed = static_cast<std::uint32_t>(c.r << 16 | c.g << 8 | c.b);
    std::memcpy(to + 3 * sizeof(float), &packed, sizeof packed);
  }
  stored.cloud.height = 1;
  stored.cloud.width = static_cast<std::uint32_t>(points.points.size());
  stored.cloud.point_step = static_cast<std::uint32_t>(step);
  stored.cloud.row_step = static_cast<std::uint32_t>(stored.data.size());
  stored.cloud.data = stored.data;
  return stored;
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error)) refuse(folder, "it is a file");
  fs::create_directories(folder, error);
  if (error) refuse(folder, error.message());
}

/// Returns whether this is a file name of a run: a frame's number.
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

}  // namespace

ResultFolderOptions run_results(const OutputOptions& options) {
  return {.path = options.path,
          .report = {"report.json", std::string(report_json_start)},
          .others = {{"report.html", page_begin, options.report_page},
                     {"links.json", "{\n", options.saves.links}},
          .force = options.force,
          .advice = "choose another folder with -o, or write into this one with --force"};
}

OutputFolder::OutputFolder(const OutputOptions& options, ResultFolder& folder,
                           const Rectification* rectification)
    : options_(options), folder_(folder), painter_(rectification) {
  writers_.emplace(writers_of(options_));
  if (folder.has_former())
    for (const ImageKind& kind : image_kinds)
      for (const fs::path& image : images_in(folder.path() / kind.folder, kind.ending))
        remove_former(image);
  folder.remove_former();
  for (const ImageKind& kind : image_kinds)
    if (options_.saves.*kind.wanted) make_folder(options_.path / kind.folder);
}

OutputFolder::~OutputFolder() {
  if (finished_) return;
  writers_.reset();
  std::error_code ignored;
  for (const std::size_t index : saved_)
    for (const ImageKind& kind : image_kinds)
      if (options_.saves.*kind.wanted) fs::remove(file(kind.folder, index, kind.ending), ignored);
}

void OutputFolder::begin(const ReportHead& head) {
  folder_.add("report.json", [&](const fs::path& part) {
    report_file_ = part;
    report_.emplace(part, head);
  });
  if (!options_.saves.links) return;
  Json links = Json::object();
  for (std::size_t i = 0; i < head.links.size(); ++i)
    links[std::to_string(i + 1)] = {{"link", head.links[i]}};
  folder_.add_text("links.json", links.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

void OutputFolder::finish(const Statistics& statistics, std::span<const std::string> notes) {
  writers_->finish();
  report_->finish(statistics, notes);
  const std::string fault = options_.report_page ? add_page() : std::string();
  folder_.finish();
  finished_ = true;
  if (!fault.empty()) throw InputError(fault);
}

/// Returns why there is no page, or an empty text.
std::string OutputFolder::add_page() {
  std::error_code error;
  const auto size = fs::file_size(report_file_, error);
  if (error || size > most_report_page_bytes)
    return (options_.path / "report.html").string() +
           ": not written, as report.json is larger than " +
           std::to_string(most_report_page_bytes >> 20U) + " MB; choose fewer frames with --frames";
  folder_.add_text("report.html", report_page(read_whole_file(report_file_, most_report_page_bytes),
                                              key_frames_.json()));
  return {};
}

void OutputFolder::save(const FrameReport& report, const Frame& frame,
                        const ShownTargets& targets) {
  report_->add(report);
  saved_.push_back(report.index);
  const VirtualDepthView& virtual_depth = report.virtual_depth;
  const std::size_t index = report.index;
  const auto plain_png = [](const auto& to, const auto& image) { write_png(to, image); };
  const auto plain_npy = [](const auto& to, const auto& image) { write_npy(to, image); };
  if (options_.saves.vdi && !virtual_depth.depth.empty())
    write_later(file("vdi", index, ".npy"), virtual_depth.depth, plain_npy);
  if (options_.saves.links && !virtual_depth.links.empty())
    write_later(file("links", index, ".png"), virtual_depth.links, plain_png);
  if (options_.saves.robot_mask && !virtual_depth.links.empty())
    writers_->add([to = file("robot_mask", index, ".png"), mask = robot_mask(virtual_depth)] {
      write_png(to, mask.view());
    });
  if (options_.saves.labels)
    write_later(file("labels", index, ".png"), report.labels,
                [](const auto& to, const auto& image) { write_png(to, image, label_palette()); });
  if (options_.saves.filtered || options_.saves.points)
    save_without_robot(report, frame, targets.camera);
  if (!options_.saves.overlay && !options_.report_page) return;
  const auto overlay = painter_.draw(report, {frame.depth.view, frame.color.view}, targets);
  if (options_.saves.overlay) write_later(file("overlay", index, ".png"), overlay, plain_png);
  if (options_.report_page) key_frames_.add(report, overlay);
}

void OutputFolder::save_without_robot(const FrameReport& report, const Frame& frame,
                                      const Camera& camera) {
  without_robot(report, filtered_);
  if (options_.saves.filtered)
    writers_->add([to = file("filtered", report.index, ".png"), image = millimetres_of(filtered_)] {
      write_png(to, image.view());
    });
  if (!options_.saves.points) return;
  Eigen::Isometry3d T_frame_camera = Eigen::Isometry3d::Identity();
  if (!options_.points_frame.empty()) {
    const auto T = camera_in_link(report, options_.points_frame);
    if (!T) return;
    T_frame_camera = *T;
  }
  if (!cloud_maker_) cloud_maker_.emplace(camera);
  PointCloud cloud;
  cloud_maker_->make(filtered_, cloud, T_frame_camera);
  writers_->add([pcd = file("points", report.index, ".pcd"),
                 ply = file("points", report.index, ".ply"), cloud = std::move(cloud),
                 color = copy_of(painter_.seen_color(frame.color.view))] {
    const StoredCloud stored = stored_cloud(cloud, color.view());
    write_cloud(pcd, stored.cloud);
    write_cloud(ply, stored.cloud);
  });
}

template <typename T, typename Write>
void OutputFolder::write_later(fs::path file, ImageView<const T> image, Write write) {
  writers_->add(
      [file = std::move(file), copy = copy_of(image), write] { write(file, copy.view()); });
}

fs::path OutputFolder::file(const char* kind, std::size_t index, const char* ending) const {
  std::string digits = std::to_string(index);
  digits.insert(0, frame_digits - std::min(digits.size(), frame_digits), '0');
  return options_.path / kind / (digits + ending);
}

}  // namespace penumbra::io
