// SPDX-License-Identifier: Apache-2.0
#include "../support/test.hpp"
#include "files.hpp"
#include "robots.hpp"

#include <io/files/bitmap_font.hpp>
#include <io/files/overlay_painter.hpp>
#include <io/files/target_overlay.hpp>

namespace penumbra::io {
namespace {

constexpr Rgb8 white{255, 255, 255};
constexpr Rgb8 black{0, 0, 0};

// A scene of one grey with a robot's rectangle of one label in it.
struct Scene {
  Scene(int width, int height, Label label)
      : color(width, height, Rgb8{100, 100, 100}), labels(width, height) {
    for (int v = height / 2; v < height / 2 + height / 4; ++v)
      for (int u = width / 2; u < width / 2 + width / 4; ++u)
        labels(u, v) = static_cast<std::uint8_t>(label);
    report.index = 3;
    report.labels = std::as_const(labels).view();
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  [[nodiscard]] ShownImages images() const { return {{}, std::as_const(color).view()}; }

  Image<Rgb8> color;
  Image<std::uint8_t> labels;
  FrameReport report;
};

TEST(Overlay, BlendsTheLabelAndKeepsTheScene) {
  for (const Label label : {Label::front, Label::occluded, Label::unknown, Label::beyond}) {
    const Scene scene(640, 480, label);
    Image<Rgb8> out;
    draw_overlay(scene.report, scene.images(), out);
    ASSERT_EQ(out.width(), 640);
    ASSERT_EQ(out.height(), 480);
    const Rgb8 wanted = label_color(label);
    const auto blended = [](int value) { return static_cast<std::uint8_t>((100 + value) / 2); };
    EXPECT_EQ(out(400, 300), (Rgb8{blended(wanted.r), blended(wanted.g), blended(wanted.b)}));
    EXPECT_EQ(out(600, 460), (Rgb8{100, 100, 100}));
  }
}

TEST(Overlay, ShowsDepthWithoutColor) {
  Image<float> metres(64, 480, 0.0F);
  for (int v = 0; v < 480; ++v) {
    metres(50, v) = 0.5F;
    metres(51, v) = 2.0F;
    metres(52, v) = std::numeric_limits<float>::quiet_NaN();
    metres(53, v) = std::numeric_limits<float>::infinity();
    metres(54, v) = -1.0F;
    metres(55, v) = 0.001F;
  }
  Image<std::uint16_t> millimetres(64, 480, 0);
  for (int v = 0; v < 480; ++v) millimetres(50, v) = 500, millimetres(51, v) = 2000;
  Image<Rgb8> of_metres, of_millimetres;
  draw_overlay({}, {std::as_const(metres).view(), {}}, of_metres);
  draw_overlay({}, {std::as_const(millimetres).view(), {}}, of_millimetres);
  EXPECT_GT(of_metres(50, 400).r, of_metres(51, 400).r);
  EXPECT_GT(of_metres(51, 400).r, 0);
  for (int u = 52; u < 55; ++u) EXPECT_EQ(of_metres(u, 400), black) << u;
  EXPECT_EQ(of_metres(55, 400), white);
  EXPECT_EQ(of_metres(50, 400), of_millimetres(50, 400));
  EXPECT_EQ(of_metres(51, 400), of_millimetres(51, 400));
}

/// The legend as read from the picture: `text` in white, wherever it stands.
bool shows(const Image<Rgb8>& picture, std::string_view text) {
  const int width = static_cast<int>(text.size()) * BitmapFont::advance;
  Image<Rgb8> ink(width, BitmapFont::height);
  BitmapFont::draw(text, 0, 0, 1, white, ink);
  const auto matches = [&](int u, int v) {
    for (int y = 0; y < ink.height(); ++y)
      for (int x = 0; x < width; ++x)
        if ((ink(x, y) == white) != (picture(u + x, v + y) == white)) return false;
    return true;
  };
  for (int v = 0; v + BitmapFont::height <= picture.height(); ++v)
    for (int u = 0; u + width <= picture.width(); ++u)
      if (matches(u, v)) return true;
  return false;
}

TEST(Overlay, WithoutAPoseTheLegendCountsNoRobot) {
  Scene scene(320, 240, Label::unknown);
  scene.labels = Image<std::uint8_t>(320, 240, static_cast<std::uint8_t>(Label::unknown));
  scene.report.labels = std::as_const(scene.labels).view();
  scene.report.pixels.robot = scene.report.pixels.unknown = scene.labels.size();
  Image<Rgb8> out;
  draw_overlay(scene.report, scene.images(), out);
  EXPECT_TRUE(shows(out, "robot 76800 px")) << "the test can read the legend";
  scene.report.status = FrameStatus::missing_joints;
  draw_overlay(scene.report, scene.images(), out);
  EXPECT_TRUE(shows(out, "robot: pose unknown"));
  EXPECT_TRUE(shows(out, "unknown  all pixels"));
  EXPECT_FALSE(shows(out, "robot 76800 px"));
}

// Every pair of label colours stays apart for normal sight and for people who lack one kind of
// cone: simulation matrices of severity 1 by Machado, Oliveira and Fernandes (2009), which work on
// linear RGB; distance in CIELAB (1976), where 2.3 is just noticeable.
TEST(Overlay, ColorsAreToldApartByAll) {
  constexpr double clearly_apart = 20.0;
  using Matrix = Eigen::Matrix3d;
  const Matrix protan{{0.152286, 1.052583, -0.204868},
                      {0.114503, 0.786281, 0.099216},
                      {-0.003882, -0.048116, 1.051998}};
  const Matrix deutan{{0.367322, 0.860646, -0.227968},
                      {0.280085, 0.672501, 0.047413},
                      {-0.011820, 0.042940, 0.968881}};
  const Matrix tritan{{1.255528, -0.076749, -0.178779},
                      {-0.078411, 0.930809, 0.147602},
                      {0.004733, 0.691367, 0.303900}};
  const Matrix to_xyz{{0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}};
  const auto linear = [](std::uint8_t value) {
    const double c = value / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  const auto lab = [&](Rgb8 c, const Matrix& sight) {
    const Eigen::Vector3d seen =
        (sight * Eigen::Vector3d(linear(c.r), linear(c.g), linear(c.b))).cwiseMax(0).cwiseMin(1);
    const Eigen::Vector3d xyz = (to_xyz * seen).cwiseQuotient(Eigen::Vector3d(0.9505, 1.0, 1.089));
    const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116.0; };
    return Eigen::Vector3d(116 * f(xyz.y()) - 16, 500 * (f(xyz.x()) - f(xyz.y())),
                           200 * (f(xyz.y()) - f(xyz.z())));
  };
  const Matrix normal = Matrix::Identity();
  for (const Matrix* sight : {&normal, &protan, &deutan, &tritan})
    for (int a = 1; a < 5; ++a)
      for (int b = 1; b < a; ++b)
        EXPECT_GT((lab(label_color(static_cast<Label>(a)), *sight) -
                   lab(label_color(static_cast<Label>(b)), *sight))
                      .norm(),
                  clearly_apart)
            << a << " and " << b;
}

constexpr Rgb8 grey{100, 100, 100};
constexpr std::int64_t second = 1'000'000'000;

class TargetOverlayTest : public testing::Test {
 protected:
  /// A frame with one target, seen from a camera at x in the root's frame that looks along z.
  Image<Rgb8> draw(const TargetReport& said, std::int64_t stamp, double camera_x,
                   const TargetShape& shape) {
    const Target target{.name = std::string(said.name), .shape = shape};
    FrameReport report;
    report.stamp = stamp;
    report.T_root_camera = Eigen::Translation3d(camera_x, 0, 0) * Eigen::Isometry3d::Identity();
    report.T_root_link = {&T_root_, 1};
    report.targets = {&said, 1};
    Image<Rgb8> out(320, 240, grey);
    overlay_.draw({&target, 1}, report, robot_, camera_, out);
    return out;
  }
  static bool is_drawn(const Image<Rgb8>& image, int u, int v) { return !(image(u, v) == grey); }

