// SPDX-License-Identifier: Apache-2.0
#include "lidar_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace penumbra::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double pi = std::numbers::pi, degree = pi / 180.0;
constexpr double turn = 0.1;  // seconds
constexpr std::size_t object_count = 10;
constexpr double amplitude = 0.5, joint_speed = 2.0;  // rad, rad/s
/// CloudRule: a beam and 0.14 degrees.
constexpr double reach = LidarWorld::beam + 0.14 * degree;
const Vector3d zero = Vector3d::Zero(), X = Vector3d::UnitX(), Y = Vector3d::UnitY(),
               Z = Vector3d::UnitZ();
const Vector3d along_x(0.0, pi / 2.0, 0.0), along_y(pi / 2.0, 0.0, 0.0);  // rpy of a cylinder

std::string text(const Vector3d& v) {
  std::ostringstream out;
  out.precision(9);
  out << v.x() << ' ' << v.y() << ' ' << v.z();
  return out.str();
}

std::string urdf_of(const LidarShape& shape) {
  const auto [a, b] = std::pair(std::to_string(shape.size.x()), std::to_string(shape.size.y()));
  const std::string size = shape.kind == "box"      ? "size=\"" + text(shape.size) + '"'
                           : shape.kind == "sphere" ? "radius=\"" + a + '"'
                                                    : "radius=\"" + a + "\" length=\"" + b + '"';
  return "<collision><origin xyz=\"" + text(shape.at) + "\" rpy=\"" + text(shape.rpy) +
         "\"/><geometry><" + shape.kind + ' ' + size + "/></geometry></collision>\n";
}

/// `group`: 0 is the room, 1 the robot.
std::string geom_of(const LidarShape& shape, int group) {
  Vector3d size = shape.size;
  if (shape.kind == "box")
    size *= 0.5;
  else
    size.y() *= 0.5;
  return "<geom type=\"" + shape.kind + "\" size=\"" + text(size) + "\" pos=\"" + text(shape.at) +
         "\" euler=\"" + text(shape.rpy) + "\" group=\"" + std::to_string(group) + "\"/>\n";
}

std::string body_of(const LidarRobot& robot, const LidarLink& link) {
  std::string out = "<body name=\"" + link.name + "\" pos=\"" + text(link.at) +
                    "\"><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 1\"/>\n";
  if (!link.axis.isZero())
    out += "<joint name=\"" + link.name + "_joint\" axis=\"" + text(link.axis) + "\"/>\n";
  for (const LidarShape& shape : link.shapes) out += geom_of(shape, 1);
  for (const LidarLink& child : robot.links)
    if (child.parent == link.name) out += body_of(robot, child);
  return out + "</body>\n";
}

sim::ModelPtr load(const std::string& mjcf) {
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "scene.xml", int(mjcf.size()));
  std::memcpy(files->filedata[0], mjcf.data(), mjcf.size());
  std::array<char, 1000> why{};
  sim::ModelPtr model(mj_loadXML("scene.xml", files.get(), why.data(), why.size()));
  mj_deleteVFS(files.get());
  if (model == nullptr) throw std::logic_error("MuJoCo: " + std::string(why.data()));
  return model;
}

std::vector<LidarShape> room() {
  return {{"box", {8.0, 6.0, 0.2}, {0.0, 0.0, -0.1}},   {"box", {0.2, 6.0, 3.0}, {4.1, 0.0, 1.5}},
          {"box", {0.2, 6.0, 3.0}, {-4.1, 0.0, 1.5}},   {"box", {8.4, 0.2, 3.0}, {0.0, 3.1, 1.5}},
          {"box", {8.4, 0.2, 3.0}, {0.0, -3.1, 1.5}},   {"box", {8.0, 6.0, 0.2}, {0.0, 0.0, 3.1}},
          {"box", {0.5, 0.8, 1.9}, {-3.5, -1.5, 0.95}}, {"cylinder", {0.1, 3.0, 0}, {2.5, 2, 1.5}}};
}

/// Half of them are balls.
std::vector<LidarShape> objects(sim::Random& random) {
  std::vector<LidarShape> out;
  for (std::size_t i = 0; i < object_count; ++i) {
    const Vector3d away(20.0 + double(i), 0.0, 0.0);
    if (i % 2 == 0)
      out.push_back({"sphere", {random.uniform(0.02, 0.08), 0.0, 0.0}, away});
    else {
      const Vector3d edges(random.uniform(0.04, 0.12), random.uniform(0.04, 0.12),
                           random.uniform(0.04, 0.12));
      out.push_back({"box", edges, away, {random.uniform(0, 3), random.uniform(0, 3), 0.3}});
    }
  }
  return out;
}

