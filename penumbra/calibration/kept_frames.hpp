// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/camera/rectification.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra {

/// A frame that is kept to calibrate, diagnose or tune a setup. Images that are not needed are
/// empty; they are those of a pinhole camera.
struct KeptFrame {
  std::size_t index = 0;   ///< in its source
  std::size_t number = 0;  ///< frames with an image up to it; shared by poses without an image
  std::optional<std::int64_t> stamp = {};  ///< nanoseconds
  std::vector<double> joints = {};  ///< order of Robot::variables(); empty if the poses are from TF
  std::vector<Eigen::Isometry3d> T_root_link = {};
  std::optional<Eigen::Isometry3d> T_root_camera = {};  ///< of a frame that was judged
  bool is_resting = true;                               ///< the robot stands still, or has no stamp

  static constexpr std::uint8_t not_known = 128;  ///< of a mask

  Image<float> depth = {};          ///< measured, metres; 0: no measurement
  Image<std::uint8_t> mask = {};    ///< 0: not the robot; not_known; any other: the robot
  Image<float> virtual_depth = {};  ///< metres; 0: no robot on the ray
  Image<std::uint16_t> links = {};  ///< of virtual_depth: link index + 1; 0: none
  Image<std::uint8_t> labels = {};
  Image<Rgb8> color = {};

  /// The poses before and after it, in time's order, its own among them: of up to 7 frames and of
  /// 0.25 s. They have neither images nor poses around them.
  std::vector<KeptFrame> nearby = {};

  /// Returns the seconds from another frame to this; null without stamps.
  [[nodiscard]] std::optional<double> seconds_after(const KeptFrame& other) const;
  /// Returns whether `nearby` reaches 0.1 s to both sides: whether it tells if the poses are of
  /// another time.
  [[nodiscard]] bool tells_time() const;
};

/// Returns the links' poses in the root at a time after a frame, from those around it; empty where
/// these do not reach, or are too far apart.
[[nodiscard]] std::vector<Eigen::Isometry3d> poses_at(const Robot& robot, const KeptFrame& frame,
                                                      double seconds);

/// Throws InputError if frames are fewer than KeptFrames::least. `purpose`: as in "tune".
void check_enough(std::span<const KeptFrame> frames, const std::string& purpose);

/// Chooses frames of a sequence between which the robot moves, spread over the whole of it.
class KeptFrames {
 public:
  static constexpr std::size_t least = 3;  ///< that tell about a setup

  enum class Choice : std::uint8_t {
    any,
    rest_first,  ///< those in which the robot stands still, if there are `least`
    moving       ///< of a moving robot, with poses around them that tell time
  };
  struct Options {
    Choice choice = Choice::any;
    std::size_t most = 20;
    double motion = 0.03;      ///< metres that one link moves between two frames, at least
    bool needs_depth = true;   ///< frames without a depth image are not used
    std::size_t parent = 0;    ///< index of the link that carries the camera
    bool camera_stays = true;  ///< it is an InputError if the camera moves on that link
    int columns = 0;  ///< images with at least twice as many are thinned to about these; 0: none
  };

  /// `camera`: of the frames' images, with its distortion.
  KeptFrames(const Robot& robot, const Camera& camera, const Options& options);

  /// Looks at the next frame of the sequence. If it is wanted, returns it without its images: call
  /// add() with them. The poses of all frames, also of those without an image, become those around
  /// the kept ones. Throws InputError if the camera moves on its link, and for moving frames
  /// without a stamp.
  [[nodiscard]] std::optional<KeptFrame> pass(const Frame& frame);
  /// Takes the robot's pose between frames.
  void follow(const Frame& frame);
  /// The same of a frame that was judged. `joints`: its positions in the order of
  /// Robot::variables(); others: the poses are from TF.
  [[nodiscard]] std::optional<KeptFrame> pass(const FrameReport& report,
                                              std::span<const double> joints);
  /// Returns whether a judged frame has the poses of all links, and depth if that is needed.
  [[nodiscard]] bool is_usable(const FrameReport& report) const;
  /// Keeps the frame of the last pass(); drops others when there are too many.
  void add(KeptFrame frame);

  /// Returns an image as it is kept: free of distortion, and thinned. Throws InputError if it is
  /// not of the camera's size.
  template <typename T>
  [[nodiscard]] Image<T> image_of(ImageView<const T> raw) const {
    check_size(raw.width, raw.height);
    Image<T> image(camera_.width(), camera_.height());
    for (int v = 0; v < image.height(); ++v)
      for (int u = 0; u < image.width(); ++u) {
        int x = u * block_ + block_ / 2, y = v * block_ + block_ / 2;
        if (lens_) {
          const std::int32_t at = lens_->pinhole_to_raw()(x, y);
          if (at == Rectification::no_pixel) continue;
          x = at % raw.width, y = at / raw.width;
        }
        image(u, v) = raw(x, y);
      }
    return image;
  }
  [[nodiscard]] Image<float> depth_of(const DepthView& depth,
                                      const MeasuredRange& range = {}) const {
    const Image<float> metres = metres_of(depth, range);
    return image_of(metres.view());
  }

  /// Returns whether an image is of the camera's size.
  [[nodiscard]] bool is_size(int width, int height) const {
    return width == raw_.width() && height == raw_.height();
  }
  /// Returns how many pixels of an image become one of the kept image, in each direction.
  [[nodiscard]] int block() const { return block_; }
  /// Returns the camera of the images as they come, without its lens.
  [[nodiscard]] const Intrinsics& raw_camera() const { return raw_; }
  /// Returns the camera of the kept images.
  [[nodiscard]] const Intrinsics& camera() const { return camera_; }
  [[nodiscard]] std::span<const KeptFrame> frames() const { return frames_; }
  /// Returns the frames that serve the choice so far.
  [[nodiscard]] std::vector<KeptFrame> chosen() const;
  /// Returns the camera's pose in its link as the first frame has it; null: it has none.
  [[nodiscard]] const std::optional<Eigen::Isometry3d>& T_parent_camera() const {
    return T_parent_camera_;
  }
  [[nodiscard]] std::size_t seen() const { return seen_; }
  /// Returns why the last frame that cannot be used cannot; empty: all can.
  [[nodiscard]] const std::string& last_fault() const { return last_fault_; }
  /// Returns which frames cannot be used and whether too few are at rest, a line each.
  [[nodiscard]] std::vector<std::string> notes() const;

 private:
  [[nodiscard]] KeptFrame posed_frame(const Frame& frame) const;
  void follow_until(const Frame& frame);
  void check_size(int width, int height) const;
  [[nodiscard]] bool follow(KeptFrame& frame);
  void follow_camera(const KeptFrame& frame, const Eigen::Isometry3d& T_parent_camera);
  [[nodiscard]] bool has_rested() const;
  [[nodiscard]] bool wants(const KeptFrame& frame) const;
  void refuse(std::size_t index, const std::string& why);

  Robot robot_;
  Options options_;
  Intrinsics raw_;
  std::optional<Rectification> lens_;
  int block_;
  Intrinsics camera_;
  std::vector<KeptFrame> frames_;
  double motion_;                 // metres, as Options::motion; more after frames were dropped
  std::deque<KeptFrame> recent_;  // the newest last, without images
  double speed_ = 0.0;            // of the fastest link's origin, m/s; 0 if it is not known
  std::optional<Eigen::Isometry3d> T_parent_camera_;
  std::size_t seen_ = 0, images_ = 0, faulty_ = 0;
  std::string fault_, last_fault_;  // of the first frame, with its index
};

}  // namespace penumbra
