// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>

#include <penumbra/base/error.hpp>
#include <penumbra/render/gl/egl_context.hpp>

#include <sim/mujoco_handles.hpp>
#include <sim/simulation.hpp>
#include <sim/stage.hpp>

namespace penumbra::sim {
namespace {

// With 24 bits of depth these planes give steps of 3e-6 m at 1.5 m.
constexpr double near_plane = 0.08, far_plane = 12.0;  // metres
constexpr int most_geoms = 2000;

// Round shapes have enough sides to differ by less than 0.1 % of their radius. Shadows, reflections
// and antialiasing are off.
constexpr const char* visual =
    "<visual><quality numslices=\"40\" numstacks=\"14\" numquads=\"1\" offsamples=\"0\" "
    "shadowsize=\"0\"/><headlight ambient=\"0.45 0.45 0.45\" diffuse=\"0.45 0.45 0.45\" "
    "specular=\"0 0 0\"/></visual>";

constexpr const char* light =
    "<light directional=\"true\" castshadow=\"false\" dir=\"0.4 0.3 -1\" ambient=\"0 0 0\" "
    "diffuse=\"0.35 0.35 0.35\" specular=\"0 0 0\"/>";

[[noreturn]] void throw_fault(const char* message) {
  throw std::runtime_error(std::string("MuJoCo: ") + message);
}

/// Returns a context with the fixed functions that MuJoCo's renderer needs.
std::unique_ptr<gl::EglContext> open_context() {
  // MuJoCo reads from this variable where to find OpenGL's functions. The user's value is kept.
  setenv("MUJOCO_GL", "egl", 0);
  try {
    return gl::open_device(-1, gl::GlProfile::legacy);
  } catch (const InputError& error) {
    throw InputError(std::string("simulation: ") + error.what());
  }
}

std::string body_name(std::size_t part) { return "part_" + std::to_string(part); }

void write_scene(const SceneDescription& scene, const std::filesystem::path& file) {
  std::ofstream stream(file, std::ios::binary);
  stream << "<mujoco><include file=\"" << Arm::mjcf_file << "\"/>" << visual << "<asset>"
         << scene.assets << "</asset><worldbody>" << light;
  for (std::size_t i = 0; i < scene.parts.size(); ++i)
    stream << "<body name=\"" << body_name(i) << "\" mocap=\"true\">" << scene.parts[i].geoms
           << "</body>\n";
  stream << "</worldbody></mujoco>\n";
  if (!stream.flush()) throw InputError(file.string() + ": cannot be written");
}

ModelPtr load_scene(const std::filesystem::path& file) {
  std::array<char, 1000> why{};
  ModelPtr model(mj_loadXML(file.c_str(), nullptr, why.data(), why.size()));
  if (model == nullptr) throw std::logic_error("MuJoCo: " + std::string(why.data()));
  return model;
}

void set_texture(mjModel& model, const SceneTexture& texture) {
  const int id = mj_name2id(&model, mjOBJ_TEXTURE, texture.name.c_str());
  const Image<Rgb8>& image = texture.image;
  if (id < 0 || model.tex_width[id] != image.width() || model.tex_height[id] != image.height())
    throw std::logic_error("texture " + texture.name + " is not as large as the scene says");
  std::memcpy(model.tex_rgb + model.tex_adr[id], image.data(), image.size() * sizeof(Rgb8));
}

void to_floats(const Eigen::Vector3d& from, float* to) {
  for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(from[k]);
}

/// Returns the frustum with Penumbra's pixel centres: pixel (u, v) spans u - 0.5 .. u + 0.5.
mjvGLCamera gl_camera(const Viewpoint& view) {
  const Intrinsics& k = view.intrinsics;
  const double scale = near_plane / k.fy();
  mjvGLCamera camera{};
  to_floats(view.T_base_camera.translation(), camera.pos);
  to_floats(view.T_base_camera.linear().col(2), camera.forward);
  to_floats(-view.T_base_camera.linear().col(1), camera.up);
  camera.frustum_center = static_cast<float>(scale * (0.5 * (k.width() - 1) - k.cx()));
  camera.frustum_bottom = static_cast<float>(scale * (k.cy() + 0.5 - k.height()));
  camera.frustum_top = static_cast<float>(scale * (k.cy() + 0.5));
  camera.frustum_near = static_cast<float>(near_plane);
  camera.frustum_far = static_cast<float>(far_plane);
  return camera;
}

}  // namespace

struct Stage::Drawing {
  Drawing(const Arm& arm, const SceneDescription& scene, const std::filesystem::path& folder,
          const Intrinsics& largest);
  ~Drawing();
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;

  void update_scene();
  void draw(const Viewpoint& view, bool segmentation);

