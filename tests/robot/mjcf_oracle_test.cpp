// SPDX-License-Identifier: Apache-2.0
// MuJoCo as the oracle of the reader of MJCF: link poses and the places of shapes.
#include "../../sim/mujoco_handles.hpp"
#include "plain_robot.hpp"
#include "urdf_text.hpp"

#include <mujoco/mujoco.h>

#include <penumbra/mesh/primitives.hpp>

namespace penumbra::test {
namespace {

// MuJoCo rounds its quaternions anew at each body.
constexpr double kBodyTolerance = 1e-9;
// Float vertices of up to 3 m, after primitive_error.
constexpr double kShapeTolerance = primitive_error + 2e-6;

struct Loaded {
  sim::ModelPtr model;
  sim::DataPtr data;
};

Loaded load_mujoco(const std::filesystem::path& file) {
  const std::lock_guard lock(sim::mujoco_mutex());
  std::array<char, 1000> why{};
  Loaded out;
  out.model.reset(mj_loadXML(file.c_str(), nullptr, why.data(), why.size()));
  if (!out.model) throw std::runtime_error(why.data());
  out.data.reset(mj_makeData(out.model.get()));
  return out;
}

std::string name_of(const mjModel& model, mjtObj kind, int id) {
  const char* name = mj_id2name(&model, kind, id);
  return name == nullptr ? "" : name;
}

/// Writes a random model. Every orientation, joint kind, default class and anchor occurs.
class RandomMjcf {
 public:
  explicit RandomMjcf(Random& random) : random_(random) {
    degrees_ = below(random, 2) == 0;
    const std::string letters = "xyzXYZ";
    for (int i = 0; i < 3; ++i) eulerseq_ += letters[below(random, 6)];
  }

  std::string text() {
    std::string bodies;
    for (int i = 0; i < 3; ++i) bodies += body(0);
    return "<mujoco model=\"random\">\n<compiler autolimits=\"true\" angle=\"" +
           std::string(degrees_ ? "degree" : "radian") + "\" eulerseq=\"" + eulerseq_ +
           "\" meshdir=\"meshes\"/>\n<option><flag constraint=\"disable\"/></option>\n" +
           "<option><flag constraint=\"disable\"/></option>" + defaults() + assets() +
           "<worldbody><geom type=\"plane\" size=\"1 1 1\"/>\n" + bodies + "</worldbody>\n" +
           "<equality>\n" + couplings_ + "</equality></mujoco>\n";
  }

  /// Position of each follower, by those of the other joints.
  struct Coupling {
    std::string follower, leader;
    double a0, a1;
  };
  [[nodiscard]] const std::vector<Coupling>& couplings() const { return all_; }

 private:
  bool chance(std::size_t one_of) { return below(random_, one_of) == 0; }
  std::string angle(double radians) {
    return exact(degrees_ ? radians * 180.0 / std::numbers::pi : radians);
  }

  std::string orientation(bool only_quat = false) {
    const Vector3d a = random_direction(random_), b = random_direction(random_);
    switch (only_quat ? 1 : below(random_, 6)) {
      case 1:
        return " quat=\"" + exact(uniform(random_, -2, 2)) + " " + exact(a) + "\"";
      case 2:
        return " axisangle=\"" + exact(2.0 * a) + " " + angle(uniform(random_, -4, 4)) + "\"";
      case 3:
        return " xyaxes=\"" + exact(3.0 * a) + " " + exact(b) + "\"";
      case 4:
        return " zaxis=\"" + exact(chance(3) ? Vector3d(0, 0, -2) : a) + "\"";
      case 5:
        return " euler=\"" + angle(uniform(random_, -4, 4)) + " " + angle(uniform(random_, -4, 4)) +
               " " + angle(uniform(random_, -4, 4)) + "\"";
      default:
        return "";
    }
  }

