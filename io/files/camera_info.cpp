// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file-inl.hpp>

#include <io/files/camera_info.hpp>
#include <io/files/camera_info_fields-inl.hpp>
#include <io/files/yaml.hpp>

namespace penumbra::io {
namespace {

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

std::string frame_of(const YamlNode& root) {
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

/// Where the values stand in the two forms of the file.
class InfoFile final : public CameraInfoFields {
 public:
  explicit InfoFile(const YamlNode& root) : root_(root), calibration_(is_calibration(root)) {
    if (calibration_)
      root.allow_only({"image_width", "image_height", "camera_name", "camera_matrix",
                       "distortion_model", "distortion_coefficients", "rectification_matrix",
                       "projection_matrix"});
    else
      root.allow_only({"header", "frame_id", "width", "height", "distortion_model", "d", "k", "r",
                       "p", "D", "K", "R", "P", "binning_x", "binning_y", "roi"});
  }

  [[nodiscard]] InfoValue<std::int64_t> width() const override {
    return integer(root_.at(calibration_ ? "image_width" : "width"));
  }
  [[nodiscard]] InfoValue<std::int64_t> height() const override {
    return integer(root_.at(calibration_ ? "image_height" : "height"));
  }
  [[nodiscard]] InfoValue<std::string> distortion_model() const override {
    const YamlNode& node = root_.at("distortion_model");
    return {{&node}, node.text_or_empty()};
  }
  [[nodiscard]] InfoMatrix k() const override { return get("camera_matrix", "k", "K"); }
  [[nodiscard]] InfoMatrix d() const override { return get("distortion_coefficients", "d", "D"); }
  [[nodiscard]] InfoMatrix r() const override { return get("rectification_matrix", "r", "R"); }
  [[nodiscard]] InfoMatrix p() const override { return get("projection_matrix", "p", "P"); }
  [[nodiscard]] InfoValue<std::int64_t> binning_x() const override {
    return pixels(root_, "binning_x");
  }
  [[nodiscard]] InfoValue<std::int64_t> binning_y() const override {
    return pixels(root_, "binning_y");
  }

  [[nodiscard]] std::optional<InfoWindow> roi() const override {
    const YamlNode* roi = root_.find("roi");
    if (roi == nullptr) return std::nullopt;
    roi->allow_only({"x_offset", "y_offset", "width", "height", "do_rectify"});
    const YamlNode* do_rectify = roi->find("do_rectify");
    return InfoWindow{{roi},
                      pixels(*roi, "x_offset"),
                      pixels(*roi, "y_offset"),
                      pixels(*roi, "width"),
                      pixels(*roi, "height"),
                      {{do_rectify}, do_rectify != nullptr && do_rectify->boolean()}};
  }

  [[nodiscard]] std::string frame_id() const override { return frame_of(root_); }

 private:
  static bool is_calibration(const YamlNode& root) {
    return root.find("image_width") != nullptr || root.find("image_height") != nullptr ||
           root.find("camera_matrix") != nullptr;
  }

  static InfoValue<std::int64_t> integer(const YamlNode& node) { return {{&node}, node.integer()}; }

  /// 0 where the key is missing.
  static InfoValue<std::int64_t> pixels(const YamlNode& map, std::string_view key) {
    const YamlNode* node = map.find(key);
    return node != nullptr ? integer(*node) : InfoValue<std::int64_t>{{&map}, 0};
  }

  [[nodiscard]] InfoMatrix get(std::string_view of_calibration, std::string_view of_message,
                               std::string_view of_ros1) const {
    if (calibration_) {
      const YamlNode& node = root_.at(of_calibration);
      return {{&node}, matrix(node)};
    }
    const YamlNode& node = at_either(root_, of_message, of_ros1);
    return {{&node}, node.numbers()};
  }

  const YamlNode& root_;
  bool calibration_;
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
  Camera camera = camera_of(InfoFile(documents.front()), rectified);
  for (std::size_t i = 1; i < documents.size(); ++i)
    if (!is_same(camera, camera_of(InfoFile(documents[i]), rectified)))
      documents[i].fail("document " + std::to_string(i + 1) + " of " +
                        std::to_string(documents.size()) +
                        " (---) is another camera than the first; keep the one that the images "
                        "were taken with");
  return camera;
}

Camera read_camera_info(const std::filesystem::path& file, bool rectified) {
  return parse_camera_info(read_whole_file(file, FileLimit::text), file, rectified);
}

}  // namespace penumbra::io
