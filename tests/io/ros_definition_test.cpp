// SPDX-License-Identifier: Apache-2.0
#include "../support/random.hpp"
#include "../support/run_length.hpp"
#include "files.hpp"
#include "ros_samples.hpp"

#include <gtest/gtest.h>

#include <penumbra/base/version.hpp>

#include <io/ros/message_definition.hpp>
#include <io/ros/wire_types-inl.hpp>

namespace penumbra::io {
namespace {

using test::input_error;

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

TEST(RosDefinition, AnEmptyMessageHasOneByte) {
  const MessageDefinition definition("std_msgs/msg/Empty", "");
  EXPECT_EQ(definition.root().min_bytes, 1U);
}

TEST(RosDefinition, FaultsNameTypeAndLine) {
  const auto fault = [](const std::string& text) {
    return input_error([&] { MessageDefinition("a/msg/B", text); });
  };
  EXPECT_HAS(fault("int32 x\nfloat32 x"), "'a/msg/B', line 2: a/B has x twice");
  EXPECT_HAS(fault("int32"), "line 1: 'TYPE NAME' or 'TYPE NAME=VALUE' is wanted, not 'int32'");
  EXPECT_HAS(fault("int32 x.y"), "not 'int32 x.y'");
  EXPECT_HAS(fault("int32[0] x"), "'0' is no number of elements");
  EXPECT_HAS(fault("int32[-1] x"), "'-1' is no number of elements");
  EXPECT_HAS(fault("int32[99999999999] x"), "is no number of elements");
  EXPECT_HAS(fault("int32[3 x"), "'int32[3' is no type");
  EXPECT_HAS(fault("int32<=3 x"), "only strings have a bound");
  EXPECT_HAS(fault("a/b/C x"), "'a/b/C' is no type");
  EXPECT_HAS(fault("C x"), "lacks the definition of a/C");
  EXPECT_HAS(fault("B x"), "a/B holds itself");
  EXPECT_HAS(fault("C x\n===\nMSG: a/C\nD[] y\n===\nMSG: a/D\nB[2] z"), "holds itself");
  EXPECT_HAS(fault("===\nMSG: a/C\n===\nMSG: a/msg/C\n"), "line 4: a/C is defined twice");
  EXPECT_HAS(fault("===\nIDL: a/C\n"), "'MSG: package/Type' is wanted behind a line of '='");
  EXPECT_HAS(fault(std::string(MessageDefinition::max_text + 1, '#')), "bytes; at most");
  EXPECT_HAS(input_error([] { MessageDefinition("no type", ""); }), "is no message type");
  std::string many;
  for (std::size_t i = 0; i <= MessageDefinition::max_types; ++i)
    many += "===\nMSG: a/T" + std::to_string(i) + "\n";
  EXPECT_HAS(fault(many), "more than 256 message types");
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

TEST(RosDefinition, BuiltInTextsHoldTheirDependencies) {
  const std::string_view text = definition_of("tf2_msgs/msg/TFMessage");
  EXPECT_EQ(text, definition_of("tf2_msgs/TFMessage"));
  const std::string line = "\n" + std::string(80, '=') + "\nMSG: ";
  EXPECT_HAS(std::string(text), line + "geometry_msgs/TransformStamped\n");
  EXPECT_HAS(std::string(text), line + "geometry_msgs/Quaternion\n");
  EXPECT_HAS(std::string(text), line + "builtin_interfaces/Time\n");
  EXPECT_EQ(text.find("SPDX"), std::string_view::npos);
  EXPECT_TRUE(definition_of("tf2_msgs/msg/Nothing").empty());
}

// What is written is the built-in definition's fields, all of them and in their order.
template <typename M>
void expect_all_fields(const std::vector<TypeDefinition>& types, std::size_t type);

template <typename T>
void expect_member(const std::vector<TypeDefinition>& types, const FieldDefinition& field) {
  using Value = typename Shape<T>::Value;
  EXPECT_TRUE(has_shape<T>(field)) << shown_field(field) << ", not " << shape_text<T>();
  if constexpr (WireMessage<Value>) expect_all_fields<Value>(types, field.nested);
}

template <typename M, typename T>
void expect_field(const std::vector<TypeDefinition>& types, const FieldDefinition& field,
                  const Member<M, T>& member) {
  EXPECT_EQ(field.name, member.name);
  expect_member<T>(types, field);
}

template <typename W, typename M, typename T>
void expect_field(const std::vector<TypeDefinition>& types, const FieldDefinition& field,
                  const Converted<W, M, T>& member) {
  EXPECT_EQ(field.name, member.name);
  expect_member<W>(types, field);
}

template <typename M>
void expect_all_fields(const std::vector<TypeDefinition>& types, std::size_t type) {
  const auto& fields = types[type].fields;
  ASSERT_EQ(fields.size(), std::tuple_size_v<decltype(Fields<M>::members)>) << types[type].name;
  std::apply(
      [&](const auto&... members) {
        std::size_t i = 0;
        (expect_field(types, fields[i++], members), ...);
      },
      Fields<M>::members);
}

TEST(RosDefinition, StructsThatAreWrittenHaveEveryField) {
  test::for_each_sample([](const auto& message) {
    using M = std::decay_t<decltype(message)>;
    const MessageDefinition definition(message_type<M>(), definition_of(message_type<M>()));
    expect_all_fields<M>(definition.types(), 0);
  });
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

TEST(RosDefinition, DamagedTextsThrowInputErrorsOnly) {
  std::mt19937_64 random = test::seeded_random(5);
  const std::string whole(definition_of("penumbra_msgs/Targets"));
  for (std::size_t size = 0; size <= whole.size(); ++size)
    test::only_input_errors(
        [&] { MessageDefinition("penumbra_msgs/Targets", whole.substr(0, size)); });
  const int rounds = test::is_full_run() ? 200'000 : 3'000;
  constexpr std::string_view spice = "[]<=#/\n\" 09aZ\t=";
  for (int i = 0; i < rounds; ++i) {
    std::string text = whole;
    for (std::size_t n = 1 + random() % 8; n > 0; --n)
      text[random() % text.size()] =
          random() % 2 == 0 ? spice[random() % spice.size()] : static_cast<char>(random());
    test::only_input_errors([&] { MessageDefinition("penumbra_msgs/Targets", text); });
  }
}

}  // namespace
}  // namespace penumbra::io
