// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text-inl.hpp>
#include <penumbra/robot/robot_tree-inl.hpp>

namespace penumbra::detail {
namespace {

constexpr std::string_view kSingle[] = {""};
constexpr std::string_view kPlanar[] = {"/x", "/y", "/yaw"};
constexpr std::string_view kFloating[] = {"/x", "/y", "/z", "/qx", "/qy", "/qz", "/qw"};

std::span<const std::string_view> endings(JointType type) {
  if (type == JointType::fixed) return {};
  if (type == JointType::planar) return kPlanar;
  if (type == JointType::floating) return kFloating;
  return kSingle;
}

/// Follows mimicking joints to the joint that moves by itself.
class MimicFolder {
 public:
  MimicFolder(const Urdf& urdf, const std::vector<std::size_t>& source, RobotTree& tree)
      : urdf_(urdf), source_(source), joints_(tree.joints) {
    for (std::size_t i = 0; i < joints_.size(); ++i) index_.emplace(joints_[i].name, i);
  }

  void fold_all() {
    for (std::size_t i = 0; i < joints_.size(); ++i)
      if (joints_[i].mimics) fold(i);
  }

 private:
  const UrdfJoint& urdf_joint(std::size_t i) const { return urdf_.joints[source_[i]]; }
  bool open(std::size_t i) const { return joints_[i].mimics && !joints_[i].variable; }

  void fold(std::size_t start) {
    std::vector<std::size_t> chain;
    for (std::size_t i = start; open(i); i = target_of(i)) {
      if (chain.size() > joints_.size()) fail_at(urdf_, urdf_joint(start), "mimics in a cycle");
      chain.push_back(i);
    }
    for (auto i = chain.rbegin(); i != chain.rend(); ++i) follow(*i, joints_[target_of(*i)]);
  }

  std::size_t target_of(std::size_t i) const {
    const UrdfJoint& joint = urdf_joint(i);
    const auto at = index_.find(joint.mimic->joint);
    if (at == index_.end())
      fail_at(urdf_, joint,
              "mimics " + in_quotes(joint.mimic->joint) + ", which is not in the file");
    if (endings(joints_[at->second].type).size() != 1)
      fail_at(
          urdf_, joint,
          "mimics " + in_quotes(joint.mimic->joint) +
              ", which has no single value; expected a revolute, continuous or prismatic joint");
    return at->second;
  }

  void follow(std::size_t i, const Joint& target) {
    const UrdfMimic& mimic = *urdf_joint(i).mimic;
    Joint& joint = joints_[i];
    joint.variable = target.variable;
    joint.multiplier = mimic.multiplier * target.multiplier;
    joint.offset = mimic.multiplier * target.offset + mimic.offset;
    const double largest = std::max(std::abs(joint.multiplier), std::abs(joint.offset));
    if (!(largest <= kLargestMimic))
      fail_at(urdf_, urdf_joint(i), "its chain of mimics multiplies or offsets by more than 1e9");
  }

  const Urdf& urdf_;
  const std::vector<std::size_t>& source_;
  std::vector<Joint>& joints_;
  std::unordered_map<std::string_view, std::size_t> index_;
};

void check_names(const Urdf& urdf, const std::vector<std::string>& variables) {
  std::unordered_set<std::string_view> seen;
  for (const std::string& name : variables)
    if (!seen.insert(name).second)
      throw InputError(urdf.file + ": two joints have a position named " + in_quotes(name) +
                       "; rename one of them");
}

}  // namespace

void assign_variables(const Urdf& urdf, const std::vector<std::size_t>& source, RobotTree& tree) {
  for (std::size_t i = 0; i < tree.joints.size(); ++i) {
    Joint& joint = tree.joints[i];
    const UrdfJoint& from = urdf.joints[source[i]];
    const auto names = endings(joint.type);
    joint.mimics = from.mimic.has_value() && !names.empty();  // a fixed joint cannot move after all
    if (joint.mimics && names.size() != 1)
      fail_at(urdf, from, "mimics another joint, but has more than one value of its own");
    if (joint.mimics || names.empty()) continue;
    joint.variable = tree.variables.size();
    for (const std::string_view ending : names)
      tree.variables.push_back(joint.name + std::string(ending));
  }
  check_names(urdf, tree.variables);
  MimicFolder(urdf, source, tree).fold_all();
}

}  // namespace penumbra::detail
