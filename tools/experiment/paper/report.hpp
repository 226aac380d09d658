#pragma once
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "tools/experiment/paper/claims/claim.hpp"
#include "tools/experiment/paper/programme.hpp"
#include "tools/report/study.hpp"

namespace sandhopper::paper {

// Page of the programme: claims, then one section for each part of the programme with the paper's panels.
Study programme_report(const ProgrammeResults& results, const std::vector<Claim>& claims);

// The numbers of the page: claims, stiffness by definition, map, decomposition, estimation errors,
// treatments, conditions.
nlohmann::ordered_json programme_json(const ProgrammeResults& results, const std::vector<Claim>& claims);

// Sections of the page, each in its own file.
StudySection claims_section(const std::vector<Claim>& claims);
StudySection stride_section(const ProgrammeResults& results);
StudySection actuator_section(const ProgrammeResults& results);
StudySection decomposition_section(const ProgrammeResults& results);
StudySection estimation_section(const ProgrammeResults& results);
StudySection stiffness_section(const ProgrammeResults& results);

}  // namespace sandhopper::paper
