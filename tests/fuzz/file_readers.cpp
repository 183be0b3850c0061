// SPDX-License-Identifier: Apache-2.0
// Images, point clouds, and the texts of recordings, targets and trajectories.
#include "../io/mini_png.hpp"
#include "../io/robots.hpp"
#include "readers.hpp"

#include <cmath>

#include <penumbra/base/error.hpp>

#include <io/cloud/cloud_file.hpp>
#include <io/files/camera_info.hpp>
#include <io/files/camera_views.hpp>
#include <io/files/candidates_file.hpp>
#include <io/files/detections_file.hpp>
#include <io/files/image_file.hpp>
#include <io/files/joint_file.hpp>
#include <io/files/npy.hpp>
#include <io/files/png.hpp>
#include <io/files/pose_file.hpp>
#include <io/files/recording.hpp>
#include <io/files/targets_file.hpp>
#include <io/files/trajectory_file.hpp>
#include <io/files/video_file.hpp>

namespace penumbra::fuzz {
namespace {

using namespace io;

const Intrinsics images(70, 50, 100, 100, 35, 25);

template <typename T>
FileResult png(const std::filesystem::path& from) {
  Image<T> image;
  return read_png(from, image);
}

void read_pngs(std::string_view bytes) {
  const auto from = file("a.png", bytes);
  const bool is_grey = png<std::uint8_t>(from).ok() || png<std::uint16_t>(from).ok();
  const FileResult result = png<Rgb8>(from);
  require(!is_grey || result.ok(), "grey can be read as colour");
  result.require();
}

/// Pixels under a right checksum, so that damage reaches the decoder. The first byte says whether
/// they are interlaced.
void read_png_pixels(std::string_view bytes) {
  using namespace test::mini_png;
  if (bytes.empty()) return;
  const bool interlaced = bytes.front() % 2 != 0;
  read_pngs(signature() + header({16, 16, 16, 0, interlaced}) +
            chunk("IDAT", std::string(bytes.substr(1))) + chunk("IEND", ""));
}

void read_depth_image(std::string_view bytes) {
  SharedDepth depth;
  read_depth(file("depth", bytes), std::nullopt, std::nullopt, depth).require();
}

void read_jpeg(std::string_view bytes) {
  Image<Rgb8> color;
  read_color(file("a.jpg", bytes), std::nullopt, color).require();
}

/// The bytes are what ffprobe prints: it reads the video in a process of its own.
void read_video(std::string_view bytes) {
  static const bool has_ffprobe = [] {
    const auto program =
        file("ffprobe", "#!/bin/sh\nfor last; do :; done\nexec cat \"${last#file:}\"\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    const std::string path = folder().path().string() + ":" + std::getenv("PATH");
    return ::setenv("PATH", path.c_str(), 1) == 0;
  }();
  require(has_ffprobe, "ffprobe");
  static_cast<void>(VideoFile<std::uint16_t>(file("a.mkv", bytes)));
}

/// A cloud that was read is written without loss.
Reader cloud(const std::string& name, const std::string& ending) {
  return {name, [ending](std::string_view bytes) {
            const StoredCloud read = read_cloud(file("a." + ending, bytes));
            const StoredCloud again =
                read_cloud(file("copy.pcd", cloud_bytes("copy.pcd", read.cloud)));
            require(again.data == read.data, "a cloud stays the same");
            for (const char* other : {"a.ply", "a.npy", "a.bin"}) try {
                static_cast<void>(cloud_bytes(other, read.cloud));
              } catch (const InputError&) {
              }
          }};
}

void read_joints(std::string_view text) {
  static const Robot robot = test::arm();
  const auto from = file("joints.csv", text);
  for (const JointRow& row : read_joint_file(from, robot)) {
    const bool is_usable = row.fault.empty() || !row.unknown.empty();
    require(row.positions.size() == (is_usable ? 2U : 0U), "a usable row has all positions");
    for (const double p : row.positions) require(std::isfinite(p), "positions are finite");
  }
  static_cast<void>(read_frame_stamps(from));
}

void read_pose(std::string_view bytes) {
  require(read_pose_csv(file("pose.csv", bytes)).matrix().allFinite(), "a pose is finite");
}

void read_recording(std::string_view text) {
  static const bool has_files = [] {
    file("arm.urdf", test::arm_urdf);
    file("info.yaml",
         "{width: 8, height: 6, k: [9, 0, 3.5, 0, 9, 2.5, 0, 0, 1], p: [9, 0, 3.5, 0, 0, 9, 2.5, 0,"
         " 0, 0, 1, 0], distortion_model: plumb_bob, d: [0, 0, 0, 0, 0]}\n");
    file("pose.csv", "1,0,0,0.5\n0,1,0,0\n0,0,1,-1\n0,0,0,1\n");
    file("joints.csv", "frame,shoulder,elbow\n0,0,0\n");
    return true;
  }();
  require(has_files, "files");
  const auto from = file("recording.yaml", text);
  if (const auto clouds = CloudRecording::open(from)) return;
  const auto cameras = Recording::cameras(from);
  for (const std::string& camera : cameras) static_cast<void>(Recording::open(from, camera));
  if (cameras.empty()) static_cast<void>(Recording::open(from).load_robot());
}

void read_info(std::string_view text) {
  for (const bool is_rectified : {false, true}) {
    const Camera camera = parse_camera_info(std::string(text), "info.yaml", is_rectified);
    camera.check();
    require(camera.intrinsics.ray(1, 1).allFinite(), "rays are finite");
    require(camera.distortion.max_radius() >= 0, "a radius is not negative");
  }
}

void read_targets_of(const std::filesystem::path& from) {
  static const Robot robot = test::arm();
  TargetsFile targets = TargetsFile::open(from, {.robot = robot,
                                                 .image = ImageSpace::raw,
                                                 .images = images,
                                                 .has_distortion = false,
                                                 .beyond_hides = true});
  constexpr std::int64_t frames[] = {0, 1, 4, 5};
  for (const std::int64_t frame : frames) static_cast<void>(targets.of_frame(frame));
  targets.check_frames(frames);
}

void read_targets(std::string_view text) {
  static const auto csv = file("a.csv", "frame,x0,y0,x1,y1,class\n4,10,20,24,35,39\n");
  static const auto keypoints = file("k.csv", "frame,name,u,v,score\n0,a,1,2,0.5\n4,a,7,8,1\n");
  read_targets_of(file("targets.yaml", text));
}

/// The table of one target, whose columns say what it is.
void read_target_table(std::string_view text) {
  file("t.csv", text);
  const auto has = [&](const char* column) { return text.find(column) != std::string_view::npos; };
  const std::string target =
      has("width") ? "box: {csv: t.csv}"
      : has("qx")  ? "keypoint: [5, 5], handling: pose, estimate: {pose: {csv: t.csv}}"
                   : "keypoint: {csv: t.csv}";
  read_targets_of(file("table.yaml", "targets:\n- {name: a, " + target + "}\n"));
}

Reader detections(const std::string& name, const std::string& path, const std::string& pattern) {
  return {name, [=](std::string_view text) {
            file(path, text);
            static_cast<void>(read_detections(pattern, folder().path(), images, {{39, "bottle"}},
                                              usual_first_frame(pattern)));
          }};
}

Reader trajectory(const std::string& name, const std::string& path) {
  return {name,
          [=](std::string_view text) { static_cast<void>(read_trajectories(file(path, text))); }};
}

void read_views(std::string_view text) {
  static_cast<void>(cameras_of_views(file("views.json", text)));
}

void read_poses_of_cameras(std::string_view text) {
  static const Robot robot = test::arm();
  static_cast<void>(
      read_candidates(file("candidates.csv", text), robot, {.name = "", .camera = {images}}));
}

const Added files({{"png", read_pngs},
                   {"png_pixels", read_png_pixels},
                   {"tiff", read_depth_image},
                   // OpenEXR takes the size that an attribute states, and refuses it afterwards.
                   {"exr", read_depth_image, 2000, std::size_t{1} << 31U},
                   {"npy", read_depth_image},
                   {"jpeg", read_jpeg},
                   {"video", read_video, 100},
                   cloud("pcd", "pcd"),
                   cloud("cloud_ply", "ply"),
                   cloud("cloud_npy", "npy"),
                   cloud("bin", "bin"),
                   {"joints", read_joints},
                   {"pose", read_pose},
                   {"recording", read_recording},
                   {"camera_info", read_info},
                   {"targets", read_targets},
                   {"target_table", read_target_table},
                   detections("detections_json", "d.json", "d.json"),
                   detections("detections_csv", "d.csv", "d.csv"),
                   detections("detections_mot", "d.txt", "d.txt"),
                   detections("detections_yolo", "labels/4.txt", "labels/%d.txt"),
                   trajectory("trajectory", "t.yaml"),
                   trajectory("trajectory_csv", "plan.csv"),
                   {"candidates", read_poses_of_cameras},
                   {"views", read_views}});

}  // namespace
}  // namespace penumbra::fuzz
