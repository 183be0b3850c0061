// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file-inl.hpp>

#include <io/files/camera_info.hpp>
#include <io/files/printable.hpp>
#include <io/files/yaml.hpp>

namespace penumbra::io {
namespace {

using Names = std::vector<std::string_view>;

/// The names of each field: in dumps of the message of ROS 2 and ROS 1, in the files of
/// camera_calibration and OpenCV, kalibr's camchain and RealSense's JSON.
const std::map<std::string, Names>& names_of_fields() {
  static const std::map<std::string, Names> names{
      {"width", {"width", "image_width", "imageWidth", "resolution", "image_size", "imageSize"}},
      {"height",
       {"height", "image_height", "imageHeight", "resolution", "image_size", "imageSize"}},
      {"k", {"k", "K", "camera_matrix", "cameraMatrix", "intrinsics", "fx"}},
      {"d",
       {"d", "D", "distortion_coefficients", "distortion_coeffs", "dist_coeffs", "dist_coeff",
        "distCoeffs", "coeffs"}},
      {"r", {"r", "R", "rectification_matrix"}},
      {"p", {"p", "P", "projection_matrix"}},
      {"distortion_model", {"distortion_model", "model"}}};
  return names;
}

/// What a user adds where a field is missing.
const std::vector<std::pair<const char*, const char*>> examples{
    {"width", "width: 640"},
    {"height", "height: 480"},
    {"k", "k: [fx, 0, cx, 0, fy, cy, 0, 0, 1]"},
    {"distortion_model", "distortion_model: plumb_bob"},
    {"d", "d: [k1, k2, p1, p2, k3], all 0 for images without distortion"},
    {"r", "r: [1, 0, 0, 0, 1, 0, 0, 0, 1]"}};

bool is_camera(const YamlNode& node) {
  const auto has = [&](std::string_view name) {
    const YamlNode* const found = node.find(name);
    return found != nullptr && (name != "intrinsics" || found->is_list());
  };
  return std::ranges::any_of(names_of_fields(), [&](const auto& field) {
    return field.first != "distortion_model" && field.first != "r" &&
           std::ranges::any_of(field.second, has);
  });
}

/// Returns the only camera of a file, which may have a name there, as kalibr's cam0.
const YamlNode& only_camera(const YamlNode& root) {
  std::vector<const YamlNode*> found;
  if (root.is_map() && is_camera(root)) return root;
  if (root.is_map())
    for (const YamlNode& child : root.entries())
      if (child.is_map() && is_camera(child)) found.push_back(&child);
  if (found.size() > 1)
    root.fail("describes several cameras, " + printable(found[0]->key()) + " and " +
              printable(found[1]->key()) +
              "; write the one that took the images into a file alone");
  if (found.size() == 1) return *found[0];
  std::string all;
  for (const auto& [field, example] : examples)
    if (std::string_view(field) != "r") all += (all.empty() ? "" : "; ") + std::string(example);
  root.fail(
      "is no camera file that is known (ROS's camera_info, camera_calibration, OpenCV, "
      "kalibr, RealSense); write " +
      all);
}

/// Returns the name that Penumbra has for a lens model of RealSense's SDK or kalibr. `is_flat`: all
/// coefficients are 0.
std::string lens_name(std::string name, bool is_flat) {
  for (char& c : name) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
    if (c == ' ') c = '_';
  }
  const auto has = [&](std::string_view part) { return name.find(part) != std::string::npos; };
  if (has("inverse_brown") || has("modified_brown")) return is_flat ? "none" : name;
  if (has("brown_conrady") || name == "radtan") return "plumb_bob";
  if (has("kannala_brandt4")) return "equidistant";
  return has("distortion") ? name.substr(name.find_last_of("._") + 1) : name;
}

/// The description of one camera in a file.
class InfoFile {
 public:
  explicit InfoFile(const YamlNode& root) : root_(only_camera(root)) {
    constexpr std::string_view only_ros[] = {
        "k", "d", "r", "p", "header", "binning_x", "binning_y", "roi", "camera_name"};
    for (const std::string_view name : only_ros) is_ros_ |= root_.find(name) != nullptr;
    if (const YamlNode* const model = root_.find("camera_model"))
      if (model->text() != "pinhole")
        model->fail("is '" + printable(model->text()) + "'; only pinhole is supported");
    if (!is_ros_) return;  // others have many keys more, and a file without one needed is refused
    std::vector<std::string_view> known{"frame_id"};
    known.insert(known.end(), std::begin(only_ros), std::end(only_ros));
    for (const auto& [field, names] : names_of_fields())
      known.insert(known.end(), names.begin(), names.end());
    root_.allow_only(known);
  }

  [[nodiscard]] Camera camera(bool rectified) const {
    const bool has_p = find("p") != nullptr;
    require_all(rectified && has_p);
    CameraInfoFields info{.width = pixels_of("width", 0), .height = pixels_of("height", 1)};
    if (!rectified || !has_p) {
      info.k = matrix_k();
      read_lens(info);
    }
    if (rectified) set_rectified(info);
    info.binning_x = pixels(root_, "binning_x");
    info.binning_y = pixels(root_, "binning_y");
    if (const YamlNode* roi = root_.find("roi")) info.roi = window(*roi);
    info.frame_id = frame_id();
    info.fail = [this](const std::string& field, const std::string& what) { at(field).fail(what); };
    return camera_of(info, rectified);
  }

