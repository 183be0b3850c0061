// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <penumbra/camera/camera.hpp>

#include <apps/penumbra/run_output.hpp>
#include <io/assembly/result_encoder.hpp>
#include <io/files/pending_file.hpp>
#include <io/mcap/writer.hpp>

namespace penumbra::app {

/// A bag of results: topics /penumbra/..., each message with its image's stamp, by which it is
/// recorded, too. Frames without a stamp have no place in it.
class OutputBag final : public RunOutput, private io::ResultSink {
 public:
  /// `camera`: of the judged images; `root`: the robot's root link. `file` itself is not touched
  /// before finish(). Throws InputError where nothing can be written beside it.
  OutputBag(const std::filesystem::path& file, const Camera& camera, std::string root);

  void begin(const io::ReportHead&) override {}
  void save(const FrameReport& report, const io::FrameData& frame,
            const io::ShownTargets& targets) override;
  void finish(const Statistics& statistics, std::span<const std::string> notes) override;
  [[nodiscard]] std::vector<std::string> notes() const override;
  [[nodiscard]] std::string where() const override { return "results: " + file_.string(); }

 private:
  struct Channel {
    std::uint16_t id = 0;
    std::uint32_t messages = 0;
  };
  [[nodiscard]] bool wants(io::Result) const override { return true; }
  void write(io::Result result, std::int64_t stamp, std::span<const std::byte> payload) override;

  std::filesystem::path file_;
  io::PendingFile pending_;
  io::mcap::Writer writer_;
  io::ResultEncoder encoder_;
  std::array<Channel, io::result_topics.size()> channels_;  // by Result
  std::string missing_link_;
};

/// Whether `file` may take a bag of results: it is no folder, and what is there is empty or
/// such a bag. Throws InputError where not; touches nothing.
void check_former_bag(const std::filesystem::path& file);

/// Whether results go into a bag of that name.
[[nodiscard]] bool is_output_bag(const std::filesystem::path& output);

}  // namespace penumbra::app
