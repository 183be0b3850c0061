// SPDX-License-Identifier: Apache-2.0
// What a session says of the setup of a sensor of points: its scans are closed forms of an arm of
// boxes before a wall.
#include "../robot/urdf_text.hpp"
#include "../support/random.hpp"

#include <penumbra/session/session.hpp>

namespace penumbra::test {
namespace {

constexpr double noise = 0.005;  // metres, standard deviation
constexpr std::int64_t scan_length = 100 * ms;

struct ArmBox {
  Vector3d centre, size;
};
const std::array<ArmBox, 3> arm_boxes{{{{0, 0, 0.2}, {0.16, 0.16, 0.4}},
                                       {{0.25, 0, 0}, {0.5, 0.1, 0.12}},
                                       {{0.2, 0.05, 0}, {0.4, 0.08, 0.16}}}};
constexpr double shoulder_height = 0.4, upper_arm = 0.5;  // metres

std::string text_of(const Vector3d& v) {
  return std::to_string(v.x()) + " " + std::to_string(v.y()) + " " + std::to_string(v.z());
}

Robot box_arm() {
  std::string xml = link_xml("base");
  const std::array<std::array<std::string, 3>, 3> joints{
      {{"turn", R"(<axis xyz="0 0 1"/>)", "base"},
       {"lift",
        R"(<origin xyz="0 0 )" + std::to_string(shoulder_height) + R"("/><axis xyz="0 1 0"/>)",
        "turn_link"},
       {"bend", R"(<origin xyz=")" + std::to_string(upper_arm) + R"( 0 0"/><axis xyz="0 1 0"/>)",
        "lift_link"}}};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& [name, where, parent] = joints[i];
    xml += link_xml(name + "_link",
                    collision_xml("<box size=\"" + text_of(arm_boxes[i].size) + "\"/>",
                                  "<origin xyz=\"" + text_of(arm_boxes[i].centre) + "\"/>")) +
           joint_xml(name, "continuous", parent, name + "_link", where);
  }
  return parse(robot_xml(xml));
}

std::vector<double> joints_at(std::int64_t stamp) {
  const double t = 1e-9 * double(stamp);
  return {0.8 * std::sin(0.9 * t), -0.4 + 0.5 * std::sin(1.3 * t + 1.0),
          0.6 + 0.7 * std::sin(0.7 * t + 2.0)};
}

Isometry3d sensor_pose() {
  return Translation3d(1.8, 0.3, 0.9) * AngleAxisd(std::numbers::pi, Vector3d::UnitZ()) *
         AngleAxisd(0.2, Vector3d::UnitY());
}

/// Scans from the left to the right, in which the arm moves.
class Scanner {
 public:
  explicit Scanner(int columns) : columns_(columns) {}

  [[nodiscard]] Frame scan(std::int64_t begin) {
    points_.clear();
    times_.clear();
    for (int column = 0; column < columns_; ++column) {
      const std::int64_t after = scan_length * column / columns_;
      const auto q = joints_at(begin + after);
      std::array<Isometry3d, 3> T_box_sensor;
      Isometry3d T(AngleAxisd(q[0], Vector3d::UnitZ()));
      for (std::size_t i = 0; i < 3; ++i) {
        if (i == 1)
          T = T * Translation3d(0, 0, shoulder_height) * AngleAxisd(q[1], Vector3d::UnitY());
        if (i == 2) T = T * Translation3d(upper_arm, 0, 0) * AngleAxisd(q[2], Vector3d::UnitY());
        T_box_sensor[i] = (T * Translation3d(arm_boxes[i].centre)).inverse() * sensor_pose();
      }
      const int rows = columns_ * 3 / 4;
      for (int row = 0; row < rows; ++row) {
        const Vector3d ray =
            Vector3d(1.0, 0.6 - 1.2 * column / columns_, 0.45 - 0.9 * row / rows).normalized();
        double range = 4.0 / ray.x();  // the wall
        for (std::size_t i = 0; i < 3; ++i)
          if (const auto enters = enter_box(T_box_sensor[i].translation(),
                                            T_box_sensor[i].linear() * ray, arm_boxes[i].size / 2))
            range = std::min(range, *enters);
        points_.push_back((ray * (range + noise * normal_(random_))).cast<float>());
        times_.push_back(std::int32_t(after));
      }
    }
    return {
        .stamp = begin,
        .scan = Scan{.points = {reinterpret_cast<const std::byte*>(points_.data()), points_.size()},
                     .times = times_}};
  }

