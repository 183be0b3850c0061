// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/base/stamps.hpp>
#include <penumbra/cloud/cloud_pipeline.hpp>
#include <penumbra/cloud/cloud_targets-inl.hpp>
#include <penumbra/poses/pose_stage-inl.hpp>
#include <penumbra/robot/drawn_links-inl.hpp>
#include <penumbra/targets/target_stage-inl.hpp>
#include <penumbra/targets/target_views-inl.hpp>

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

struct CloudPipeline::State final : SampleJudge {
  State(Robot given, const CloudConfig& cloud_config)
      : robot(std::move(given)),
        config(cloud_config),
        poses(robot, config.sensor_parent, config.T_parent_sensor, missing_links_of(robot), false),
        targets(robot, *this, std::nullopt) {
    check_is_drawn(robot);
    make_labeller();
  }

  void make_labeller();
  bool place(std::int64_t stamp, const PoseAt& pose_at);
  bool place_parts(const Scan& scan, const PoseAt& pose_at);
  [[nodiscard]] double movement() const;
  [[nodiscard]] std::string fault_of(const Scan& scan);
  bool refuse(FrameStatus status, std::string message);
  [[nodiscard]] bool is_reached(const Eigen::Vector3d& point,
                                const std::optional<Eigen::Vector3d>& origin) const;
  void take(const CloudLabels& found, const Scan& scan);
  Judgement judge(const LabelledFrame& frame, const Target& target, TargetMemory* memory,
                  const std::optional<Eigen::Vector2d>& motion) override;

  Robot robot;
  CloudConfig config;
  PoseStage poses;
  std::optional<CloudLabeller> labeller;
  std::vector<AttachedBody> carried;  // the labeller's, after the links
  std::vector<double> radii;          // of the labeller's bodies
  RobotPose pose;
  std::vector<Eigen::Isometry3d> T_sensor_body;  // of all parts
  std::vector<std::uint16_t> part_of;            // of each point; empty: one part
  std::vector<std::size_t> numbers;              // of the carried, in report.links
  std::vector<Ball> reaches;                     // where links of unknown pose can be
  std::vector<float> ranges;
  std::vector<std::uint8_t> labels;
  std::vector<std::uint16_t> links;
  bool is_labelled = false;      // not all unknown
  const Scan* judged = nullptr;  // that is judged
  PoseResult begin_poses = {};   // at the scan's begin
  TargetStage targets;
  CloudReport report;
};

void CloudPipeline::State::make_labeller() {
  std::vector<Body> bodies = bodies_of(robot);
  for (const AttachedBody& body : carried) bodies.push_back({body.name, {body.mesh.get(), 1}});
  labeller.emplace(bodies, config.rule, config.threads);
  radii.clear();
  for (const Body& body : bodies) radii.push_back(radius_of(body.meshes));
}

/// Adds the poses at a stamp to T_sensor_body. Returns false, with the fault in the report, if no
/// point can be labelled. What is attached at the scan's begin stays so.
bool CloudPipeline::State::place(std::int64_t stamp, const PoseAt& pose_at) {
  pose_at(stamp, pose);
  const bool is_begin = T_sensor_body.empty();
  if (!is_begin) pose.attached = carried;
  const PoseResult& found = poses.place(pose, stamp, FrameStatus::ok, "");
  if (is_begin) begin_poses = found;
  if (!found.known() || !found.missing_links.empty()) return refuse(found.status, found.message);
  report.status = worse(report.status, found.status);
  if (report.message.empty()) report.message = found.message;
  if (report.note.empty()) report.note = found.note;
  for (const Reach& reach : found.reaches) reaches.push_back(reach.ball);
  if (is_begin) {
    numbers.clear();
    std::vector<AttachedBody> drawn;
    for (const PlacedBody& body : found.attached) {
      numbers.push_back(body.link);
      drawn.push_back(*std::find_if(pose.attached.begin(), pose.attached.end(),
                                    [&](const auto& one) { return one.name == body.name; }));
    }
    const bool is_same = std::equal(drawn.begin(), drawn.end(), carried.begin(), carried.end(),
                                    [](const auto& a, const auto& b) { return a.mesh == b.mesh; });
    carried = std::move(drawn);
    if (!is_same) make_labeller();
  }
  if (found.attached.size() != carried.size())
    return refuse(FrameStatus::missing_link, found.message);
  T_sensor_body.insert(T_sensor_body.end(), found.T_camera_link.begin(), found.T_camera_link.end());
  for (const PlacedBody& body : found.attached) T_sensor_body.push_back(body.T_camera_body);
  return true;
}

