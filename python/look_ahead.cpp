// SPDX-License-Identifier: Apache-2.0
// What planned motions will hide.
#include <algorithm>
#include <memory>
#include <numeric>
#include <variant>

#include <python/arrays.hpp>
#include <python/bindings.hpp>
#include <python/fields.hpp>
#include <python/frame.hpp>

#include <penumbra/base/error.hpp>
#include <penumbra/planning/look_ahead.hpp>

namespace penumbra::python {
namespace {

using Rows = Shown<"Annotated[NDArray[float64], '(N, J)']">;
using SeenRows = Shown<"Annotated[NDArray[float32], '(N, T)']">;
using GivenTarget = std::variant<ForecastTarget, Target>;

const RobotPose& check_start(const RobotPose& start, const Robot& robot) {
  if (start.status != FrameStatus::ok || start.positions.empty())
    throw InputError("start: has no joint positions");
  check_positions(start, robot);
  return start;
}

Rows positions_at(const Trajectory& motion, const Numbers& times) {
  const std::size_t variables = motion.robot().variables().size();
  std::vector<double> positions(times.size() * variables);
  for (std::size_t i = 0; i < times.size(); ++i)
    motion.at(times[i], std::span(positions).subspan(i * variables, variables));
  return Rows(copied(
      positions, {static_cast<py::ssize_t>(times.size()), static_cast<py::ssize_t>(variables)}));
}

std::vector<TrajectoryPoint> trajectory_points(const Numbers& times, std::size_t joints,
                                               const Rows& positions,
                                               const std::optional<Rows>& velocities,
                                               const std::optional<Rows>& accelerations) {
  const auto n = static_cast<py::ssize_t>(times.size());
  const std::array<py::ssize_t, 2> shape{n, static_cast<py::ssize_t>(joints)};
  std::vector<TrajectoryPoint> points(times.size());
  const auto read = [&](const Rows& rows, const char* what,
                        std::vector<double> TrajectoryPoint::*to) {
    const auto numbers = numbers_of(rows, shape, what);
    for (std::size_t i = 0; i < points.size(); ++i)
      (points[i].*to).assign(numbers.data() + i * joints, numbers.data() + (i + 1) * joints);
  };
  for (std::size_t i = 0; i < points.size(); ++i) points[i].time = times[i];
  read(positions, "positions", &TrajectoryPoint::positions);
  if (velocities) read(*velocities, "velocities", &TrajectoryPoint::velocities);
  if (accelerations) read(*accelerations, "accelerations", &TrajectoryPoint::accelerations);
  return points;
}

}  // namespace

void bind_trajectory(py::module_& m) {
  py::class_<Trajectory, std::shared_ptr<Trajectory>> motion(
      m, "Trajectory",
      "A planned motion. Between two points it is linear, with velocities cubic, "
      "with accelerations, too, quintic.");
  motion.def(
      py::init([](const Robot& robot, const std::vector<std::string>& variables,
                  const Numbers& times, const Rows& positions, const PoseArgument& start,
                  const std::optional<Rows>& velocities, const std::optional<Rows>& accelerations) {
        return Trajectory(
            robot, variables,
            trajectory_points(times, variables.size(), positions, velocities, accelerations),
            check_start(start.pose, robot).positions);
      }),
      py::arg("robot"), py::arg("variables"), py::arg("times"), py::arg("positions"),
      py::arg("start"), py::kw_only(), py::arg("velocities") = py::none(),
      py::arg("accelerations") = py::none(),
      "variables: names of J of Robot.variables; the others stay at the joints of `start`, a "
      "frame's pose. "
      "times: seconds from the start of the motion, (N,). positions, velocities, "
      "accelerations: (N, J), rad and m. Raises InputError for what no motion can be.");
  motion.def_property_readonly("duration", &Trajectory::duration, "Seconds.");
  motion.def_property_readonly(
      "jump",
      [](const Trajectory& self) {
        const Trajectory::Jump jump = self.jump();
        return std::pair(self.robot().variables()[jump.variable], jump.by);
      },
      "The variable that differs most from `start` where the motion begins, and by how much.");
  motion.def_property_readonly(
      "notes", [](const Trajectory& self) { return Frozen<std::string>{self.notes()}; },
      "One line for each likely mistake: joints that exceed a limit of the URDF, times that may be "
      "in milliseconds.");
  motion.def("at", &positions_at, py::arg("times"),
             "Positions at times, (N,), seconds: rows in the order of Robot.variables.");
}

namespace {

template <typename Get>
Numbers numbers_of_samples(const CameraForecast& of, Get get) {
  Numbers numbers;
  for (const Prediction& prediction : of.predictions) numbers.push_back(prediction.*get);
  return numbers;
}

void bind_forecasts(py::module_& m) {
  using C = CameraForecast;
  py::class_<C> camera(m, "CameraForecast",
                       "What a camera, or all of them together, will see of a target.");
  show_properties(
      camera,
      Field{"intervals", &C::intervals, "VerdictIntervals of the whole motion, without gaps."},
      Field{"times", &C::times, "Seconds, of the samples; empty for all cameras together."},
      Field{"verdicts",
            [](const C& of) {
              Frozen<Verdict> verdicts;
              for (const Prediction& each : of.predictions) verdicts.values.push_back(each.verdict);
              return verdicts;
            },
            "By sample."},
      Field{"hidden", [](const C& of) { return numbers_of_samples(of, &Prediction::hidden); },
            "Share of the target's pixels, by sample."},
      Field{"clearance", [](const C& of) { return numbers_of_samples(of, &Prediction::clearance); },
            "Pixels between target and robot, below 0: how deep it is hidden; by sample. nan: "
            "unknown, or not measured."},
      Field{"hidden_at", &C::hidden_at, "Seconds until it gets hidden; None: never."},
      Field{"seen_again_at", &C::seen_again_at, "Seconds until it is seen again; None: never."},
      Field{"seen_for", &C::seen_for, "Seconds for which it is seen, by share."});
  bind_repr(camera, {"hidden_at", "seen_again_at", "seen_for"});
  using T = TargetForecast;
  py::class_<T> target(m, "TargetForecast", "What a motion does to a target.");
  show_fields(target, Field{"name", &T::name, "The target's."},
              Field{"cameras", &T::cameras, "A CameraForecast for each camera."},
              Field{"any", &T::any, "Of all cameras together: seen if one sees it."});
  using R = RankedMotion;
  py::class_<R> ranked(m, "RankedMotion", "A motion among others.");
  show_fields(ranked, Field{"trajectory", &R::trajectory, "Index."},
              Field{"seen", &R::seen, "Share of the motion for which targets are seen, 0 to 1."},
              Field{"reason", &R::reason, "What costs most, one line; empty: nothing is hidden."});
  m.def(
      "rank",
      [](const std::vector<std::vector<TargetForecast>>& forecasts) {
        return Frozen<RankedMotion>{rank(forecasts)};
      },
      py::arg("forecasts"),
      "Orders motions, by what LookAhead.along() returned of each, by the share of time for which "
      "their targets stay visible: RankedMotions, the best first.");
}

void bind_given(py::module_& m) {
  using C = ForecastCamera;
  py::class_<C> camera(m, "ForecastCamera", "A camera that will see the motion.");
  camera.def(py::init([](std::string name, const Camera& of, const LabelRule& rule) {
               return C{std::move(name), of, rule};
             }),
             py::arg("name"), py::arg("camera"), py::kw_only(), py::arg("rule") = LabelRule());
  show_fields(camera, Field{"name", &C::name, "Its name."},
              Field{"camera", &C::camera, "With its pose. Its images are the rectified ones."},
              Field{"rule", &C::rule, "Its tolerance separates robot and target."});
  using T = ForecastTarget;
  py::class_<T> target(m, "ForecastTarget", "A target that moves with a constant velocity.");
  bind_fields<1>(target, Field{"target", &T::target, "Where it is at the start."},
                 Field{"velocity", &T::velocity, "In the root's frame, m/s."},
                 Field{"angular_velocity", &T::angular_velocity, "About its origin, rad/s."});
  using L = LookAheadConfig;
  py::class_<L> config(m, "LookAheadConfig", "How closely a motion is looked at.");
  bind_fields(config, Field{"threads", &L::threads, "How many."},
              Field{"step", &L::step, "Seconds between samples at most."},
              Field{"motion", &L::motion,
                    "Of a target's smaller side in the image, that robot or target move at most "
                    "between two samples."},
              Field{"border", &L::border, "Seconds by which an interval's ends may be off."},
              Field{"clearance", &L::clearance,
                    "Pixels up to which the clearance is measured, to 127; 0: it is not, which "
                    "saves time."});
}

/// LookAhead, for one thread at a time.
struct Ahead {
  LookAhead look;
  std::size_t variables, targets;
  OneThread one;

