// SPDX-License-Identifier: Apache-2.0
// Where to put a camera: verdicts against spheres and boxes that a formula intersects, sets against
// brute force.
#include "../pipeline/slab_scene.hpp"

#include <penumbra/mesh/primitives.hpp>
#include <penumbra/planning/view_planning.hpp>

namespace penumbra::test {
namespace {

constexpr Tolerance planned_tolerance{0.02, 0.0, 0.0};

/// Shares this close to a threshold are not compared: pixels at outlines count in one and not in
/// the other.
constexpr double near_threshold = 0.03;

struct Ball {
  const char* name;
  Vector3d centre;
  double radius;
};

const std::vector<Ball> balls = {{"behind the slab", {0.05, 0.02, 1.9}, 0.08},
                                 {"behind the plate", {0.55, 0.15, 2.4}, 0.05},
                                 {"beside", {-0.6, -0.3, 1.4}, 0.06}};

ForecastCamera candidate(const std::string& name, const std::string& link,
                         const Isometry3d& T_link_camera, const DepthRange& range = {}) {
  ForecastCamera camera{.name = name, .camera = slab_camera()};
  camera.camera.parent = link;
  camera.camera.T_parent_camera = T_link_camera;
  camera.camera.range = range;
  camera.rule.tolerance = planned_tolerance;
  return camera;
}

Frame frame_at(const Robot& robot, double slide, const std::vector<Target>& targets) {
  Frame frame;
  frame.pose.T_root_link.resize(robot.links().size());
  robot.forward_kinematics(std::vector{slide}, frame.pose.T_root_link);
  frame.targets = targets;
  return frame;
}

std::vector<Target> ball_targets() {
  std::vector<Target> targets(balls.size());
  for (std::size_t i = 0; i < balls.size(); ++i) {
    targets[i].name = balls[i].name;
    targets[i].shape = PointTarget{balls[i].centre, balls[i].radius, ReferenceFrame::root()};
  }
  return targets;
}

bool meets(const Ball& ball, const Vector3d& origin, const Vector3d& ray) {
  const Vector3d to = ball.centre - origin;
  return to.dot(ray) > 0.0 && to.cross(ray.normalized()).norm() <= ball.radius;
}

/// What the camera sees of a ball by the definition; nothing where pixels at outlines decide.
std::optional<Verdict> verdict_by_rays(const Ball& ball, const Isometry3d& T_root_camera,
                                       const std::vector<SlabBox>& robot) {
  const Intrinsics k = slab_camera().intrinsics;
  const Vector3d origin = T_root_camera.translation();
  const double depth = (T_root_camera.inverse() * ball.centre).z();
  const double margin = ball.radius + planned_tolerance.at(depth);
  std::size_t inside = 0, hidden = 0, unknown = 0;
  for (const auto [u, v] : each_pixel(k)) {
    const Vector3d ray = T_root_camera.linear() * k.ray(u, v);
    if (!meets(ball, origin, ray)) continue;
    ++inside;
    double nearest = inf;  // z of the optical frame
    for (const SlabBox& box : robot)
      nearest =
          std::min(nearest, enter_box(origin - box.centre, ray, box.size / 2).value_or(nearest));
    if (nearest < depth - margin)
      ++hidden;
    else if (nearest <= depth + margin)
      ++unknown;
  }
  if (inside == 0) return Verdict::out_of_view;
  const double share = double(hidden) / double(inside);
  const TargetThresholds limits;
  const auto is_near = [&](double limit) { return std::abs(share - limit) < near_threshold; };
  if (inside < 20 || unknown > 0 || (is_near(limits.partial_enter) && share > 0.0) ||
      is_near(limits.hidden_enter))
    return std::nullopt;
  if (share > limits.hidden_enter) return Verdict::hidden;
  return share > limits.partial_enter ? Verdict::partial : Verdict::visible;
}

/// Around the scene, looking at about its middle.
std::vector<ForecastCamera> random_candidates(std::mt19937_64& random, std::size_t count) {
  std::uniform_real_distribution<double> side(-0.8, 0.8), behind(-0.9, 0.2), angle(-0.5, 0.5);
  std::vector<ForecastCamera> candidates;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d at(side(random), side(random), behind(random));
    const Vector3d ahead = (Vector3d(0.1 + angle(random), angle(random), 1.7) - at).normalized();
    const auto turn = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), ahead) *
                      AngleAxisd(angle(random), Vector3d::UnitZ());
    candidates.push_back(candidate(std::to_string(i), "", Translation3d(at) * turn));
  }
  return candidates;
}

