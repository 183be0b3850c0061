// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>
#include <utility>

#include <io/files/image_size.hpp>
#include <io/files/jpeg.hpp>
#include <io/files/json.hpp>
#include <io/web/frame_store.hpp>
#include <io/web/scene.hpp>

namespace penumbra::io {
namespace {

constexpr int jpeg_quality = 90;

double tenth(double pixels) { return std::round(10.0 * pixels) / 10.0; }

/// "marks": [{"outline": [[u, v, u, v...]...], "place": [u, v] or null}...], one for each target of
/// the report.
std::string marks_json(std::span<const TargetMark> marks) {
  Json json = Json::array();
  for (const TargetMark& mark : marks) {
    Json outline = Json::array();
    for (const PixelPath& path : mark.outline) {
      Json line = Json::array();
      for (const Eigen::Vector2d& p : path)
        for (const double pixels : {p.x(), p.y()}) line.push_back(tenth(pixels));
      outline.push_back(std::move(line));
    }
    Json place;
    if (mark.place) place = {tenth(mark.place->x()), tenth(mark.place->y())};
    json.push_back({{"outline", std::move(outline)}, {"place", std::move(place)}});
  }
  return "\"marks\": " + json_text(json);
}

}  // namespace

FrameStore::FrameStore(const Pipeline& pipeline, const ReportHead& head)
    : pipeline_(pipeline),
      missing_links_(head.missing_links.begin(), head.missing_links.end()),
      notes_(head.notes.begin(), head.notes.end()),
      text_(report_start(head)),
      head_size_(text_.size()) {}

void FrameStore::take(const Frame& frame, const FrameReport& report) {
  Entry entry;
  const std::string text = report_frame(report);
  std::string poses = poses_json(report.T_root_link, report.T_root_camera, report.links.size());
  if (!frame.scan)
    poses += ", " + marks_json(target_overlay_.marks(frame.targets, report, pipeline_.robot(),
                                                     pipeline_.report_camera()));
  entry.poses = spool_.append(std::as_bytes(std::span(poses)), true);
  if (frame.scan)
    add_points(report, *frame.scan, entry);
  else
    add_images(report, frame, entry);
  if (outlines_ != nullptr) entry.pose = frame.pose;
  add(std::move(entry), text);
  if (frame.color_message.empty()) return;
  const std::lock_guard lock(mutex_);
  if (without_color_++ == 0) first_without_color_ = frame.color_message;
}

void FrameStore::add(Entry entry, const std::string& text) {
  const std::lock_guard lock(mutex_);
  text_ += entries_.empty() ? "\n" : ",\n";
  entry.report_offset = text_.size();
  entry.report_size = text.size();
  text_ += text;
  entries_.push_back(std::move(entry));
}

void FrameStore::add_points(const FrameReport& report, const Scan& scan, Entry& entry) {
  const PartBytes cloud = cloud_part(scan.points, report.labels);
  entry.parts[static_cast<std::size_t>(Part::cloud)] = {
      spool_.append(std::as_bytes(std::span(*cloud.bytes)), true), "xyzlrgb", cloud.width,
      cloud.height};
}

void FrameStore::add_images(const FrameReport& report, const Frame& frame, Entry& entry) {
  const auto at = [&](Part part) -> Kept& { return entry.parts[static_cast<std::size_t>(part)]; };
  at(Part::labels) = keep(report.labels, "u8");
  at(Part::links) = keep(report.virtual_depth.links, "u16");
  at(Part::vdi) = keep(report.virtual_depth.depth, "f32");
  at(Part::depth) = keep_depth(frame.depth.view);
  at(Part::color) = keep_color(frame);
}

template <typename T>
FrameStore::Kept FrameStore::keep(ImageView<const T> image, const char* type) {
  if (image.empty()) return {};
  const std::size_t row = sizeof(T) * static_cast<std::size_t>(image.width);
  pixels_.resize(row * static_cast<std::size_t>(image.height));
  for (int v = 0; v < image.height; ++v)
    std::memcpy(pixels_.data() + row * static_cast<std::size_t>(v), image.row(v), row);
  return {spool_.append(std::as_bytes(std::span(pixels_)), true), type, image.width, image.height};
}

FrameStore::Kept FrameStore::keep_depth(const DepthView& depth) {
  if (is_empty(depth)) return {};
  std::visit([&](const auto& image) { fill_metres(image, metres_); }, depth);
  return keep(rectified(pipeline_.rectification(), std::as_const(metres_).view(), rectified_),
              "f32");
}

FrameStore::Kept FrameStore::keep_color(const Frame& frame) {
  const auto image = rectified(pipeline_.rectification(), frame.color.view, color_);
  if (image.empty()) return {};
  encode_jpeg(image, jpeg_quality, file_);
  return {spool_.append(file_, false), "image/jpeg", image.width, image.height};
}

void FrameStore::finish(const Statistics& statistics, std::span<const std::string> notes) {
  notes_.insert(notes_.end(), notes.begin(), notes.end());
  const std::lock_guard lock(mutex_);
  end_ = report_end(statistics, missing_links_, notes_);
}

std::size_t FrameStore::size() const {
  const std::lock_guard lock(mutex_);
  return entries_.size();
}

bool FrameStore::is_complete() const {
  const std::lock_guard lock(mutex_);
  return !end_.empty();
}

SharedBytes FrameStore::report(std::size_t from) const {
  const std::lock_guard lock(mutex_);
  const std::string_view text(text_);
  std::string report(text.substr(0, head_size_));
  if (from < entries_.size()) {
    report += '\n';
    report += text.substr(entries_[from].report_offset);
  }
  return shared_bytes(report + (end_.empty() ? unfinished_report_end() : end_));
}

std::optional<PacketFrame> FrameStore::frame(std::size_t i) const {
  std::unique_lock lock(mutex_);
  if (i >= entries_.size()) return std::nullopt;
  const Entry entry = entries_[i];
  std::string report = text_.substr(entry.report_offset, entry.report_size);
  lock.unlock();
  return PacketFrame{
      std::move(report), spool_.read(entry.poses),
      [this, parts = entry.parts, pose = entry.pose](Part part) -> std::optional<PartBytes> {
        if (part == Part::outlines && outlines_ != nullptr)
          return outlines_->draw(pose, calibration_->progress());
        const Kept& kept = parts[static_cast<std::size_t>(part)];
        if (kept.type == nullptr) return std::nullopt;
        return PartBytes{kept.type, kept.width, kept.height, shared_bytes(spool_.read(kept.place))};
      }};
}

std::vector<std::string> FrameStore::missing() const {
  std::vector<std::string> lines;
  const std::lock_guard lock(mutex_);
  for (const std::string& link : missing_links_)
    lines.push_back("link " + link + " is drawn without its geometry, which could not be read");
  if (without_color_ > 0)
    lines.push_back("no colour in " + std::to_string(without_color_) +
                    " frames, first: " + first_without_color_);
  return lines;
}

}  // namespace penumbra::io
