// SPDX-License-Identifier: Apache-2.0
#include <initializer_list>
#include <span>
#include <system_error>
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/files/disk_file.hpp>
#include <io/files/pending_file.hpp>
#include <io/files/png.hpp>
#include <sim/numbers.hpp>
#include <sim/recording_folder.hpp>

namespace penumbra::sim {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t digits = 6;  // digits of a frame's number in file names

[[noreturn]] void refuse_file(const fs::path& file, const std::string& why) {
  throw InputError(file.string() + ": cannot be written (" + why + "); choose another with -o");
}

std::ofstream open_table(const fs::path& file, const std::string& header) {
  std::ofstream stream(file, std::ios::binary);
  stream << header << '\n';
  if (!stream) refuse_file(file, "no such folder, or no permission");
  return stream;
}

void write_whole(const fs::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  if (!stream.flush()) refuse_file(file, "no such folder, no permission, or no space");
}

void make_new_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder, error) &&
      (!fs::is_directory(folder, error) || !fs::is_empty(folder, error)))
    throw InputError("--output: " + folder.string() +
                     " is there and not an empty folder; choose another");
  fs::create_directories(folder, error);
  if (error) refuse_file(folder, error.message());
}

/// Returns `text` as a double-quoted YAML scalar.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += (c == '"' || c == '\\' ? "\\" : "") + std::string(1, c);
  return out + "\"";
}

std::string joint_row(std::size_t index, std::int64_t stamp, std::span<const double> positions) {
  std::string row = std::to_string(index) + ',' + std::to_string(stamp);
  for (const double position : positions) row += ',' + numbers({position});
  return row + '\n';
}

}  // namespace

RecordingFolder::RecordingFolder(const fs::path& folder, const Simulation& simulation,
                                 const std::string& scene, const SimulationOptions& options)
    : folder_(folder), simulation_(simulation), second_camera_(options.second_camera) {
  make_new_folder(folder);
  for (const char* kind : {"color", "depth", "ids", "second_depth"}) {
    std::error_code error;
    if (kind == std::string("second_depth") && !second_camera_) continue;
    fs::create_directory(folder / kind, error);
    if (error) refuse_file(folder / kind, error.message());
  }
  std::string header = "frame,stamp";
  for (const std::string& name : simulation.robot().variables()) header += ',' + name;
  joints_ = open_table(folder / "joint_states.csv", header);
  true_joints_ = open_table(folder / "true_joint_states.csv", header);
  truth_ = open_table(folder / "truth.csv",
                      "frame,stamp,object,id,x,y,z,qx,qy,qz,qw,pixels_alone,pixels_seen,"
                      "pixels_behind_robot");
  write_robot();
  write_camera("", simulation.camera(), simulation.T_base_camera());
  if (second_camera_)
    write_camera("second_", simulation.camera(), simulation.T_base_second_camera());
  write_scene(scene, options);
}

void RecordingFolder::write_robot() {
  const fs::path description = simulation_.urdf().parent_path();
  const std::string name = description.filename().string();
  std::error_code error;
  fs::copy(description, folder_ / name, fs::copy_options::recursive, error);
  if (error) refuse_file(folder_ / name, error.message());
  const auto robot = [&](const std::string& indent) {
    return indent + "urdf: " + quoted(name + '/' + simulation_.urdf().filename().string()) + '\n' +
           indent + "packages:\n" + indent + "  " + quoted(name) + ": " + quoted(name) + '\n' +
           indent + "geometry: visual   # what was drawn\n";
  };
  std::string robots = simulation_.arms().empty() ? "robot:\n" + robot("  ") : "robots:\n";
  for (const auto& [arm, T] : simulation_.arms()) {
    const Eigen::Vector3d at = T.translation();
    const Eigen::Quaterniond turn(T.linear());
    robots += "  " + arm + ":\n    pose: [" +
              numbers({at.x(), at.y(), at.z(), turn.x(), turn.y(), turn.z(), turn.w()}, ", ") +
              "]\n" + robot("    ");
  }
  description_ = "# Simulated by penumbra simulate. Paths are relative to this file.\n" + robots +
                 "camera:\n  info: camera_info.yaml\n  parent: " +
                 quoted(simulation_.robot().links().front()) +
                 "\n  pose: camera_pose.csv\n"
                 "frames:\n  joints: joint_states.csv\n  depth: depth/%06d.png\n"
                 "  color: color/%06d.png\n";
}

