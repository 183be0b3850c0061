// SPDX-License-Identifier: Apache-2.0
// Points and times of messages of any layout, and messages without the robot's points.
#include "../support/test.hpp"

#include <penumbra/labels/labels.hpp>

#include <io/cloud/cloud_points.hpp>

namespace penumbra::test {
namespace {

struct Labelled {
  explicit Labelled(const std::vector<Label>& all) : links(all.size()) {
    for (const Label label : all) labels.push_back(static_cast<std::uint8_t>(label));
    const int count = static_cast<int>(all.size());
    report.labels = {labels.data(), count, 1, count};
    report.virtual_depth.links = {links.data(), count, 1, count};
  }
  std::vector<std::uint8_t> labels;
  std::vector<std::uint16_t> links;
  FrameReport report;
};

using io::CloudPoints;
using io::PointCloud2Message;
using io::PointFieldMessage;

constexpr std::int64_t stamp = 1'700'000'000'000'000'000;
constexpr std::uint8_t uint8 = 2, uint32 = 6, float32 = 7, float64 = 8;

/// A cloud whose numbers are written one by one, in either byte order.
class Table {
 public:
  Table(std::vector<PointFieldMessage> fields, std::uint32_t step, std::uint32_t width,
        std::uint32_t height = 1, bool is_bigendian = false, std::uint32_t row_step = 0)
      : message_{.header = {stamp, "lidar"},
                 .height = height,
                 .width = width,
                 .fields = std::move(fields),
                 .is_bigendian = is_bigendian,
                 .point_step = step,
                 .row_step = row_step == 0 ? step * width : row_step},
        data_(std::size_t{message_.row_step} * height) {}

  template <typename T>
  void set(std::size_t point, std::uint32_t offset, T value) {
    std::array<std::byte, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof value);
    if (message_.is_bigendian) std::reverse(bytes.begin(), bytes.end());
    const std::size_t row = point / message_.width, column = point % message_.width;
    std::copy(bytes.begin(), bytes.end(),
              data_.begin() + static_cast<std::ptrdiff_t>(row * message_.row_step +
                                                          column * message_.point_step + offset));
  }
  [[nodiscard]] PointCloud2Message& message() {
    message_.data = data_;
    return message_;
  }

 private:
  PointCloud2Message message_;
  std::vector<std::byte> data_;
};

std::vector<PointFieldMessage> xyz_fields() {
  return {{"x", 0, float32, 1}, {"y", 4, float32, 1}, {"z", 8, float32, 1}};
}

TEST(CloudPoints, LieWhereTheFieldsSay) {
  std::mt19937_64 random = seeded_random(3);
  std::uniform_real_distribution<double> number(-50.0, 50.0);
  std::vector<Eigen::Vector3d> truth(6);
  for (auto& point : truth) point = {number(random), number(random), number(random)};
  const auto check = [&](Table& table, bool copies) {
    CloudPoints points;
    ASSERT_EQ(io::read_points(table.message(), true, points), "");
    ASSERT_EQ(points.points.count, truth.size());
    EXPECT_EQ(points.copied.empty(), !copies);
    for (std::size_t i = 0; i < truth.size(); ++i)
      EXPECT_EQ(points.points[i], truth[i].cast<float>().eval()) << i;
  };
  Table plain({{"intensity", 12, uint8, 1}, {"x", 0}, {"y", 4}, {"z", 8}}, 13, 6);
  Table turned({{"z", 1}, {"x", 9}, {"y", 5}}, 14, 6);  // another order
  Table wide({{"x", 0, float64}, {"y", 8, float64}, {"z", 16, float64}}, 24, 6);
  Table big(xyz_fields(), 12, 6, 1, true);
  Table rows(xyz_fields(), 16, 3, 2, false, 3 * 16 + 5);
  for (std::size_t i = 0; i < truth.size(); ++i)
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      const auto value = static_cast<float>(truth[i][axis]);
      plain.set(i, 4 * axis, value);
      turned.set(i, std::array<std::uint32_t, 3>{9, 5, 1}[axis], value);
      wide.set(i, 8 * axis, truth[i][axis]);
      big.set(i, 4 * axis, value);
      rows.set(i, 4 * axis, value);
    }
  check(plain, false);
  check(turned, true);
  check(wide, true);
  check(big, true);
  check(rows, true);
}

