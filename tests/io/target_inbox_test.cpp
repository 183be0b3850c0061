// SPDX-License-Identifier: Apache-2.0
// Which targets messages become, and under which names.
#include "robots.hpp"

#include <map>
#include <string>

#include <gtest/gtest.h>

#include <io/ros/target_inbox.hpp>

namespace penumbra::io {
namespace {

class TargetInboxTest : public testing::Test {
 protected:
  /// Identities by names.
  std::map<std::string, bool> taken() {
    std::map<std::string, bool> all;
    for (const Target& target : inbox_.take()) all[std::string(target.name)] = target.has_identity;
    return all;
  }
  template <typename Detection>
  static Detection detection(const std::string& id, const std::string& class_id) {
    Detection one;
    one.id = id;
    one.results = {{{"other", 0.1}}, {{class_id, 0.9}}};
    return one;
  }

  const Robot robot_ = test::arm();
  TargetInbox inbox_{robot_, "optical"};
  const MessageHeader header_{7, "optical"};
};

using Names = std::map<std::string, bool>;

TEST_F(TargetInboxTest, NamesMadeOfAPlaceAreNoIdentity) {
  const auto cup = [](const std::string& id) { return detection<Detection2DMessage>(id, "cup"); };
  inbox_.add("/d", Detection2DArrayMessage{header_, {cup(""), cup("7"), cup("")}});
  EXPECT_EQ(taken(), (Names{{"/d/cup", false}, {"/d/7", true}, {"/d/cup 2", false}}));
  inbox_.add("/d", Detection2DArrayMessage{header_, {cup("")}});
  EXPECT_EQ(taken(), (Names{{"/d/cup", false}})) << "the other may be the one that is hidden";
}

TEST_F(TargetInboxTest, IdsThatStandTwiceAreNone) {
  const auto cup = [](const std::string& id) { return detection<Detection3DMessage>(id, "cup"); };
  inbox_.add("/d", Detection3DArrayMessage{header_, {cup("7"), cup("8"), cup("7")}});
  EXPECT_EQ(taken(), (Names{{"/d/7", false}, {"/d/8", true}, {"/d/7 2", false}}));
  inbox_.add("/d", Detection3DArrayMessage{header_, {cup(""), cup("cup")}});
  EXPECT_EQ(taken(), (Names{{"/d/cup", false}, {"/d/cup 2", false}})) << "an id as a class is";
  inbox_.add("/d", Detection3DArrayMessage{header_, {cup("7"), cup("7"), cup("7 2")}});
  EXPECT_EQ(taken(), (Names{{"/d/7", false}, {"/d/7 2", false}, {"/d/7 2 2", false}}));
}

TEST_F(TargetInboxTest, KeypointsHaveTheirNames) {
  const KeypointsMessage message{header_, {{.name = "left"}, {.name = ""}, {.name = "right"}}};
  inbox_.add("/k", message);
  EXPECT_EQ(taken(), (Names{{"/k/left", true}, {"/k/", false}, {"/k/right", true}}));
  inbox_.add("/goal", PoseStampedMessage{.header = header_});
  EXPECT_EQ(taken(), (Names{{"/goal", true}}));
}

}  // namespace
}  // namespace penumbra::io
