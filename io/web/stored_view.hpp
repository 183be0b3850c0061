// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <penumbra/camera/camera.hpp>
#include <penumbra/pipeline/pipeline.hpp>

#include <io/web/packet.hpp>
#include <io/web/scene.hpp>

namespace penumbra::io {

/// Describes the input of a page.
struct SessionInfo {
  std::string mode = "stored";  ///< "stored" or "live"
  std::string input;
  std::vector<std::string> links;
  std::optional<Camera> camera = {};  ///< of the parts' images
  ImageSpace image = ImageSpace::raw;
  std::vector<Part> parts = {};           ///< available parts
  std::vector<std::string> cameras = {};  ///< of CamerasView; empty: one without a name
};

/// Returns the answer to GET /api/session.
[[nodiscard]] std::string session_json(const SessionInfo& info, std::size_t frames,
                                       std::optional<std::size_t> expected, bool is_complete,
                                       std::uint64_t scene_version,
                                       const std::vector<std::string>& missing);

/// Returns the file of the page with this path, or nothing.
[[nodiscard]] std::optional<WebAnswer> page_answer(const std::string& path);

/// Returns the answer to GET /api/scene or /api/scene.bin, for this version and server if the query
/// names them; nothing for other paths.
[[nodiscard]] std::optional<WebAnswer> scene_answer(const WebRequest& request, const Scene& scene);

/// Serves the page and frames of an archive.
class StoredView final : public WebHandler {
 public:
  /// `archive` must outlive this. `expected`: the final number of frames, if known.
  StoredView(SessionInfo info, Scene scene, const FrameArchive& archive,
             std::optional<std::size_t> expected);

  [[nodiscard]] WebAnswer answer(const WebRequest& request) override;
  [[nodiscard]] std::unique_ptr<WebChannel> open_channel(const std::string& path) override;

 private:
  [[nodiscard]] WebAnswer report(const WebRequest& request) const;
  [[nodiscard]] WebAnswer packet(const WebRequest& request) const;

  SessionInfo info_;
  Scene scene_;
  const FrameArchive& archive_;
  std::optional<std::size_t> expected_;
  std::optional<PacketCloud> cloud_;
};

}  // namespace penumbra::io