/// Returns what adds a link: its name, parent, place, axis and centre of its joint, and shapes.
auto adder(LidarRobot& to, std::string prefix = {}) {
  return [&to, prefix](const std::string& name, const std::string& parent, const Vector3d& at,
                       const Vector3d& axis, double centre, std::vector<LidarShape> shapes) {
    to.links.push_back({prefix + name, parent == "cell" ? parent : prefix + parent, at, axis,
                        centre, std::move(shapes)});
  };
}

void add_arm(LidarRobot& to, const std::string& prefix, double y) {
  const auto add = adder(to, prefix);
  add("base", "cell", {0, y, 0.75}, zero, 0, {{"cylinder", {0.09, 0.10, 0}, {0, 0, 0.05}}});
  add("shoulder", "base", {0, 0, 0.10}, Z, 0.3, {{"cylinder", {0.07, 0.17, 0}, {0, 0, 0.085}}});
  add("upper_arm", "shoulder", {0, 0.13, 0.10}, Y, 0.5,
      {{"cylinder", {0.062, 0.13, 0}, zero, along_y}, {"capsule", {0.055, 0.40, 0}, {0, 0, 0.20}}});
  add("forearm", "upper_arm", {0, -0.11, 0.40}, Y, 0.9,
      {{"cylinder", {0.05, 0.12, 0}, zero, along_y}, {"box", {0.08, 0.07, 0.36}, {0, 0, 0.19}}});
  add("wrist_1", "forearm", {0, 0.09, 0.37}, Y, 0.2,
      {{"cylinder", {0.043, 0.11, 0}, zero, along_y}});
  add("wrist_2", "wrist_1", {0, 0, 0.03}, Z, 0.2, {{"cylinder", {0.038, 0.10, 0}, {0, 0, 0.06}}});
  add("hand", "wrist_2", {0, 0, 0.10}, Y, 0.3,
      {{"sphere", {0.045, 0, 0}, {0, 0, 0.02}},
       {"box", {0.05, 0.13, 0.06}, {0, 0, 0.09}},
       {"box", {0.025, 0.015, 0.08}, {0, 0.045, 0.16}},
       {"box", {0.025, 0.015, 0.08}, {0, -0.045, 0.16}}});
}

}  // namespace

std::string LidarRobot::urdf() const {
  std::string out = "<robot name=\"robot\">\n";
  for (const LidarLink& link : links) {
    out += "<link name=\"" + link.name + "\">\n";
    for (const LidarShape& shape : link.shapes) out += urdf_of(shape);
    out += "</link>\n";
    if (link.parent.empty()) continue;
    out += "<joint name=\"" + link.name + "_joint\" type=\"" +
           (link.axis.isZero() ? "fixed" : "continuous") + "\"><parent link=\"" + link.parent +
           "\"/><child link=\"" + link.name + "\"/><origin xyz=\"" + text(link.at) + "\"/>";
    if (!link.axis.isZero()) out += "<axis xyz=\"" + text(link.axis) + "\"/>";
    out += "</joint>\n";
  }
  return out + "</robot>\n";
}

std::string LidarRobot::mjcf(std::span<const LidarShape> around) const {
  std::string out = "<mujoco><compiler angle=\"radian\" eulerseq=\"XYZ\"/><worldbody>\n";
  for (const LidarShape& shape : around) out += geom_of(shape, 0);
  for (const LidarShape& shape : furniture) out += geom_of(shape, 0);
  return out + body_of(*this, links.front()) + "</worldbody></mujoco>\n";
}

LidarRobot lidar_arms(std::size_t count) {
  LidarRobot robot{count == 1 ? "arm" : "two arms",
                   {{"cell", "", zero, zero}},
                   {{"box", {1.0, 2.0, 0.05}, {0.0, 0.0, 0.725}}}};
  for (std::size_t i = 0; i < count; ++i)
    add_arm(robot, std::to_string(i + 1) + "_", 0.9 * (double(i) - 0.5 * double(count - 1)));
  return robot;
}

