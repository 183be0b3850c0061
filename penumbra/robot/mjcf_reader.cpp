// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <system_error>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text.hpp>
#include <penumbra/base/whole_file-inl.hpp>
#include <penumbra/robot/mjcf-inl.hpp>

namespace penumbra::detail {
namespace {

namespace fs = std::filesystem;

/// Replaces each <include> by the content of its file.
class MjcfIncludes {
 public:
  MjcfIncludes(const std::string& file, fs::path folder, UrdfWarnings& messages)
      : folder_(std::move(folder)), messages_(&messages), open_{canonical(file)} {}

  void expand(XmlElement& element) {
    constexpr std::size_t most_elements = 2'000'000;
    std::vector<XmlElement> children;
    for (XmlElement& child : element.children) {
      if (++elements_ > most_elements)
        UrdfNode(child, *messages_, "").fail("with its includes the file has too many elements");
      if (child.name == "include") {
        XmlElement part = read(child);
        expand(part);
        open_.pop_back();
        std::ranges::move(part.children, std::back_inserter(children));
      } else {
        expand(child);
        children.push_back(std::move(child));
      }
    }
    element.children = std::move(children);
  }

 private:
  static fs::path canonical(const fs::path& file) {
    std::error_code error;
    fs::path path = fs::weakly_canonical(file, error);
    return error ? file : path;
  }

  XmlElement read(const XmlElement& include) {
    const UrdfNode node(include, *messages_, "include");
    node.expect({"file"});
    constexpr std::size_t most_files = 1000;
    constexpr std::size_t deepest = 20;
    if (++files_ > most_files || open_.size() > deepest)
      node.fail("more than " + std::to_string(most_files) + " files are included, or they are " +
                "nested deeper than " + std::to_string(deepest));
    const fs::path file = locate(node);
    open_.push_back(canonical(file));
    if (std::ranges::count(open_, open_.back()) > 1)
      node.fail("file " + file.string() + " includes itself");
    return read_xml(read_whole_file(file, FileLimit::text), file.string());
  }

  [[nodiscard]] fs::path locate(const UrdfNode& node) const {
    const std::string& name = node.text("file");
    std::error_code error;
    for (const fs::path& folder : {folder_, fs::path(*node.xml().file).parent_path()})
      if (fs::is_regular_file(folder / name, error)) return folder / name;
    node.fail("no file at " + (folder_ / name).string());
  }

