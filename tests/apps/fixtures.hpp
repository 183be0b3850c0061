// SPDX-License-Identifier: Apache-2.0
// The tiny recording in a folder of its own, as a folder and as a bag, and commands on it.
#pragma once

#include "program.hpp"
#include "tiny_bag.hpp"
#include "tiny_recording.hpp"

#include <regex>
#include <type_traits>

#include <penumbra/base/image.hpp>

#include <io/files/npy.hpp>
#include <io/files/png.hpp>

namespace penumbra::test {

/// The shipped recording.
inline const fs::path example = PENUMBRA_SOURCE_DIR "/examples/arm_over_table";
inline const Words example_package = {"--package",
                                      "arm_description=" + (example / "arm_description").string()};

/// Returns the name of a frame's file: "000007.png".
inline std::string numbered(std::size_t frame, const std::string& ending = ".png") {
  const std::string number = std::to_string(frame);
  return std::string(6 - number.size(), '0') + number + ending;
}

/// Reads a PNG file, or an NPY file of floats.
template <typename T>
Image<T> read_image(const fs::path& file) {
  Image<T> image;
  if constexpr (std::is_same_v<T, float>)
    io::read_npy(file, image).require();
  else
    io::read_png(file, image).require();
  return image;
}

/// Returns what of a file the clock has no part in.
inline std::string without_times(const fs::path& file) {
  static const std::regex times(R"("timing_ms": ?\{([^{}]|\{[^{}]*\})*\})");
  if (file.extension() == ".html") return "a page";
  const std::string text = read_file(file);
  return file.extension() == ".json" ? std::regex_replace(text, times, "") : text;
}

/// A test with an empty folder, whose "out" takes what `penumbra` writes.
class FolderTest : public testing::Test {
 protected:
  [[nodiscard]] fs::path path() const { return folder_.path(); }
  [[nodiscard]] fs::path path(const std::string& name) const { return path() / name; }
  [[nodiscard]] fs::path out() const { return path("out"); }
  [[nodiscard]] fs::path out(const std::string& name) const { return out() / name; }

  void write(const std::string& name, const std::string& content) const {
    write_file(path(name), content);
  }
  void edit(const std::string& name, const std::string& from, const std::string& to) const {
    edit_file(path(name), from, to);
  }

  [[nodiscard]] Json report() const { return read_json(out("report.json")); }
  [[nodiscard]] Image<std::uint8_t> labels(std::size_t frame) const {
    return read_image<std::uint8_t>(out("labels") / numbered(frame));
  }
  [[nodiscard]] Words statuses() const {
    Words all;
    const Json json = report();
    for (const Json& frame : json["frames"]) all.push_back(frame["status"]);
    return all;
  }
  [[nodiscard]] std::string message(std::size_t frame) const {
    const Json said = report()["frames"].at(frame)["message"];
    return said.is_null() ? "" : std::string(said);
  }
  [[nodiscard]] std::string notes() const { return report()["summary"]["notes"].dump(); }

 private:
  TemporaryFolder folder_;
};

/// Returns the URDF of a link that is fixed to `parent`.
inline std::string fixed_link(const std::string& name, const std::string& parent,
                              const std::string& content) {
  return "<link name=\"" + name + "\">" + content + "</link><joint name=\"to_" + name +
         "\" type=\"fixed\"><parent link=\"" + parent + "\"/><child link=\"" + name +
         "\"/></joint>";
}

/// Returns the recording.yaml of two cameras at the tiny recording's place. `of_right`: lines of
/// the second camera alone. `more`: lines at the end.
inline std::string two_cameras_yaml(const std::string& of_right = "",
                                    const std::string& more = "") {
  const std::string camera =
      "    info: camera_info.yaml\n    parent: base\n    pose: camera_pose.csv\n"
      "    depth: depth_%d.png\n    color: color_%d.png\n";
  return "robot:\n  urdf: tiny.urdf\ncameras:\n  left:\n" + camera + "  right:\n" + camera +
         of_right + "frames:\n  joints: joint_states.csv\n" + more;
}

class TinyTest : public FolderTest {
 protected:
  TinyTest() { write_tiny_recording(path()); }

  Outcome run(const Words& options = {}, const Words& environment = {}) const {
    return penumbra(Words{"run", path(), "-o", out()} + options, environment);
  }
  Outcome render(const Words& options = {}, const Words& environment = {}) const {
    return penumbra(
        Words{"render", "--robot", path("tiny.urdf"), "--camera", path("camera_info.yaml"),
              "--pose", path("camera_pose.csv"), "-o", path("vdi.npy")} +
            options,
        environment);
  }
  Outcome inspect(const Words& options = {}) const {
    return penumbra(Words{"inspect", path("tiny.urdf")} + options);
  }
  void add_to_robot(const std::string& urdf) const {
    edit_file(path("tiny.urdf"), "</robot>", urdf + "</robot>");
  }
  void write_joints(const std::string& text) const { write_file(path("joint_states.csv"), text); }
  void write_targets(const std::string& list) const {
    write_file(path("targets.yaml"), "targets:\n" + list);
  }
};

/// The tiny recording as a bag, and `penumbra run` of it.
class BagTest : public TinyTest {
 protected:
  BagTest() : bag_(tiny_bag(path())) {}

  Outcome run(const Words& options = {}, const std::string& name = "tiny.mcap") const {
    return penumbra(Words{"run", name == "tiny.mcap" ? tiny_mcap() : path(name), "-o", out(),
                          "--save", saves_} +
                    options);
  }
  [[nodiscard]] fs::path tiny_mcap() const {
    bag_.write_mcap(path("tiny.mcap"));
    return path("tiny.mcap");
  }

  /// Labels are those of the recording folder at the first call, to the last pixel.
  void expect_recorded_labels(std::size_t first = 0, std::size_t end = 3) const {
    if (!fs::exists(path("wanted")))
      succeed(penumbra({"run", path(), "-o", path("wanted"), "--save", "labels"}));
    for (std::size_t i = first; i < end; ++i)
      EXPECT_TRUE(read_file(out("labels") / numbered(i)) ==
                  read_file(path("wanted/labels") / numbered(i)))
          << i;
  }

  Outcome expect_recorded(const Words& options = {}) const {
    Outcome outcome = succeed(run(options));
    expect_recorded_labels();
    return outcome;
  }

  static constexpr const char* depth_topic = "/camera/depth/image_rect_raw";
  static constexpr const char* info_topic = "/camera/depth/camera_info";
  static constexpr const char* color_topic = "/camera/color/image_raw/compressed";

  TinyBag bag_;
  std::string saves_ = "labels";
};

}  // namespace penumbra::test