/// Returns how far a body moves at most between two neighbours of the poses so far.
double CloudPipeline::State::movement() const {
  const std::size_t bodies = radii.size();
  double most = 0.0;
  for (std::size_t i = 0; i < bodies; ++i) {
    for (std::size_t k = i; k + bodies < T_sensor_body.size(); k += bodies) {
      const Eigen::Isometry3d moved = T_sensor_body[k].inverse() * T_sensor_body[k + bodies];
      const double chord = (moved.linear() - Eigen::Matrix3d::Identity()).norm() / std::sqrt(2.0);
      most = std::max(most, moved.translation().norm() + chord * radii[i]);
    }
  }
  return most;
}

bool CloudPipeline::State::refuse(FrameStatus status, std::string message) {
  is_labelled = false;
  report.status = status;
  report.message = std::move(message);
  return false;
}

/// Returns why no point is a measurement; empty: some are.
std::string CloudPipeline::State::fault_of(const Scan& scan) {
  const Eigen::Vector3f origin = scan.origin.value_or(Eigen::Vector3d::Zero()).cast<float>();
  constexpr std::size_t most_tested = 1000;
  const std::size_t step = std::max<std::size_t>(1, scan.points.count / most_tested);
  ranges.clear();
  for (std::size_t i = 0; i < scan.points.count; i += step)
    if (const float range = (scan.points[i] - origin).norm(); std::isfinite(range) && range > 0.0F)
      ranges.push_back(range);
  if (ranges.empty() && step > 1)
    for (std::size_t i = 0; i < scan.points.count && ranges.empty(); ++i)
      if (const float range = (scan.points[i] - origin).norm();
          std::isfinite(range) && range > 0.0F)
        ranges.push_back(range);
  if (ranges.empty())
    return scan.points.count == 0 ? "the cloud has no points"
                                  : "no point of the cloud is a measurement";
  const auto middle = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() / 2);
  std::nth_element(ranges.begin(), middle, ranges.end());
  if (*middle <= max_range || !scan.origin) return {};
  return "half of the points are more than " + std::to_string(std::lround(*middle)) +
         " m away; are their coordinates millimetres?";
}

/// Finds the poses of each part of a scan, and the part of each point. Returns as place().
bool CloudPipeline::State::place_parts(const Scan& scan, const PoseAt& pose_at) {
  T_sensor_body.clear();
  reaches.clear();
  part_of.clear();
  const auto place_at = [&](std::int64_t time) {
    return place(stamp_after(scan.stamp.value_or(0), time), pose_at);
  };
  report.parts = 1;
  const bool is_at_once = scan.times.empty() || !scan.origin;
  const std::int64_t first = is_at_once ? 0 : std::ranges::min(scan.times);
  const bool is_placed = place_at(first);
  if (!scan.times.empty() && scan.times.size() != scan.points.count)
    return refuse(FrameStatus::bad_depth, std::to_string(scan.times.size()) + " times for " +
                                              std::to_string(scan.points.count) + " points");
  if (std::string fault = fault_of(scan); !fault.empty())
    return refuse(FrameStatus::bad_depth, std::move(fault));
  if (!is_placed) return false;
  const std::int64_t length = is_at_once ? 0 : std::int64_t{std::ranges::max(scan.times)} - first;
  if (length == 0) return true;
  constexpr std::int64_t instants = 8;  // of the motion
  for (std::int64_t i = 1; i <= instants; ++i)
    if (!place_at(first + i * length / instants)) return false;
  const auto count = static_cast<std::int64_t>(std::clamp(
      std::ceil(instants * movement() / part_movement), 1.0, static_cast<double>(max_parts)));
  report.parts = static_cast<std::size_t>(count);
  const auto tried = static_cast<std::ptrdiff_t>(T_sensor_body.size());
  for (std::int64_t part = 0; part < count; ++part)
    if (!place_at(first + (2 * part + 1) * length / (2 * count))) return false;
  T_sensor_body.erase(T_sensor_body.begin(), T_sensor_body.begin() + tried);
  for (const std::int32_t time : scan.times)
    part_of.push_back(
        static_cast<std::uint16_t>(std::min(count - 1, (time - first) * count / length)));
  return true;
}

