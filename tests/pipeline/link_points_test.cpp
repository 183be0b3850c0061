// SPDX-License-Identifier: Apache-2.0
// Points on links, in a scene whose depth a formula tells.
#include "slab_scene.hpp"

#include <penumbra/pipeline/link_points.hpp>

namespace penumbra::test {
namespace {

const Vector3d slab_size(0.4, 0.2, 0.1);

/// Points 1 cm inside of the edges of the slab's near and far faces: none is next to an outline.
std::vector<Vector3d> face_points(double side) {
  std::vector<Vector3d> points;
  for (const auto [i, j] : each_pixel(0, 0, 11, 6))
    points.emplace_back(-0.19 + 0.038 * i, -0.09 + 0.036 * j, 0.05 * side);
  return points;
}

void expect_all(const std::vector<PointView>& views, Verdict verdict, int hidden_by = 0) {
  ASSERT_FALSE(views.empty());
  for (const PointView& view : views) {
    EXPECT_EQ(view.verdict, verdict) << view.pixel.transpose();
    EXPECT_EQ(view.hidden_by, hidden_by) << view.pixel.transpose();
  }
}

class LinkPoints : public testing::Test {
 protected:
  std::vector<PointView> views(const Frame& frame, const std::vector<Vector3d>& points,
                               const PipelineConfig& config = plain_config()) {
    pipeline_ = std::make_unique<Pipeline>(slab_robot(), slab_camera(), config);
    const FrameReport& report = pipeline_->process(frame);
    return PointJudge(pipeline_->robot()).judge(report, pipeline_->report_camera(), "slab", points);
  }

