#pragma once
#include <string>

#include "tools/diagnose/answer/diagnosis.hpp"
#include "tools/diagnose/fit/prepare.hpp"

namespace sandhopper::diagnose {

// Text of a nominal.toml that contains the findings, so that a second run can start from it. A finding
// becomes a change of keys if keys can express it and no trial's set-up overrides them; otherwise an entry
// under [effects] (tools/campaign/README.md). It is the author's own text with the
// changed and added keys and nothing that nobody stated; without that text (Recordings::model_text) it states
// every number. Findings outside the list of effects become comments. Returns an empty string if comments are
// all there is.
std::string corrected_model(const Recordings& recordings, const Problem& problem, const Diagnosis& diagnosis);

}  // namespace sandhopper::diagnose
