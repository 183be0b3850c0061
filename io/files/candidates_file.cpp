// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/target.hpp>

#include <io/files/candidates_file.hpp>
#include <io/files/csv.hpp>
#include <io/files/frame_values.hpp>
#include <io/files/names.hpp>
#include <io/files/numbers.hpp>
#include <io/files/printable.hpp>

namespace penumbra::io {
namespace {

constexpr std::array<std::string_view, 9> candidate_columns = {"name", "x",  "y",  "z",   "qx",
                                                               "qy",   "qz", "qw", "link"};
constexpr std::string_view candidate_header =
    "the header name,x,y,z,qx,qy,qz,qw with or without ,link is wanted";

/// The cells of a row by their column.
using CandidateRow = std::map<std::string_view, std::string_view>;

void check_candidate_header(const std::vector<std::string_view>& header) {
  for (auto at = header.begin(); at != header.end(); ++at) {
    if (std::find(candidate_columns.begin(), candidate_columns.end(), *at) ==
        candidate_columns.end())
      throw InputError("'" + printable(*at) + "' is no column; " + std::string(candidate_header));
    if (std::find(header.begin(), at, *at) != at)
      throw InputError("column '" + printable(*at) + "' is there twice; keep one");
  }
  for (const std::string_view column : candidate_columns)
    if (column != "link" && std::find(header.begin(), header.end(), column) == header.end())
      throw InputError("has no column '" + std::string(column) + "'; " +
                       std::string(candidate_header));
}

double number_of(const CandidateRow& row, std::string_view column) {
  const std::string_view cell = row.at(column);
  const auto value = parse_number<double>(cell);
  if (!value)
    throw InputError(std::string(column) + " is '" + printable(cell) + "'; a number is wanted");
  return *value;
}

CameraCandidate candidate_of(const CandidateRow& row, const Robot& robot) {
  CameraCandidate candidate;
  candidate.name = row.at("name");
  if (candidate.name.empty() ||
      std::any_of(candidate.name.begin(), candidate.name.end(), is_control))
    throw InputError("the name is '" + printable(candidate.name) +
                     "'; letters and digits are "
                     "wanted");
  std::vector<double> numbers;
  for (const std::string_view column : {"x", "y", "z", "qx", "qy", "qz", "qw"})
    numbers.push_back(number_of(row, column));
  candidate.T_link_camera = isometry_of(numbers);
  if (candidate.T_link_camera.translation().cwiseAbs().maxCoeff() > max_target_distance)
    throw InputError("is more than 1000 km away; metres are wanted");
  const auto link = row.find("link");
  if (link == row.end() || link->second.empty()) return candidate;
  candidate.link = link->second;
  const std::vector<std::string_view> known(robot.links().begin(), robot.links().end());
  if (!robot.find_link(candidate.link))
    throw InputError("'" + printable(candidate.link) + "' is no link of the robot" +
                     near_names(candidate.link, known));
  return candidate;
}

}  // namespace

std::vector<CameraCandidate> read_candidates(const std::filesystem::path& file,
                                             const Robot& robot) {
  const std::string text = read_csv(file);
  CsvLines lines(text);
  if (!lines.next())
    throw InputError(file.string() + ": is empty; " + std::string(candidate_header));
  std::vector<CameraCandidate> candidates;
  std::map<std::string, std::size_t, std::less<>> line_of;  // by name
  try {
    const std::vector<std::string_view> header = lines.cells();
    check_candidate_header(header);
    while (lines.next()) {
      if (lines.cells().size() != header.size())
        throw InputError("has " + std::to_string(lines.cells().size()) + " cells, the header " +
                         std::to_string(header.size()));
      CandidateRow row;
      for (std::size_t i = 0; i < header.size(); ++i) row[header[i]] = lines.cells()[i];
      CameraCandidate candidate = candidate_of(row, robot);
      const auto [known, is_new] = line_of.emplace(candidate.name, lines.line());
      if (!is_new)
        throw InputError("the name '" + candidate.name + "' is that of line " +
                         std::to_string(known->second) + ", too; use each name once");
      candidates.push_back(std::move(candidate));
    }
  } catch (const InputError& fault) {
    throw InputError(file.string() + ":" + std::to_string(lines.line()) + ": " + fault.what());
  }
  if (candidates.empty())
    throw InputError(file.string() +
                     ": has a header, but no candidate; a line for each pose is "
                     "wanted");
  return candidates;
}

}  // namespace penumbra::io
