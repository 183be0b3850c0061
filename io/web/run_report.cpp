// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file-inl.hpp>

#include <io/json-inl.hpp>
#include <io/web/run_folder.hpp>

namespace penumbra::io {
namespace {

Backend backend_of(const std::string& name) {
  for (const Backend backend : {Backend::gl, Backend::reference})
    if (name == to_string(backend)) return backend;
  return Backend::cpu;
}

void read_settings(const Json& settings, RunReport& report) {
  const Json& tolerance = settings.at("tolerance");
  report.tolerance = {tolerance.at(0), tolerance.at(1), tolerance.at(2)};
  report.front_min_width = settings.at("front_min_width");
  report.fringe_reach = settings.value("fringe_reach", 0);
  report.paper_labels = settings.at("labels") == "paper";
  if (settings.at("image") == "rectified") report.image = ImageSpace::rectified;
  if (const Json& geometry = settings.at("geometry"); geometry.is_string())
    report.geometry = geometry == "visual" ? Geometry::visual : Geometry::collision;
  report.geometry_fallback = settings.at("geometry_fallback");
  if (const Json& targets = settings.at("targets"); targets.is_string()) report.targets = targets;
  report.has_target_topics =
      report.targets.empty() && settings.at("target_history_s").get<double>() > 0;
}

void read_frames(const Json& frames, RunReport& report) {
  for (const Json& frame : frames) {
    report.indices.push_back(frame.at("index"));
    report.frames.push_back(json_text(frame));
  }
}

}  // namespace

RunReport RunReport::read(const std::filesystem::path& file) {
  RunReport report;
  try {
    Json json = Json::parse(read_whole_file(file, FileLimit::data));
    report.input = json.at("input");
    report.backend = backend_of(json.at("renderer").at("backend"));
    read_settings(json.at("settings"), report);
    for (const Json& link : json.at("links")) report.links.push_back(link);
    read_frames(json.at("frames"), report);
    const Json& summary = json.at("summary");
    report.has_missing_links = !summary.at("missing_links").empty();
    report.end = "\n],\n\"summary\": " + json_text(summary) + "}\n";
    json.erase("frames");
    json.erase("summary");
    report.start = json_text(json);
    report.start.pop_back();
    report.start += ",\n\"frames\": [";
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file.string() + ": is no report of penumbra run (" + error.what() +
                     "); a folder that run wrote with -o is wanted");
  }
  return report;
}

}  // namespace penumbra::io