 private:
  /// Returns the value of a field, or null.
  [[nodiscard]] const YamlNode* find(const std::string& field) const {
    const YamlNode* found = nullptr;
    for (const std::string_view name : names_of_fields().at(field))
      if (const YamlNode* const other = root_.find(name)) {
        if (found != nullptr && name == "model") break;  // the camera's, as D435
        if (found != nullptr) other->fail("key '" + found->key() + "' is there too; keep one");
        found = other;
      }
    return found;
  }

  [[nodiscard]] const YamlNode& at(const std::string& field) const {
    if (field.starts_with("roi.")) {
      const YamlNode* value = root_.at("roi").find(field.substr(4));
      return value != nullptr ? *value : root_.at("roi");
    }
    const bool is_named = names_of_fields().contains(field);
    const YamlNode* const found = is_named ? find(field) : &root_.at(field);
    return found != nullptr ? *found : root_;
  }

  /// Names all that is missing at once.
  void require_all(bool from_p) const {
    std::string missing;
    for (const auto& [field, example] : examples) {
      const std::string name = field;
      const bool is_size = name == "width" || name == "height";
      const bool is_needed =
          is_size || (name == "r" ? from_p : !from_p && (name != "distortion_model" || is_ros_));
      if (is_needed && find(name) == nullptr && !(name == "d" && has_no_lens()))
        missing += (missing.empty() ? "" : "; ") + std::string(example);
    }
    if (!missing.empty()) root_.fail("is not complete; add " + missing);
  }

  [[nodiscard]] bool has_no_lens() const {
    const YamlNode* const model = find("distortion_model");
    return model != nullptr && !is_ros_ && lens_name(model->text_or_empty(), true) == "none";
  }

  [[nodiscard]] std::int64_t pixels_of(const std::string& field, std::size_t place) const {
    const YamlNode& node = at(field);
    if (!node.is_list()) return node.integer();
    if (node.items().size() != 2) node.fail("expected [width, height]");
    return node.items()[place].integer();
  }

  /// Returns k from a matrix, or from fx, fy, cx and cy.
  [[nodiscard]] std::vector<double> matrix_k() const {
    const YamlNode& node = at("k");
    if (node.key() == "fx") {
      const auto one_of = [&](const char* cv, const char* realsense) {
        const YamlNode* const found = root_.find(realsense);
        return (found != nullptr ? *found : root_.at(cv)).number();
      };
      const double cx = one_of("cx", "ppx"), cy = one_of("cy", "ppy");
      return {node.number(), 0, cx, 0, root_.at("fy").number(), cy, 0, 0, 1};
    }
    const std::vector<double> k = matrix("k");
    if (node.key() == "intrinsics" && k.size() == 4) return {k[0], 0, k[2], 0, k[1], k[3], 0, 0, 1};
    return k;
  }

  void read_lens(CameraInfoFields& info) const {
    if (find("d") != nullptr) info.d = matrix("d");
    const bool is_flat = std::ranges::all_of(info.d, [](double d) { return d == 0; });
    if (const YamlNode* const model = find("distortion_model")) {
      const std::string name = lens_name(model->text_or_empty(), is_flat);
      if (name.find("_brown_conrady") != std::string::npos)
        model->fail(
            "is not supported with coefficients other than 0; rectify the images and give "
            "zeros");
      info.distortion_model = name;
      return;
    }
    const YamlNode* const fisheye = root_.find("fisheye_model");
    if (fisheye != nullptr && fisheye->text() != "0")
      info.distortion_model = "equidistant";
    else if (info.d.size() == 4 && fisheye == nullptr)
      at("d").fail("has 4 values, of plumb_bob or equidistant (fisheye); add distortion_model");
    else if (at("k").key() == "fx" && !is_flat)
      at("d").fail("has no model; add distortion_model: plumb_bob, or another");
    else
      info.distortion_model = info.d.size() > 5 ? "rational_polynomial" : "plumb_bob";
  }

  /// Without a projection, that of an image without distortion is its camera matrix.
  void set_rectified(CameraInfoFields& info) const {
    if (find("p") != nullptr) {
      info.r = matrix("r");
      info.p = matrix("p");
      return;
    }
    const std::vector<double>& k = info.k;
    const bool is_none =
        at("d").with_context([&] { return Distortion(info.distortion_model, info.d).is_none(); });
    if (k.size() != 9 || !is_none)
      root_.fail(
          "describes images with distortion; for rectified ones add their projection, p: "
          "[fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0], and r: [1, 0, 0, 0, 1, 0, 0, 0, 1]");
    info.r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    info.p = {k[0], k[1], k[2], 0, k[3], k[4], k[5], 0, k[6], k[7], k[8], 0};
  }

  /// Returns a list of numbers or of rows, or the data of {rows, cols, data}.
  [[nodiscard]] std::vector<double> matrix(const std::string& field) const {
    const YamlNode& node = at(field);
    if (node.is_list()) {
      std::vector<double> values;
      for (const YamlNode& item : node.items())
        for (const double value : item.is_list() ? item.numbers() : std::vector{item.number()})
          values.push_back(value);
      return values;
    }
    node.allow_only({"rows", "cols", "data", "dt", "type_id"});
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
  bool is_ros_ = false;
};

bool is_same(const Camera& a, const Camera& b) {
  return a.intrinsics == b.intrinsics && a.distortion == b.distortion && a.frame_id == b.frame_id;
}

}  // namespace

Camera parse_camera_info(const std::string& text, const std::filesystem::path& file,
                         bool rectified) {
  if (text.starts_with('<'))
    throw InputError(file.string() +
                     ": is XML, which is not read; OpenCV writes YAML into a file *.yml");
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
