#include "firmware/request_box.hpp"

#include <algorithm>

namespace sandhopper {

// Urgent words first, then disarm: a cycle that sees a release of this read has then also seen its stop.
void RequestBox::post(std::span<const Word> words, std::int64_t received_ns) {
  const std::lock_guard lock(posters_);
  ++batches_;
  for (int pass = 0; pass < 3; ++pass)
    for (std::size_t i = 0; i < words.size(); ++i) {
      const int turn = means_stop(words[i]) ? 0 : words[i] == Word::disarm ? 1 : 2;
      if (turn == pass)
        push({.received_ns = received_ns,
              .number = posted_ + static_cast<std::uint32_t>(i) + 1,
              .batch = batches_,
              .word = words[i]});
    }
  posted_ += static_cast<std::uint32_t>(words.size());
}

void RequestBox::push(const Posted& posted) noexcept {
  auto& ring = means_stop(posted.word) ? urgent_ : ordinary_;
  if (ring.push(posted)) return;
  last_refused_.store(posted.word, std::memory_order_relaxed);
  refused_.fetch_add(1, std::memory_order_release);
}

RequestBox::Taken RequestBox::take(std::int64_t now_ns, const std::atomic<Quit>& quit) noexcept {
  Taken taken;
  answer_count_ = 0;
  stopping_ = false;
  collect();
  if (!quitting_ && quit.load(std::memory_order_acquire) != Quit::no) {
    quitting_ = stopping_ = true;
    stopped_by_ = Word::quit;
    taken.request = Request::stop;
  }
  take_urgent(now_ns, taken);
  drop_overruled(now_ns);
  if (!stopping_) take_ordinary(now_ns, taken);
  answer_refused(now_ns);
  taken.answers = {answers_.data(), answer_count_};
  return taken;
}

void RequestBox::collect() noexcept {
  for (const Posted* next = ordinary_.front(); next != nullptr && waiting_count_ < waiting_.size();
       next = ordinary_.front()) {
    waiting_[waiting_count_++] = *next;
    ordinary_.pop();
  }
}

void RequestBox::take_urgent(std::int64_t now_ns, Taken& taken) noexcept {
  for (std::size_t i = 0; i < kMost; ++i) {
    const Posted* next = urgent_.front();
    if (next == nullptr) return;
    quitting_ = quitting_ || means_quit(next->word);
    stopped_by_ = stopping_ ? std::min(stopped_by_, next->word) : next->word;
    stopped_batch_ = next->batch;
    stopping_ = true;
    taken.request = Request::stop;
    answer(*next, now_ns, RequestOutcome::served);
    urgent_.pop();
  }
}

std::optional<Word> RequestBox::overruler_of(const Posted& posted) const noexcept {
  if (posted.word == Word::disarm) return std::nullopt;
  if (stopping_ || (stopped_batch_ != 0 && posted.batch <= stopped_batch_)) return stopped_by_;
  if (quitting_) return Word::quit;
  if (posted.number < disarm_number_) return Word::disarm;
  return std::nullopt;
}

void RequestBox::drop_overruled(std::int64_t now_ns) noexcept {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < waiting_count_; ++i) {
    if (const auto by = overruler_of(waiting_[i]))
      answer(waiting_[i], now_ns, RequestOutcome::overruled, *by);
    else
      waiting_[kept++] = waiting_[i];
  }
  waiting_count_ = kept;
}

void RequestBox::take_ordinary(std::int64_t now_ns, Taken& taken) noexcept {
  if (waiting_count_ == 0) return;
  const auto end = waiting_.begin() + static_cast<std::ptrdiff_t>(waiting_count_);
  const auto first = std::min_element(waiting_.begin(), end, [](const Posted& a, const Posted& b) {
    if ((a.word == Word::disarm) != (b.word == Word::disarm)) return a.word == Word::disarm;
    return a.number < b.number;
  });
  const Posted served = *first;
  std::copy(first + 1, end, first);
  --waiting_count_;
  taken.request = request_of(served.word);
  answer(served, now_ns, RequestOutcome::served);
  if (served.word != Word::disarm) return;
  disarm_number_ = std::max(disarm_number_, served.number);
  drop_overruled(now_ns);
}

void RequestBox::answer_refused(std::int64_t now_ns) noexcept {
  const auto count = refused_.exchange(0, std::memory_order_acquire);
  if (count == 0) return;
  answer({.word = last_refused_.load(std::memory_order_relaxed)}, now_ns, RequestOutcome::refused);
  answers_[answer_count_ - 1].count = count;
}

void RequestBox::answer(const Posted& posted, std::int64_t now_ns, RequestOutcome outcome,
                        Word overruled_by) noexcept {
  answers_[answer_count_++] = {.time_ns = now_ns,
                               .received_ns = posted.received_ns == 0 ? now_ns : posted.received_ns,
                               .number = posted.number,
                               .word = posted.word,
                               .outcome = outcome,
                               .overruled_by = overruled_by};
}

}  // namespace sandhopper
