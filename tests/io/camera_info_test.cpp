// SPDX-License-Identifier: Apache-2.0
#include "files.hpp"

#include <io/files/camera_info.hpp>

namespace penumbra::io {
namespace {

using test::replaced;

// As `ros2 topic echo --once` prints it.
const std::string info_text = R"(header:
  stamp:
    sec: 12
    nanosec: 500
  frame_id: camera_depth_optical_frame
height: 480
width: 640
distortion_model: plumb_bob
d:
- -0.3
- 0.1
- 0.001
- -0.002
- 0.0
k: [500.5, 0.0, 320.25, 0.0, 501.5, 240.75, 0.0, 0.0, 1.0]
r: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
p: [480.0, 0.0, 318.0, 0.0, 0.0, 481.0, 239.0, 0.0, 0.0, 0.0, 1.0, 0.0]
binning_x: 0
binning_y: 0
roi:
  x_offset: 0
  y_offset: 0
  height: 0
  width: 0
  do_rectify: false
---
)";

// As camera_calibration writes it.
const std::string calibration = R"(image_width: 640
image_height: 480
camera_name: narrow_stereo
camera_matrix:
  rows: 3
  cols: 3
  data: [500.5, 0.0, 320.25, 0.0, 501.5, 240.75, 0.0, 0.0, 1.0]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.3, 0.1, 0.001, -0.002, 0.0]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
projection_matrix:
  rows: 3
  cols: 4
  data: [480.0, 0.0, 318.0, 0.0, 0.0, 481.0, 239.0, 0.0, 0.0, 0.0, 1.0, 0.0]
)";

const Intrinsics raw_camera(640, 480, 500.5, 501.5, 320.25, 240.75);
const Intrinsics rectified(640, 480, 480, 481, 318, 239);

Camera parse(const std::string& text, bool is_rectified = false) {
  return parse_camera_info(text, "cam.yaml", is_rectified);
}

void expect_same_lens(const Distortion& a, const Distortion& b) {
  EXPECT_EQ(a.model(), b.model());
  EXPECT_EQ(a.distort({0.3, -0.2}), b.distort({0.3, -0.2}));
}

const Distortion lens("plumb_bob", std::vector<double>{-0.3, 0.1, 0.001, -0.002, 0.0});

TEST(CameraInfo, ReadsBothForms) {
  for (const std::string& text : {info_text, calibration}) {
    const Camera camera = parse(text);
    EXPECT_EQ(camera.intrinsics, raw_camera);
    expect_same_lens(camera.distortion, lens);
    const Camera free = parse(text, true);
    EXPECT_EQ(free.intrinsics, rectified);
    EXPECT_TRUE(free.distortion.is_none());
  }
  EXPECT_EQ(parse(info_text).frame_id, "camera_depth_optical_frame");
  EXPECT_EQ(parse(calibration).frame_id, "");
}

TEST(CameraInfo, ReadsUpperCaseKeysOfRos1) {
  std::string text = replaced(replaced(info_text, "\nd:", "\nD:"), "\nk:", "\nK:");
  text = replaced(replaced(text, "\nr:", "\nR:"), "\np:", "\nP:");
  text = replaced(replaced(text, "sec:", "secs:"), "do_rectify: false", "do_rectify: False");
  EXPECT_EQ(parse(text).intrinsics, raw_camera);
  EXPECT_EQ(parse(text, true).intrinsics, rectified);
}

TEST(CameraInfo, FrameIdMayStandOnTopOrBeEmpty) {
  const std::string no_header = info_text.substr(info_text.find("height"));
  EXPECT_EQ(parse(no_header).frame_id, "");
  EXPECT_EQ(parse("frame_id: cam\n" + no_header).frame_id, "cam");
  EXPECT_EQ(parse("frame_id: ''\n" + no_header).frame_id, "");
}

// The window is cut from the full image and then binned: pixel (u, v) of what comes is the block
// from (x_offset + u * binning_x, y_offset + v * binning_y) on, and its ray is the block's middle.
TEST(CameraInfo, AppliesWindowThenBinning) {
  constexpr double rounding = 1e-12;
  std::string text =
      replaced(replaced(info_text, "binning_x: 0", "binning_x: 2"), "binning_y: 0", "binning_y: 4");
  text = replaced(replaced(text, "x_offset: 0", "x_offset: 100"), "y_offset: 0", "y_offset: 50");
  text = replaced(replaced(text, "  height: 0", "  height: 200"), "  width: 0", "  width: 401");
  for (const bool is_rectified : {false, true}) {
    const Camera camera = parse(text, is_rectified);
    const Intrinsics& full = is_rectified ? rectified : raw_camera;
    EXPECT_EQ(camera.intrinsics.width(), 200);
    EXPECT_EQ(camera.intrinsics.height(), 50);
    for (const int u : {0, 7, 199})
      for (const int v : {0, 3, 49}) {
        const Eigen::Vector3d first = full.ray(100 + 2 * u, 50 + 4 * v);
        const Eigen::Vector3d last = full.ray(100 + 2 * u + 1, 50 + 4 * v + 3);
        EXPECT_LT((camera.intrinsics.ray(u, v) - 0.5 * (first + last)).norm(), rounding);
      }
  }
  EXPECT_EQ(parse(replaced(info_text, "binning_x: 0", "binning_x: 1")).intrinsics, raw_camera);
}

