#include "tools/benchmark/baselines.hpp"

#include <cstdint>

namespace sandhopper::benchmark {

Diagnosis null_only() {
  Diagnosis d;
  d.verdict = "consistent";
  return d;
}

Diagnosis random_pick(const Truth& truth, const std::vector<std::string>& ids) {
  Diagnosis d;
  d.verdict = "missing_physics";
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : truth.name + truth.plant)
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  if (ids.empty()) return d;
  Claim claim;
  claim.id = ids[(hash >> 20) % ids.size()];
  claim.probability = 1.0 / static_cast<double>(ids.size());
  d.claims.push_back(claim);
  return d;
}

std::optional<Diagnosis> plainer(const std::optional<Diagnosis>& diagnosis, const std::string& method) {
  if (!diagnosis) return std::nullopt;
  const auto found = diagnosis->baselines.find(method);
  if (found == diagnosis->baselines.end() || found->second.empty()) return std::nullopt;
  Diagnosis d;
  d.verdict = "missing_physics";
  Claim claim;
  claim.id = found->second;
  claim.probability = 1.0;
  d.claims.push_back(claim);
  return d;
}

}  // namespace sandhopper::benchmark