LidarRobot lidar_quadruped() {
  LidarRobot robot{"quadruped", {{"trunk", "", {0, 0, 0.40}, zero}}};
  robot.links[0].shapes = {{"box", {0.60, 0.24, 0.14}},
                           {"cylinder", {0.018, 0.075, 0}, {0, 0, 0.1075}}};  // the lidar's mast
  const auto add = adder(robot);
  for (const double x : {1.0, -1.0})
    for (const double y : {1.0, -1.0}) {
      const std::string leg = std::string(x > 0 ? "front" : "rear") + (y > 0 ? "_left" : "_right");
      add(leg + "_hip", "trunk", {0.24 * x, 0.13 * y, 0.02}, X, 0.7 * y,
          {{"cylinder", {0.045, 0.09, 0}, {0, 0.02 * y, 0}, along_x}});
      add(leg + "_thigh", leg + "_hip", {0, 0.09 * y, 0}, Y, 0.8 * x,
          {{"cylinder", {0.05, 0.05, 0}, zero, along_y},
           {"capsule", {0.033, 0.24, 0}, {0, 0, -0.12}}});
      add(leg + "_shank", leg + "_thigh", {0, 0, -0.25}, Y, -1.5 * x,
          {{"cylinder", {0.019, 0.22, 0}, {0, 0, -0.12}}, {"sphere", {0.03, 0, 0}, {0, 0, -0.24}}});
    }
  add("neck", "trunk", {0.34, 0, 0.06}, Z, 0.0, {{"cylinder", {0.035, 0.09, 0}, {0, 0, 0.045}}});
  add("head", "neck", {0, 0, 0.09}, Y, 0.0, {{"box", {0.17, 0.12, 0.09}, {0.05, 0, 0.03}}});
  return robot;
}

namespace {

Vector3d direction(double azimuth, double elevation) {
  return {std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
          std::sin(elevation)};
}

}  // namespace

std::vector<LidarRay> spinning_lidar(int beams, int columns, double half_height) {
  std::vector<LidarRay> rays;
  for (int column = 0; column < columns; ++column)
    for (int i = 0; i < beams; ++i) {
      const double turned = (column + 0.5) / columns;
      rays.push_back({direction(2.0 * pi * turned, half_height * (2.0 * i / (beams - 1) - 1.0)),
                      turn * turned});
    }
  return rays;
}

std::vector<LidarRay> rosette_lidar(std::size_t scan) {
  constexpr int count = 20'000;
  // Turns about z, and swings up and down, in a scan; not a multiple of each other.
  constexpr double turns = 4.0, swings = 123.0 * std::numbers::phi;
  std::vector<LidarRay> rays;
  for (int i = 0; i < count; ++i) {
    const double part = (i + 0.5) / count, total = double(scan) + part;
    const double height = 0.5 + 0.5 * std::sin(2.0 * pi * swings * total);
    rays.push_back(
        {direction(2.0 * pi * turns * std::numbers::sqrt2 * total, degree * (-7.0 + 59.0 * height)),
         turn * part});
  }
  return rays;
}

std::vector<LidarRay> plane_scanner() {
  constexpr int count = 1081;
  std::vector<LidarRay> rays;
  rays.reserve(count);
  for (int i = 0; i < count; ++i)
    rays.push_back({direction(degree * (0.25 * i - 135.0), 0.0), 0.025 * i / (count - 1)});
  return rays;
}

JointMotion lidar_motion(const LidarRobot& robot, const Robot& loaded, Wave wave,
                         std::uint64_t seed) {
  sim::Random random(seed, 2);
  std::vector<double> centre(loaded.variables().size()), phase(centre.size());
  for (const LidarLink& link : robot.links)
    if (const auto i = loaded.find_variable(link.name + "_joint")) centre[*i] = link.centre;
  for (double& angle : phase) angle = random.uniform(0.0, 2.0 * pi);
  return [=](double t) {
    std::vector<double> q = centre;
    for (std::size_t i = 0; i < q.size(); ++i)
      q[i] += wave == Wave::sine
                  ? amplitude * std::sin(joint_speed / amplitude * t + phase[i])
                  : amplitude * 2.0 / pi *
                        std::asin(std::sin(0.5 * pi * joint_speed / amplitude * t + phase[i]));
    return q;
  };
}

LidarWorld::LidarWorld(const LidarRobot& robot, LidarMount mount, std::uint64_t seed)
    : mount_(std::move(mount)), robot_(Robot::parse(robot.urdf(), ".")), random_(seed, 1) {
  std::vector<LidarShape> around = objects(random_);
  for (const LidarShape& shape : room()) around.push_back(shape);
  model_ = load(robot.mjcf(around));
  data_.reset(mj_makeData(model_.get()));
  for (const std::string& name : robot_.variables())
    qpos_.push_back(model_->jnt_qposadr[mj_name2id(model_.get(), mjOBJ_JOINT, name.c_str())]);
  for (int geom = 0; geom < model_->ngeom; ++geom) {
    const auto* const body = mj_id2name(model_.get(), mjOBJ_BODY, model_->geom_bodyid[geom]);
    link_of_.push_back(model_->geom_group[geom] == 0
                           ? std::uint16_t{0}
                           : std::uint16_t(robot_.find_link(body).value() + 1));
  }
  body_ = mj_name2id(model_.get(), mjOBJ_BODY, mount_.parent.c_str());
}

