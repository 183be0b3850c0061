// SPDX-License-Identifier: Apache-2.0
// penumbra render, inspect and doctor; --renderer and --gl-device: what is taken, what the report
// says of it, what is refused; a graphics device that fails: a plain line, and what was done is
// kept.
#include "../support/opengl.hpp"
#include "../support/run_length.hpp"
#include "fixtures.hpp"

#include <algorithm>

#include <penumbra/base/simd_target.hpp>
#include <penumbra/base/version.hpp>
#include <penumbra/render/gl/gl_devices.hpp>

namespace penumbra::test {
namespace {

constexpr double depth_tolerance = 1e-5;  // metres at 1 m: float32

using RenderTest = TinyTest;

TEST_F(RenderTest, WritesOneVirtualDepthImageAndTellsTimesAndPositions) {
  succeed(render());
  EXPECT_NEAR(read_image<float>(path("vdi.npy"))(31, 23), 0.95, depth_tolerance) << "at rest";
  succeed(render({"--joint", "slide=0.25", "--links", path("links.png")}));
  EXPECT_NEAR(read_image<float>(path("vdi.npy"))(31, 23), 1.2, depth_tolerance);
  const auto links = read_image<std::uint16_t>(path("links.png"));
  EXPECT_EQ(links(31, 23), 2);
  EXPECT_EQ(links(0, 0), 0);

  const Json json =
      Json::parse(succeed(render({"--joint", "slide=0.25", "--repeat", "20", "--json"})).out);
  EXPECT_EQ(json["triangles"], 12);
  EXPECT_GT(json["robot_pixels"], 100);
  EXPECT_EQ(json["joints"]["slide"], 0.25);
  for (const char* stage : {"kinematics_ms", "render_ms", "classify_ms"}) {
    EXPECT_GT(json[stage]["min"], 0.0) << stage;
    EXPECT_GE(json[stage]["median"], json[stage]["min"]) << stage;
    EXPECT_GE(json[stage]["p99"], json[stage]["median"]) << stage;
  }
}

TEST_F(RenderTest, RefusesBadInput) {
  fs::create_directory(path("folder.png"));
  const std::vector<std::pair<Words, std::string>> cases = {
      {{"--joint", "slid=0.1"}, "slide"},
      {{"--joint", "slide"}, "--joint"},
      {{"--joint", "slide=far"}, "slide=far"},
      {{"--joint", "slide=nan"}, "slide=nan"},
      {{"--joint", "slide=1", "--joint", "slide=2"}, "twice"},
      {{"--joint", "slide=1e9"}, "'board'"},
      {{"--joint", "slide=-1"}, "ignore_links"},
      {{"--parent", "bass"}, "bass"},
      {{"--repeat", "0"}, "--repeat"},
      {{"--package", "name"}, "--package"},
      {{"--links", path("vdi.npy")}, "--links"},
      {{"--links", path("links.npy")}, ".png"},
      {{"--links", path("folder.png")}, "is a folder"},
      {{"--links", ""}, "--links"},
      {{"--links", path(".") / "camera_pose.csv"}, "--pose"}};
  const std::string pose = read_file(path("camera_pose.csv"));
  for (const auto& [options, named] : cases) {
    expect_refused(render(options), {named});
    EXPECT_FALSE(fs::exists(path("vdi.npy")));
  }
  EXPECT_EQ(read_file(path("camera_pose.csv")), pose);
}

using InspectTest = RenderTest;

TEST_F(InspectTest, TellsTheSameAsJson) {
  expect_values(Json::parse(succeed(inspect({"--json"})).out), {{"/robot", "tiny"},
                                                                {"/links/0/drawn", false},
                                                                {"/links/1/triangles", 12},
                                                                {"/links/1/watertight", true},
                                                                {"/joints/0/upper", 1.0},
                                                                {"/joints/0/mimic", nullptr},
                                                                {"/variables", Json{"slide"}}});
}

TEST_F(InspectTest, TellsWhereItsOutputCannotBeWritten) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  expect_refused(
      penumbra({"-c", "\"$0\" inspect \"$1\" >/dev/full", PENUMBRA_PROGRAM, path("tiny.urdf")}, {},
               "/bin/sh"),
      {"standard output: cannot be written"});
}

TEST_F(InspectTest, PathsNeverSteerTheTerminal) {
  edit("tiny.urdf", "board.stl", "\x1b[31m\u009b31mred.stl");
  const std::string text = succeed(inspect({"--allow-missing-meshes"})).out;
  expect_lacks(text, {"\x1b", "\u009b"});
  expect_has(text, {"?[31m?31mred.stl"});
}

Json doctor_json(const Words& environment = {}) {
  const Outcome outcome = succeed(penumbra({"doctor", "--json"}, environment));
  EXPECT_EQ(outcome.err, "");
  return Json::parse(outcome.out);
}

TEST(Doctor, JsonHasTheBuildAndTheMachine) {
  const Json json = doctor_json();
  EXPECT_EQ(keys(json),
            (Words{"penumbra", "build", "cpu", "opengl", "renderers", "network", "libraries"}));
  EXPECT_EQ(json["penumbra"], PENUMBRA_VERSION);
  EXPECT_EQ(keys(json["build"]), (Words{"type", "compiler", "sanitizers", "opengl", "dds"}));
  EXPECT_EQ(json["cpu"]["simd"], Json(simd_target_names()));
  EXPECT_GT(json["cpu"]["threads"], 0);
  for (const Json& device : json["opengl"]["devices"])
    EXPECT_EQ(keys(device), (Words{"index", "name", "version", "vendor", "software", "fault"}));
  EXPECT_EQ(json["renderers"],
            has_opengl() ? Json({"cpu", "gl", "reference"}) : Json({"cpu", "reference"}));
}

TEST(Doctor, SaysWhatToInstallWhereThereIsNoDriver) {
  const Json json = doctor_json(no_egl_driver);
  const Json& opengl = json["opengl"];
  for (const Json& device : opengl["devices"]) EXPECT_FALSE(device["fault"].is_null()) << device;
  EXPECT_EQ(opengl["fault"].is_null(), !opengl["devices"].empty()) << opengl;
  EXPECT_EQ(json["renderers"], Json({"cpu", "reference"}));
  expect_has(succeed(penumbra({"doctor"}, no_egl_driver)).out, {"cannot be used", "install"});
}

using RendererTest = TinyTest;

TEST_F(RendererTest, TheCpuIsTheDefault) {
  succeed(run({}, no_egl_driver));
  EXPECT_EQ(report()["renderer"]["backend"], "cpu");
  const Outcome outcome = succeed(render({"--json"}, no_egl_driver));
  EXPECT_EQ(Json::parse(outcome.out)["renderer"], report()["renderer"]);
}

TEST_F(RendererTest, OpenGlByNameIsNeverReplaced) {
  expect_refused(run({"--renderer", "gl"}, no_egl_driver), {"renderer 'gl'"});
  EXPECT_FALSE(fs::exists(out("report.json")));
  expect_refused(render({"--renderer", "gl"}, no_egl_driver), {"renderer 'gl'"});
  EXPECT_FALSE(fs::exists(path("vdi.npy")));
}

TEST_F(RendererTest, OpenGlIsNamedInTheReport) {
  const auto device = working_device();
  if (!device) GTEST_SKIP() << "no OpenGL device works here";
  succeed(run({"--renderer", "gl", "--gl-device", std::to_string(*device)}));
  const Json json = report();
  expect_values(json, {{"/renderer/backend", "gl"},
                       {"/renderer/isa", nullptr},
                       {"/renderer/threads", nullptr},
                       {"/frames/0/pixels/front", 64}});  // the object of 8 x 8 pixels
  const std::string words = json["renderer"]["device"];
  EXPECT_TRUE(words.starts_with(gl_devices()[*device].name)) << words;
}

#ifdef PENUMBRA_FAILING_DEVICE

constexpr int most_questions = 100;  // that OpenGL may be asked while three frames are drawn

class FailingDevice : public TinyTest {
 protected:
  void SetUp() override {
    if (sanitized) GTEST_SKIP() << "skipped: sanitized";  // it wants to be the first library
    if (!has_opengl()) GTEST_SKIP() << no_opengl;
  }
  /// An environment in which the device fails when it was asked for its state `spared` times.
  static Words failing(int spared) {
    return {std::string("LD_PRELOAD=") + PENUMBRA_FAILING_DEVICE,
            "PENUMBRA_TEST_SPARED=" + std::to_string(spared)};
  }
  static void expect_device_failed(const Outcome& outcome) {
    EXPECT_EQ(outcome.status, 1) << outcome.err;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
    expect_has(outcome.err, {"OpenGL: the graphics device was reset", "--renderer cpu"});
    expect_lacks(outcome.err, {"internal error"});
  }
  /// Frames in the report of a run that failed; 0 where there is none.
  [[nodiscard]] std::size_t frames_of(const Outcome& outcome) const {
    EXPECT_EQ(fs::exists(out("labels/000000.png")), fs::exists(out("report.json")));
    if (!fs::exists(out("report.json"))) return 0;
    const Json json = report();
    const std::string note = json["summary"]["notes"].back();
    const std::size_t frames = json["frames"].size();
    expect_has(note, {"frame " + std::to_string(frames) + " and later ones are not judged"});
    expect_has(outcome.err, {note});
    EXPECT_EQ(json["summary"]["frames"], frames);
    for (const Json& frame : json["frames"]) EXPECT_EQ(frame["pixels"]["front"], 64);
    return frames;
  }
};

/// The device fails ever later until the run is done.
TEST_F(FailingDevice, LeavesTheFramesBefore) {
  std::vector<std::size_t> kept;
  for (int spared = 0; spared < most_questions; ++spared) {
    const Outcome outcome = run({"--renderer", "gl", "--save", "labels"}, failing(spared));
    if (outcome.status == 0) break;
    expect_device_failed(outcome);
    kept.push_back(frames_of(outcome));
  }
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  for (const std::size_t frames : {0U, 1U, 2U})
    EXPECT_NE(std::count(kept.begin(), kept.end(), frames), 0) << frames;
  EXPECT_EQ(report()["frames"].size(), 3U);
}

TEST_F(FailingDevice, IsNoFaultOfRender) {
  expect_device_failed(render({"--renderer", "gl"}, failing(0)));
  EXPECT_FALSE(fs::exists(path("vdi.npy")));
}

#endif

}  // namespace
}  // namespace penumbra::test
