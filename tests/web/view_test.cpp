// SPDX-License-Identifier: Apache-2.0
// What `penumbra view` serves of the shipped example, against what `penumbra run` writes of it.
#include "../apps/fixtures.hpp"
#include "viewer_process.hpp"

#include <cmath>

#include <io/files/jpeg.hpp>

namespace penumbra::test {
namespace {

using nlohmann::json;

constexpr std::size_t example_frames = 12;

json without_times(json report) {
  for (auto& frame : report["frames"]) frame.erase("timing_ms");
  report["summary"].erase("timing_ms");
  return report;
}

/// A viewer of the example, and what `run` writes of it.
class ViewExampleTest : public FolderTest {
 protected:
  void expect_report_of_run() const {
    const json written = without_times(json::parse(read_file(out("report.json"))));
    EXPECT_EQ(without_times(viewer_.get_json("/api/report")), written);
    const json rest = viewer_.get_json("/api/report?from=11");
    ASSERT_EQ(rest["frames"].size(), 1U);
    EXPECT_EQ(rest["frames"][0]["index"], 11);
    for (const std::string from : {"-1", "x", "1.5"})
      EXPECT_EQ(viewer_.client().get("/api/report?from=" + from).status, 400) << from;
    EXPECT_EQ(session_["frames"], example_frames);
    EXPECT_EQ(session_["links"], written["links"]);
    EXPECT_EQ(session_["missing"], json::array());
  }

  // What another program on this port would count alike is not from here.
  void expect_server_everywhere() const {
    const std::string server = session_["server"];
    EXPECT_EQ(viewer_.packet(0, "").json["server"], server);
    EXPECT_EQ(viewer_.get_json("/api/scene")["server"], server);
    EXPECT_EQ(viewer_.client().get("/api/scene.bin?version=1&server=" + server).status, 200);
    EXPECT_EQ(viewer_.client().get("/api/scene.bin?version=2").status, 409);
    EXPECT_EQ(viewer_.client().get("/api/scene?server=other").status, 409);
    const ViewerProcess other({example});
    EXPECT_NE(other.get_json("/api/session")["server"], server);
  }

  void expect_images_of_run() const {
    const json report = json::parse(read_file(out("report.json")));
    for (std::size_t i = 0; i < example_frames; ++i) {
      Packet served = viewer_.packet(i, "labels,links,vdi");
      served.json["frame"].erase("timing_ms");
      json frame = report["frames"][i];
      frame.erase("timing_ms");
      EXPECT_EQ(served.json["frame"], frame);
      EXPECT_EQ(served.parts["labels"], bytes_of(labels(i))) << i;
      EXPECT_EQ(served.parts["links"],
                bytes_of(read_image<std::uint16_t>(out("links") / numbered(i))))
          << i;
      EXPECT_EQ(served.parts["vdi"], bytes_of(read_image<float>(out("vdi") / numbered(i, ".npy"))))
          << i;
    }
  }

  // The cube stands at (0.52, 0.28, 0.04) of the root link.
  void expect_outlines_around_targets() const {
    const Packet served = viewer_.packet(3, "");
    ASSERT_EQ(session_["parts"], json({"color", "labels", "links", "vdi", "depth", "cloud"}));
    const json& marks = served.json["marks"];
    ASSERT_EQ(marks.size(), served.json["frame"]["targets"].size());
    ASSERT_EQ(served.json["frame"]["targets"][0]["name"], "cube");
    for (const std::size_t axis : {0U, 1U}) {
      const double place = marks[0]["place"][axis];
      double low = place, high = place;
      for (const json& path : marks[0]["outline"])
        for (std::size_t i = axis; i < path.size(); i += 2) {
          low = std::min(low, path[i].get<double>());
          high = std::max(high, path[i].get<double>());
        }
      EXPECT_LT(low, place - 5);
      EXPECT_GT(high, place + 5);
    }
    EXPECT_EQ(marks[3]["place"], nullptr) << "the wrist is lost";
  }

  void expect_recorded_depth_and_color() const {
    // JPEG at quality 90: mean difference of a channel, of 255.
    constexpr double color_tolerance = 4.0;
    const Packet served = viewer_.packet(5, "color,depth");
    const auto millimetres = read_image<std::uint16_t>(example / "depth/5.png");
    ASSERT_EQ(served.parts.at("depth").size(), millimetres.size() * sizeof(float));
    for (std::size_t i = 0; i < millimetres.size(); ++i)
      ASSERT_EQ(served.float_at("depth", i * sizeof(float)),
                0.001F * static_cast<float>(millimetres.data()[i]));
    const auto recorded = read_image<Rgb8>(example / "color/5.png");
    Image<Rgb8> shown;
    const std::string& jpeg = served.parts.at("color");
    ASSERT_FALSE(io::decode_jpeg(std::as_bytes(std::span(jpeg)), shown));
    ASSERT_EQ(shown.size(), recorded.size());
    double sum = 0;
    for (std::size_t i = 0; i < shown.size(); ++i)
      sum += std::abs(shown.data()[i].g - recorded.data()[i].g);
    EXPECT_LT(sum / static_cast<double>(shown.size()), color_tolerance);
  }