void RecordingFolder::write_camera(const std::string& prefix, const Camera& camera,
                                   const Eigen::Isometry3d& T_base_camera) const {
  const Intrinsics& k = camera.intrinsics;
  const std::string fx = numbers({k.fx()}), fy = numbers({k.fy()}), cx = numbers({k.cx()}),
                    cy = numbers({k.cy()});
  std::string info = "frame_id: ";
  info += quoted(camera.frame_id) + "\nwidth: " + std::to_string(k.width()) +
          "\nheight: " + std::to_string(k.height()) + "\ndistortion_model: plumb_bob\n" +
          "d: [0, 0, 0, 0, 0]\nk: [" + fx + ", 0, " + cx + ", 0, " + fy + ", " + cy +
          ", 0, 0, 1]\nr: [1, 0, 0, 0, 1, 0, 0, 0, 1]\np: [" + fx + ", 0, " + cx + ", 0, 0, " + fy +
          ", " + cy + ", 0, 0, 0, 1, 0]\n";
  write_whole(folder_ / (prefix + "camera_info.yaml"), info);
  std::string pose;
  const Eigen::Matrix4d& m = T_base_camera.matrix();
  for (int row = 0; row < 4; ++row)
    pose += numbers({m(row, 0), m(row, 1), m(row, 2), m(row, 3)}, ",") + '\n';
  write_whole(folder_ / (prefix + "camera_pose.csv"), pose);
}

void RecordingFolder::write_scene(const std::string& scene,
                                  const SimulationOptions& options) const {
  if (!simulation_.model_image().empty())
    io::write_png(folder_ / "model.png", simulation_.model_image().view());
  write_whole(folder_ / "scene.yaml", scene_text(simulation_, scene, options));
}

fs::path RecordingFolder::image(const char* kind, std::size_t index) const {
  std::string number = std::to_string(index);
  number.insert(0, digits - std::min(number.size(), digits), '0');
  return folder_ / kind / (number + ".png");
}

void RecordingFolder::add(const SimFrame& frame, std::size_t index) {
  io::write_png(image("color", index), frame.color.view());
  io::write_png(image("depth", index), frame.depth.view());
  if (second_camera_) io::write_png(image("second_depth", index), frame.second_depth.view());
  store_ids(frame, ids_);
  io::write_png(image("ids", index), std::as_const(ids_).view());
  joints_ << joint_row(index, frame.stamp, frame.joints);
  true_joints_ << joint_row(index, frame.stamp, frame.true_joints);
  for (const ObjectTruth& object : frame.objects) {
    const Eigen::Vector3d p = object.T_base_object.translation();
    const Eigen::Quaterniond q(object.T_base_object.linear());
    truth_ << index << ',' << frame.stamp << ',' << object.name << ',' << object.id << ','
           << numbers({p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}, ",") << ','
           << object.pixels_alone << ',' << object.pixels_seen << ',' << object.pixels_behind_robot
           << '\n';
  }
}

void RecordingFolder::finish() {
  for (auto [stream, name] : {std::pair(&joints_, "joint_states.csv"),
                              {&true_joints_, "true_joint_states.csv"},
                              {&truth_, "truth.csv"}})
    if (!stream->flush()) refuse_file(folder_ / name, "no space");
  io::PendingFile file(folder_ / "recording.yaml");  // without it, it is no recording
  io::write_file(file.part(), description_.data(), description_.size());
  file.finish();
}

}  // namespace penumbra::sim
