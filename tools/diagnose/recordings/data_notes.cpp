#include <algorithm>
#include <cmath>
#include <iterator>

#include "tools/diagnose/discrepancy/misfit.hpp"
#include "tools/diagnose/recordings/data_faults.hpp"

// Faults that become notes of the answer and do not change the verdict.
namespace sandhopper::diagnose {
namespace {

template <class Predicate>
std::vector<DataFault> taken(std::vector<DataFault>& faults, Predicate wanted) {
  std::vector<DataFault> out;
  std::ranges::copy_if(faults, std::back_inserter(out), wanted);
  std::erase_if(faults, wanted);
  return out;
}

}  // namespace

std::vector<DataFault> take_known_limits(std::vector<DataFault>& faults, const Belief& belief) {
  const double range = belief.value("sensors.imu_range_mps2");
  return taken(faults, [&](const DataFault& fault) {
    return fault.id == "imu.clipping" && range > 0.0 &&
           std::abs(std::abs(fault.limit) - range) <= std::max(fault.limit_resolution, 1e-3 * range);
  });
}

std::vector<DataFault> take_spikes(std::vector<DataFault>& faults) {
  return taken(faults, [](const DataFault& fault) { return fault.id == "data.spike"; });
}

std::vector<DataFault> take_single_events(std::vector<DataFault>& faults, std::size_t trials) {
  return taken(faults, [&](const DataFault& fault) {
    return trials >= kTooFewTrials && fault.stretches == 1 && fault.limit == 0.0;
  });
}

}  // namespace sandhopper::diagnose
