// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <exception>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/camera/rectification.hpp>
#include <penumbra/pipeline/frame_labeller-inl.hpp>
#include <penumbra/pipeline/image_judge-inl.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/pipeline/scan_labeller-inl.hpp>
#include <penumbra/poses/pose_stage.hpp>
#include <penumbra/render/near_plane_check.hpp>
#include <penumbra/robot/drawn_links.hpp>
#include <penumbra/targets/attach_target.hpp>
#include <penumbra/targets/target_stage.hpp>

namespace penumbra {
namespace {

Robot checked(Robot robot) {
  check_is_drawn(robot);
  return robot;
}

std::optional<Rectification> rectification_of(const Camera& camera) {
  if (camera.distortion.is_none()) return std::nullopt;
  return std::optional<Rectification>(std::in_place, camera);
}

const Rectification* pointer_to(const std::optional<Rectification>& rectification) {
  return rectification ? &*rectification : nullptr;
}

PixelCounts counts_of(const LabelledFrame& frame) {
  const auto count = [&](Label label) {
    return frame.labels.pixels[static_cast<std::size_t>(label)];
  };
  const LabelView& labels = frame.labels;
  PixelCounts pixels{.robot = std::nullopt,
                     .clear = static_cast<std::size_t>(labels.labels.width) *
                              static_cast<std::size_t>(labels.labels.height),
                     .front = count(Label::front),
                     .occluded = count(Label::occluded),
                     .unknown = count(Label::unknown),
                     .beyond = count(Label::beyond),
                     .fringe = count(Label::fringe),
                     .uncovered = frame.uncovered};
  pixels.clear -= pixels.front + pixels.occluded + pixels.unknown + pixels.beyond + pixels.fringe +
                  pixels.uncovered;
  const auto& drawn = frame.images.labels.pixels;  // a scan's unknown points are no robot
  if (frame.poses->known()) pixels.robot = 0;
  for (const Label label : {Label::front, Label::occluded, Label::unknown, Label::beyond})
    if (pixels.robot) *pixels.robot += drawn[static_cast<std::size_t>(label)];
  return pixels;
}

}  // namespace

struct Pipeline::State {
  /// A camera, and what labels and judges its images.
  struct Images {
    Images(const Robot& robot, const Camera& of, const PipelineConfig& config)
        : camera(of.check()),
          rectification(rectification_of(camera)),
          labeller(robot, camera, pointer_to(rectification), config),
          near_plane(labeller.render_intrinsics(), bodies_of(robot)),
          judge(robot, camera, pointer_to(rectification), labeller, config) {}

    Camera camera;
    std::optional<Rectification> rectification;  // null without lens distortion
    FrameLabeller labeller;
    NearPlaneCheck near_plane;
    ImageJudge judge;
  };

  State(Robot of, const Camera& camera, const PipelineConfig& config)
      : robot(checked(std::move(of))),
        missing_links(missing_links_of(robot)),
        poses(robot, config.camera_parent, config.T_parent_camera, missing_links),
        own_images(std::in_place, robot, camera, config),
        targets(robot, own_images->judge, camera.frame_id) {}
  State(Robot of, const CloudConfig& config)
      : robot(checked(std::move(of))),
        missing_links(missing_links_of(robot)),
        poses(robot, config.sensor_parent, config.T_parent_sensor, missing_links, false),
        scans(std::in_place, robot, config),
        targets(robot, *scans, std::nullopt) {}

  [[nodiscard]] Images& images() {
    if (!own_images) throw std::logic_error("this pipeline has no camera: its sensor scans");
    return *own_images;
  }
  LabelledFrame label(const Frame& frame);
  const FrameReport& report_of(const Frame& frame, const LabelledFrame& labelled);

