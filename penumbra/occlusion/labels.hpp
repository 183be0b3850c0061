// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

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
};
inline constexpr std::size_t label_count = 5;

/// e(z) = a + b z + c z^2, metres: how far a measured depth may lie before the model and still be
/// the robot.
struct Tolerance {
  double a = 0.02;   ///< metres
  double b = 0.0;    ///< metres per metre
  double c = 0.012;  ///< metres per square metre: stereo noise grows so

  [[nodiscard]] double at(double z) const { return a + (b + c * z) * z; }
};

/// The rule of labelling (DESIGN section 1.3). Defaults are measured: docs/tolerance.md.
struct LabelRule {
  Tolerance tolerance;
  double beyond_factor = 2.0;  ///< k: beyond is past dV + k e(dV)
  int front_min_width = 5;     ///< pixels: narrower front regions become occluded; 0: off
  bool fold_beyond = false;    ///< call beyond occluded
  DepthRange range;            ///< measured depths outside of it are no measurements

  /// The paper as written: 0.01 m everywhere, no clean-up, beyond folded; no measurement stays
  /// unknown.
  [[nodiscard]] static LabelRule paper();

  /// Throws InputError, with the values it got: a tolerance that is not finite or negative
  /// somewhere in 0..20 m, factor < 1, width < 0, near >= far.
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
  /// `isa` as in RendererOptions; "scalar" takes the plain twin.
  Classifier(int width, int height, const LabelRule& rule, const std::string& isa = {});
  ~Classifier();
  Classifier(Classifier&&) noexcept;
  Classifier& operator=(Classifier&&) noexcept;

  /// Labels every pixel. Both images must have the classifier's size. The view is valid until the
  /// next call.
  [[nodiscard]] LabelView classify(const VirtualDepthView& virtual_depth,
                                   const DepthView& measured);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra
