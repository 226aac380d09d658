#pragma once
#include <vector>

#include "tools/diagnose/engine.hpp"

namespace sandhopper::diagnose {

// diagnose(), which takes the numbers of the belief as exact, and once more if what that names may be the
// rounding of a number: then the numbers in `rounding` whose rounding would show are known to their
// rounding only, as [known_to] says it. The second answer counts if it needs fewer effects and no number is
// off by more than half a digit; a note names the numbers. Hoppers are not diagnosed twice, because they take
// minutes.
Diagnosis diagnose_as_written(const Recordings& recordings, const EngineOptions& options,
                              const std::vector<KeySpread>& rounding);

}  // namespace sandhopper::diagnose