  Robot robot;
  std::vector<std::string> missing_links;
  PoseStage poses;
  std::optional<Images> own_images;   // of a camera
  std::optional<ScanLabeller> scans;  // of a sensor of points
  TargetStage targets;
  const PoseResult* last_poses = nullptr;  // of the last frame, if it was judged
  std::size_t calls = 0;
  std::vector<std::size_t> attached;  // the report's
  FrameReport report;
};

Pipeline::Pipeline(Robot robot, const Camera& camera, const PipelineConfig& config)
    : state_(std::make_unique<State>(std::move(robot), camera, config)) {}
Pipeline::Pipeline(Robot robot, const CloudConfig& config)
    : state_(std::make_unique<State>(std::move(robot), config)) {}
Pipeline::~Pipeline() = default;
Pipeline::Pipeline(Pipeline&&) noexcept = default;
Pipeline& Pipeline::operator=(Pipeline&&) noexcept = default;

const Robot& Pipeline::robot() const { return state_->robot; }
void Pipeline::set_rule(const CloudRule& rule) {
  if (!state_->scans) throw std::logic_error("this pipeline's sensor is a camera");
  state_->scans->set_rule(rule);
}
const RendererInfo& Pipeline::renderer() const {
  return state_->images().labeller.renderer().info();
}
std::size_t Pipeline::triangle_count() const {
  return state_->images().labeller.renderer().triangle_count();
}
const LabelRule& Pipeline::rule() const { return state_->images().labeller.rule(); }
const Intrinsics& Pipeline::intrinsics() const { return state_->images().labeller.intrinsics(); }
Camera Pipeline::report_camera() const {
  const State::Images& images = state_->images();
  if (!images.labeller.rectifies()) return images.camera;
  return {.intrinsics = intrinsics(),
          .distortion = {},
          .range = images.camera.range,
          .frame_id = images.camera.frame_id};
}
const Rectification* Pipeline::rectification() const {
  const State::Images& images = state_->images();
  return images.labeller.rectifies() ? &*images.rectification : nullptr;
}
std::span<const std::string> Pipeline::missing_links() const { return state_->missing_links; }

const FrameReport& Pipeline::process(const Frame& frame) {
  State& s = *state_;
  s.last_poses = nullptr;
  const LabelledFrame labelled = s.label(frame);
  s.targets.judge(frame.targets, labelled);
  s.targets.track(frame.targets, labelled);
  s.last_poses = labelled.poses;
  return s.report_of(frame, labelled);
}

LabelledFrame Pipeline::State::label(const Frame& frame) {
  if (scans) return scans->label(frame, poses);
  return own_images->labeller.label(
      frame.depth.view,
      poses.place(frame.pose, frame.stamp, frame.source_status, frame.source_message));
}

AttachedBody Pipeline::attach_target(const Target& target, std::string_view link) const {
  const State& s = *state_;
  if (s.last_poses != nullptr)
    for (const TargetReport& report : s.targets.reports())
      if (report.name == target.name)
        return penumbra::attach_target(target, link, *s.last_poses, report, s.robot);
  throw InputError("target '" + target.name + "' was not in the last frame");
}

void Pipeline::forget_target(std::string_view name) { state_->targets.forget(name); }
void Pipeline::forget_targets() { state_->targets.forget_all(); }

const FrameReport& Pipeline::State::report_of(const Frame& frame, const LabelledFrame& labelled) {
  const PoseResult& at = *labelled.poses;
  report.index = frame.index.value_or(calls);
  ++calls;
  report.stamp = frame.stamp;
  report.joint_age = frame.pose.age;
  report.status = labelled.status;
  report.message = labelled.message;
  report.note = at.note;
  report.nothing_measured = labelled.nothing_measured;
  report.parts = scans ? scans->parts() : 0;
  report.pixels = counts_of(labelled);
  report.timing.kinematics = at.kinematics_ms;
  report.timing.render = labelled.render_ms;
  report.timing.classify = labelled.classify_ms;
  report.timing.targets.reset();
  if (!frame.targets.empty()) report.timing.targets = targets.elapsed_ms();
  report.T_root_camera.reset();
  report.T_root_link = {};
  report.near_links = {};
  report.links = poses.links();
  report.missing_links = at.missing_links;
  attached.clear();
  for (const PlacedBody& body : at.attached) attached.push_back(body.link);
  report.attached = attached;
  if (at.known()) {
    report.T_root_camera = at.T_root_camera;
    report.T_root_link = at.T_root_link;
    if (own_images) report.near_links = own_images->near_plane.find(at.T_camera_link);
  }
  report.virtual_depth = labelled.images.virtual_depth;
  report.depth = labelled.images.measured;
  report.labels = labelled.labels.labels;
  report.targets = targets.reports();
  return report;
}

}  // namespace penumbra
