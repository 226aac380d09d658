#pragma once
#include <algorithm>
#include <cmath>

namespace sandhopper::diagnose {

inline constexpr double kBalanced_N = 1e-6;  // accuracy of the force's balance

// Solves F = f(F) for a decreasing f, between 0 and f(0), by regula falsi (Illinois). The last call of `f` is
// at the solution.
template <class Force>
double bracketed_N(const Force& f) {
  constexpr int kMost = 30;
  // `above`, `below`: f(F) - F at both ends.
  double low = 0.0, above = f(0.0), high = above, below = f(high) - high;
  double force_N = high;
  int side = 0;
  for (int i = 0; i < kMost && high - low > kBalanced_N; ++i) {
    force_N = above > below ? (low * below - high * above) / (below - above) : 0.5 * (low + high);
    const double off = f(force_N) - force_N;
    if (std::abs(off) < kBalanced_N) break;
    if (off > 0.0) {
      low = force_N, above = off;
      if (side > 0) below *= 0.5;
      side = 1;
    } else {
      high = force_N, below = off;
      if (side < 0) above *= 0.5;
      side = -1;
    }
  }
  return force_N;
}

// Solves F = f(F) by secants from `guess_N`, the force of the previous step. `slope` is df/dF there; it is
// updated. If the secants fail, bracketed_N() solves it. The last call of `f` is at the solution.
template <class Force>
double balanced_N(const Force& f, double guess_N, double& slope) {
  constexpr int kSecants = 5;
  double force_N = guess_N, off = f(force_N) - force_N;
  for (int i = 0; i < kSecants && std::abs(off) >= kBalanced_N; ++i) {
    const double next_N = std::max(0.0, force_N + off / (1.0 - slope));
    const double next_off = f(next_N) - next_N;
    const double steeper = 1.0 + (next_off - off) / (next_N - force_N);
    if (!(steeper <= 0.0)) break;
    slope = steeper;
    force_N = next_N;
    off = next_off;
  }
  return std::abs(off) < kBalanced_N ? force_N : bracketed_N(f);
}

}  // namespace sandhopper::diagnose
