// SPDX-License-Identifier: Apache-2.0
#include "../support/random.hpp"
#include "../support/run_length.hpp"
#include "files.hpp"
#include "ros_samples.hpp"

#include <gtest/gtest.h>

#include <penumbra/base/version.hpp>

#include <io/ros/message_definition.hpp>

namespace penumbra::io {
namespace {

using test::refusal;

// ros_reference_test compares the fields' values.
TEST(RosDefinition, LayoutsHaveTheFieldsOfTheirDefinitions) {
  test::for_each_sample([]<typename M>(const M&) {
    const MessageDefinition definition(M::ros_type, definition_of(M::ros_type));
    EXPECT_EQ(definition.types().front().fields.size(),
              std::tuple_size_v<decltype(M::layout(std::declval<M&>()))>);
    EXPECT_NO_THROW(Decoder<M>(message_type<M>(), definition_of(message_type<M>())));
  });
}

TEST(RosDefinition, ConstantsOfOurMessagesAreTheStructs) {
  const std::string text(definition_of("penumbra_msgs/Target"));
  using T = TargetMessage;
  const int values[] = {
      T::unknown,      T::visible,        T::partial,  T::hidden,          T::out_of_view,
      T::held_by_link, T::not_handled,    T::measured, T::predicted,       T::held,
      T::lost,         T::no_estimate,    T::accepted, T::refused_verdict, T::refused_gate,
      T::refused_late, T::refused_invalid};
  std::istringstream names(
      "UNKNOWN VISIBLE PARTIAL HIDDEN OUT_OF_VIEW HELD_BY_LINK NOT_HANDLED MEASURED PREDICTED HELD "
      "LOST NO_ESTIMATE ACCEPTED REFUSED_VERDICT REFUSED_GATE REFUSED_LATE REFUSED_INVALID");
  std::string name;
  for (const int value : values) {
    names >> name;
    EXPECT_HAS(text, "\nuint8 " + name + "=" + std::to_string(value) + "\n");
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
  EXPECT_EQ(messages, 11U);
}

// Bytes are never read by a definition that differs in a field.
TEST(RosDefinition, DamagedTextsThrowInputErrorsOnly) {
  std::mt19937_64 random = test::seeded_random(5);
  const std::string whole(definition_of("penumbra_msgs/Targets"));
  const int rounds = test::is_full_run() ? 200'000 : 3'000;
  constexpr std::string_view spice = "[]<=#/\n\" 09aZ\t=";
  for (int i = 0; i < rounds; ++i) {
    std::string text = whole.substr(0, random() % 4 == 0 ? random() % whole.size() : whole.size());
    for (std::size_t n = 1 + random() % 8; n > 0 && !text.empty(); --n)
      text[random() % text.size()] =
          random() % 2 == 0 ? spice[random() % spice.size()] : static_cast<char>(random());
    test::refusal([&] { Decoder<TargetsMessage>("penumbra_msgs/Targets", text); });
  }
}

}  // namespace
}  // namespace penumbra::io
