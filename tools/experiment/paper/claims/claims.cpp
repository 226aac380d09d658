#include "tools/experiment/paper/claims/claims.hpp"

#include <cmath>

namespace sandhopper::paper {

std::vector<Claim> claim_table(const ProgrammeResults& results) {
  std::vector<Claim> table;
  for (const auto& group : {instrument_claims, mechanics_claims, filter_claims, programme_claims,
                            stride_claims, terrain_claims, stiffness_claims})
    for (auto& claim : group(results)) table.push_back(std::move(claim));
  return table;
}

}  // namespace sandhopper::paper