  void expect_cloud_of_depth() const {
    constexpr float tolerance = 1e-5F;  // of float32 at a few metres
    constexpr std::size_t point = 16;   // bytes: x, y, z, label, r, g, b
    const Packet served = viewer_.packet(5, "depth,labels,cloud&step=3");
    const json& camera = session_["camera"];
    const int width = camera["width"], height = camera["height"];
    const float fx = camera["fx"], fy = camera["fy"], cx = camera["cx"], cy = camera["cy"];
    const std::string& cloud = served.parts.at("cloud");
    std::size_t at = 0;
    for (int v = 0; v < height; v += 3)
      for (int u = 0; u < width; u += 3) {
        const auto i = static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                       static_cast<std::size_t>(u);
        const float z = served.float_at("depth", i * sizeof(float));
        if (z == 0) continue;
        ASSERT_LE(at + point, cloud.size());
        ASSERT_NEAR(served.float_at("cloud", at), (static_cast<float>(u) - cx) / fx * z, tolerance);
        ASSERT_NEAR(served.float_at("cloud", at + 4), (static_cast<float>(v) - cy) / fy * z,
                    tolerance);
        ASSERT_EQ(served.float_at("cloud", at + 8), z);
        ASSERT_EQ(cloud[at + 12], served.parts.at("labels")[i]);
        at += point;
      }
    EXPECT_EQ(at, cloud.size());
  }

  // The scene, posed and projected by this test alone, covers the robot's pixels of the VDI.
  void expect_scene_on_the_robot() const {
    const json scene = viewer_.get_json("/api/scene");
    const std::string bytes = viewer_.client().get("/api/scene.bin").body;
    const Packet served = viewer_.packet(5, "links,vdi");
    const json& camera = session_["camera"];
    const double fx = camera["fx"], fy = camera["fy"], cx = camera["cx"], cy = camera["cy"];
    const long width = camera["width"], height = camera["height"];
    const auto pose_of = [](const json& p) {
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.translation() << p[0], p[1], p[2];
      pose.linear() = Eigen::Quaterniond(p[6], p[3], p[4], p[5]).toRotationMatrix();
      return pose;
    };
    const Eigen::Isometry3d T_camera_root = pose_of(served.json["camera_pose"]).inverse();
    std::size_t seen = 0, nearest = 0;
    for (std::size_t l = 0; l < scene["links"].size(); ++l)
      for (const json& mesh : scene["links"][l]["meshes"])
        for (std::size_t k = 0; k < mesh["vertices"]; ++k) {
          Eigen::Vector3f vertex;
          std::memcpy(vertex.data(),
                      bytes.data() + mesh["position_offset"].get<std::size_t>() + k * sizeof vertex,
                      sizeof vertex);
          const Eigen::Vector3d p =
              T_camera_root * pose_of(served.json["link_poses"][l]) * vertex.cast<double>();
          const long u = std::lround(fx * p.x() / p.z() + cx);
          const long v = std::lround(fy * p.y() / p.z() + cy);
          if (u < 0 || v < 0 || u >= width || v >= height) continue;
          const float z =
              served.float_at("vdi", static_cast<std::size_t>(v * width + u) * sizeof(float));
          if (z == 0) continue;  // a vertex on the silhouette may round off it
          ++seen;
          // Nothing of the robot lies before what the VDI shows, but within a slanted pixel.
          nearest += p.z() > z - 0.02 ? 1 : 0;
        }
    EXPECT_GT(seen, 1000U);
    // Beside a silhouette a vertex may round onto what lies behind it.
    EXPECT_GT(static_cast<double>(nearest), 0.99 * static_cast<double>(seen));
  }

  void expect_one_line_for_what_is_not_there() const {
    WebClient client = viewer_.client();
    for (const std::string path :
         {"/api/frames/12/packet", "/api/frames/-1/packet",
          "/api/frames/99999999999999999999/packet", "/api/frames/0x1/packet",
          "/api/frames//packet", "/api/frames/../../etc/passwd", "/assets/../../../etc/passwd",
          "/%2e%2e/etc/passwd", "/etc/passwd", "/api", "/index.htm"}) {
      const HttpReply reply = client.get(path);
      EXPECT_EQ(reply.status, 404) << path;
      EXPECT_TRUE(json::parse(reply.body)["error"].is_string()) << path;
    }
    for (const std::string query :
         {"with=labels,secrets", "with=labels&step=0", "step=65", "step=x"})
      EXPECT_EQ(client.get("/api/frames/0/packet?" + query).status, 400) << query;
    EXPECT_EQ(client.upgrade("/api/live").status, 404);
  }

  const ViewerProcess viewer_{{example}};
  const json session_ = viewer_.complete_session();
};

TEST_F(ViewExampleTest, ServesWhatRunWritesAndWhatTheRecordingHolds) {
  succeed(penumbra({"run", example, "-o", out(), "--save", "vdi,labels,links"}));
  expect_report_of_run();
  expect_server_everywhere();
  expect_images_of_run();
  expect_outlines_around_targets();
  expect_recorded_depth_and_color();
  expect_cloud_of_depth();
  expect_scene_on_the_robot();
  expect_one_line_for_what_is_not_there();

  const HttpReply page = viewer_.client().get("/");
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.headers.at("content-type"), "text/html; charset=utf-8");
  EXPECT_EQ(page.body, read_file(PENUMBRA_SOURCE_DIR "/web/dist/index.html"));
  expect_refused(penumbra({"view", example, "--port", std::to_string(viewer_.port())}), {"--port"});
}

TEST(ViewInput, AtFaultIsOneLineAndStatus2) {
  const TemporaryFolder folder;
  expect_all_refused([](const Words& line) { return penumbra(Words{"view"} + line); },
                     {{{folder.path()}, "recording"},
                      {{folder.path() / "gone"}, "gone"},
                      {{folder.write("some.txt", "text")}, "some.txt"},
                      {{example, "--port", "70000"}, "--port"},
                      {{example, "--address", "nowhere"}, "--address"},
                      {{example, "--frames", "50:60"}, "frames 50:60"}});
}

}  // namespace
}  // namespace penumbra::test
