#include "tools/campaign/full_counters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace sandhopper {
namespace {

// Registers of encoders (12 to 14 bits), microcontrollers (16, 32) and converters (24).
constexpr std::array kBits{12, 13, 14, 16, 24, 32};
// A counter that was set anew, or a force that yields, jumps by the width to within a step with a probability
// of the step as a share of half the width. Above this probability the jump is no overflow.
constexpr double kByChanceAtMost = 0.01;
constexpr std::size_t kFewestCounts = 20;

struct Register {
  double width = 0.0;
  std::size_t jumps = 0;
};

// True if the counts fill a register with or without sign from one end to the other, to within a step. That
// is a second coincidence beside the width of the jump.
bool fills(double width, double low, double high, double step) {
  const auto from = [&](double least) {
    return low >= least && low < least + step && high < least + width && high >= least + width - 1.0 - step;
  };
  return from(0.0) || from(-0.5 * width);
}

// The register whose width every jump has, to within a step.
Register register_of(const std::vector<double>& counts, double low, double high) {
  for (const int bits : kBits) {
    const double width = std::ldexp(1.0, bits);
    if (high - low >= width) continue;
    Register found{width};
    double usual = 1.0, left = 0.0;
    for (std::size_t i = 1; i < counts.size(); ++i) {
      const double step = std::abs(counts[i] - counts[i - 1]);
      if (step > 0.5 * width)
        ++found.jumps, left = std::max(left, width - step);
      else
        usual = std::max(usual, step);
    }
    const double step = std::max(usual, left);
    const double share = step / (0.5 * width);
    const double chance = fills(width, low, high, step) ? share * share : share;
    if (found.jumps > 0 && chance <= kByChanceAtMost) return found;
  }
  return {};
}

// One number far from all others that comes again and again is a fill value, not a counter.
bool is_one_code(const std::vector<double>& counts, const Register& found, double low) {
  std::set<double> above;
  for (const double count : counts)
    if (count - low > 0.5 * found.width) above.insert(count);
  return above.size() < 2;
}

}  // namespace

std::string put_register_back(std::vector<double>& counts) {
  std::vector<double> fresh;
  double low = INFINITY, high = -INFINITY;
  for (const double count : counts) {
    if (std::isnan(count)) continue;
    if (count != std::floor(count)) return "";
    fresh.push_back(count);
    low = std::min(low, count), high = std::max(high, count);
  }
  if (fresh.size() < kFewestCounts) return "";
  const auto found = register_of(fresh, low, high);
  if (found.jumps == 0 || is_one_code(fresh, found, low)) return "";
  // A counter without a sign that begins just below its end began at a small negative number.
  double turns = low >= 0.0 && fresh.front() > 0.75 * found.width ? -found.width : 0.0, last = NAN;
  for (double& count : counts) {
    if (std::isnan(count)) continue;
    const double step = count - last;
    last = count;
    if (std::abs(step) > 0.5 * found.width) turns -= std::copysign(found.width, step);
    count += turns;
  }
  return fmt::format(
      "jumps {} times by {:.0f} = 2^{:.0f}, as a counter does that is full, or a negative number "
      "without its sign; it is taken as going on",
      found.jumps, found.width, std::log2(found.width));
}

}  // namespace sandhopper