TEST(ViewPlanning, VerdictsAreThoseOfRays) {
  std::mt19937_64 random = seeded_random(20261);
  const Robot robot = slab_robot();
  const std::vector<ForecastCamera> candidates = random_candidates(random, 40);
  const Vector3d part(0.3, 0.3, 0.1);
  const AttachedBody body{"part", "slab", std::make_shared<PreparedMesh>(make_box(part)),
                          at(-0.2, 0.1, 0.1)};
  std::vector<Frame> motion;
  std::vector<std::vector<SlabBox>> boxes;
  for (int i = 0; i < 12; ++i) {
    const double slide = -0.3 + 0.08 * i;
    motion.push_back(frame_at(robot, slide, ball_targets()));
    boxes.push_back(
        {{{0.0, 0.0, 1.0 + slide}, {0.4, 0.2, 0.1}}, {{0.5, 0.1, 1.5}, {0.2, 0.2, 0.1}}});
    if (i % 2 == 0) continue;
    motion.back().pose.attached = {body};
    boxes.back().push_back({{-0.2, 0.1, 1.1 + slide}, part});
  }
  const CandidateViews views = judge_candidates(robot, candidates, motion, 3);
  std::map<Verdict, int> compared;
  std::vector<std::vector<int>> visible(candidates.size(), std::vector<int>(balls.size()));
  for (std::size_t c = 0; c < candidates.size(); ++c)
    for (std::size_t f = 0; f < motion.size(); ++f)
      for (std::size_t t = 0; t < balls.size(); ++t) {
        visible[c][t] += views.at(c, f, t) == Verdict::visible;
        const auto wanted = verdict_by_rays(balls[t], candidates[c].camera.pose(), boxes[f]);
        if (!wanted) continue;
        ++compared[*wanted];
        EXPECT_EQ(views.at(c, f, t), *wanted)
            << "candidate " << c << ", frame " << f << ", " << balls[t].name;
      }
  for (const Verdict verdict :
       {Verdict::visible, Verdict::partial, Verdict::hidden, Verdict::out_of_view})
    EXPECT_GT(compared[verdict], 20) << to_string(verdict);
  for (std::size_t c = 0; c < candidates.size(); ++c)
    for (std::size_t t = 0; t < balls.size(); ++t)
      EXPECT_DOUBLE_EQ(views.share(c, t, Verdict::visible), visible[c][t] / 12.0);
}

/// The verdicts of one candidate for targets at one pose of the robot.
std::vector<Verdict> judged(const ForecastCamera& camera, const std::vector<Target>& targets,
                            double slide = 0.0, std::string* why = nullptr) {
  const Robot robot = slab_robot();
  const std::vector<Frame> motion{frame_at(robot, slide, targets)};
  const CandidateViews views = judge_candidates(robot, {&camera, 1}, motion, 1);
  std::vector<Verdict> verdicts;
  for (std::size_t t = 0; t < targets.size(); ++t) verdicts.push_back(views.at(0, 0, t));
  if (why != nullptr) *why = views.unknown(0);
  return verdicts;
}

Target point_at(const Vector3d& position, const ReferenceFrame& frame, const char* name = "point") {
  return {.name = name, .shape = PointTarget{position, 0.03, frame}};
}

const ForecastCamera at_root = candidate("root", "", at(0.0, 0.0, 0.0));