  fs::path folder_;
  UrdfWarnings* messages_;
  std::vector<fs::path> open_;  // files, from the main one to that being read
  std::size_t files_ = 0;
  std::size_t elements_ = 0;
};

void read_compiler(const UrdfNode& node, MjcfCompiler& out) {
  node.expect(
      {"angle meshdir assetdir eulerseq autolimits coordinate strippath alignfree",
       "boundmass boundinertia settotalmass balanceinertia fitaabb texturedir discardvisual "
       "usethread fusestatic inertiafromgeom inertiagrouprange saveinertial "
       "exactmeshinertia convexhull conflict",
       "", "lengthrange"});
  if (node.has("angle")) {
    const std::string& angle = node.text("angle");
    if (angle != "degree" && angle != "radian")
      node.fail("angle=" + in_quotes(angle) + " is not degree or radian");
    out.degrees = angle == "degree";
  }
  if (node.has("coordinate") && node.text("coordinate") != "local")
    node.fail("coordinate=" + in_quotes(node.text("coordinate")) +
              " is not supported; MuJoCo 2.3.3 and older convert it to \"local\"");
  if (mjcf_flag(node, "alignfree", false))
    node.fail("alignfree=\"true\" moves the frames of free bodies; write \"false\"");
  if (node.has("eulerseq")) out.eulerseq = node.text("eulerseq");
  if (out.eulerseq.size() != 3 || out.eulerseq.find_first_not_of("xyzXYZ") != std::string::npos)
    node.fail("eulerseq=" + in_quotes(out.eulerseq) + " is not three of x, y, z, X, Y, Z");
  out.autolimits = mjcf_flag(node, "autolimits", out.autolimits);
  out.strippath = mjcf_flag(node, "strippath", out.strippath);
  for (const char* const key : {"assetdir", "meshdir"})
    if (node.has(key) && !node.xml().attribute(key)->empty()) out.meshes = node.text(key);
}

/// Returns a path relative to the main file's folder: that below the folder of the meshes or, if it
/// does not exist, the same below the folder of the included file.
std::string mesh_path(const UrdfNode& node, const MjcfCompiler& compiler, const fs::path& folder) {
  fs::path name = node.text("file");
  if (compiler.strippath) name = name.filename();
  fs::path path = compiler.meshes / name;
  std::error_code error;
  if (fs::is_regular_file(folder / path, error)) return path.string();
  const fs::path below = fs::path(*node.xml().file).parent_path().lexically_relative(folder);
  const fs::path other = compiler.meshes / below / name;
  return (fs::is_regular_file(folder / other, error) ? other : path).string();
}

void read_asset_mesh(const UrdfNode& own, const fs::path& folder, MjcfModel& model) {
  const XmlElement complete = model.defaults.complete(own, "main", "mesh");
  const UrdfNode unnamed = own.with(complete);
  const std::string name =
      unnamed.has("name") ? unnamed.identifier() : fs::path(unnamed.text("file")).stem().string();
  const UrdfNode node = unnamed.named("mesh " + in_quotes(name));
  if (model.meshes.contains(name)) node.fail("this name is given twice");
  auto& [mesh, fault] = model.meshes[name];
  try {
    own.expect(mjcf_mesh_rule);
    if (node.has("vertex") || node.has("builtin"))
      node.fail("a mesh without a file is not supported; write it to an OBJ or STL file");
    mesh.filename = mesh_path(node, model.compiler, folder);
    mesh.scale = mjcf_vector(node, "scale", Eigen::Vector3d::Ones());
    if ((mesh.scale.array() == 0.0).any())
      node.fail("scale=" + in_quotes(node.text("scale")) + " flattens the mesh");
    Eigen::Isometry3d T_file_ref = Eigen::Isometry3d::Identity();
    T_file_ref.translation() = mjcf_vector(node, "refpos", Eigen::Vector3d::Zero());
    if (node.has("refquat"))
      T_file_ref.linear() = mjcf_quaternion(node, "refquat").toRotationMatrix();
    mesh.T_scaled_file = T_file_ref.inverse();
  } catch (const InputError& error) {
    fault = error.what();
  }
}

void read_assets(const UrdfNode& node, const fs::path& folder, MjcfModel& model) {
  node.expect({"", "", "mesh skin", "texture material hfield model"});
  for (const UrdfNode& child : node.children()) {
    if (child.name() == "skin") child.fail("skins are not supported");
    if (child.name() == "mesh") read_asset_mesh(child, folder, model);
  }
}

/// The joints with one value, by name.
using ScalarJoints = std::map<std::string, UrdfJoint*>;

UrdfJoint& find_joint(const UrdfNode& node, std::string_view key, const ScalarJoints& joints) {
  const std::string& name = node.text(key);
  const auto joint = joints.find(name);
  if (joint == joints.end())
    node.fail(std::string(key) + "=" + in_quotes(name) + " is no hinge or slide joint");
  return *joint->second;
}

std::array<double, 5> polynomial_of(const UrdfNode& node) {
  std::array<double, 5> a = {0.0, 1.0, 0.0, 0.0, 0.0};
  if (!node.has("polycoef")) return a;
  const std::vector<double> given = mjcf_numbers(node, "polycoef");
  if (given.size() > a.size()) node.fail("polycoef has more than 5 numbers");
  std::ranges::copy(given, a.begin());
  if (std::ranges::any_of(a, [](double c) { return std::abs(c) > largest_mimic; }))
    node.fail("polycoef=" + in_quotes(node.text("polycoef")) + " must lie within +-1e9");
  return a;
}

/// Makes joint1 mimic joint2: y - y0 = a0 + a1 (x - x0), where x0 and y0 are the joints' refs; a
/// constant one becomes fixed. Returns false if this constraint cannot be enforced.
bool couple(const UrdfNode& node, const std::map<std::string, double>& refs,
            const ScalarJoints& joints) {
  const std::array<double, 5> a = polynomial_of(node);
  UrdfJoint& y = find_joint(node, "joint1", joints);
  const UrdfJoint* const x = node.has("joint2") ? &find_joint(node, "joint2", joints) : nullptr;
  const bool is_linear = a[2] == 0.0 && a[3] == 0.0 && a[4] == 0.0;
  if (y.mimic || y.joint.type == JointType::fixed || (x != nullptr && !is_linear)) return false;
  const double y_at_zero = refs.at(y.name) + a[0];
  if (x == nullptr || a[1] == 0.0) {
    y.joint.origin = y.joint.origin * mjcf_motion(y.joint, y_at_zero);
    y.joint.type = JointType::fixed;
  } else {
    y.mimic = UrdfMimic{x->name, a[1], y_at_zero - a[1] * refs.at(x->name)};
  }
  return true;
}

ScalarJoints scalar_joints(MjcfModel& model) {
  ScalarJoints joints;
  for (UrdfJoint& joint : model.urdf.joints)
    if (model.refs.contains(joint.name)) joints.emplace(joint.name, &joint);
  return joints;
}

/// Returns the number of constraints that are not enforced.
std::size_t read_equalities(const UrdfNode& section, const MjcfModel& model,
                            const ScalarJoints& joints) {
  section.expect({"", "", "joint connect weld tendon flex flexvert flexstrain distance"});
  std::size_t open = 0;
  for (const UrdfNode& own : section.children()) {
    const bool is_joint = own.name() == "joint";
    if (is_joint) own.expect({"joint1 joint2 polycoef active class", "name solref solimp"});
    const XmlElement complete = model.defaults.complete(own, "main", "equality");
    const UrdfNode node = own.with(complete);
    if (!mjcf_flag(node, "active", true)) continue;
    if (!is_joint || !couple(node, model.refs, joints)) ++open;
  }
  return open;
}

/// Calls a function for all sections of a name.
template <typename Read>
void for_each(const UrdfNode& root, std::string_view name, Read&& read) {
  for (const UrdfNode& child : root.children())
    if (child.name() == name) read(child);
}

void add_notes(const MjcfModel& model, std::size_t open, std::vector<std::string>& notes) {
  const auto note = [&](std::size_t count, const std::string& what) {
    if (count > 0) notes.push_back(what + ": " + std::to_string(count));
  };
  note(model.surroundings,
       "geoms of the world itself (floor, table), which are not drawn as they are no body's");
  note(model.hidden,
       "geoms that are not drawn as they do not collide and are in a group above 2 or transparent");
  note(open,
       "equality constraints (closed loops, tendons, nonlinear ones) that are not enforced: each "
       "of their joints needs a position of its own");
  for (const std::string& name : model.balls)
    notes.push_back("joint " + in_quotes(name) +
                    ": a ball joint is read as a floating one; its x, y and z must be 0");
}

}  // namespace

Urdf read_mjcf(XmlElement root, const fs::path& folder) {
  UrdfWarnings messages;
  MjcfIncludes(*root.file, folder, messages).expand(root);
  const UrdfNode node(root, messages, "");
  node.expect({"model", "", "compiler default asset worldbody equality deformable",
               "option size visual statistic custom extension contact tendon actuator sensor "
               "keyframe"});
  MjcfModel model;
  Urdf& urdf = model.urdf;
  urdf.file = *root.file;
  urdf.name = node.has("model") ? node.text("model") : "MuJoCo Model";
  urdf.links.push_back({"world", node.place(), {}, {}});
  std::size_t open = 0;
  for_each(node, "deformable", [](const UrdfNode& n) { n.fail("deformables are not supported"); });
  for_each(node, "compiler", [&](const UrdfNode& n) { read_compiler(n, model.compiler); });
  for_each(node, "default", [&](const UrdfNode& n) { model.defaults.read(n); });
  for_each(node, "asset", [&](const UrdfNode& n) { read_assets(n, folder, model); });
  for_each(node, "worldbody", [&](const UrdfNode& n) { read_mjcf_world(n, model); });
  const ScalarJoints joints = scalar_joints(model);
  for_each(node, "equality", [&](const UrdfNode& n) { open += read_equalities(n, model, joints); });
  if (urdf.links.size() == 1) node.fail("the model has no bodies; this may be a part of one");
  for (auto& [kind, line] : messages) urdf.warnings.push_back(std::move(line));
  add_notes(model, open, urdf.warnings);
  return urdf;
}

}  // namespace penumbra::detail
