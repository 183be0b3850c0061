// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <exception>
#include <optional>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/camera/rectification.hpp>
#include <penumbra/pipeline/frame_check-inl.hpp>
#include <penumbra/pipeline/frame_labeller-inl.hpp>
#include <penumbra/pipeline/link_poses-inl.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/pipeline/stage_timer-inl.hpp>
#include <penumbra/pipeline/target_stage-inl.hpp>
#include <penumbra/render/near_plane_check.hpp>

namespace penumbra {
namespace {

std::vector<std::string> missing_links_of(const Robot& robot) {
  std::vector<std::string> links;
  for (const LinkReport& link : robot.report())
    if (link.missing) links.push_back(link.link);
  return links;
}

/// A robot of which nothing is drawn would make every pixel look clear.
Robot drawn(Robot robot) {
  for (const LinkReport& link : robot.report())
    if (link.drawn || link.missing) return robot;
  throw InputError("robot '" + robot.name() +
                   "': no link is drawn; it needs geometry of the chosen kind that ignore_links "
                   "and only_links leave");
}

Camera checked(const Camera& camera) {
  camera.check();
  return camera;
}

std::optional<Rectification> rectification_of(const Camera& camera) {
  if (camera.distortion.is_none()) return std::nullopt;
  return std::optional<Rectification>(std::in_place, camera);
}

const Rectification* pointer_to(const std::optional<Rectification>& rectification) {
  return rectification ? &*rectification : nullptr;
}

bool by_joints_alone(const Frame& frame) {
  return frame.T_root_link.empty() && !frame.T_parent_camera;
}

Camera pinhole(const Camera& camera, const Intrinsics& intrinsics) {
  return {.intrinsics = intrinsics,
          .distortion = {},
          .range = camera.range,
          .frame_id = camera.frame_id};
}

}  // namespace

struct Pipeline::State {
  State(Robot robot_, const Camera& camera_, const PipelineConfig& config);

  [[nodiscard]] TargetStage::Setup target_setup(const PipelineConfig& config);
  void begin(const Frame& frame);
  FrameStatus pose_links(const Frame& frame);
  void add_message(const std::string& more);
  JudgedFrame label(const Frame& frame);
  void report_without_pose();
  void report_images(const JudgedImages& images);
  void judge_targets(std::span<const Target> given, const JudgedFrame& frame);

