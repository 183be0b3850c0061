// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <system_error>

#include <penumbra/base/error.hpp>

#include <io/files/names.hpp>
#include <sim/depth_sensor.hpp>
#include <sim/random.hpp>
#include <sim/scene.hpp>
#include <sim/simulation.hpp>
#include <sim/stage.hpp>
#include <sim/temporary_folder.hpp>

namespace penumbra::sim {
namespace {

constexpr std::int64_t first_stamp = 1'700'000'000'000'000'000;  // nanoseconds
constexpr double longest = 3600.0;                               // seconds
constexpr double third_of_turn = 2.0 * std::numbers::pi / 3.0;   // radians
constexpr std::uint64_t joint_stream = 21, depth_stream = 31, second_stream = 32;

/// Returns a D415's colour camera at 640x480 (69 degrees of 1280x720, cropped and binned), with a
/// typically calibrated principal point off the centre.
Camera d415_color() {
  Camera camera{Intrinsics(640, 480, 612.3, 612.3, 325.4, 236.8), {}, {}, "camera_optical_frame"};
  return camera;
}

void check_options(const SimulationOptions& options) {
  const auto need = [](bool good, const std::string& what, double value, const char* wanted) {
    if (!good)
      throw InputError("simulation: " + what + " is " + std::to_string(value) + "; " + wanted +
                       " is needed");
  };
  need(options.joint_sigma >= 0.0 && options.joint_sigma <= 1.0, "joint_sigma", options.joint_sigma,
       "0 to 1 rad");
  need(options.joint_latency >= 0.0 && options.joint_latency <= 10.0, "joint_latency",
       options.joint_latency, "0 to 10 s");
  need(options.belt_jitter >= 0.0 && options.belt_jitter <= 0.5, "belt_jitter", options.belt_jitter,
       "0 to 0.5");
  need(options.camera >= 0 && options.camera <= 2, "camera", options.camera, "0, 1 or 2");
  need(options.duration >= 0.0 && options.duration <= longest, "duration", options.duration,
       "0 to 3600 s");
  need(options.frame_rate > 0.0 && options.frame_rate <= 1000.0, "frame_rate", options.frame_rate,
       "more than 0, at most 1000 per second");
  need(options.duration == 0.0 || options.duration * options.frame_rate >= 1.0, "duration",
       options.duration, "at least the time of one frame");
}

std::filesystem::path shipped_urdf() {
  std::filesystem::path urdf = PENUMBRA_SIM_ARM;
  std::error_code error;
  if (!std::filesystem::is_regular_file(urdf, error))
    throw InputError(urdf.string() +
                     ": the simulated arm's URDF is not there; it belongs to "
                     "Penumbra's sources (examples/arm_over_table)");
  return urdf;
}

RobotOptions visual_geometry(const std::filesystem::path& urdf) {
  RobotOptions options;
  options.packages.emplace(urdf.parent_path().filename().string(), urdf.parent_path());
  options.geometry = Geometry::visual;
  options.geometry_fallback = true;
  return options;
}

bool is_robot(std::int32_t id) { return id >= 1 && id < first_object_id; }

/// Copies the pixels of `ids` that are nearer into the frame.
void lay_over(const Image<std::int32_t>& ids, const Image<float>& depth, const Window& window,
              SimFrame& to) {
  for (int v = window.v0; v < window.v1; ++v) {
    const float* const z = depth.view().row(v);
    const std::int32_t* const id = ids.view().row(v);
    float* const to_z = to.true_depth.view().row(v);
    std::int32_t* const to_id = to.ids.view().row(v);
    for (int u = window.u0; u < window.u1; ++u) {
      const bool nearer = z[u] > 0.0F && (to_z[u] == 0.0F || z[u] < to_z[u]);
      to_z[u] = nearer ? z[u] : to_z[u];
      to_id[u] = nearer ? id[u] : to_id[u];
    }
  }
}

}  // namespace

struct Simulation::State {
  State(const std::string& name, const SimulationOptions& options_);
  [[nodiscard]] std::unique_ptr<Scene> make_scene(const std::string& name);
  [[nodiscard]] double time_of(std::size_t index) const {
    return static_cast<double>(index) / options.frame_rate;
  }
  void report_joints(double time, SimFrame& to) const;
  void draw(const ScenePose& pose, SimFrame& to);
  void draw_objects(const ScenePose& pose, SimFrame& to);
  void count_alone(const Window& window, const SimFrame& frame_of, ObjectTruth& object) const;

