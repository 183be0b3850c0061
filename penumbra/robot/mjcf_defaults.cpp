// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <sstream>
#include <utility>

#include <penumbra/base/text.hpp>
#include <penumbra/robot/mjcf-inl.hpp>

namespace penumbra::detail {
namespace {

constexpr std::array<std::string_view, 5> orientations = {"quat", "axisangle", "xyaxes", "zaxis",
                                                          "euler"};

bool is_orientation(const XmlAttribute& attribute) {
  return std::ranges::find(orientations, attribute.name) != orientations.end();
}

/// Returns the attribute that gives an element's orientation; null: none does.
const XmlAttribute* orientation_of(const UrdfNode& node) {
  const XmlAttribute* found = nullptr;
  for (const XmlAttribute& attribute : node.xml().attributes) {
    if (!is_orientation(attribute)) continue;
    if (found != nullptr)
      node.fail("has both " + found->name + " and " + attribute.name + "; one is expected");
    found = &attribute;
  }
  return found;
}

/// Returns the words of a list that come after those of another.
std::string words_after(const std::string& given, const std::string& list) {
  std::istringstream some(given), all(list);
  std::string word, rest;
  while (all >> word)
    if (!(some >> word)) rest += " " + word;
  return rest;
}

/// Returns whether an element keeps its orientation although a default has one, too. MuJoCo reads
/// all others over a quat, wherever they stand; its versions differ in which of two others counts.
bool keeps_orientation(const UrdfNode& node, const std::string& own, const std::string& inherited) {
  if (own != "quat" && inherited != "quat" && own != inherited)
    node.fail("has " + own + ", but its default class has " + inherited + "; write both alike");
  return own != "quat" || inherited == "quat";
}

/// Returns an element with the attributes that it lacks from a default.
XmlElement merged(const UrdfNode& node, const UrdfNode& base) {
  XmlElement out = node.xml();
  const XmlAttribute* const own = orientation_of(node);
  const XmlAttribute* const inherited = orientation_of(base);
  const bool has_two = own != nullptr && inherited != nullptr;
  const bool keeps_own = has_two && keeps_orientation(node, own->name, inherited->name);
  if (has_two && !keeps_own) std::erase_if(out.attributes, is_orientation);
  for (const XmlAttribute& attribute : base.xml().attributes) {
    const auto known = std::ranges::find(out.attributes, attribute.name, &XmlAttribute::name);
    if (known == out.attributes.end() && !(keeps_own && is_orientation(attribute)))
      out.attributes.push_back(attribute);
    else if (attribute.name == "size")  // a shorter list replaces the first numbers
      known->value += words_after(known->value, attribute.value);
  }
  return out;
}

/// Returns the rule of an element of <default>; null: it is not read.
const ElementRule* rule_of(std::string_view kind) {
  static constexpr ElementRule equality = {"active", "solref solimp"};
  if (kind == "geom") return &mjcf_geom_rule;
  if (kind == "joint") return &mjcf_joint_rule;
  if (kind == "mesh") return &mjcf_mesh_rule;
  return kind == "equality" ? &equality : nullptr;
}

/// Every class and element copies these attributes.
void expect_short(const UrdfNode& node) {
  constexpr std::size_t longest = 1000;
  for (const XmlAttribute& attribute : node.xml().attributes)
    if (attribute.value.size() > longest)
      node.fail(attribute.name + " has more than " + std::to_string(longest) + " characters");
}

Eigen::Quaterniond turn(double angle, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
}

Eigen::Vector3d direction(const UrdfNode& node, const Eigen::Vector3d& vector) {
  constexpr double shortest = 1e-9;
  if (!(vector.stableNorm() > shortest)) node.fail("an axis of its orientation has no length");
  return vector.stableNormalized();
}

Eigen::Quaterniond euler_rotation(const UrdfNode& node, const MjcfCompiler& compiler) {
  const Eigen::Vector3d angles = node.vector("euler");
  Eigen::Quaterniond all = Eigen::Quaterniond::Identity();
  for (int i = 0; i < 3; ++i) {
    const char letter = compiler.eulerseq[static_cast<std::size_t>(i)];
    const bool is_fixed = std::isupper(static_cast<unsigned char>(letter)) != 0;
    const int axis = letter - (is_fixed ? 'X' : 'x');
    const auto one = turn(angles[i] * compiler.angle_unit(), Eigen::Vector3d::Unit(axis));
    all = is_fixed ? one * all : all * one;
  }
  return all;
}

Eigen::Quaterniond rotation_of_axes(const UrdfNode& node) {
  Eigen::Matrix<double, 3, 2> xy;
  node.numbers("xyaxes", {xy.data(), 6});
  Eigen::Matrix3d axes;
  axes.col(0) = direction(node, xy.col(0));
  axes.col(1) = direction(node, xy.col(1) - axes.col(0).dot(xy.col(1)) * axes.col(0));
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return Eigen::Quaterniond(axes);
}

Eigen::Quaterniond rotation_of(const UrdfNode& node, const MjcfCompiler& compiler) {
  const XmlAttribute* const given = orientation_of(node);
  if (given == nullptr) return Eigen::Quaterniond::Identity();
  if (given->name == "quat") return mjcf_quaternion(node, "quat");
  if (given->name == "euler") return euler_rotation(node, compiler);
  if (given->name == "xyaxes") return rotation_of_axes(node);
  if (given->name == "zaxis") return mjcf_rotation_to(node, node.vector("zaxis"));
  Eigen::Vector4d turned;
  node.numbers("axisangle", {turned.data(), 4});
  return turn(turned[3] * compiler.angle_unit(), direction(node, turned.head<3>()));
}

}  // namespace

void MjcfDefaults::read(const UrdfNode& section) {
  if (section.has("class")) other_names_of_main_.insert(section.text("class"));
  read(section, "main", classes_.at("main"));
}

void MjcfDefaults::read(const UrdfNode& section, const std::string& name, Elements elements) {
  section.expect({"class", "", "default geom joint mesh equality",
                  "material site camera light pair tendon general motor position velocity "
                  "intvelocity orientation pid damper cylinder muscle adhesion dcmotor plugin"});
  for (const UrdfNode& child : section.children()) {
    const ElementRule* const rule = rule_of(child.name());
    if (rule == nullptr) continue;
    child.expect(*rule);
    expect_short(child);
    const auto known = elements.find(child.name());
    elements[child.name()] =
        known == elements.end() ? child.xml() : merged(child, child.with(known->second));
  }
  classes_[name] = elements;
  for (const UrdfNode& child : section.children()) {
    if (child.name() != "default") continue;
    const std::string& nested = child.text("class");
    if (classes_.contains(nested)) child.fail("class " + in_quotes(nested) + " is given twice");
    read(child.named("default " + in_quotes(nested)), nested, elements);
  }
}

std::string MjcfDefaults::childclass(const UrdfNode& node, const std::string& parent) const {
  if (!node.has("childclass")) return parent;
  const std::string& name = node.text("childclass");
  if (other_names_of_main_.contains(name)) return "main";
  if (!classes_.contains(name))
    node.fail("childclass=" + in_quotes(name) + " is no class of <default>");
  return name;
}

XmlElement MjcfDefaults::complete(const UrdfNode& node, const std::string& childclass,
                                  const std::string& kind) const {
  std::string name = node.has("class") ? node.text("class") : childclass;
  if (other_names_of_main_.contains(name)) name = "main";
  const auto elements = classes_.find(name);
  if (elements == classes_.end())
    node.fail("class=" + in_quotes(name) + " is no class of <default>");
  const auto base = elements->second.find(kind);
  return base == elements->second.end() ? node.xml() : merged(node, node.with(base->second));
}

bool mjcf_flag(const UrdfNode& node, std::string_view key, bool absent) {
  if (!node.has(key)) return absent;
  const std::string& value = node.text(key);
  if (value != "true" && value != "false")
    node.fail(std::string(key) + "=" + in_quotes(value) + " is not true or false");
  return value == "true";
}

std::vector<double> mjcf_numbers(const UrdfNode& node, std::string_view key) {
  std::istringstream words(node.text(key));
  std::string word;
  std::vector<double> out;
  while (words >> word) out.push_back(0.0);
  node.numbers(key, out);
  return out;
}

Eigen::Vector3d mjcf_vector(const UrdfNode& node, std::string_view key,
                            const Eigen::Vector3d& absent) {
  if (!node.has(key)) return absent;
  Eigen::Vector3d value = node.vector(key);
  if (value.cwiseAbs().maxCoeff() > farthest_origin)
    node.fail(std::string(key) + "=" + in_quotes(node.text(key)) + " lies beyond 1e6");
  return value;
}

Eigen::Quaterniond mjcf_quaternion(const UrdfNode& node, std::string_view key) {
  Eigen::Vector4d wxyz;
  node.numbers(key, {wxyz.data(), 4});
  constexpr double shortest = 1e-9;
  if (!(wxyz.stableNorm() > shortest))
    node.fail(std::string(key) + "=" + in_quotes(node.text(key)) + " has no length");
  wxyz.stableNormalize();
  return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
}

Eigen::Quaterniond mjcf_rotation_to(const UrdfNode& node, const Eigen::Vector3d& z) {
  const Eigen::Vector3d to = direction(node, z);
  const Eigen::Vector3d axis(-to.y(), to.x(), 0.0);  // z x to
  const double sine = axis.norm();
  constexpr double least = 1e-10;
  return turn(std::atan2(sine, to.z()),
              sine < least ? Eigen::Vector3d(1.0, 0.0, 0.0) : Eigen::Vector3d(axis / sine));
}

Eigen::Isometry3d mjcf_pose(const UrdfNode& node, const MjcfCompiler& compiler) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = mjcf_vector(node, "pos", Eigen::Vector3d::Zero());
  pose.linear() = rotation_of(node, compiler).toRotationMatrix();
  return pose;
}

}  // namespace penumbra::detail
