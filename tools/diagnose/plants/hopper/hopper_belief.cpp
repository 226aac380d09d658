#include "tools/diagnose/plants/hopper/hopper_belief.hpp"

#include <algorithm>
#include <type_traits>

#include "tools/diagnose/plants/inputs.hpp"

namespace sandhopper::diagnose {
namespace {

template <class Table>
void fill(Table& table, const std::string& prefix, const Belief& belief, const Edits& edits) {
  Table::fields(table, [&]<class Member>(std::string_view key, Member& member, Range range = {}) {
    const std::string name = prefix + std::string(key);
    if constexpr (HasFields<Member>) {
      fill(member, name + ".", belief, edits);
    } else if constexpr (std::is_same_v<Member, double>) {
      const double believed = belief.value(name, member);
      const double edited = edits.edited(name, believed);
      // An edited number is clamped to its range; a believed one is used as it is.
      member = edited == believed ? believed : std::clamp(edited, range.low, range.high);
    } else if constexpr (std::is_same_v<Member, int>) {
      member = static_cast<int>(belief.value(name, member));
    } else if constexpr (std::is_same_v<Member, bool>) {
      member = belief.value(name, member ? 1.0 : 0.0) != 0.0;
    }
  });
}

}  // namespace

WorldConfig world_of(const Belief& belief, const Edits& edits) {
  WorldConfig world;
  fill(world, "", belief, edits);
  return world;
}

bool imu_rate_is_stated(const Belief& belief) {
  const double rate_Hz = belief.value("sensors.imu_rate_Hz");
  return rate_Hz > 0.0 && rate_Hz < kAsGoodAsNone_Hz;
}

Belief with_payload(Belief belief, const Trial& trial) {
  const double payload_kg = trial.setup_or("payload_kg", 0.0);
  if (payload_kg != 0.0)
    belief.numbers["robot.body_mass_kg"] =
        belief.value("robot.body_mass_kg", LegParameters{}.body_mass_kg) + payload_kg;
  return belief;
}

}  // namespace sandhopper::diagnose
