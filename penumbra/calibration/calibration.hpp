// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <future>
#include <memory>
#include <mutex>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/calibration/kept_frames.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra {

struct CalibrationOptions {
  std::string camera_parent;  ///< link that carries the camera; empty: the root
  /// The camera's pose in that link, at most 100 mm and 10 degrees off; null: it is searched for.
  std::optional<Eigen::Isometry3d> initial;
  bool focal = false;  ///< estimate the focal lengths, too
  /// Estimate the zero offsets of joints that the images contradict; needs depth.
  bool joint_offsets = false;
  /// Estimate the time between images and poses, too; needs depth, and poses around the frames.
  bool time_offset = false;
  /// Standard deviation of the zeros of joints, rad (m of sliding ones). Published errors of
  /// industrial arms are 0.002 to 0.007; hobby servos repeat to 0.02 or 0.03.
  double joint_accuracy = 0.005;
  /// The widest 95 % region of a good pose, metres, and as many rad; null: 0.03, without depth 0.06
  /// m and 0.03 rad.
  std::optional<double> accept = {};
  std::uint64_t seed = 1;  ///< of the poses that are tried
};

/// A small motion of the camera in its own frame: rotation (rad) in x, y, z, then translation (m).
using PoseCovariance = Eigen::Matrix<double, 6, 6>;

/// How well the robot fits a frame.
struct FrameFit {
  std::size_t index = 0;  ///< KeptFrame::index
  bool used = true;       ///< false: the robot is elsewhere than its joints say
  /// Share of the robot's measured pixels at its depth; without depth, intersection over union of
  /// robot and mask.
  double agreeing = 0.0;
  double residual = 0.0;  ///< median distance of measured points from the robot's surface, metres
  double outline = 0.0;  ///< median distance of the depth's or mask's edge from the outline, pixels
};

/// A value and its standard deviation.
struct Estimate {
  double value = 0.0;
  double sigma = 0.0;
};

struct Calibration {
  Eigen::Isometry3d T_parent_camera;
  /// Of T_parent_camera: what joints' zeros within CalibrationOptions::joint_accuracy do, the
  /// residuals' own, and what errors common to a frame or a link do. It covers the pose that each
  /// cause in `notes` gives.
  PoseCovariance covariance;
  /// Metres: measured = true (1 + depth_scale) + depth_offset; neither without depth.
  std::optional<Estimate> depth_offset, depth_scale;
  Estimate outline;  ///< pixels by which the depth's or mask's picture of the robot is larger
  /// Pixels by which the depth image lies to the right of and below the colour image; only with
  /// depth and masks, and then the pose is that of the colour image.
  std::optional<Estimate> shift_right, shift_down;
  /// Relative: fx and fy are 1 + this of the camera's; only with CalibrationOptions::focal. The
  /// same for both without depth.
  std::optional<Estimate> focal_x, focal_y;
  /// Order of Robot::variables(), rad or m; empty: not asked. Those that the images do not
  /// contradict stay 0.
  std::vector<Estimate> joint_offsets;
  /// Seconds to add to an image's stamp before poses are looked up.
  std::optional<Estimate> time_offset;
  std::vector<FrameFit> frames;
  std::vector<double> link_residuals;  ///< signed medians by link, metres; NaN: not seen
  double mask_overlap = 0.0;           ///< intersection over union with the masks; 0 without masks

  /// Why the pose must not be used and what helps, a line each; empty: it is good.
  std::vector<std::string> faults;
  /// Frames that were left out, and inputs that the images contradict, with the amount: a focal
  /// length, a joint's zero, the time of the poses, the sensor's depth.
  std::vector<std::string> notes;
  std::string advice;    ///< what is known least, and which joints' motion would add most
  bool is_wide = false;  ///< the only fault: the region is wider than CalibrationOptions::accept

  [[nodiscard]] bool is_good() const { return faults.empty(); }
  /// Half of the longest axis of the 95 % ellipsoid of the camera's position (m) and rotation
  /// (rad).
  [[nodiscard]] double position_error() const;
  [[nodiscard]] double rotation_error() const;
};

/// Estimates a camera's pose from the robot that it sees: in depth images, or in masks alone. The
/// camera is fixed to the root or to any link of the robot. Where no frame has depth, the masks
/// alone are fitted. Throws InputError for fewer frames than KeptFrames::least, frames without
/// images, images of another size than the camera's, and options that need depth; any other failure
/// is Calibration::faults.
[[nodiscard]] Calibration calibrate(std::span<const KeptFrame> frames, const Intrinsics& camera,
                                    const Robot& robot, const CalibrationOptions& options);

/// Beyond which a camera's motion is reported.
struct DriftLimits {
  double position = 0.002;                           ///< metres, > 0
  double rotation = 0.1 * std::numbers::pi / 180.0;  ///< rad, > 0

  /// Throws InputError for limits that are not positive.
  void check() const;
};

/// How far a camera is from its calibration.
struct Drift {
  bool is_camera = true;  ///< false: a sensor of points
  bool is_known = false;  ///< the robot has been seen in enough poses
  /// The camera's pose in its calibrated frame.
  Eigen::Isometry3d T_calibrated_camera = Eigen::Isometry3d::Identity();
  PoseCovariance covariance = PoseCovariance::Zero();
  Estimate time_offset;  ///< seconds to add to an image's stamp before poses are looked up

