// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include <penumbra/base/image.hpp>
#include <penumbra/base/tile_mask.hpp>
#include <penumbra/base/virtual_depth.hpp>
#include <penumbra/camera/camera.hpp>

namespace penumbra {

/// What the comparison of measured and virtual depth says of a pixel.
enum class Label : std::uint8_t {
  clear = 0,     ///< no robot on this ray
  front = 1,     ///< something real stands before the robot
  occluded = 2,  ///< the sensor sees the robot: what was wanted there is hidden
  unknown = 3,   ///< robot on the ray, no measurement; never counted as visible
  beyond = 4,    ///< the sensor sees past the model: model too large or out of place there
  fringe = 5,    ///< no robot on this ray, but the sensor carried the robot's depth here: the depth
                 ///< is not to be trusted, and nothing is hidden
};
inline constexpr std::size_t label_count = 6;

/// Whether what the sensor measured at a pixel of this label is real and no robot.
[[nodiscard]] constexpr bool is_trusted(Label label) {
  return label == Label::clear || label == Label::front;
}

/// e(z) = a + b z + c z^2, metres: how far a measured depth may lie before the model and still be
/// the robot.
struct Tolerance {
  double a = 0.015;  ///< metres
  double b = 0.0;    ///< metres per metre
  double c = 0.006;  ///< metres per square metre: stereo noise grows so

  [[nodiscard]] double at(double z) const { return a + (b + c * z) * z; }
};

/// The rule of labelling. docs/tuning.md says how the defaults were measured and
/// how to choose others.
///
/// With d the measured and dV the virtual depth of a pixel of the robot, computed in float32:
/// unknown where d is no measurement, beyond where d > dV + k e(dV), front where d < dV - e(dV),
/// else occluded. Then the clean-up: a front pixel stays front only if it is confirmed, else it
/// becomes occluded.
///
/// The sensor sees the robot's edges blurred and, by calibration, out of place. So a pixel of the
/// image, on the robot or beside it, counts as certain only if its d < n - e(n), with n the nearest
/// virtual depth anywhere within edge_margin pixels (in steps of cell pixels: n is the least dV of
/// the cells of the pixel grid that lie at most ceil(edge_margin / cell) cells from the pixel's, so
/// that up to cell - 1 pixels more are looked at; where no robot is near, no pixel is certain). A
/// pixel without measurement counts as certain between two certain ones: at most front_min_width
/// pixels away from it, left and right in its row, or above and below in its column. The seeds are
/// the front pixels, certain themselves, that lie in a square of front_min_width pixels inside the
/// image all of whose pixels count as certain. Confirmed are the seeds and the front pixels at most
/// edge_margin / 2 pixels from one in both u and v.
///
/// So an object that reaches past the robot's silhouette is not worn away at it, a hole in an
/// object does not break it up, and a seam along an edge of the robot is no object.
///
/// Fringe: real sensors carry the robot's depth past its outline. Stereo matching fattens it, gaps
/// between links are filled, and mixed pixels lie between the robot's depth and the background's.
/// A flood over blocks of 2 x 2 pixels finds such pixels. A block's depth is the nearest of its
/// occluded pixels, if it has any, else the nearest of its clear, measured ones. The flood starts
/// from the blocks with occluded pixels and goes on, breadth first, from block p to a neighbour q
/// (of four) without occluded pixels if
///   |d(q) - d(p)| <= fringe_step e(d(s)), |d(q) - d(s)| <= fringe_drift e(d(s))
/// and q lies within fringe_reach of s, where s is the block that the flood reached p from. The
/// clear pixels of the blocks that it starts from and reaches become fringe where they differ from
/// their block's depth by at most 2 fringe_step e(d(s)). A real object at the robot's own depth
/// that touches its outline is fringe up to fringe_reach; no rule on one image can tell.
struct LabelRule {
  static constexpr int cell = 4;                ///< pixels
  static constexpr int max_width = 63;          ///< pixels, of front_min_width
  static constexpr int max_edge_margin = 64;    ///< pixels
  static constexpr int max_fringe_reach = 255;  ///< pixels
  static constexpr double fringe_step = 0.6;    ///< of e(z), from one block to the next
  static constexpr double fringe_drift = 3.0;   ///< of e(z), from the outline's depth

  Tolerance tolerance;
  double beyond_factor = 2.0;  ///< k: beyond is past dV + k e(dV)
  int front_min_width = 7;     ///< pixels; 0: no clean-up
  int edge_margin = 8;         ///< pixels by which an edge of the robot may look out of place;
                               ///< 0: front pixels are certain, those beside the robot are not
  int fringe_reach = 40;       ///< pixels past the outline that the sensor carries depth; 0: no
                               ///< fringe
  bool fold_beyond = false;    ///< call beyond occluded
  DepthRange range;            ///< measured depths outside of it are no measurements

  /// The paper as written: 0.01 m everywhere, no clean-up, no fringe, beyond folded; no
  /// measurement stays unknown.
  [[nodiscard]] static LabelRule paper();

  /// The rule of a kind of sensor. realsense_d4xx (the default) is measured, the others are
  /// guesses to start `penumbra tune` from; none: no fringe. Throws InputError for another name.
  [[nodiscard]] static LabelRule for_sensor(std::string_view name);

  /// Throws InputError, with the values it got: a tolerance that is not finite or negative
  /// at some depth, factor < 1, width, margin or reach out of bounds, near >= far.
  void check() const;
};

struct LabelView {
  ImageView<const std::uint8_t> labels;           ///< Label values
  std::array<std::size_t, label_count> pixels{};  ///< how many pixels have each label
  const TileMask* touched = nullptr;              ///< outside of these tiles every label is clear
};

/// Labels depth images of one size. Holds its buffers; allocates nothing per image.
class Classifier {
 public:
  /// `isa` as in RendererOptions; "scalar" takes the plain twin, whose labels are the same. Throws
  /// InputError for a rule that fails its check, a size outside 1..Intrinsics::max_size or an isa
  /// that is not there.
  Classifier(int width, int height, const LabelRule& rule, const std::string& isa = {});
  ~Classifier();
  Classifier(Classifier&&) noexcept;
  Classifier& operator=(Classifier&&) noexcept;

  /// Labels every pixel. Both images must have the classifier's size; where the virtual depth has
  /// no tile mask, all of it is looked at. The view is valid until the next call.
  [[nodiscard]] LabelView classify(const VirtualDepthView& virtual_depth,
                                   const DepthView& measured);

  [[nodiscard]] const LabelRule& rule() const;
  [[nodiscard]] const std::string& isa() const;  ///< the target in use

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra
