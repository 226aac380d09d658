#pragma once
#include <memory>
#include <string>
#include <vector>

#include "tools/conceal/core/keys.hpp"
#include "tools/conceal/core/random.hpp"
#include "tools/conceal/core/table.hpp"

namespace sandhopper::conceal {

struct EffectInfo {
  std::string id;     // as in diagnosis.json; outside that list any word
  std::string port;   // where an effect outside the list acts; empty for those on it
  std::string group;  // effects of one group are not hidden together
};

// Explanations that the set-ups of such a campaign cannot tell apart; the first of them is the truth.
struct Ambiguity {
  std::vector<std::string> ids;
};

// The apparatus of one campaign: a world, what is believed of it, and how it is recorded.
class Bench {
 public:
  virtual ~Bench() = default;
  virtual Belief belief() const = 0;
  virtual std::vector<Setup> draw_setups(int trials, Random random) const = 0;
  virtual Table record(const Setup& setup, Random random) const = 0;
  // Adds physics that the belief does not have; `size` is relative to typical. Returns its parameters.
  virtual Json hide(const std::string& id, double size, Random random) = 0;
  // Limits the apparatus (channels, range of set-ups) so that the ambiguity's members stay together.
  virtual void restrict_to(std::size_t ambiguity) = 0;
};

class Plant {
 public:
  virtual ~Plant() = default;
  virtual std::string name() const = 0;
  virtual std::vector<EffectInfo> listed() const = 0;
  virtual std::vector<EffectInfo> unlisted() const = 0;
  virtual std::vector<Ambiguity> ambiguities() const = 0;
  virtual std::vector<std::string> expendable() const = 0;
  virtual std::unique_ptr<Bench> build(Random random) const = 0;
};

const std::vector<const Plant*>& plants();
const Plant* find_plant(const std::string& name);

}  // namespace sandhopper::conceal
