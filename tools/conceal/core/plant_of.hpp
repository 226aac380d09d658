#pragma once
#include <functional>
#include <stdexcept>

#include "tools/conceal/core/plant.hpp"

namespace sandhopper::conceal {

// One effect of a plant, as a change of its world.
template <class World>
struct Recipe {
  EffectInfo info;
  std::function<Json(World&, double size, Random&)> apply;
};

// A change of the world (set-ups, channels) that makes the members of an ambiguity indistinguishable.
template <class World>
struct Restriction {
  Ambiguity ambiguity;
  std::function<void(World&)> apply;
};

// Functions and recipes from which PlantOf makes a plant.
template <class World>
struct PlantSpec {
  std::string name;
  World (*draw)(Random&);
  Belief (*belief)(const World&);
  std::vector<Setup> (*draw_setups)(const World&, int trials, Random&);
  Table (*record)(const World&, const Setup&, const TrialRandom&);
  std::vector<std::string> (*phases)(const World&, const Setup&, const TrialRandom&, const Table&);
  std::vector<Recipe<World>> listed;
  std::vector<Recipe<World>> unlisted;
  std::vector<Restriction<World>> restrictions;
  std::vector<std::string> expendable;  // Channels that may be recorded dead.
  std::vector<std::string> inputs;      // Channels that a simulation takes from the recording.
};

// A plant made from the functions of its folder.
template <class World>
class PlantOf final : public Plant {
 public:
  explicit PlantOf(PlantSpec<World> spec) : spec_(std::move(spec)) {}

  std::string name() const override { return spec_.name; }
  std::vector<EffectInfo> listed() const override { return infos(spec_.listed); }
  std::vector<EffectInfo> unlisted() const override { return infos(spec_.unlisted); }
  std::vector<Ambiguity> ambiguities() const override {
    std::vector<Ambiguity> all;
    for (const auto& restriction : spec_.restrictions) all.push_back(restriction.ambiguity);
    return all;
  }
  std::vector<std::string> expendable() const override { return spec_.expendable; }
  std::vector<std::string> inputs() const override { return spec_.inputs; }
  std::unique_ptr<Bench> build(Random random) const override {
    return std::make_unique<BenchOf>(spec_, spec_.draw(random));
  }

 private:
  static std::vector<EffectInfo> infos(const std::vector<Recipe<World>>& recipes) {
    std::vector<EffectInfo> all;
    for (const auto& recipe : recipes) all.push_back(recipe.info);
    return all;
  }

  class BenchOf final : public Bench {
   public:
    BenchOf(const PlantSpec<World>& spec, World world)
        : spec_(spec), world_(std::move(world)), believed_(world_) {}
    Belief belief() const override { return spec_.belief(believed_); }
    std::vector<Setup> draw_setups(int trials, Random random) const override {
      return spec_.draw_setups(believed_, trials, random);
    }
    Table record(const Setup& setup, const TrialRandom& trial) const override {
      return spec_.record(world_, setup, trial);
    }
    std::vector<std::string> phases(const Setup& setup, const TrialRandom& trial,
                                    const Table& recorded) const override {
      return spec_.phases(world_, setup, trial, recorded);
    }
    Json hide(const std::string& id, double size, Random random) override {
      for (const auto* recipes : {&spec_.listed, &spec_.unlisted})
        for (const auto& recipe : *recipes)
          if (recipe.info.id == id) return recipe.apply(world_, size, random);
      throw std::invalid_argument(spec_.name + " has no effect " + id);
    }
    void restrict_to(std::size_t ambiguity) override {
      spec_.restrictions.at(ambiguity).apply(world_);
      spec_.restrictions.at(ambiguity).apply(believed_);
    }

   private:
    const PlantSpec<World>& spec_;
    World world_;
    World believed_;
  };

  PlantSpec<World> spec_;
};

}  // namespace sandhopper::conceal