  Robot robot;
  Camera camera;
  std::optional<Rectification> rectification;  // nothing without lens distortion
  std::vector<std::string> missing_links;
  FrameCheck check;
  LinkPoses poses;
  CameraInsideCheck camera_inside;
  FrameLabeller labeller;
  std::optional<FrameLabeller> late_labeller;  // where targets may come late
  NearPlaneCheck near_plane;
  std::vector<std::uint8_t> unknown_row;  // stands for every row of an image (stride 0)
  Camera judged_camera;                   // of the report's images
  TargetStage targets;
  std::size_t calls = 0;
  FrameReport report;
};

Pipeline::State::State(Robot robot_, const Camera& camera_, const PipelineConfig& config)
    : robot(drawn(std::move(robot_))),
      camera(checked(camera_)),
      rectification(rectification_of(camera)),
      missing_links(missing_links_of(robot)),
      check(robot, camera.intrinsics.width(), camera.intrinsics.height(), rule_of(camera, config),
            missing_links),
      poses(robot, config),
      camera_inside(bodies_of(robot)),
      labeller(robot, camera, pointer_to(rectification), config),
      near_plane(labeller.render_intrinsics(), bodies_of(robot)),
      unknown_row(static_cast<std::size_t>(labeller.intrinsics().width()),
                  static_cast<std::uint8_t>(Label::unknown)),
      judged_camera(config.image == ImageSpace::raw ? camera
                                                    : pinhole(camera, labeller.intrinsics())),
      targets(target_setup(config)) {
  report.links = robot.links();
  report.missing_links = missing_links;
}

Pipeline::Pipeline(Robot robot, const Camera& camera, const PipelineConfig& config)
    : state_(std::make_unique<State>(std::move(robot), camera, config)) {}
Pipeline::~Pipeline() = default;
Pipeline::Pipeline(Pipeline&&) noexcept = default;
Pipeline& Pipeline::operator=(Pipeline&&) noexcept = default;

const Robot& Pipeline::robot() const { return state_->robot; }
const RendererInfo& Pipeline::renderer() const { return state_->labeller.renderer().info(); }
std::size_t Pipeline::triangle_count() const {
  return state_->labeller.renderer().triangle_count();
}
const LabelRule& Pipeline::rule() const { return state_->labeller.rule(); }
const Intrinsics& Pipeline::intrinsics() const { return state_->labeller.intrinsics(); }
const Rectification* Pipeline::rectification() const {
  return state_->labeller.rectifies() ? &*state_->rectification : nullptr;
}
std::span<const std::string> Pipeline::missing_links() const { return state_->missing_links; }

const FrameReport& Pipeline::process(const Frame& frame) {
  State& s = *state_;
  s.begin(frame);
  s.judge_targets(frame.targets, s.label(frame));
  return s.report;
}

void Pipeline::forget_target(std::string_view name) { state_->targets.forget(name); }
void Pipeline::forget_targets() { state_->targets.forget_all(); }

/// Poses and draws the robot and labels the frame's depth image. Reports all but the targets.
JudgedFrame Pipeline::State::label(const Frame& frame) {
  check(frame, report);
  if (has_pose(report.status)) {
    const FrameStatus fault = pose_links(frame);
    if (fault != FrameStatus::ok) report.status = fault;
  }
  JudgedFrame judged{frame.stamp, report.status, report.message, {}, {}, {}};
  if (!has_pose(report.status)) {
    report_without_pose();
    return judged;
  }
  judged.poses = {poses.T_root_link(), poses.T_camera_link(), poses.T_root_camera(), frame.doubts};
  if (has_depth(report.status)) judged.depth = frame.depth;
  report.near_links = near_plane.find(judged.poses.T_camera_link);
  judged.images = labeller.label(judged.poses.T_camera_link, judged.depth, report.timing);
  report_images(judged.images);
  return judged;
}

void Pipeline::State::begin(const Frame& frame) {
  report.index = frame.index.value_or(calls);
  ++calls;
  report.stamp = frame.stamp;
  report.joint_age = frame.joints.age;
  report.pixels = {};
  report.timing = {};
  report.virtual_depth = {};
  report.depth = {};
  report.labels = {};
  report.targets = {};
  report.T_root_camera.reset();
  report.T_root_link = {};
  report.near_links = {};
}

/// ok, or why the poses cannot be drawn; the report's message says it.
FrameStatus Pipeline::State::pose_links(const Frame& frame) {
  const StageTimer timer(report.timing.kinematics);
  const bool by_joints = by_joints_alone(frame);
  if (const auto lost = poses.update(frame)) {
    add_message((by_joints ? "joint positions put link '" : "poses put link '") +
                robot.links()[*lost] + "' more than 1000 km from the camera");
    return by_joints ? FrameStatus::missing_joints : FrameStatus::missing_transform;
  }
  if (const auto link = camera_inside.find(poses.T_camera_link())) {
    add_message("the camera's centre lies inside of link '" + robot.links()[*link] +
                "': correct the camera's pose, or name the link in ignore_links if it is the "
                "camera's own housing");
    return FrameStatus::missing_transform;
  }
  return FrameStatus::ok;
}

void Pipeline::State::add_message(const std::string& more) {
  report.message += (report.message.empty() ? "" : "; ") + more;
}

void Pipeline::State::report_without_pose() {
  const auto& uncovered = labeller.uncovered();
  const Intrinsics& size = labeller.intrinsics();
  report.labels = {unknown_row.data(), size.width(), size.height(), 0};
  report.pixels.uncovered = uncovered ? uncovered->count() : 0;
  report.pixels.unknown =
      unknown_row.size() * static_cast<std::size_t>(size.height()) - report.pixels.uncovered;
}

void Pipeline::State::report_images(const JudgedImages& images) {
  const auto count = [&](Label label) {
    return images.labels.pixels[static_cast<std::size_t>(label)];
  };
  PixelCounts& pixels = report.pixels;
  pixels.front = count(Label::front);
  pixels.occluded = count(Label::occluded);
  pixels.unknown = count(Label::unknown);
  pixels.beyond = count(Label::beyond);
  pixels.fringe = count(Label::fringe);
  pixels.uncovered = labeller.uncovered() ? labeller.uncovered()->marked() : 0;
  pixels.robot = pixels.front + pixels.occluded + pixels.unknown + pixels.beyond;
  report.virtual_depth = images.virtual_depth;
  report.depth = images.measured;
  report.labels = images.labels.labels;
  report.T_root_camera = poses.T_root_camera();
  report.T_root_link = poses.T_root_link();
}

void Pipeline::State::judge_targets(std::span<const Target> given, const JudgedFrame& frame) {
  std::optional<double> time;
  {
    const StageTimer timer(time);
    report.targets = targets.process(given, frame);
  }
  if (!given.empty()) report.timing.targets = time;
}

TargetStage::Setup Pipeline::State::target_setup(const PipelineConfig& config) {
  const bool is_reference = config.backend == Backend::reference;
  const bool is_raw = config.image == ImageSpace::raw;
  const auto& uncovered = labeller.uncovered();
  if (config.target_history > 0.0)
    late_labeller.emplace(robot, camera, pointer_to(rectification), config);
  return {.robot = robot,
          .camera = judged_camera,
          .rule = rule_of(camera, config),
          .backend = is_reference ? Backend::reference : Backend::cpu,
          .renderer = {.threads = 1, .isa = config.renderer.isa},
          .render_intrinsics = labeller.render_intrinsics(),
          .rectification = is_raw ? pointer_to(rectification) : nullptr,
          .unseen = uncovered && !is_raw ? uncovered->mask() : ImageView<const std::uint8_t>{},
          .history = config.target_history,
          .late_labeller = late_labeller ? &*late_labeller : nullptr};
}

}  // namespace penumbra