  std::pair<SeenRows, SeenRows> visibility(const Rows& positions, std::size_t camera) {
    const OneThread::Use use(one, "LookAhead");
    const auto rows =
        numbers_of(positions, std::array<py::ssize_t, 2>{-1, static_cast<py::ssize_t>(variables)},
                   "positions");
    std::vector<LookAhead::Seen> seen;
    {
      const py::gil_scoped_release others;
      seen = look.visibility(camera, {rows.data(), static_cast<std::size_t>(rows.size())});
    }
    const std::array<py::ssize_t, 2> shape{rows.shape(0), static_cast<py::ssize_t>(targets)};
    py::array_t<float> hidden(shape), clearance(shape);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      hidden.mutable_data()[i] = seen[i].hidden;
      clearance.mutable_data()[i] = seen[i].clearance;
    }
    return {hidden, clearance};
  }
};

std::unique_ptr<Ahead> make_ahead(const Robot& robot, std::vector<ForecastCamera> cameras,
                                  const std::vector<GivenTarget>& given, PoseArgument start,
                                  const LookAheadConfig& config) {
  std::vector<ForecastTarget> targets;
  for (const GivenTarget& target : given)
    targets.push_back(std::holds_alternative<Target>(target)
                          ? ForecastTarget{.target = std::get<Target>(target)}
                          : std::get<ForecastTarget>(target));
  check_start(start.pose, robot);
  return std::unique_ptr<Ahead>(
      new Ahead{LookAhead(robot, std::move(cameras), targets, std::move(start.pose), config),
                robot.variables().size(),
                targets.size(),
                {}});
}

}  // namespace

