// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>
#include <cmath>
#include <sstream>

#include <penumbra/base/error.hpp>
#include <penumbra/base/simd_target.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/labels/fringe-inl.hpp>
#include <penumbra/labels/label_work-inl.hpp>
#include <penumbra/labels/labels.hpp>

namespace penumbra {
namespace {

template <typename... Parts>
[[noreturn]] void fail(const Parts&... parts) {
  std::ostringstream message;
  (message << ... << parts);
  throw InputError(message.str());
}

}  // namespace

std::string_view to_string(Verdict verdict) {
  constexpr std::array<std::string_view, 6> names = {"visible", "partial",     "hidden",
                                                     "unknown", "out_of_view", "held"};
  return names[static_cast<std::size_t>(verdict)];
}

bool Tolerance::is_valid() const {
  const bool is_negative = a < 0.0 || c < 0.0 || (b < 0.0 && b * b > 4.0 * a * c);
  return a < 1.0 && std::abs(b) < 1.0 && c < 1.0 && !is_negative;
}

LabelRule LabelRule::paper() {
  LabelRule rule;
  rule.tolerance = {0.01, 0.0, 0.0};
  rule.front_min_width = 0;
  rule.edge_margin = 0;
  rule.fringe_reach = 0;
  rule.scene_memory = 0.0;
  rule.fold_beyond = true;
  return rule;
}

LabelRule LabelRule::for_sensor(std::string_view name) {
  struct Sensor {
    std::string_view name;
    Tolerance tolerance;
    int fringe_reach;
  };
  static constexpr Sensor sensors[] = {{"realsense_d4xx", {}, 40},
                                       {"zed", {0.015, 0.0, 0.009}, 40},
                                       {"tof", {0.015, 0.004, 0.0}, 6},
                                       {"structured_light", {0.01, 0.0, 0.004}, 12},
                                       {"none", {}, 0}};
  for (const Sensor& sensor : sensors) {
    if (sensor.name != name) continue;
    LabelRule rule;
    rule.tolerance = sensor.tolerance;
    rule.fringe_reach = sensor.fringe_reach;
    return rule;
  }
  fail("sensor '", name, "': expected realsense_d4xx, zed, tof, structured_light or none");
}

void LabelRule::check() const {
  check_settings(*this);
  const Tolerance& e = tolerance;
  if (!e.is_valid())
    fail("tolerance ", e.a, ",", e.b, ",", e.c,
         ": a + b z + c z^2 must not be negative at any depth, and each number be below 1; is a in "
         "metres?");
  if (!(range.near >= 0.0 && range.near < range.far))
    fail("sensor range ", range.near, "..", range.far, " m: near must be 0 or more and below far");
}

struct Classifier::State {
  State(int width, int height, const LabelRule& label_rule, std::int64_t target)
      : rule(label_rule),
        isa(simd_target_name(target)),
        label(labelling::label_kernel(target)),
        label_fringe(labelling::fringe_kernel(target)),
        work(width, height, labelling::Rule(rule)),
        fringe(width, height, rule.fringe_reach),
        everything(width, height) {
    everything.mark(0, 0, width - 1, height - 1);
  }

  LabelRule rule;
  std::string isa;
  labelling::LabelKernel label;
  labelling::LabelFringe label_fringe;
  labelling::Work work;
  labelling::Fringe fringe;
  TileMask everything;
};

Classifier::Classifier(int width, int height, const LabelRule& rule, const std::string& isa) {
  rule.check();
  if (width < 1 || height < 1 || width > Intrinsics::max_size || height > Intrinsics::max_size)
    fail("image size ", width, " x ", height, ": must be 1 to ", Intrinsics::max_size, " pixels");
  state_ = std::make_unique<State>(width, height, rule, simd_target(isa));
}

Classifier::~Classifier() = default;
Classifier::Classifier(Classifier&&) noexcept = default;
Classifier& Classifier::operator=(Classifier&&) noexcept = default;

const LabelRule& Classifier::rule() const { return state_->rule; }
const std::string& Classifier::isa() const { return state_->isa; }

LabelView Classifier::classify(const VirtualDepthView& virtual_depth, const DepthView& measured,
                               ImageView<const std::uint16_t> known) {
  labelling::Work& work = state_->work;
  const TileMask& touched =
      virtual_depth.touched != nullptr ? *virtual_depth.touched : state_->everything;
  assert(virtual_depth.depth.width == work.width && virtual_depth.depth.height == work.height);
  assert(touched.width == work.width && touched.height == work.height);
  assert(touched.tile_width % 32 == 0);
  work.begin(touched);
  assert(std::visit([&](const auto& d) { return d.width == work.width && d.height == work.height; },
                    measured));
  LabelView view;
  view.pixels = state_->label(work, virtual_depth.depth, measured);
  view.pixels[static_cast<std::size_t>(Label::fringe)] =
      state_->label_fringe(state_->fringe, work, measured, known);
  std::size_t labelled = 0;
  for (const std::size_t pixels : view.pixels) labelled += pixels;
  view.pixels[static_cast<std::size_t>(Label::clear)] = work.labels.size() - labelled;
  view.labels = work.labels.view();
  view.touched = &work.touched;
  return view;
}

}  // namespace penumbra
