// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <stdexcept>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/rigid-inl.hpp>
#include <penumbra/base/text.hpp>
#include <penumbra/base/whole_file-inl.hpp>
#include <penumbra/robot/link_geometry-inl.hpp>
#include <penumbra/robot/mjcf-inl.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/robot/robot_tree-inl.hpp>
#include <penumbra/robot/xacro-inl.hpp>

namespace penumbra {
namespace {

namespace fs = std::filesystem;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

using Index = std::map<std::string, std::size_t, std::less<>>;

std::optional<std::size_t> find(const Index& index, std::string_view name) {
  const auto at = index.find(name);
  return at == index.end() ? std::nullopt : std::optional(at->second);
}

Isometry3d pose_of(const Matrix3d& rotation, const Vector3d& translation) {
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() = rotation;
  pose.translation() = translation;
  return pose;
}

/// Returns T_joint_child at the positions.
Isometry3d motion(const Joint& joint, std::span<const double> positions) {
  if (joint.type == JointType::fixed) return Isometry3d::Identity();
  const double* const value = &positions[*joint.variable];
  if (joint.type == JointType::planar) {
    const Matrix3d plane = plane_axes(joint.axis);
    return pose_of(Eigen::AngleAxisd(value[2], joint.axis).toRotationMatrix(),
                   plane.col(0) * value[0] + plane.col(1) * value[1]);
  }
  if (joint.type == JointType::floating) {
    const Eigen::Vector4d xyzw(value[3], value[4], value[5], value[6]);
    return pose_of(Eigen::Quaterniond(xyzw.stableNormalized()).toRotationMatrix(),
                   {value[0], value[1], value[2]});
  }
  const double position = joint.multiplier * *value + joint.offset;
  if (joint.type == JointType::prismatic)
    return pose_of(Matrix3d::Identity(), joint.axis * position);
  return pose_of(Eigen::AngleAxisd(position, joint.axis).toRotationMatrix(), Vector3d::Zero());
}

/// Returns the joint that an option holds at a position.
const Joint& find_held(const std::string& file, const std::string& name, double position,
                       const std::vector<Joint>& joints) {
  constexpr double slack = 0.1;  // rad or m beyond a limit: positions in another unit are farther
  const std::string what = file + ": joints: '" + name + "' ";
  const auto found = std::ranges::find(joints, name, &Joint::name);
  if (found == joints.end())
    throw InputError(what + "is no joint of the robot; 'penumbra inspect' lists the joints");
  const bool has_one = found->variable && !found->mimics && found->type != JointType::planar &&
                       found->type != JointType::floating;
  if (!has_one) throw InputError(what + "has no single position of its own");
  const bool is_limited = found->lower && found->upper && *found->lower < *found->upper;
  if (!std::isfinite(position) || std::abs(position) > Robot::max_position ||
      (is_limited && (position < *found->lower - slack || position > *found->upper + slack)))
    throw InputError(what + "is held at " + detail::printed(position) +
                     (is_limited ? ", beyond its limits " + detail::printed(*found->lower) +
                                       " to " + detail::printed(*found->upper)
                                 : "") +
                     "; expected radians or metres");
  return *found;
}

/// Fixes joints, and those that mimic them, at given positions.
void hold_joints(const std::string& file, const std::map<std::string, double>& positions,
                 detail::RobotTree& tree) {
  for (const auto& [name, position] : positions) {
    const std::size_t variable = *find_held(file, name, position, tree.joints).variable;
    std::vector<double> all(tree.variables.size());
    all[variable] = position;
    for (Joint& joint : tree.joints) {
      if (joint.variable == variable) {
        joint.origin = joint.origin * motion(joint, all);
        joint.type = JointType::fixed;
        joint.variable.reset();
        joint.mimics = false;
        joint.is_held = true;
      } else if (joint.variable > variable) {
        --*joint.variable;
      }
    }
    tree.variables.erase(tree.variables.begin() + static_cast<std::ptrdiff_t>(variable));
  }
}

void check_positions(const Robot& robot, std::span<const double> positions, std::size_t poses) {
  constexpr double shortest_quaternion = 1e-6;
  if (positions.size() != robot.variables().size() || poses != robot.links().size())
    throw std::invalid_argument(
        "forward_kinematics: one position per variable and one pose per link");
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (!(std::abs(positions[i]) <= Robot::max_position))
      throw std::invalid_argument("forward_kinematics: position of " + robot.variables()[i] +
                                  " is not within +-1e9");
  for (const Joint& joint : robot.joints()) {
    if (joint.type != JointType::floating) continue;
    const double* q = &positions[*joint.variable + 3];
    if (!(std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3])) >= shortest_quaternion))
      throw std::invalid_argument("forward_kinematics: quaternion of " + joint.name + " is zero");
  }
}

}  // namespace

