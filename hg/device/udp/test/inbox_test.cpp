#include "hg/device/udp/inbox.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <vector>

namespace hg::udp {
namespace {

bool take(Inbox& inbox, std::uint64_t number, std::uint32_t session = 7,
          MessageType type = MessageType::kSensors) {
  const auto code = static_cast<std::uint16_t>(type);
  return inbox.accept(DatagramCheck::kGood, {.type = code, .session = session, .number = number});
}

TEST(Inbox, TakesEachNumberOnceAndCountsTheMissing) {
  Inbox inbox(7, Side::kServer);
  for (const std::uint64_t number : {4, 5, 8}) EXPECT_TRUE(take(inbox, number));
  EXPECT_FALSE(inbox.was_overtaken());
  EXPECT_EQ(inbox.counts().lost, 2U);  // 6 and 7
  EXPECT_TRUE(take(inbox, 6));
  EXPECT_TRUE(inbox.was_overtaken());
  EXPECT_FALSE(take(inbox, 6));
  EXPECT_FALSE(take(inbox, 8));
  const LinkCounts counts = inbox.counts();
  EXPECT_EQ(counts.received, 4U);
  EXPECT_EQ(counts.reordered, 1U);
  EXPECT_EQ(counts.duplicate, 2U);
  EXPECT_EQ(counts.lost, 1U);
}

TEST(Inbox, RefusesAndCountsWhatIsNotOfThisSession) {
  Inbox inbox(7, Side::kServer);
  EXPECT_FALSE(take(inbox, 1, 8));
  EXPECT_FALSE(inbox.accept(DatagramCheck::kCorrupted, {.session = 7, .number = 2}));
  EXPECT_FALSE(inbox.accept(DatagramCheck::kTruncated, {}));
  EXPECT_FALSE(inbox.accept(DatagramCheck::kForeign, {}));
  EXPECT_FALSE(inbox.accept(DatagramCheck::kWrongVersion, {.session = 7, .number = 3}));
  const LinkCounts counts = inbox.counts();
  EXPECT_EQ(counts.wrong_session, 1U);
  EXPECT_EQ(counts.corrupted, 1U);
  EXPECT_EQ(counts.truncated, 1U);
  EXPECT_EQ(counts.foreign, 1U);
  EXPECT_EQ(counts.wrong_version, 1U);
  EXPECT_EQ(counts.received, 0U);
}

// An attacker without the key can send back what it has heard.
TEST(Inbox, OwnDatagramsThatComeBackUseUpNoNumber) {
  Inbox inbox(7, Side::kServer);
  EXPECT_FALSE(take(inbox, 3, 7, MessageType::kCommand));
  EXPECT_FALSE(take(inbox, 4, 7, MessageType::kLeader));
  EXPECT_TRUE(take(inbox, 3));
  EXPECT_TRUE(take(inbox, 4));
  EXPECT_EQ(inbox.counts().foreign, 2U);
  EXPECT_EQ(inbox.counts().duplicate, 0U);
}

TEST(Inbox, OldNumbersAreNotTakenAgain) {
  Inbox inbox(7, Side::kServer);
  EXPECT_TRUE(take(inbox, 1));
  EXPECT_TRUE(take(inbox, 1 + NumberWindow::kSize));
  EXPECT_FALSE(take(inbox, 1));
  EXPECT_TRUE(take(inbox, 2));  // the oldest that is still remembered
}

TEST(Inbox, CountsAsASetDoesWhateverTheOrder) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Inbox inbox(7, Side::kServer);
    std::set<std::uint64_t> seen;
    std::uint64_t newest = 100, first = 100;
    for (int i = 0; i < 2000; ++i) {
      const std::uint64_t number = newest + random() % 5 - (i == 0 ? 0 : random() % 30);
      const bool is_new = seen.insert(number).second;
      ASSERT_EQ(take(inbox, number), is_new) << number;
      newest = std::max(newest, number);
      if (i == 0) first = newest = number;
      first = std::min(first, number);
      ASSERT_EQ(inbox.counts().received, seen.size());
      ASSERT_EQ(inbox.counts().lost, newest - first + 1 - seen.size());
    }
  }
}

}  // namespace
}  // namespace hg::udp
