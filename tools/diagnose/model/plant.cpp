#include "tools/diagnose/model/plant.hpp"

#include <stdexcept>

#include "tools/diagnose/plants/falling_body/falling_body.hpp"
#include "tools/diagnose/plants/hopper/hopper.hpp"
#include "tools/diagnose/plants/intruder/intruder.hpp"
#include "tools/diagnose/plants/rotary_axis/rotary_axis.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kDerivativeStep = 0.1;  // of a standard deviation; the derivative hardly depends on it

}  // namespace

void TrialModel::add_key_spreads(const Belief& belief) {
  first_key_spread_ = trial_nuisances.size();
  for (const auto& spread : belief.key_spreads) {
    const bool has_an_effect = spread.sd > 0.0 && (!spread.is_relative || belief.value(spread.key) != 0.0);
    if (!has_an_effect) continue;
    key_spreads_.push_back(spread);
    trial_nuisances.push_back({spread.name, spread.sd, kDerivativeStep * spread.sd});
  }
}

std::optional<TrialModel::Alike> TrialModel::like(const std::string& label) const {
  for (std::size_t i = 0; i < trial_nuisances.size(); ++i)
    if (const auto found = trial_nuisances[i].like.find(label); found != trial_nuisances[i].like.end())
      return Alike{i, found->second};
  return std::nullopt;
}

Edits TrialModel::with_key_spreads(Edits edits, std::span<const double> nuisances) const {
  for (std::size_t i = 0; i < key_spreads_.size(); ++i) {
    const double moved = nuisances[first_key_spread_ + i];
    if (key_spreads_[i].is_relative)
      edits.scale(key_spreads_[i].key, 1.0 + moved);
    else
      edits.add(key_spreads_[i].key, moved);
  }
  return edits;
}

std::unique_ptr<PlantModel> make_plant(PlantKind kind) {
  switch (kind) {
    case PlantKind::falling_body:
      return make_falling_body();
    case PlantKind::rotary_axis:
      return make_rotary_axis();
    case PlantKind::intruder:
      return make_intruder();
    case PlantKind::hopper:
      return make_hopper();
  }
  throw std::invalid_argument("diagnose: this plant cannot be simulated");
}

double conversion_s(const Belief& belief, const std::string& channel) {
  const double rate_Hz = belief.value("sensors.load_cell_rate_Hz");
  const bool load_cell = channel == "force_N" || channel == "load_cell_force_N";
  return load_cell && rate_Hz > 0.0 ? 1.0 / rate_Hz : 0.0;
}

}  // namespace sandhopper::diagnose