struct Robot::Model {
  std::string name;
  fs::path urdf = {};
  RobotOptions options = {};
  std::vector<std::string> links;
  std::vector<Joint> joints;
  std::vector<std::string> variables;
  Index link_index;
  Index variable_index;
  std::vector<std::vector<PreparedMesh>> meshes;  // of each link
  std::vector<LinkReport> report;                 // of each link
  std::vector<std::string> notes;
  std::vector<RobotPart> parts = {};

  void add(const PlacedRobot& robot);
};

/// Appends a robot's links and joints, with its name before theirs.
void Robot::Model::add(const PlacedRobot& robot) {
  const Model& other = *robot.robot.model_;
  const std::string prefix = robot.name + "/";
  RobotPart part{robot.name, links.size(), 0, variables.size(), 0};
  Joint& mount = joints.emplace_back();
  mount.name = prefix + "mount";
  mount.child = part.first_link;
  mount.origin = robot.T_world_root;
  for (Joint joint : other.joints) {
    joint.name = prefix + joint.name;
    joint.parent += part.first_link;
    joint.child += part.first_link;
    if (joint.variable) *joint.variable += part.first_variable;
    joints.push_back(std::move(joint));
  }
  for (const std::string& link : other.links) links.push_back(prefix + link);
  for (const std::string& variable : other.variables) variables.push_back(prefix + variable);
  meshes.insert(meshes.end(), other.meshes.begin(), other.meshes.end());
  for (LinkReport link : other.report) {
    link.link = prefix + link.link;
    report.push_back(std::move(link));
  }
  for (const std::string& note : other.notes)
    notes.push_back("robot '" + robot.name + "': " + note);
  part.end_link = links.size();
  part.end_variable = variables.size();
  parts.push_back(std::move(part));
}

std::string_view to_string(JointType type) {
  constexpr std::array<std::string_view, 6> names = {"revolute", "continuous", "prismatic",
                                                     "fixed",    "planar",     "floating"};
  return names[static_cast<std::size_t>(type)];
}

Matrix3d plane_axes(const Vector3d& normal) {
  // Duff et al. 2017, "Building an orthonormal basis, revisited", JCGT 6(1): precise for any
  // normal.
  const double sign = normal.z() >= 0.0 ? 1.0 : -1.0;
  const double f = -1.0 / (sign + normal.z());
  const double x = normal.x();
  const double y = normal.y();
  Matrix3d axes;
  axes.col(0) << 1.0 + sign * x * x * f, sign * x * y * f, -sign * x;
  axes.col(1) << x * y * f, sign + y * y * f, -y;
  axes.col(2) = normal;
  return axes;
}

/// Reads a URDF, xacro or MJCF text.
static detail::Urdf read_description(std::string_view xml, const std::string& file,
                                     const fs::path& folder, const RobotOptions& options,
                                     detail::FileLocator& packages) {
  detail::XmlElement root = detail::read_xml(xml, file);
  if (root.name == "mujoco" && !options.arguments.empty())
    throw InputError(file + ": an MJCF takes no arguments; they are for xacro files");
  if (root.name == "mujoco") return detail::read_mjcf(std::move(root), folder);
  std::vector<std::string> notes;
  detail::Urdf urdf =
      detail::read_urdf(detail::expand_xacro(root, folder, options.arguments, packages, notes));
  urdf.warnings.insert(urdf.warnings.end(), notes.begin(), notes.end());
  return urdf;
}

std::unique_ptr<Robot::Model> Robot::make_model(std::string_view xml, const std::string& file,
                                                const fs::path& folder,
                                                const RobotOptions& options) {
  detail::FileLocator locator(folder, options.packages);
  const detail::Urdf urdf = read_description(xml, file, folder, options, locator);
  detail::RobotTree tree = detail::build_tree(urdf);
  hold_joints(file, options.joints, tree);
  const auto choices = detail::choose_links(urdf, options);
  detail::GeometryLoader loader(locator, options);

  auto model = std::make_unique<Model>();
  model->name = urdf.name;
  model->options = options;
  model->joints = std::move(tree.joints);
  model->variables = std::move(tree.variables);
  for (const std::size_t i : tree.links) {
    detail::LinkGeometry geometry = loader.load(urdf.links[i], choices[i]);
    model->links.push_back(urdf.links[i].name);
    model->meshes.push_back(std::move(geometry.meshes));
    model->report.push_back(std::move(geometry.report));
  }
  for (const auto& notes : {urdf.warnings, loader.notes(), detail::geometry_notes(urdf, choices)})
    model->notes.insert(model->notes.end(), notes.begin(), notes.end());
  return model;
}