  bool has_moved = false;      ///< farther than the limits; neither chance nor clocks explain it
  bool clocks_differ = false;  ///< by more than 5 ms; neither chance nor the pose explains it
  /// One of the two, and the robot's motion does not tell which: then the pose is as if the clocks
  /// were right, and the time offset as if the pose were.
  bool camera_or_clocks = false;

  /// Index and stamp (ns) of the frame at which the camera moved suddenly; null if it did not, or
  /// if the frame is not known within 30 frames.
  std::optional<std::size_t> bumped_at;
  std::optional<std::int64_t> bumped_at_stamp;
  std::size_t bumped_within = 0;  ///< frames by which that may be off
  /// Share of the robot's pixels in which the sensor sees past its surface; about 1 if the robot is
  /// elsewhere by more than its size.
  double seen_through = 0.0;

  /// Metres and rad, and half of the longest axis of their 95 % ellipsoids.
  [[nodiscard]] double position() const { return T_calibrated_camera.translation().norm(); }
  [[nodiscard]] double rotation() const;
  [[nodiscard]] double position_error() const;
  [[nodiscard]] double rotation_error() const;
  /// One line for users if the camera has moved or clocks differ; else empty.
  [[nodiscard]] std::string message() const;
};

/// Watches whether a camera stays where its calibration says, from the depth of the robot that it
/// sees. It never changes the calibration. Costs about 20 us per frame.
class CalibrationWatch {
 public:
  /// `camera`: of the reports' images; `is_camera`: else they are drawn from a sensor's scans.
  /// Throws InputError as DriftLimits::check().
  explicit CalibrationWatch(const Camera& camera, const DriftLimits& limits = {},
                            bool is_camera = true);
  ~CalibrationWatch();
  CalibrationWatch(CalibrationWatch&&) noexcept;
  CalibrationWatch& operator=(CalibrationWatch&&) noexcept;

  /// Adds a frame in which the robot's pose and depth are known; ignores others.
  void add(const FrameReport& report);
  /// Returns whether it will compare the images of the next such frame.
  [[nodiscard]] bool compares_next() const;
  [[nodiscard]] const Drift& drift() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What a RunningCalibration has found so far.
struct CalibrationProgress {
  bool is_running = false;   ///< takes frames
  bool is_search = false;    ///< without a first guess
  bool has_moved = false;    ///< it began because the watch saw the camera move
  std::size_t frames = 0;    ///< since it began
  std::size_t poses = 0;     ///< different poses of the robot in them
  std::string message = {};  ///< one line: what is missing, or what was found; empty: not asked
  std::string camera_parent = {};               ///< link in which the poses are
  std::optional<Eigen::Isometry3d> given = {};  ///< the camera's pose by TF or its configuration
  std::shared_ptr<const Calibration> found =
      {};  ///< of the poses when it was solved; null: not yet

  [[nodiscard]] bool is_ready() const { return found && found->is_good(); }
};

/// Says how far another pose of the camera is from a found one, and whether that is within its 95 %
/// region: as in "15.0 mm and 0.70 degrees from it, which is beyond that".
[[nodiscard]] std::string distance_text(const Calibration& found,
                                        const Eigen::Isometry3d& T_parent_camera);

/// Calibrates a camera while its cell runs: a question that is asked of judged frames. The
/// robot is moved by others. New poses are solved on a thread of its own, at first all, once a good
/// pose is found a few at a time. It begins by itself when the watch sees the camera move, and
/// changes nothing. It keeps at most KeptFrames::Options::most images, and as many while it solves.
/// Any thread may call all members.
class RunningCalibration {
 public:
  RunningCalibration() = default;
  ~RunningCalibration() { wait(); }
  RunningCalibration(const RunningCalibration&) = delete;
  RunningCalibration& operator=(const RunningCalibration&) = delete;

  /// Begins, and forgets former results. `search`: without a first guess; else from the pose that
  /// the camera has.
  void begin(bool search);
  /// Ends with this line and forgets the results: they are in use.
  void end(std::string why);
  [[nodiscard]] CalibrationProgress progress() const;

  // Whoever judges the frames calls these:
  /// Sets what the next frames are of. If that changes, poses begin anew.
  void follow(const Robot& robot, const Camera& camera, const std::string& camera_parent,
              const Eigen::Isometry3d& T_parent_camera);
  void take(const Frame& frame, const Drift& drift);
  /// Waits until all poses are solved: no further frame will come.
  void finish();

 private:
  struct Setup {
    Robot robot;
    Camera camera;
    std::string camera_parent;
    Eigen::Isometry3d T_parent_camera;
    [[nodiscard]] bool is_same(const Setup& other) const;
  };

  void restart(bool search, bool has_moved);
  void look_at(const Frame& frame);
  [[nodiscard]] bool can_solve() const;
  void solve();
  void settle(std::shared_ptr<const Calibration> found, const std::string& fault);
  void describe();
  void wait();

  mutable std::mutex mutex_;
  std::shared_ptr<const Setup> setup_;  // null: no frame came yet
  std::optional<KeptFrames> frames_;
  CalibrationProgress progress_;
  bool is_solving_ = false, has_moved_ = false;
  std::optional<std::int64_t> begun_at_;  // stamp of the first frame, ns
  std::uint64_t number_ = 0;              // of the question: results of former ones are dropped
  // Frames that were added, of these solved, and seen when the last one was added.
  std::size_t added_ = 0, solved_ = 0, last_added_ = 0;
  std::string fault_;  // why the poses could not be solved
  std::future<void> solving_;
};

}  // namespace penumbra
