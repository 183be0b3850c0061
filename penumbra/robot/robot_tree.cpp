// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text.hpp>
#include <penumbra/robot/robot_tree-inl.hpp>

namespace penumbra::detail {
namespace {

using Index = std::unordered_map<std::string_view, std::size_t>;

/// Fails at a link or joint.
template <typename Element>
[[noreturn]] void fail(const Element& element, const std::string& what) {
  throw InputError(element.place + ": " + what);
}

template <typename Named>
Index index_names(const std::vector<Named>& list) {
  Index index;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const auto [at, is_new] = index.emplace(list[i].name, i);
    if (!is_new) fail(list[i], "this name is already used at " + list[at->second].place);
  }
  return index;
}

/// Joints by the links at their ends, as indices into Urdf::joints.
struct Edges {
  std::vector<std::optional<std::size_t>> into;  // of each link
  std::vector<std::vector<std::size_t>> out;     // of each link, in the file's order
  std::vector<std::size_t> parent;               // link of each joint
  std::vector<std::size_t> child;                // link of each joint
};

std::size_t find_end(const Index& links, const UrdfJoint& joint, const std::string& end,
                     const std::string& name) {
  const auto at = links.find(name);
  if (at == links.end())
    fail(joint, "its " + end + " link " + in_quotes(name) + " is not in the file");
  return at->second;
}

Edges connect(const Urdf& urdf) {
  const Index links = index_names(urdf.links);
  Edges edges;
  edges.into.resize(urdf.links.size());
  edges.out.resize(urdf.links.size());
  for (std::size_t j = 0; j < urdf.joints.size(); ++j) {
    const UrdfJoint& joint = urdf.joints[j];
    edges.parent.push_back(find_end(links, joint, "parent", joint.parent));
    edges.child.push_back(find_end(links, joint, "child", joint.child));
    auto& into = edges.into[edges.child[j]];
    if (into)
      fail(joint, "its child link " + in_quotes(joint.child) + " is already the child of joint " +
                      in_quotes(urdf.joints[*into].name) + "; a link has one parent");
    into = j;
    edges.out[edges.parent[j]].push_back(j);
  }
  return edges;
}

std::size_t find_root(const Urdf& urdf, const Edges& edges) {
  std::optional<std::size_t> root;
  for (std::size_t i = 0; i < urdf.links.size(); ++i) {
    if (edges.into[i]) continue;
    if (root)
      fail(urdf.links[i], "is a second root besides link " + in_quotes(urdf.links[*root].name) +
                              "; every link but one needs a joint to a parent");
    root = i;
  }
  if (!root) fail(urdf.links.front(), "the joints form a cycle: every link has a parent");
  return *root;
}

/// A link and the joint that leads to it; the root has none.
struct Visit {
  std::size_t link;
  std::optional<std::size_t> joint;
};

/// Returns all links in depth-first order.
std::vector<Visit> walk(const Urdf& urdf, const Edges& edges) {
  std::vector<Visit> order;
  std::vector<bool> seen(urdf.links.size(), false);
  std::vector<Visit> open{{find_root(urdf, edges), std::nullopt}};
  while (!open.empty()) {
    const Visit visit = open.back();
    open.pop_back();
    order.push_back(visit);
    seen[visit.link] = true;
    const auto& out = edges.out[visit.link];
    for (auto j = out.rbegin(); j != out.rend(); ++j) open.push_back({edges.child[*j], *j});
  }
  const auto lost = std::find(seen.begin(), seen.end(), false);
  if (lost != seen.end())
    fail(urdf.links[static_cast<std::size_t>(lost - seen.begin())],
         "is part of a cycle of joints that is not connected to the root link");
  return order;
}

/// Returns what follows the joint's name in the names of its variables.
std::span<const std::string_view> variable_endings(JointType type) {
  static constexpr std::string_view single[] = {""};
  static constexpr std::string_view planar[] = {"/x", "/y", "/yaw"};
  static constexpr std::string_view floating[] = {"/x", "/y", "/z", "/qx", "/qy", "/qz", "/qw"};
  if (type == JointType::fixed) return {};
  if (type == JointType::planar) return planar;
  if (type == JointType::floating) return floating;
  return single;
}

/// Gives a variable to every joint that moves and mimics no other.
void add_variables(const Urdf& urdf, const std::vector<std::size_t>& source, RobotTree& tree) {
  for (std::size_t i = 0; i < tree.joints.size(); ++i) {
    Joint& joint = tree.joints[i];
    const UrdfJoint& from = urdf.joints[source[i]];
    const auto endings = variable_endings(joint.type);
    joint.mimics = from.mimic.has_value() && !endings.empty();  // a fixed joint never moves
    if (joint.mimics && endings.size() != 1)
      fail(from, "mimics another joint, but has more than one value itself");
    if (joint.mimics || endings.empty()) continue;
    joint.variable = tree.variables.size();
    for (const std::string_view ending : endings)
      tree.variables.push_back(joint.name + std::string(ending));
  }
  std::unordered_set<std::string_view> seen;
  for (const std::string& name : tree.variables)
    if (!seen.insert(name).second)
      throw InputError(urdf.file + ": two joints have a position named " + in_quotes(name) +
                       "; rename one of them");
}

/// Gives every mimicking joint the variable at the end of its chain of joints. `source[i]` is the
/// URDF's joint that became joints[i].
void resolve_mimics(const Urdf& urdf, const std::vector<std::size_t>& source,
                    std::vector<Joint>& joints) {
  constexpr int longest_chain = 1000;
  Index index;
  for (std::size_t i = 0; i < joints.size(); ++i) index.emplace(joints[i].name, i);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (!joints[i].mimics) continue;
    const UrdfJoint& start = urdf.joints[source[i]];
    double multiplier = 1.0;
    double offset = 0.0;
    std::size_t at = i;
    for (int steps = 0; joints[at].mimics && !joints[at].variable; ++steps) {
      if (steps > longest_chain) fail(start, "mimics in a cycle");
      const UrdfMimic& mimic = *urdf.joints[source[at]].mimic;
      const auto target = index.find(mimic.joint);
      if (target == index.end())
        fail(start, "mimics " + in_quotes(mimic.joint) + ", which is not in the file");
      offset += multiplier * mimic.offset;
      multiplier *= mimic.multiplier;
      at = target->second;
    }
    const Joint& target = joints[at];
    if (variable_endings(target.type).size() != 1)
      fail(start, "mimics " + in_quotes(target.name) +
                      ", which has no single value; expected a revolute, continuous or prismatic "
                      "joint");
    joints[i].variable = target.variable;
    joints[i].offset = offset + multiplier * target.offset;
    joints[i].multiplier = multiplier * target.multiplier;
    const auto is_large = [](double value) { return !(std::abs(value) <= largest_mimic); };
    if (is_large(joints[i].multiplier) || is_large(joints[i].offset))
      fail(start, "its chain of mimics multiplies or offsets by more than 1e9");
  }
}

}  // namespace

RobotTree build_tree(const Urdf& urdf) {
  if (urdf.links.empty()) throw InputError(urdf.file + ": the robot has no links");
  const Edges edges = connect(urdf);
  index_names(urdf.joints);
  RobotTree tree;
  std::vector<std::size_t> source;  // of each joint
  std::vector<std::size_t> place(urdf.links.size());
  for (const auto& [link, from] : walk(urdf, edges)) {
    place[link] = tree.links.size();
    tree.links.push_back(link);
    if (!from) continue;
    Joint& joint = tree.joints.emplace_back(urdf.joints[*from].joint);
    joint.name = urdf.joints[*from].name;
    joint.parent = place[edges.parent[*from]];
    joint.child = place[link];
    source.push_back(*from);
  }
  add_variables(urdf, source, tree);
  resolve_mimics(urdf, source, tree.joints);
  return tree;
}

}  // namespace penumbra::detail
