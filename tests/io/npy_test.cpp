// SPDX-License-Identifier: Apache-2.0
#include "../support/run_length.hpp"
#include "cloud_samples.hpp"
#include "files.hpp"
#include "memory_file.hpp"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include <io/files/npy.hpp>

namespace penumbra::io {
namespace {

const std::string good_header = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }\n";
const std::string six_bytes = test::raw(1.5F, -2.0F, 0.0F, 4.25F, 5.0F, 6.0F);

std::string npy(int version, const std::string& header, const std::string& values = six_bytes) {
  return test::npy(header, values, static_cast<char>(version));
}

class Npy : public testing::Test {
 protected:
  FileResult read(const std::string& bytes) {
    return read_npy(test::MemoryFile(bytes).path(), image_);
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "depth.npy";
  Image<float> image_;
};

TEST_F(Npy, ReadsEveryVersionAndSpelling) {
  const std::string headers[] = {
      good_header,
      "{\"shape\":(2,3),\"fortran_order\":False,\"descr\":\"<f4\"}",
      "{'fortran_order': False, 'descr': '<f4', 'shape': (2, 3,)}            \n",
  };
  for (const int version : {1, 2, 3}) {
    for (const std::string& header : headers) {
      image_ = {};
      ASSERT_EQ(read(npy(version, header)).message, "");
      ASSERT_EQ(image_.width(), 3);
      ASSERT_EQ(image_.height(), 2);
      EXPECT_EQ(std::memcmp(image_.data(), six_bytes.data(), six_bytes.size()), 0);
    }
  }
}

TEST_F(Npy, NamesWhatItDoesNotRead) {
  const auto header = [](const std::string& type, const std::string& order,
                         const std::string& shape) {
    return npy(
        1, "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }\n");
  };
  const std::string two = npy(1, "{'descr': '<f4', 'shape': (2, 3), }");
  const test::BadInputs cases = {{header("<f8", "False", "(2, 3)"), "'<f8'"},
                                 {header("<f4", "True", "(2, 3)"), "Fortran"},
                                 {header("<f4", "False", "(6,)"), "1 dimensions"},
                                 {header("<f4", "False", "(0, 3)"), "a side of 0"},
                                 {header("<f4", "False", "(40000, 3)"), "a side of 40000"},
                                 {header("<f4", "False", "(30000, 30000)"), "ends before"},
                                 {two, "header"},
                                 {npy(4, good_header), "version 4.0"},
                                 {npy(2, std::string(70000, ' '), ""), "70000"},
                                 {"frame,joint1\n0,1", "NumPy"},
                                 {npy(1, good_header, six_bytes + "x"), "after"}};
  for (const auto& [bytes, named] : cases) {
    const FileResult result = read_npy(folder_.write("depth.npy", bytes), image_);
    EXPECT_EQ(result.status, FileStatus::bad);
    EXPECT_HAS(result.message, "depth.npy: ");
    EXPECT_HAS(result.message, named);
  }
  EXPECT_EQ(read_npy(folder_.path() / "none.npy", image_).status, FileStatus::missing);
  folder_.write("depth.npy", npy(1, good_header));
  EXPECT_TRUE(read_npy(file_, image_, ImageSize{3, 2}).ok());
  EXPECT_HAS(read_npy(file_, image_, ImageSize{2, 3}).message, "3 x 2");
}

TEST_F(Npy, ReturnsWhatWasWrittenWithAnyStride) {
  std::mt19937_64 random = test::seeded_random(1);
  Image<float> image(20, 10);
  for (std::size_t i = 0; i < image.size(); ++i)
    image.data()[i] = static_cast<float>(random()) * 1e-19F;
  image(3, 9) = std::numeric_limits<float>::infinity();
  const ImageView<const float> flipped{&std::as_const(image)(3, 9), 15, 7, -20};
  write_npy(file_, flipped);
  ASSERT_EQ(read_npy(file_, image_).message, "");
  EXPECT_TRUE(test::same_pixels(flipped, image_.view()));
}

TEST_F(Npy, FindsEveryTruncation) {
  const std::string whole = npy(1, good_header);
  for (std::size_t length = 0; length < whole.size(); ++length)
    ASSERT_EQ(read(whole.substr(0, length)).status, FileStatus::bad) << length;
}

TEST_F(Npy, SurvivesDamage) {
  for (const int version : {1, 2, 3})  // which differ in the length's size alone
    test::read_damaged(npy(version, good_header), version == 1 || test::is_full_run() ? 2000 : 200,
                       [&](const std::string& bytes) {
                         image_ = {};
                         static_cast<void>(read(bytes));
                         ASSERT_LE(image_.size() * sizeof(float), bytes.size());
                       });
}

}  // namespace
}  // namespace penumbra::io