  std::unique_ptr<Pipeline> pipeline_;
  Image<float> depth_ = scene_depth(slab_camera(), 0.0);
};

TEST_F(LinkPoints, AreSpreadByArea) {
  constexpr std::size_t count = 5000;
  const std::vector<Vector3d> points = points_on(slab_robot(), "slab", count);
  ASSERT_EQ(points.size(), count);
  EXPECT_EQ(points, points_on(slab_robot(), "slab", count));
  const double area = 2 * (0.4 * 0.2 + 0.4 * 0.1 + 0.2 * 0.1);
  std::array<std::array<double, 2>, 3> of_face{};
  for (const Vector3d& p : points) {
    const Eigen::Array3d from_face = p.array().abs() - slab_size.array() / 2;
    int axis = 0;
    EXPECT_NEAR(from_face.maxCoeff(&axis), 0.0, 1e-7);  // metres: float32 vertices
    ++of_face[axis][p[axis] > 0.0 ? 1 : 0];
  }
  for (int axis = 0; axis < 3; ++axis)
    for (const double found : of_face[axis])  // of a face's two triangles each has one more or less
      EXPECT_NEAR(found, count * slab_size.prod() / slab_size[axis] / area, 2.0);

  // Squares of 2 cm of the near face: each has its share, which random points miss by 4 and more.
  std::map<std::pair<int, int>, int> squares;
  for (const Vector3d& p : points)
    if (p.z() < -0.05 + 1e-6)
      ++squares[{int(std::floor(p.x() / 0.02)), int(std::floor(p.y() / 0.02))}];
  ASSERT_EQ(squares.size(), 200U);
  double squared = 0.0;
  const double share = count * 0.0004 / area;
  for (const auto& [square, found] : squares) squared += std::pow(found - share, 2);
  EXPECT_LT(squared / 200.0, share / 2) << "random points have a variance of " << share;
}

TEST_F(LinkPoints, NeedASurface) {
  EXPECT_THROW((void)points_on(slab_robot(), "base", 3), InputError);
  EXPECT_THROW((void)points_on(slab_robot(), "slap", 3), InputError);
  EXPECT_TRUE(points_on(slab_robot(), "slab", 0).empty());
}

TEST_F(LinkPoints, AreWhereTheCameraProjectsThem) {
  const std::vector<Vector3d> points = face_points(-1.0);
  const auto found = views(frame_of(depth_), points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d p = points[i] + Vector3d(0, 0, 1);
    EXPECT_DOUBLE_EQ(found[i].depth, p.z());
    EXPECT_TRUE(found[i].pixel.isApprox(slab_camera().intrinsics.project(p), 1e-12));
  }
}

TEST_F(LinkPoints, OnTheFarSideAreHiddenByTheirOwnLink) {
  PipelineConfig no_depth = plain_config();
  no_depth.has_depth = false;
  for (const PipelineConfig& config : {plain_config(), no_depth}) {
    const Frame frame = config.has_depth ? frame_of(depth_) : Frame{.pose = {.positions = {0.0}}};
    expect_all(views(frame, face_points(-1.0), config), Verdict::visible);
    expect_all(views(frame, face_points(1.0), config), Verdict::hidden, 2);
  }
}

TEST_F(LinkPoints, OfAThinSheetAreHiddenOnItsFarSide) {
  // 1 mm thick, 1.2 mm a pixel, seen at any angle.
  std::mt19937_64 random = seeded_random(301);
  for (int view = 0; view < 20; ++view) {
    const std::string turn = " rpy=\"" + std::to_string(uniform(random, -1.2, 1.2)) + " " +
                             std::to_string(uniform(random, -1.2, 1.2)) + " 0\"";
    const Robot robot = parse(robot_xml(
        link_xml("base") + link_xml("sheet", box_xml("0.2 0.2 0.001")) +
        joint_xml("hold", "fixed", "base", "sheet", "<origin xyz=\"0 0 1\"" + turn + "/>")));
    PipelineConfig config = plain_config();
    config.has_depth = false;
    Pipeline pipeline(robot, camera_at_root(Intrinsics(640, 480, 830, 830, 319, 241)), config);
    const FrameReport& report = pipeline.process({});
    ASSERT_EQ(report.status, FrameStatus::ok);
    const bool is_front = report.T_root_link[1].linear()(2, 2) > 0.0;  // its -z side
    for (const double side : {-1.0, 1.0}) {
      std::vector<Vector3d> points;
      for (int i = 0; i < 50; ++i)
        points.emplace_back(uniform(random, -0.09, 0.09), uniform(random, -0.09, 0.09),
                            0.0005 * side);
      const bool is_seen = is_front == (side < 0.0);
      expect_all(
          PointJudge(pipeline.robot()).judge(report, pipeline.report_camera(), "sheet", points),
          is_seen ? Verdict::visible : Verdict::hidden, is_seen ? 0 : 2);
    }
  }
}

TEST_F(LinkPoints, BehindWhatTheRobotCarriesAreHiddenByIt) {
  const auto found = views(frame_of(depth_, 0.0, {}, {part()}), {{0.17, 0.06, -0.05}});
  expect_all(found, Verdict::hidden, 4);
}

TEST_F(LinkPoints, BehindSomethingElseAreHiddenByNoLink) {
  const std::vector<Vector3d> point{{0.0, 0.0, -0.05}};
  const auto [u, v] = std::pair(73, 57);
  depth_(u, v) = 0.5F;
  expect_all(views(frame_of(depth_), point), Verdict::hidden, 0);
  for (const float not_the_robot : {0.0F, 2.0F}) {
    depth_(u, v) = not_the_robot;
    expect_all(views(frame_of(depth_), point), Verdict::unknown);
  }
  depth_(u, v) = 0.95F;
  expect_all(views(frame_of(depth_), point), Verdict::visible);
}

TEST_F(LinkPoints, OutsideTheImageAreOutOfView) {
  const std::vector<Vector3d> points{{5, 0, 0}, {0, 5, 0}, {0, 0, -1.005}, {0, 0, -3}};
  expect_all(views(frame_of(depth_), points), Verdict::out_of_view);
}

TEST_F(LinkPoints, AreUnknownWhileTheRobotOrTheDepthIs) {
  expect_all(views({.depth = depth_.view()}, face_points(-1.0)), Verdict::unknown);
  expect_all(views({.pose = {.positions = {0.0}}}, face_points(-1.0)), Verdict::unknown);
  expect_all(views({.pose = {.positions = {0.0}}}, face_points(1.0)), Verdict::hidden, 2);
  Frame frame = frame_of(depth_);
  frame.pose.uncertain_links = {2};  // the plate, which may be anywhere on its arm
  for (const PointView& view : views(frame, face_points(-1.0)))
    EXPECT_NE(view.verdict, Verdict::hidden);
  frame.pose.uncertain_links = {1};
  for (const PointView& view : views(frame, face_points(-1.0))) {
    EXPECT_EQ(view.verdict, Verdict::unknown);
    EXPECT_TRUE(std::isnan(view.depth));
  }
}

TEST_F(LinkPoints, AreNotVisibleWhileAPartOfTheRobotIsNotDrawn) {
  PipelineConfig no_depth = plain_config();
  no_depth.has_depth = false;
  for (const PipelineConfig& config : {plain_config(), no_depth}) {
    Pipeline pipeline(slab_robot_without_mesh(), slab_camera(), config);
    const FrameReport& report = pipeline.process(frame_of(depth_));
    expect_all(PointJudge(pipeline.robot())
                   .judge(report, pipeline.report_camera(), "slab", face_points(-1.0)),
               Verdict::unknown);
    expect_all(PointJudge(pipeline.robot())
                   .judge(report, pipeline.report_camera(), "slab", face_points(1.0)),
               Verdict::hidden, 2);
  }
}

TEST_F(LinkPoints, AreRefusedForAnotherLink) {
  Pipeline pipeline(slab_robot(), slab_camera(), plain_config());
  const FrameReport& report = pipeline.process(frame_of(depth_));
  EXPECT_THROW(
      (void)PointJudge(pipeline.robot()).judge(report, pipeline.report_camera(), "slap", {}),
      InputError);
}

}  // namespace
}  // namespace penumbra::test
