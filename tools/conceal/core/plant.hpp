#pragma once
#include <memory>
#include <string>
#include <vector>

#include "tools/conceal/core/keys.hpp"
#include "tools/conceal/core/random.hpp"
#include "tools/conceal/core/table.hpp"

namespace sandhopper::conceal {

// Name and group of an effect.
struct EffectInfo {
  std::string id;     // As in diagnosis.json; for unlisted effects any word.
  std::string port;   // For unlisted effects the port at which it acts, else empty.
  std::string group;  // Effects of the same group are not hidden together.
};

// Effects that the set-ups of such a campaign cannot distinguish. The first one is the hidden one.
struct Ambiguity {
  std::vector<std::string> ids;
};

// The apparatus of one campaign: true and believed parameters, and the recording.
class Bench {
 public:
  virtual ~Bench() = default;
  virtual Belief belief() const = 0;
  virtual std::vector<Setup> draw_setups(int trials, Random random) const = 0;
  virtual Table record(const Setup& setup, const TrialRandom& trial) const = 0;
  // Phase of the motion in each row of that recording, in the words of diagnosis.json (`where`).
  virtual std::vector<std::string> phases(const Setup& setup, const TrialRandom& trial,
                                          const Table& recorded) const = 0;
  // Hides an effect that the belief does not contain. `size` is relative to typical. Returns its parameters.
  virtual Json hide(const std::string& id, double size, Random random) = 0;
  // Limits channels or set-ups so that the members of the ambiguity cannot be distinguished.
  virtual void restrict_to(std::size_t ambiguity) = 0;
};

// A kind of apparatus and the effects that it can hide. Each `build` draws one apparatus.
class Plant {
 public:
  virtual ~Plant() = default;
  virtual std::string name() const = 0;
  virtual std::vector<EffectInfo> listed() const = 0;
  virtual std::vector<EffectInfo> unlisted() const = 0;
  virtual std::vector<Ambiguity> ambiguities() const = 0;
  // Channels that may be recorded dead.
  virtual std::vector<std::string> expendable() const = 0;
  // Channels that a simulation of this plant takes from the recording. It cannot predict them.
  virtual std::vector<std::string> inputs() const = 0;
  virtual std::unique_ptr<Bench> build(Random random) const = 0;
};

const std::vector<const Plant*>& plants();
// Null if there is no plant of this name.
const Plant* find_plant(const std::string& name);

}  // namespace sandhopper::conceal
