// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <utility>

#include <penumbra/base/version.hpp>

#include <io/files/json.hpp>
#include <io/files/numbers.hpp>
#include <io/web/page_files.hpp>
#include <io/web/stored_view.hpp>
#include <io/web/web_types.hpp>

namespace penumbra::io {
namespace {

constexpr std::string_view frames_path = "/api/frames/";
constexpr std::string_view packet_end = "/packet";

Json camera_json(const SessionInfo& info) {
  if (!info.camera) return nullptr;
  const Intrinsics& i = info.camera->intrinsics;
  return {{"width", i.width()},
          {"height", i.height()},
          {"fx", i.fx()},
          {"fy", i.fy()},
          {"cx", i.cx()},
          {"cy", i.cy()},
          {"image", info.image == ImageSpace::raw ? "raw" : "rectified"}};
}

std::string query_of(const WebRequest& request, const char* name) {
  const auto at = request.query.find(name);
  return at == request.query.end() ? std::string() : at->second;
}

/// Returns the index in "/api/frames/17/packet", or nothing for other paths.
std::optional<std::size_t> packet_index(std::string_view path) {
  if (!path.starts_with(frames_path) || !path.ends_with(packet_end) ||
      path.size() <= frames_path.size() + packet_end.size())
    return std::nullopt;
  path.remove_prefix(frames_path.size());
  path.remove_suffix(packet_end.size());
  const auto number = parse_number<std::int64_t>(path);
  if (!number || *number < 0) return std::nullopt;
  return static_cast<std::size_t>(*number);
}

}  // namespace

std::string session_json(const SessionInfo& info, std::size_t frames,
                         std::optional<std::size_t> expected, bool is_complete,
                         std::uint64_t scene_version, const std::vector<std::string>& missing) {
  Json parts = Json::array();
  for (const Part part : info.parts) parts.push_back(to_string(part));
  const Json json{
      {"penumbra", PENUMBRA_VERSION},  {"server", server_id()},          {"mode", info.mode},
      {"input", info.input},           {"complete", is_complete},        {"frames", frames},
      {"expected", or_null(expected)}, {"scene_version", scene_version}, {"links", info.links},
      {"camera", camera_json(info)},   {"parts", std::move(parts)},      {"missing", missing},
      {"cameras", info.cameras}};
  return json_text(json);
}

std::optional<WebAnswer> page_answer(const std::string& path) {
  const PageFile* const file = find_page_file(path == "/" ? "/index.html" : path);
  if (file == nullptr) return std::nullopt;
  // Asset names contain a hash of the content.
  return WebAnswer{.type = std::string(file->type),
                   .body = {shared_bytes(std::string(file->bytes))},
                   .keeps = path.starts_with("/assets/")};
}

std::optional<WebAnswer> scene_answer(const WebRequest& request, const Scene& scene) {
  const bool is_index = request.path == "/api/scene";
  if (!is_index && request.path != "/api/scene.bin") return std::nullopt;
  const auto wants_other = [&](const char* name, const std::string& is) {
    const auto wanted = query_of(request, name);
    return !wanted.empty() && wanted != is;
  };
  if (wants_other("server", server_id()) || wants_other("version", std::to_string(scene.version)))
    return web_error(
        409, "the scene is another one by now, of version " + std::to_string(scene.version));
  if (is_index) return WebAnswer{.body = {scene.json}};
  return WebAnswer{.type = "application/octet-stream", .body = {scene.geometry}};
}

StoredView::StoredView(SessionInfo info, Scene scene, const FrameArchive& archive,
                       std::optional<std::size_t> expected)
    : info_(std::move(info)), scene_(std::move(scene)), archive_(archive), expected_(expected) {
  if (info_.camera) cloud_.emplace(*info_.camera);
}

WebAnswer StoredView::answer(const WebRequest& request) {
  if (request.path == "/api/session")
    return {.body = {
                shared_bytes(session_json(info_, archive_.size(), expected_, archive_.is_complete(),
                                          scene_.version, archive_.missing()))}};
  if (request.path == "/api/report") return report(request);
  if (auto scene = scene_answer(request, scene_)) return *std::move(scene);
  if (request.path.starts_with(frames_path)) return packet(request);
  if (auto page = page_answer(request.path)) return *std::move(page);
  return web_error(404, "nothing is served at " + request.path);
}

WebAnswer StoredView::report(const WebRequest& request) const {
  const std::string from = query_of(request, "from");
  const auto first = parse_number<std::int64_t>(from.empty() ? "0" : from);
  if (!first || *first < 0) return web_error(400, "from= takes the number of frames to leave out");
  return {.body = {archive_.report(static_cast<std::size_t>(*first))}};
}

WebAnswer StoredView::packet(const WebRequest& request) const {
  const auto index = packet_index(request.path);
  if (!index) return web_error(404, "nothing is served at " + request.path);
  const auto wanted = parse_wanted(query_of(request, "with"), query_of(request, "step"));
  if (!wanted)
    return web_error(400,
                     "with= takes color, overlay, labels, links, vdi, depth, cloud and outlines, "
                     "with commas between them; step= 1 to 64");
  const auto frame = archive_.frame(*index);
  if (!frame)
    return web_error(404, "there is no frame " + std::to_string(*index) + "; there are " +
                              std::to_string(archive_.size()) +
                              (archive_.is_complete() ? "" : " so far"));
  return {.type = "application/octet-stream",
          .body = make_packet(*frame, *wanted, cloud_ ? &*cloud_ : nullptr, scene_.version)};
}

std::unique_ptr<WebChannel> StoredView::open_channel(const std::string& /*path*/) {
  return nullptr;
}

}  // namespace penumbra::io
