// SPDX-License-Identifier: Apache-2.0
// What the keys mean is said in ROS's sensor_msgs/msg/CameraInfo.msg: k, p and roi refer to the
// full resolution, width x height; roi is a window of that, and binning makes one pixel of each
// block of the window.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>

#include <io/camera_info.hpp>
#include <io/disk_file.hpp>
#include <io/yaml.hpp>

namespace penumbra::io {
namespace {

constexpr std::uint64_t max_camera_info_bytes = 1 << 20;

/// The value of one of two spellings of a key, which must not both stand there.
const YamlNode* find_either(const YamlNode& map, std::string_view key, std::string_view other) {
  const YamlNode* first = map.find(key);
  const YamlNode* second = map.find(other);
  if (first != nullptr && second != nullptr)
    second->fail("key '" + std::string(key) + "' is there too; keep one");
  return first != nullptr ? first : second;
}

const YamlNode& at_either(const YamlNode& map, std::string_view key, std::string_view other) {
  const YamlNode* node = find_either(map, key, other);
  return node != nullptr ? *node : map.at(key);
}

/// The values of camera_calibration's {rows, cols, data}.
std::vector<double> matrix(const YamlNode& node) {
  node.allow_only({"rows", "cols", "data"});
  const std::int64_t rows = node.at("rows").integer();
  const std::int64_t cols = node.at("cols").integer();
  std::vector<double> values = node.at("data").numbers();
  const auto count = static_cast<std::int64_t>(values.size());
  if (rows < 0 || cols < 0 || rows > count || cols > count + 1 || rows * cols != count)
    node.at("data").fail("has " + std::to_string(count) + " values; rows x cols are " +
                         std::to_string(rows) + " x " + std::to_string(cols));
  return values;
}

/// A matrix of either form of the file, and where it stands.
struct Matrix {
  const YamlNode& node;
  std::vector<double> values;

  void require(std::size_t count) const {
    if (values.size() != count)
      node.fail("has " + std::to_string(values.size()) + " values; " + std::to_string(count) +
                " are wanted");
  }
  void require(std::size_t i, double wanted, const std::string& why) const {
    if (values[i] != wanted)
      node.fail("value " + std::to_string(i + 1) + " is " + std::to_string(values[i]) + "; " + why);
  }
};

/// Where the values stand in the two forms of the file.
class CameraInfo {
 public:
  explicit CameraInfo(const YamlNode& root) : root_(root), calibration_(is_calibration(root)) {
    if (calibration_)
      root.allow_only({"image_width", "image_height", "camera_name", "camera_matrix",
                       "distortion_model", "distortion_coefficients", "rectification_matrix",
                       "projection_matrix"});
    else
      root.allow_only({"header", "frame_id", "width", "height", "distortion_model", "d", "k", "r",
                       "p", "D", "K", "R", "P", "binning_x", "binning_y", "roi"});
  }

  [[nodiscard]] int width() const { return size(calibration_ ? "image_width" : "width"); }
  [[nodiscard]] int height() const { return size(calibration_ ? "image_height" : "height"); }

  [[nodiscard]] Matrix k() const { return get("camera_matrix", "k", "K"); }
  [[nodiscard]] Matrix d() const { return get("distortion_coefficients", "d", "D"); }
  [[nodiscard]] Matrix r() const { return get("rectification_matrix", "r", "R"); }
  [[nodiscard]] Matrix p() const { return get("projection_matrix", "p", "P"); }

  [[nodiscard]] const YamlNode& distortion_model() const { return root_.at("distortion_model"); }
  [[nodiscard]] const YamlNode* find(std::string_view key) const { return root_.find(key); }

 private:
  static bool is_calibration(const YamlNode& root) {
    return root.find("image_width") != nullptr || root.find("image_height") != nullptr ||
           root.find("camera_matrix") != nullptr;
  }

  [[nodiscard]] int size(std::string_view key) const {
    const YamlNode& node = root_.at(key);
    const std::int64_t value = node.integer();
    if (value < 1 || value > Intrinsics::max_size)
      node.fail("is " + std::to_string(value) + "; 1 to " + std::to_string(Intrinsics::max_size) +
                " pixels are wanted");
    return static_cast<int>(value);
  }

  [[nodiscard]] Matrix get(std::string_view of_calibration, std::string_view of_message,
                           std::string_view of_ros1) const {
    if (calibration_) {
      const YamlNode& node = root_.at(of_calibration);
      return {node, matrix(node)};
    }
    const YamlNode& node = at_either(root_, of_message, of_ros1);
    return {node, node.numbers()};
  }

