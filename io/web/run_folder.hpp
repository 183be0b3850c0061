// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <penumbra/pipeline/pipeline.hpp>

#include <io/web/packet.hpp>

namespace penumbra::io {

/// The content of a report.json.
struct RunReport {
  std::string input;
  ImageSpace image = ImageSpace::raw;
  std::vector<std::string> links;
  std::vector<std::int64_t> indices;  ///< index of each frame
  std::vector<std::string> frames;    ///< the report's text of each frame
  std::string start, end;             ///< the report's text around the frames

  /// Reads a file. Throws InputError if it is not the report of a run.
  [[nodiscard]] static RunReport read(const std::filesystem::path& file);
};

/// The results of a run in a folder: its report and saved images.
class RunFolder final : public FrameArchive {
 public:
  RunFolder(std::filesystem::path folder, RunReport report);

  /// Returns the kinds of images that the folder holds.
  [[nodiscard]] std::vector<Part> parts() const;

  [[nodiscard]] std::size_t size() const override { return report_.frames.size(); }
  [[nodiscard]] bool is_complete() const override { return true; }
  [[nodiscard]] SharedBytes report(std::size_t from) const override;
  [[nodiscard]] std::optional<PacketFrame> frame(std::size_t i) const override;
  [[nodiscard]] std::vector<std::string> missing() const override;

 private:
  [[nodiscard]] bool is_saved(Part part) const;

  std::filesystem::path folder_;
  RunReport report_;
};

}  // namespace penumbra::io
