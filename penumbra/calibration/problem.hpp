// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/calibration/calibration.hpp>
#include <penumbra/calibration/dense.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra::calibration {

using Twist = Eigen::Matrix<double, 6, 1>;  ///< rotation vector (rad), then translation (m)

/// Returns the small motion.
[[nodiscard]] Eigen::Isometry3d motion(const Twist& twist);
[[nodiscard]] Twist twist_of(const Eigen::Isometry3d& motion);

/// Returns half of the longest axis of the 95 % ellipsoid.
[[nodiscard]] double longest_axis(const Eigen::Matrix3d& covariance);

using FramePointers = std::vector<const KeptFrame*>;
[[nodiscard]] FramePointers pointers_to(std::span<const KeptFrame> frames);
/// Returns whether a link is at one place in all frames.
[[nodiscard]] bool stands_still(std::span<const KeptFrame> frames, std::size_t link);

/// What is estimated.
struct State {
  Eigen::Isometry3d T_parent_camera;
  double depth_offset = 0.0;  ///< metres
  double depth_scale = 0.0;
  double outline = 0.0;                                   ///< pixels
  Eigen::Vector2d depth_shift = Eigen::Vector2d::Zero();  ///< pixels, of depth against the masks
  Eigen::Vector2d focal = Eigen::Vector2d::Zero();  ///< fx and fy are 1 + this of the camera's
  std::vector<double> joint_offsets;                ///< of Robot::variables(); empty: all are 0
  /// Of Robot::joints(), metres by which each lies farther from its parent link's origin than the
  /// URDF says; empty: all are 0.
  std::vector<double> link_lengths = {};
  double time_offset = 0.0;  ///< seconds from an image to its poses
  double lens = 0.0;         ///< the first radial coefficient of a distortion that the camera lacks

  /// Returns the true depth where the sensor measures `depth`.
  [[nodiscard]] float corrected(float depth) const {
    return static_cast<float>((depth - depth_offset) / (1.0 + depth_scale));
  }
};

/// The order of the unknowns in a step: the camera's motion in its own frame, depth offset, depth
/// scale, outline, then the depth's shift, the focal lengths, the joints' offsets, the lengths of
/// links, the time offset and the lens where they are estimated.
struct Unknowns {
  static constexpr int pose = 0, depth_offset = 6, depth_scale = 7, outline = 8, shift = 9;
  bool has_shift = false;
  int focal_count = 0;                      ///< 1: fx and fy by the same factor; 2: each by its own
  std::vector<std::size_t> variables = {};  ///< Robot::variables() whose offsets are estimated
  std::size_t accurate = 0;  ///< the last so many of `variables` have zeros within `accuracy`
  double accuracy = 0.0;     ///< rad or m, standard deviation
  std::vector<std::size_t> links = {};  ///< Robot::joints() at the ends of links of unknown length
  bool has_time = false, has_lens = false;
  bool holds_depth = false;  ///< depth offset and scale stay as they are: there may be no depth
  double edge_step = 1.0;    ///< pixels between two values of an edge

  [[nodiscard]] int focal() const { return has_shift ? shift + 2 : shift; }
  [[nodiscard]] int joints() const { return focal() + focal_count; }
  [[nodiscard]] int lengths() const { return joints() + static_cast<int>(variables.size()); }
  [[nodiscard]] int time() const { return lengths() + static_cast<int>(links.size()); }
  [[nodiscard]] int lens() const { return time() + (has_time ? 1 : 0); }
  [[nodiscard]] int size() const { return lens() + (has_lens ? 1 : 0); }
  void step(State& state, const Eigen::VectorXd& by) const;
  /// Of those with an expectation of 0; 0 for the pose and for what is held.
  [[nodiscard]] Eigen::VectorXd values(const State& state) const;
  /// Standard deviations of what is expected before anything is measured; infinite for the pose,
  /// next to nothing for what is held.
  [[nodiscard]] Eigen::VectorXd prior_sigmas() const;
};

enum class Kind : std::uint8_t {
  surface,  ///< distance of a measured point from the robot's surface along its normal, metres
  edge,     ///< distance of the depth's step, or the mask's border without depth, from the rendered
            ///< outline, pixels
  mask      ///< the same of the mask's border where there is depth, too
};
constexpr std::size_t kinds = 3;

/// A residual. Its derivatives by all unknowns are in Residuals::rows.
struct Residual {
  Kind kind;
  std::uint16_t link;
  std::uint32_t frame;
  double value;
};

struct Residuals {
  std::vector<Residual> list;
  std::vector<double> rows;  ///< Unknowns::size() each
};

