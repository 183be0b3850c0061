// SPDX-License-Identifier: Apache-2.0
#include <python/bindings.hpp>
#include <python/fields.hpp>
#include <python/targets.hpp>

namespace penumbra::python {

Region region_of(const OwnedRegion& region) {
  struct Viewed {
    Region operator()(const PixelBox& box) const { return box; }
    Region operator()(const Polygon& polygon) const { return PixelPolygon{polygon.corners}; }
    Region operator()(const Mask& mask) const { return PixelMask{mask.view}; }
    Region operator()(const RunLengths& runs) const {
      return RunLengthMask{runs.width, runs.height, runs.counts};
    }
    Region operator()(const PixelEllipse& ellipse) const { return ellipse; }
    Region operator()(const Rendered& rendered) const { return RenderedRegion{rendered.view}; }
  };
  return std::visit(Viewed{}, region);
}

namespace {

/// NumPy's masks are mostly of bool, whose bytes are 0 and 1.
Mask mask_of(const py::object& source) {
  py::object array = source;
  if (py::isinstance<py::array>(source) &&
      py::array(source).dtype().num() == py::dtype::of<bool>().num())
    array = source.attr("view")("uint8");
  static constexpr PixelType types[] = {pixel_type<std::uint8_t>};
  (void)check_image(array, "mask (bool or uint8)", types);
  auto kept = py::reinterpret_borrow<py::array>(array);
  const auto view = view_of<std::uint8_t>(kept);
  return {std::move(kept), view};
}

void bind_masks(py::module_& m) {
  py::class_<Mask> mask(m, "PixelMask",
                        "The pixels that are not 0 in an image of the report's size.");
  mask.def(py::init([](const MaskSource& of) { return mask_of(of); }), py::arg("mask"),
           "The mask is looked at where it lies, whenever a frame is judged: do not change it "
           "meanwhile.");
  show_properties(mask,
                  Field{"mask", [](const Mask& of) { return ImageResult<std::uint8_t>{of.array}; },
                        "The array itself, as uint8."});
  py::class_<RunLengths> runs(
      m, "RunLengthMask",
      "COCO's run-length mask: columns from top to bottom, from left to right; runs of pixels "
      "outside and inside by turns, the first of them outside.");
  using R = RunLengths;
  bind_fields<3>(runs, Field{"width", &R::width, "Pixels, of the report's images."},
                 Field{"height", &R::height, "Pixels, of the report's images."},
                 Field{"counts", &R::counts, "Pixels of each run."});
  py::class_<Rendered> rendered(
      m, "RenderedRegion",
      "An object that was rendered alone: where its depth is > 0, which is also its "
      "expected depth, metres.");
  rendered.def(py::init([](const ImageArgument<"depth", float>& depth) {
                 return Rendered{depth.array, std::get<0>(depth.view)};
               }),
               py::arg("depth"), "Of the report's size; looked at where it lies.");
  show_properties(rendered,
                  Field{"depth", [](const Rendered& of) { return ImageResult<float>{of.array}; },
                        "The array itself."});
}

std::vector<Eigen::Vector2d> corners_of(const py::object& source) {
  constexpr py::ssize_t shape[] = {-1, 2};
  const auto array = numbers_of(source, shape, "corners (u, v)");
  std::vector<Eigen::Vector2d> corners;
  for (py::ssize_t i = 0; i < array.shape(0); ++i)
    corners.emplace_back(array.at(i, 0), array.at(i, 1));
  return corners;
}

void bind_outlines(py::module_& m) {
  py::class_<PixelBox> box(m, "PixelBox",
                           "The pixels whose centres lie in [u, u + width) x [v, v + height).");
  using B = PixelBox;
  bind_fields<4>(box, Field{"u", &B::u, "Pixels."}, Field{"v", &B::v, "Pixels."},
                 Field{"width", &B::width, "Pixels."}, Field{"height", &B::height, "Pixels."});
  py::class_<Polygon>(
      m, "PixelPolygon",
      "The pixels whose centres the outline winds around, in either direction. It may cross "
      "itself.")
      .def(py::init([](const CornerSource& corners) { return Polygon{corners_of(corners)}; }),
           py::arg("corners"), "(u, v) each, pixels, in either order.");
  py::class_<PixelEllipse> ellipse(m, "PixelEllipse",
                                   "The pixels whose centres lie inside an ellipse or on it.");
  using E = PixelEllipse;
  bind_fields(ellipse, Field{"centre", &E::centre, "(u, v), pixels."},
              Field{"semi_axes", &E::semi_axes, "Pixels, > 0."},
              Field{"angle", &E::angle, "Radians from +u to +v: of the first semi-axis."});
}

}  // namespace

void bind_regions(py::module_& m) {
  bind_outlines(m);
  bind_masks(m);
  m.def(
      "check_region",
      [](const OwnedRegion& region, int width, int height) {
        check_region(region_of(region), width, height);
      },
      py::arg("region"), py::arg("width"), py::arg("height"),
      "Raises InputError for a region that is invalid in an image of that size.");
}

}  // namespace penumbra::python