/// Whether a link of unknown pose may be at a point, or, of a point with a ray, be mixed into it.
bool CloudPipeline::State::is_reached(const Eigen::Vector3d& point,
                                      const std::optional<Eigen::Vector3d>& origin) const {
  const CloudRule& rule = config.rule;
  return std::any_of(reaches.begin(), reaches.end(), [&](const Ball& ball) {
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
void CloudPipeline::State::take(const CloudLabels& found, const Scan& scan) {
  const std::size_t robot_links = robot.links().size();
  if (found.enclosing) {
    const std::size_t body = *found.enclosing;
    const std::string& name =
        body < robot_links ? robot.links()[body] : carried[body - robot_links].name;
    refuse(FrameStatus::missing_transform,
           "the sensor's centre lies inside link '" + name +
               "', or less than 2 cm from it: correct the sensor's pose, or name the link in "
               "ignore_links if it is the sensor's own housing");
    return;
  }
  labels = found.labels;
  links = found.links;
  if (!numbers.empty())
    for (std::uint16_t& link : links)
      if (link > robot_links)
        link = static_cast<std::uint16_t>(numbers[link - 1 - robot_links] + 1);
  if (reaches.empty()) return;
  for (std::size_t i = 0; i < scan.points.count; ++i) {
    if (!is_reached(scan.points[i].cast<double>(), scan.origin)) continue;
    labels[i] = unknown_label;
    links[i] = 0;
  }
}

Judgement CloudPipeline::State::judge(const LabelledFrame& frame, const Target& target,
                                      TargetMemory* memory,
                                      const std::optional<Eigen::Vector2d>& /*motion*/) {
  if (!is_labelled) throw InputError(frame.fault());
  if (!judged->origin) throw InputError("clouds without rays do not show what is hidden");
  const auto at = placement_of(target.shape).value_or(ShapePlacement());
  TargetMemory none;
  return cloud::judge_on_rays(
      {judged->points, *judged->origin, labels, links, poses.links().size(), config.rule.tolerance},
      target, frame.poses->T_root_camera.inverse() * pose_of(at.frame, *frame.poses, robot),
      memory != nullptr ? *memory : none);
}

CloudPipeline::CloudPipeline(Robot robot, const CloudConfig& config)
    : state_(std::make_unique<State>(std::move(robot), config)) {}
CloudPipeline::~CloudPipeline() = default;
CloudPipeline::CloudPipeline(CloudPipeline&&) noexcept = default;
CloudPipeline& CloudPipeline::operator=(CloudPipeline&&) noexcept = default;

void CloudPipeline::set_rule(const CloudRule& rule) {
  state_->labeller->set_rule(rule);
  state_->config.rule = rule;
}

const Robot& CloudPipeline::robot() const { return state_->robot; }

const CloudReport& CloudPipeline::process(const Scan& scan, const PoseAt& pose_at) {
  State& s = *state_;
  s.report = CloudReport();
  s.report.stamp = scan.stamp;
  s.is_labelled = true;
  s.labels.assign(scan.points.count, unknown_label);
  s.links.assign(scan.points.count, 0);
  if (s.place_parts(scan, pose_at))
    s.take(scan.origin ? s.labeller->label(scan.points, *scan.origin, s.T_sensor_body, s.part_of)
                       : s.labeller->label(scan.points, s.T_sensor_body),
           scan);
  for (const std::uint8_t label : s.labels) ++s.report.points[label];
  s.report.labels = s.labels;
  s.report.point_links = s.links;
  s.report.links = s.poses.links();
  if (s.T_sensor_body.size() >= s.robot.links().size())
    s.report.T_sensor_link = std::span(s.T_sensor_body).first(s.robot.links().size());
  s.judged = &scan;
  s.begin_poses.stamp = scan.stamp;
  const LabelledFrame frame{
      .poses = &s.begin_poses, .status = s.report.status, .message = s.report.message};
  s.targets.judge(scan.targets, frame);
  s.targets.track(scan.targets, frame);
  s.report.targets = s.targets.reports();
  return s.report;
}

}  // namespace penumbra