  SimulationOptions options;
  std::filesystem::path urdf = shipped_urdf();
  Camera camera = d415_color();  // both, with the first one's pose
  TemporaryFolder folder;
  std::vector<ArmPlace> arms;
  Arm arm;
  std::unique_ptr<Scene> scene;
  Stage stage;
  Viewpoint view, second_view;
  DepthSensor sensor, second_sensor;
  double duration;  // seconds
  std::size_t frame = 0;
  Image<std::int32_t> alone_ids;
  Image<float> alone_depth, second_truth;
};

Simulation::State::State(const std::string& name, const SimulationOptions& options_)
    : options(options_),
      arms(name == "two_arms" ? two_places() : std::vector<ArmPlace>()),
      arm(arms.empty() ? urdf : write_arms(urdf, arms, folder.path()), visual_geometry(urdf),
          folder.path()),
      scene(make_scene(name)),
      stage(arm, scene->description(), folder.path(), camera.intrinsics),
      view{camera.intrinsics,
           Eigen::AngleAxisd(options_.camera * third_of_turn, Eigen::Vector3d::UnitZ()) *
               scene->description().T_base_camera},
      second_view{camera.intrinsics, scene->description().T_base_second_camera},
      sensor(options_.depth, camera.intrinsics.fx(), options_.seed,
             depth_stream + (static_cast<std::uint64_t>(options_.camera) << 8)),
      second_sensor(options_.depth, camera.intrinsics.fx(), options_.seed, second_stream),
      duration(options_.duration > 0.0 ? options_.duration : scene->description().duration) {
  camera.T_parent_camera = view.T_base_camera;
}

std::unique_ptr<Scene> Simulation::State::make_scene(const std::string& name) {
  const SceneOptions scene_options{options.seed, options.belt_jitter, options.frame_rate,
                                   options.duration};
  if (name == "conveyor") return make_conveyor(arm, scene_options);
  if (name == "handover") return make_handover(arm, scene_options);
  if (name == "random" || name == "carry" || name == "two_arms")
    return make_random_targets(arm, scene_options, camera.intrinsics, name == "carry");
  const std::vector<std::string>& names = Simulation::scenes();
  const std::vector<std::string_view> known(names.begin(), names.end());
  throw InputError("there is no scene '" + name + "'" + io::near_names(name, known));
}

/// Adds noise that is determined by the frame's number.
void Simulation::State::report_joints(double time, SimFrame& to) const {
  to.true_joints = scene->joints(time);
  to.joints = scene->joints(time - options.joint_latency);
  if (options.joint_sigma == 0.0) return;
  Random random(options.seed, mix(joint_stream ^ (frame << 8)));
  for (double& position : to.joints) position += options.joint_sigma * random.normal();
}

/// Draws the robot, the background and each object separately and merges them by depth. The image
/// is the same as if drawn at once, and each object is also drawn alone.
void Simulation::State::draw(const ScenePose& pose, SimFrame& to) {
  const auto background = [](std::int32_t id) { return id == 0; };
  const Window whole{0, 0, view.intrinsics.width(), view.intrinsics.height()};
  to.ids.fit(view.intrinsics.width(), view.intrinsics.height());
  to.true_depth.fit(view.intrinsics.width(), view.intrinsics.height());
  to.robot_ids.fit(view.intrinsics.width(), view.intrinsics.height());
  to.robot_depth.fit(view.intrinsics.width(), view.intrinsics.height());
  if (options.color) stage.draw_color(view, to.color);
  stage.draw_ids(view, is_robot, whole, &to.robot_ids, &to.robot_depth);
  stage.draw_ids(view, background, whole, nullptr, &to.true_depth);
  std::fill_n(to.ids.data(), to.ids.size(), 0);
  lay_over(to.robot_ids, to.robot_depth, whole, to);
  draw_objects(pose, to);
  sensor.measure(to.true_depth, frame, to.depth);
  if (!options.second_camera) return;
  second_truth.fit(second_view.intrinsics.width(), second_view.intrinsics.height());
  const auto everything = [](std::int32_t) { return true; };
  stage.draw_ids(second_view, everything, whole, nullptr, &second_truth);
  second_sensor.measure(second_truth, frame, to.second_depth);
}

void Simulation::State::draw_objects(const ScenePose& pose, SimFrame& to) {
  const std::vector<std::string>& names = scene->description().objects;
  const std::vector<ObjectSolid>& solids = scene->description().solids;
  to.objects.resize(names.size());
  alone_ids.fit(view.intrinsics.width(), view.intrinsics.height());
  alone_depth.fit(view.intrinsics.width(), view.intrinsics.height());
  for (std::size_t i = 0; i < names.size(); ++i) {
    ObjectTruth& object = to.objects[i];
    object.name = names[i];
    object.id = first_object_id + static_cast<std::int32_t>(i);
    object.T_base_object = pose.objects[i];
    object.solid = solids.empty() ? ObjectSolid() : solids[i];
    const Window window = stage.window_of(view, object.id);
    const auto itself = [&](std::int32_t id) { return id == object.id; };
    stage.draw_ids(view, itself, window, &alone_ids, &alone_depth);
    count_alone(window, to, object);
    lay_over(alone_ids, alone_depth, window, to);
  }
  for (ObjectTruth& object : to.objects)
    object.pixels_seen = static_cast<std::size_t>(
        std::count(to.ids.data(), to.ids.data() + to.ids.size(), object.id));
}

void Simulation::State::count_alone(const Window& window, const SimFrame& frame_of,
                                    ObjectTruth& object) const {
  object.pixels_alone = object.pixels_behind_robot = 0;
  object.alone.fit(view.intrinsics.width(), view.intrinsics.height());
  object.alone_depth.fit(view.intrinsics.width(), view.intrinsics.height());
  std::fill_n(object.alone.data(), object.alone.size(), std::uint8_t{0});
  std::fill_n(object.alone_depth.data(), object.alone_depth.size(), 0.0F);
  for (int v = window.v0; v < window.v1; ++v)
    for (int u = window.u0; u < window.u1; ++u) {
      if (alone_ids(u, v) != object.id) continue;
      object.alone(u, v) = 1;
      object.alone_depth(u, v) = alone_depth(u, v);
      ++object.pixels_alone;
      const float robot = frame_of.robot_depth(u, v);
      object.pixels_behind_robot += robot > 0.0F && robot < alone_depth(u, v) ? 1 : 0;
    }
}

const std::vector<std::string>& Simulation::scenes() {
  static const std::vector<std::string> names{"conveyor", "handover", "random", "carry",
                                              "two_arms"};
  return names;
}

Simulation::Simulation(const std::string& scene, const SimulationOptions& options) {
  check_options(options);
  state_ = std::make_unique<State>(scene, options);
  if (frames() == 0)
    throw InputError("simulation: frame_rate (--rate) is " + std::to_string(options.frame_rate) +
                     "; at least one frame in the scene's " + std::to_string(state_->duration) +
                     " s is needed");
  if (options.joint_latency > 0.0 && !state_->scene->description().moves)
    throw InputError("simulation: joint_latency means nothing in the scene '" + scene +
                     "', whose frames have nothing to do with each other; leave it out");
  if (options.belt_jitter > 0.0 && scene != "conveyor")
    throw InputError("simulation: belt_jitter means nothing in the scene '" + scene +
                     "', which has no belt; leave it out");
}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

std::size_t Simulation::frames() const {
  return static_cast<std::size_t>(std::floor(state_->duration * state_->options.frame_rate + 1e-6));
}

void Simulation::skip(std::size_t frames) { state_->frame += frames; }

bool Simulation::next(SimFrame& frame) {
  State& s = *state_;
  if (s.frame >= frames()) return false;
  const double time = s.time_of(s.frame);
  frame.stamp = first_stamp + std::llround(1e9 * time);
  s.report_joints(time, frame);
  const ScenePose pose = s.scene->pose(time);
  s.stage.place(frame.true_joints, pose.parts);
  s.draw(pose, frame);
  ++s.frame;
  return true;
}

const std::filesystem::path& Simulation::urdf() const { return state_->urdf; }
const std::vector<ArmPlace>& Simulation::arms() const { return state_->arms; }
const Robot& Simulation::robot() const { return state_->arm.robot(); }
const Camera& Simulation::camera() const { return state_->camera; }
const Eigen::Isometry3d& Simulation::T_base_camera() const { return state_->view.T_base_camera; }
const Eigen::Isometry3d& Simulation::T_base_second_camera() const {
  return state_->second_view.T_base_camera;
}
const Image<Rgb8>& Simulation::model_image() const {
  return state_->scene->description().model_image;
}
Eigen::Vector3d Simulation::object_size() const { return state_->scene->description().object_size; }
Eigen::Vector3d Simulation::conveyor_direction() const {
  return state_->scene->description().conveyor_direction;
}
double Simulation::duration() const { return state_->duration; }
bool Simulation::is_whole() const {
  return state_->duration >= state_->scene->description().duration;
}

std::optional<std::int64_t> Simulation::grasp_stamp() const {
  const std::optional<double> grasp = state_->scene->description().grasp;
  if (!grasp || *grasp >= state_->duration) return std::nullopt;
  return first_stamp + std::llround(1e9 * *grasp);
}

}  // namespace penumbra::sim