/// How far from the expected place something is looked for.
struct Reach {
  double depth;   ///< metres between measured and virtual depth
  double pixels;  ///< between the rendered outline and the edge
};

/// The pose of every link in the camera, for any state.
class Model {
 public:
  Model(const Robot& robot, std::size_t parent) : robot_(robot), parent_(parent) {}

  [[nodiscard]] std::vector<Eigen::Isometry3d> T_camera_link(const KeptFrame& frame,
                                                             const State& state) const;
  /// How each link moves in the camera's frame with the unknowns that move links apart from the
  /// camera, from Unknowns::joints() on: by unknown, then by link.
  [[nodiscard]] std::vector<std::vector<Twist>> link_twists(const KeptFrame& frame,
                                                            const State& state,
                                                            const Unknowns& unknowns) const;
  /// Returns where the link that carries the camera is in the root.
  [[nodiscard]] const Eigen::Isometry3d& T_root_parent(const KeptFrame& frame) const {
    return frame.T_root_link[parent_];
  }
  [[nodiscard]] const Robot& robot() const { return robot_; }

 private:
  const Robot& robot_;
  std::size_t parent_;
};

/// A point of the robot's rendered surface in the camera's frame, metres, and the normal there.
struct SurfacePoint {
  Eigen::Vector3d point, normal;

