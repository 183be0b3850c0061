// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/files/csv.hpp>
#include <io/files/numbers.hpp>
#include <io/files/printable.hpp>
#include <io/files/trajectory_file.hpp>
#include <io/files/yaml.hpp>

namespace penumbra::io {
namespace {

FileTrajectory read_table(const std::string& text, const std::filesystem::path& file) {
  FileTrajectory trajectory{.name = file.string()};
  CsvLines lines(text, file);
  const auto fault = [&](const std::string& what) {
    throw InputError(file.string() + ":" + std::to_string(lines.line()) + ": " + what);
  };
  if (!lines.next()) throw InputError(file.string() + ": is empty; expected time,JOINT,...");
  if (lines.cells().front() != "time" || lines.cells().size() < 2)
    fault("expected the header time,JOINT,...");
  trajectory.variables.assign(lines.cells().begin() + 1, lines.cells().end());
  while (lines.next()) {
    if (lines.cells().size() != trajectory.variables.size() + 1)
      fault(std::to_string(lines.cells().size()) + " cells; the header has " +
            std::to_string(trajectory.variables.size() + 1));
    std::vector<double> values;
    for (const std::string_view cell : lines.cells()) {
      const auto value = parse_number<double>(cell);
      if (!value) fault("'" + printable(cell) + "'; expected a number");
      values.push_back(*value);
    }
    trajectory.points.push_back(
        {.time = values.front(), .positions = {values.begin() + 1, values.end()}});
  }
  return trajectory;
}

std::vector<double> values_of(const YamlNode& point, std::string_view key) {
  const YamlNode* const values = point.find(key);
  return values == nullptr || values->is_null() ? std::vector<double>{} : values->numbers();
}

/// Returns a duration of ROS 2 (sec, nanosec) or ROS 1 (secs, nsecs).
double seconds_of(const YamlNode& time) {
  const bool is_ros1 = time.find("secs") != nullptr;
  const YamlNode* const rest = time.find(is_ros1 ? "nsecs" : "nanosec");
  return static_cast<double>(time.at(is_ros1 ? "secs" : "sec").integer()) +
         1e-9 * static_cast<double>(rest == nullptr ? 0 : rest->integer());
}

/// Appends a JointTrajectory `after` seconds.
void append_points(const YamlNode& message, double after, FileTrajectory& to) {
  const std::vector<std::string> names = message.at("joint_names").texts();
  if (to.points.empty()) to.variables = names;
  if (names != to.variables) message.at("joint_names").fail("differ from those of the part before");
  const bool is_later = !to.points.empty();
  const auto& points = message.at("points").items();
  for (const YamlNode& point : points) {
    const double seconds = seconds_of(point.at("time_from_start"));
    TrajectoryPoint read{.time = after + seconds,
                         .positions = point.at("positions").numbers(),
                         .velocities = values_of(point, "velocities"),
                         .accelerations = values_of(point, "accelerations")};
    // A part begins where the last one ended.
    if (is_later && seconds == 0.0 && &point == &points.front()) continue;
    to.points.push_back(std::move(read));
  }
}

void append_robot(const YamlNode& message, FileTrajectory& to) {
  const YamlNode* const floating = message.find("multi_dof_joint_trajectory");
  if (floating != nullptr) {
    const YamlNode* const points = floating->find("points");
    if (points != nullptr && !points->is_null() && !points->items().empty())
      points->fail("motions of floating and planar joints are not read; expected none");
  }
  append_points(message.at("joint_trajectory"), to.points.empty() ? 0.0 : to.points.back().time,
                to);
}

FileTrajectory read_message(const YamlNode& message, std::string name) {
  if (const YamlNode* const goal = message.find("goal"); goal != nullptr && goal->is_map())
    return read_message(*goal, std::move(name));
  FileTrajectory trajectory{.name = std::move(name)};
  const YamlNode* const parts = message.find("trajectory");
  if (parts != nullptr && parts->is_map())  // a goal of FollowJointTrajectory
    append_points(*parts, 0.0, trajectory);
  else if (parts != nullptr)
    for (const YamlNode& part : parts->items()) append_robot(part, trajectory);
  else if (message.find("joint_trajectory") != nullptr)
    append_robot(message, trajectory);
  else if (message.find("joint_names") != nullptr)
    append_points(message, 0.0, trajectory);
  else
    message.fail(
        "expected a message of JointTrajectory, RobotTrajectory or DisplayTrajectory, a goal of "
        "FollowJointTrajectory, or a table *.csv");
  return trajectory;
}

}  // namespace

std::vector<FileTrajectory> read_trajectories(const std::filesystem::path& file) {
  const std::string text = read_csv(file);
  std::vector<FileTrajectory> trajectories;
  if (file.extension() == ".csv") {
    trajectories.push_back(read_table(text, file));
  } else {
    const std::vector<YamlNode> documents = YamlNode::parse_all(text, file);
    for (const YamlNode& document : documents)
      if (!document.is_null())
        trajectories.push_back(read_message(
            document, trajectories.empty()
                          ? file.string()
                          : file.string() + " " + std::to_string(trajectories.size() + 1)));
  }
  if (trajectories.empty() || trajectories.front().points.empty())
    throw InputError(file.string() + ": has no points of a motion");
  return trajectories;
}

}  // namespace penumbra::io
