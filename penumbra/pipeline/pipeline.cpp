// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <exception>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/image_judge-inl.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/pipeline/target_stage-inl.hpp>
#include <penumbra/poses/pose_stage.hpp>
#include <penumbra/robot/drawn_links.hpp>

namespace penumbra {
namespace {

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
  State(Robot of, const std::string& parent, const Eigen::Isometry3d& T_parent_sensor,
        std::unique_ptr<FrameJudge> how, std::optional<std::string> image_frame)
      : robot(std::move(of)),
        missing_links(missing_links_of(robot)),
        poses(robot, parent, T_parent_sensor, missing_links, image_frame.has_value()),
        judge(std::move(how)),
        targets(robot, *judge, std::move(image_frame)) {}

  [[nodiscard]] const ImageJudge& images() const {
    if (image_judge == nullptr)
      throw std::logic_error("this pipeline has no camera: its sensor scans");
    return *image_judge;
  }
  const FrameReport& report_of(const Frame& frame, const LabelledFrame& labelled);

  Robot robot;
  std::vector<std::string> missing_links;
  PoseStage poses;
  std::unique_ptr<FrameJudge> judge;
  const ImageJudge* image_judge = nullptr;  // the same, of a camera
  TargetStage targets;
  const PoseResult* last_poses = nullptr;  // of the last frame, if it was judged
  std::size_t calls = 0;
  std::vector<std::size_t> attached;  // the report's
  FrameReport report;
};

Pipeline::Pipeline(Robot robot, const Camera& camera, const PipelineConfig& config) {
  check_is_drawn(robot);
  auto judge = std::make_unique<ImageJudge>(robot, camera, config);
  const ImageJudge* const images = judge.get();
  state_ = std::make_unique<State>(std::move(robot), camera.parent, camera.pose(), std::move(judge),
                                   camera.frame_id);
  state_->image_judge = images;
}
Pipeline::Pipeline(Robot robot, const std::string& sensor_parent,
                   const Eigen::Isometry3d& T_parent_sensor, std::unique_ptr<FrameJudge> scans)
    : state_(std::make_unique<State>(std::move(robot), sensor_parent, T_parent_sensor,
                                     std::move(scans), std::nullopt)) {}
Pipeline::~Pipeline() = default;
Pipeline::Pipeline(Pipeline&&) noexcept = default;
Pipeline& Pipeline::operator=(Pipeline&&) noexcept = default;

const Robot& Pipeline::robot() const { return state_->robot; }
void Pipeline::set_rule(const CloudRule& rule) { state_->judge->set_rule(rule); }
const RendererInfo& Pipeline::renderer() const {
  return state_->images().labeller().renderer().info();
}
std::size_t Pipeline::triangle_count() const {
  return state_->images().labeller().renderer().triangle_count();
}
const LabelRule& Pipeline::rule() const { return state_->images().labeller().rule(); }
const Intrinsics& Pipeline::intrinsics() const { return state_->images().labeller().intrinsics(); }
Camera Pipeline::report_camera() const { return state_->images().camera(); }
const Rectification* Pipeline::rectification() const { return state_->images().rectification(); }
std::span<const std::string> Pipeline::missing_links() const { return state_->missing_links; }

const FrameReport& Pipeline::process(const Frame& frame, std::span<const Forecast> forecasts) {
  State& s = *state_;
  s.last_poses = nullptr;
  const LabelledFrame labelled = s.judge->label(frame, s.poses);
  s.targets.judge(frame.targets, labelled, forecasts);
  s.targets.track(frame.targets, labelled);
  s.last_poses = labelled.poses;
  return s.report_of(frame, labelled);
}

AttachedBody Pipeline::attach_target(const Target& target, std::string_view link) const {
  return state_->targets.attach(target, link, state_->last_poses);
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
  report.parts = labelled.parts;
  report.pixels = counts_of(labelled);
  report.timing.kinematics = at.kinematics_ms;
  report.timing.render = labelled.render_ms;
  report.timing.classify = labelled.classify_ms;
  report.timing.targets.reset();
  if (!frame.targets.empty()) report.timing.targets = targets.elapsed_ms();
  report.T_root_camera.reset();
  report.T_root_link = {};
  report.near_links = labelled.near_links;
  report.links = at.links;
  report.missing_links = at.missing_links;
  attached.clear();
  for (const PlacedBody& body : at.attached) attached.push_back(body.link);
  report.attached = attached;
  if (at.known()) {
    report.T_root_camera = at.T_root_camera;
    report.T_root_link = at.T_root_link;
  }
  report.virtual_depth = labelled.images.virtual_depth;
  report.depth = labelled.images.measured;
  report.labels = labelled.labels.labels;
  report.targets = targets.reports();
  return report;
}

}  // namespace penumbra