TEST(CloudPoints, FieldsThatAreNotReadMayBeOfAnyType) {
  auto fields = xyz_fields();
  fields.push_back({"serial", 12, 9, 1});    // 8 bytes: 64-bit integers, which ROS does not have
  fields.push_back({"vendor", 500, 77, 9});  // of any size
  Table table(fields, 20, 2);
  for (std::size_t i = 0; i < 2; ++i) table.set(i, 0, 1.0F + static_cast<float>(i));
  CloudPoints points;
  EXPECT_EQ(io::read_points(table.message(), true, points), "");
  EXPECT_EQ(points.points[1], Eigen::Vector3f(2, 0, 0));
  for (const char* used : {"x", "time"}) {
    fields[4].name = used;
    if (*used == 'x') fields[0].name = "other";
    Table other(fields, 20, 2);
    EXPECT_TRUE(holds(io::read_points(other.message(), true, points), "77")) << used;
    fields[0].name = "x";
  }
}

TEST(CloudPoints, AWrongByteOrderIsSeenAndSaid) {
  std::mt19937_64 random = seeded_random(5);
  std::uniform_real_distribution<float> length(-50.0F, 50.0F);
  for (const bool is_big : {false, true})
    for (const bool is_lie : {false, true}) {
      Table table(xyz_fields(), 12, 3000, 1, is_big);
      std::vector<Eigen::Vector3f> truth;
      for (std::size_t i = 0; i < 3000; ++i) {
        truth.emplace_back(length(random), length(random), i % 3 == 0 ? 0.0F : 1.5F);
        if (i % 7 == 0) truth.back().setZero();  // no measurement
        for (std::uint32_t axis = 0; axis < 3; ++axis) table.set(i, 4 * axis, truth[i][axis]);
      }
      PointCloud2Message message = table.message();
      message.is_bigendian = is_big != is_lie;
      CloudPoints points;
      ASSERT_EQ(io::read_points(message, true, points), "");
      for (std::size_t i = 0; i < truth.size(); ++i) ASSERT_EQ(points.points[i], truth[i]);
      EXPECT_EQ(points.time_note.find("is_bigendian") != std::string::npos, is_lie);
    }
}

TEST(CloudPoints, AreAtMost16Million) {
  CloudPoints points;
  Table table({{"x", 0, float32}, {"y", 0, float32}, {"z", 0, float32}}, 4, 16'000'001);
  EXPECT_TRUE(holds(io::read_points(table.message(), false, points), "16000000"));
  const io::LaserScanMessage scan{.ranges = std::vector<float>(16'000'001, 1.0F)};
  EXPECT_TRUE(holds(io::read_points(scan, false, points), "16000000"));
}

/// How drivers write times. Each scan lasts 100 ms; the expected ones are after the header's stamp.
struct Clock {
  const char* name;
  std::string field;
  std::uint8_t type;
  double first, step;  // in the driver's unit
  double expected_first, expected_step;
  const char* said;
};