  const YamlNode& root_;
  bool calibration_;
};

/// Full resolution: the image that the sensor would give without roi and binning.
Intrinsics raw_intrinsics(const CameraInfo& info) {
  const Matrix k = info.k();
  k.require(9);
  k.require(1, 0, "a skew is not supported and must be 0");
  for (const std::size_t i : {3U, 6U, 7U}) k.require(i, 0, "[fx 0 cx, 0 fy cy, 0 0 1] is wanted");
  k.require(8, 1, "[fx 0 cx, 0 fy cy, 0 0 1] is wanted");
  const int width = info.width();
  const int height = info.height();
  return k.node.blamed_for([&] {
    return Intrinsics(width, height, k.values[0], k.values[4], k.values[2], k.values[5]);
  });
}

Distortion raw_distortion(const CameraInfo& info) {
  const YamlNode& model = info.distortion_model();
  const std::string& name = model.text_or_empty();
  model.blamed_for([&] { static_cast<void>(penumbra::distortion_model(name)); });
  const Matrix d = info.d();
  return d.node.blamed_for([&] { return Distortion(name, d.values); });
}

void require_identity(const Matrix& r) {
  constexpr double rounding = 1e-9;
  r.require(9);
  for (std::size_t i = 0; i < 9; ++i)
    if (std::abs(r.values[i] - (i % 4 == 0 ? 1 : 0)) > rounding)
      r.node.fail(
          "turns the rectified image against the camera; give the camera's pose as that of the "
          "rectified image and the identity here");
}

Intrinsics rectified_intrinsics(const CameraInfo& info) {
  require_identity(info.r());
  const Matrix p = info.p();
  p.require(12);
  p.require(1, 0, "a skew is not supported and must be 0");
  for (const std::size_t i : {3U, 7U, 11U})
    p.require(i, 0, "the image of a second camera of a stereo pair is not supported; 0 is wanted");
  for (const std::size_t i : {4U, 8U, 9U})
    p.require(i, 0, "[fx 0 cx 0, 0 fy cy 0, 0 0 1 0] is wanted");
  p.require(10, 1, "[fx 0 cx 0, 0 fy cy 0, 0 0 1 0] is wanted");
  const int width = info.width();
  const int height = info.height();
  return p.node.blamed_for([&] {
    return Intrinsics(width, height, p.values[0], p.values[5], p.values[2], p.values[6]);
  });
}

/// A whole number of pixels; 0 where the key is missing.
int pixels(const YamlNode& map, std::string_view key) {
  const YamlNode* node = map.find(key);
  if (node == nullptr) return 0;
  const std::int64_t value = node->integer();
  if (value < 0 || value > Intrinsics::max_size)
    node->fail("is " + std::to_string(value) + "; 0 to " + std::to_string(Intrinsics::max_size) +
               " pixels are wanted");
  return static_cast<int>(value);
}

/// The window of roi; all of the image where every value is 0.
Intrinsics windowed(const CameraInfo& info, const Intrinsics& full, bool rectified) {
  const YamlNode* roi = info.find("roi");
  if (roi == nullptr) return full;
  roi->allow_only({"x_offset", "y_offset", "width", "height", "do_rectify"});
  const int x = pixels(*roi, "x_offset");
  const int y = pixels(*roi, "y_offset");
  const int width = pixels(*roi, "width");
  const int height = pixels(*roi, "height");
  const YamlNode* do_rectify = roi->find("do_rectify");
  const bool window_differs = do_rectify != nullptr && do_rectify->boolean();
  if (x == 0 && y == 0 && width == 0 && height == 0) return full;
  if (rectified && window_differs)
    do_rectify->fail(
        "the rectified image's window is not that of roi; give the roi of the rectified image "
        "and do_rectify: false");
  return roi->blamed_for([&] { return full.cropped(x, y, width, height); });
}

Intrinsics binned(const YamlNode& root, const Intrinsics& window) {
  const int bx = std::max(pixels(root, "binning_x"), 1);
  const int by = std::max(pixels(root, "binning_y"), 1);
  if (bx == 1 && by == 1) return window;
  const YamlNode& blamed = root.at(bx > 1 ? "binning_x" : "binning_y");
  return blamed.blamed_for([&] { return window.binned(bx, by); });
}

std::string frame_id(const YamlNode& root) {
  const YamlNode* own = root.find("frame_id");
  const YamlNode* header = root.find("header");
  if (header != nullptr) {
    header->allow_only({"seq", "stamp", "frame_id"});
    const YamlNode* in_header = header->find("frame_id");
    if (own != nullptr && in_header != nullptr) own->fail("header.frame_id is there too; keep one");
    if (in_header != nullptr) own = in_header;
  }
  return own != nullptr ? own->text_or_empty() : std::string();
}

Camera camera_of(const YamlNode& root, bool rectified) {
  const CameraInfo info(root);
  const Intrinsics full = rectified ? rectified_intrinsics(info) : raw_intrinsics(info);
  return {.intrinsics = binned(root, windowed(info, full, rectified)),
          .distortion = rectified ? Distortion() : raw_distortion(info),
          .range = {},
          .frame_id = frame_id(root)};
}

bool is_same(const Camera& a, const Camera& b) {
  return a.intrinsics == b.intrinsics && a.distortion == b.distortion && a.frame_id == b.frame_id;
}

}  // namespace

Camera parse_camera_info(const std::string& text, const std::filesystem::path& file,
                         bool rectified) {
  std::vector<YamlNode> documents = YamlNode::parse_all(text, file);
  // ros2 topic echo ends every message with the mark of a next document.
  while (documents.size() > 1 && documents.back().is_null()) documents.pop_back();
  Camera camera = camera_of(documents.front(), rectified);
  for (std::size_t i = 1; i < documents.size(); ++i)
    if (!is_same(camera, camera_of(documents[i], rectified)))
      documents[i].fail("document " + std::to_string(i + 1) + " of " +
                        std::to_string(documents.size()) +
                        " (---) is another camera than the first; keep the one that the images "
                        "were taken with");
  return camera;
}

Camera read_camera_info(const std::filesystem::path& file, bool rectified) {
  return parse_camera_info(read_text(file, max_camera_info_bytes), file, rectified);
}

}  // namespace penumbra::io
