// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>

#include <penumbra/base/image.hpp>
#include <penumbra/base/setting.hpp>
#include <penumbra/camera/camera.hpp>

namespace penumbra {

/// The result of comparing the measured with the virtual depth of a pixel.
enum class Label : std::uint8_t {
  clear = 0,     ///< no robot on this ray
  front = 1,     ///< something real is in front of the robot
  occluded = 2,  ///< the sensor sees the robot, which hides what is behind it
  unknown = 3,   ///< robot on the ray, no measurement; never counted as visible
  beyond = 4,    ///< the sensor sees past the model, which is too large or out of place there
  fringe = 5,    ///< no robot on this ray, but the sensor reports the robot's depth: the depth is
                 ///< invalid, and nothing is hidden
};
inline constexpr std::size_t label_count = 6;

/// Whether the measurement at a pixel of this label is real and not of the robot.
[[nodiscard]] constexpr bool is_trusted(Label label) {
  return label == Label::clear || label == Label::front;
}

/// How much of a target is hidden, by the labels of its pixels.
enum class Verdict {
  visible,
  partial,
  hidden,
  unknown,
  out_of_view,
  held  ///< a link carries it: an attached body has its name, and no pixels are judged
};

/// In their order.
inline constexpr std::array all_verdicts = {Verdict::visible, Verdict::partial,     Verdict::hidden,
                                            Verdict::unknown, Verdict::out_of_view, Verdict::held};

/// The verdict's name in report.json.
[[nodiscard]] std::string_view to_string(Verdict verdict);

/// e(z) = a + b z + c z^2, metres: how far in front of the model a measurement may be and still be
/// of the robot.
struct Tolerance {
  double a = 0.015;  ///< metres
  double b = 0.0;    ///< metres per metre
  double c = 0.006;  ///< metres per square metre, as stereo noise grows

  [[nodiscard]] double at(double z) const { return a + (b + c * z) * z; }

  /// Whether it is not negative at any depth, and each number is below 1: no sensor is as coarse as
  /// 1 m, and millimetres are taken for metres.
  [[nodiscard]] bool is_valid() const;

  bool operator==(const Tolerance&) const = default;
};

/// The rule of labelling. docs/tuning.md describes how the defaults were measured and how to choose
/// others.
///
/// d is the measured and dV the virtual depth of a pixel, in float32.
///
/// 1. Compare. A pixel of the robot is unknown if d is no measurement, beyond if
///    d > dV + k e(dV), front if d < dV - e(dV), else occluded.
/// 2. Clean up. The sensor sees the robot's edges blurred and, due to calibration, out of place, so
///    front pixels without an object's width become occluded (an opening by reconstruction):
///    - The limit of a pixel, on the robot or not, is n - e(n). n is the least dV of the cells, of
///      `cell` pixels squared, at most ceil(edge_margin / cell) cells from the pixel's.
///    - Foreground: the pixels with d below their limit. A pixel without measurement is foreground
///      too if it lies between two such pixels, at most front_min_width pixels away, in its row or
///      in its column. Without a robot near, no pixel is foreground.
///    - Seeds: the front pixels with d below their limit that lie in a square of front_min_width
///      pixels, inside the image, that is all foreground.
///    - Seeds, and front pixels at most edge_margin / 2 pixels from a seed in both u and v, stay
///      front.
///    So an object keeps its full width at the robot's silhouette, holes do not split it, and a
///    seam along an edge of the robot is no object.
/// 3. Fringe. Sensors report the robot's depth past its outline: stereo matching fattens it, gaps
///    between links are filled, and mixed pixels lie between the robot and the background. A flood
///    fill over blocks of 2 x 2 pixels finds such pixels:
///    - A block's depth is the nearest of its occluded pixels or, without any, of its clear,
///      measured ones. The flood starts from the blocks with occluded pixels.
///    - It continues, breadth first, from block p to one of the four neighbours q without occluded
///      pixels if |d(q) - d(p)| <= fringe_step e(d(s)), |d(q) - d(s)| <= fringe_drift e(d(s)), and
///      q lies within fringe_reach of s, the block that the flood reached p from.
///    - The clear pixels of these blocks become fringe if they differ from their block's depth by
///      at most 2 fringe_step e(d(s)).
///    A real object at the robot's depth that touches its outline is fringe up to fringe_reach; one
///    image cannot tell them apart.
/// 4. Memory, of a Pipeline whose camera stands still and whose frames have stamps. A pixel stays
///    clear if its depth differs by at most fringe_step e(d(s)) from what was measured there when
///    no robot was within fringe_reach, or 40 pixels, and if, through such pixels at most 16 pixels
///    apart, it has contact with one outside of the fringe. That is forgotten after `scene_memory`
///    seconds, where the camera sees past it, and where the robot comes within fringe_drift e(z) of
///    it.
///
/// In the code: pixel_labels-inl.hpp compares, foreground_pixels-inl.hpp and front_cleanup-inl.hpp
/// clean up, fringe-inl.hpp floods; label_simd.cpp calls them in order. scene_memory.hpp remembers.
struct LabelRule {
  static constexpr int cell = 4;               ///< pixels
  static constexpr int max_width = 63;         ///< pixels, of front_min_width
  static constexpr double fringe_step = 0.6;   ///< of e(z), from one block to the next
  static constexpr double fringe_drift = 3.0;  ///< of e(z), from the outline's depth

