// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/base/stamps.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/pipeline/scan_labeller-inl.hpp>
#include <penumbra/robot/drawn_links.hpp>

namespace penumbra {
namespace {

constexpr auto unknown_label = static_cast<std::uint8_t>(Label::unknown);
/// Metres that a robot may move within a part of a scan. Outlines are then wrong by half of it,
/// which the beam of a point covers from 1.7 m on.
constexpr double part_movement = 0.01;

/// Returns how far the points of a mesh may be from its frame's origin.
double radius_of(std::span<const PreparedMesh> meshes) {
  double radius = 0.0;
  for (const PreparedMesh& mesh : meshes)
    radius = std::max(radius,
                      mesh.bounds.min().cwiseAbs().cwiseMax(mesh.bounds.max().cwiseAbs()).norm());
  return radius;
}

}  // namespace

ScanLabeller::ScanLabeller(const Robot& robot, const CloudConfig& config)
    : robot_(robot),
      config_(config),
      recent_(span_nanoseconds(config.target_history, "target_history")) {
  check_is_drawn(robot_);
  make_labeller();
}

void ScanLabeller::make_labeller() {
  std::vector<Body> bodies = bodies_of(robot_);
  for (const AttachedBody& body : carried_) bodies.push_back({body.name, {body.mesh.get(), 1}});
  labeller_.emplace(bodies, config_.rule, config_.threads);
  radii_.clear();
  for (const Body& body : bodies) radii_.push_back(radius_of(body.meshes));
}

/// Adds the poses at a time after the frame's stamp to T_sensor_body_. Returns false, with the
/// fault, if no point can be labelled. What is attached at the scan's begin stays so.
bool ScanLabeller::place(const Frame& frame, std::int64_t after, PoseStage& poses) {
  const std::int64_t stamp = stamp_after(frame.stamp.value_or(0), after);
  if (frame.pose_at)
    frame.pose_at(stamp, pose_);
  else
    pose_ = frame.pose;
  const bool is_begin = T_sensor_body_.empty();
  if (!is_begin) pose_.attached = carried_;
  const PoseResult& found = poses.place(pose_, stamp, frame.source_status, frame.source_message);
  if (is_begin) begin_ = found;
  if (!found.known() || !found.missing_links.empty()) return refuse(found.status, found.message);
  now_.status = worse(now_.status, found.status);
  if (now_.message.empty()) now_.message = found.message;
  for (const Reach& reach : found.reaches) reaches_.push_back(reach.ball);
  if (is_begin) {
    numbers_.clear();
    std::vector<AttachedBody> drawn;
    for (const PlacedBody& body : found.attached) {
      numbers_.push_back(body.link);
      drawn.push_back(*std::find_if(pose_.attached.begin(), pose_.attached.end(),
                                    [&](const auto& one) { return one.name == body.name; }));
    }
    const bool is_same = std::equal(drawn.begin(), drawn.end(), carried_.begin(), carried_.end(),
                                    [](const auto& a, const auto& b) { return a.mesh == b.mesh; });
    carried_ = std::move(drawn);
    if (!is_same) make_labeller();
  }
  if (found.attached.size() != carried_.size())
    return refuse(FrameStatus::missing_link, found.message);
  T_sensor_body_.insert(T_sensor_body_.end(), found.T_camera_link.begin(),
                        found.T_camera_link.end());
  for (const PlacedBody& body : found.attached) T_sensor_body_.push_back(body.T_camera_body);
  return true;
}

/// Returns how far a body moves at most between two neighbours of the poses so far.
double ScanLabeller::movement() const {
  const std::size_t bodies = radii_.size();
  double most = 0.0;
  for (std::size_t i = 0; i < bodies; ++i) {
    for (std::size_t k = i; k + bodies < T_sensor_body_.size(); k += bodies) {
      const Eigen::Isometry3d moved = T_sensor_body_[k].inverse() * T_sensor_body_[k + bodies];
      const double chord = (moved.linear() - Eigen::Matrix3d::Identity()).norm() / std::sqrt(2.0);
      most = std::max(most, moved.translation().norm() + chord * radii_[i]);
    }
  }
  return most;
}

bool ScanLabeller::refuse(FrameStatus status, std::string message) {
  now_.are_known = false;
  now_.status = status;
  now_.message = std::move(message);
  return false;
}

/// Returns why no point is a measurement; empty: some are.
std::string ScanLabeller::fault_of(const Scan& scan) {
  const Eigen::Vector3f origin = scan.origin.value_or(Eigen::Vector3d::Zero()).cast<float>();
  constexpr std::size_t most_tested = 1000;
  const std::size_t step = std::max<std::size_t>(1, scan.points.count / most_tested);
  ranges_.clear();
  for (std::size_t i = 0; i < scan.points.count; i += step)
    if (const float range = (scan.points[i] - origin).norm(); std::isfinite(range) && range > 0.0F)
      ranges_.push_back(range);
  if (ranges_.empty() && step > 1)
    for (std::size_t i = 0; i < scan.points.count && ranges_.empty(); ++i)
      if (const float range = (scan.points[i] - origin).norm();
          std::isfinite(range) && range > 0.0F)
        ranges_.push_back(range);
  if (ranges_.empty())
    return scan.points.count == 0 ? "the cloud has no points"
                                  : "no point of the cloud is a measurement";
  const auto middle = ranges_.begin() + static_cast<std::ptrdiff_t>(ranges_.size() / 2);
  std::nth_element(ranges_.begin(), middle, ranges_.end());
  if (*middle <= CloudConfig::max_range || !scan.origin) return {};
  return "half of the points are more than " + std::to_string(std::lround(*middle)) +
         " m away; are their coordinates millimetres?";
}

/// Finds the poses of each part of a scan, and the part of each point. Returns as place().
bool ScanLabeller::place_parts(const Frame& frame, PoseStage& poses) {
  const Scan& scan = now_.scan;
  T_sensor_body_.clear();
  reaches_.clear();
  part_of_.clear();
  const auto place_at = [&](std::int64_t time) { return place(frame, time, poses); };
  parts_ = 1;
  const bool is_at_once = scan.times.empty() || !scan.origin;
  const std::int64_t first = is_at_once ? 0 : std::ranges::min(scan.times);
  if (!place_at(first)) return false;
  if (frame.source_status != FrameStatus::ok) return refuse(begin_.status, begin_.message);
  if (!frame.scan) return refuse(FrameStatus::missing_depth, "the frame has no scan");
  if (!scan.times.empty() && scan.times.size() != scan.points.count)
    return refuse(FrameStatus::bad_depth, std::to_string(scan.times.size()) + " times for " +
                                              std::to_string(scan.points.count) + " points");
  if (std::string fault = fault_of(scan); !fault.empty())
    return refuse(FrameStatus::bad_depth, std::move(fault));
  const std::int64_t length = is_at_once ? 0 : std::int64_t{std::ranges::max(scan.times)} - first;
  if (length == 0) return true;
  constexpr std::int64_t instants = 8;  // of the motion
  for (std::int64_t i = 1; i <= instants; ++i)
    if (!place_at(first + i * length / instants)) return false;
  const auto count =
      static_cast<std::int64_t>(std::clamp(std::ceil(instants * movement() / part_movement), 1.0,
                                           static_cast<double>(CloudConfig::max_parts)));
  const auto tried = static_cast<std::ptrdiff_t>(T_sensor_body_.size());
  for (std::int64_t part = 0; part < count; ++part)
    if (!place_at(first + (2 * part + 1) * length / (2 * count))) return false;
  parts_ = static_cast<std::size_t>(count);
  T_sensor_body_.erase(T_sensor_body_.begin(), T_sensor_body_.begin() + tried);
  for (const std::int32_t time : scan.times)
    part_of_.push_back(
        static_cast<std::uint16_t>(std::min(count - 1, (time - first) * count / length)));
  return true;
}

/// Whether a link of unknown pose may be at a point, or, of a point with a ray, be mixed into it.
bool ScanLabeller::is_reached(const Eigen::Vector3d& point,
                              const std::optional<Eigen::Vector3d>& origin) const {
  const CloudRule& rule = config_.rule;
  return std::any_of(reaches_.begin(), reaches_.end(), [&](const Ball& ball) {
    const Eigen::Vector3d from = origin.value_or(ball.centre);
    const Eigen::Vector3d to_centre = ball.centre - from, ray = point - from;
    const double distance = to_centre.norm(), range = ray.norm();
    const double radius = ball.radius + rule.tolerance.at(distance) + rule.beam * distance;
    if ((point - ball.centre).norm() <= radius) return true;
    if (!origin || range < distance) return false;
    const double across = to_centre.cross(ray).norm() / range;
    return across <= radius && range <= distance + radius + rule.mixing && to_centre.dot(ray) > 0;
  });
}

/// Takes the labels, with what is attached by its number in the report.
void ScanLabeller::take(const CloudLabels& found) {
  const std::size_t robot_links = robot_.links().size();
  if (found.enclosing) {
    const std::size_t body = *found.enclosing;
    const std::string& name =
        body < robot_links ? robot_.links()[body] : carried_[body - robot_links].name;
    refuse(FrameStatus::missing_transform,
           "the sensor's centre lies inside link '" + name +
               "', or less than 2 cm from it: correct the sensor's pose, or name the link in "
               "ignore_links if it is the sensor's own housing");
    return;
  }
  now_.labels = found.labels;
  now_.links = found.links;
  if (!numbers_.empty())
    for (std::uint16_t& link : now_.links)
      if (link > robot_links)
        link = static_cast<std::uint16_t>(numbers_[link - 1 - robot_links] + 1);
  if (reaches_.empty()) return;
  const Scan& scan = now_.scan;
  for (std::size_t i = 0; i < scan.points.count; ++i) {
    if (!is_reached(scan.points[i].cast<double>(), scan.origin)) continue;
    now_.labels[i] = unknown_label;
    now_.links[i] = 0;
  }
}

void ScanLabeller::set_rule(const CloudRule& rule) {
  labeller_->set_rule(rule);
  config_.rule = rule;
}

void ScanLabeller::begin(const LabelledFrame& frame) {
  if (config_.target_history == 0.0 || !frame.stamp()) return;
  Labels& kept = recent_.at(*frame.stamp());
  kept = now_;
  kept.scan = copy_of(now_.scan);
}

const LabelledFrame& ScanLabeller::earlier(std::int64_t stamp, const PoseResult* poses) {
  if (config_.target_history == 0.0)
    throw InputError("its stamp is not the scan's, and no scans are stored (target_history)");
  const Labels* const kept = recent_.find(stamp);
  if (kept == nullptr || poses == nullptr) throw InputError("no scan of its stamp is stored");
  return late_ = frame_of(*kept, *poses);
}

LabelledFrame ScanLabeller::frame_of(const Labels& scan, const PoseResult& poses) {
  LabelledFrame frame{
      .poses = &poses, .status = scan.status, .message = scan.message, .scan = &scan.scan};
  const auto row = []<typename T>(const std::vector<T>& values) {
    const int width = static_cast<int>(values.size());
    return ImageView<const T>{values.data(), width, 1, width};
  };
  frame.labels.labels = row(scan.labels);
  for (const std::uint8_t label : scan.labels) ++frame.labels.pixels[label];
  frame.images.virtual_depth.links = row(scan.links);
  frame.images.link_names = poses.links;
  if (!poses.reaches.empty()) frame.images.fault = frame.fault();
  if (!scan.are_known) return frame;
  frame.images.labels = frame.labels;
  frame.images.labels.pixels[unknown_label] = 0;  // they need not be the robot's
  return frame;
}

LabelledFrame ScanLabeller::label(const Frame& frame, PoseStage& poses) {
  const Scan scan = frame.scan.value_or(Scan());
  const std::size_t count = scan.points.count;
  if (count > std::numeric_limits<int>::max())
    throw InputError("a scan of " + std::to_string(count) + " points is too large");
  now_.scan = scan;
  now_.status = FrameStatus::ok;
  now_.message.clear();
  now_.are_known = true;
  now_.labels.assign(count, unknown_label);
  now_.links.assign(count, 0);
  bool is_placed = false;
  {
    const StageTimer timer(begin_.kinematics_ms);
    is_placed = place_parts(frame, poses);
  }
  std::optional<double> classify_ms;
  if (is_placed) {
    const StageTimer timer(classify_ms);
    take(scan.origin ? labeller_->label(scan.points, *scan.origin, T_sensor_body_, part_of_)
                     : labeller_->label(scan.points, T_sensor_body_));
  }
  begin_.stamp = frame.stamp;
  if (!has_pose(now_.status)) begin_.status = now_.status;  // unknown in a part is unknown
  LabelledFrame out = frame_of(now_, begin_);
  out.classify_ms = classify_ms;
  out.parts = parts_;
  return out;
}

// Here, so that a program that reads no scans need not be linked with their labels.
Pipeline::Pipeline(const Robot& robot, const CloudConfig& config)
    : Pipeline(robot, config.sensor_parent, config.T_parent_sensor,
               std::make_unique<ScanLabeller>(robot, config)) {}

}  // namespace penumbra
