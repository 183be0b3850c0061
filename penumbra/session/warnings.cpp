// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include <penumbra/base/stamps.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/session/scan_image-inl.hpp>
#include <penumbra/session/warnings.hpp>

namespace penumbra {
namespace {

bool is_beyond(const Joint& joint, std::span<const double> positions) {
  // A <limit> without lower and upper has 0 for both by the format, and means no range.
  if (!joint.variable || !joint.lower || !joint.upper || *joint.lower == *joint.upper) return false;
  const double slack =
      joint.type == JointType::prismatic ? Warnings::prismatic_slack : Warnings::revolute_slack;
  const double position = joint.multiplier * positions[*joint.variable] + joint.offset;
  return position < *joint.lower - slack || position > *joint.upper + slack;
}

std::string counted(std::size_t n, const std::string& thing) {
  return std::to_string(n) + " " + thing + (n == 1 ? "" : "s");
}

std::string percent_of(std::size_t part, std::size_t whole) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f %%",
                100.0 * static_cast<double>(part) / static_cast<double>(whole));
  return text.data();
}

bool exceeds(std::size_t part, double share, std::size_t whole) {
  return static_cast<double>(part) > share * static_cast<double>(whole);
}

}  // namespace

Warnings::Warnings(const Robot& robot)
    : robot_(robot), frames_beyond_(robot.joints().size()), frames_near_(robot.links().size()) {}

Warnings::Warnings(const Pipeline& pipeline, const Camera& camera, const PipelineConfig& config)
    : Warnings(pipeline.robot()) {
  has_depth_ = config.has_depth;
  const std::size_t parent = find_camera_parent(robot_, camera.parent);
  sensor_.emplace(
      Sensor{.setup = has_depth_ ? SetupCheck(robot_, pipeline.report_camera(), parent)
                                 : SetupCheck(robot_, camera, parent, SetupCheck::Images::color),
             .image = config.image,
             .fringe_reach = pipeline.rule().fringe_reach});
}

void Warnings::add(const FrameReport& report, const Frame& frame) {
  const std::span<const double> positions = frame.pose.positions;
  is_scanner_ = report.parts > 0;
  if (report.pixels.robot) {
    ++posed_frames_;
    robot_seen_ = robot_seen_ || *report.pixels.robot > 0;
    if (is_scanner_ && has_depth(report.status)) ++labelled_scans_;
    if (has_depth_ && (sensor_ || is_scanner_) &&
        (has_depth(report.status) || report.nothing_measured)) {
      robot_pixels_ += *report.pixels.robot;
      const PixelCounts& pixels = report.pixels;
      measured_ += pixels.front + pixels.occluded + pixels.beyond;
      front_ += pixels.front;
      beyond_ += pixels.beyond;
    }
  }
  for (const std::size_t link : report.near_links) ++frames_near_[link];
  uncovered_ = std::max(uncovered_, report.pixels.uncovered);
  if (body_note_.empty()) body_note_ = report.note;
  if (frame.plan && frame.plan != plan_ && plan_notes_.empty()) plan_notes_ = frame.plan->notes();
  plan_ = frame.plan;
  add_targets(report);
  add_stamp(report);
  if (sensor_ && !is_scanner_) {
    sensor_->setup.add(report, positions, nullptr, frame.color.view);
    diagnosis_.reset();
  }
  if (positions.size() != robot_.variables().size()) return;
  for (std::size_t i = 0; i < frames_beyond_.size(); ++i)
    if (is_beyond(robot_.joints()[i], positions)) ++frames_beyond_[i];
}

void Warnings::add(ScanImage& image) {
  if (!sensor_)
    sensor_.emplace(Sensor{
        .setup = SetupCheck(robot_, image.camera(), image.parent(), SetupCheck::Images::scans),
        .image = ImageSpace::raw,
        .fringe_reach = 0});
  sensor_->setup.add(image.report(), image.positions(), [&] { image.draw(); });
  diagnosis_.reset();
}

void Warnings::add_stamp(const FrameReport& report) {
  if (!report.stamp) return;
  if (last_stamp_ && *report.stamp <= *last_stamp_) {
    if (!first_late_) first_late_ = {report.index, *report.stamp, *last_stamp_};
    ++late_stamps_;
  } else if (last_stamp_) {
    longest_period_ = std::max(longest_period_, stamp_distance(*report.stamp, *last_stamp_));
  }
  last_stamp_ = report.stamp;
}

/// Called before add_stamp().
void Warnings::add_targets(const FrameReport& report) {
  if (report.targets.empty()) return;
  for (const TargetReport& target : report.targets)
    if (!target.note.empty() && target_notes_.size() < most_target_notes)
      target_notes_.try_emplace(std::string(target.name), target.note);
  if (report.stamp && last_stamp_ && is_clock_jump(*report.stamp, *last_stamp_)) ++forgotten_;
  if (std::any_of(report.targets.begin(), report.targets.end(),
                  [](const TargetReport& target) { return target.wants_stamp; }))
    ++not_handled_;
}

