#pragma once
#include <vector>

#include "tools/experiment/paper/claims/claim.hpp"
#include "tools/experiment/paper/summaries.hpp"

namespace sandhopper::paper {

// All 36 claims in order. Every value is computed from `results` or from checks that need no bed.
std::vector<Claim> claim_table(const ProgrammeResults& results);

// Groups of claims, each in its own file.
std::vector<Claim> instrument_claims(const ProgrammeResults& results);  // 1, 2
std::vector<Claim> mechanics_claims(const ProgrammeResults& results);   // 3 to 8
std::vector<Claim> filter_claims(const ProgrammeResults& results);      // 9 to 12
std::vector<Claim> programme_claims(const ProgrammeResults& results);   // 13 to 16
std::vector<Claim> stride_claims(const ProgrammeResults& results);      // 17 to 25
std::vector<Claim> terrain_claims(const ProgrammeResults& results);     // 26 to 30
std::vector<Claim> stiffness_claims(const ProgrammeResults& results);   // 31 to 36

}  // namespace sandhopper::paper