// A text with one piece of it replaced, and what the error must name.
struct Edit {
  const char *piece, *by, *named;
};

void expect_refused(const std::string& text, std::initializer_list<Edit> edits,
                    bool is_rectified = false) {
  for (const auto& [piece, by, named] : edits) {
    const std::string bad = replaced(text, piece, by);
    test::expect_refused([&] { return parse(bad, is_rectified); }, {"cam.yaml", named});
  }
}

TEST(CameraInfo, WrongValuesAreNamedWithLineAndKey) {
  expect_refused(info_text,
                 {{"k: [500.5, 0.0, 320.25, 0.0, 501.5, 240.75, 0.0, 0.0, 1.0]\n", "", "add k: "},
                  {"distortion_model: plumb_bob\n", "", "add distortion_model: "},
                  {"height: 480", "height: 480\nheigth: 480", "cam.yaml:7: heigth"},
                  {"height: 480", "height: 480\nmade: x\nby: y", "(unknown, too: by)"},
                  {"height: 480", "height: 480\nheight: 480", "there already"},
                  {"width: 640", "width: 0", "cam.yaml:7: width"},
                  {"width: 640", "width: 99999999999", "cam.yaml:7: width"},
                  {"plumb_bob", "division", "cam.yaml:8: distortion_model"},
                  {"plumb_bob", "equidistant", "cam.yaml:9: d"},
                  {"- -0.3", "- .nan", "cam.yaml:10: d[0]"},
                  {"k: [500.5", "k: [0.0", "cam.yaml:15: k: "},
                  {"k: [500.5", "k: [1, 500.5", "cam.yaml:15: k: has 10 values"},
                  {"k: [500.5, 0.0", "k: [500.5, 0.1", "skew"},
                  {"240.75, 0.0, 0.0, 1.0]", "240.75, 0.0, 0.0, 2.0]", "value 9"},
                  {"k: [500.5", "K: [500.5, 0]\nk: [500.5", "keep one"},
                  {"binning_x: 0", "binning_x: 641", "cam.yaml:18: binning_x"},
                  {"  width: 0", "  width: 700", "cam.yaml:20: roi"},
                  {"  x_offset: 0", "  x_offset: 10", "region of interest"},
                  {"do_rectify: false", "do_rectify: false\n  angle: 3", "roi.angle"},
                  {"height: 480", "height: 480\nframe_id: other", "header.frame_id"}});
  expect_refused(calibration, {{"image_width: 640\n", "", "add width: "},
                               {"  rows: 3\n", "", "camera_matrix: key 'rows'"},
                               {"cols: 5", "cols: 4", "1 x 4"},
                               {"rows: 3", "rows: 4611686018427387905", "rows x"},
                               {"cols: 5", "cols: 5\n  rank: 2", "rank"}});
}

TEST(CameraInfo, RectifiedNeedsAPlainProjection) {
  expect_refused(info_text,
                 {{"318.0, 0.0,", "318.0, -24.0,", "stereo pair"},
                  {"p: [480.0, 0.0", "p: [480.0, 3.0", "skew"},
                  {"p: [480.0", "p: [0.0", "fx = 0"},
                  {"p: [480.0", "p: [1.0, 480.0", "13 values"},
                  {"r: [1.0", "r: [0.9999", "turns the rectified image"}},
                 true);
  EXPECT_NO_THROW(static_cast<void>(parse(replaced(info_text, "r: [1.0", "r: [0.9999"))));
}

TEST(CameraInfo, SeveralDocumentsMustBeOfTheSameCamera) {
  const std::string later = replaced(info_text, "sec: 12", "sec: 13");
  for (const std::string& text :
       {"%YAML 1.2\n---\n" + info_text, "---\n" + info_text + later + info_text})
    EXPECT_EQ(parse(text).intrinsics, raw_camera);
  const auto lines = std::count(info_text.begin(), info_text.end(), '\n');
  const std::string third = "cam.yaml:" + std::to_string(2 * lines + 1) + ": document 3 of 3";
  for (const auto& [from, to] : {std::pair("width: 640", "width: 320"),
                                 {"- -0.3", "- -0.2"},
                                 {"k: [500.5", "k: [500.6"},
                                 {"binning_y: 0", "binning_y: 2"},
                                 {"frame_id: camera", "frame_id: other"}})
    test::expect_refused({{info_text + later + replaced(info_text, from, to), third}},
                         [](const std::string& text) { return parse(text); });
}

// As OpenCV's calibration programs write it.
const std::string opencv = R"(%YAML:1.0
---
calibration_time: "Mon 01 Jan 2024 10:00:00"
nr_of_frames: 3
image_width: 640
image_height: 480
board_width: 9
square_size: 25.
# flags: +fix_aspectRatio
flags: 2
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 5.005e+02, 0., 320.25, 0., 501.5,
       240.75, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ -0.3, 1.0e-01, 0.001, -0.002, 0. ]