void bind_look_ahead(py::module_& m) {
  bind_given(m);
  bind_forecasts(m);
  py::class_<Ahead>(m, "LookAhead",
                    "Says what a motion will hide, when, for how long, and by which link: "
                    "docs/look_ahead.md. Serves one thread at a time.")
      .def(py::init(&make_ahead), py::arg("robot"), py::arg("cameras"), py::arg("targets"),
           py::arg("start"), py::arg("config") = LookAheadConfig(),
           "start: a frame's pose: the joints of now, and what links carry. Raises InputError for "
           "no "
           "cameras, targets that are invalid in every frame and settings out of range.")
      .def(
          "along",
          [](Ahead& self, const Trajectory& trajectory) {
            const OneThread::Use use(self.one, "LookAhead");
            const py::gil_scoped_release others;
            return Frozen<TargetForecast>{self.look.along(trajectory)};
          },
          py::arg("trajectory"), "A TargetForecast for each target.")
      .def("visibility", &Ahead::visibility, py::arg("positions"), py::arg("camera") = 0,
           "What a camera sees of the T targets, where they are at the start, in N configurations, "
           "rows in the order of Robot.variables. Returns the hidden shares (nan: unknown, or out "
           "of view) and the clearances in pixels, each (N, T).");
}

}  // namespace penumbra::python