  const Arm& arm;
  ModelPtr model;
  DataPtr data;
  std::unique_ptr<gl::EglContext> egl = open_context();
  mjrContext context{};
  mjvScene scene{};
  mjvOption option{};
  std::vector<std::int32_t> ids;     // ids of geoms
  std::vector<int> mocap;            // mocap index of each part
  std::vector<int> qpos;             // of Arm::joint_positions
  std::vector<unsigned char> bytes;  // as OpenGL returns them, bottom row first
  std::vector<float> depths;
};

Stage::Drawing::Drawing(const Arm& robot, const SceneDescription& description,
                        const std::filesystem::path& folder, const Intrinsics& largest)
    : arm(robot) {
  const std::filesystem::path file = folder / "scene.xml";
  write_scene(description, file);
  model = load_scene(file);
  for (const SceneTexture& texture : description.textures) set_texture(*model, texture);
  data.reset(mj_makeData(model.get()));
  for (std::size_t i = 0; i < description.parts.size(); ++i) {
    const int body = mj_name2id(model.get(), mjOBJ_BODY, body_name(i).c_str());
    mocap.push_back(model->body_mocapid[body]);
  }
  for (const auto& [joint, value] : arm.joint_positions(arm.robot().rest_positions()))
    qpos.push_back(model->jnt_qposadr[mj_name2id(model.get(), mjOBJ_JOINT, joint.c_str())]);
  for (int geom = 0; geom < model->ngeom; ++geom) {
    const int body = model->geom_bodyid[geom];
    const int part = model->body_mocapid[body];
    if (part >= 0) {
      const int object = description
                             .parts[static_cast<std::size_t>(
                                 std::find(mocap.begin(), mocap.end(), part) - mocap.begin())]
                             .object;
      ids.push_back(object < 0 ? 0 : first_object_id + object);
      continue;
    }
    // The root link is MuJoCo's world.
    const std::string name = body == 0 ? "" : mj_id2name(model.get(), mjOBJ_BODY, body);
    const auto link = body == 0 ? std::optional<std::size_t>(0) : arm.robot().find_link(name);
    if (!link) throw std::logic_error("MuJoCo's body '" + name + "' is no link");
    ids.push_back(1 + static_cast<std::int32_t>(*link));
  }
  model->vis.global.offwidth = largest.width();
  model->vis.global.offheight = largest.height();
  const gl::EglContext::Current current(*egl);
  mjr_defaultContext(&context);
  mjr_makeContext(model.get(), &context, mjFONTSCALE_50);
  mjr_setBuffer(mjFB_OFFSCREEN, &context);
  if (context.currentBuffer != mjFB_OFFSCREEN)
    throw InputError("simulation: OpenGL has no buffer of " + std::to_string(largest.width()) +
                     "x" + std::to_string(largest.height()) + " to draw in");
  mjv_defaultScene(&scene);
  mjv_makeScene(model.get(), &scene, most_geoms);
  mjv_defaultOption(&option);
  // A URDF's collision geometry is in group 0, its visual geometry in group 1; scenes use 2.
  option.geomgroup[0] = 0;
  option.geomgroup[1] = 1;
  option.geomgroup[2] = 1;
}

Stage::Drawing::~Drawing() {
  const std::lock_guard lock(mujoco_mutex());
  const gl::EglContext::Current current(*egl);
  mjv_freeScene(&scene);
  mjr_freeContext(&context);
}

void Stage::Drawing::update_scene() {
  mjvCamera unused;
  mjv_defaultFreeCamera(model.get(), &unused);
  mjv_updateScene(model.get(), data.get(), &option, nullptr, &unused, mjCAT_ALL, &scene);
}

void Stage::Drawing::draw(const Viewpoint& view, bool segmentation) {
  std::fill(std::begin(scene.flags), std::end(scene.flags), mjtByte{0});
  scene.flags[mjRND_CULL_FACE] = 1;
  scene.flags[mjRND_SEGMENT] = segmentation ? 1 : 0;
  scene.flags[mjRND_IDCOLOR] = segmentation ? 1 : 0;
  scene.camera[0] = scene.camera[1] = gl_camera(view);
  const mjrRect area{0, 0, view.intrinsics.width(), view.intrinsics.height()};
  mjr_render(area, &scene, &context);
}

Stage::Stage(const Arm& arm, const SceneDescription& scene, const std::filesystem::path& folder,
             const Intrinsics& largest) {
  const std::lock_guard lock(mujoco_mutex());
  mju_user_error = throw_fault;  // otherwise MuJoCo ends the process
  drawing_ = std::make_unique<Drawing>(arm, scene, folder, largest);
}

Stage::~Stage() = default;

void Stage::place(std::span<const double> joints, std::span<const Eigen::Isometry3d> parts) {
  const auto positions = drawing_->arm.joint_positions(joints);
  mjData& data = *drawing_->data;
  for (std::size_t i = 0; i < positions.size(); ++i)
    data.qpos[drawing_->qpos[i]] = positions[i].value;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const int id = drawing_->mocap[i];
    const Eigen::Quaterniond q(parts[i].linear());
    for (int k = 0; k < 3; ++k) data.mocap_pos[3 * id + k] = parts[i].translation()[k];
    const std::array<double, 4> wxyz{q.w(), q.x(), q.y(), q.z()};
    std::copy(wxyz.begin(), wxyz.end(), data.mocap_quat + 4 * id);
  }
  mj_kinematics(drawing_->model.get(), &data);
  mj_comPos(drawing_->model.get(), &data);
  mj_camlight(drawing_->model.get(), &data);
}

