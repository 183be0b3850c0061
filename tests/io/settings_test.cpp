// SPDX-License-Identifier: Apache-2.0
// Settings: the tables of the documents are those of the descriptions; files and options agree with
// check().

#include "../support/test.hpp"

#include <penumbra/base/whole_file-inl.hpp>
#include <penumbra/targets/target_judge.hpp>
#include <penumbra/tracking/trackers.hpp>

#include <io/files/settings.hpp>
#include <io/files/statistics.hpp>

namespace penumbra::io {
namespace {

template <typename Value>
std::string text_of(const Value& value) {
  std::ostringstream text;
  if constexpr (std::is_same_v<Value, Tolerance>) {
    text << value.a << ", " << value.b << ", " << value.c;
  } else if constexpr (std::is_same_v<Value, Eigen::Vector3d>) {
    text << value.x() << ", " << value.y() << ", " << value.z();
  } else if constexpr (std::is_enum_v<Value>) {
    text << '`' << to_string(value) << '`';
  } else if constexpr (requires { value.has_value(); }) {
    return value ? text_of(*value) : "none";
  } else {
    text << std::boolalpha << value;
  }
  return text.str();
}

template <typename Value>
std::string range_of(const auto& setting) {
  std::ostringstream text;
  if constexpr (requires(Value value) { value.has_value(); }) {
    return range_of<typename Value::value_type>(setting);
  } else if constexpr (std::is_enum_v<Value>) {
    return expected_of<Value>(setting);
  } else if constexpr (NumberSetting<Value>) {
    text << setting.range.least << " to " << setting.range.most;
  }
  return text.str();
}

/// The table of the settings of a struct.
template <typename Struct>
std::string table() {
  std::ostringstream text;
  text << "| setting | unit | range | default | meaning |\n|---|---|---|---|---|\n";
  for_each_setting<Struct>([&]<typename Value>(const Setting<Struct, Value>& setting) {
    text << "| `" << setting.name << "` | " << setting.unit << " | " << range_of<Value>(setting)
         << " | " << text_of(Struct{}.*setting.member) << " | " << setting.meaning << " |\n";
  });
  return text.str();
}

template <typename Struct>
void expect_table_in(const std::string& page, const std::string& name) {
  const std::string text =
      read_whole_file(std::filesystem::path(PENUMBRA_SOURCE_DIR) / "docs" / page, FileLimit::text);
  const std::string first = "<!-- begin: " + name + " -->\n\n", last = "\n<!-- end: " + name;
  const std::size_t begin = text.find(first) + first.size();
  EXPECT_EQ(text.substr(begin, text.find(last) - begin), table<Struct>()) << page;
}

TEST(Settings, TablesAreThoseOfTheDescriptions) {
  expect_table_in<LabelRule>("tuning.md", "LabelRule");
  expect_table_in<TargetThresholds>("targets.md", "TargetThresholds");
  expect_table_in<PoseTrackerConfig>("tracking.md", "PoseTrackerConfig");
  expect_table_in<PointTrackerConfig>("tracking.md", "PointTrackerConfig");
}

/// A text is a setting's value in a file if and only if check() accepts it.
TEST(Settings, FilesRefuseWhatTheCheckRefuses) {
  for_each_setting<LabelRule>([&]<typename Value>(const Setting<LabelRule, Value>& setting) {
    if constexpr (NumberSetting<Value>) {
      for (const double number : {-1.0, 0.0, 1.0, 2.5, 63.0, 64.0, 255.0, 256.0, 1001.0}) {
        LabelRule read, set;
        const std::string yaml = std::string(setting.name) + ": " + text_of(number);
        const YamlNode node = YamlNode::parse(yaml, "a.yaml");
        set.*setting.member = static_cast<Value>(number);
        const bool is_whole = static_cast<double>(set.*setting.member) == number;
        const std::string refused = test::refusal([&] { read_settings(node, read); });
        EXPECT_EQ(refused.empty(), is_whole && test::refusal([&] { set.check(); }).empty()) << yaml;
        EXPECT_TRUE(refused.empty() ||
                    test::holds(refused, "a.yaml:1: " + std::string(setting.name)));
      }
    }
  });
}

TEST(Settings, OthersKeepTheirs) {
  RuleOptions options;
  options.given = read_settings(YamlNode::parse("edge_margin: 3\nparent: a", "a.yaml"),
                                options.values, {"parent"});
  LabelRule recorded;
  recorded.fringe_reach = 11;
  EXPECT_EQ(options.applied_to(recorded).edge_margin, 3);
  EXPECT_EQ(options.applied_to(recorded).fringe_reach, 11);
  options.sensor = "tof";
  EXPECT_EQ(options.applied_to(recorded).fringe_reach, 6);
}

TEST(Statistics, QuantilesByRank) {
  EXPECT_FALSE(quantiles({}).has_value());
  EXPECT_EQ(quantiles({4.0, 1.0, 2.0, 3.0})->median, 3.0);
  std::vector<double> samples(200);
  std::iota(samples.rbegin(), samples.rend(), 1.0);
  EXPECT_EQ(quantiles(samples)->p99, 198.0) << "198 of 200 are 99 %";
  EXPECT_EQ(quantiles(samples)->max, 200.0);
}

}  // namespace
}  // namespace penumbra::io
