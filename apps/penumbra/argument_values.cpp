// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/argument_values.hpp>
#include <apps/penumbra/text.hpp>
#include <io/files/numbers.hpp>

namespace penumbra::app {

void refuse_option(const std::string& option, const std::string& value, const std::string& wanted) {
  throw InputError(option + ": '" + value + "' is not " + wanted);
}

Backend to_backend(const std::string& name) {
  for (const Backend backend : {Backend::cpu, Backend::gl, Backend::reference})
    if (name == to_string(backend)) return backend;
  refuse_option("--renderer", name, "one of cpu, gl, reference");
}

Geometry to_geometry(const std::string& name) {
  if (name == "collision") return Geometry::collision;
  if (name == "visual") return Geometry::visual;
  refuse_option("--geometry", name, "collision or visual");
}

ImageSpace to_image(const std::string& name) {
  if (name == "raw") return ImageSpace::raw;
  if (name == "rectified") return ImageSpace::rectified;
  refuse_option("--image", name, "raw or rectified");
}

PoseSource to_poses(const std::string& name) {
  for (const PoseSource source : {PoseSource::joints, PoseSource::transforms, PoseSource::both})
    if (name == to_string(source)) return source;
  refuse_option("--poses", name, "one of joints, tf, both");
}

double to_time_offset(const std::string& text) {
  constexpr double most = 10.0;
  const auto seconds = io::parse_number<double>(text);
  if (!seconds || !(std::abs(*seconds) <= most))
    refuse_option("--time-offset", text, "a number of seconds from -10 to 10");
  return *seconds;
}

double to_fps(const std::string& text) {
  constexpr double least = 1e-3, most = 1e3;
  const auto fps = io::parse_number<double>(text);
  if (!fps || !(*fps >= least && *fps <= most))
    refuse_option("--fps", text, "a number of frames per second from 0.001 to 1000");
  return *fps;
}

bool to_paper(const std::string& name) {
  if (name == "paper") return true;
  if (name == "full") return false;
  refuse_option("--labels", name, "full or paper");
}

Tolerance to_tolerance(const std::string& text) {
  const auto parts = split(text, ',');
  const char* const wanted = "A,B,C: three numbers, of e(z) = A + B z + C z^2 in metres";
  if (parts.size() != 3) refuse_option("--tolerance", text, wanted);
  const auto a = io::parse_number<double>(parts[0]), b = io::parse_number<double>(parts[1]),
             c = io::parse_number<double>(parts[2]);
  if (!a || !b || !c) refuse_option("--tolerance", text, wanted);
  return {*a, *b, *c};
}

int to_count(const std::string& option, const std::string& text, int least, int most) {
  const auto value = io::parse_number<std::int64_t>(text);
  if (!value || *value < least || *value > most)
    refuse_option(option, text,
                  "a whole number from " + std::to_string(least) + " to " + std::to_string(most));
  return static_cast<int>(*value);
}

io::FrameRange to_range(const std::string& text) {
  const auto parts = split(text, ':');
  const char* const wanted = "A:B, the frames from A up to but without B (either may be left out)";
  if (parts.size() != 2) refuse_option("--frames", text, wanted);
  io::FrameRange range;
  for (auto [part, bound] : {std::pair(&parts[0], &range.first), {&parts[1], &range.end}}) {
    if (part->empty()) continue;
    *bound = io::parse_number<std::int64_t>(*part);
    if (!*bound || **bound < 0) refuse_option("--frames", text, wanted);
  }
  return range;
}

io::Saves to_saves(const std::string& text) {
  io::Saves saves;
  for (const std::string& part : split(text, ',')) {
    if (part == "vdi") {
      saves.vdi = true;
    } else if (part == "labels") {
      saves.labels = true;
    } else if (part == "links") {
      saves.links = true;
    } else if (part == "overlay") {
      saves.overlay = true;
    } else if (part == "filtered") {
      saves.filtered = true;
    } else if (part == "points") {
      saves.points = true;
    } else {
      refuse_option("--save", part, "one of vdi, labels, links, overlay, filtered, points");
    }
  }
  return saves;
}

std::pair<std::string, std::string> to_pair(const std::string& option, const std::string& text,
                                            const std::string& wanted) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == text.size())
    refuse_option(option, text, wanted);
  return {text.substr(0, equals), text.substr(equals + 1)};
}

void take_package(const std::string& text, std::map<std::string, std::filesystem::path>& packages) {
  const auto [name, folder] = to_pair("--package", text, "NAME=DIR");
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error))
    refuse_option("--package", text, "NAME=DIR with a folder that exists");
  if (!packages.emplace(name, folder).second)
    refuse_option("--package", text, "the only one of " + name + "; give each name once");
}

std::pair<std::string, double> to_joint(const std::string& text) {
  const char* const wanted = "NAME=VALUE with a number (radians or metres)";
  const auto [name, value] = to_pair("--joint", text, wanted);
  const auto number = io::parse_number<double>(value);
  if (!number) refuse_option("--joint", text, wanted);
  return {name, *number};
}

}  // namespace penumbra::app
