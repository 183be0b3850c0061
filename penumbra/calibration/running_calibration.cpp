// SPDX-License-Identifier: Apache-2.0
#include <exception>
#include <numbers>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text.hpp>
#include <penumbra/calibration/calibration.hpp>

namespace penumbra {
namespace {

// Once a good pose is found, so many new frames are solved together, or those that are there after
// so many frames without a new pose: the robot rests, or repeats its motion.
constexpr std::size_t new_frames = 3, patience = 30;
/// With fewer the stated region holds the truth too seldom (bench/results/calibration.txt), and
/// more will come.
constexpr std::size_t least_poses = 5;

std::string mm_and_degrees(double metres, double radians) {
  return detail::fixed(1e3 * metres, 1) + " mm and " +
         detail::fixed(radians * 180.0 / std::numbers::pi, 2) + " degrees";
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "; ") + line;
  return text;
}

std::string poses_text(std::size_t poses) {
  return std::to_string(poses) + (poses == 1 ? " pose" : " poses");
}

/// Tells what was found, where the given pose is, and what would help.
std::string result_text(const Calibration& found, const std::optional<Eigen::Isometry3d>& given) {
  if (!found.is_good()) return "no good pose yet: " + joined(found.faults);
  std::string text = "a good pose is found by " + poses_text(found.frames.size()) + ", within " +
                     mm_and_degrees(found.position_error(), found.rotation_error()) + " (95 %)";
  if (given) text += "; the pose in use is " + distance_text(found, *given);
  return text + (found.notes.empty() ? "" : "; " + joined(found.notes));
}

}  // namespace

std::string distance_text(const Calibration& found, const Eigen::Isometry3d& T_parent_camera) {
  const Eigen::Isometry3d between = T_parent_camera.inverse() * found.T_parent_camera;
  const double moved = between.translation().norm();
  const double turned = std::abs(Eigen::AngleAxisd(between.linear()).angle());
  const bool is_beyond = moved > found.position_error() || turned > found.rotation_error();
  return mm_and_degrees(moved, turned) + " from it, which is " + (is_beyond ? "beyond" : "within") +
         " that";
}

void RunningCalibration::begin(bool search) {
  const std::lock_guard lock(mutex_);
  restart(search, false);
}

void RunningCalibration::end(std::string why) {
  const std::lock_guard lock(mutex_);
  ++number_;
  frames_.reset();
  progress_ = {.message = std::move(why)};
}

CalibrationProgress RunningCalibration::progress() const {
  const std::lock_guard lock(mutex_);
  return progress_;
}

void RunningCalibration::restart(bool search, bool has_moved) {
  ++number_;
  progress_ = {.is_running = true, .is_search = search, .has_moved = has_moved};
  frames_.reset();
  begun_at_.reset();
  added_ = solved_ = last_added_ = 0;
  fault_.clear();
  describe();
}

void RunningCalibration::follow(const Robot& robot, const Camera& camera,
                                const std::string& camera_parent,
                                const Eigen::Isometry3d& T_parent_camera) {
  const std::string& parent = camera_parent.empty() ? robot.links().front() : camera_parent;
  auto setup = std::make_shared<Setup>(Setup{robot, camera, parent, T_parent_camera});
  const std::lock_guard lock(mutex_);
  has_moved_ = false;
  if (setup_ && setup_->is_same(*setup)) return;
  setup_ = std::move(setup);
  if (progress_.is_running)
    restart(progress_.is_search, progress_.has_moved);
  else if (std::exchange(progress_.found, nullptr))
    progress_.message = "the robot, the camera or its link changed since: begin again";
}

bool RunningCalibration::Setup::is_same(const Setup& other) const {
  return robot.links().data() == other.robot.links().data() &&
         camera.intrinsics == other.camera.intrinsics &&
         camera.distortion == other.camera.distortion && camera_parent == other.camera_parent &&
         T_parent_camera.matrix() == other.T_parent_camera.matrix();
}