  std::string defaults() {
    return "<default>\n<geom size=\"0.11 0.12 0.13\" quat=\"0.3 0.1 0.5 0.2\"/>\n"
           "<joint armature=\"1\" axis=\"" +
           exact(random_direction(random_)) +
           "\"/><mesh scale=\"0.5 0.7 -0.9\"/>\n"
           "<default class=\"box\"><geom type=\"box\" size=\"0.2\"/>"
           "<joint pos=\"0.1 0.2 0.3\"/>\n"
           "<default class=\"slide\"><geom type=\"ellipsoid\"/><joint type=\"slide\" ref=\"0.3\"/>"
           "</default></default>\n"
           "<default class=\"capsule\"><geom type=\"capsule\" euler=\"1 2 "
           "3\"/></default></default>\n";
  }

  static std::string assets() {
    return "<asset><mesh file=\"part.obj\"/>\n"
           "<mesh name=\"other\" file=\"sub/part2.stl\" scale=\"1 2 0.5\" "
           "refpos=\"0.1 -0.2 0.3\" refquat=\"1 0.5 -0.3 0.2\"/></asset>\n";
  }

  std::string class_of() {
    const char* names[] = {"box", "slide", "capsule", "main"};
    return chance(2) ? "" : std::string(" class=\"") + names[below(random_, 4)] + "\"";
  }

  std::string joint(const std::string& type) {
    const std::string name = "j" + std::to_string(joints_++);
    std::string out = "<joint name=\"" + name + "\"" + class_of();
    if (type != "") out += " type=\"" + type + "\"";
    if (!chance(3)) out += " pos=\"" + exact(random_triple(random_, 0.5)) + "\"";
    if (!chance(3)) out += " axis=\"" + exact(2.0 * random_direction(random_)) + "\"";
    if (type == "hinge" && chance(2)) out += " ref=\"" + angle(uniform(random_, -1, 1)) + "\"";
    if (type == "hinge" && chance(2))
      out += " range=\"" + angle(-1.25) + " " + angle(uniform(random_, 0, 3)) + "\"";
    if (type == "hinge" || type == "slide") {
      if (!scalars_.empty() && chance(4)) {
        const Coupling c{name, scalars_[below(random_, scalars_.size())], uniform(random_, -1, 1),
                         uniform(random_, -2, 2)};
        couplings_ += "<joint joint1=\"" + c.follower + "\" joint2=\"" + c.leader +
                      "\" polycoef=\"" + exact(c.a0) + " " + exact(c.a1) + " 0 0 0\"/>\n";
        all_.push_back(c);
      }
      scalars_.push_back(name);
    }
    return out + "/>";
  }

  std::string geom() {
    const char* types[] = {"sphere", "capsule", "cylinder", "ellipsoid", "box"};
    const std::string its_class = class_of();
    // A quat is overridden by the class's euler; of two others, it depends on MuJoCo's version.
    const bool only_quat = its_class.find("capsule") != std::string::npos;
    const std::string pose =
        " pos=\"" + exact(random_triple(random_, 0.5)) + "\"" + orientation(only_quat) + "/>";
    std::string out = "<geom" + its_class;
    if (chance(4))
      return out + " type=\"mesh\" mesh=\"" + (chance(2) ? "part" : "other") + "\"" + pose;
    const std::size_t type = below(random_, 5);
    out += std::string(" type=\"") + types[type] + "\"";
    if (chance(2)) out += " size=\"" + exact(uniform(random_, 0.05, 0.4)) + "\"";
    if (type == 0 || !chance(3)) return out + pose;
    return out + " fromto=\"" + exact(random_triple(random_, 0.5)) + " " +
           exact(random_triple(random_, 0.5)) + "\"/>";
  }

  std::string body(int depth) {
    std::string out = "<body name=\"b" + std::to_string(bodies_++) + "\" pos=\"" +
                      exact(random_triple(random_, 0.5)) + "\"" + orientation();
    if (chance(3)) out += " childclass=\"box\"";
    out += ">\n<inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 1\"/>";
    if (depth == 0 && chance(3))
      out += chance(2) ? joint("free") : "<freejoint name=\"j" + std::to_string(joints_++) + "\"/>";
    else if (chance(4))
      out += joint("slide") + joint("ball");
    else
      for (std::size_t n = below(random_, 4); n > 0; --n)
        out += joint(chance(2) ? "hinge" : "slide");
    for (std::size_t n = 1 + below(random_, 2); n > 0; --n) out += geom() + "\n";
    if (depth < 4)
      for (std::size_t n = below(random_, 3); n > 0; --n) out += body(depth + 1);
    return out + "</body>\n";
  }

