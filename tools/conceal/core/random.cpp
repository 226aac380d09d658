#include "tools/conceal/core/random.hpp"

#include <cmath>
#include <numbers>

namespace sandhopper::conceal {

Random Random::stream(std::string_view purpose, std::uint64_t index) const {
  std::uint64_t hash = 0xcbf29ce484222325ULL;  // FNV-1a
  for (const char c : purpose) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  Random child(state_ ^ hash ^ (index * 0x9e3779b97f4a7c15ULL));
  child.bits();
  return child;
}

std::uint64_t Random::bits() {
  state_ += 0x9e3779b97f4a7c15ULL;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

double Random::uniform(double low, double high) {
  return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1.0p-53;
}

double Random::log_uniform(double low, double high) {
  return std::exp(uniform(std::log(low), std::log(high)));
}

double Random::normal(double mean, double sigma) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return mean + sigma * radius * std::cos(2.0 * std::numbers::pi * uniform());
}

int Random::below(int count) { return static_cast<int>(uniform(0.0, count)); }

}  // namespace sandhopper::conceal
