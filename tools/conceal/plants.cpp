#include "tools/conceal/plants.hpp"

namespace sandhopper::conceal {

const std::vector<const Plant*>& plants() {
  static const std::vector<const Plant*> all{&falling_body_plant(), &hopper_plant(), &intruder_plant(),
                                             &rotary_axis_plant()};
  return all;
}

const Plant* find_plant(const std::string& name) {
  for (const auto* plant : plants())
    if (plant->name() == name) return plant;
  return nullptr;
}

}  // namespace sandhopper::conceal
