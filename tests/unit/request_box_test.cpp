#include "firmware/request_box.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>
#include <vector>

// The request box serves the most urgent word first and answers every other one.
namespace sandhopper {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class RequestBoxTest : public ::testing::Test {
 protected:
  void post(const std::vector<Word>& words) { box.post(words, ++received_ns); }

  // One cycle: returns the request that it serves and keeps the answers as text, for example "release
  // overruled stop".
  Request turn() {
    const auto taken = box.take(++time_ns, quit);
    answers.clear();
    for (const auto& a : taken.answers) {
      auto text = std::string(name_of(a.word)) + " " + std::string(name_of(a.outcome));
      if (a.outcome == RequestOutcome::overruled) text += " " + std::string(name_of(a.overruled_by));
      answers.push_back(text);
      EXPECT_EQ(a.time_ns, time_ns);
    }
    return taken.request;
  }

  RequestBox box;
  std::atomic<Quit> quit{Quit::no};
  std::int64_t time_ns = 1000;
  std::int64_t received_ns = 0;
  std::vector<std::string> answers;
};

TEST_F(RequestBoxTest, AStopInOneWriteWithReleaseWinsOnEitherSideOfIt) {
  for (const auto& words : {std::vector{Word::stop, Word::release}, std::vector{Word::release, Word::stop}}) {
    post(words);
    EXPECT_EQ(turn(), Request::stop);
    EXPECT_THAT(answers, ElementsAre("stop served", "release overruled stop"));
    EXPECT_EQ(turn(), Request::none);
    EXPECT_THAT(answers, IsEmpty());
  }
}

TEST_F(RequestBoxTest, AStopCancelsAllThatIsNotYetServed) {
  post({Word::arm, Word::release});
  post({Word::arm});
  EXPECT_EQ(turn(), Request::arm);
  post({Word::stop});
  EXPECT_EQ(turn(), Request::stop);
  EXPECT_THAT(answers, ElementsAre("stop served", "release overruled stop", "arm overruled stop"));
  post({Word::arm});
  EXPECT_EQ(turn(), Request::arm) << "what comes after the stop was served is not overruled";
}

TEST_F(RequestBoxTest, DisarmOverrulesWhatStoodBeforeItAndNotWhatFollows) {
  post({Word::arm, Word::disarm, Word::arm, Word::release});
  EXPECT_EQ(turn(), Request::disarm);
  EXPECT_THAT(answers, ElementsAre("disarm served", "arm overruled disarm"));
  EXPECT_EQ(turn(), Request::arm);
  EXPECT_EQ(turn(), Request::release);
}

TEST_F(RequestBoxTest, StopComesBeforeDisarmAndBothAreServed) {
  post({Word::disarm, Word::stop});
  EXPECT_EQ(turn(), Request::stop);
  EXPECT_EQ(turn(), Request::disarm);
}

TEST_F(RequestBoxTest, AnUnknownWordStopsAndOverrules) {
  post({Word::release, Word::unknown});
  EXPECT_EQ(turn(), Request::stop);
  EXPECT_THAT(answers, ElementsAre("unknown served", "release overruled unknown"));
}

TEST_F(RequestBoxTest, AfterAQuitNothingArms) {
  post({Word::arm});
  quit = Quit::softly;
  EXPECT_EQ(turn(), Request::stop);
  EXPECT_THAT(answers, ElementsAre("arm overruled quit"));
  post({Word::release, Word::disarm});
  EXPECT_EQ(turn(), Request::disarm);
  EXPECT_THAT(answers, ElementsAre("release overruled quit", "disarm served"));
}

TEST_F(RequestBoxTest, AFloodCannotKeepAStopOutAndIsAnswered) {
  post(std::vector<Word>(1000, Word::arm));
  post({Word::stop});
  EXPECT_EQ(turn(), Request::stop);
  EXPECT_EQ(answers.front(), "stop served");
  EXPECT_EQ(answers[1], "arm overruled stop");
  EXPECT_EQ(answers.back(), "arm refused");
  EXPECT_EQ(answers.size(), 2 + RequestBox::kMost);
  EXPECT_EQ(turn(), Request::none);
}

TEST_F(RequestBoxTest, AnAnswerHasItsTimes) {
  box.post(std::array{Word::arm}, 77);
  box.post(std::array{Word::release}, 0);
  const auto first = box.take(1000, quit);
  ASSERT_EQ(first.answers.size(), 1U);
  EXPECT_EQ(first.answers[0].received_ns, 77);
  EXPECT_EQ(first.answers[0].number, 1U);
  const auto second = box.take(2000, quit);
  EXPECT_EQ(second.answers[0].received_ns, 2000) << "the cycle stamps what has no time";
  EXPECT_EQ(second.answers[0].number, 2U);
}

// A cycle reads at random instants. A release must never be served with or after the stop of the same read,
// and each word must be answered exactly once.
TEST_F(RequestBoxTest, UnderTwoPostersAndACycleEachWordIsAnsweredOnceAndNoReleaseOutlivesItsStop) {
  constexpr int kPosts = 2000;
  std::atomic<int> posting{2};
  const auto poster = [&] {
    for (int i = 0; i < kPosts; ++i) {
      box.post(std::array{Word::release, Word::stop, Word::release}, 1);
      if (i % 8 == 0) std::this_thread::yield();
    }
    --posting;
  };
  std::thread first(poster), second(poster);
  std::uint64_t answered = 0, released = 0;
  for (bool last = false;;) {
    const bool over = posting == 0;
    const auto taken = box.take(++time_ns, quit);
    for (const auto& a : taken.answers) answered += a.count;
    released += taken.request == Request::release ? 1 : 0;
    if (over && taken.answers.empty() && std::exchange(last, true)) break;
  }
  first.join();
  second.join();
  EXPECT_EQ(answered, 2U * 3U * kPosts);
  EXPECT_EQ(released, 0U);
}

}  // namespace
}  // namespace sandhopper
