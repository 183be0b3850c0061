// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file-inl.hpp>

#include <io/files/json.hpp>
#include <io/files/names.hpp>
#include <io/files/npy.hpp>
#include <io/files/png.hpp>
#include <io/web/run_folder.hpp>
#include <io/web/scene.hpp>

namespace penumbra::io {
namespace {

constexpr std::size_t name_digits = 6;
constexpr std::array saved_kinds{Part::overlay, Part::labels, Part::links, Part::vdi};

/// Throws InputError for a file that is outside of the folder through a link.
void check_is_inside(const std::filesystem::path& file, const std::filesystem::path& folder) {
  std::error_code error;
  const auto root = std::filesystem::weakly_canonical(folder, error);
  const auto real = std::filesystem::weakly_canonical(file, error);
  const auto end = std::mismatch(root.begin(), root.end(), real.begin(), real.end()).first;
  if (error || end != root.end())
    throw InputError(file.string() + ": is outside of the run's folder and is not shown");
}

template <typename T, typename Read>
std::optional<PartBytes> pixels_of(const std::filesystem::path& file, const char* type, Read read) {
  Image<T> image;
  if (!read(file, image, std::nullopt).ok()) return std::nullopt;
  std::string bytes(image.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), image.data(), bytes.size());
  return PartBytes{type, image.width(), image.height(), shared_bytes(std::move(bytes))};
}

std::optional<PartBytes> read_saved(const std::filesystem::path& file, Part part,
                                    const std::filesystem::path& folder) {
  check_is_inside(file, folder);
  if (part == Part::labels) return pixels_of<std::uint8_t>(file, "u8", read_png<std::uint8_t>);
  if (part == Part::links) return pixels_of<std::uint16_t>(file, "u16", read_png<std::uint16_t>);
  if (part == Part::vdi) return pixels_of<float>(file, "f32", read_npy);
  Image<Rgb8> image;
  if (!read_png(file, image).ok()) return std::nullopt;
  return PartBytes{"image/png", image.width(), image.height(),
                   shared_bytes(read_whole_file(file, FileLimit::data))};
}

}  // namespace

RunReport RunReport::read(const std::filesystem::path& file) {
  RunReport report;
  try {
    Json json = Json::parse(read_whole_file(file, FileLimit::data));
    report.input = json.at("input");
    if (json.at("settings").at("image") == "rectified") report.image = ImageSpace::rectified;
    for (const Json& link : json.at("links")) report.links.push_back(link);
    for (const Json& frame : json.at("frames")) {
      report.indices.push_back(frame.at("index"));
      report.frames.push_back(json_text(frame));
    }
    report.end = "\n],\n\"summary\": " + json_text(json.at("summary")) + "}\n";
    json.erase("frames");
    json.erase("summary");
    report.start = json_text(json);
    report.start.pop_back();
    report.start += ",\n\"frames\": [";
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file.string() + ": is not a report of penumbra run (" + error.what() +
                     "); expected a folder that run wrote with -o");
  }
  return report;
}

RunFolder::RunFolder(std::filesystem::path folder, RunReport report)
    : folder_(std::move(folder)), report_(std::move(report)) {}

bool RunFolder::is_saved(Part part) const {
  std::error_code error;
  return std::find(saved_kinds.begin(), saved_kinds.end(), part) != saved_kinds.end() &&
         std::filesystem::is_directory(folder_ / to_string(part), error);
}

std::vector<Part> RunFolder::parts() const {
  std::vector<Part> parts;
  for (const Part part : saved_kinds)
    if (is_saved(part)) parts.push_back(part);
  return parts;
}

SharedBytes RunFolder::report(std::size_t from) const {
  std::string text = report_.start;
  for (std::size_t i = from; i < size(); ++i)
    text += (i == from ? "\n" : ",\n") + report_.frames[i];
  return shared_bytes(text + report_.end);
}

std::optional<PacketFrame> RunFolder::frame(std::size_t i) const {
  if (i >= size()) return std::nullopt;
  return PacketFrame{report_.frames[i], poses_json({}, {}, report_.links.size()),
                     [this, i](Part part) -> std::optional<PartBytes> {
                       if (!is_saved(part)) return std::nullopt;
                       std::string name = std::to_string(report_.indices[i]);
                       name.insert(0, name_digits - std::min(name.size(), name_digits), '0');
                       name += part == Part::vdi ? ".npy" : ".png";
                       return read_saved(folder_ / to_string(part) / name, part, folder_);
                     }};
}

std::vector<std::string> RunFolder::missing() const {
  std::string all, unsaved;
  for (const Part part : saved_kinds) {
    const std::string name(to_string(part));
    all += (all.empty() ? "" : ",") + name;
    if (!is_saved(part)) unsaved += (unsaved.empty() ? "" : ", ") + name;
  }
  std::vector<std::string> lines;
  if (!unsaved.empty())
    lines.push_back("not saved by the run: " + unsaved + "; `penumbra run " +
                    for_shell(report_.input) + " -o " + for_shell(folder_.string()) + " --save " +
                    all + "`, with the run's other options, saves all");
  lines.push_back("not part of a run's results: robot, points, color, depth; `penumbra view " +
                  for_shell(report_.input) + "`, with the run's other options, shows them");
  return lines;
}

}  // namespace penumbra::io