void LidarWorld::pose(const std::vector<double>& positions) {
  for (std::size_t i = 0; i < positions.size(); ++i) data_->qpos[qpos_[i]] = positions[i];
  mj_kinematics(model_.get(), data_.get());
  T_world_sensor_ = sim::body_pose(*data_, body_) * mount_.T_parent_sensor;
}

LidarWorld::Hit LidarWorld::cast(const Vector3d& ray, bool robot_only) const {
  const std::array<mjtByte, mjNGROUP> groups{static_cast<mjtByte>(robot_only ? 0 : 1), 1};
  const Vector3d origin = T_world_sensor_.translation(), along = T_world_sensor_.linear() * ray;
  int geom = -1;
  const double range =
      mj_ray(model_.get(), data_.get(), origin.data(), along.data(), groups.data(), 1, -1, &geom);
  return {range, geom};
}

bool LidarWorld::may_meet_robot(const Vector3d& ray) const {
  const Vector3d origin = T_world_sensor_.translation(), along = T_world_sensor_.linear() * ray;
  for (int geom = 0; geom < model_->ngeom; ++geom) {
    if (!is_robot(geom)) continue;
    const Vector3d to = Eigen::Map<const Vector3d>(data_->geom_xpos + 3 * geom) - origin;
    const double far = to.norm(), radius = model_->geom_rbound[geom] + 2.0 * reach * far;
    if (far < radius || (to.dot(along) > 0.0 && to.cross(along).norm() < radius)) return true;
  }
  return false;
}

double LidarWorld::distance(const Vector3d& point) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (int geom = 0; geom < model_->ngeom; ++geom) {
    if (!is_robot(geom)) continue;
    using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    const Vector3d size = Eigen::Map<const Vector3d>(model_->geom_size + 3 * geom);
    const Vector3d p = Eigen::Map<const Matrix>(data_->geom_xmat + 9 * geom).transpose() *
                       (point - Eigen::Map<const Vector3d>(data_->geom_xpos + 3 * geom));
    const double radial = p.head<2>().norm(), height = std::abs(p.z());
    double d = 0.0;
    switch (model_->geom_type[geom]) {
      case mjGEOM_BOX:
        d = (p.cwiseAbs() - size).cwiseMax(0.0).norm();
        break;
      case mjGEOM_CYLINDER:
        d = std::hypot(std::max(radial - size.x(), 0.0), std::max(height - size.y(), 0.0));
        break;
      case mjGEOM_CAPSULE:
        d = std::hypot(radial, std::max(height - size.y(), 0.0)) - size.x();
        break;
      default:
        d = p.norm() - size.x();
    }
    nearest = std::min(nearest, d);
  }
  return nearest;
}

void LidarWorld::place_objects(const JointMotion& motion, double begin, double end) {
  std::vector<int> robot_geoms;
  for (int geom = 0; geom < model_->ngeom; ++geom)
    if (is_robot(geom)) robot_geoms.push_back(geom);
  const auto gap_at = [&](double time, const Vector3d& place, double radius) {
    pose(motion(time));
    return distance(place) - radius;
  };
  for (int object = 0; object < int(object_count); ++object) {
    const double radius = model_->geom_rbound[object];
    for (int attempt = 0; attempt < 1000; ++attempt) {
      pose(motion(0.5 * (begin + end)));
      const Vector3d eye = T_world_sensor_.translation();
      const auto pick = std::size_t(random_.uniform(0.0, double(robot_geoms.size())));
      const Vector3d target =
          Eigen::Map<const Vector3d>(data_->geom_xpos + at(3 * robot_geoms[pick]));
      const Vector3d place = target + random_.uniform(-0.7, 0.7) * (target - eye).normalized() +
                             0.12 * Vector3d(random_.normal(), random_.normal(), random_.normal());
      const double gap = gap_at(0.5 * (begin + end), place, radius);
      if ((place - eye).norm() < radius + 0.15 || gap < 0.05 || gap > 0.50 ||
          gap_at(begin, place, radius) < 0.02 || gap_at(end, place, radius) < 0.02)
        continue;
      Eigen::Map<Vector3d>(model_->geom_pos + at(3 * object)) = place;
      break;
    }
  }
}

