// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <penumbra/camera/camera.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/pipeline/statistics.hpp>

#include <apps/penumbra/run_input.hpp>
#include <apps/penumbra/run_output.hpp>
#include <apps/penumbra/run_summary.hpp>
#include <io/files/report_json.hpp>
#include <io/files/targets_file.hpp>

namespace penumbra::app {

/// An input with its pipeline, judged frame by frame: what `run` and `view` have in common.
class Judging {
 public:
  /// Opens the input, and says on stdout what of a bag is taken. Throws InputError that names the
  /// file.
  explicit Judging(const RunArguments& arguments);

  [[nodiscard]] const RunInput& input() const { return input_; }
  [[nodiscard]] const Pipeline& pipeline() const { return pipeline_; }
  [[nodiscard]] const Camera& camera() const { return camera_; }  ///< of the report's images
  [[nodiscard]] std::optional<std::size_t> size() const { return source_->size(); }
  /// Refers to this.
  [[nodiscard]] io::ReportHead head() const;

  /// Judges the frames into `output`, which has begun, and finishes it. `go_on` is asked after each
  /// frame; where it says no, later ones are not judged, and the answer is false. Throws InputError
  /// where the first usable frame shows a fault of the input, and what `output` throws.
  bool run(RunOutput& output, const std::function<bool()>& go_on);

  /// Prints faults, notes, counts and times. To be called after run().
  void tell(const std::string& where) const;
  /// Of `run`.
  [[nodiscard]] int status() const;

 private:
  void judge_frames(RunOutput& output, const std::function<bool()>& go_on);

  const RunArguments& arguments_;
  RunInput input_;
  Camera camera_;
  std::optional<io::TargetsFile> targets_;
  Pipeline pipeline_;
  std::unique_ptr<io::FrameSource> source_;
  std::vector<std::string> late_notes_;
  Statistics statistics_;
  ColorFaults color_;
  std::vector<std::string> sequence_notes_;
  std::string lost_;  // why later frames are not judged
  bool stopped_ = false;
};

}  // namespace penumbra::app