void Stage::draw_color(const Viewpoint& view, Image<Rgb8>& color) {
  Drawing& d = *drawing_;
  const gl::EglContext::Current current(*d.egl);
  d.update_scene();
  d.draw(view, false);
  const int width = view.intrinsics.width(), height = view.intrinsics.height();
  const std::size_t row = 3 * static_cast<std::size_t>(width);
  d.bytes.resize(row * static_cast<std::size_t>(height));
  mjr_readPixels(d.bytes.data(), nullptr, {0, 0, width, height}, &d.context);
  color.fit(width, height);
  for (int v = 0; v < height; ++v)
    std::memcpy(color.view().row(v), &d.bytes[row * static_cast<std::size_t>(height - 1 - v)], row);
}

void Stage::draw_ids(const Viewpoint& view, const std::function<bool(std::int32_t)>& shown,
                     const Window& window, Image<std::int32_t>* ids, Image<float>* depth) {
  if (window.empty()) return;
  Drawing& d = *drawing_;
  const gl::EglContext::Current current(*d.egl);
  d.update_scene();
  for (int i = 0; i < d.scene.ngeom; ++i) {
    mjvGeom& geom = d.scene.geoms[i];
    const bool of_model = geom.objtype == mjOBJ_GEOM;
    const std::int32_t id = of_model ? d.ids[static_cast<std::size_t>(geom.objid)] : 0;
    geom.segid = of_model && shown(id) ? id : -1;
  }
  d.draw(view, true);
  const int width = window.u1 - window.u0, rows = window.v1 - window.v0;
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(rows);
  const mjrRect area{window.u0, view.intrinsics.height() - window.v1, width, rows};
  if (ids != nullptr) d.bytes.resize(3 * pixels);
  if (depth != nullptr) d.depths.resize(pixels);
  mjr_readPixels(ids != nullptr ? d.bytes.data() : nullptr,
                 depth != nullptr ? d.depths.data() : nullptr, area, &d.context);
  for (int v = window.v0; v < window.v1; ++v) {
    const std::size_t from =
        static_cast<std::size_t>(window.v1 - 1 - v) * static_cast<std::size_t>(width);
    if (ids != nullptr) {
      const unsigned char* rgb = &d.bytes[3 * from];
      std::int32_t* const to = ids->view().row(v) + window.u0;
      // MuJoCo writes the id + 1, the lowest byte in red.
      for (int u = 0; u < width; ++u, rgb += 3)
        to[u] = std::max(0, (rgb[0] | rgb[1] << 8 | rgb[2] << 16) - 1);
    }
    if (depth != nullptr) {
      const float* const z = &d.depths[from];
      float* const to = depth->view().row(v) + window.u0;
      constexpr float product = static_cast<float>(near_plane * far_plane);
      constexpr float far = static_cast<float>(far_plane);
      constexpr float range = static_cast<float>(far_plane - near_plane);
      for (int u = 0; u < width; ++u) to[u] = z[u] < 1.0F ? product / (far - z[u] * range) : 0.0F;
    }
  }
}

Window Stage::window_of(const Viewpoint& view, std::int32_t id) const {
  const Drawing& d = *drawing_;
  const Intrinsics& k = view.intrinsics;
  const Eigen::Isometry3d T_camera_base = view.T_base_camera.inverse();
  const Window whole{0, 0, k.width(), k.height()};
  Window window{k.width(), k.height(), 0, 0};
  for (int geom = 0; geom < d.model->ngeom; ++geom) {
    if (d.ids[static_cast<std::size_t>(geom)] != id) continue;
    const Eigen::Vector3d centre =
        T_camera_base * Eigen::Map<const Eigen::Vector3d>(d.data->geom_xpos + 3 * geom);
    const double radius = d.model->geom_rbound[geom];
    const double nearest = centre.z() - radius;
    if (nearest < near_plane) return whole;
    // Bounds the ball's silhouette by its box's corners at the nearest and the farthest depth.
    for (const double z : {nearest, centre.z() + radius})
      for (const double side : {-radius, radius}) {
        const double u = k.fx() * (centre.x() + side) / z + k.cx();
        const double v = k.fy() * (centre.y() + side) / z + k.cy();
        const auto clamp = [](double x, int most) {
          return static_cast<int>(std::clamp(x, 0.0, static_cast<double>(most)));
        };
        window.u0 = std::min(window.u0, clamp(std::floor(u) - 1.0, k.width()));
        window.v0 = std::min(window.v0, clamp(std::floor(v) - 1.0, k.height()));
        window.u1 = std::max(window.u1, clamp(std::ceil(u) + 2.0, k.width()));
        window.v1 = std::max(window.v1, clamp(std::ceil(v) + 2.0, k.height()));
      }
  }
  return window;
}

}  // namespace penumbra::sim