  Random& random_;
  bool degrees_;
  std::string eulerseq_, couplings_;
  std::size_t bodies_ = 0, joints_ = 0;
  std::vector<std::string> scalars_;
  std::vector<Coupling> all_;
};

/// Random qpos of all joints, and the same as the robot's positions.
std::vector<double> set_positions(Random& random, const RandomMjcf& source, const Robot& robot,
                                  Loaded& mujoco) {
  const mjModel& model = *mujoco.model;
  const auto qpos = [&](int joint) { return mujoco.data->qpos + model.jnt_qposadr[joint]; };
  for (int j = 0; j < model.njnt; ++j) {
    const int type = model.jnt_type[j];
    const int count = type == mjJNT_FREE ? 7 : type == mjJNT_BALL ? 4 : 1;
    for (int i = 0; i < count; ++i) qpos(j)[i] = uniform(random, -3.0, 3.0);
    if (count > 1) mju_normalize4(qpos(j) + count - 4);
  }
  for (const auto& [follower, leader, a0, a1] : source.couplings()) {
    const int y = mj_name2id(&model, mjOBJ_JOINT, follower.c_str());
    const int x = mj_name2id(&model, mjOBJ_JOINT, leader.c_str());
    const auto ref = [&](int joint) { return model.qpos0[model.jnt_qposadr[joint]]; };
    *qpos(y) = ref(y) + a0 + a1 * (*qpos(x) - ref(x));
  }
  std::vector<double> positions(robot.variables().size(), nan);
  const auto set = [&](const std::string& name, double value) {
    if (const auto at = robot.find_variable(name)) positions[*at] = value;
  };
  for (int j = 0; j < model.njnt; ++j) {
    const std::string name = name_of(model, mjOBJ_JOINT, j);
    const int type = model.jnt_type[j];
    const bool is_free = type == mjJNT_FREE;
    if (!is_free && type != mjJNT_BALL) set(name, *qpos(j));
    for (int i = 0; i < 3; ++i) set(name + "/" + "xyz"[i], is_free ? qpos(j)[i] : 0.0);
    const char* wxyz[] = {"/qw", "/qx", "/qy", "/qz"};
    for (int i = 0; i < 4; ++i) set(name + wxyz[i], qpos(j)[(is_free ? 3 : 0) + i]);
  }
  return positions;
}

void expect_body_poses(Random& random, const RandomMjcf& source, const Robot& robot,
                       Loaded& mujoco) {
  const auto positions = set_positions(random, source, robot, mujoco);
  mj_kinematics(mujoco.model.get(), mujoco.data.get());
  std::vector<Isometry3d> poses(robot.links().size());
  robot.forward_kinematics(positions, poses);
  for (int b = 0; b < mujoco.model->nbody; ++b) {
    const std::string name = name_of(*mujoco.model, mjOBJ_BODY, b);
    const auto link = robot.find_link(name);
    ASSERT_TRUE(link) << name;
    const Isometry3d theirs = sim::body_pose(*mujoco.data, b);
    ASSERT_LT((poses[*link].matrix() - theirs.matrix()).cwiseAbs().maxCoeff(), kBodyTolerance)
        << name;
  }
}

/// How far a MuJoCo geom reaches along a direction in its body's frame.
double support(const mjModel& model, int geom, const Vector3d& along) {
  const double* q = model.geom_quat + 4 * geom;
  const Vector3d d = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).conjugate() * along;
  const Vector3d size(model.geom_size + 3 * geom);
  const double centre = Eigen::Map<const Vector3d>(model.geom_pos + 3 * geom).dot(along);
  switch (model.geom_type[geom]) {
    case mjGEOM_SPHERE:
      return centre + size[0];
    case mjGEOM_CAPSULE:
      return centre + size[0] + size[1] * std::abs(d.z());
    case mjGEOM_CYLINDER:
      return centre + size[0] * d.head<2>().norm() + size[1] * std::abs(d.z());
    case mjGEOM_ELLIPSOID:
      return centre + size.cwiseProduct(d).norm();
    case mjGEOM_BOX:
      return centre + size.dot(d.cwiseAbs());
    default:
      break;
  }
  const int mesh = model.geom_dataid[geom];
  double farthest = -inf;
  for (int i = 0; i < model.mesh_vertnum[mesh]; ++i) {
    const float* v = model.mesh_vert + 3 * (model.mesh_vertadr[mesh] + i);
    farthest = std::max(farthest, d.dot(Vector3d(v[0], v[1], v[2])));
  }
  return centre + farthest;
}

void expect_shapes(Random& random, const Robot& robot, const mjModel& model) {
  std::map<int, std::size_t> seen;  // geoms of each body
  for (int g = 0; g < model.ngeom; ++g) {
    const int body = model.geom_bodyid[g];
    if (body == 0) continue;
    const auto meshes = robot.meshes(*robot.find_link(name_of(model, mjOBJ_BODY, body)));
    ASSERT_LT(seen[body], meshes.size());
    const PreparedMesh& mesh = meshes[seen[body]++];
    for (int i = 0; i < 20; ++i) {
      const Vector3d along = random_direction(random);
      double farthest = -inf;
      for (const auto& v : mesh.vertices)
        farthest = std::max(farthest, along.dot(v.cast<double>()));
      ASSERT_NEAR(farthest, support(model, g, along), kShapeTolerance)
          << "geom " << g << " type " << model.geom_type[g];
    }
  }
}

void expect_limits(const Robot& robot, const mjModel& model) {
  for (const Joint& joint : robot.joints()) {
    const int id = mj_name2id(&model, mjOBJ_JOINT, joint.name.c_str());
    if (id < 0 || model.jnt_type[id] == mjJNT_BALL || model.jnt_type[id] == mjJNT_FREE) continue;
    ASSERT_EQ(joint.lower.has_value(), model.jnt_limited[id] != 0) << joint.name;
    if (!joint.lower) continue;
    EXPECT_NEAR(*joint.lower, model.jnt_range[2 * id], 1e-12);
    EXPECT_NEAR(*joint.upper, model.jnt_range[2 * id + 1], 1e-12);
  }
}

void write_meshes(const TemporaryFolder& folder) {
  folder.write("meshes/part.obj",
               "v 0 0 0\nv 0.7 0.1 0\nv 0 0.5 0.1\nv 0.1 0 0.6\nv 0.4 0.4 0.4\n"
               "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 5\nf 3 4 5\nf 4 2 5\n");
  const std::array<Vector3f, 4> corners = {Vector3f(0, 0, 0), Vector3f(0.6F, 0, 0.1F),
                                           Vector3f(0, 0.4F, 0), Vector3f(0.1F, 0.1F, 0.5F)};
  std::string stl(80, ' ');
  const auto append = [&](const auto& value) {
    stl.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  append(std::uint32_t{4});
  for (const auto& [a, b, c] : {std::array{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) {
    append(std::array<float, 3>{});
    for (const int corner : {a, b, c})
      for (int i = 0; i < 3; ++i) append(corners[static_cast<std::size_t>(corner)][i]);
    append(std::uint16_t{0});
  }
  folder.write("meshes/sub/part2.stl", stl);
}

TEST(MjcfOracle, PosesShapesAndLimitsAreMuJoCos) {
  Random random = seeded_random(64);
  const TemporaryFolder folder;
  write_meshes(folder);
  int joints = 0, couplings = 0;
  for (int run = 0; run < samples(40); ++run) {
    RandomMjcf source(random);
    const std::string text = source.text();
    const auto file = folder.write("robot.xml", text);
    SCOPED_TRACE(text);
    Loaded mujoco = load_mujoco(file);
    const Robot robot = Robot::load(file);
    joints += mujoco.model->njnt;
    couplings += static_cast<int>(source.couplings().size());
    for (int i = 0; i < 100 && !testing::Test::HasFailure(); ++i)
      expect_body_poses(random, source, robot, mujoco);
    expect_shapes(random, robot, *mujoco.model);
    expect_limits(robot, *mujoco.model);
    if (testing::Test::HasFailure()) break;
  }
  EXPECT_GT(joints, samples(100));
  EXPECT_GT(couplings, 10);
}

}  // namespace
}  // namespace penumbra::test
