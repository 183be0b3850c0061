// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <span>

#include <python/arrays.hpp>
#include <python/bindings.hpp>
#include <python/fields.hpp>

#include <penumbra/camera/camera.hpp>
#include <penumbra/camera/rectification.hpp>
#include <penumbra/camera/registration.hpp>

#include <io/files/camera_info.hpp>
#include <io/files/pose_file.hpp>

namespace penumbra::python {
namespace {

void bind_intrinsics(py::module_& m) {
  py::class_<Intrinsics> intrinsics(
      m, "Intrinsics",
      "A pinhole camera's image size and projection, pixels. The centre of pixel (u, v) has "
      "integer coordinates; its ray is ((u - cx) / fx, (v - cy) / fy, 1) in the optical frame: x "
      "right, y down, z forward.");
  intrinsics
      .def(py::init<int, int, double, double, double, double>(), py::arg("width"),
           py::arg("height"), py::arg("fx"), py::arg("fy"), py::arg("cx"), py::arg("cy"),
           "Raises InputError for sizes or focal lengths out of bounds.")
      .def("binned", &Intrinsics::binned, py::arg("bx"), py::arg("by"),
           "The camera whose pixels each cover bx x by of this one's.")
      .def("cropped", &Intrinsics::cropped, py::arg("x"), py::arg("y"), py::arg("width"),
           py::arg("height"), "The camera of a window that starts at (x, y).")
      .def("ray", &Intrinsics::ray, py::arg("u"), py::arg("v"),
           "The ray of an image point in the optical frame, with z = 1.")
      .def(
          "project",
          [](const Intrinsics& self, const Eigen::Vector3d& point) {
            if (!(point.z() > 0.0)) throw InputError("point: z must be above 0");
            return self.project(point);
          },
          py::arg("point"),
          "Image point (u, v) of a point in the optical frame, metres. Raises InputError for one "
          "that is not before the camera.")
      .def(
          "__eq__", [](const Intrinsics& a, const Intrinsics& b) { return a == b; },
          py::is_operator());
  intrinsics.attr("__hash__") = py::none();
  using K = Intrinsics;
  show_fields(intrinsics, Field{"width", &K::width, "Pixels."},
              Field{"height", &K::height, "Pixels."}, Field{"fx", &K::fx, "Focal length, pixels."},
              Field{"fy", &K::fy, "Focal length, pixels."},
              Field{"cx", &K::cx, "Principal point, pixels."},
              Field{"cy", &K::cy, "Principal point, pixels."});
}

void bind_distortion(py::module_& m) {
  py::class_<Distortion> distortion(
      m, "Distortion",
      "How a lens bends rays. Points are on the plane z = 1 of the optical frame.");
  distortion.def(py::init<>(), "None.")
      .def(py::init([](const std::string& name, const std::vector<double>& coefficients) {
             return Distortion(name, coefficients);
           }),
           py::arg("name"), py::arg("coefficients"),
           "By ROS's names: plumb_bob (4 or 5 coefficients), rational_polynomial (8), equidistant "
           "(4). Raises InputError for an unknown name or a wrong number of coefficients.")
      .def("distort", &Distortion::distort, py::arg("undistorted"),
           "Where the lens puts the ray through the point.")
      .def("undistort", &Distortion::undistort, py::arg("distorted"),
           "The undistorted point, or None if the lens maps no point there.");
  using D = Distortion;
  show_fields(distortion, Field{"model", &D::model, "The lens model."},
              Field{"coefficients", &D::coefficients, "In the order of its name's; none: empty."},
              Field{"is_none", &D::is_none, "Whether rays stay straight."},
              Field{"max_radius", &D::max_radius,
                    "Largest undistorted radius up to which the model is one-to-one."});
}

/// By how many coefficients there are, as OpenCV does.
Distortion distortion_of(const std::vector<double>& coefficients) {
  if (coefficients.empty()) return {};
  return Distortion(coefficients.size() == 8 ? "rational_polynomial" : "plumb_bob", coefficients);
}

using OptionalPose = std::optional<Eigen::Isometry3d>;

Camera camera_from_matrix(const Eigen::Matrix3d& K, std::pair<int, int> size,
                          const std::vector<double>& D, std::string parent,
                          const OptionalPose& T_parent_camera) {
  Eigen::Matrix3d rest = K;
  rest(0, 0) = rest(1, 1) = rest(0, 2) = rest(1, 2) = 0.0;
  if (rest != Eigen::Vector3d(0, 0, 1).asDiagonal().toDenseMatrix())
    throw py::value_error("K: expected [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]");
  return {Intrinsics(size.first, size.second, K(0, 0), K(1, 1), K(0, 2), K(1, 2)),
          distortion_of(D),
          {},
          {},
          std::move(parent),
          T_parent_camera};
}

void bind_camera_class(py::module_& m) {
  py::class_<DepthRange> range(
      m, "DepthRange",
      "The sensor's own range: depths outside of it are no measurements. It does not limit what is "
      "rendered.");
  bind_fields(range, Field{"near", &DepthRange::near, "Metres."},
              Field{"far", &DepthRange::far, "Metres."});
  py::class_<Camera> camera(
      m, "Camera", "A calibrated depth camera: what its images are like, and where it is.");
  camera.def(py::init([](const Intrinsics& intrinsics, const Distortion& distortion,
                         const DepthRange& depth_range, std::string frame_id, std::string parent,
                         const OptionalPose& T_parent_camera) {
               Camera made{intrinsics,          distortion,        depth_range,
                           std::move(frame_id), std::move(parent), T_parent_camera};
               made.check();
               return made;
             }),
             py::arg("intrinsics"), py::kw_only(), py::arg("distortion") = Distortion(),
             py::arg("range") = DepthRange(), py::arg("frame_id") = std::string(),
             py::arg("parent") = std::string(), py::arg("T_parent_camera") = OptionalPose(),
             "Raises InputError unless 0 <= near < far.");
  camera.def_static("from_matrix", &camera_from_matrix, py::arg("K"), py::arg("size"),
                    py::arg("D") = std::vector<double>(), py::kw_only(),
                    py::arg("parent") = std::string(), py::arg("T_parent_camera") = OptionalPose(),
                    "K: OpenCV's camera matrix, 3 x 3, pixels; size: (width, height); D: its "
                    "distortion coefficients, none, 4, 5 or 8.");
  show_fields(camera, Field{"intrinsics", &Camera::intrinsics, "Of the image as it comes."},
              Field{"distortion", &Camera::distortion, "Of the image as it comes."},
              Field{"range", &Camera::range, "Which depths are measurements."},
              Field{"frame_id", &Camera::frame_id, "The optical frame; may be empty."},
              Field{"parent", &Camera::parent, "Link that carries it; empty: the root."},
              Field{"T_parent_camera", &Camera::T_parent_camera,
                    "Pose of the optical frame (x right, y down, z forward) in that link's frame, "
                    "metres; None: not known, and what needs it raises InputError."});
  bind_replace(camera,
               {"intrinsics", "distortion", "range", "frame_id", "parent", "T_parent_camera"});
}

using PngSource = Shown<
    "Annotated[Union[NDArray[bool_], NDArray[uint8], NDArray[uint16]], '(H, W) or (H, W, 3)']">;

void write_png(const std::filesystem::path& file, const PngSource& source) {
  py::object image = source;
  if (is_bool(image)) image = image.attr("view")("uint8").attr("__mul__")(255);
  if (py::isinstance<py::array>(image) && py::reinterpret_borrow<py::array>(image).ndim() == 3) {
    const SharedColor color = color_of(image, "image");
    const py::gil_scoped_release others;
    return io::write_png(file, color.view);
  }
  static constexpr PixelType types[] = {pixel_type<std::uint8_t>, pixel_type<std::uint16_t>};
  const bool is_wide = check_image(image, "image", types) == 1;
  const auto array = py::reinterpret_borrow<py::array>(image);
  const py::gil_scoped_release others;
  if (is_wide) return io::write_png(file, view_of<std::uint16_t>(array));
  io::write_png(file, view_of<std::uint8_t>(array));
}

void bind_files(py::module_& m) {
  m.def("read_camera_info", &io::read_camera_info, py::arg("file"), py::kw_only(),
        py::arg("rectified"), WithoutGil(),
        "Reads a camera's intrinsics: ROS's camera_info (a dump or camera_calibration's file), "
        "OpenCV's "
        "YAML, kalibr's camchain or RealSense's JSON. rectified: the images are free of distortion "
        "already; then p is used, else k and d. "
        "Raises InputError with file, line and key.");
  m.def("read_pose_csv", &io::read_pose_csv, py::arg("file"), WithoutGil(),
        "Reads a pose, metres: 4 x 4 or 3 x 4 numbers or x y z qx qy qz qw (text or .npy), or YAML "
        "of "
        "easy_handeye. Raises InputError for anything that is no rigid transform.");
  m.def("write_png", &write_png, py::arg("file"), py::arg("image"),
        "Writes uint8 or uint16 as grey, bool as black and white, uint8 (H, W, 3) as red, green, "
        "blue. Raises InputError if "
        "the file cannot be written.");
}

void bind_rectification(py::module_& m) {
  using R = Rectification;
  py::class_<R, std::shared_ptr<R>> rectification(
      m, "Rectification",
      "Maps between a camera's raw, distorted image and a pinhole image that covers it. Both ways "
      "take the nearest pixel: depths are never mixed.");
  rectification
      .def(py::init([](const Camera& raw) {
             const py::gil_scoped_release others;
             return std::make_shared<R>(raw);
           }),
           py::arg("raw"), "Raises InputError if the lens reaches no pixel.")
      .def_property_readonly(
          "raw_to_pinhole",
          [](const std::shared_ptr<R>& self) { return array_of(self->raw_to_pinhole(), self); },
          "Of the raw image's size: index v * width + u of each "
          "pixel's pinhole pixel, -1 without one. Read-only view.")
      .def_property_readonly(
          "pinhole_to_raw",
          [](const std::shared_ptr<R>& self) { return array_of(self->pinhole_to_raw(), self); },
          "Of the pinhole image's size: index v * width + u of each "
          "pixel's raw pixel, -1 without one. Read-only view.");
  show_properties(rectification, Field{"pinhole", &R::pinhole, "Size and projection."},
                  Field{"half_angle", &R::half_angle,
                        "Rays farther than this from the optical axis, radians, are not covered."});
}

struct Registration {
  Registration(const Camera& from_, const Camera& to)
      : warp(from_, to), width(from_.intrinsics.width()), height(from_.intrinsics.height()) {}
  DepthRegistration warp;
  int width, height;
  OneThread thread;
};

DepthResult warped(Registration& self, const DepthArgument<"depth">& depth,
                   const Eigen::Isometry3d& T_to_from) {
  const OneThread::Use use(self.thread, "DepthRegistration.warp");
  check_size(depth.array, "depth", self.width, self.height);
  DepthView result;
  {
    const py::gil_scoped_release others;
    result = self.warp.warp(depth.view, T_to_from);
  }
  return std::visit([](const auto& view) -> DepthResult { return {array_of(view, nullptr).array}; },
                    result);
}

void bind_registration(py::module_& m) {
  py::class_<Registration>(
      m, "DepthRegistration",
      "Brings depth images of one camera into the image of another: what that would measure of the "
      "surfaces that the first one sees.")
      .def(py::init<const Camera&, const Camera&>(), py::arg("from_camera"), py::arg("to_camera"))
      .def(
          "warp", &warped, py::arg("depth"), py::arg("T_to_from"),
          "depth: of the first camera's size, millimetres (uint16) or metres (float32). The result "
          "is a new array of the second camera's size and the same dtype, 0 where nothing is "
          "measured.");
}

}  // namespace

void bind_camera(py::module_& m) {
  bind_intrinsics(m);
  bind_distortion(m);
  bind_camera_class(m);
  bind_files(m);
  bind_rectification(m);
  bind_registration(m);
}

}  // namespace penumbra::python
