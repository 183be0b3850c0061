// SPDX-License-Identifier: Apache-2.0
#include "cloud_samples.hpp"

#include <tuple>

#include <io/cloud/cloud_file.hpp>

namespace penumbra::io {
namespace {

using test::raw;
using namespace std::string_literals;

constexpr std::uint8_t type_i8 = 1, type_u8 = 2, type_i16 = 3, type_u16 = 4, type_f32 = 7,
                       type_f64 = 8;

/// Name, type and count of each field.
using Fields = std::vector<std::tuple<std::string, int, int>>;

std::string points_of(const StoredCloud& stored) {
  EXPECT_EQ(stored.cloud.data.data(), stored.data.data());
  EXPECT_EQ(stored.cloud.data.size(), stored.data.size());
  return {reinterpret_cast<const char*>(stored.data.data()), stored.data.size()};
}

void expect_fields(const PointCloud2Message& cloud, const Fields& expected) {
  Fields fields;
  std::uint32_t offset = 0;
  constexpr std::array<std::uint32_t, 9> sizes{0, 1, 1, 2, 2, 4, 4, 4, 8};
  for (const PointFieldMessage& field : cloud.fields) {
    fields.emplace_back(field.name, field.datatype, field.count);
    EXPECT_EQ(field.offset, offset) << field.name;
    offset += sizes.at(field.datatype) * field.count;
  }
  EXPECT_EQ(fields, expected);
  EXPECT_EQ(cloud.point_step, offset);
  EXPECT_EQ(cloud.row_step, offset * cloud.width);
  EXPECT_EQ(cloud.data.size(), std::size_t{cloud.row_step} * cloud.height);
  EXPECT_FALSE(cloud.is_bigendian);
}

const Fields mixed{{"x", type_f32, 1},   {"y", type_f32, 1}, {"z", type_f32, 1},
                   {"rgb", type_f32, 1}, {"_", type_u8, 2},  {"ring", type_u16, 1},
                   {"t", type_f64, 1},   {"n", type_i8, 3}};

class CloudFile : public testing::Test {
 protected:
  [[nodiscard]] StoredCloud read(const std::string& name, const std::string& bytes) const {
    return read_cloud(folder_.write(name, bytes));
  }
  [[nodiscard]] std::string written(const std::string& name,
                                    const PointCloud2Message& cloud) const {
    write_cloud(folder_.path() / name, cloud);
    return test::read_bytes(folder_.path() / name);
  }