avg_reprojection_error: 4.4e-01
per_view_reprojection_errors: !!opencv-matrix
   rows: 1
   cols: 1
   dt: f
   data: [ .Nan ]
)";

const std::string kalibr = R"(cam0:
  cam_overlaps: []
  camera_model: pinhole
  distortion_coeffs: [-0.3, 0.1, 0.001, -0.002]
  distortion_model: radtan
  intrinsics: [500.5, 501.5, 320.25, 240.75]
  resolution: [640, 480]
  rostopic: /camera/image_raw
)";

const std::string realsense = R"({
	"width": 640, "height": 480, "fx": 500.5, "fy": 501.5, "ppx": 320.25, "ppy": 240.75,
	"model": "distortion.brown_conrady", "coeffs": [-0.3, 0.1, 0.001, -0.002, 0.0], "serial": "1"
})";

// What numpy and yaml.dump make of OpenCV's matrices, with the keys of its tutorials.
const std::string dumped =
    "image_size: [640, 480]\ncameraMatrix:\n- [500.5, 0, 320.25]\n- [0, 501.5, 240.75]\n- [0, 0, "
    "1]\ndist_coeffs: [[-0.3, 0.1, 0.001, -0.002, 0]]\nrms: 0.2\n";

TEST(CameraInfo, ReadsTheFilesOfOtherPrograms) {
  const std::string upper_case =
      replaced(replaced(opencv, "camera_matrix", "K"), "distortion_coefficients", "D");
  const std::string both = replaced(opencv, "flags: 2", "distortion_model: plumb_bob");
  for (const std::string& text : {opencv, upper_case, both, kalibr, realsense, dumped}) {
    const Camera camera = parse(text);
    EXPECT_EQ(camera.intrinsics, raw_camera) << text;
    expect_same_lens(camera.distortion, lens);
  }
  const auto model = [](const std::string& text) { return parse(text).distortion.model(); };
  const std::string fisheye =
      replaced(replaced(opencv, "rows: 5", "rows: 4"), "-0.002, 0. ]", "-0.002 ]");
  EXPECT_EQ(model(replaced(kalibr, "radtan", "equidistant")), DistortionModel::equidistant);
  EXPECT_EQ(model(replaced(fisheye, "flags: 2", "fisheye_model: 1")), DistortionModel::equidistant);
  EXPECT_EQ(model(replaced(fisheye, "flags: 2", "fisheye_model: 0")), DistortionModel::plumb_bob);
  EXPECT_EQ(model(replaced(replaced(opencv, "rows: 5", "rows: 8"), "-0.002, 0. ]",
                           "-0.002, 0., 0.1, 0., 0. ]")),
            DistortionModel::rational_polynomial);
  const std::string zeros = replaced(realsense, "-0.3, 0.1, 0.001, -0.002, 0.0", "0, 0, 0, 0, 0");
  EXPECT_TRUE(parse(replaced(zeros, "brown", "inverse_brown")).distortion.is_none());
  EXPECT_EQ(parse(zeros, true).intrinsics, raw_camera) << "without distortion nothing is rectified";
}

TEST(CameraInfo, OneLineSaysWhatOtherFilesLack) {
  test::expect_refused(
      {{replaced(kalibr, "resolution: [640, 480]", "fps: 3"),
        "cam.yaml:1: cam0: is not complete; "
        "add width: 640; height: 480"},
       {replaced(kalibr, "pinhole", "omni"), "cam0.camera_model: is 'omni'"},
       {replaced(kalibr, "radtan", "fov"), "cam0.distortion_model: "},
       {kalibr + "cam1:\n  resolution: [640, 480]\n", "cam0 and cam1"},
       {replaced(realsense, "brown", "inverse_brown"), "model: is not supported"},
       {replaced(realsense, "\"model\": \"distortion.brown_conrady\",", ""),
        "add distortion_model"},
       {replaced(realsense, "\"coeffs\"", "\"coefs\""), "add d: [k1, k2, p1, p2, k3]"},
       {replaced(replaced(opencv, "rows: 5", "rows: 4"), "-0.002, 0. ]", "-0.002 ]"),
        "equidistant"},
       {replaced(opencv, "image_width", "imgwidth"), "add width: 640"},
       {"Camera.fx: 500.5\nCamera.fy: 501.5\n", "k: [fx, 0, cx, 0, fy, cy, 0, 0, 1]"},
       {"500.5 0 320.25\n0 501.5 240.75\n0 0 1\n", "k: [fx, 0, cx"},
       {"<?xml version=\"1.0\"?><opencv_storage></opencv_storage>", "XML"}},
      [](const std::string& text) { return parse(text); });
  expect_refused(kalibr, {{"radtan", "radtan", "add their projection"}}, true);
}

}  // namespace
}  // namespace penumbra::io