TEST(ViewPlanning, CamerasAndTargetsMoveWithTheirLinks) {
  const ForecastCamera on_slab = candidate("on slab", "slab", at(0.0, 0.0, 0.2));
  const Target ahead = point_at({0.0, 0.0, 1.5}, ReferenceFrame::of_link("slab"));
  for (const double slide : {0.0, 0.5, -0.5})
    EXPECT_EQ(judged(on_slab, {ahead}, slide).front(), Verdict::visible) << slide;
  EXPECT_EQ(judged(at_root, {ahead}).front(), Verdict::hidden) << "by the slab itself";
  const Target box{.name = "box",
                   .shape = BoxTarget{at(0.0, 0.0, 2.0), {0.1, 0.1, 0.1}, ReferenceFrame::root()}};
  EXPECT_EQ(judged(at_root, {box}).front(), Verdict::hidden);
  EXPECT_EQ(judged(on_slab, {box}).front(), Verdict::visible);
}

TEST(ViewPlanning, WhatIsNotKnownIsNeverVisible) {
  const Target beside = point_at({-0.6, 0.0, 1.4}, ReferenceFrame::root());
  EXPECT_EQ(judged(at_root, {beside}).front(), Verdict::visible);
  for (const DepthRange& range : {DepthRange{0.3, 1.3}, {1.5, 9.0}})
    EXPECT_EQ(judged(candidate("root", "", at(0.0, 0.0, 0.0), range), {beside}).front(),
              Verdict::out_of_view);

  std::string why;
  const ForecastCamera inside = candidate("inside", "slab", at(0.0, 0.0, 0.0));
  EXPECT_EQ(judged(inside, {beside}, 0.0, &why).front(), Verdict::unknown);
  EXPECT_TRUE(holds(why, "inside link 'slab'"));
  Target absent = beside;
  absent.shape = std::monostate();
  EXPECT_EQ(judged(at_root, {absent}).front(), Verdict::unknown);
  Target lenient = point_at({0.0, 0.0, 2.0}, ReferenceFrame::root());
  lenient.thresholds.beyond_hides = false;  // of a sensor's image, and there is none
  EXPECT_EQ(judged(at_root, {lenient}).front(), Verdict::hidden);
  EXPECT_EQ(judged(at_root, {point_at({0.0, 0.0, 0.95}, ReferenceFrame::root())}).front(),
            Verdict::unknown)
      << "at the slab's own depth";

  const Robot robot = slab_robot();
  const auto verdict = [&](const Frame& frame, const DepthRange& range = {}) {
    const ForecastCamera camera = candidate("root", "", at(0.0, 0.0, 0.0), range);
    return judge_candidates(robot, {&camera, 1}, {&frame, 1}, 1).at(0, 0, 0);
  };
  Frame frame = frame_at(robot, 0.0, {beside});
  frame.pose.attached = {{"lost", "slab", nullptr, at(0, 0, 0)}};
  EXPECT_EQ(verdict(frame), Verdict::unknown) << "a body without a mesh";
  frame.pose.attached.clear();
  frame.pose.uncertain_links = {*robot.find_link("base")};
  EXPECT_EQ(verdict(frame), Verdict::unknown);
  frame = frame_at(robot, 0.0, {point_at({0.0, 0.0, 1.0}, ReferenceFrame::of_link("slab"))});
  frame.pose.uncertain_links = {*robot.find_link("slab")};
  EXPECT_EQ(verdict(frame, {0.1, 1.0}), Verdict::unknown)
      << "neither hidden nor out of the camera's range";
}

/// A foil 5 mm before the camera, thinner than what is drawn of it.
TEST(ViewPlanning, WhatIsTooNearToBeDrawnMakesUnknown) {
  const Robot robot =
      parse(slab_urdf(link_xml("foil", box_xml("0.4 0.4 0.001")) +
                      joint_xml("wrap", "fixed", "base", "foil", "<origin xyz=\"0 0 0.005\"/>")));
  const std::vector<Frame> motion{
      frame_at(robot, 0.0,
               {point_at({-0.6, 0.0, 1.4}, ReferenceFrame::root()),
                point_at({0.0, 0.0, 2.0}, ReferenceFrame::root(), "far")})};
  const CandidateViews views = judge_candidates(robot, {&at_root, 1}, motion, 1);
  EXPECT_EQ(views.at(0, 0, 0), Verdict::unknown);
  EXPECT_EQ(views.at(0, 0, 1), Verdict::hidden) << "by the slab, whatever else does";
  EXPECT_TRUE(holds(views.unknown(0), "too near"));
}

