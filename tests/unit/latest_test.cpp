#include "drivers/latest.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace sandhopper {
namespace {

TEST(Latest, GivesEachValueOnceAndOnlyTheNewest) {
  Latest<int> box;
  int value = -1;
  EXPECT_FALSE(box.take(value));
  EXPECT_EQ(value, -1);
  box.publish(1);
  box.publish(2);
  EXPECT_TRUE(box.take(value));
  EXPECT_EQ(value, 2);
  EXPECT_FALSE(box.take(value));
}

// Also run under the thread sanitizer. A value torn between two writes has different fields.
TEST(Latest, NeverTearsAValueBetweenThreads) {
  struct Wide {
    std::array<std::uint64_t, 16> same{};
  };
  constexpr std::uint64_t kLast = 20000;
  Latest<Wide> box;
  std::thread writer([&] {
    Wide wide;
    for (std::uint64_t n = 1; n <= kLast; ++n) {
      wide.same.fill(n);
      box.publish(wide);
      if (n % 64 == 0) std::this_thread::yield();
    }
  });
  Wide seen;
  std::uint64_t previous = 0;
  while (previous != kLast) {
    if (!box.take(seen)) {
      std::this_thread::yield();
      continue;
    }
    for (const auto word : seen.same) ASSERT_EQ(word, seen.same[0]);
    ASSERT_GT(seen.same[0], previous);
    previous = seen.same[0];
  }
  writer.join();
}

}  // namespace
}  // namespace sandhopper