std::vector<std::string> Warnings::lines() const {
  static_assert(DepthRenderer::near_plane == 0.01, "the 1 cm below");
  std::vector<std::string> lines;
  if (!has_depth_)
    lines.emplace_back(
        "no depth camera: verdicts come from the robot's model alone; what other things hide is "
        "not "
        "known");
  const Diagnosis& found = diagnosis();
  // Without a robot in view, or depth on it, no setup explains anything.
  const bool shows_robot =
      robot_seen_ && (robot_pixels_ == 0 || exceeds(measured_, nearly_none, robot_pixels_));
  const bool has_cause = found.cause != Diagnosis::Cause::none &&
                         (shows_robot || found.cause != Diagnosis::Cause::unexplained);
  if (!body_note_.empty()) lines.push_back(body_note_);
  if (has_cause && (body_note_.empty() || found.cause != Diagnosis::Cause::unexplained))
    lines.push_back(found.message);
  const bool is_named = has_cause || !body_note_.empty();
  if (!is_named && labelled_scans_ > 0) add_scan_lines(lines);
  if (!is_named && !is_scanner_ && posed_frames_ > 0 && !robot_seen_)
    lines.push_back(
        std::string("the robot is ") + (posed_frames_ == 1 ? "not in the image" : "in no frame") +
        ": is the camera's pose that of the optical frame (x right, y down, z forward) in "
        "its parent link's frame (not the inverse), in metres?");
  if (std::string line = depth_line(); !is_named && !is_scanner_ && !line.empty())
    lines.push_back(std::move(line));
  if ((!sensor_ || sensor_->image == ImageSpace::raw) && uncovered_ > 0)
    lines.push_back("the lens model does not reach " + counted(uncovered_, "pixel") +
                    " of the image: unknown in labels, but 0 as without robot in virtual depth and "
                    "link images; are the distortion coefficients right?");
  for (std::size_t i = 0; i < frames_near_.size(); ++i)
    if (frames_near_[i] > 0)
      lines.push_back("part of link '" + robot_.links()[i] +
                      "' lies within 1 cm of the camera and is not drawn in " +
                      counted(frames_near_[i], "frame") +
                      ": what it hides is labelled as if it were not there");
  if (late_stamps_ > 0)
    lines.push_back(counted(late_stamps_, "stamp") +
                    " not after the frame's before, first in frame " +
                    std::to_string(first_late_->index) + " (" + std::to_string(first_late_->stamp) +
                    " ns after " + std::to_string(first_late_->before) +
                    " ns): are frames doubled or out of order?");
  if (longest_period_ > 0 && longest_period_ < shortest_period)
    lines.push_back("stamps rise by " + std::to_string(longest_period_) +
                    " ns at most from frame to frame: are stamps in nanoseconds?");
  if (forgotten_ > 0)
    lines.push_back("stamps went back by more than a second in " + counted(forgotten_, "frame") +
                    " with targets: earlier verdicts and tracks were forgotten");
  if (not_handled_ > 0)
    lines.push_back("targets that want handling in " + counted(not_handled_, "frame") +
                    " without a stamp: they are not handled there");
  for (const auto& [target, line] : target_notes_) lines.push_back(line);
  for (const std::string& line : plan_notes_) lines.push_back("the planned motion: " + line);
  std::string joints;
  for (std::size_t i = 0; i < frames_beyond_.size(); ++i)
    if (frames_beyond_[i] > 0)
      joints += (joints.empty() ? "joint '" : ", joint '") + robot_.joints()[i].name +
                "' beyond its limits in " + counted(frames_beyond_[i], "frame");
  if (!is_named && !joints.empty())
    lines.push_back(joints + ": are the positions in radians and metres?");
  if (!sensor_ || found.cause != Diagnosis::Cause::none || !body_note_.empty()) return lines;
  for (std::string& line : sensor_->setup.missing_parts(sensor_->fringe_reach))
    lines.push_back(std::move(line));
  return lines;
}

void Warnings::add_scan_lines(std::vector<std::string>& lines) const {
  const std::size_t on_robot = measured_ - front_;
  if (on_robot == 0)
    lines.emplace_back(
        "no point is on the robot: it is out of the sensor's view, or the sensor's pose is wrong");
  else if (poses() < KeptFrames::least && exceeds(beyond_, likely_wrong, on_robot))
    lines.push_back(
        std::to_string(
            std::lround(100.0 * static_cast<double>(beyond_) / static_cast<double>(on_robot))) +
        " % of the points in the robot's direction lie behind it, which no sensor can see: the "
        "sensor's pose, the joint positions or their stamps are wrong, or the model is larger than "
        "the robot");
}

const Diagnosis& Warnings::diagnosis() const {
  if (!diagnosis_) diagnosis_ = sensor_ ? sensor_->setup.diagnose() : Diagnosis{};
  return *diagnosis_;
}

std::string Warnings::depth_line() const {
  constexpr const char* doubt = "is depth in millimetres (16-bit PNG) or metres (float32)";
  if (robot_pixels_ == 0) return {};
  if (!exceeds(measured_, nearly_none, robot_pixels_))
    return "depth is measured on " + percent_of(measured_, robot_pixels_) +
           " of the robot's pixels: " + doubt +
           ", of the camera that is named, and within its range?";
  if (!exceeds(front_ + beyond_, most, measured_)) return {};
  return "of the robot's pixels with a measured depth " + percent_of(front_, measured_) +
         " are front and " + percent_of(beyond_, measured_) + " beyond: " + doubt +
         ", and the camera's pose right?";
}

}  // namespace penumbra
