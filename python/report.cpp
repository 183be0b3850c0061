// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <python/bindings.hpp>
#include <python/fields.hpp>
#include <python/report.hpp>
#include <python/robot.hpp>

#include <io/files/coco_mask.hpp>

namespace penumbra::python {

Report::Report(std::shared_ptr<SessionState> state, const FrameReport& report,
               std::shared_ptr<const void> depth)
    : numbers(report),
      targets(report.targets.begin(), report.targets.end()),
      T_root_link(report.T_root_link.begin(), report.T_root_link.end()),
      links(report.links.begin(), report.links.end()),
      missing_links(report.missing_links.begin(), report.missing_links.end()),
      state_(std::move(state)),
      call_(state_->calls),
      depth_(std::move(depth)) {
  for (const std::size_t link : report.near_links) near_links.push_back(links[link]);
  for (const std::size_t body : report.attached) attached.push_back(links[body]);
  numbers.T_root_link = {};
  numbers.near_links = numbers.attached = {};
  numbers.targets = {};
  numbers.links = numbers.missing_links = {};
}

FrameReport Report::with_names() const {
  FrameReport report = numbers;
  report.T_root_link = T_root_link;
  report.links = links;
  report.missing_links = missing_links;
  return report;
}

void Report::check_is_last() const {
  if (state_->calls != call_)
    throw py::value_error(
        "FrameReport: the session has judged another frame since: read the "
        "images of frame " +
        std::to_string(numbers.index) + " before the next call");
}

ImageResult<std::uint8_t> Report::labels() const {
  return labels_.read([&] { return check_is_last(), numbers.labels; });
}
std::optional<ImageResult<float>> Report::virtual_depth() const {
  return read(virtual_depth_, numbers.virtual_depth.depth);
}
std::optional<ImageResult<std::uint16_t>> Report::link_image() const {
  return read(link_image_, numbers.virtual_depth.links);
}

BoolImage Report::robot_mask() const {
  if (const auto depth = virtual_depth(); depth && !robot_mask_)
    robot_mask_ = read_only(depth->array.attr("__gt__")(0));
  return robot_mask_ ? robot_mask_ : BoolImage(py::none());
}

std::optional<py::dict> Report::coco_annotation() const {
  check_is_last();
  const auto depth = numbers.virtual_depth.depth;
  if (depth.width == 0) return std::nullopt;
  const io::CocoMask mask = io::coco_mask(depth);
  return py::dict(py::arg("segmentation") =
                      py::dict(py::arg("size") = py::make_tuple(depth.height, depth.width),
                               py::arg("counts") = mask.counts),
                  py::arg("bbox") = mask.box, py::arg("area") = mask.area);
}

Label Report::label(int u, int v) const {
  const auto image = view_of<std::uint8_t>(py::reinterpret_borrow<py::array>(labels().array));
  if (u < 0 || v < 0 || u >= image.width || v >= image.height)
    throw py::index_error("label: pixel (" + std::to_string(u) + ", " + std::to_string(v) +
                          ") is outside of the image, " + std::to_string(image.width) + "x" +
                          std::to_string(image.height));
  return static_cast<Label>(image(u, v));
}

DepthImage Report::depth_without_robot() const {
  check_is_last();
  if (!state_->cloud_maker)
    throw py::value_error(
        "FrameReport: a scan has no image: take its points whose labels[0] is clear or front");
  DepthImage image;
  without_robot(with_names(), image);
  return image;
}

PointCloud Report::points(const std::optional<std::string>& frame) const {
  const auto T = frame ? camera_in_link(with_names(), *frame) : Eigen::Isometry3d::Identity();
  PointCloud cloud;
  const DepthImage depth = depth_without_robot();
  if (T) state_->cloud_maker->make(depth, cloud, *T);
  return cloud;
}

std::vector<PointView> Report::point_views(const std::string& link, const Points& points) const {
  check_is_last();
  if (!state_->report_camera)
    throw py::value_error("FrameReport: points are judged in images; a scan has none");
  auto& judge = state_->point_judge;
  if (!judge) judge.emplace(state_->session.pipeline().robot());
  return judge->judge(with_names(), *state_->report_camera, link, points);
}

namespace {

void bind_report_parts(py::module_& m) {
  py::class_<PixelCounts> pixels(
      m, "PixelCounts",
      "How many pixels of the label image have each label: robot = front + "
      "occluded + unknown + beyond. Of a scan: points; robot = front + occluded + beyond.");
  using P = PixelCounts;
  show_fields(pixels, Field{"robot", &P::robot, "Of the robot; None: its pose is not known."},
              Field{"clear", &P::clear, "Not of the robot."},
              Field{"front", &P::front, "Something real in front of the robot."},
              Field{"occluded", &P::occluded, "The sensor sees the robot."},
              Field{"unknown", &P::unknown, "Not measured."},
              Field{"beyond", &P::beyond, "The sensor sees past the model."},
              Field{"fringe", &P::fringe, "Next to the robot: depth not to be trusted."},
              Field{"uncovered", &P::uncovered, "That the lens model does not reach."});
  py::class_<StageTimes> times(m, "StageTimes",
                               "Wall time of the stages, milliseconds; None: not run.");
  using T = StageTimes;
  show_fields(times, Field{"kinematics", &T::kinematics, "Poses of the links."},
              Field{"render", &T::render, "Virtual depth."},
              Field{"classify", &T::classify, "Labels."},
              Field{"targets", &T::targets, "Verdicts and handling."});
}

/// A cloud as arrays.
struct CloudArrays {
  VertexArray points;
  py::array pixels, colors;  // colors: empty without a colour image
};

/// Of each point's pixel in a colour image of the labels' size.
py::array colors_of(const py::object& color, const py::array& pixels, const FrameReport& report) {
  const ImageView<const Rgb8> image = color_of(color, "color").view;
  check_size("color", image.width, image.height, report.labels.width, report.labels.height);
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
                      : colors_of(color, arrays.pixels, report.numbers);
  return arrays;
}

void bind_without_robot(py::module_& m, py::class_<Report>& report) {
  using C = CloudArrays;
  py::class_<C> cloud(m, "PointCloud", "Points without the robot, in the order of their pixels.");
  show_properties(cloud, Field{"points", &C::points, "float32 (N, 3), metres."},
                  Field{"pixels", &C::pixels, "uint32 (N,): v * width + u of each point."},
                  Field{"colors", &C::colors, "uint8 (N, 3); (0, 3) without a colour image."});
  cloud.def("__len__", [](const C& c) { return c.pixels.size(); });
  cloud.def("__repr__", [](const C& c) {
    return "<penumbra.PointCloud: " + std::to_string(c.pixels.size()) + " points>";
  });
  report
      .def("label", &Report::label, py::arg("u"), py::arg("v"),
           "The label of pixel (u, v): column and row. Raises IndexError outside of the image.")
      .def(
          "without_robot",
          [](const Report& r) {
            const auto image = std::make_shared<DepthImage>(r.depth_without_robot());
            return std::visit(
                [&](auto& depth) -> DepthResult { return {array_of(depth.view(), image).array}; },
                *image);
          },
          "A copy of the frame's depth, which must not have changed since, without the robot: 0 "
          "(uint16) or NaN (float32) where depth "
          "is not to be trusted, that is, where the label is neither clear nor front.")
      .def("coco_annotation", &Report::coco_annotation,
           "The robot_mask as COCO's annotations have it: segmentation (size and counts, the "
           "compressed run lengths of pycocotools), bbox and area; None: the robot's pose is not "
           "known. Raises ValueError after the session's next call.")
      .def("points", &points_of, py::arg("frame") = std::optional<std::string>(),
           py::arg("color") = py::none(),
           "The points of without_robot(), of the depth as it is now. frame: link whose frame they "
           "are given in; None: the "
           "camera's optical frame. color: uint8 (H, W, 3), an image of the labels' size. Raises "
           "InputError for a name that is no link.");
}

/// Views of points as arrays.
struct PointViews {
  py::array pixels, depths, visible, verdicts, hidden_by;
};

PointViews point_views_of(const Report& report, const std::string& link, const Points& points) {
  const std::vector<PointView> views = report.point_views(link, points);
  const auto column = [&](auto get) {
    using T = decltype(get(views[0]));
    py::array_t<T> values(static_cast<py::ssize_t>(views.size()));
    std::ranges::transform(views, values.mutable_data(), get);
    return read_only(std::move(values));
  };
  py::array_t<double> pixels({static_cast<py::ssize_t>(views.size()), py::ssize_t{2}});
  for (std::size_t i = 0; i < views.size(); ++i)
    std::copy_n(views[i].pixel.data(), 2, pixels.mutable_data() + 2 * i);
  return {
      .pixels = read_only(std::move(pixels)),
      .depths = column([](const PointView& v) { return v.depth; }),
      .visible = column([](const PointView& v) { return v.verdict == Verdict::visible; }),
      .verdicts = column([](const PointView& v) { return static_cast<std::uint8_t>(v.verdict); }),
      .hidden_by = column([](const PointView& v) { return v.hidden_by; })};
}

void bind_point_views(py::module_& m, py::class_<Report>& report) {
  using V = PointViews;
  py::class_<V> views(m, "PointViews", "Where an image shows points of a link.");
  show_properties(
      views,
      Field{"pixels", &V::pixels,
            "float64 (N, 2): u and v; NaN where the camera cannot see, or the pose is not known."},
      Field{"depths", &V::depths, "float64 (N,), metres; NaN: the pose is not known."},
      Field{"visible", &V::visible, "bool (N,): neither the robot nor anything else hides it."},
      Field{"verdicts", &V::verdicts,
            "uint8 (N,): places in list(Verdict), of visible, hidden, unknown and out_of_view."},
      Field{"hidden_by", &V::hidden_by,
            "uint16 (N,): of hidden points the number in link images of what hides it, which may "
            "be its own link; 0: nothing of the robot."});
  views.def("__len__", [](const V& v) { return v.depths.size(); });
  views.def("__repr__", [](const V& v) {
    return "<penumbra.PointViews: " + std::to_string(v.depths.size()) + " points>";
  });
  report.def("point_views", &point_views_of, py::arg("link"), py::arg("points"),
             "Where the image shows points of a link, as Robot.points_on() returns them, and what "
             "hides them. points: (N, 3), in the link's frame, metres. A point that the robot does "
             "not hide is visible where its pixel is labelled occluded: the sensor sees the robot. "
             "Without a depth camera the robot alone decides. Raises InputError for a name that is "
             "no link, ValueError for a scan and after the session's next call.");
}

void bind_report_properties(py::class_<Report>& report) {
  using F = FrameReport;
  using R = Report;
  const auto of = [](auto member) { return [member](const R& r) { return r.numbers.*member; }; };
  show_properties(
      report, Field{"index", of(&F::index), "In its source."},
      Field{"stamp", of(&F::stamp), "Nanoseconds."},
      Field{"joint_age", of(&F::joint_age), "Nanoseconds."},
      Field{"status", of(&F::status), "Whether the frame can be relied on."},
      Field{"message", of(&F::message), "One line for every status but ok."},
      Field{"nothing_measured", of(&F::nothing_measured),
            "No pixel of the depth image is within the sensor's range."},
      Field{"parts", of(&F::parts),
            "In how many parts a scan was labelled, each by poses of its own; 0: no scan."},
      Field{"pixels", of(&F::pixels), "Pixels, or a scan's points, by label."},
      Field{"timing", of(&F::timing), "Milliseconds by stage."},
      Field{"T_root_camera", of(&F::T_root_camera),
            "The optical frame in the root link's frame, metres; None: not known."},
      Field{"T_root_link",
            [](const R& r) {
              return r.T_root_link.empty() ? std::nullopt : std::optional(r.T_root_link);
            },
            "Poses of the links, metres; None: not known."},
      Field{"near_links", &R::near_links,
            "Links of which a part lies nearer than 1 cm and is not drawn."},
      Field{"targets", &R::targets, "One for each of the frame's targets, in their order."},
      Field{"links", &R::links,
            "Names of the robot's links, then of attached bodies: links[i] has the number i + 1 in "
            "link images."},
      Field{"attached", &R::attached, "Names of the bodies attached in this frame."},
      Field{"missing_links", &R::missing_links,
            "Links drawn without all of their geometry, and attached bodies that are not drawn."},
      Field{"labels", &R::labels,
            "Label values, (H, W), of a scan (1, N); all unknown if the robot's pose is not "
            "known. A read-only copy, made when it is first read. Raises ValueError if it was not "
            "read before the "
            "session's next call."},
      Field{"virtual_depth", &R::virtual_depth,
            "Metres along the optical axis, 0 where no robot is; None: the robot's pose is not "
            "known, or it is a scan. As labels."},
      Field{"link_image", &R::link_image,
            "Index into links + 1 of the nearest surface, of a scan of the link that decided, 0: "
            "none; None: the robot's pose is not known. As labels."},
      Field{"robot_mask", &R::robot_mask,
            "Where the robot is in the label image, whether it is measured or not: virtual_depth > "
            "0; None: the robot's pose is not known. False does not say that the depth is to be "
            "trusted (fringe, missing_links, pixels outside of the lens model): without_robot() "
            "leaves such pixels out. As virtual_depth."});
  bind_repr(report, {"index", "status", "message", "pixels", "targets"});
}

}  // namespace

void bind_report(py::module_& m) {
  bind_report_parts(m);
  py::class_<Report> report(m, "FrameReport",
                            "The results for one frame. Read its images before the "
                            "session's next call; everything else stays.");
  bind_report_properties(report);
  bind_without_robot(m, report);
  bind_point_views(m, report);
}

}  // namespace penumbra::python
