// SPDX-License-Identifier: Apache-2.0
#include "../support/run_length.hpp"
#include "files.hpp"

#include <gtest/gtest.h>

#include <penumbra/base/version.hpp>

#include <io/ros/message_definition.hpp>
#include <io/ros/messages.hpp>

namespace penumbra::io {
namespace {

std::string shown_field(const FieldDefinition& field) {
  const std::string text = type_text(field) + " " + field.name;
  return field.default_text.empty() ? text : text + " " + field.default_text;
}

std::vector<std::string> shown_fields(const TypeDefinition& type) {
  std::vector<std::string> fields;
  for (const FieldDefinition& field : type.fields) fields.push_back(shown_field(field));
  return fields;
}

TEST(RosDefinition, ReadsEveryKindOfField) {
  const MessageDefinition definition("own_msgs/msg/Kinds",
                                     "# a comment\n"
                                     "bool[] flags\r\n"
                                     "byte one # why\n"
                                     "\tchar  two\n"
                                     "\n"
                                     "float64[3] xyz [1.0, 2.0, 3.0]\n"
                                     "int16[<=5] few\n"
                                     "string<=10[<=3] names\n"
                                     "string greeting \"a # b\"\n"
                                     "Inner inner\n"
                                     "other_msgs/Thing[2] things\n"
                                     "time stamp\n"
                                     "builtin_interfaces/Duration span\n"
                                     "int32 MOST=7\n"
                                     "string NAME = \"x=1\"  # the name\n"
                                     "================\n"
                                     "MSG: own_msgs/Inner\n"
                                     "uint8 value 3\n"
                                     "===============================\n"
                                     "MSG: other_msgs/msg/Thing\n"
                                     "string<=4 id\n"
                                     "uint64 count");
  EXPECT_EQ(definition.root().name, "own_msgs/Kinds");
  const std::vector<std::string> wanted = {"bool[] flags",
                                           "byte one",
                                           "char two",
                                           "float64[3] xyz [1.0, 2.0, 3.0]",
                                           "int16[<=5] few",
                                           "string<=10[<=3] names",
                                           "string greeting \"a # b\"",
                                           "own_msgs/Inner inner",
                                           "other_msgs/Thing[2] things",
                                           "builtin_interfaces/Time stamp",
                                           "builtin_interfaces/Duration span"};
  EXPECT_EQ(shown_fields(definition.root()), wanted);
  ASSERT_EQ(definition.root().constants.size(), 2U);
  EXPECT_EQ(definition.root().constants[0].value_text, "7");
  EXPECT_EQ(definition.root().constants[1].name, "NAME");
  EXPECT_EQ(definition.root().constants[1].value_text, "\"x=1\"");
  const auto& things = definition.root().fields[8];
  EXPECT_EQ(shown_fields(definition.types()[things.nested]),
            (std::vector<std::string>{"string<=4 id", "uint64 count"}));
  EXPECT_EQ(min_bytes_each(things, definition.types()), 12U);
  EXPECT_EQ(definition.root().min_bytes, 4U + 1 + 1 + 24 + 4 + 4 + 4 + 1 + 2 * 12 + 8 + 8);
}

TEST(RosDefinition, FaultsNameTypeAndLine) {
  std::string many;
  for (std::size_t i = 0; i <= MessageDefinition::max_types; ++i)
    many += "===\nMSG: a/T" + std::to_string(i) + "\n";
  test::expect_refused({{"int32 x\nfloat32 x", "'a/msg/B', line 2"},
                        {"int32", "line 1: "},
                        {"int32 x.y", "'int32 x.y'"},
                        {"int32[0] x", "'0'"},
                        {"int32[-1] x", "'-1'"},
                        {"int32[99999999999] x", "'99999999999'"},
                        {"int32[3 x", "'int32[3'"},
                        {"int32<=3 x", "only strings"},
                        {"a/b/C x", "'a/b/C'"},
                        {"C x", "a/C"},
                        {"B x", "a/B holds itself"},
                        {"C x\n===\nMSG: a/C\nD[] y\n===\nMSG: a/D\nB[2] z", "holds itself"},
                        {"===\nMSG: a/C\n===\nMSG: a/msg/C\n", "line 4: a/C"},
                        {"===\nIDL: a/C\n", "MSG: package/Type"},
                        {std::string(MessageDefinition::max_text + 1, '#'), "bytes"},
                        {many, "256"}},
                       [](const std::string& text) { MessageDefinition("a/msg/B", text); });
}

// Such a tree has 64^64 leaves; it must cost as much as its text.
TEST(RosDefinition, WideAndDeepCostsNothing) {
  std::string text = "T0 x\n";
  for (int i = 0; i < 64; ++i) {
    text += "===\nMSG: a/T" + std::to_string(i) + "\n";
    for (int k = 0; k < 64; ++k)
      text += (i == 63 ? std::string("uint8") : "T" + std::to_string(i + 1) + "[4000000000]") +
              " f" + std::to_string(k) + "\n";
  }
  const MessageDefinition definition("a/msg/Root", text);
  EXPECT_GT(definition.root().min_bytes, 1'000'000'000U);
}

TEST(RosDefinition, ConstantsOfOurMessagesAreTheStructs) {
  const MessageDefinition definition("penumbra_msgs/Target", definition_of("penumbra_msgs/Target"));
  using T = TargetMessage;
  const std::vector<std::pair<std::string, int>> wanted = {{"UNKNOWN", T::unknown},
                                                           {"VISIBLE", T::visible},
                                                           {"PARTIAL", T::partial},
                                                           {"HIDDEN", T::hidden},
                                                           {"OUT_OF_VIEW", T::out_of_view},
                                                           {"NOT_HANDLED", T::not_handled},
                                                           {"MEASURED", T::measured},
                                                           {"PREDICTED", T::predicted},
                                                           {"HELD", T::held},
                                                           {"LOST", T::lost},
                                                           {"NO_ESTIMATE", T::no_estimate},
                                                           {"ACCEPTED", T::accepted},
                                                           {"REFUSED_VERDICT", T::refused_verdict},
                                                           {"REFUSED_GATE", T::refused_gate},
                                                           {"REFUSED_LATE", T::refused_late},
                                                           {"REFUSED_INVALID", T::refused_invalid}};
  ASSERT_EQ(definition.root().constants.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_EQ(definition.root().constants[i].name, wanted[i].first);
    EXPECT_EQ(definition.root().constants[i].value_text, std::to_string(wanted[i].second));
  }
}

// What colcon builds: the same files, of this version.
TEST(RosDefinition, OurPackageListsItsMessages) {
  const std::filesystem::path folder = PENUMBRA_SOURCE_DIR "/ros/penumbra_msgs";
  EXPECT_HAS(test::read_bytes(folder / "package.xml"), "<version>" PENUMBRA_VERSION "</version>");
  const std::string listed = test::read_bytes(folder / "CMakeLists.txt");
  std::size_t messages = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "msg")) {
    EXPECT_HAS(listed, "  msg/" + entry.path().filename().string() + "\n");
    EXPECT_FALSE(definition_of("penumbra_msgs/" + entry.path().stem().string()).empty());
    ++messages;
  }
  EXPECT_EQ(messages, 5U);
}

TEST(RosDefinition, SurvivesDamage) {
  test::read_damaged(
      std::string(definition_of("penumbra_msgs/Targets")), test::is_full_run() ? 200'000 : 3000,
      [](const std::string& text) { MessageDefinition("penumbra_msgs/Targets", text); });
}

}  // namespace
}  // namespace penumbra::io
