// SPDX-License-Identifier: Apache-2.0
// The tiny recording in a folder of its own, as a folder and as a bag, and commands on it.
#pragma once

#include "program.hpp"
#include "tiny_bag.hpp"
#include "tiny_recording.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <penumbra/base/image.hpp>

#include <io/files/png.hpp>

namespace penumbra::test {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Of an object, in their order.
inline Words keys(const Json& json) {
  Words names;
  for (const auto& [name, value] : json.items()) names.push_back(name);
  return names;
}

inline void expect_has(const std::string& text, const Words& words) {
  for (const std::string& word : words)
    EXPECT_NE(text.find(word), std::string::npos) << word << " is not in: " << text;
}

/// Status 2, and one line that names all of these.
inline void expect_refused(const Outcome& outcome, const Words& named) {
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  expect_has(outcome.err, named);
}

class TinyTest : public testing::Test {
 protected:
  TinyTest() { write_tiny_recording(path()); }

  [[nodiscard]] fs::path path() const { return folder_.path(); }
  [[nodiscard]] fs::path path(const std::string& name) const { return path() / name; }
  [[nodiscard]] fs::path out() const { return path("out"); }

  Outcome run(Words options = {}) const {
    options.insert(options.begin(), {"run", path(), "-o", out()});
    return penumbra(options);
  }
  Outcome render(Words options = {}, const Words& environment = {}) const {
    options.insert(options.begin(),
                   {"render", "--robot", path("tiny.urdf"), "--camera", path("camera_info.yaml"),
                    "--pose", path("camera_pose.csv"), "-o", path("vdi.npy")});
    return penumbra(options, environment);
  }
  Outcome inspect(Words options = {}) const {
    options.insert(options.begin(), {"inspect", path("tiny.urdf")});
    return penumbra(options);
  }

  [[nodiscard]] Json report() const { return Json::parse(read_file(out() / "report.json")); }
  [[nodiscard]] Image<std::uint8_t> labels(const std::string& file) const {
    Image<std::uint8_t> image;
    io::read_png(out() / "labels" / file, image).require();
    return image;
  }

 private:
  TemporaryFolder folder_;
};

/// The tiny recording as a bag, and `penumbra run` of it.
class BagTest : public TinyTest {
 protected:
  BagTest() : bag_(tiny_bag(path())) {}

  Outcome run(Words options = {}, const std::string& name = "tiny.mcap") const {
    if (name == "tiny.mcap") bag_.write_mcap(path(name));
    options.insert(options.begin(), {"run", path(name), "-o", out(), "--save", saves_});
    return penumbra(options);
  }
  [[nodiscard]] std::string status(std::size_t frame) const {
    return report()["frames"].at(frame)["status"];
  }
  [[nodiscard]] std::string message(std::size_t frame) const {
    const Json said = report()["frames"].at(frame)["message"];
    return said.is_null() ? "" : std::string(said);
  }

  /// Labels are those of the recording folder, to the last pixel.
  void expect_recorded_labels(std::size_t first = 0, std::size_t end = 3) const {
    const fs::path wanted = path("wanted");
    ASSERT_EQ(penumbra({"run", path(), "-o", wanted, "--save", "labels"}).status, 0);
    for (std::size_t i = first; i < end; ++i) {
      const std::string file = "labels/00000" + std::to_string(i) + ".png";
      EXPECT_TRUE(read_file(out() / file) == read_file(wanted / file)) << file;
    }
  }

  TinyBag bag_;
  std::string saves_ = "labels";
};

}  // namespace penumbra::test
