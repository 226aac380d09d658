#include "tools/campaign/mass_below_cell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/campaign/hopper_signals.hpp"

namespace sandhopper {

std::string mass_below_cell_effect(std::string_view channel) {
  return fmt::format("load_cell.inertia[{}]", channel);
}

double mass_below_cell_kg(const Belief& belief, std::string_view channel) {
  const auto& effects =
      std::visit([](const auto& plant) -> const BeliefEffects& { return plant.effects; }, belief);
  const auto effect = effects.find(mass_below_cell_effect(channel));
  if (effect == effects.end()) return 0.0;
  const auto mass = effect->second.find("mass_kg");
  return mass == effect->second.end() ? 0.0 : mass->second;
}

void add_mass_below_cell(TrialRecording& recording, const Belief& belief) {
  const auto* hopper = std::get_if<HopperBelief>(&belief);
  const double mass_kg = hopper == nullptr ? 0.0 : mass_below_cell_kg(belief, kLoadCell);
  const auto cell = std::ranges::find(recording.channels, kLoadCell, &TrialRecording::Channel::name);
  const auto* accel = recording.find(kFootAccel);
  if (mass_kg == 0.0 || cell == recording.channels.end() || accel == nullptr) return;
  std::size_t before = 0;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    if (!std::isnan((*accel)[row])) before = row;
    std::size_t after = row;
    while (after < accel->size() && std::isnan((*accel)[after])) ++after;
    if (after == accel->size() || std::isnan((*accel)[before])) continue;
    const double share = after == before ? 0.0
                                         : (recording.t_s[row] - recording.t_s[before]) /
                                               (recording.t_s[after] - recording.t_s[before]);
    cell->values[row] +=
        mass_kg * (std::lerp((*accel)[before], (*accel)[after], share) - hopper->gravity_mps2);
  }
}

}  // namespace sandhopper