TEST(CloudPoints, TimesOfDriversAreUnderstood) {
  constexpr double now = 1e-9 * static_cast<double>(stamp);
  const Clock drivers[] = {
      {"Velodyne", "time", float32, 0, 1e-3, 0, 1e-3, "seconds after"},
      {"VelodyneOfTheEnd", "time", float32, -0.1, 1e-3, -0.1, 1e-3, "seconds after"},
      {"Ouster", "t", uint32, 0, 1e6, 0, 1e-3, "nanoseconds after"},
      {"Hesai", "timestamp", float64, now, 1e-3, 0, 1e-3, ": seconds of the stamp's clock"},
      {"LivoxCloud", "timestamp", float64, 1e9 * now, 1e6, 0, 1e-3, "nanoseconds of the stamp's"},
      {"Microseconds", "offset_time", uint32, 0, 1e3, 0, 1e-3, "microseconds after"},
      {"Milliseconds", "time", float32, 0, 1, 0, 1e-3, "milliseconds after"},
      {"ClockOfItsOwn", "timestamp", float64, 86'400, 1e-3, 0, 1e-3, "seconds of a clock of its"}};
  for (const Clock& clock : drivers) {
    SCOPED_TRACE(clock.name);
    auto fields = xyz_fields();
    fields.push_back({clock.field, 12, clock.type, 1});
    constexpr std::uint32_t count = 101;
    Table table(fields, 20, count);
    for (std::size_t i = 0; i < count; ++i) {
      const double value = clock.first + clock.step * static_cast<double>(i);
      table.set(i, 0, 1.0F);
      if (clock.type == float32) table.set(i, 12, static_cast<float>(value));
      if (clock.type == float64) table.set(i, 12, value);
      if (clock.type == uint32) table.set(i, 12, static_cast<std::uint32_t>(value));
    }
    CloudPoints points;
    ASSERT_EQ(io::read_points(table.message(), true, points), "");
    EXPECT_TRUE(holds(points.time_note, "'" + clock.field + "' has the points' times"));
    EXPECT_TRUE(holds(points.time_note, clock.said));
    ASSERT_EQ(points.times.size(), count);
    constexpr double resolution = 1e-6;  // seconds: a double has 0.2 us of seconds since 1970
    for (std::size_t i = 0; i < count; ++i)
      ASSERT_NEAR(1e-9 * points.times[i],
                  clock.expected_first + clock.expected_step * static_cast<double>(i), resolution);
  }
}

TEST(CloudPoints, TimesThatNoScanHasAreAFault) {
  auto fields = xyz_fields();
  fields.push_back({"t", 12, float64, 1});
  Table table(fields, 20, 3);
  for (std::size_t i = 0; i < 2; ++i) table.set(i, 0, 1.0F);
  table.set(1, 12, 5.5e-9 * static_cast<double>(stamp));  // seconds; neither of the stamp's clock
  table.set(2, 12, 7e30);                                 // the time of a point at the origin
  CloudPoints points;
  EXPECT_TRUE(holds(io::read_points(table.message(), true, points), "no scan"));
  EXPECT_EQ(io::read_points(table.message(), false, points), "");
  EXPECT_TRUE(points.times.empty());
  table.set(1, 12, 0.05);
  ASSERT_EQ(io::read_points(table.message(), true, points), "");
  EXPECT_EQ(points.times, (std::vector<std::int32_t>{0, 50'000'000, 0}));
  Table none(xyz_fields(), 12, 2);
  ASSERT_EQ(io::read_points(none.message(), true, points), "");
  EXPECT_TRUE(holds(points.time_note, "no times"));
}

TEST(CloudPoints, LiesOfSizesAreRefused) {
  using M = PointCloud2Message;
  constexpr auto most = std::numeric_limits<std::uint32_t>::max();
  const std::pair<void (*)(M&), std::string_view> lies[] = {
      {[](M&) {}, ""},
      {[](M& m) { m.width = 5; }, "do not fit"},
      {[](M& m) { m.width = m.height = m.row_step = most; }, "do not fit"},
      {[](M& m) { m.row_step = 11; }, "do not fit"},
      {[](M& m) { m.point_step = most; }, "do not fit"},
      {[](M& m) { m.fields[1].offset = most; }, "field 'y'"},
      {[](M& m) { m.fields[1].count = most; }, "field 'y'"},
      {[](M& m) { m.fields[1].datatype = 9; }, "field 'y'"},
      {[](M& m) { m.fields[1].datatype = 5; }, "float32"},
      {[](M& m) { m.fields[1].name = "why"; }, "no field 'y'"}};
  for (const auto& [change, says] : lies) {
    Table table(xyz_fields(), 12, 4, 2);
    change(table.message());
    CloudPoints points;
    const std::string fault = io::read_points(table.message(), true, points);
    EXPECT_EQ(fault.empty(), says.empty()) << fault;
    EXPECT_TRUE(holds(fault, says));
  }
}

/// Sizes, offsets and types are changed at random: whatever they say, only the data are read.
TEST(CloudPoints, RandomLayoutsAreReadOrRefused) {
  std::mt19937_64 random = seeded_random(11);
  const auto any = [&](std::uint32_t most) {
    return static_cast<std::uint32_t>(random() % (most + 1));
  };
  int read = 0;
  constexpr int rounds = 20'000;
  for (int round = 0; round < rounds; ++round) {
    PointCloud2Message cloud{.header = {stamp, ""}};
    cloud.width = any(8);
    cloud.height = any(3);
    cloud.point_step = any(40);
    cloud.row_step = random() % 2 == 0 ? cloud.width * cloud.point_step : any(400);
    cloud.is_bigendian = random() % 2 == 0;
    for (const char* const name : {"x", "y", "z", "time"})
      cloud.fields.push_back({name, any(36), static_cast<std::uint8_t>(any(9)), any(3)});
    for (auto& field : cloud.fields)
      if (random() % 4 != 0) field.datatype = float32;
    const std::vector<std::byte> data(any(1000), std::byte{0x3f});
    const std::unique_ptr<std::byte[]> exact(new std::byte[data.size()]);  // for sanitizers
    std::copy(data.begin(), data.end(), exact.get());
    cloud.data = {exact.get(), data.size()};
    CloudPoints points;
    if (!io::read_points(cloud, true, points).empty()) continue;
    ++read;
    float sum = 0.0F;
    for (std::size_t i = 0; i < points.points.count; ++i) sum += points.points[i].sum();
    const Labelled labelled(
        std::vector(points.points.count, static_cast<Label>(random() % label_count)));
    std::vector<std::byte> out;
    const auto result =
        io::cloud_output(cloud, labelled.report, {.labelled = random() % 2 == 0}, out);
    EXPECT_EQ(io::read_points(result, true, points), "") << sum;
  }
  EXPECT_GT(read, rounds / 100);
}

using enum Label;

TEST(CloudOutput, KeepsTheRowsOfOrganisedClouds) {
  auto fields = xyz_fields();
  fields.push_back({"intensity", 12, uint8, 1});
  Labelled labelled({clear, occluded, front, fringe});
  labelled.links[1] = 7;
  Table table(fields, 13, 2, 2);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::uint32_t axis = 0; axis < 3; ++axis)
      table.set(i, 4 * axis, 1.0F + static_cast<float>(i));
    table.set(i, 12, static_cast<std::uint8_t>(10 * i));
  }
  std::vector<std::byte> data;
  CloudPoints points;
  const auto removed = io::cloud_output(table.message(), labelled.report, {}, data);
  ASSERT_EQ(io::read_points(removed, true, points), "");
  ASSERT_EQ(points.points.count, 4U);
  EXPECT_EQ(points.points[0], Eigen::Vector3f(1, 1, 1));
  EXPECT_TRUE(points.points[1].array().isNaN().all());
  EXPECT_TRUE(points.points[3].array().isNaN().all());
  EXPECT_EQ(removed.data[25], std::byte{10}) << "the intensity stays";
  EXPECT_FALSE(removed.is_dense);
  const auto marked = io::cloud_output(table.message(), labelled.report, {.labelled = true}, data);
  ASSERT_EQ(marked.fields.size(), 6U);
  EXPECT_EQ(marked.fields[4].name, "label");
  EXPECT_EQ(marked.point_step, 16U);
  EXPECT_EQ(marked.data[16 + 13], static_cast<std::byte>(occluded));
  EXPECT_EQ(marked.data[16 + 14], std::byte{7});
}