void RunningCalibration::take(const Frame& frame, const Drift& drift) {
  const std::lock_guard lock(mutex_);
  const bool begins_to_move = drift.has_moved && !has_moved_;
  has_moved_ = drift.has_moved;
  if (!progress_.is_running) {
    if (begins_to_move) restart(false, true);
  } else if (begun_at_ && drift.bumped_at_stamp > begun_at_) {
    restart(progress_.is_search, true);  // not with poses before and after
  }
  if (!begun_at_) begun_at_ = frame.stamp;
  if (!setup_ || !progress_.is_running) return;
  try {
    look_at(frame);
  } catch (const InputError& error) {
    ++number_;
    frames_.reset();
    progress_.is_running = false;
    progress_.message = error.what();
    return;
  }
  describe();
  const bool is_time = !progress_.is_ready() || added_ >= solved_ + new_frames ||
                       progress_.frames >= last_added_ + patience;
  if (!is_solving_ && is_time && can_solve()) solve();
}

void RunningCalibration::look_at(const Frame& frame) {
  if (!frames_)
    frames_.emplace(
        setup_->robot, setup_->camera,
        KeptFrames::Options{.choice = KeptFrames::Choice::rest_first,
                            .parent = find_camera_parent(setup_->robot, setup_->camera_parent)});
  std::optional<KeptFrame> kept = frames_->pass(frame);
  progress_.frames = frames_->seen();
  progress_.camera_parent = setup_->camera_parent;
  if (has_pose(frame.pose.status))
    progress_.given = frame.pose.T_parent_camera.value_or(setup_->T_parent_camera);
  if (!kept) return;
  const DepthRange& range = setup_->camera.range;
  kept->depth = frames_->depth_of(frame.depth.view, {range.near, range.far});
  frames_->add(*std::move(kept));
  ++added_;
  last_added_ = progress_.frames;
  progress_.poses = frames_->frames().size();
}

bool RunningCalibration::can_solve() const {
  return frames_ && added_ > solved_ && frames_->frames().size() >= least_poses &&
         (progress_.is_search || progress_.given);
}

/// Solves the poses so far on another thread.
void RunningCalibration::solve() {
  solved_ = added_;
  is_solving_ = true;
  CalibrationOptions options;
  options.camera_parent = setup_->camera_parent;
  if (!progress_.is_search) options.initial = progress_.given;
  solving_ = std::async(std::launch::async, [this, number = number_, setup = setup_,
                                             camera = frames_->camera(), frames = frames_->chosen(),
                                             options = std::move(options)] {
    std::shared_ptr<const Calibration> found;
    std::string fault;
    try {
      found = std::make_shared<const Calibration>(calibrate(frames, camera, setup->robot, options));
    } catch (const std::exception& error) {
      fault = error.what();
    }
    const std::lock_guard lock(mutex_);
    is_solving_ = false;
    if (number == number_) settle(std::move(found), fault);
  });
}

void RunningCalibration::settle(std::shared_ptr<const Calibration> found,
                                const std::string& fault) {
  fault_ = fault;
  if (found) progress_.found = std::move(found);
  describe();
}

void RunningCalibration::finish() {
  wait();
  {
    const std::lock_guard lock(mutex_);
    if (can_solve()) solve();
  }
  wait();
  const std::lock_guard lock(mutex_);
  frames_.reset();
  progress_.is_running = false;
}

void RunningCalibration::wait() {
  std::future<void> solving;
  {
    const std::lock_guard lock(mutex_);
    solving = std::move(solving_);
  }
  if (solving.valid()) solving.wait();
}

/// Says in one line what is missing or found.
void RunningCalibration::describe() {
  std::string& line = progress_.message;
  line = progress_.has_moved ? "the camera has moved: " : "";
  const std::size_t poses = progress_.poses;
  if (progress_.found) {
    line += result_text(*progress_.found, progress_.given);
  } else if (!fault_.empty()) {
    line += fault_;
  } else if (progress_.frames == 0) {
    line += "no frame was judged since the calibration began";
  } else if (poses == 0) {
    line += "no frame can be used yet (" + frames_->last_fault() + ")";
  } else if (!progress_.is_search && !progress_.given) {
    line += "the camera's pose is not known, so that there is none to begin from: search for it";
  } else if (poses < least_poses) {
    line += "move the robot to more poses, and let it stand still for a second in each";
  } else {
    line += "the pose is sought";
  }
  line += "; " + poses_text(poses) + " so far";
  if (progress_.is_running && poses < least_poses)
    line += " of at least " + std::to_string(least_poses);
  else if (progress_.is_ready() && progress_.is_running)
    line += "; " + progress_.found->advice;
}

}  // namespace penumbra