LidarPoint LidarWorld::meet(const Vector3d& ray, double& range) {
  const Hit hit = cast(ray, false);
  if (hit.geom < 0) throw std::logic_error("a ray leaves the room");
  range = hit.range;
  LidarPoint point{.truth = is_robot(hit.geom) ? LidarTruth::robot : LidarTruth::room,
                   .link = link_of_[at(hit.geom)]};
  if (point.truth == LidarTruth::room) {
    const Vector3d end = T_world_sensor_ * (range * ray);
    point.is_close = distance(end) <= close;
  }
  if (!may_meet_robot(ray)) return point;
  const Vector3d u = ray.unitOrthogonal(), v = ray.cross(u);
  const auto ring = [&](double radius, int count, const auto& f) {
    for (int i = 0; i < count; ++i) {
      const double angle = 2.0 * pi * i / count;
      f((ray + radius * (std::cos(angle) * u + std::sin(angle) * v)).normalized());
    }
  };
  if (point.truth == LidarTruth::room) {
    point.is_before = is_robot(cast(ray, true).geom);
    for (const double radius : {0.5 * reach, reach})
      ring(radius, 16, [&](const Vector3d& r) { point.is_next_to |= cast(r, true).geom >= 0; });
  }
  const double weight = random_.uniform();
  ring(beam, 8, [&](const Vector3d& r) {
    const Hit other = cast(r, false);
    if (point.truth >= LidarTruth::veil || is_robot(other.geom) == is_robot(hit.geom) ||
        std::abs(other.range - hit.range) < veil)
      return;
    range += weight * (other.range - hit.range);
    const double behind = range - (is_robot(hit.geom) ? hit : other).range;
    point = {.truth = behind >= 0.0 && behind <= CloudRule().mixing ? LidarTruth::veil
                                                                    : LidarTruth::other_veil};
  });
  return point;
}

LidarScan LidarWorld::scan(std::span<const LidarRay> rays, const JointMotion& motion, double begin,
                           double noise) {
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  LidarScan out{.stamp = std::llround(1e9 * begin)};
  out.middle = out.stamp + std::llround(0.5e9 * (rays.front().time + rays.back().time));
  double posed_at = -1.0;
  for (const LidarRay& ray : rays) {
    out.times.push_back(std::int32_t(std::llround(1e9 * ray.time)));
    if (ray.time != posed_at) pose(motion(1e-9 * double(out.stamp) + ray.time));
    posed_at = ray.time;
    if (random_.uniform() < dropped) {
      out.points.push_back({none, none, none});
      out.truth.emplace_back();
      continue;
    }
    double range = 0.0;
    out.truth.push_back(meet(ray.direction, range));
    const Eigen::Vector3f p =
        (std::max(range + noise * random_.normal(), 0.021) * ray.direction).cast<float>();
    out.points.push_back({p.x(), p.y(), p.z()});
  }
  return out;
}

void LidarScore::add(const LidarScan& scan, const FrameReport& report) {
  for (std::size_t i = 0; i < scan.truth.size(); ++i) {
    const LidarPoint& point = scan.truth[i];
    const auto label = static_cast<Label>(report.labels.data[i]);
    const bool stays = is_trusted(label);
    const bool is_robot = label == Label::occluded || label == Label::beyond;
    false_measurements += (label == Label::unknown) != (point.truth == LidarTruth::dropped);
    switch (point.truth) {
      case LidarTruth::dropped:
        break;
      case LidarTruth::robot:
        ++robot;
        left += stays;
        wrong_links += is_robot && report.virtual_depth.links.data[i] != point.link;
        break;
      case LidarTruth::veil:
        ++veil;
        veil_left += stays;
        break;
      case LidarTruth::other_veil:
        ++other_veil;
        other_veil_left += stays;
        break;
      case LidarTruth::room:
        ++room;
        if (stays) break;
        ++(label == Label::fringe && point.is_next_to ? fringe
           : point.is_before                          ? before
           : point.is_close                           ? near
                                                      : removed);
    }
  }
}

Frame frame_of(const LidarScan& scan, const JointMotion& motion) {
  return {.stamp = scan.stamp,
          .scan = Scan{.points = {reinterpret_cast<const std::byte*>(scan.points.data()),
                                  scan.points.size()},
                       .times = scan.times},
          .pose_at = [&motion](std::int64_t stamp, RobotPose& pose) {
            pose.positions = motion(1e-9 * double(stamp));
          }};
}

const FrameReport& process(Pipeline& pipeline, const LidarScan& scan, const JointMotion& motion,
                           bool with_times) {
  Frame frame = frame_of(scan, motion);
  if (!with_times) {
    frame.stamp = scan.middle;
    frame.scan->times = {};
  }
  return pipeline.process(frame);
}

}  // namespace penumbra::test
