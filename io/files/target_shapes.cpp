// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <sstream>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/mesh/mesh_file.hpp>

#include <io/files/frame_pattern.hpp>
#include <io/files/names.hpp>
#include <io/files/png.hpp>
#include <io/files/target_shapes.hpp>

namespace penumbra::io {
namespace {

using MakeShape = std::function<TargetShape(const FrameValue&)>;

/// Refuses a shape that would make the target unknown in every frame.
void check(const TargetShape& shape, const Intrinsics& images) {
  check_shape(shape);
  if (const auto* target = std::get_if<RegionTarget>(&shape))
    check_region(target->region, images.width(), images.height());
}

/// Returns shapes made from a frame's numbers. The numbers in the YAML file are checked at once.
ShapeSource source_of(const TargetReader& reader, const YamlNode& node, const ValueFormat& format,
                      const MakeShape& make) {
  const auto values = reader.values(
      node, format, [&](const FrameValue& value) { check(make(value), reader.context.images); });
  return {[=](std::int64_t index, Target& target) {
            const FrameValue value = values->at(index);
            target.shape = made_of(value, make);
            target.stamp = value.stamp;
          },
          values->has_stamps()};
}

std::optional<double> depth_of(const YamlNode& node) {
  const YamlNode* depth = node.find("expected_depth");
  return depth == nullptr ? std::nullopt : std::optional(positive_number(*depth));
}

/// Returns a region with the common settings, and the value's own depth if it has one.
RegionTarget region_target(const RegionTarget& common, Region region, const FrameValue& value) {
  RegionTarget target = common;
  target.region = std::move(region);
  if (value.expected_depth) target.expected_depth = value.expected_depth;
  return target;
}

ShapeSource read_box(const TargetReader& reader, const YamlNode& node) {
  return source_of(reader, node, fixed_format({"u", "v", "width", "height"}),
                   [common = region_settings(reader.node, Extent::amodal)](
                       const FrameValue& value) -> TargetShape {
                     const auto& n = value.numbers;
                     if (!(n[2] > 0.0 && n[3] > 0.0))
                       throw InputError("has no area; expected width and height above 0");
                     return region_target(common, PixelBox{n[0], n[1], n[2], n[3]}, value);
                   });
}

std::vector<double> corners_of(const YamlNode& node) {
  std::vector<double> numbers;
  for (const YamlNode& corner : node.items())
    for (const double number : corner.numbers(2)) numbers.push_back(number);
  if (numbers.size() < 6) node.fail("has fewer than 3 corners; expected [[u, v], ...]");
  return numbers;
}

ShapeSource read_polygon(const TargetReader& reader, const YamlNode& node) {
  return source_of(reader, node, {corners_of, {}, {}},
                   [common = region_settings(reader.node, Extent::amodal)](
                       const FrameValue& value) -> TargetShape {
                     PixelPolygon polygon;
                     for (std::size_t i = 0; i + 1 < value.numbers.size(); i += 2)
                       polygon.corners.emplace_back(value.numbers[i], value.numbers[i + 1]);
                     return region_target(common, std::move(polygon), value);
                   });
}

/// Reads {size: [height, width], counts: [...]}. Returns height, width and the counts.
std::vector<double> run_lengths_of(const YamlNode& node) {
  node.allow_only({"size", "counts"});
  std::vector<double> numbers = node.at("size").numbers(2);
  for (const YamlNode& count : node.at("counts").items()) {
    const std::int64_t pixels = count.integer();
    if (pixels < 0 || pixels > std::numeric_limits<std::uint32_t>::max())
      count.fail("is " + count.text() + "; expected a number of pixels");
    numbers.push_back(static_cast<double>(pixels));
  }
  return numbers;
}

ShapeSource read_run_lengths(const TargetReader& reader, const YamlNode& node) {
  const Intrinsics images = reader.context.images;
  return source_of(reader, node, {run_lengths_of, {}, {}},
                   [=, common = region_settings(reader.node, Extent::amodal)](
                       const FrameValue& value) -> TargetShape {
                     const auto& n = value.numbers;
                     if (n[0] != images.height() || n[1] != images.width())
                       throw InputError("is of another size; expected [" +
                                        std::to_string(images.height()) + ", " +
                                        std::to_string(images.width()) + "] (height, width)");
                     RunLengthMask runs{images.width(), images.height(), {}};
                     double pixels = 0.0;
                     for (std::size_t i = 2; i < n.size(); ++i) {
                       runs.counts.push_back(static_cast<std::uint32_t>(n[i]));
                       pixels += n[i];
                     }
                     if (pixels != n[0] * n[1])
                       throw InputError("counts add up to " + std::to_string(std::llround(pixels)) +
                                        "; expected all pixels of the image");
                     return region_target(common, std::move(runs), value);
                   });
}

ShapeSource read_mask(const TargetReader& reader, const YamlNode& node) {
  const ImageSize size{reader.context.images.width(), reader.context.images.height()};
  const auto read = [size, common = region_settings(reader.node, Extent::amodal)](
                        const std::filesystem::path& file) -> TargetShape {
    auto mask = std::make_shared<Image<std::uint8_t>>();
    read_png(file, *mask, size).require();
    return region_target(common,
                         PixelMask{Shared<ImageView<const std::uint8_t>>(
                             std::shared_ptr<const Image<std::uint8_t>>(std::move(mask)))},
                         FrameValue{});
  };
  if (!node.is_map()) {
    TargetShape given;
    node.with_context([&] {
      given = read(reader.folder / node.text());
      check(given, reader.context.images);
    });
    return {[given](std::int64_t, Target& target) { target.shape = given; }};
  }
  node.allow_only({"files"});
  const YamlNode& files = node.at("files");
  const FramePattern pattern = files.with_context(
      [&] { return FramePattern(files.text(), reader.folder, reader.context.stamps); });
  if (pattern.existing().empty()) files.fail("no file of that name for any frame");
  return {[=](std::int64_t index, Target& target) { target.shape = read(pattern.file(index)); }};
}

/// Reads semi-axes and angle of a key point from `radius` or `ellipse`, in pixels, or with _m in
/// metres.
void read_ellipse(const YamlNode& node, KeypointTarget& target) {
  constexpr std::array keys{"radius", "ellipse", "radius_m", "ellipse_m"};
  const YamlNode* given = nullptr;
  for (const char* const key : keys) {
    const YamlNode* found = node.find(key);
    if (found == nullptr) continue;
    if (given != nullptr) found->fail("cannot be combined with " + given->key() + "; keep one");
    given = found;
  }
  if (given == nullptr) return;
  target.in_metres = given->key().ends_with("_m");
  if (given->key().starts_with("radius")) {
    target.semi_axes.setConstant(positive_number(*given));
    return;
  }
  const std::vector<double> ellipse = given->numbers(3);
  if (!(ellipse[0] > 0.0 && ellipse[1] > 0.0))
    given->fail("has no area; expected [a, b, angle] with a and b above 0");
  target.semi_axes = {ellipse[0], ellipse[1]};
  target.angle = ellipse[2] * std::numbers::pi / 180.0;
}

ShapeSource read_keypoint(const TargetReader& reader, const YamlNode& node) {
  KeypointTarget common;
  read_ellipse(reader.node, common);
  common.expected_depth = depth_of(reader.node);
  ValueFormat format = fixed_format({"u", "v"}, {"score"});
  if (const YamlNode* score = reader.node.find("min_score")) {
    common.min_score = score->number();
    format = fixed_format({"u", "v", "score"});
  }
  return source_of(reader, node, format, [common](const FrameValue& value) -> TargetShape {
    KeypointTarget target = common;
    target.pixel = {value.numbers[0], value.numbers[1]};
    if (value.numbers.size() > 2) target.score = value.numbers[2];
    if (value.expected_depth) target.expected_depth = value.expected_depth;
    return target;
  });
}

ShapeSource read_point(const TargetReader& reader, const YamlNode& node) {
  PointTarget common;
  common.frame = link_of(reader.node, reader.context.robot);
  if (const YamlNode* radius = reader.node.find("radius")) common.radius = positive_number(*radius);
  return source_of(reader, node, fixed_format({"x", "y", "z"}),
                   [common](const FrameValue& value) -> TargetShape {
                     PointTarget target = common;
                     target.position = position_of(value.numbers);
                     return target;
                   });
}

ShapeSource read_object_box(const TargetReader& reader, const YamlNode& node) {
  BoxTarget common;
  common.frame = link_of(reader.node, reader.context.robot);
  const YamlNode& size = reader.node.at("size");
  const std::vector<double> edges = size.numbers(3);
  if (!(edges[0] > 0.0 && edges[1] > 0.0 && edges[2] > 0.0))
    size.fail("has an edge that is not above 0; expected metres");
  common.size = position_of(edges);
  return source_of(reader, node, pose_format(), [common](const FrameValue& value) -> TargetShape {
    BoxTarget target = common;
    target.pose = isometry_of(value.numbers);
    return target;
  });
}

/// Refuses meshes that float32 depths cannot represent.
void check_extent(const TriangleMesh& mesh, const YamlNode& blamed) {
  constexpr double least = 1e-6;  // metres
  double farthest = 0.0;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    if (!vertex.allFinite())
      blamed.fail(
          "makes the mesh larger than numbers of 32 bits; its extent must be 1e-6 to 1e6 m");
    farthest = std::max(farthest, static_cast<double>(vertex.cwiseAbs().maxCoeff()));
    box.extend(vertex.cast<double>());
  }
  const double extent = box.isEmpty() ? 0.0 : box.sizes().maxCoeff();
  if (extent >= least && extent <= max_target_distance && farthest <= max_target_distance) return;
  std::ostringstream text;
  text << "makes a mesh of " << extent << " m that reaches " << farthest
       << " m from its origin; expected an extent of 1e-6 to 1e6 m, at most as far out";
  blamed.fail(text.str());
}

std::shared_ptr<const PreparedMesh> mesh_of(const TargetReader& reader) {
  const YamlNode& file = reader.node.at("file");
  TriangleMesh mesh;
  file.with_context([&] { mesh = load_mesh(reader.folder / file.text()); });
  const YamlNode* scale = reader.node.find("scale");
  if (scale != nullptr) {
    const double factor = positive_number(*scale);
    for (Eigen::Vector3f& vertex : mesh.vertices)
      vertex = (factor * vertex.cast<double>()).cast<float>();
  }
  check_extent(mesh, scale != nullptr ? *scale : file);
  return std::make_shared<const PreparedMesh>(mesh);
}

ShapeSource read_mesh(const TargetReader& reader, const YamlNode& node) {
  MeshTarget common;
  common.frame = link_of(reader.node, reader.context.robot);
  common.mesh = mesh_of(reader);
  return source_of(reader, node, pose_format(), [common](const FrameValue& value) -> TargetShape {
    MeshTarget target = common;
    target.pose = isometry_of(value.numbers);
    return target;
  });
}

/// A kind of target: its key, how it is read, and which keys belong to it.
struct ShapeKind {
  std::string_view key;
  ShapeSource (*read)(const TargetReader&, const YamlNode&);
  bool has_pixels;
  bool has_pose;
  std::vector<std::string_view> keys;
};

const std::vector<ShapeKind>& kinds() {
  static const std::vector<ShapeKind> all{
      {"box", read_box, true, false, {"extent", "expected_depth", "height"}},
      {"polygon", read_polygon, true, false, {"extent", "expected_depth", "height"}},
      {"mask", read_mask, true, false, {"extent", "expected_depth", "height"}},
      {"rle", read_run_lengths, true, false, {"extent", "expected_depth", "height"}},
      {"keypoint",
       read_keypoint,
       true,
       false,
       {"radius", "ellipse", "radius_m", "ellipse_m", "min_score", "expected_depth"}},
      {"point", read_point, false, false, {"radius", "link"}},
      {"box3d", read_object_box, false, true, {"size", "link"}},
      {"mesh", read_mesh, false, true, {"file", "scale", "link"}}};
  return all;
}

constexpr std::array<std::string_view, 6> common_keys{"name",       "frame_id", "depth_margin",
                                                      "thresholds", "handling", "estimate"};

}  // namespace

