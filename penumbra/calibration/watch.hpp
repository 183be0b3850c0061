// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <future>
#include <memory>
#include <mutex>
#include <numbers>
#include <optional>
#include <string>

#include <Eigen/Geometry>

#include <penumbra/calibration/calibration.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/pipeline/frame.hpp>

namespace penumbra {

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