  const Robot robot_ = test::bare_robot();
  const Camera camera_{Intrinsics(320, 240, 200, 200, 160, 120), {}, {}, "camera"};
  const Eigen::Isometry3d T_root_ = Eigen::Isometry3d::Identity();
  TargetOverlay overlay_;
};

TargetReport said(Verdict verdict, std::int64_t stamp, double occluded) {
  TargetReport report;
  report.name = "lid";
  report.stamp = stamp;
  report.verdict = verdict;
  report.judgement.emplace();
  report.judgement->inside = 100;
  report.judgement->occluded = occluded;
  return report;
}

/// "unknown 0%" would read as "0 % hidden".
TEST_F(TargetOverlayTest, UnknownHasNoShare) {
  const RegionTarget box{PixelBox{100, 100, 40, 40}};
  const auto drawn = [&](Verdict verdict, double share) {
    return draw(said(verdict, 0, share), 0, 0.0, box);
  };
  EXPECT_TRUE(test::same_pixels(drawn(Verdict::unknown, 0.0).view(),
                                drawn(Verdict::unknown, 0.001).view()));
  EXPECT_FALSE(
      test::same_pixels(drawn(Verdict::unknown, 0.0).view(), drawn(Verdict::unknown, 0.5).view()))
      << "at least 50 %";
  EXPECT_FALSE(
      test::same_pixels(drawn(Verdict::partial, 0.3).view(), drawn(Verdict::partial, 0.5).view()));
}

/// The camera moves half a metre meanwhile: what stands still is seen 100 pixels further left.
TEST_F(TargetOverlayTest, ALateTargetIsDrawnWhereItIsSeenNow) {
  const PointTarget ball{.position = {0.25, 0, 1}, .radius = 0.05};  // at u 210, 10 pixels wide
  const Image<Rgb8> first = draw(said(Verdict::visible, 0, 0), 0, 0.0, ball);
  EXPECT_TRUE(is_drawn(first, 200, 120));
  const Image<Rgb8> late = draw(said(Verdict::visible, 0, 0), second, 0.5, ball);
  EXPECT_TRUE(is_drawn(late, 100, 120));
  EXPECT_FALSE(is_drawn(late, 200, 120)) << "as if the camera stood where it was";
  const Image<Rgb8> own = draw(said(Verdict::visible, 2 * second, 0), 2 * second, 0.5, ball);
  EXPECT_TRUE(is_drawn(own, 200, 120)) << "of its own frame it is drawn in that camera";
  const Image<Rgb8> unseen = draw(said(Verdict::visible, -second, 0), 0, 0.0, ball);
  EXPECT_TRUE(test::same_pixels(unseen.view(), Image<Rgb8>(320, 240, grey).view()));
}

}  // namespace
}  // namespace penumbra::io