Robot Robot::join(std::span<const PlacedRobot> robots) {
  if (robots.empty()) throw InputError("no robots to join");
  auto model = std::make_unique<Model>();
  model->meshes.emplace_back();
  LinkReport& world = model->report.emplace_back();
  world.link = model->links.emplace_back("world");
  world.reason = "the place of the robots";
  for (const PlacedRobot& robot : robots) {
    const auto has_name = [&](const RobotPart& part) { return part.name == robot.name; };
    if (robot.name.empty() || robot.name.find('/') != std::string::npos ||
        std::any_of(model->parts.begin(), model->parts.end(), has_name))
      throw InputError("robot '" + robot.name +
                       "': each robot needs a name of its own, without '/'");
    if (!is_rigid(robot.T_world_root))
      throw InputError("robot '" + robot.name + "': its pose is not a rigid transform");
    model->add(robot);
    model->name += (model->name.empty() ? "" : " + ") + robot.name;
  }
  return Robot(std::move(model));
}

Robot Robot::load(const fs::path& urdf, const RobotOptions& options) {
  auto model = make_model(read_whole_file(urdf, FileLimit::text), urdf.string(), urdf.parent_path(),
                          options);
  model->urdf = urdf;
  return Robot(std::move(model));
}

Robot Robot::parse(std::string_view xml, const fs::path& folder, const RobotOptions& options) {
  return Robot(make_model(xml, "robot_description", folder, options));
}

Robot::Robot(std::unique_ptr<Model> model) {
  for (std::size_t i = 0; i < model->links.size(); ++i)
    model->link_index.emplace(model->links[i], i);
  for (std::size_t i = 0; i < model->variables.size(); ++i)
    model->variable_index.emplace(model->variables[i], i);
  model_ = std::move(model);
}

const std::string& Robot::name() const { return model_->name; }
const fs::path& Robot::urdf() const { return model_->urdf; }
const RobotOptions& Robot::options() const { return model_->options; }
std::span<const std::string> Robot::links() const { return model_->links; }
std::span<const Joint> Robot::joints() const { return model_->joints; }
std::span<const std::string> Robot::variables() const { return model_->variables; }
std::span<const LinkReport> Robot::report() const { return model_->report; }
std::span<const std::string> Robot::notes() const { return model_->notes; }
std::span<const RobotPart> Robot::parts() const { return model_->parts; }
std::span<const PreparedMesh> Robot::meshes(std::size_t link) const { return model_->meshes[link]; }

const RobotPart* Robot::part_of(std::size_t link) const {
  for (const RobotPart& part : model_->parts)
    if (part.first_link <= link && link < part.end_link) return &part;
  return nullptr;
}

std::optional<std::size_t> Robot::find_link(std::string_view name) const {
  return find(model_->link_index, name);
}

std::optional<std::size_t> Robot::find_variable(std::string_view name) const {
  return find(model_->variable_index, name);
}

std::vector<double> Robot::rest_positions() const {
  std::vector<double> positions(variables().size(), 0.0);
  for (const Joint& joint : joints())
    if (joint.type == JointType::floating) positions[*joint.variable + 6] = 1.0;
  return positions;
}

void Robot::forward_kinematics(std::span<const double> positions,
                               std::span<Isometry3d> T_root_link) const {
  check_positions(*this, positions, T_root_link.size());
  T_root_link[0].setIdentity();
  for (const Joint& joint : joints())
    T_root_link[joint.child] =
        T_root_link[joint.parent] * (joint.origin * motion(joint, positions));
}

std::size_t find_camera_parent(const Robot& robot, const std::string& name) {
  if (name.empty()) return 0;
  if (const auto link = robot.find_link(name)) return *link;
  std::string known;
  for (const std::string& link : robot.links()) known += (known.empty() ? "" : ", ") + link;
  throw InputError("camera parent '" + name + "' is not a link of robot '" + robot.name() +
                   "'; its links: " + known);
}

}  // namespace penumbra
