#include <gtest/gtest.h>

#include <thread>

#include "firmware/log/spsc_ring.hpp"

namespace sandhopper {
namespace {

struct Slot {
  std::uint64_t number = 0;
  std::uint64_t check = 0;
};

TEST(SpscRing, KeepsOrderAndCountsWhatDoesNotFit) {
  SpscRing<int> ring(4);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(ring.push(i), i < 4);
  EXPECT_EQ(ring.dropped(), 2U);
  for (int i = 0; i < 4; ++i) {
    ASSERT_NE(ring.front(), nullptr);
    EXPECT_EQ(*ring.front(), i);
    ring.pop();
  }
  EXPECT_EQ(ring.front(), nullptr);
  EXPECT_TRUE(ring.push(9));
}

TEST(SpscRing, TwoThreadsSeeEveryValueOnceAndWhole) {
  SpscRing<Slot> ring(64);
  constexpr std::uint64_t kCount = 200'000;
  std::thread producer([&ring] {
    for (std::uint64_t i = 0; i < kCount;) {
      Slot* slot = ring.claim();
      if (slot == nullptr) {
        std::this_thread::yield();
        continue;
      }
      *slot = {i, ~i};
      ring.publish();
      ++i;
    }
  });
  std::uint64_t expected = 0;
  while (expected < kCount) {
    const Slot* slot = ring.front();
    if (slot == nullptr) {
      std::this_thread::yield();
      continue;
    }
    ASSERT_EQ(slot->number, expected);
    ASSERT_EQ(slot->check, ~expected);
    ring.pop();
    ++expected;
  }
  producer.join();
  EXPECT_EQ(ring.front(), nullptr);
}

}  // namespace
}  // namespace sandhopper
