// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file-inl.hpp>

#include <io/files/json-inl.hpp>
#include <io/web/run_folder.hpp>

namespace penumbra::io {
namespace {

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
    if (json.at("settings").at("image") == "rectified") report.image = ImageSpace::rectified;
    for (const Json& link : json.at("links")) report.links.push_back(link);
    read_frames(json.at("frames"), report);
    report.end = "\n],\n\"summary\": " + json_text(json.at("summary")) + "}\n";
    json.erase("frames");
    json.erase("summary");
    report.start = json_text(json);
    report.start.pop_back();
    report.start += ",\n\"frames\": [";
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file.string() + ": is not a report of penumbra run (" + error.what() +
                     "); a folder that run wrote with -o is wanted");
  }
  return report;
}

}  // namespace penumbra::io
