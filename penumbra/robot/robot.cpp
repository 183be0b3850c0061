// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <penumbra/base/whole_file-inl.hpp>
#include <penumbra/robot/link_geometry-inl.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/robot/robot_model-inl.hpp>
#include <penumbra/robot/robot_tree-inl.hpp>

namespace penumbra {
namespace {

namespace fs = std::filesystem;

std::optional<std::size_t> find(const std::map<std::string, std::size_t, std::less<>>& index,
                                std::string_view name) {
  const auto at = index.find(name);
  return at == index.end() ? std::nullopt : std::optional(at->second);
}

}  // namespace

std::string_view to_string(JointType type) {
  switch (type) {
    case JointType::revolute:
      return "revolute";
    case JointType::continuous:
      return "continuous";
    case JointType::prismatic:
      return "prismatic";
    case JointType::fixed:
      return "fixed";
    case JointType::planar:
      return "planar";
    case JointType::floating:
      break;
  }
  return "floating";
}

std::unique_ptr<const Robot::Model> Robot::make_model(std::string_view xml, const std::string& file,
                                                      const fs::path& folder,
                                                      const RobotOptions& options) {
  const detail::Urdf urdf = detail::read_urdf(xml, file);
  detail::RobotTree tree = detail::build_tree(urdf);
  const auto choices = detail::choose_links(urdf, options);
  detail::GeometryLoader loader(urdf, folder, options);

  auto model = std::make_unique<Model>();
  model->name = urdf.name;
  model->joints = std::move(tree.joints);
  model->variables = std::move(tree.variables);
  for (const std::size_t i : tree.links) {
    detail::LinkGeometry geometry = loader.load(urdf.links[i], choices[i]);
    model->link_index.emplace(urdf.links[i].name, model->links.size());
    model->links.push_back(urdf.links[i].name);
    model->meshes.push_back(std::move(geometry.meshes));
    model->report.push_back(std::move(geometry.report));
  }
  for (std::size_t i = 0; i < model->variables.size(); ++i)
    model->variable_index.emplace(model->variables[i], i);
  model->notes = urdf.warnings;
  for (std::string& note : loader.notes()) model->notes.push_back(std::move(note));
  for (std::string& note : detail::lacking_notes(urdf, choices))
    model->notes.push_back(std::move(note));
  return model;
}

Robot Robot::load(const fs::path& urdf, const RobotOptions& options) {
  return Robot(make_model(read_whole_file(urdf, FileLimit::text), urdf.string(), urdf.parent_path(),
                          options));
}

Robot Robot::parse(std::string_view xml, const fs::path& folder, const RobotOptions& options) {
  return Robot(make_model(xml, "robot_description", folder, options));
}

Robot::Robot(std::unique_ptr<const Model> model) : model_(std::move(model)) {}
Robot::Robot(const Robot&) = default;
Robot::Robot(Robot&&) noexcept = default;
Robot& Robot::operator=(const Robot&) = default;
Robot& Robot::operator=(Robot&&) noexcept = default;
Robot::~Robot() = default;

const std::string& Robot::name() const { return model_->name; }
std::span<const std::string> Robot::links() const { return model_->links; }
std::span<const Joint> Robot::joints() const { return model_->joints; }
std::span<const std::string> Robot::variables() const { return model_->variables; }
std::span<const LinkReport> Robot::report() const { return model_->report; }
std::span<const std::string> Robot::notes() const { return model_->notes; }
std::span<const PreparedMesh> Robot::meshes(std::size_t link) const { return model_->meshes[link]; }

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

}  // namespace penumbra
