// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <string_view>
#include <unordered_map>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text-inl.hpp>
#include <penumbra/robot/robot_tree-inl.hpp>

namespace penumbra::detail {
namespace {

using Index = std::unordered_map<std::string_view, std::size_t>;

template <typename Named>
Index index_names(const Urdf& urdf, const std::vector<Named>& list) {
  Index index;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const auto [at, added] = index.emplace(list[i].name, i);
    if (!added)
      fail_at(urdf, list[i],
              "the name is taken already, on line " + std::to_string(list[at->second].line));
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

std::size_t find_end(const Urdf& urdf, const Index& links, const UrdfJoint& joint,
                     const std::string& end, const std::string& name) {
  const auto at = links.find(name);
  if (at == links.end())
    fail_at(urdf, joint, "its " + end + " link " + in_quotes(name) + " is not in the file");
  return at->second;
}

Edges connect(const Urdf& urdf, const Index& links) {
  Edges edges;
  edges.into.resize(urdf.links.size());
  edges.out.resize(urdf.links.size());
  for (std::size_t j = 0; j < urdf.joints.size(); ++j) {
    const UrdfJoint& joint = urdf.joints[j];
    edges.parent.push_back(find_end(urdf, links, joint, "parent", joint.parent));
    edges.child.push_back(find_end(urdf, links, joint, "child", joint.child));
    auto& into = edges.into[edges.child[j]];
    if (into)
      fail_at(urdf, joint,
              "its child link " + in_quotes(joint.child) + " has a parent already, by joint " +
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
      fail_at(urdf, urdf.links[i],
              "is a second root beside link " + in_quotes(urdf.links[*root].name) +
                  "; every link but one needs a joint to a parent");
    root = i;
  }
  if (!root) fail_at(urdf, urdf.links.front(), "the joints form a cycle: every link has a parent");
  return *root;
}

// Links in depth-first order with the joint that leads to each (none to the root).
struct Visit {
  std::size_t link;
  std::optional<std::size_t> joint;
};

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
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (!seen[i])
      fail_at(urdf, urdf.links[i], "hangs on a cycle of joints and not on the robot's root link");
  return order;
}

Joint make_joint(const UrdfJoint& from, std::size_t parent, std::size_t child) {
  Joint joint;
  joint.name = from.name;
  joint.type = from.type;
  joint.parent = parent;
  joint.child = child;
  joint.origin = from.origin;
  joint.axis = from.axis;
  joint.velocity = from.velocity;
  joint.lower = from.lower;
  joint.upper = from.upper;
  return joint;
}

}  // namespace

RobotTree build_tree(const Urdf& urdf) {
  if (urdf.links.empty()) throw InputError(urdf.file + ": the robot has no links");
  const Edges edges = connect(urdf, index_names(urdf, urdf.links));
  index_names(urdf, urdf.joints);
  RobotTree tree;
  std::vector<std::size_t> source;
  std::vector<std::size_t> place(urdf.links.size());
  for (const auto& [link, joint] : walk(urdf, edges)) {
    place[link] = tree.links.size();
    tree.links.push_back(link);
    if (!joint) continue;
    tree.joints.push_back(
        make_joint(urdf.joints[*joint], place[edges.parent[*joint]], place[link]));
    source.push_back(*joint);
  }
  assign_variables(urdf, source, tree);
  return tree;
}

void fail_at(const Urdf& urdf, const UrdfJoint& joint, const std::string& what) {
  throw InputError(urdf.file + ":" + std::to_string(joint.line) + ": joint " +
                   in_quotes(joint.name) + ": " + what);
}

void fail_at(const Urdf& urdf, const UrdfLink& link, const std::string& what) {
  throw InputError(urdf.file + ":" + std::to_string(link.line) + ": link " + in_quotes(link.name) +
                   ": " + what);
}

}  // namespace penumbra::detail
