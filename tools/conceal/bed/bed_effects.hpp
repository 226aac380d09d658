#pragma once
#include "tools/conceal/bed/bed.hpp"
#include "tools/conceal/core/plant_of.hpp"

namespace sandhopper::conceal {

// Recipes that hide an effect of the bed.
Recipe<Bed> bed_added_mass();
std::vector<Recipe<Bed>> bed_speed_effects();
std::vector<Recipe<Bed>> bed_depth_effects();
std::vector<Recipe<Bed>> bed_history_effects();
std::vector<Recipe<Bed>> bed_unlisted_effects();

// The bed's recipes for a world with a member `bed`.
template <class World>
std::vector<Recipe<World>> for_bed_of(const std::vector<Recipe<Bed>>& recipes) {
  std::vector<Recipe<World>> all;
  for (const auto& recipe : recipes)
    all.push_back({recipe.info, [recipe](World& w, double size, Random& random) {
                     return recipe.apply(w.bed, size, random);
                   }});
  return all;
}

}  // namespace sandhopper::conceal