TEST(ViewPlanning, RefusesUnknownLinksAndSets) {
  const ForecastCamera lost = candidate("lost", "slap", at(0, 0, 0));
  const Robot robot = slab_robot();
  const std::vector<Frame> motion{frame_at(robot, 0.0, ball_targets())};
  expect_refused([&] { (void)judge_candidates(robot, {&lost, 1}, motion, 2); }, {"slap"});
  const CandidateViews views(3, 1, 1);
  for (const std::size_t most : {0U, 4U})
    expect_refused([&] { (void)best_cameras(views, most); }, {"3"});
  EXPECT_NO_THROW(check_camera_sets(60, 6)) << "56 million";
  expect_refused([&] { check_camera_sets(60, 7); }, {"60 candidates", "fewer cameras"});
  expect_refused([&] { check_camera_sets(1000, 1000); }, {"1000 candidates", "fewer candidates"});
}

CandidateViews random_views(std::mt19937_64& random, std::size_t candidates, double share) {
  CandidateViews views(candidates, 31, 3);  // a number of bits that fills no words
  std::bernoulli_distribution is_seen(share);
  for (std::size_t c = 0; c < candidates; ++c)
    for (std::size_t f = 0; f < views.frames(); ++f)
      for (std::size_t t = 0; t < views.targets(); ++t)
        views.at(c, f, t) = is_seen(random) ? Verdict::visible : Verdict::partial;
  return views;
}

double mean_of(const CandidateViews& views, const std::vector<std::size_t>& set) {
  std::set<std::pair<std::size_t, std::size_t>> seen;
  for (const std::size_t c : set)
    for (std::size_t f = 0; f < views.frames(); ++f)
      for (std::size_t t = 0; t < views.targets(); ++t)
        if (views.at(c, f, t) == Verdict::visible) seen.emplace(f, t);
  return double(seen.size()) / double(views.frames() * views.targets());
}

/// How many pairs of frame and target all see together, and the sum of those that each sees.
std::pair<long, long> worth_of(const CandidateViews& views, const std::vector<std::size_t>& set) {
  const auto pairs = double(views.frames() * views.targets());
  long alone = 0;
  for (const std::size_t c : set) alone += std::lround(pairs * mean_of(views, {c}));
  return {std::lround(pairs * mean_of(views, set)), alone};
}

void expect_consistent(const CandidateViews& views, const CameraSet& set, std::size_t size) {
  EXPECT_EQ(set.candidates.size(), size);
  EXPECT_EQ(std::set(set.candidates.begin(), set.candidates.end()).size(), size);
  EXPECT_TRUE(std::is_sorted(set.candidates.begin(), set.candidates.end()));
  EXPECT_NEAR(set.mean, mean_of(views, set.candidates), 1e-12);
  double sum = 0.0;
  for (const double share : set.visible) sum += share;
  EXPECT_NEAR(set.mean, sum / double(set.visible.size()), 1e-12);
}

TEST(ViewPlanning, SetsAreTheBest) {
  std::mt19937_64 random = seeded_random(20262);
  for (int round = 0; round < 20; ++round) {
    const CandidateViews views = random_views(random, 8, 0.15);
    const std::vector<CameraSet> best = best_cameras(views, 8);
    ASSERT_EQ(best.size(), 8U);
    for (std::size_t size = 1; size <= 8; ++size) {
      std::pair most(0L, 0L);
      for (unsigned members = 0; members < 256; ++members) {
        std::vector<std::size_t> set;
        for (std::size_t c = 0; c < 8; ++c)
          if ((members >> c & 1U) != 0) set.push_back(c);
        if (set.size() == size) most = std::max(most, worth_of(views, set));
      }
      const CameraSet& found = best[size - 1];
      expect_consistent(views, found, size);
      EXPECT_EQ(worth_of(views, found.candidates), most) << size;
    }
  }
}

}  // namespace
}  // namespace penumbra::test