  /// Returns the normal's part along a ray with z = 1; null for a surface that is seen too
  /// obliquely to be compared.
  [[nodiscard]] std::optional<double> along(const Eigen::Vector3d& ray) const {
    constexpr double least_cosine = 0.35;  // of the angle between ray and normal
    const double along = normal.dot(ray);
    return std::abs(along) > least_cosine * ray.norm() ? std::optional(along) : std::nullopt;
  }
  /// Returns the derivative, by a motion of the link, of a measured point's distance from the
  /// surface.
  [[nodiscard]] Twist gradient() const {
    Twist gradient;
    gradient << -point.cross(normal), -normal;
    return gradient;
  }
};
/// Returns whether a pixel shows the robot's surface, and `margin` pixels in each direction, too.
[[nodiscard]] inline bool is_inside(const VirtualDepthView& robot, int u, int v, int margin) {
  constexpr float continuous = 0.02f;  // metres between neighbours of one surface
  const auto& z = robot.depth;
  const float here = z(u, v);
  const auto is_near = [&](int du, int dv) {
    return std::abs(z(u + du, v + dv) - here) < continuous;
  };
  return here > 0.0f && is_near(-margin, 0) && is_near(margin, 0) && is_near(0, -margin) &&
         is_near(0, margin);
}
/// Returns the surface at such a pixel; null at edges between surfaces, and where `ray_of` a pixel
/// is null.
template <typename RayOf>
[[nodiscard]] std::optional<SurfacePoint> surface_at(const VirtualDepthView& robot, int u, int v,
                                                     RayOf&& ray_of) {
  if (!is_inside(robot, u, v, 1)) return {};
  std::array<Eigen::Vector3d, 5> points;
  std::size_t i = 0;
  for (const auto& [du, dv] : {std::pair{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
    const std::optional<Eigen::Vector3d> ray = ray_of(u + du, v + dv);
    if (!ray || robot.links(u + du, v + dv) != robot.links(u, v)) return {};
    points[i++] = *ray * static_cast<double>(robot.depth(u + du, v + dv));
  }
  return SurfacePoint{points[0], (points[2] - points[1]).cross(points[4] - points[3]).normalized()};
}

/// Pixels in which robot and mask are both, and in which one of them is.
struct Overlap {
  std::size_t both = 0, either = 0;

  void add(const ImageView<const float>& robot, const Image<std::uint8_t>& mask);
  [[nodiscard]] double share() const {
    return static_cast<double>(both) / static_cast<double>(std::max<std::size_t>(either, 1));
  }
};

/// Compares frames with the rendered robot.
class Observer {
 public:
  Observer(const Model& model, const Intrinsics& camera, const Unknowns& unknowns);

  /// Adds the frame's residuals at a state.
  void observe(const KeptFrame& frame, std::size_t number, const State& state, const Reach& reach,
               Residuals& out);

  /// Returns how well the robot fits the frame.
  [[nodiscard]] FrameFit fit(const KeptFrame& frame, const State& state);
  /// What a frame with these joints would tell about the pose in a direction, in any unit.
  [[nodiscard]] double information(const KeptFrame& frame, const State& state,
                                   const Twist& direction);
  /// Returns the overlap of the robot and the frames' masks.
  [[nodiscard]] double overlap(std::span<const KeptFrame> frames, const State& state) {
    Overlap sum;
    for (const KeptFrame& frame : frames) sum.add(render(frame, state).depth, frame.mask);
    return sum.share();
  }
  [[nodiscard]] VirtualDepthView render(const KeptFrame& frame, const State& state);
  [[nodiscard]] const Model& model() const { return model_; }
  /// What observe() estimates from now on.
  void set_unknowns(const Unknowns& unknowns) { unknowns_ = unknowns; }

 private:
  struct View;  // one frame at one state
  void add_surface(const View& view, const Reach& reach, Residuals& out) const;
  void add_outlines(const View& view, const Reach& reach, Residuals& out) const;
  void add_row(const View& view, const Residual& residual, const Twist& gradient,
               const Eigen::Vector2d& by_focal, const Eigen::Vector3d& ray, Residuals& out) const;

  const Model& model_;
  Intrinsics nominal_, camera_;  // camera_: with State::focal, that of renderer_
  Unknowns unknowns_;
  int stride_;
  int margin_;  // pixels from the outline inside which depth is not compared
  std::unique_ptr<DepthRenderer> renderer_;
};

/// Normal equations of the residuals that are wrong together.
struct Part {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd steps;  ///< the gradient, by kind, if all were off by the step of their unit

  Part& operator+=(const Part& other);
};

/// The normal equations of frames at one state.
struct Equations {
  std::vector<Part> parts;         ///< by frame, then link; empty: nothing seen
  std::vector<std::size_t> views;  ///< of each part: the first one with the same view of its link
  std::size_t links = 0;
  Eigen::MatrixXd information;  ///< of all, with what is expected of the unknowns
  Eigen::VectorXd gradient;     ///< likewise
  Eigen::VectorXd prior;        ///< inverse squares of Unknowns::prior_sigmas()

  /// The equations if only these unknowns are estimated.
  [[nodiscard]] Equations of(const std::vector<int>& chosen) const;
  /// Returns the step to where the residuals are least, to first order.
  [[nodiscard]] Eigen::VectorXd step() const { return -dense::solve(information, gradient); }
  /// Returns the equations after a step, to first order.
  [[nodiscard]] Equations after(const Eigen::VectorXd& step) const;
  /// Returns the unknowns' covariance, where the gradient is 0. NaN if all frames repeat one view.
  [[nodiscard]] Eigen::MatrixXd covariance() const;
  /// Returns how many times as far the camera's position may be off without each frame.
  [[nodiscard]] std::vector<double> wider_without() const;
};

[[nodiscard]] Equations equations_at(Observer& observer, const Unknowns& unknowns,
                                     std::span<const KeptFrame* const> frames, const State& state);

/// The result of refine().
struct Refined {
  State state;
  Eigen::MatrixXd covariance;  ///< of all unknowns
  std::vector<double> link_residuals;
};

/// Robust least squares from `start`, whose pose is a few centimetres and degrees off at most.
[[nodiscard]] Refined refine(Observer& observer, const Unknowns& unknowns,
                             std::span<const KeptFrame* const> frames, State start);

/// An input that may be wrong.
struct Cause {
  enum class Kind : std::uint8_t { focal, joint, link, clock, lens };
  Kind kind = Kind::focal;
  std::size_t index = 0;  ///< of a joint in Robot::variables(), of a link's end in Robot::joints()

  bool operator==(const Cause&) const = default;
};

/// Returns the causes that a robot and its frames can show.
[[nodiscard]] std::vector<Cause> possible_causes(const Robot& robot,
                                                 std::span<const KeptFrame* const> frames);

/// A cause that explains the residuals much better than the inputs do.
struct FoundCause {
  Cause cause;
  std::vector<Cause> or_else;  ///< that explain them as well
};

/// What explains the residuals of a fit.
struct Explained {
  /// Where the camera is if a cause is true, from the fit's pose.
  struct Pose {
    Twist motion;
    PoseCovariance covariance;
  };
  Unknowns unknowns;  ///< those of the fit and the causes
  Refined fit;        ///< with them
  std::vector<FoundCause> causes = {};
  std::vector<Pose> poses = {};  ///< of the causes, and of one that chance may explain
  /// What would be known of an offset of a joint if it was estimated, too, and then of the camera's
  /// rotation (half axis of the 95 % region); rad or m.
  struct Joint {
    double sigma = 0.0, rotation_error = 0.0;
  };
  std::vector<Joint> joints = {};  ///< order of Robot::variables()
  bool clock_is_untold = false;    ///< the motion is such that another time is another pose
};

/// Frees causes in turn, the best first, while one explains the residuals of `fit` much better than
/// zero does.
[[nodiscard]] Explained explain(Observer& observer, const Unknowns& own,
                                std::span<const KeptFrame* const> frames, const Refined& fit);
/// Returns a clause that names what was found, with its amount.
[[nodiscard]] std::string text_of(const FoundCause& found, const Explained& explained,
                                  const Robot& robot, const Intrinsics& camera);
/// Returns a message about images in words of scans, which `penumbra calibrate` does not read.
[[nodiscard]] std::string of_scans(std::string message);
/// Returns how far a camera is from its calibration, without parts whose 95 % error bar is wider
/// than their value: as in "3.1 +- 0.2 mm and 0.20 +- 0.05 degrees". `digits`: of millimetres.
[[nodiscard]] std::string amount_of(const Drift& drift, int digits);
/// Names a depth offset or scale beyond what sensors have; empty: it is not.
[[nodiscard]] std::string text_of_depth(const Refined& fit);
/// Returns how the camera moves if the depth is within what sensors have.
[[nodiscard]] Twist motion_with_usual_depth(Observer& observer, const Unknowns& own,
                                            std::span<const KeptFrame* const> frames,
                                            const State& state);

/// Frames on images of about 128 columns, with the robot's meshes simplified.
class SmallFrames {
 public:
  struct Small {
    const KeptFrame* frame;
    Image<float> depth;
    Image<std::uint8_t> moved;  ///< 1: nearer than the background; without depth, the mask
    Image<float> grey;          ///< of a colour image in place of both, as bright as most
    float brightness = 1.0f;    ///< factor that makes it so
    TileMask moved_tiles;       ///< with a pixel of `moved`; only with depth
  };
  static constexpr double occluded = 0.3;  ///< cost of a pixel with something before the robot
  static constexpr double missed = 0.5;    ///< of one that moved and is not the robot

  SmallFrames(const Robot& robot, const Intrinsics& camera,
              std::span<const KeptFrame* const> frames);

  [[nodiscard]] const std::vector<Small>& frames() const { return frames_; }
  /// Returns the camera of the small images.
  [[nodiscard]] const Intrinsics& camera() const { return renderer_->intrinsics(); }
  /// Sets another camera of the whole images.
  void set_camera(const Intrinsics& camera);
  /// Finds what moved before a camera that is fixed, by depth times this factor.
  void find_moved(double depth_factor = 1.0);
  [[nodiscard]] VirtualDepthView render(std::span<const Eigen::Isometry3d> T_camera_link) {
    return renderer_->render(T_camera_link);
  }
  /// Calls f(first, end, v) for parts of rows with at least all pixels of the robot and of what
  /// moved.
  template <typename F>
  static void for_each_part(const Small& small, const VirtualDepthView& robot, F&& f) {
    const int step = robot.touched->tile_width, width = robot.depth.width;
    for (int v = 0; v < robot.depth.height; ++v)
      for (int first = 0; first < width; first += step)
        if (robot.touched->holds(first, v) || small.moved_tiles.holds(first, v))
          f(first, std::min(first + step, width), v);
  }
  /// Brings colour images to the brightness of most, finds what moved in them, and leaves out those
  /// that show another view than most.
  void compare_colors();
  /// Returns a sum over pixels as a share of `most` of them. A robot out of view, or a speck, is as
  /// bad as one in free space.
  [[nodiscard]] double score(double sum, double most, double frames) const;

 private:
  int block_;  // pixels of a whole image that become one, in each direction
  std::vector<Small> frames_;
  double moved_factor_ = 0.0;                      // for which `moved` holds
  std::vector<std::vector<PreparedMesh>> meshes_;  // of each link
  std::unique_ptr<DepthRenderer> renderer_;
};

/// Rates setups by the colour images of a camera that stands still: a pixel's background is seen in
/// the frames in which the robot is elsewhere, and what the robot covers differs from it.
class ColorScore {
 public:
  explicit ColorScore(SmallFrames& frames);

  /// Returns how much better the images are explained than by a scene in which nothing moves, of
  /// what could be; less than 0: worse. `T_camera_link`: of a frame by its number. `covering`: a
  /// factor of what a covered pixel costs.
  [[nodiscard]] double score(
      const std::function<std::vector<Eigen::Isometry3d>(std::size_t)>& T_camera_link,
      std::size_t every_frame = 1, double covering = 1.0);

 private:
  void find_costs(int v, int first, int end, bool is_still);

  SmallFrames& frames_;
  std::vector<Image<float>> bare_;  // by frame, 1 where the robot does not cover
  std::vector<float> all_bare_;     // a row of such
  std::array<std::vector<float>, 4> sums_;
  Image<float> seen_;            // 0: outside of what the lens shows
  Image<float> still_;           // each pixel's cost if the robot covers none
  std::size_t every_frame_ = 0;  // for which still_ holds
  double covering_ = 1.0;
  double explainable_ = 0.0;  // the sum of still_
};

/// A factor of what a covered pixel costs, with which a robot is found that has little contrast to
/// its background.
constexpr double low_contrast = 0.3;

/// Returns the number of frames by which joints are shifted to compare them with those of others.
[[nodiscard]] inline std::size_t half_of(std::size_t frames) {
  return std::max<std::size_t>(1, frames / 2);
}

/// Rates camera poses on small images: agreement of measured and virtual depth, against what was
/// measured behind the robot's surface and what moved and is not the robot. Without depth:
/// intersection over union of robot and masks; by colours, how much of the images' changes the
/// robot explains.
class PoseSearch {
 public:
  PoseSearch(const Model& model, const Intrinsics& camera, std::span<const KeptFrame* const> frames,
             bool camera_is_fixed, std::uint64_t seed);

  /// Returns the score: at most 1 if all of the robot's pixels agree.
  [[nodiscard]] double score(const State& state, std::size_t every_frame = 1);
  [[nodiscard]] double score(const Eigen::Isometry3d& T_parent_camera, std::size_t every_frame = 1);
  /// Returns the score; of colour images, how much lower it is with the joints of other frames: a
  /// pose that covers what changes by itself explains as much with them.
  [[nodiscard]] double rating(const State& state, std::size_t every_frame = 1);
  /// Returns the score of colour images with the joints of other frames.
  [[nodiscard]] double score_of_others(const State& state, std::size_t every_frame = 1) {
    return score_colors(state, every_frame, half_of(frames().size()));
  }
  /// Returns the images that are used.
  [[nodiscard]] std::span<const SmallFrames::Small> frames() const { return small_.frames(); }
  /// Returns the best pose near `start`: within 100 mm and 10 degrees.
  [[nodiscard]] Eigen::Isometry3d near(const Eigen::Isometry3d& start);
  /// Returns candidates from everywhere, the best first; or the best one within about 300 mm and
  /// 20 degrees of `around`. `covering`: as of ColorScore.
  [[nodiscard]] std::vector<Eigen::Isometry3d> candidates(
      const std::optional<Eigen::Isometry3d>& around = {}, double covering = 1.0);

 private:
  struct Anchor {
    Eigen::Vector3d in_camera = Eigen::Vector3d::Zero(), in_parent = Eigen::Vector3d::Zero();
  };
  [[nodiscard]] Eigen::Isometry3d narrowed(const Eigen::Isometry3d& start,
                                           const std::array<double, 3>& costs);
  [[nodiscard]] double score_colors(const State& state, std::size_t every_frame,
                                    std::size_t shift = 0);
  void find_anchors();
  [[nodiscard]] Eigen::Isometry3d guess(std::mt19937_64& random,
                                        const std::optional<Eigen::Isometry3d>& around) const;
  [[nodiscard]] Eigen::Isometry3d climb(Eigen::Isometry3d mean, const Twist& sigma, int rounds,
                                        const std::optional<Eigen::Isometry3d>& around);

  const Model& model_;
  SmallFrames small_;
  std::vector<Anchor> anchors_;  // by frame; empty for a camera on a moving link
  std::uint64_t seed_;
  double tolerance_;                  // metres
  double cost_of_covering_ = 1.0;     // of colours
  std::optional<ColorScore> colors_;  // null: depth or masks
};

constexpr int narrow_part = 128;
/// The least overlap of the robot with such masks. On the shared webcams poses that are centimetres
/// off have 0.64 to 0.70, right ones of ten images and more 0.75 to 0.82.
constexpr double least_by_color = 0.72;
/// Makes masks from the colours of a fixed camera, for a pose that is known within this part of the
/// image's width: a margin of 1 / `part`.
/// A pixel's background is seen in frames in which the robot is farther off than the margin. What
/// differs from it is robot, and what is farther from the robot than that is not known. `small`: of
/// these frames, in their order; the masks of others know nothing.
void mask_by_color(std::vector<KeptFrame>& frames, std::span<const SmallFrames::Small> small,
                   Observer& observer, const State& state, int part = narrow_part);
/// Fits a pose that is known to about a thirtieth of the image's width to the borders of masks that
/// the colours give there, and there again. `frames`: those of the search, which get the masks
/// of the result.
[[nodiscard]] Refined refine_by_color(std::vector<KeptFrame>& frames, const PoseSearch& search,
                                      Observer& observer, const Unknowns& unknowns,
                                      const Eigen::Isometry3d& start);

}  // namespace penumbra::calibration
