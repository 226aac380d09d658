#pragma once
#include <cstdint>
#include <string_view>

namespace sandhopper::conceal {

// Random numbers that are equal on every machine (the distributions of std are not): SplitMix64, Box-Muller.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  // An independent generator for one purpose. Draws for one purpose never change those for another.
  Random stream(std::string_view purpose, std::uint64_t index = 0) const;

  std::uint64_t bits();
  double uniform(double low = 0.0, double high = 1.0);  // [low, high)
  double log_uniform(double low, double high);          // low > 0
  double normal(double mean = 0.0, double sigma = 1.0);
  int below(int count);  // 0 … count-1
  bool chance(double probability) { return uniform() < probability; }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }

 private:
  std::uint64_t state_;
};

// Random numbers of one trial: sensor noise, and everything else (bed, release, offsets of the sensors). With
// other noise the same trial is repeated: only the noise of its sensors differs.
class TrialRandom {
 public:
  TrialRandom(const Random& trial) : TrialRandom(trial, trial) {}  // NOLINT: a trial with its own noise
  TrialRandom(const Random& trial, const Random& noise) : trial_(trial), noise_(noise) {}

  Random stream(std::string_view purpose) const { return trial_.stream(purpose); }
  Random noise(std::string_view purpose) const { return noise_.stream(purpose); }

 private:
  Random trial_, noise_;
};

}  // namespace sandhopper::conceal
