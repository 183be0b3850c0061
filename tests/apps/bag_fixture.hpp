// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "json.hpp"
#include "program.hpp"
#include "tiny_bag.hpp"
#include "tiny_recording.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace penumbra::test {

namespace fs = std::filesystem;

/// The tiny recording as a bag, and `penumbra run` of it.
class BagTest : public testing::Test {
 protected:
  BagTest() {
    write_tiny_recording(folder_.path());
    bag_ = tiny_bag(folder_.path());
  }

  Outcome run(std::vector<std::string> options = {}, const std::string& name = "tiny.mcap") {
    const fs::path file = folder_.path() / name;
    if (name == "tiny.mcap") bag_.write_mcap(file);
    options.insert(options.begin(), {"run", file, "-o", out(), "--save", saves_});
    return penumbra(options);
  }
  [[nodiscard]] fs::path out() const { return folder_.path() / "out"; }
  [[nodiscard]] Json report() const { return Json::parse(read_file(out() / "report.json")); }
  [[nodiscard]] std::string status(std::size_t frame) const {
    return report()["frames"].at(frame)["status"];
  }
  [[nodiscard]] std::string message(std::size_t frame) const {
    const Json said = report()["frames"].at(frame)["message"];
    return said.is_null() ? "" : std::string(said);
  }

  /// Labels are those of the recording folder, to the last pixel.
  void expect_recorded_labels(std::size_t first = 0, std::size_t end = 3) {
    const fs::path wanted = folder_.path() / "wanted";
    ASSERT_EQ(penumbra({"run", folder_.path(), "-o", wanted, "--save", "labels"}).status, 0);
    for (std::size_t i = first; i < end; ++i) {
      const std::string file = "labels/00000" + std::to_string(i) + ".png";
      EXPECT_TRUE(read_file(out() / file) == read_file(wanted / file)) << file;
    }
  }

  TemporaryFolder folder_;
  TinyBag bag_;
  std::string saves_ = "labels";
};

}  // namespace penumbra::test
