// SPDX-License-Identifier: Apache-2.0
#include <python/bindings.hpp>
#include <python/fields.hpp>
#include <python/targets.hpp>

#include <io/files/coco_mask.hpp>

namespace penumbra::python {

PixelMask pixel_mask_of(const py::object& source, const char* argument) {
  const py::object array = is_bool(source) ? source.attr("view")("uint8") : source;
  static constexpr PixelType types[] = {pixel_type<std::uint8_t>};
  (void)check_image(array, argument, types);
  auto kept = py::reinterpret_borrow<py::array>(array);
  const auto view = view_of<std::uint8_t>(kept);
  return {{view, owner_of(std::move(kept))}};
}

namespace {

void bind_masks(py::module_& m) {
  py::class_<PixelMask> mask(m, "PixelMask",
                             "The pixels that are not 0 in an image of the report's size.");
  mask.def(py::init([](const MaskSource& of) { return pixel_mask_of(of, "mask (bool or uint8)"); }),
           py::arg("mask"),
           "The mask is looked at where it lies, whenever a frame is judged: do not change it "
           "meanwhile.");
  show_properties(
      mask, Field{"mask", [](const PixelMask& of) { return array_of(of.mask.view, of.mask.owner); },
                  "The array, as uint8."});
  py::class_<RunLengthMask> runs(
      m, "RunLengthMask",
      "COCO's run-length mask: columns from top to bottom, from left to right; runs of pixels "
      "outside and inside by turns, the first of them outside.");
  using R = RunLengthMask;
  bind_fields<3>(runs, Field{"width", &R::width, "Pixels, of the report's images."},
                 Field{"height", &R::height, "Pixels, of the report's images."},
                 Field{"counts", &R::counts, "Pixels of each run."});
  runs.def(
      py::init([](int width, int height, const std::variant<std::string, py::bytes>& counts) {
        // A string's caster takes bytes, too.
        auto decoded = io::decoded_counts(std::get<std::string>(counts));
        if (!decoded) throw InputError("counts: damaged run lengths");
        return R{width, height, *std::move(decoded)};
      }),
      py::arg("width"), py::arg("height"), py::arg("counts"),
      "Of compressed run lengths, as pycocotools and FrameReport.coco_annotation() have them.");
  py::class_<RenderedRegion> rendered(
      m, "RenderedRegion",
      "An object that was rendered alone: where its depth is > 0, which is also its "
      "expected depth, metres.");
  rendered.def(py::init([](const ImageArgument<"depth", float>& depth) {
                 return RenderedRegion{{std::get<0>(depth.view), owner_of(depth.array)}};
               }),
               py::arg("depth"), "Of the report's size; looked at where it lies.");
  show_properties(rendered, Field{"depth",
                                  [](const RenderedRegion& of) {
                                    return array_of(of.depth.view, of.depth.owner);
                                  },
                                  "The array."});
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
  py::class_<PixelPolygon>(
      m, "PixelPolygon",
      "The pixels whose centres the outline winds around, in either direction. It may cross "
      "itself.")
      .def(py::init([](const CornerSource& corners) { return PixelPolygon{corners_of(corners)}; }),
           py::arg("corners"), "(u, v) each, pixels, in either order.");
  py::class_<PixelEllipse> ellipse(m, "PixelEllipse",
                                   "The pixels whose centres lie inside an ellipse or on it.");
  using E = PixelEllipse;
  bind_fields<2>(ellipse, Field{"centre", &E::centre, "(u, v), pixels."},
                 Field{"semi_axes", &E::semi_axes, "Pixels, > 0."},
                 Field{"angle", &E::angle, "Radians from +u to +v: of the first semi-axis."});
}

}  // namespace

void bind_regions(py::module_& m) {
  bind_outlines(m);
  bind_masks(m);
  m.def("check_region", &check_region, py::arg("region"), py::arg("width"), py::arg("height"),
        "Raises InputError for a region that is invalid in an image of that size.");
}

}  // namespace penumbra::python