ReferenceFrame link_of(const YamlNode& node, const Robot& robot) {
  const YamlNode* link = node.find("link");
  if (link == nullptr) return {};
  if (const auto index = robot.find_link(link->text()))
    return ReferenceFrame::of_link(robot.links()[*index]);
  const std::vector<std::string_view> known(robot.links().begin(), robot.links().end());
  link->fail("'" + link->text() + "' is no link of the robot" + near_names(link->text(), known));
}

double positive_number(const YamlNode& node) {
  const double value = node.number();
  if (value > 0.0) return value;
  node.fail("is " + node.text() + "; expected a positive number");
}

RegionTarget region_settings(const YamlNode& node, Extent extent) {
  if (const YamlNode* given = node.find("extent")) {
    if (given->text() != "amodal" && given->text() != "modal")
      given->fail("is '" + given->text() + "'; expected amodal or modal");
    extent = given->text() == "modal" ? Extent::modal : Extent::amodal;
  }
  const YamlNode* const height = node.find("height");
  return {.region = {},
          .extent = extent,
          .expected_depth = depth_of(node),
          .height = height == nullptr ? std::nullopt : std::optional(positive_number(*height))};
}

bool names_pixels(const YamlNode& target) {
  return std::any_of(kinds().begin(), kinds().end(), [&](const ShapeKind& kind) {
    return kind.has_pixels && target.find(kind.key) != nullptr;
  });
}

ShapeSource read_shape(const TargetReader& reader) {
  const ShapeKind* chosen = nullptr;
  for (const ShapeKind& kind : kinds()) {
    const YamlNode* found = reader.node.find(kind.key);
    if (found == nullptr) continue;
    if (chosen != nullptr)
      found->fail("cannot be combined with " + std::string(chosen->key) +
                  "; a target has one of them");
    chosen = &kind;
  }
  if (chosen == nullptr) {
    std::string known;
    for (const ShapeKind& kind : kinds())
      known += (known.empty() ? "" : ", ") + std::string(kind.key);
    reader.node.fail("target '" + reader.name + "' has no place; expected one of the keys " +
                     known);
  }
  std::vector<std::string_view> known(common_keys.begin(), common_keys.end());
  known.push_back(chosen->key);
  known.insert(known.end(), chosen->keys.begin(), chosen->keys.end());
  reader.node.allow_only(known);
  ShapeSource source = chosen->read(reader, reader.node.at(chosen->key));
  source.has_pose = chosen->has_pose;
  return source;
}

}  // namespace penumbra::io
