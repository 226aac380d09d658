#include "tools/campaign/full_counters.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

namespace sandhopper {
namespace {

using testing::HasSubstr;

// An encoder that turns on, counted by a register.
std::vector<double> encoder(double width, double end, double begin = 0.0) {
  std::vector<double> counts;
  for (int i = 0; i < 400; ++i) {
    const double true_count = std::floor(begin + (end - begin) * i / 400.0 + 50.0 * std::sin(0.3 * i));
    counts.push_back(true_count - width * std::floor(true_count / width));
  }
  return counts;
}

TEST(FullCounters, AnEncoderThatIsFullOnceIsPutBack) {
  for (const int bits : {14, 16, 24, 32}) {
    const double width = std::ldexp(1.0, bits);
    auto counts = encoder(width, 1.3 * width, 0.9 * width);
    EXPECT_THAT(put_register_back(counts), HasSubstr("2^" + std::to_string(bits)));
    double largest = 0.0;
    for (std::size_t i = 1; i < counts.size(); ++i)
      largest = std::max(largest, std::abs(counts[i] - counts[i - 1]));
    EXPECT_LT(largest, 0.01 * width) << bits;
  }
}

TEST(FullCounters, NegativeNumbersWithoutTheirSignGetIt) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 200.0);
  for (const int bits : {16, 24, 32})
    for (const double first : {40.0, -38.0}) {
      const double width = std::ldexp(1.0, bits);
      std::vector<double> true_counts{first}, counts;
      for (int i = 1; i < 300; ++i)
        true_counts.push_back(std::floor(noise(random) + (i > 100 ? 2.0 * (i - 100) : 0.0)));
      for (const double count : true_counts) counts.push_back(count < 0.0 ? count + width : count);
      const auto told = put_register_back(counts);
      EXPECT_FALSE(told.empty()) << bits;
      EXPECT_EQ(counts, true_counts) << bits << " " << first;
    }
}

TEST(FullCounters, OtherNumbersStay) {
  std::vector<double> swing, code, reset, decimals = encoder(65536.0, 80000.0, 60000.0), square;
  for (int i = 0; i < 400; ++i) {
    swing.push_back(std::floor(32768.0 + 32000.0 * std::sin(0.02 * i)));
    code.push_back(i % 50 == 49 ? 65535.0 : std::floor(100.0 + 3.0 * std::sin(0.1 * i)));
    reset.push_back(i < 200 ? 40000.0 + 100.0 * i : 100.0 * i - 20000.0);  // set to zero by hand
    square.push_back((i / 40) % 2 == 0 ? 3.0 : 60000.0);
  }
  decimals[7] += 0.5;
  for (auto* values : {&swing, &code, &reset, &decimals, &square}) {
    const auto before = *values;
    EXPECT_EQ(put_register_back(*values), "");
    EXPECT_EQ(*values, before);
  }
}

}  // namespace
}  // namespace sandhopper
