// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <python/bindings.hpp>
#include <python/fields.hpp>
#include <python/frame.hpp>

#include <penumbra/base/error.hpp>
#include <penumbra/calibration/calibration.hpp>
#include <penumbra/diagnosis/diagnosis.hpp>
#include <penumbra/poses/pose_stage.hpp>

namespace penumbra::python {

namespace {

Calibration calibrate_frames(const py::iterable& frames, const Camera& camera, const Robot& robot,
                             bool search, const std::vector<MaskSource>& given_masks, bool images,
                             bool focal, bool joint_offsets, std::vector<Frame> motion,
                             double joint_accuracy, const std::optional<double>& accept,
                             std::uint64_t seed) {
  std::vector<PixelMask> masks;
  for (const MaskSource& mask : given_masks)
    masks.push_back(pixel_mask_of(mask, "masks (bool or uint8)"));
  for (std::size_t i = 0; i < motion.size(); ++i)
    if (!motion[i].stamp)
      throw py::value_error("motion[" + std::to_string(i) + "]: needs a stamp for the time offset");
  std::ranges::stable_sort(motion, {}, &Frame::stamp);
  if (images && !masks.empty())
    throw py::value_error("images: masks are given too; leave one of them out");
  using Choice = KeptFrames::Choice;
  KeptFrames chosen(robot, camera,
                    {.choice = motion.empty() ? Choice::rest_first : Choice::any,
                     .needs_depth = masks.empty() && !images,
                     .parent = find_camera_parent(robot, camera.parent)});
  auto next = motion.begin();
  for (const py::handle each : frames) {
    const std::size_t number = chosen.seen();
    const auto frame = checked_cast<Frame>(
        each, "frames[" + std::to_string(number) + "]: expected penumbra.Frame");
    if (!motion.empty() && !frame.stamp)
      throw py::value_error("frames[" + std::to_string(number) +
                            "]: needs a stamp for the time offset");
    for (; next != motion.end() && next->stamp < frame.stamp; ++next) chosen.follow(*next);
    std::optional<KeptFrame> kept = chosen.pass(frame);
    if (!kept) continue;
    if (images) {
      if (frame.color.view.empty())
        throw InputError("frames[" + std::to_string(number) + "]: has no colour image" +
                         (frame.color_message.empty() ? "; open the input with color=True"
                                                      : ": " + frame.color_message));
      kept->color = chosen.image_of(frame.color.view);
    } else if (!is_empty(frame.depth.view))
      kept->depth = chosen.depth_of(frame.depth.view);
    if (number < masks.size()) kept->mask = chosen.image_of(masks[number].mask.view);
    chosen.add(*std::move(kept));
  }
  for (; next != motion.end(); ++next) chosen.follow(*next);
  if (!masks.empty() && masks.size() != chosen.seen())
    throw py::value_error("masks: expected one for each of " + std::to_string(chosen.seen()) +
                          " frames; got " + std::to_string(masks.size()));
  std::optional<Eigen::Isometry3d> start;
  if (!search) start = chosen.T_parent_camera() ? *chosen.T_parent_camera() : camera.pose();
  const std::vector<KeptFrame> all = chosen.chosen();
  const std::vector<std::string> notes = chosen.notes();
  if (all.size() < KeptFrames::least && !notes.empty())
    throw InputError("calibration needs 3 frames or more: " + notes.back());
  const py::gil_scoped_release others;
  Calibration found = calibrate(all, chosen.camera(), robot,
                                {.camera_parent = camera.parent,
                                 .initial = start,
                                 .focal = focal,
                                 .joint_offsets = joint_offsets,
                                 .time_offset = !motion.empty(),
                                 .joint_accuracy = joint_accuracy,
                                 .accept = accept,
                                 .seed = seed});
  found.notes.insert(found.notes.begin(), notes.begin(), notes.end());
  return found;
}

}  // namespace

void bind_calibration(py::module_& m) {
  py::class_<Estimate> estimate(m, "Estimate", "A value and its standard deviation.");
  show_fields(estimate, Field{"value", &Estimate::value, "The value."},
              Field{"sigma", &Estimate::sigma, "Its standard deviation."});
  py::class_<FrameFit> fit(m, "FrameFit", "How well the robot fits a frame.");
  show_fields(
      fit, Field{"index", &FrameFit::index, "The frame's index."},
      Field{"used", &FrameFit::used, "False: the robot is elsewhere than its joints say."},
      Field{"agreeing", &FrameFit::agreeing,
            "Share of the robot's measured pixels at its depth; without depth, intersection over "
            "union of robot and mask."},
      Field{"residual", &FrameFit::residual,
            "Median distance of measured points from the robot's surface, metres."},
      Field{"outline", &FrameFit::outline,
            "Median distance of the depth's or mask's edge from the outline, pixels."});
  using C = Calibration;
  py::class_<C> calibration(m, "Calibration", "A camera's pose, and how good it is.");
  show_properties(
      calibration,
      Field{"T_parent_camera", &C::T_parent_camera,
            "Pose of the optical frame in the parent link, metres."},
      Field{"covariance", &C::covariance,
            "Of a small motion of the camera in its own frame: rotation (rad), then translation "
            "(m)."},
      Field{"depth_offset", &C::depth_offset,
            "Metres: measured = true (1 + depth_scale) + depth_offset; None: no depth."},
      Field{"depth_scale", &C::depth_scale, "See depth_offset."},
      Field{"outline", &C::outline,
            "Pixels by which the depth's or mask's picture of the robot is larger."},
      Field{"shift_right", &C::shift_right,
            "Pixels by which the depth image lies to the right of the colour image; None: no "
            "masks, or "
            "no depth."},
      Field{"shift_down", &C::shift_down, "The same, below."},
      Field{"focal_x", &C::focal_x, "fx is 1 + this of the camera's; None: not asked."},
      Field{"focal_y", &C::focal_y, "fy is 1 + this of the camera's; None: not asked."},
      Field{"joint_offsets", &C::joint_offsets,
            "In the order of Robot.variables, rad or m; empty: not asked. 0: the images do not "
            "contradict it."},
      Field{"time_offset", &C::time_offset,
            "Seconds to add to an image's stamp before poses are looked up; None: no motion."},
      Field{"frames", &C::frames, "By frame."},
      Field{"link_residuals", &C::link_residuals,
            "Signed median residuals by link, metres; nan: not seen."},
      Field{"mask_overlap", &C::mask_overlap, "Intersection over union with the masks."},
      Field{"faults", &C::faults,
            "Why the pose must not be used and what to record instead; empty: it is good."},
      Field{"notes", &C::notes,
            "Frames that were left out, and inputs that the images contradict."},
      Field{"advice", &C::advice, "What is known least, and which joints' motion would add most."},
      Field{"is_good", &C::is_good, "Whether there are no faults."},
      Field{"is_wide", &C::is_wide, "Whether the only fault is a region wider than accepted."},
      Field{"position_error", &C::position_error,
            "Half of the longest axis of the 95 % ellipsoid of the position, metres."},
      Field{"rotation_error", &C::rotation_error, "The same of the rotation, rad."});
  bind_repr(calibration, {"is_good", "position_error", "rotation_error"});
  using D = Drift;
  py::class_<D> drift(m, "Drift", "How far a camera is from its calibration.");
  show_properties(
      drift, Field{"is_known", &D::is_known, "Whether the robot was seen in enough poses."},
      Field{"T_calibrated_camera", &D::T_calibrated_camera,
            "The camera's pose in its calibrated frame, metres."},
      Field{"covariance", &D::covariance,
            "Of a small motion of the camera in its own frame: rotation (rad), then translation "
            "(m)."},
      Field{"time_offset", &D::time_offset,
            "Seconds to add to an image's stamp before poses are looked up."},
      Field{"has_moved", &D::has_moved,
            "Farther than 2 mm or 0.1 degrees; neither chance nor clocks explain it."},
      Field{"clocks_differ", &D::clocks_differ,
            "The time offset is over 5 ms; neither chance nor the pose explains it."},
      Field{"camera_or_clocks", &D::camera_or_clocks,
            "One of the two, and the robot's motion does not tell which."},
      Field{"bumped_at", &D::bumped_at, "Index of the frame at which it moved suddenly, or None."},
      Field{"bumped_within", &D::bumped_within, "Frames by which that may be off."},
      Field{"seen_through", &D::seen_through,
            "Share of the robot's pixels in which the sensor sees past its surface."},
      Field{"position", &D::position, "Metres."}, Field{"rotation", &D::rotation, "Rad."},
      Field{"position_error", &D::position_error,
            "Half of the longest axis of the 95 % ellipsoid of the position, metres."},
      Field{"rotation_error", &D::rotation_error, "The same of the rotation, rad."},
      Field{"message", &D::message, "One line if the camera has moved; else empty."});
  bind_repr(drift, {"is_known", "has_moved", "position", "position_error"});
  using S = Diagnosis;
  py::class_<S> diagnosis(m, "Diagnosis", "What is wrong with a setup.");
  show_properties(
      diagnosis,
      Field{"cause", [](const S& d) { return std::string(to_string(d.cause)); },
            "none, depth_unit, depth_scale, depth_ray, camera_unit, camera_inverted, "
            "camera_transposed, camera_axes, camera_pose, intrinsics, joint_unit, joint_sign, "
            "joint_zero, joint_order, joint_time, or unexplained."},
      Field{"other", [](const S& d) { return std::string(to_string(d.other)); },
            "A second cause that the frames cannot rule out, or none."},
      Field{"message", &S::message, "One line with the amount and the remedy; empty: nothing."},
      Field{"frame", &S::frame, "Index of the frame that shows it most."},
      Field{"score", &S::score, "Agreement of the images and the virtual depth, at most 1."},
      Field{"best", &S::best, "The same after the mend."},
      Field{"poses", &S::poses, "Poses of the robot that were compared; below 3 tell little."});
  bind_repr(diagnosis, {"cause", "message"});
  m.def("calibrate", &calibrate_frames, py::arg("frames"), py::arg("camera"), py::arg("robot"),
        py::kw_only(), py::arg("search") = false, py::arg("masks") = std::vector<MaskSource>(),
        py::arg("images") = false, py::arg("focal") = false, py::arg("joint_offsets") = false,
        py::arg("motion") = std::vector<Frame>(),
        py::arg("joint_accuracy") = CalibrationOptions().joint_accuracy,
        py::arg("accept") = py::none(), py::arg("seed") = 1,
        "Estimates a camera's pose from the robot that it sees. frames: an opened input, or three "
        "frames or more with joints (or T_root_link) and with depth, masks or color; those are "
        "used between which the robot moves, at rest if it is. camera: of the images; "
        "its pose, or that of the frames, is a guess, at most 100 mm and 10 degrees off. search: "
        "that pose is not known. masks: images that are not 0 where "
        "the colour image shows the robot, and 128 where that is not known. images: take the "
        "frames' colour images in place of depth, of a camera that stands still. focal: estimate "
        "the focal lengths, too. joint_offsets: "
        "estimate the offsets of joints that the images contradict. motion: frames with stamps and "
        "poses "
        "that reach 0.1 s before and after each of `frames`, in which the robot moves: the time "
        "offset is estimated, too. joint_accuracy: standard deviation of the zeros of joints, rad. "
        "accept: the widest 95 % region of a good pose, metres. Raises InputError for too few "
        "frames; any other failure is "
        "Calibration.faults.");
}

}  // namespace penumbra::python