TEST(CloudOutput, RemovesRangesOfAScan) {
  constexpr float no_echo = std::numeric_limits<float>::infinity();
  const io::LaserScanMessage scan{.header = {stamp, ""},
                                  .angle_min = -1.0F,
                                  .angle_increment = 0.5F,
                                  .time_increment = 1e-3F,
                                  .range_min = 0.1F,
                                  .range_max = 10.0F,
                                  .ranges = {1, 2, no_echo, 0.05F, 3},
                                  .intensities = {1, 2, 3, 4, 5}};
  CloudPoints points;
  ASSERT_EQ(io::read_points(scan, true, points), "");
  for (const std::size_t i : {0U, 1U, 4U}) {
    const float angle = -1.0F + 0.5F * static_cast<float>(i);
    const Eigen::Vector3f expected(scan.ranges[i] * std::cos(angle),
                                   scan.ranges[i] * std::sin(angle), 0);
    EXPECT_LT((points.points[i] - expected).norm(), 1e-6F);
    EXPECT_NEAR(points.times[i], 1e6 * static_cast<double>(i), 100.0);
  }
  EXPECT_TRUE(points.points[2].array().isNaN().any());
  EXPECT_TRUE(points.points[3].array().isNaN().any()) << "below range_min";
  const Labelled labelled({clear, occluded, unknown, unknown, beyond});
  std::vector<std::byte> none;
  const auto removed = io::cloud_output(scan, labelled.report, {}, none);
  EXPECT_EQ(removed.ranges[0], 1.0F);
  EXPECT_TRUE(std::isnan(removed.ranges[1]));
  EXPECT_EQ(removed.ranges[2], no_echo) << "nothing was removed there";
  EXPECT_EQ(removed.ranges[3], 0.05F);
  EXPECT_TRUE(std::isnan(removed.ranges[4]));
  EXPECT_EQ(removed.intensities, scan.intensities);
  const auto infinite = io::cloud_output(scan, labelled.report, {.infinite_ranges = true}, none);
  EXPECT_EQ(infinite.ranges[1], no_echo);
  const Labelled none_known({unknown, unknown, unknown, unknown, unknown});
  const auto unknowns = io::cloud_output(scan, none_known.report, {.infinite_ranges = true}, none);
  EXPECT_TRUE(std::isnan(unknowns.ranges[1])) << "unknown is not free";
  io::LaserScanMessage slow = scan;
  slow.time_increment = 0.5F;
  EXPECT_TRUE(holds(io::read_points(slow, true, points), "time_increment"));
}

TEST(CloudPoints, LivoxMessagesHaveTheirTimes) {
  io::LivoxMessage cloud{.header = {stamp, ""}, .timebase = 5, .point_num = 2};
  cloud.points = {{.offset_time = 7, .x = 1}, {.offset_time = 90'000'000, .x = 2}};
  CloudPoints points;
  ASSERT_EQ(io::read_points(cloud, true, points), "");
  EXPECT_EQ(points.times, (std::vector<std::int32_t>{7, 90'000'000}));
  cloud.points[1].offset_time = 4'000'000'000;
  EXPECT_TRUE(holds(io::read_points(cloud, true, points), "more than 1 s"));
}

}  // namespace
}  // namespace penumbra::test