  Tolerance tolerance;
  double beyond_factor = 2.0;
  int front_min_width = 7;
  int edge_margin = 8;
  int fringe_reach = 40;
  double scene_memory = 60.0;  ///< seconds
  bool fold_beyond = false;    ///< label beyond as occluded
  DepthRange range;            ///< measured depths outside of it are no measurements

  bool operator==(const LabelRule&) const = default;

  /// The settings that files, options and parameters have. The paper's rule folds beyond; the range
  /// is the camera's.
  static constexpr auto settings() {
    return std::tuple(
        Setting("tolerance", &LabelRule::tolerance, {}, "m, m/m, m/m^2",
                "A, B, C, each below 1, of e(z) = A + B z + C z^2 >= 0 metres: depth that differs "
                "by less is the "
                "same"),
        Setting("front_min_width", &LabelRule::front_min_width, {0, max_width}, "px",
                "front regions narrower than this become occluded; 0: no clean-up"),
        Setting("edge_margin", &LabelRule::edge_margin, {0, 64}, "px",
                "how far an edge of the robot may be out of place; 0: the clean-up ignores edges"),
        Setting("fringe_reach", &LabelRule::fringe_reach, {0, 255}, "px",
                "how far past its outline the sensor shows the robot's depth; 0: no fringe"),
        Setting(
            "scene_memory", &LabelRule::scene_memory, {0, 3600}, "s",
            "how long what was measured before the robot came keeps real things next to it from "
            "being fringe; 0: not at all"),
        Setting("beyond_factor", &LabelRule::beyond_factor, {1, 1000}, "",
                "how many tolerances behind the model beyond starts"));
  }

  /// Returns the paper's rule: 0.01 m everywhere, no clean-up, no fringe, beyond folded. Pixels
  /// without measurement stay unknown.
  [[nodiscard]] static LabelRule paper();

  /// Returns the rule of a sensor: realsense_d4xx (the default, measured), zed, tof,
  /// structured_light (starting points for `penumbra tune`) or none (no fringe). Throws InputError
  /// for another name.
  [[nodiscard]] static LabelRule for_sensor(std::string_view name);

  /// Throws InputError, with the values, for settings out of their range, an invalid tolerance and
  /// near >= far.
  void check() const;
};

struct LabelView {
  ImageView<const std::uint8_t> labels;           ///< Label values
  std::array<std::size_t, label_count> pixels{};  ///< how many pixels have each label
  const TileMask* touched = nullptr;              ///< outside of these tiles every label is clear
};

/// Labels depth images of one size. Allocates nothing per image.
class Classifier {
 public:
  /// `isa` as in RendererOptions. Throws InputError for a rule that fails its check, a size outside
  /// 1..Intrinsics::max_size or an unknown isa.
  Classifier(int width, int height, const LabelRule& rule, const std::string& isa = {});
  ~Classifier();
  Classifier(Classifier&&) noexcept;
  Classifier& operator=(Classifier&&) noexcept;

  /// Labels every pixel. All images must have the classifier's size. Without a tile mask, the
  /// whole virtual depth is read. `known`: SceneMemory::depth(); empty: none. The view is valid
  /// until the next call.
  [[nodiscard]] LabelView classify(const VirtualDepthView& virtual_depth, const DepthView& measured,
                                   ImageView<const std::uint16_t> known = {});

  [[nodiscard]] const LabelRule& rule() const;
  [[nodiscard]] const std::string& isa() const;  ///< the target in use

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The rule of labelling points. r is a point's distance from the sensor's origin, s that of the
/// robot's first surface on the point's ray.
///
/// 1. A point whose ray meets the robot is front if r < s - e(s), beyond if r > s + k e(s), else
///    occluded.
/// 2. A point whose ray misses the robot is clear.
/// 3. A beam is as wide as `beam` to all sides, and may return a mixture of what it meets. Clear
///    and front points become fringe if a ray at most `beam` from theirs (or up to 0.14 degrees
///    more) meets the robot at s, and s - e(s) <= r <= s + mixing.
struct CloudRule {
  Tolerance tolerance{0.03, 0.0, 0.0};  ///< e(s)
  double beyond_factor = 2.0;           ///< k
  double beam = 0.003;                  ///< radians
  double mixing = 0.5;                  ///< metres

  static constexpr double max_beam = 0.01, max_mixing = 100.0;

  static constexpr auto settings() {
    return std::tuple(
        Setting("tolerance", &CloudRule::tolerance, {}, "m, m/m, m/m^2",
                "A, B, C, each below 1, of e(s) = A + B s + C s^2 >= 0 metres: a range that "
                "differs by less is "
                "the same"),
        Setting("beyond_factor", &CloudRule::beyond_factor, {1, 100}, "",
                "how many tolerances behind the model beyond starts"),
        Setting("beam", &CloudRule::beam, {0, max_beam}, "rad",
                "how far from a point's ray its return may come: half of the beam, and "
                "errors of the robot's pose"),
        Setting("mixing", &CloudRule::mixing, {0, max_mixing}, "m",
                "how far behind the robot a return may lie that mixes it with what is behind"));
  }

  /// Returns the rule of a sensor: lidar_2cm (the default), livox_mid360, ouster_os1 or hokuyo. All
  /// are estimates from data sheets. Throws InputError for another name.
  [[nodiscard]] static CloudRule for_sensor(std::string_view name);

  /// Throws InputError for settings out of range.
  void check() const;
};

}  // namespace penumbra
