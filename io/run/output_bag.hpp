// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <penumbra/camera/camera.hpp>

#include <io/assembly/result_encoder.hpp>
#include <io/files/pending_file.hpp>
#include <io/files/run_output.hpp>
#include <io/mcap/writer.hpp>

namespace penumbra::io {

/// A bag of results: topics /penumbra/..., each message with its image's stamp, which is also its
/// log time. Frames without a stamp are refused.
class OutputBag final : public RunOutput, private ResultSink {
 public:
  /// `camera`: of the judged images; `root`: the robot's root link. `file` itself is not touched
  /// before finish(). Throws InputError if its folder cannot be written.
  OutputBag(const std::filesystem::path& file, const Camera& camera, std::string root);

  void begin(const ReportHead&) override {}
  void save(const FrameReport& report, const Frame& frame, const ShownTargets& targets) override;
  void finish(const Statistics& statistics, std::span<const std::string> notes) override;
  [[nodiscard]] std::vector<std::string> notes() const override;

 private:
  struct Channel {
    std::uint16_t id = 0;
    std::uint32_t messages = 0;
  };
  [[nodiscard]] bool wants(Result) const override { return true; }
  void write(Result result, std::int64_t stamp, std::span<const std::byte> payload) override;

  std::filesystem::path file_;
  PendingFile pending_;
  mcap::Writer writer_;
  ResultEncoder encoder_;
  std::array<Channel, result_topics.size()> channels_;  // by Result
  std::string missing_link_;
};

/// Throws InputError unless `file` is missing, empty or a bag of results.
void check_former_bag(const std::filesystem::path& file);

/// Throws InputError if results would replace the input, or what is no result.
void check_output_place(const std::filesystem::path& input, const std::filesystem::path& output);

/// Returns whether this is the name of a bag.
[[nodiscard]] bool is_output_bag(const std::filesystem::path& output);

}  // namespace penumbra::io
