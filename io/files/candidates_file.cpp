// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/targets/target.hpp>

#include <io/files/candidates_file.hpp>
#include <io/files/csv.hpp>
#include <io/files/frame_values.hpp>
#include <io/files/names.hpp>
#include <io/files/numbers.hpp>
#include <io/files/printable.hpp>

namespace penumbra::io {
namespace {

constexpr std::string_view candidate_header = "name,x,y,z,qx,qy,qz,qw";  // then ,link or nothing
constexpr std::array number_columns = {"x", "y", "z", "qx", "qy", "qz", "qw"};  // from 1 on
constexpr std::size_t link_column = 1 + number_columns.size();

using Cells = std::vector<std::string_view>;

[[noreturn]] void refuse_header(const std::string& what) {
  throw InputError(what + "; expected the header " + std::string(candidate_header) +
                   " with or without ,link");
}

void check_candidate_header(const Cells& cells) {
  std::string header;
  for (const std::string_view cell : cells) header += (header.empty() ? "" : ",") + printable(cell);
  if (header != candidate_header && header != std::string(candidate_header) + ",link")
    refuse_header("the header is '" + header + "'");
}

ForecastCamera candidate_of(const Cells& row, const Robot& robot, ForecastCamera candidate) {
  candidate.name = row.front();
  check_name(candidate.name);
  std::vector<double> numbers;
  for (std::size_t i = 0; i < number_columns.size(); ++i) {
    const auto value = parse_number<double>(row[1 + i]);
    if (!value)
      throw InputError(std::string(number_columns[i]) + " is '" + printable(row[1 + i]) +
                       "'; expected a number");
    numbers.push_back(*value);
  }
  Camera& camera = candidate.camera;
  camera.parent.clear();
  camera.T_parent_camera = isometry_of(numbers);
  if (const double far = camera.T_parent_camera->translation().norm(); far > farthest_target)
    throw InputError("is " + std::to_string(std::lround(far)) +
                     " m away: are these millimetres? give metres");
  if (row.size() == link_column) return candidate;
  camera.parent = row[link_column];
  const Cells known(robot.links().begin(), robot.links().end());
  if (!camera.parent.empty() && !robot.find_link(camera.parent))
    throw InputError("'" + printable(camera.parent) + "' is no link of the robot" +
                     near_names(camera.parent, known));
  return candidate;
}

}  // namespace

std::vector<ForecastCamera> read_candidates(const std::filesystem::path& file, const Robot& robot,
                                            const ForecastCamera& camera) {
  const std::string text = read_csv(file);
  CsvLines lines(text, file);
  if (!lines.next()) refuse_header(file.string() + ": is empty");
  std::vector<ForecastCamera> candidates;
  std::map<std::string, std::size_t, std::less<>> line_of;  // by name
  try {
    check_candidate_header(lines.cells());
    const std::size_t columns = lines.cells().size();
    while (lines.next()) {
      if (lines.cells().size() != columns)
        throw InputError("has " + std::to_string(lines.cells().size()) + " cells, the header " +
                         std::to_string(columns));
      ForecastCamera candidate = candidate_of(lines.cells(), robot, camera);
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
                     ": has a header, but no candidate; expected a line for each pose");
  return candidates;
}

}  // namespace penumbra::io
