// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <mutex>
#include <numbers>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file-inl.hpp>
#include <penumbra/mesh/mesh_file.hpp>
#include <penumbra/robot/file_locator.hpp>

#include <io/files/stl_file.hpp>
#include <sim/arm.hpp>
#include <sim/mujoco_handles.hpp>

namespace penumbra::sim {
namespace {

namespace fs = std::filesystem;

// All links stay separate bodies, so that each pixel has a link. A URDF for display has no masses;
// nothing falls here, so any mass will do.
constexpr const char* compiler =
    "<mujoco><compiler fusestatic=\"false\" discardvisual=\"false\" strippath=\"false\" "
    "balanceinertia=\"true\" boundmass=\"0.001\" boundinertia=\"0.000001\"/></mujoco>";

std::string lower_ending(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

/// Copies a mesh to where MuJoCo finds it and returns its name. MuJoCo identifies meshes by name
/// only, so each element gets a file of its own: one mesh may be used at several scales.
std::string place_mesh(const fs::path& from, const fs::path& folder, int number) {
  const std::string ending = lower_ending(from);
  const bool readable = ending == ".stl" || ending == ".obj";
  std::string name = "mesh_" + std::to_string(number) + (readable ? ending : ".stl");
  if (readable) {
    std::error_code error;
    fs::copy_file(from, folder / name, fs::copy_options::overwrite_existing, error);
    if (error) throw InputError(from.string() + ": cannot be read (" + error.message() + ")");
  } else {
    io::write_stl(folder / name, load_mesh(from));
  }
  return name;
}

/// Returns the URDF with meshes that MuJoCo can read and with its compiler's options.
std::string prepared(const fs::path& urdf, const RobotOptions& options, const fs::path& folder) {
  const std::string text = read_whole_file(urdf, FileLimit::text);
  static const std::regex pattern(R"re(<robot\b[^>]*>|filename\s*=\s*"([^"]*)")re");
  std::string out;
  detail::FileLocator files(urdf.parent_path(), options.packages);
  auto from = text.cbegin();
  int number = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it) {
    out.append(from, (*it)[0].first);
    from = (*it)[0].second;
    if ((*it)[1].matched)
      out += "filename=\"" + place_mesh(files.locate((*it)[1]), folder, number++) + '"';
    else
      out += it->str() + compiler;
  }
  return out.append(from, text.cend());
}

/// Returns a geom's extent in its own frame, in which MuJoCo keeps the vertices of meshes.
Eigen::AlignedBox3d extent_of(const mjModel& model, int geom) {
  const Eigen::Map<const Eigen::Vector3d> size(model.geom_size + 3 * geom);
  Eigen::Vector3d half = size;
  switch (model.geom_type[geom]) {
    case mjGEOM_BOX:
      break;
    case mjGEOM_SPHERE:
      half = Eigen::Vector3d::Constant(size.x());
      break;
    case mjGEOM_CYLINDER:
      half = {size.x(), size.x(), size.y()};
      break;
    case mjGEOM_MESH: {
      const int mesh = model.geom_dataid[geom], first = model.mesh_vertadr[mesh];
      Eigen::AlignedBox3d box;
      for (int i = first; i < first + model.mesh_vertnum[mesh]; ++i)
        box.extend(Eigen::Map<const Eigen::Vector3f>(model.mesh_vert + 3 * i).cast<double>());
      return box;
    }
    default:
      throw std::logic_error("a URDF has no such shape");
  }
  return {-half, half};
}

void write_text(const fs::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  if (!stream.flush()) throw InputError(file.string() + ": cannot be written");
}

}  // namespace

struct Arm::Model {
  ModelPtr model;
  DataPtr data;

  [[nodiscard]] int find(mjtObj kind, const std::string& name) const {
    const int id = mj_name2id(model.get(), kind, name.c_str());
    if (id < 0) throw std::logic_error("MuJoCo has no '" + name + "'");
    return id;
  }
};

Arm::Arm(const fs::path& urdf, const RobotOptions& options, const fs::path& folder)
    : robot_(Robot::load(urdf, options)), model_(std::make_unique<Model>()) {
  const fs::path file = folder / "arm.urdf";
  write_text(file, prepared(urdf, options, folder));
  std::array<char, 1000> why{};
  const std::lock_guard lock(mujoco_mutex());
  model_->model.reset(mj_loadXML(file.c_str(), nullptr, why.data(), why.size()));
  const mjModel* const model = model_->model.get();
  if (model == nullptr) throw InputError(urdf.string() + ": MuJoCo cannot read it: " + why.data());
  if (mj_saveLastXML((folder / mjcf_file).c_str(), model, why.data(), why.size()) == 0)
    throw InputError((folder / mjcf_file).string() + ": cannot be written: " + why.data());
  model_->data.reset(mj_makeData(model));
}

Arm::~Arm() = default;

std::vector<Arm::Position> Arm::joint_positions(std::span<const double> positions) const {
  std::vector<Position> all;
  for (const Joint& joint : robot_.joints()) {
    if (!joint.variable) continue;
    all.push_back({joint.name, joint.multiplier * positions[*joint.variable] + joint.offset});
  }
  return all;
}

void Arm::set(std::span<const double> positions) {
  for (const auto& [joint, value] : joint_positions(positions)) {
    const int id = model_->find(mjOBJ_JOINT, joint);
    model_->data->qpos[model_->model->jnt_qposadr[id]] = value;
  }
  mj_kinematics(model_->model.get(), model_->data.get());
  mj_comPos(model_->model.get(), model_->data.get());
}

std::vector<Eigen::Vector3d> Arm::part_centres(std::span<const double> positions) {
  set(positions);
  std::vector<Eigen::Vector3d> centres;
  for (int geom = 0; geom < model_->model->ngeom; ++geom)
    if (model_->model->geom_bodyid[geom] != 0)
      centres.emplace_back(Eigen::Map<const Eigen::Vector3d>(model_->data->geom_xpos + 3 * geom));
  return centres;
}

double Arm::PartBox::distance(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d p = T_root_box.inverse() * point;
  return (p.cwiseAbs() - half).cwiseMax(0.0).norm();
}

std::vector<Arm::PartBox> Arm::part_boxes(std::span<const double> positions) {
  set(positions);
  using RowMatrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  std::vector<PartBox> boxes;
  for (int geom = 0; geom < model_->model->ngeom; ++geom) {
    const Eigen::AlignedBox3d extent = extent_of(*model_->model, geom);
    PartBox& box = boxes.emplace_back();
    box.T_root_box.linear() = Eigen::Map<const RowMatrix>(model_->data->geom_xmat + 9 * geom);
    box.T_root_box.translation() =
        Eigen::Map<const Eigen::Vector3d>(model_->data->geom_xpos + 3 * geom) +
        box.T_root_box.linear() * extent.center();
    box.half = 0.5 * extent.sizes();
  }
  return boxes;
}

Eigen::Isometry3d Arm::link_pose(std::span<const double> positions, const std::string& link) {
  set(positions);
  return body_pose(*model_->data, model_->find(mjOBJ_BODY, link));
}

std::vector<double> Arm::reach(const Eigen::Isometry3d& T_root_link, const std::string& link,
                               std::vector<double> start) {
  constexpr int steps = 200;
  constexpr double damping = 0.02, longest_step = 0.2;  // radians
  using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const mjModel* const model = model_->model.get();
  const int body = model_->find(mjOBJ_BODY, link);
  RowMatrix move(3, model->nv), turn(3, model->nv);
  for (int step = 0; step < steps; ++step) {
    set(start);
    const Eigen::Isometry3d pose = body_pose(*model_->data, body);
    const Eigen::AngleAxisd rest(T_root_link.linear() * pose.linear().transpose());
    Eigen::Matrix<double, 6, 1> error;
    error << T_root_link.translation() - pose.translation(), rest.angle() * rest.axis();
    if (error.norm() < 1e-7) break;
    mj_jacBody(model, model_->data.get(), move.data(), turn.data(), body);
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(6, static_cast<Eigen::Index>(start.size()));
    for (const Joint& joint : robot_.joints()) {
      if (!joint.variable) continue;
      const int dof = model->jnt_dofadr[model_->find(mjOBJ_JOINT, joint.name)];
      const auto column = static_cast<Eigen::Index>(*joint.variable);
      jacobian.col(column).head<3>() += joint.multiplier * move.col(dof);
      jacobian.col(column).tail<3>() += joint.multiplier * turn.col(dof);
    }
    // Damped least squares (Wampler 1986).
    const Eigen::Matrix<double, 6, 6> normal =
        jacobian * jacobian.transpose() +
        damping * damping * Eigen::Matrix<double, 6, 6>::Identity();
    const Eigen::VectorXd delta = jacobian.transpose() * normal.ldlt().solve(error);
    const double scale = std::min(1.0, longest_step / std::max(delta.cwiseAbs().maxCoeff(), 1e-12));
    for (std::size_t i = 0; i < start.size(); ++i)
      start[i] += scale * delta(static_cast<Eigen::Index>(i));
    for (const Joint& joint : robot_.joints()) {
      if (!joint.variable || joint.mimics) continue;
      double& value = start[*joint.variable];
      value = std::clamp(value, joint.lower.value_or(-std::numbers::pi),
                         joint.upper.value_or(std::numbers::pi));
    }
  }
  return start;
}

}  // namespace penumbra::sim
