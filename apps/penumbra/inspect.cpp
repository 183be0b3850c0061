// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

#include <penumbra/robot/drawn_links.hpp>
#include <penumbra/robot/robot.hpp>

#include <apps/penumbra/help.hpp>
#include <apps/penumbra/options.hpp>
#include <apps/penumbra/text.hpp>
#include <io/files/printable.hpp>
#include <io/files/report_json.hpp>

namespace penumbra::app {
namespace {

struct InspectArguments {
  std::filesystem::path robot;
  RobotOptions options;
  bool json = false;
};

using Row = std::vector<std::string>;

std::string size_of(const LinkReport& link) {
  if (link.bounds.isEmpty()) return "-";
  const Eigen::Vector3d size = link.bounds.sizes();
  return fixed(size.x(), 3) + " x " + fixed(size.y(), 3) + " x " + fixed(size.z(), 3);
}

void print_links(const Robot& robot) {
  std::vector<Row> rows = {
      {"LINK", "DRAWN", "TRIANGLES", "WATERTIGHT", "SIZE (m)", "LOAD (ms)", "WHY / FROM"}};
  for (const LinkReport& link : robot.report()) {
    std::string why = link.reason;
    for (const std::string& source : link.sources)
      if (link.reason.find(source) == std::string::npos) why += (why.empty() ? "" : ", ") + source;
    const char* const watertight = link.watertight ? "yes" : "no";
    rows.push_back({link.link,
                    link.missing ? "MISSING"
                    : link.drawn ? "yes"
                                 : "no",
                    std::to_string(link.triangles), link.drawn ? watertight : "-", size_of(link),
                    fixed(link.load_ms, 1), why});
  }
  print_table(rows);
}

std::string limits_of(const Joint& joint) {
  if (!joint.lower && !joint.upper) return "-";
  const auto text = [](const std::optional<double>& limit) {
    return limit ? fixed(*limit, 4) : std::string("-");
  };
  return text(joint.lower) + " .. " + text(joint.upper);
}

std::string mimic_of(const Robot& robot, const Joint& joint) {
  if (!joint.mimics || !joint.variable) return "-";
  return fixed(joint.multiplier, 4) + " * " + robot.variables()[*joint.variable] + " + " +
         fixed(joint.offset, 4);
}

void print_joints(const Robot& robot) {
  std::vector<Row> rows = {{"JOINT", "TYPE", "PARENT", "CHILD", "LIMITS (rad, m)", "MIMICS"}};
  for (const Joint& joint : robot.joints())
    rows.push_back({joint.name, std::string(to_string(joint.type)), robot.links()[joint.parent],
                    robot.links()[joint.child], limits_of(joint), mimic_of(robot, joint)});
  if (rows.size() > 1) print_table(rows);
}

void print_robot(const Robot& robot) {
  std::size_t drawn = 0;
  std::size_t triangles = 0;
  for (const LinkReport& link : robot.report()) {
    drawn += link.drawn ? 1 : 0;
    triangles += link.triangles;
  }
  std::cout << "robot '" << robot.name() << "': " << robot.links().size() << " links, " << drawn
            << " drawn, " << triangles << " triangles, " << robot.variables().size()
            << " joint variables\n\n";
  print_links(robot);
  std::cout << '\n';
  print_joints(robot);
  for (const std::string& note : robot.notes())
    std::cout << "\nnote: " << io::without_controls(note);
  if (!robot.notes().empty()) std::cout << '\n';
}

void add_options(CLI::App& app, InspectArguments& inspect) {
  app.footer(inspect_examples);
  add_text(app, "URDF", "the robot: URDF, xacro or MJCF", "", inspect.robot)->required();
  add_robot(app, inspect.options);
  app.add_flag("--json", inspect.json, "print JSON instead of tables");
}

int execute(const InspectArguments& arguments) {
  RobotOptions options = arguments.options;
  options.allow_missing_meshes = true;  // shows the other links
  const Robot robot = Robot::load(arguments.robot, options);
  if (arguments.json) {
    std::cout << io::robot_json(robot) << '\n';
  } else {
    print_robot(robot);
  }
  // The status is that of the commands that draw it with these options.
  check_is_drawn(Robot::load(arguments.robot, arguments.options));
  return 0;
}

}  // namespace

Execute add_inspect(CLI::App& app) {
  return make_command<InspectArguments>(app, add_options, nullptr, execute);
}

}  // namespace penumbra::app
