#pragma once
#include <cmath>
#include <cstdint>
#include <random>

namespace sandhopper {

// One independent random stream per (seed, stream): switching a sensor off or sampling it more often does not
// change the others. The engine's output is fixed by the C++ standard. The normal distribution is implemented
// here (Marsaglia's polar method), because those of the standard library differ between implementations.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream) : engine_(mixed(mixed(seed) + stream)) {}

  // Uniform in [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

  double normal() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    double x = 0.0, y = 0.0, r2 = 0.0;
    do {
      x = 2.0 * uniform() - 1.0;
      y = 2.0 * uniform() - 1.0;
      r2 = x * x + y * y;
    } while (r2 >= 1.0 || r2 == 0.0);
    const double scale = std::sqrt(-2.0 * std::log(r2) / r2);
    spare_ = scale * y;
    has_spare_ = true;
    return scale * x;
  }

 private:
  // SplitMix64's finaliser: neighbouring seeds and streams give uncorrelated engines.
  static constexpr std::uint64_t mixed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
  }

  std::mt19937_64 engine_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace sandhopper
