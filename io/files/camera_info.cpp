// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file-inl.hpp>

#include <io/files/camera_info.hpp>
#include <io/files/yaml.hpp>

namespace penumbra::io {
namespace {

/// A camera_info file in one of its two forms.
class InfoFile {
 public:
  explicit InfoFile(const YamlNode& root)
      : root_(root),
        is_calibration_(root.find("image_width") != nullptr ||
                        root.find("image_height") != nullptr ||
                        root.find("camera_matrix") != nullptr) {
    if (is_calibration_)
      root.allow_only({"image_width", "image_height", "camera_name", "camera_matrix",
                       "distortion_model", "distortion_coefficients", "rectification_matrix",
                       "projection_matrix"});
    else
      root.allow_only({"header", "frame_id", "width", "height", "distortion_model", "d", "k", "r",
                       "p", "D", "K", "R", "P", "binning_x", "binning_y", "roi"});
  }

  [[nodiscard]] Camera camera(bool rectified) const {
    CameraInfoFields info{.width = at("width").integer(), .height = at("height").integer()};
    if (rectified) {
      info.r = matrix("r");
      info.p = matrix("p");
    } else {
      info.k = matrix("k");
      info.distortion_model = at("distortion_model").text_or_empty();
      info.d = matrix("d");
    }
    info.binning_x = pixels(root_, "binning_x");
    info.binning_y = pixels(root_, "binning_y");
    if (const YamlNode* roi = root_.find("roi")) info.roi = window(*roi);
    info.frame_id = frame_id();
    info.fail = [this](const std::string& field, const std::string& what) { at(field).fail(what); };
    return camera_of(info, rectified);
  }

 private:
  /// Returns the value of a field, which each form spells in its own way.
  [[nodiscard]] const YamlNode& at(const std::string& field) const {
    static const std::map<std::string, const char*> in_calibration{
        {"width", "image_width"},
        {"height", "image_height"},
        {"k", "camera_matrix"},
        {"d", "distortion_coefficients"},
        {"r", "rectification_matrix"},
        {"p", "projection_matrix"},
        {"distortion_model", "distortion_model"}};
    static const std::map<std::string, const char*> in_ros1{
        {"k", "K"}, {"d", "D"}, {"r", "R"}, {"p", "P"}};
    if (is_calibration_) return root_.at(in_calibration.at(field));
    if (field.starts_with("roi.")) {
      const YamlNode* value = root_.at("roi").find(field.substr(4));
      return value != nullptr ? *value : root_.at("roi");
    }
    const auto ros1 = in_ros1.find(field);
    const YamlNode* other = ros1 != in_ros1.end() ? root_.find(ros1->second) : nullptr;
    if (other == nullptr) return root_.at(field);
    if (root_.find(field) != nullptr) other->fail("key '" + field + "' is there too; keep one");
    return *other;
  }

  /// Returns a list of numbers, or the data of camera_calibration's {rows, cols, data}.
  [[nodiscard]] std::vector<double> matrix(const std::string& field) const {
    const YamlNode& node = at(field);
    if (!is_calibration_) return node.numbers();
    node.allow_only({"rows", "cols", "data"});
    const std::int64_t rows = node.at("rows").integer(), cols = node.at("cols").integer();
    std::vector<double> values = node.at("data").numbers();
    const auto count = static_cast<std::int64_t>(values.size());
    if (rows < 0 || cols < 0 || rows > count || cols > count + 1 || rows * cols != count)
      node.at("data").fail("has " + std::to_string(count) + " values; rows x cols are " +
                           std::to_string(rows) + " x " + std::to_string(cols));
    return values;
  }

  static std::int64_t pixels(const YamlNode& map, const char* key) {
    const YamlNode* node = map.find(key);
    return node != nullptr ? node->integer() : 0;
  }

  static CameraInfoFields::Window window(const YamlNode& roi) {
    roi.allow_only({"x_offset", "y_offset", "width", "height", "do_rectify"});
    const YamlNode* do_rectify = roi.find("do_rectify");
    return {pixels(roi, "x_offset"), pixels(roi, "y_offset"), pixels(roi, "width"),
            pixels(roi, "height"), do_rectify != nullptr && do_rectify->boolean()};
  }

  [[nodiscard]] std::string frame_id() const {
    const YamlNode* own = root_.find("frame_id");
    if (const YamlNode* header = root_.find("header")) {
      header->allow_only({"seq", "stamp", "frame_id"});
      const YamlNode* in_header = header->find("frame_id");
      if (own != nullptr && in_header != nullptr)
        own->fail("header.frame_id is there too; keep one");
      if (in_header != nullptr) own = in_header;
    }
    return own != nullptr ? own->text_or_empty() : std::string();
  }

  const YamlNode& root_;
  bool is_calibration_;
};

bool is_same(const Camera& a, const Camera& b) {
  return a.intrinsics == b.intrinsics && a.distortion == b.distortion && a.frame_id == b.frame_id;
}

}  // namespace

Camera parse_camera_info(const std::string& text, const std::filesystem::path& file,
                         bool rectified) {
  std::vector<YamlNode> documents = YamlNode::parse_all(text, file);
  // ros2 topic echo ends every message with the mark of a next document.
  while (documents.size() > 1 && documents.back().is_null()) documents.pop_back();
  Camera camera = InfoFile(documents.front()).camera(rectified);
  for (std::size_t i = 1; i < documents.size(); ++i)
    if (!is_same(camera, InfoFile(documents[i]).camera(rectified)))
      documents[i].fail("document " + std::to_string(i + 1) + " of " +
                        std::to_string(documents.size()) +
                        " (---) describes another camera than the first; keep the one that took "
                        "the images");
  return camera;
}

Camera read_camera_info(const std::filesystem::path& file, bool rectified) {
  return parse_camera_info(read_whole_file(file, FileLimit::text), file, rectified);
}

}  // namespace penumbra::io
