#pragma once
#include <algorithm>
#include <bitset>
#include <cstddef>

namespace sandhopper {

// Increases by one on a bad sample and decreases by `leak` on a good one. Single outliers pass; a share of
// bad samples above leak / (1 + leak) does not.
class LeakyCount {
 public:
  explicit constexpr LeakyCount(double leak) noexcept : leak_(leak) {}
  double see(bool bad) noexcept {
    value_ = bad ? value_ + 1.0 : std::max(0.0, value_ - leak_);
    return value_;
  }
  void reset() noexcept { value_ = 0.0; }
  double value() const noexcept { return value_; }

 private:
  double leak_;
  double value_ = 0.0;
};

// Share of the last N cycles in which the condition held. Cycles before the first count as if it held.
template <std::size_t N>
class RecentShare {
 public:
  RecentShare() noexcept { reset(); }
  void see(bool had) noexcept {
    recent_[next_] = had;
    next_ = (next_ + 1) % N;
  }
  void reset() noexcept { recent_.set(); }
  double share() const noexcept { return static_cast<double>(recent_.count()) / N; }

 private:
  std::bitset<N> recent_;
  std::size_t next_ = 0;
};

}  // namespace sandhopper