 private:
  int columns_;
  std::mt19937_64 random_ = seeded_random(59);
  std::normal_distribution<double> normal_;
  std::vector<Eigen::Vector3f> points_;
  std::vector<std::int32_t> times_;
};

/// What a user may have wrong.
struct Mistake {
  Isometry3d T_sensor_given = Isometry3d::Identity();
  std::int64_t late = 0;  // nanoseconds by which the joints' stamps are wrong
  double zero = 0.0;      // of the joint 'lift', rad
};

Session session_of(const Mistake& mistake = {}) {
  return Session(box_arm(), CloudConfig{.T_parent_sensor = sensor_pose() * mistake.T_sensor_given});
}

/// Shows a session scans at 10 Hz.
void watch(Session& session, int scans, int columns, const Mistake& mistake = {}) {
  Scanner scanner(columns);
  for (int i = 0; i < scans; ++i) {
    Frame frame = scanner.scan(i * scan_length);
    frame.pose_at = [&](std::int64_t stamp, RobotPose& pose) {
      pose.positions = joints_at(stamp + mistake.late);
      pose.positions[1] += mistake.zero;
    };
    ASSERT_EQ(session.process(frame).status, FrameStatus::ok);
  }
}

constexpr int few_scans = 40, columns_of_few = 80;

TEST(ScanSetup, NothingIsSaidOfARightOne) {
  Session session = session_of();
  watch(session, few_scans, columns_of_few);
  EXPECT_GE(session.poses(), KeptFrames::least);
  EXPECT_EQ(session.diagnosis().cause, Diagnosis::Cause::none) << session.diagnosis().message;
  EXPECT_TRUE(session.warnings().empty()) << session.warnings().front();
}

TEST(ScanSetup, ASensorThatStandsElsewhereIsNamedWithTheAmount) {
  for (const Vector3d& by : {Vector3d(0.03, 0, 0), Vector3d(0, 0.02, -0.1)}) {
    const Mistake mistake{.T_sensor_given = at(by)};
    Session session = session_of(mistake);
    watch(session, few_scans, columns_of_few, mistake);
    const Diagnosis& found = session.diagnosis();
    EXPECT_EQ(found.cause, Diagnosis::Cause::camera_pose) << found.message;
    ASSERT_TRUE(holds(found.message, "the sensor's pose is about ")) << found.message;
    const double amount =
        std::stod(found.message.substr(found.message.find_first_of("0123456789")));
    constexpr double within = 12.0;  // mm: the error bars are up to as long
    EXPECT_NEAR(amount, 1e3 * by.norm(), within) << found.message;
    EXPECT_FALSE(holds(found.message, "calibrate")) << "which reads no clouds";
    EXPECT_EQ(session.warnings().size(), 1U) << "one line for one mistake";
  }
}

TEST(ScanSetup, WrongJointsAreNamed) {
  using enum Diagnosis::Cause;
  for (const auto& [mistake, cause, named] :
       {std::tuple(Mistake{.zero = -0.15}, joint_zero, "'lift'"),
        std::tuple(Mistake{.late = 60 * ms}, joint_time, "scans and joint states")}) {
    Session session = session_of();
    watch(session, few_scans, columns_of_few, mistake);
    EXPECT_EQ(session.diagnosis().cause, cause);
    EXPECT_TRUE(holds(session.diagnosis().message, named));
  }
}

TEST(ScanSetup, CloudsWithoutRaysAreNotDiagnosed) {
  Session session = session_of();
  Scanner scanner(columns_of_few);
  Frame frame = scanner.scan(0);
  frame.scan->origin.reset();
  frame.pose.positions = joints_at(0);
  session.process(frame);
  EXPECT_EQ(session.poses(), 0U);
}

TEST(ScanSetup, AMovedSensorDriftsAndARightOneDoesNot) {
  constexpr int scans = 300, columns = 120;
  for (const double moved : {0.0, 0.025}) {
    const Mistake mistake{.T_sensor_given = at(0, moved, 0)};
    Session session = session_of(mistake);
    watch(session, scans, columns, mistake);
    const Drift& drift = session.drift();
    std::cout << "drift " << drift.is_known << " " << drift.position() << " +- "
              << drift.position_error() << " of " << moved << ": " << drift.message() << '\n';
    EXPECT_TRUE(drift.is_known);
    EXPECT_EQ(drift.has_moved, moved > 0.0) << drift.message();
    EXPECT_EQ(session.warnings().empty(), moved == 0.0);
  }
}

}  // namespace
}  // namespace penumbra::test
