#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <string_view>

#include "config/fields.hpp"
#include "firmware/log/spsc_ring.hpp"
#include "firmware/records.hpp"
#include "firmware/sensor_frame.hpp"

namespace sandhopper {

// Way of ending. softly: stop the robot and wait until its drives are off. at_once: do not wait; the owner of
// the drives switches them off.
enum class Quit : std::uint8_t { no, softly, at_once };

// Words of the operator. The first five stop the robot. An unknown word is one of them, because it may have
// been meant as `stop`.
enum class Word : std::uint8_t { quit, end_of_input, signal, stop, unknown, disarm, arm, release };
template <>
struct EnumNames<Word> {
  static constexpr std::array<std::string_view, 8> value{"quit",    "end_of_input", "signal", "stop",
                                                         "unknown", "disarm",       "arm",    "release"};
};

constexpr bool means_quit(Word word) noexcept { return word <= Word::signal; }
constexpr bool means_stop(Word word) noexcept { return word <= Word::unknown; }
constexpr Request request_of(Word word) noexcept {
  if (means_stop(word)) return Request::stop;
  if (word == Word::disarm) return Request::disarm;
  return word == Word::arm ? Request::arm : Request::release;
}

// Outcome of a word:
//   served: the cycle acted on it
//   no_effect: the cycle took it, but it has no meaning in the robot's present state
//   overruled: a more urgent word came before it was served
//   refused: too many words are waiting
enum class RequestOutcome : std::uint8_t { served, no_effect, overruled, refused };
template <>
struct EnumNames<RequestOutcome> {
  static constexpr std::array<std::string_view, 4> value{"served", "no_effect", "overruled", "refused"};
};

// A word of the operator and its outcome; topic /request of the log. It is only a record: the cycle's input
// is SensorFrame::request.
struct RequestRecord {
  std::int64_t time_ns = 0;      // time of the cycle that served, overruled or refused it, CLOCK_MONOTONIC
  std::int64_t received_ns = 0;  // time at which the line was read, CLOCK_MONOTONIC
  std::uint32_t number = 0;      // number of the word since start, from 1
  std::uint32_t count = 1;       // number of words that this record covers; more than 1 only if refused
  Word word = Word::stop;
  RequestOutcome outcome = RequestOutcome::served;
  Word overruled_by = Word::stop;  // only if overruled
  State state = State::idle;       // of the robot after that cycle

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("time_ns", self.time_ns);
    visit("received_ns", self.received_ns);
    visit("number", self.number);
    visit("count", self.count);
    visit("word", self.word);
    visit("outcome", self.outcome);
    visit("overruled_by", self.overruled_by);
    visit("state", self.state);
  }
};

// Queue of the operator's words to the cycle. Every posted word is answered once.
//
//   quit, stop and unknown words are served in the next cycle, all together. They overrule every arm and
//   release that is not yet served or was posted with them, before or after.
//   disarm comes next, one per cycle. It overrules arm and release that were posted before it.
//   arm and release follow in their order, one per cycle; after a quit they are overruled.
//
// Two bounded rings lead to the cycle, one of them for urgent words only, so that other words cannot block a
// stop. The cycle's side locks, waits and allocates nothing. Posters exclude each other by a mutex that the
// cycle never takes.
class RequestBox {
 public:
  static constexpr std::size_t kMost = 256;  // most words of each kind that wait

  // Posts the words of one read in their order. received_ns is 0 if the poster cannot read the cycle's clock;
  // the record then gets the cycle's time.
  void post(std::span<const Word> words, std::int64_t received_ns);

  struct Taken {
    Request request = Request::none;     // for this cycle
    std::span<RequestRecord> answers{};  // valid until the next take(); the caller sets `state`
  };
  // Called by the cycle once per turn. The first call after `quit` was set gives a stop. A quit that was set
  // before the words were posted is seen together with them.
  Taken take(std::int64_t now_ns, const std::atomic<Quit>& quit) noexcept;

 private:
  struct Posted {
    std::int64_t received_ns = 0;
    std::uint32_t number = 0;
    std::uint32_t batch = 0;  // equal for the words of one read
    Word word = Word::stop;
  };

  void push(const Posted& posted) noexcept;
  void collect() noexcept;
  void take_urgent(std::int64_t now_ns, Taken& taken) noexcept;
  void take_ordinary(std::int64_t now_ns, Taken& taken) noexcept;
  void answer_refused(std::int64_t now_ns) noexcept;
  void answer(const Posted& posted, std::int64_t now_ns, RequestOutcome outcome,
              Word overruled_by = Word::stop) noexcept;
  std::optional<Word> overruler_of(const Posted& posted) const noexcept;
  void drop_overruled(std::int64_t now_ns) noexcept;

  // State of the posting side.
  std::mutex posters_;
  std::uint32_t posted_ = 0;
  std::uint32_t batches_ = 0;

  SpscRing<Posted> urgent_{kMost};
  SpscRing<Posted> ordinary_{kMost};
  std::atomic<std::uint32_t> refused_{0};
  std::atomic<Word> last_refused_{Word::arm};

  // State of the cycle's side.
  std::array<Posted, kMost> waiting_{};
  std::size_t waiting_count_ = 0;
  std::array<RequestRecord, 2 * kMost + 1> answers_{};
  std::size_t answer_count_ = 0;
  bool quitting_ = false;
  bool stopping_ = false;            // a stop was served in this cycle
  Word stopped_by_ = Word::stop;     // the most urgent word of the newest stop
  std::uint32_t stopped_batch_ = 0;  // up to this batch arm and release are overruled
  std::uint32_t disarm_number_ = 0;  // number of the newest disarm that was served
};

}  // namespace sandhopper