  test::TemporaryFolder folder_;
};

TEST_F(CloudFile, PcdTextHasNumbersOfEveryKind) {
  const StoredCloud stored = read("a.PCD", test::ascii_pcd());
  expect_fields(stored.cloud, mixed);
  EXPECT_EQ(stored.cloud.width, 2U);
  constexpr float inf = std::numeric_limits<float>::infinity();
  const std::string zeros(2, '\0');
  EXPECT_EQ(points_of(stored),
            raw(1.0F, -2.5F, std::numeric_limits<float>::quiet_NaN(), 4.2108e+06F) + zeros +
                raw(std::uint16_t{7}, 1e300) + "\x01\xfe\x03"s + raw(0.1F, 3e-39F, -inf) +
                raw(2.3418052e-38F) + zeros + raw(std::uint16_t{65535}, -1e-300) + "\x80\x7f\x00"s);
}

TEST_F(CloudFile, BinaryPcdIsWrittenAsItWasRead) {
  const std::string file = test::pcd(test::mixed_fields, 2, 2, "binary\n") + test::mixed_points();
  const StoredCloud stored = read("a.pcd", file);
  expect_fields(stored.cloud, mixed);
  EXPECT_EQ(points_of(stored), test::mixed_points());
  EXPECT_EQ(std::pair(stored.cloud.width, stored.cloud.height), std::pair(2U, 2U));
  EXPECT_EQ(written("b.pcd", stored.cloud), file);
  // PCL 1.6 and older add zeros. Windows ends lines with CR LF. COUNT and POINTS may be missing.
  EXPECT_EQ(points_of(read("c.pcd", file + std::string(3904, '\0'))), test::mixed_points());
  EXPECT_EQ(points_of(read("d.pcd",
                           "FIELDS x y z\r\nSIZE 4 4 4\r\nTYPE F F F\r\nWIDTH 1\r\nHEIGHT 1\r\n"
                           "DATA binary\r\n" +
                               raw(1.0F, 2.0F, 3.0F))),
            raw(1.0F, 2.0F, 3.0F));
}

TEST_F(CloudFile, CompressedPcdIsReadAndWrittenAsBinary) {
  const StoredCloud stored = read("a.pcd", test::compressed_pcd());
  expect_fields(stored.cloud, mixed);
  EXPECT_EQ(points_of(stored), test::mixed_points());
  EXPECT_EQ(written("a.pcd", stored.cloud),
            test::pcd(test::mixed_fields, 2, 2, "binary\n") + test::mixed_points());
}

TEST_F(CloudFile, CompressedPointsMayReferToThemselves) {
  const std::string header = test::pcd("FIELDS a\nSIZE 1\nTYPE U\n", 300, 1, "binary_compressed\n");
  // "abc"; 9 bytes from 3 back; 264 from 1 back; 3 from 276 back; 21 bytes.
  const std::string packed =
      "\x02"
      "abc\xe0\x00\x02\xe0\xff\x00\x21\x13\x14"s +
      std::string(21, 'x');
  const StoredCloud stored =
      read("a.pcd", header + raw(static_cast<std::uint32_t>(packed.size()), 300U) + packed);
  EXPECT_EQ(points_of(stored),
            "abcabcabcabc" + std::string(264, 'c') + "abc" + std::string(21, 'x'));
}

TEST_F(CloudFile, PlyGivesItsVerticesInEveryFormat) {
  const std::string points = raw(1.0F) + raw(2.0) + raw(3.0F) + "\xff" + raw(short{-7}) +
                             raw(-1.5F) + raw(2e100) + raw(0.0F) + "\0"s + raw(short{300});
  for (const std::string& file :
       {test::ascii_ply(), test::binary_ply<false>(), test::binary_ply<true>()}) {
    const StoredCloud stored = read("a.ply", file);
    expect_fields(stored.cloud, {{"x", type_f32, 1},
                                 {"y", type_f64, 1},
                                 {"z", type_f32, 1},
                                 {"red", type_u8, 1},
                                 {"ring", type_i16, 1}});
    EXPECT_EQ(points_of(stored), points);
    EXPECT_EQ(written("b.ply", stored.cloud),
              "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\n"
              "property double y\nproperty float z\nproperty uchar red\nproperty short ring\n"
              "end_header\n" +
                  points);
  }
}

TEST_F(CloudFile, PlyHasColorsForPackedOnes) {
  const StoredCloud stored =
      read("a.pcd", test::pcd(test::mixed_fields, 4, 1, "binary\n") + test::mixed_points());
  const std::string ply = written("a.ply", stored.cloud);
  EXPECT_HAS(ply,
             "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
             "property ushort ring\nproperty double t\nproperty char n_0\nproperty char n_1\n"
             "property char n_2\nend_header\n" +
                 raw(1.0F, 2.0F, 3.0F) + "\x10\x20\x30" + raw(std::uint16_t{7}, 1e300) +
                 "\x01\xfe\x03");
}

TEST_F(CloudFile, NumpyRowsArePoints) {
  const StoredCloud floats = read("a.npy", test::float_npy());
  expect_fields(floats.cloud,
                {{"x", type_f32, 1}, {"y", type_f32, 1}, {"z", type_f32, 1}, {"f3", type_f32, 1}});
  EXPECT_EQ(points_of(floats), raw(1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F, 7.0F, 8.0F));
  EXPECT_EQ(written("b.npy", floats.cloud),
            test::npy("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 4), }" +
                          std::string(58, ' ') + "\n",
                      points_of(floats)));
  const StoredCloud doubles = read("c.npy", test::fortran_npy());
  expect_fields(doubles.cloud, {{"x", type_f64, 1}, {"y", type_f64, 1}, {"z", type_f64, 1}});
  EXPECT_EQ(points_of(doubles), raw(1.0, 2.0, 3.0, 4.0, 5.0, 6.0));
}

TEST_F(CloudFile, EveryFormatHoldsACloudWithoutPoints) {
  StoredCloud stored = read("a.bin", "");
  for (const char* name : {"b.pcd", "b.ply", "b.npy", "b.bin"}) {
    write_cloud(folder_.path() / name, stored.cloud);
    stored = read_cloud(folder_.path() / name);
    EXPECT_EQ(stored.cloud.width, 0U) << name;
    EXPECT_EQ(stored.cloud.fields.size(), 4U) << name;
    if (std::string(name) == "b.npy") stored.cloud.fields[3].name = "intensity";
  }
  const StoredCloud packed =
      read("c.pcd", test::pcd(test::xyz_fields, 0, 1, "binary_compressed\n") + raw(0U, 0U));
  EXPECT_EQ(packed.cloud.width, 0U);
}

TEST_F(CloudFile, GapsBetweenFieldsAndRowsAreLeftOut) {
  const std::string data = raw(9, 1.0F, 2.0F, 3.0F, 9, 0x010203U, 4.0F) + raw(9, 9);
  PointCloud2Message cloud{.height = 2, .width = 1, .point_step = 12, .row_step = 18};
  cloud.fields = {{"b", 8, type_f32, 1}, {"a", 4, type_u8, 2}};
  cloud.data = std::as_bytes(std::span(data));
  EXPECT_EQ(written("a.pcd", cloud),
            test::pcd("FIELDS b a\nSIZE 4 1\nTYPE F U\nCOUNT 1 2\n", 1, 2, "binary\n") +
                data.substr(8, 4) + data.substr(4, 2) + data.substr(26, 4) + data.substr(22, 2));
}

/// A scan around the sensor of `numbers` a point: coordinates of both signs, then positive ones.
std::string bin_scan(std::size_t points, std::size_t numbers, std::mt19937_64& random) {
  std::uniform_real_distribution<float> length(-40.0F, 40.0F);
  std::string bytes;
  for (std::size_t i = 0; i < points * numbers; ++i)
    bytes += raw(i % numbers < 3 ? length(random) : std::abs(length(random)));
  return bytes;
}

TEST_F(CloudFile, BinFilesSayByTheirValuesHowManyNumbersAPointHas) {
  std::mt19937_64 random = test::seeded_random(67);
  int refused = 0;
  for (std::size_t points = 500; points < 560; ++points)
    for (const std::size_t numbers : {3U, 4U, 5U, 6U}) {
      const std::string bytes = bin_scan(points, numbers, random);
      const std::string message = test::refusal([&] {
        const StoredCloud stored = read("a.bin", bytes);
        EXPECT_EQ(stored.cloud.fields.size(), numbers) << points << " points";
        EXPECT_EQ(written("b.bin", stored.cloud), bytes);
      });
      if (message.empty()) continue;
      EXPECT_EQ(numbers, 3U) << message;  // no value shows it: another number must not fit
      EXPECT_TRUE(points % 2 == 0 || points % 5 == 0) << message;
      EXPECT_HAS(message, "numpy.save");
      ++refused;
    }
  EXPECT_EQ(refused, 36);
  EXPECT_EQ(read("a.bin", bin_scan(2, 4, random)).cloud.fields.size(), 4U);
  EXPECT_EQ(read("a.bin", bin_scan(100, 5, random)).cloud.fields[4].name, "ring");
  EXPECT_EQ(read("a.bin", "").cloud.width, 0U);
  std::string positive;  // no value says what it is
  for (int i = 0; i < 12; ++i) positive += raw(1.0F + static_cast<float>(i));
  // 32 numbers: of 4 by size, and not by values.
  const std::string seven = bin_scan(4, 7, random) + raw(-1.0F, -1.0F, -1.0F, -1.0F);
  for (const std::string& bytes : {positive, seven})
    test::expect_refused([&] { return read("a.bin", bytes); }, {"a.bin: ", "numpy.save"});
}

TEST_F(CloudFile, KeepsIntegersOf64Bits) {
  const std::string fields = "FIELDS x y z t\nSIZE 4 4 4 8\nTYPE F F F U\nCOUNT 1 1 1 1\n";
  const std::string points = raw(1.0F, 2.0F, 3.0F) + raw(std::uint64_t{18446744073709551615U});
  const std::string file = test::pcd(fields, 1, 1, "binary\n") + points;
  const StoredCloud stored = read("a.pcd", file);
  EXPECT_EQ(written("b.pcd", stored.cloud), file);
  EXPECT_EQ(
      points_of(read("c.pcd", test::pcd(fields, 1, 1, "ascii\n1 2 3 18446744073709551615\n"))),
      points);
  EXPECT_EQ(points_of(read("d.ply", written("e.ply", stored.cloud))), points);
}

}  // namespace
}  // namespace penumbra::io
