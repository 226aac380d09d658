#include "tools/diagnose/model/plant.hpp"

#include <stdexcept>

#include "tools/diagnose/plants/falling_body/falling_body.hpp"
#include "tools/diagnose/plants/hopper/hopper.hpp"
#include "tools/diagnose/plants/intruder/intruder.hpp"
#include "tools/diagnose/plants/rotary_axis/rotary_axis.hpp"

namespace sandhopper::diagnose {

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
