// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <thread>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file-inl.hpp>

#include <io/cloud/cloud_file.hpp>
#include <io/files/json.hpp>
#include <io/files/npy.hpp>
#include <io/files/overlay_painter.hpp>
#include <io/files/png.hpp>
#include <io/outputs/output_bag.hpp>
#include <io/outputs/output_folder.hpp>
#include <io/web/report_page.hpp>

namespace penumbra::io {
namespace {

namespace fs = std::filesystem;

enum class Kind { vdi, labels, links, robot_mask, overlay, filtered, pcd, ply };

struct ImageKind {
  const char* pattern;
  bool Saves::*wanted;
};
constexpr std::array<ImageKind, 8> image_kinds{{{"vdi/%06d.npy", &Saves::vdi},
                                                {"labels/%06d.png", &Saves::labels},
                                                {"links/%06d.png", &Saves::links},
                                                {"robot_mask/%06d.png", &Saves::robot_mask},
                                                {"overlay/%06d.png", &Saves::overlay},
                                                {"filtered/%06d.png", &Saves::filtered},
                                                {"points/%06d.pcd", &Saves::points},
                                                {"points/%06d.ply", &Saves::points}}};  // by Kind

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

/// Returns the file of a frame for writing.
fs::path file(ResultFolder& folder, Kind kind, std::size_t index) {
  return folder.frame_file(static_cast<std::size_t>(kind), static_cast<std::int64_t>(index));
}

}  // namespace

ResultFolderOptions run_results(const OutputOptions& options) {
  ResultFolderOptions results{
      .path = options.path,
      .report = {"report.json", std::string(report_json_start)},
      .others = {{"report.html", page_begin, options.report_page},
                 {"links.json", "{\n", options.saves.links}},
      .force = options.force,
      .advice = "choose another folder with -o, or write into this one with --force"};
  for (const ImageKind& kind : image_kinds)
    results.frames.push_back(
        {FramePattern(kind.pattern, options.path), options.saves.*kind.wanted});
  return results;
}

OutputFolder::OutputFolder(const OutputOptions& options, ResultFolder& folder,
                           const Pipeline& pipeline)
    : options_(options),
      folder_(folder),
      camera_(pipeline.report_camera()),
      painter_(pipeline.robot(), camera_, pipeline.rectification()),
      writers_(writers_of(options_)) {
  folder.begin();
}

void OutputFolder::begin(const ReportHead& head) {
  folder_.add("report.json", [&](const fs::path& part) {
    report_file_ = part;
    report_.emplace(part, report_start(head));
  });
  missing_links_.assign(head.missing_links.begin(), head.missing_links.end());
  notes_.assign(head.notes.begin(), head.notes.end());
  if (!options_.saves.links) return;
  Json links = Json::object();
  for (std::size_t i = 0; i < head.links.size(); ++i)
    links[std::to_string(i + 1)] = {{"link", head.links[i]}};
  folder_.add_text("links.json", links.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

void OutputFolder::finish(const Statistics& statistics, std::span<const std::string> notes) {
  writers_.finish();
  notes_.insert(notes_.end(), notes.begin(), notes.end());
  report_->finish(report_end(statistics, missing_links_, notes_));
  const std::string fault = options_.report_page ? add_page() : std::string();
  folder_.finish();
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
                                              key_frames_.pictures()));
  return {};
}

void OutputFolder::take(const Frame& frame, const FrameReport& report) {
  report_->add(report_frame(report));
  const VirtualDepthView& virtual_depth = report.virtual_depth;
  const std::size_t index = report.index;
  const auto plain_png = [](const auto& to, const auto& image) { write_png(to, image); };
  const auto plain_npy = [](const auto& to, const auto& image) { write_npy(to, image); };
  if (options_.saves.vdi && !virtual_depth.depth.empty())
    write_later(file(folder_, Kind::vdi, index), virtual_depth.depth, plain_npy);
  if (options_.saves.links && !virtual_depth.links.empty())
    write_later(file(folder_, Kind::links, index), virtual_depth.links, plain_png);
  if (options_.saves.robot_mask && !virtual_depth.links.empty())
    writers_.add([to = file(folder_, Kind::robot_mask, index), mask = robot_mask(virtual_depth)] {
      write_png(to, mask.view());
    });
  if (options_.saves.labels)
    write_later(file(folder_, Kind::labels, index), report.labels,
                [](const auto& to, const auto& image) { write_png(to, image, label_palette()); });
  if (options_.saves.filtered || options_.saves.points) save_without_robot(frame, report);
  if (!options_.saves.overlay && !options_.report_page) return;
  const auto overlay = painter_.draw(frame, report);
  if (options_.saves.overlay) write_later(file(folder_, Kind::overlay, index), overlay, plain_png);
  if (options_.report_page) key_frames_.add(report, overlay);
}

void OutputFolder::save_without_robot(const Frame& frame, const FrameReport& report) {
  without_robot(report, filtered_);
  if (options_.saves.filtered)
    writers_.add([to = file(folder_, Kind::filtered, report.index),
                  image = millimetres_of(filtered_)] { write_png(to, image.view()); });
  if (!options_.saves.points) return;
  Eigen::Isometry3d T_frame_camera = Eigen::Isometry3d::Identity();
  if (!options_.points_frame.empty()) {
    const auto T = camera_in_link(report, options_.points_frame);
    if (!T) return;
    T_frame_camera = *T;
  }
  if (!cloud_maker_) cloud_maker_.emplace(camera_);
  PointCloud cloud;
  cloud_maker_->make(filtered_, cloud, T_frame_camera);
  writers_.add([pcd = file(folder_, Kind::pcd, report.index),
                ply = file(folder_, Kind::ply, report.index), cloud = std::move(cloud),
                color = copy_of(painter_.seen_color(frame.color.view))] {
    const StoredCloud stored = stored_cloud(cloud, color.view());
    write_cloud(pcd, stored.cloud);
    write_cloud(ply, stored.cloud);
  });
}

template <typename T, typename Write>
void OutputFolder::write_later(fs::path file, ImageView<const T> image, Write write) {
  writers_.add(
      [file = std::move(file), copy = copy_of(image), write] { write(file, copy.view()); });
}

void check_output_place(const std::filesystem::path& of, const std::filesystem::path& output) {
  std::error_code error;
  const std::filesystem::path input = std::filesystem::absolute(of);
  if (is_output_bag(output)) {
    if (std::filesystem::equivalent(output, input, error))
      throw InputError("--output: " + output.string() + " is the input; choose another name");
    return check_former_bag(output);
  }
  const bool is_own = std::filesystem::equivalent(output, input, error) ||
                      (std::filesystem::is_regular_file(input, error) &&
                       std::filesystem::equivalent(output, input.parent_path(), error));
  if (is_own)
    throw InputError("--output: " + output.string() +
                     " is the recording's own folder; choose another, or one inside of it");
  if (std::filesystem::exists(output / "recording.yaml", error))
    throw InputError("--output: " + output.string() +
                     " is a recording (it has a recording.yaml); choose another folder");
}

bool is_output_bag(const std::filesystem::path& output) { return output.extension() == ".mcap"; }

}  // namespace penumbra::io
