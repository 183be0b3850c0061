// SPDX-License-Identifier: Apache-2.0
#include <python/bindings.hpp>
#include <python/fields.hpp>
#include <python/report.hpp>
#include <python/robot.hpp>

namespace penumbra::python {

Report::Report(std::shared_ptr<PipelineState> state, const FrameReport& report, py::object depth)
    : state_(std::move(state)),
      call_(state_->calls),
      report_(report),
      depth_(std::move(depth)),
      T_root_link_(report.T_root_link.begin(), report.T_root_link.end()) {
  targets_.reserve(report.targets.size());
  for (const TargetReport& target : report.targets) targets_.emplace_back(target, report.links);
  for (const std::size_t link : report.near_links) near_links_.push_back(report.links[link]);
  report_.T_root_link = {};
  report_.near_links = {};
  report_.targets = {};
}

void Report::check_is_last() const {
  if (state_->calls != call_)
    throw py::value_error(
        "FrameReport: the pipeline has judged another frame since, in whose images "
        "those of frame " +
        std::to_string(report_.index) + " are gone; take a copy of what is needed longer");
}

py::object Report::base() const {
  check_is_last();
  return state_->lease.base(state_);
}

DepthImage Report::filtered_depth() const {
  check_is_last();
  DepthImage image;
  without_robot(report_, image);
  return image;
}

PointCloud Report::points(const std::optional<std::string>& frame) const {
  FrameReport report = report_;
  report.T_root_link = T_root_link_;
  const auto T = frame ? camera_in_link(report, *frame) : Eigen::Isometry3d::Identity();
  PointCloud cloud;
  const DepthImage depth = filtered_depth();
  if (T) state_->cloud_maker.make(depth, cloud, *T);
  return cloud;
}

namespace {

template <auto Member>
auto number(const Report& report) {
  return report.numbers().*Member;
}

void bind_report_parts(py::module_& m) {
  py::class_<PixelCounts> pixels(
      m, "PixelCounts",
      "How many pixels of the label image have each label: robot = front + "
      "occluded + unknown + beyond.");
  using P = PixelCounts;
  show_fields(pixels, Field{"robot", &P::robot, "Of the robot; None: its pose is not known."},
              Field{"front", &P::front, "Before the robot."},
              Field{"occluded", &P::occluded, "The sensor sees the robot."},
              Field{"unknown", &P::unknown, "Not measured."},
              Field{"beyond", &P::beyond, "The sensor sees past the model."},
              Field{"fringe", &P::fringe, "Beside the robot: depth not to be trusted."},
              Field{"uncovered", &P::uncovered, "That the lens model does not reach."});
  py::class_<StageTimes> times(m, "StageTimes",
                               "Wall time of the stages, milliseconds; None: not run.");
  using T = StageTimes;
  show_fields(times, Field{"kinematics", &T::kinematics, "Poses of the links."},
              Field{"render", &T::render, "Virtual depth."},
              Field{"classify", &T::classify, "Labels."},
              Field{"targets", &T::targets, "Verdicts and handling."});
}

void bind_report_images(py::class_<Report>& report) {
  report
      .def_property_readonly(
          "virtual_depth", [](const Report& r) { return r.image(r.numbers().virtual_depth.depth); },
          "Metres along the optical axis, 0 where no robot is; None where the robot's pose is not "
          "known. A read-only view: while it is in use the pipeline's next call raises "
          "ValueError, and after that call it is not to be had any more.")
      .def_property_readonly(
          "link_image", [](const Report& r) { return r.image(r.numbers().virtual_depth.links); },
          "Index into links + 1 of the nearest surface, 0: none. As virtual_depth.")
      .def_property_readonly(
          "labels", [](const Report& r) { return r.image(r.numbers().labels).value(); },
          "Label values; all unknown where the robot's pose is not known. As virtual_depth.");
}

/// A cloud as arrays.
struct CloudArrays {
  VertexArray points;
  py::array pixels, colors;  // colors: empty without a colour image
};

/// Of each point's pixel in a colour image of the labels' size.
py::array colors_of(const py::object& color, const py::array& pixels, const FrameReport& report) {
  const auto image = py::reinterpret_borrow<py::array>(color);
  const bool fits = py::isinstance<py::array>(color) && image.ndim() == 3 &&
                    is_native(image.dtype(), py::detail::npy_api::NPY_UBYTE_) &&
                    image.shape(0) == report.labels.height &&
                    image.shape(1) == report.labels.width && image.shape(2) == 3;
  if (!fits)
    throw py::value_error("color: expected numpy.ndarray of uint8 with shape (" +
                          std::to_string(report.labels.height) + ", " +
                          std::to_string(report.labels.width) + ", 3); got " +
                          description_of(color));
  return color.attr("reshape")(-1, 3).attr("__getitem__")(pixels);
}

CloudArrays points_of(const Report& report, const std::optional<std::string>& frame,
                      const py::object& color) {
  auto cloud = std::make_shared<PointCloud>(report.points(frame));
  const auto count = static_cast<py::ssize_t>(cloud->points.size());
  CloudArrays arrays;
  arrays.points =
      py::array(py::dtype::of<float>(), {count, py::ssize_t{3}}, {},
                cloud->points.empty() ? nullptr : cloud->points[0].data(), keeper_of(cloud));
  arrays.pixels = py::array(py::dtype::of<std::uint32_t>(), {count}, {}, cloud->pixels.data(),
                            keeper_of(cloud));
  arrays.colors = color.is_none()
                      ? py::array(py::dtype::of<std::uint8_t>(), std::vector<py::ssize_t>{0, 3})
                      : colors_of(color, arrays.pixels, report.numbers());
  return arrays;
}

void bind_without_robot(py::module_& m, py::class_<Report>& report) {
  py::class_<CloudArrays>(m, "PointCloud",
                          "Points without the robot, in the order of their pixels.")
      .def_property_readonly(
          "points", [](const CloudArrays& c) { return c.points; }, "float32 (N, 3), metres.")
      .def_property_readonly(
          "pixels", [](const CloudArrays& c) { return c.pixels; },
          "uint32 (N,): v * width + u of each point.")
      .def_property_readonly(
          "colors", [](const CloudArrays& c) { return c.colors; },
          "uint8 (N, 3) of the colour image; (0, 3) without one.")
      .def("__len__", [](const CloudArrays& c) { return c.pixels.size(); });
  report
      .def(
          "filtered_depth",
          [](const Report& r) -> ImageResult<std::uint16_t, float> {
            const auto image = std::make_shared<DepthImage>(r.filtered_depth());
            return std::visit(
                [&](auto& depth) -> ImageResult<std::uint16_t, float> {
                  return {array_of(depth.view(), keeper_of(image)).array};
                },
                *image);
          },
          "A copy of the frame's depth without the robot: 0 (uint16) or NaN (float32) where depth "
          "is not to be trusted, that is, where the label is neither clear nor front.")
      .def("points", &points_of, py::arg("frame") = std::optional<std::string>(),
           py::arg("color") = py::none(),
           "The points of filtered_depth(). frame: link whose frame they are given in; None: the "
           "camera's optical frame. color: uint8 (H, W, 3), an image of the labels' size. Raises "
           "InputError for a name that is no link.");
}

void bind_report_numbers(py::class_<Report>& report) {
  using F = FrameReport;
  report.def_property_readonly("index", &number<&F::index>, "In its source.")
      .def_property_readonly("stamp", &number<&F::stamp>, "Nanoseconds.")
      .def_property_readonly("joint_age", &number<&F::joint_age>, "Nanoseconds.")
      .def_property_readonly("status", &number<&F::status>, "Whether the frame can be relied on.")
      .def_property_readonly("message", &number<&F::message>, "One line for every status but ok.")
      .def_property_readonly("nothing_measured", &number<&F::nothing_measured>,
                             "No pixel of the depth image is within the sensor's range.")
      .def_property_readonly("pixels", &number<&F::pixels>, "Pixels by label.")
      .def_property_readonly("timing", &number<&F::timing>, "Milliseconds by stage.")
      .def_property_readonly("T_root_camera", &number<&F::T_root_camera>,
                             "The optical frame in the root link's; None: not known.")
      .def_property_readonly(
          "T_root_link",
          [](const Report& r) -> std::optional<Poses> {
            if (r.T_root_link().empty()) return std::nullopt;
            return r.T_root_link();
          },
          "Poses of the links, metres; None: not known.")
      .def_property_readonly(
          "near_links", [](const Report& r) { return Frozen<std::string>{r.near_links()}; },
          "Links of which a part lies nearer than 1 cm and is not drawn.")
      .def_property_readonly(
          "targets", [](const Report& r) { return Frozen<OwnedTargetReport>{r.targets()}; },
          "One for each of the frame's targets, in their order.")
      .def_property_readonly(
          "links",
          [](const Report& r) {
            const auto links = r.state().pipeline.robot().links();
            return Frozen<std::string>{{links.begin(), links.end()}};
          },
          "Names: links[i] stands as i + 1 in link images.")
      .def_property_readonly(
          "missing_links",
          [](const Report& r) {
            const auto links = r.state().pipeline.missing_links();
            return Frozen<std::string>{{links.begin(), links.end()}};
          },
          "Links drawn without all of their geometry.");
}

}  // namespace

void bind_report(py::module_& m) {
  bind_report_parts(m);
  py::class_<Report> report(
      m, "FrameReport",
      "What the pipeline says of one frame. Numbers, verdicts and poses stay; "
      "images lie in the pipeline until its next call.");
  bind_report_numbers(report);
  bind_report_images(report);
  bind_without_robot(m, report);
  report.def("__repr__", [](const Self<Report>& self) {
    return repr_of(self, {"index", "status", "message"});
  });
}

}  // namespace penumbra::python
