// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <exception>
#include <optional>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/camera/rectification.hpp>
#include <penumbra/pipeline/frame_check-inl.hpp>
#include <penumbra/pipeline/image_space-inl.hpp>
#include <penumbra/pipeline/link_poses-inl.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/pipeline/target_stage-inl.hpp>
#include <penumbra/render/near_plane_check.hpp>

namespace penumbra {
namespace {

/// Writes the wall time of its scope, milliseconds.
class StageTimer {
 public:
  explicit StageTimer(std::optional<double>& to) : to_(to), start_(Clock::now()) {}
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;
  ~StageTimer() { to_ = std::chrono::duration<double, std::milli>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  std::optional<double>& to_;
  Clock::time_point start_;
};

std::vector<Body> bodies_of(const Robot& robot) {
  std::vector<Body> bodies;
  for (std::size_t i = 0; i < robot.links().size(); ++i)
    bodies.push_back({robot.links()[i], robot.meshes(i)});
  return bodies;
}

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

std::optional<UncoveredPixels> uncovered_of(const std::optional<Rectification>& rectification,
                                            ImageSpace image) {
  if (!rectification) return std::nullopt;
  return std::optional<UncoveredPixels>(std::in_place, image == ImageSpace::raw
                                                           ? rectification->raw_to_pinhole()
                                                           : rectification->pinhole_to_raw());
}

LabelRule rule_of(const Camera& camera, const PipelineConfig& config) {
  LabelRule rule = config.rule;
  rule.range.near = std::max(rule.range.near, camera.range.near);
  rule.range.far = std::min(rule.range.far, camera.range.far);
  return rule;
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

  [[nodiscard]] TargetStage::Setup target_setup(const PipelineConfig& config) const;
  void begin(const Frame& frame);
  FrameStatus pose_links(const Frame& frame);
  void add_message(const std::string& more);
  VirtualDepthView render(std::span<const Eigen::Isometry3d> T_camera_link);
  LabelView classify(const VirtualDepthView& virtual_depth, const DepthView& measured);
  DepthView seen_depth(const DepthView& measured);
  void label(const Frame& frame);
  void without_pose(FrameStatus status);
  void finish(FrameStatus status, const VirtualDepthView& virtual_depth, const LabelView& labels);
  void judge_targets(const Frame& frame);
  [[nodiscard]] JudgedFrame judged_frame(const LinkDoubts& doubts) const;

  Robot robot;
  Camera camera;
  std::optional<Rectification> rectification;  // nothing without lens distortion
  Intrinsics render_intrinsics;
  Intrinsics output_intrinsics;
  std::vector<std::string> missing_links;
  FrameCheck check;
  LinkPoses poses;
  CameraInsideCheck camera_inside;
  NearPlaneCheck near_plane;
  std::unique_ptr<DepthRenderer> renderer;
  std::optional<RawImages> raw_images;            // with distortion, ImageSpace::raw
  std::optional<RectifiedDepth> rectified_depth;  // with distortion, ImageSpace::rectified
  std::optional<UncoveredPixels> uncovered;       // with distortion
  Classifier classifier;
  std::vector<std::uint8_t> unknown_row;    // stands for every row of an image (stride 0)
  std::vector<std::uint16_t> no_depth_row;  // likewise
  Camera judged_camera;                     // of the report's images
  TargetStage targets;
  DepthView seen;    // of this frame, as it was compared
  LabelView labels;  // likewise
  std::size_t calls = 0;
  FrameReport report;
};

Pipeline::State::State(Robot robot_, const Camera& camera_, const PipelineConfig& config)
    : robot(drawn(std::move(robot_))),
      camera(checked(camera_)),
      rectification(rectification_of(camera)),
      render_intrinsics(rectification ? rectification->pinhole() : camera.intrinsics),
      output_intrinsics(config.image == ImageSpace::raw ? camera.intrinsics : render_intrinsics),
      missing_links(missing_links_of(robot)),
      check(robot, camera.intrinsics.width(), camera.intrinsics.height(), rule_of(camera, config),
            missing_links),
      poses(robot, config),
      camera_inside(bodies_of(robot)),
      near_plane(render_intrinsics, bodies_of(robot)),
      renderer(make_depth_renderer(config.backend, render_intrinsics, bodies_of(robot),
                                   config.renderer)),
      uncovered(uncovered_of(rectification, config.image)),
      classifier(output_intrinsics.width(), output_intrinsics.height(), rule_of(camera, config),
                 config.backend == Backend::reference ? "scalar" : config.renderer.isa),
      unknown_row(static_cast<std::size_t>(output_intrinsics.width()),
                  static_cast<std::uint8_t>(Label::unknown)),
      no_depth_row(unknown_row.size()),
      judged_camera(config.image == ImageSpace::raw ? camera : pinhole(camera, output_intrinsics)),
      targets(target_setup(config)) {
  if (rectification && config.image == ImageSpace::raw) raw_images.emplace(*rectification);
  if (rectification && config.image == ImageSpace::rectified)
    rectified_depth.emplace(*rectification);
  report.links = robot.links();
  report.missing_links = missing_links;
}

Pipeline::Pipeline(Robot robot, const Camera& camera, const PipelineConfig& config)
    : state_(std::make_unique<State>(std::move(robot), camera, config)) {}
Pipeline::~Pipeline() = default;
Pipeline::Pipeline(Pipeline&&) noexcept = default;
Pipeline& Pipeline::operator=(Pipeline&&) noexcept = default;

const Robot& Pipeline::robot() const { return state_->robot; }
const RendererInfo& Pipeline::renderer() const { return state_->renderer->info(); }
std::size_t Pipeline::triangle_count() const { return state_->renderer->triangle_count(); }
const LabelRule& Pipeline::rule() const { return state_->classifier.rule(); }
const Intrinsics& Pipeline::intrinsics() const { return state_->output_intrinsics; }
const Rectification* Pipeline::rectification() const {
  return state_->rectified_depth ? &*state_->rectification : nullptr;
}
std::span<const std::string> Pipeline::missing_links() const { return state_->missing_links; }

const FrameReport& Pipeline::process(const Frame& frame) {
  State& s = *state_;
  s.begin(frame);
  s.label(frame);
  s.judge_targets(frame);
  return s.report;
}

void Pipeline::forget_target(std::string_view name) { state_->targets.forget(name); }
void Pipeline::forget_targets() { state_->targets.forget_all(); }

void Pipeline::State::label(const Frame& frame) {
  check(frame, report);
  const FrameStatus status = report.status;
  if (!has_pose(status)) return without_pose(status);
  if (const FrameStatus fault = pose_links(frame); fault != FrameStatus::ok)
    return without_pose(fault);

  const DepthView measured = has_depth(status) ? frame.depth : DepthView{};
  const VirtualDepthView virtual_depth = render(poses.T_camera_link());
  finish(status, virtual_depth, classify(virtual_depth, measured));
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

VirtualDepthView Pipeline::State::render(std::span<const Eigen::Isometry3d> T_camera_link) {
  const StageTimer timer(report.timing.render);
  report.near_links = near_plane.find(T_camera_link);
  const VirtualDepthView rendered = renderer->render(T_camera_link);
  return raw_images ? raw_images->virtual_depth(rendered) : rendered;
}

LabelView Pipeline::State::classify(const VirtualDepthView& virtual_depth,
                                    const DepthView& measured) {
  const StageTimer timer(report.timing.classify);
  seen = seen_depth(measured);
  const LabelView made = classifier.classify(virtual_depth, seen);
  return uncovered ? uncovered->mark(made) : made;
}

DepthView Pipeline::State::seen_depth(const DepthView& measured) {
  if (std::visit([](const auto& view) { return view.empty(); }, measured))
    return ImageView<const std::uint16_t>{no_depth_row.data(), output_intrinsics.width(),
                                          output_intrinsics.height(), 0};
  if (rectified_depth) return rectified_depth->rectify(measured);
  return measured;
}

void Pipeline::State::without_pose(FrameStatus status) {
  report.status = status;
  report.labels = {unknown_row.data(), output_intrinsics.width(), output_intrinsics.height(), 0};
  report.pixels.uncovered = uncovered ? uncovered->count() : 0;
  report.pixels.unknown =
      unknown_row.size() * static_cast<std::size_t>(output_intrinsics.height()) -
      report.pixels.uncovered;
}

void Pipeline::State::finish(FrameStatus status, const VirtualDepthView& virtual_depth,
                             const LabelView& made) {
  const auto count = [&](Label label) { return made.pixels[static_cast<std::size_t>(label)]; };
  PixelCounts& pixels = report.pixels;
  pixels.front = count(Label::front);
  pixels.occluded = count(Label::occluded);
  pixels.unknown = count(Label::unknown);
  pixels.beyond = count(Label::beyond);
  pixels.fringe = count(Label::fringe);
  pixels.uncovered = uncovered ? uncovered->marked() : 0;
  pixels.robot = pixels.front + pixels.occluded + pixels.unknown + pixels.beyond;
  report.status = status;
  report.virtual_depth = virtual_depth;
  if (has_depth(status)) report.depth = seen;
  report.labels = made.labels;
  report.T_root_camera = poses.T_root_camera();
  report.T_root_link = poses.T_root_link();
  labels = made;
}

void Pipeline::State::judge_targets(const Frame& frame) {
  std::optional<double> time;
  {
    const StageTimer timer(time);
    report.targets = targets.process(frame.targets, judged_frame(frame.doubts));
  }
  if (!frame.targets.empty()) report.timing.targets = time;
}

JudgedFrame Pipeline::State::judged_frame(const LinkDoubts& doubts) const {
  JudgedFrame frame{report.stamp, report.status, report.message, {}, {}};
  if (report.T_root_camera) frame.poses = {report.T_root_link, *report.T_root_camera, doubts};
  if (has_pose(report.status))
    frame.images = {.labels = labels,
                    .virtual_depth = report.virtual_depth,
                    .measured = report.depth,
                    .is_blind = !has_depth(report.status)};
  return frame;
}

TargetStage::Setup Pipeline::State::target_setup(const PipelineConfig& config) const {
  const bool is_reference = config.backend == Backend::reference;
  const bool is_raw = config.image == ImageSpace::raw;
  return {.robot = robot,
          .camera = judged_camera,
          .rule = rule_of(camera, config),
          .backend = is_reference ? Backend::reference : Backend::cpu,
          .renderer = {.threads = 1, .isa = config.renderer.isa},
          .render_intrinsics = render_intrinsics,
          .rectification = rectification && is_raw ? &*rectification : nullptr,
          .unseen = uncovered && !is_raw ? uncovered->mask() : ImageView<const std::uint8_t>{},
          .history = config.target_history};
}

}  // namespace penumbra
