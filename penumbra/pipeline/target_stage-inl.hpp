// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <penumbra/labels/labels.hpp>
#include <penumbra/pipeline/frame_labeller-inl.hpp>
#include <penumbra/pipeline/recent_frames-inl.hpp>
#include <penumbra/pipeline/target.hpp>
#include <penumbra/pipeline/target_record-inl.hpp>
#include <penumbra/pipeline/target_views-inl.hpp>
#include <penumbra/targets/target_judge.hpp>

namespace penumbra {

/// Judges a frame's targets and follows those that are handled.
class TargetStage {
 public:
  /// A target that was not given in so many calls is forgotten.
  static constexpr std::size_t forgotten_after = 300;

  struct Setup {
    const Robot& robot;
    const Camera& camera;  ///< of the images that are judged
    LabelRule rule;
    Backend backend = Backend::cpu;  ///< of objects that are rendered alone
    RendererOptions renderer;
    Intrinsics render_intrinsics;
    const Rectification* rectification = nullptr;  ///< as ObjectRenderers takes it
    ImageView<const std::uint8_t> unseen = {};     ///< as TargetJudge takes it
    double history = 0;                            ///< seconds that frames are kept
    FrameLabeller* late_labeller = nullptr;        ///< not null if history > 0
  };

  explicit TargetStage(const Setup& setup);

  /// Judges the targets; the reports are valid until the next call. Keeps the frame for late ones.
  std::span<const TargetReport> process(std::span<const Target> targets,
                                        const LabelledFrame& frame);

  void forget(std::string_view name);
  void forget_all();

 private:
  struct Hash {
    using is_transparent = void;
    std::size_t operator()(std::string_view name) const {
      return std::hash<std::string_view>()(name);
    }
  };
  using Memories = std::unordered_map<std::string, TargetRecord, Hash, std::equal_to<>>;

  /// What a report refers to.
  struct Slot {
    Memories::value_type* known = nullptr;
    const LabelledFrame* seen = nullptr;  ///< that the target was judged on, in order
    std::vector<Blame> blame;
    std::string reason;
  };

  void begin(std::span<const Target> targets, const LabelledFrame& frame);
  Memories::value_type& known(std::string_view name);
  void forget_unused(std::size_t given);

  void judge(const Target& target, const LabelledFrame& frame, Slot& slot, TargetReport& report);
  const LabelledFrame& frame_of(const Target& target, const LabelledFrame& frame);
  const LabelledFrame& late_frame(std::int64_t stamp);
  void check(const Target& target, TargetRecord& memory) const;
  static void doubt(const LabelledFrame& frame, Slot& slot, TargetReport& report);
  Judgement judge_on(const LabelledFrame& frame, const Target& target, Slot& slot);
  void expect_motion(const LabelledFrame& frame, const TargetRecord& memory,
                     TargetView& view) const;
  [[nodiscard]] std::optional<Eigen::Vector2d> track_pixel(const LabelledFrame& frame,
                                                           const TargetRecord& memory) const;

  void handle(const Target& target, const LabelledFrame& frame, const Slot& slot,
              TargetReport& report) const;
  Outcome feed(const TargetEstimate& estimate, std::int64_t stamp, TargetRecord& memory) const;

  const Robot& robot_;
  const Camera& camera_;
  TargetJudge judge_;
  ObjectRenderers renderers_;
  TargetViews views_;
  RecentFrames recent_frames_;
  FrameLabeller* late_labeller_;
  LabelledFrame late_;  // the late frame that was labelled last in this call
  Memories memories_;
  std::deque<std::string> without_identity_;  // names in memories_ of the last call
  std::size_t calls_ = 0;
  std::optional<std::int64_t> newest_stamp_;
  const LabelledFrame* judged_ = nullptr;  // that the judge's begin() was called with
  std::deque<Slot> slots_;                 // grows only
  std::vector<TargetReport> reports_;      // likewise
};

}  // namespace penumbra
