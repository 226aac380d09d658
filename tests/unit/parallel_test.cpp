#include "tools/experiment/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>

namespace sandhopper {
namespace {

TEST(Parallel, DoesEachPieceOnce) {
  for (int round = 0; round < 200; ++round) {
    std::vector<std::atomic<int>> done(17);
    parallel_for(17L, 3, [&](long i) { ++done[static_cast<std::size_t>(i)]; });
    for (const auto& times : done) EXPECT_EQ(times, 1);
  }
}

TEST(Parallel, PiecesMayBeParallelThemselvesAndMayFail) {
  std::atomic<int> inner{0};
  parallel_for(4L, 2, [&](long) { parallel_for(5L, 2, [&](long) { ++inner; }); });
  EXPECT_EQ(inner, 20);
  EXPECT_THROW(parallel_for(8L, 2,
                            [](long i) {
                              if (i == 3) throw std::runtime_error("third");
                            }),
               std::runtime_error);
  std::atomic<int> after{0};
  parallel_for(6L, 2, [&](long) { ++after; });
  EXPECT_EQ(after, 6);
}

// Two threads that both ask: one may have to do its work alone, none waits for the other.
TEST(Parallel, IsForSeveralCallersAtOnce) {
  std::atomic<int> done{0};
  {
    const auto ask = [&] {
      for (int round = 0; round < 100; ++round) parallel_for(9L, 2, [&](long) { ++done; });
    };
    const std::jthread one(ask), other(ask);
  }
  EXPECT_EQ(done, 1800);
}

}  // namespace
}  // namespace sandhopper
