#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tools/diagnose/model/context.hpp"
#include "tools/diagnose/model/edits.hpp"
#include "tools/diagnose/model/reach.hpp"
#include "tools/diagnose/model/trial.hpp"

namespace sandhopper::diagnose {

// One recorded sample that the simulation predicts.
struct Row {
  std::uint32_t channel = 0;  // index into the plant's channels
  std::uint32_t block = 0;    // index of the stretch; each starts from its own initial state
  std::uint32_t phase = 0;    // index into the plant's phases
  double time_s = 0.0;
  double measured = 0.0;
  // Standard deviation relative to that of one sample. Below 1 for a mean of several samples, above 1 if the
  // inputs of the prediction are uncertain.
  double relative_sd = 1.0;
  double numerical_sd = 0.0;  // standard deviation between two correct simulations, in the channel's unit
  bool at_limit = false;      // the recorder cannot show more: the row says nothing of the noise
};

// Nuisance parameter: a quantity that differs from trial to trial. It is fitted in each trial, with a normal
// prior of mean 0 and standard deviation `sd`.
struct Nuisance {
  std::string name;
  double sd = 1.0;
  double step = 0.01;  // step of the numerical derivative, in the nuisance's unit
  std::string port{};  // named in the answer if the nuisance is shifted alike in all trials; empty: no port
  // True if a common shift in all trials is evidence of missing physics. False for timing conventions of the
  // recording, and if the belief states no spread.
  bool shift_is_evidence = true;
  // Label of the effect that is the same quantity, if the trials may also share one value of it
  // (fit/spread_seen.hpp). Empty: none.
  std::string shared_as{};
  // Effects that act in this trial exactly as the nuisance does: label, and change of the nuisance per unit
  // of the effect's first parameter. Both then have one derivative (`TrialModel::like`).
  std::map<std::string, double> like{};
  bool is_own = false;  // each trial has its own: how it began, when the body landed
};

inline Nuisance own_nuisance(std::string name, double sd, double step) {
  Nuisance nuisance{std::move(name), sd, step};
  nuisance.is_own = true;
  return nuisance;
}

// A quantity that is known for every row, e.g. depth or speed. The answer shows the mismatch over it.
struct Coordinate {
  std::string name;            // a channel or a quantity of the plant, with unit
  std::vector<double> values;  // one per row
};

// Variant of the simulation that another program with the same belief might be: another step size, one
// recorded event at another time, or believed dry friction that changes its sign within other speeds.
struct Variant {
  enum class Kind : std::uint8_t { none, step, event, friction };
  Kind kind = Kind::none;
  std::size_t event = 0;  // index of the recorded event
  double amount = 0.0;    // step, friction: factor of the step size, of the speeds; event: delay in rows

  bool empty() const { return kind == Kind::none; }
};
// Two variants with opposite changes. If there is only one, the other is empty.
struct VariantPair {
  Variant sooner{}, later{};
};

// Simulation of one trial. It holds the recorded inputs and the set-up; effects and nuisances are arguments.
class TrialModel {
 public:
  virtual ~TrialModel() = default;

  // Predictions of all rows, in the units of their channels. `nuisances`: those of the trial, then those of
  // each block in turn.
  virtual void predict(const Edits& edits, std::span<const double> nuisances,
                       std::span<double> out) const = 0;

  // Numerical variants that are as correct as this simulation, and their predictions.
  virtual std::vector<VariantPair> variants() const { return {}; }
  virtual void predict_variant(const Variant& /*variant*/, const Edits& edits,
                               std::span<const double> nuisances, std::span<double> out) const {
    predict(edits, nuisances, out);
  }

  // A nuisance for each number that `belief` says differs from trial to trial, behind the plant's own.
  void add_key_spreads(const Belief& belief);
  // `edits`, then these numbers as `nuisances` put them.
  Edits with_key_spreads(Edits edits, std::span<const double> nuisances) const;
  bool has_key_spreads() const { return !key_spreads_.empty(); }

  std::size_t nuisance_count() const {
    return trial_nuisances.size() + static_cast<std::size_t>(blocks) * block_nuisances.size();
  }

  // Prior standard deviation of a nuisance, indexed as in predict().
  double sd_of(std::size_t nuisance) const {
    const std::size_t q = trial_nuisances.size();
    return nuisance < q ? trial_nuisances[nuisance].sd
                        : block_nuisances[(nuisance - q) % block_nuisances.size()].sd;
  }

  // The nuisance that acts as an effect with this label does in this trial, and its change per unit of the
  // effect's first parameter. None: no nuisance acts alike.
  struct Alike {
    std::size_t nuisance = 0;
    double per_unit = 0.0;
  };
  std::optional<Alike> like(const std::string& label) const;

  std::string name;
  std::vector<Row> rows;  // sorted by channel, then by time
  std::uint32_t blocks = 1;
  std::vector<Nuisance> trial_nuisances;
  std::vector<Nuisance> block_nuisances;
  std::vector<Coordinate> coordinates;
  // Per channel: noise level of this trial relative to the campaign. Empty: 1.
  std::vector<double> noise_factor;

 private:
  std::vector<KeySpread> key_spreads_;
  std::size_t first_key_spread_ = 0;  // its place among the trial's nuisances
};

// Port at which a law of free form may be fitted. The variables of the port's state are tried one by one.
struct FreePort {
  std::string port;  // name of a LawPort; a channel if `sensor`
  bool sensor = false;
  double scale = 1.0;  // typical size of the law: force, torque or reading
  // A law at this port can fit noise, so the noise estimate (update_noise) leaves it out.
  bool takes_up_noise = false;
};

// Residual of one equation of motion in one trial: at each instant, the force or torque that the recorded
// motion needs and the belief does not explain. Accelerations are measured or differentiated, and no
// simulation is needed. A balance therefore still locates missing physics when the simulation of a trial
// diverges.
struct Balance {
  std::string port;
  std::vector<double> rest;  // needed minus believed, N or N m
  std::vector<PortState> states;
  // Regressors of the listed effects, one value per instant, each with a free size: sign and size of a speed,
  // an acceleration, the rate of a lagging signal.
  std::vector<std::vector<double>> known;
};

// A possible next trial: its recording without noise, if the edits given to doable() are true.
struct DoableTrial {
  Trial trial;
  Belief belief;                             // the campaign's with this set-up's own values
  std::map<std::string, std::string> words;  // set-up values that are words, e.g. the profile
  double cost = 0.0;  // effort: 1 for an unusual set-up, or for twice the largest value so far
};

// A rule of the belief that the recordings themselves contradict; no simulation is needed.
struct BrokenRule {
  std::string id;
  Port port{};
  std::string statement, equation;  // same as in Effect
  std::string parameter;            // name with unit
  double value = 0.0, low = 0.0, high = 0.0;
};

// Interface of a plant. Each plant has one folder in plants/; make_plant() makes it.
class PlantModel {
 public:
  virtual ~PlantModel() = default;
  // Names of the predicted channels, and of the phases of a trial. Row::channel and Row::phase are indices
  // into them.
  virtual std::vector<std::string> channels() const = 0;
  virtual std::vector<std::string> phases() const = 0;
  // False if the phases only order rows by speed or load. The answer then says where in a trial by thirds of
  // its time.
  virtual bool phases_are_stages() const { return true; }
  // Share of the explained deviance that may remain because the true law has another form than the listed
  // one.
  virtual double form_error() const { return 0.05; }
  // Deviance per row by which two programs with the same equations may differ, as if something acted at this
  // port. Port "readings": as if only readings changed. Causes are integrators, current loops and sampling
  // instants.
  virtual double simulations_differ(const std::string& /*port*/) const { return 0.0; }
  // Model error: standard deviation of a force or torque at each port that differs from trial to trial
  // although no physics is missing, in FreePort::scale. 0: not known for this plant.
  virtual double port_error() const { return 0.0; }
  // True for a plant whose forces change within a row: then a channel may record the mean over the row.
  virtual bool changes_within_rows() const { return false; }
  // Standard deviation of a channel that is a condition which the simulation must meet, in the channel's
  // unit. 0: the channel is a sensor.
  virtual double least_sd(const std::string& /*channel*/) const { return 0.0; }
  // Largest difference in the age of a row's sample between recorders that the belief describes alike: one
  // row if the recorder low-passes the channel, perhaps with only one filter step per row; one period of a
  // sensor that is faster than the rows, because the row may hold its newest sample or trigger it.
  virtual double unsure_age_s(const std::string& /*channel*/, const Belief& /*belief*/,
                              double /*row_s*/) const {
    return 0.0;
  }
  // Phase in which no force acts on the recorded channel, if there is one.
  virtual std::optional<std::size_t> quiet_phase() const { return std::nullopt; }
  // Lengths of the stretches in which a trial is simulated, longest first, relative to the shortest. Each
  // stretch starts anew, and what the model lacks adds up along it. The longest counts in which the answer
  // leaves no more than the noise; the shortest if there is none.
  virtual std::vector<double> stretches(const std::vector<Trial>& /*trials*/) const { return {1.0}; }
  void simulate_in_stretches(double length) { stretch_ = length; }
  // Model of one trial. Null if nothing in the trial can be predicted; `why` then says what is missing.
  virtual std::unique_ptr<TrialModel> trial(const Trial& trial, const Belief& belief,
                                            std::string& why) const = 0;
  // Fills `context.facts`; `context.belief` and `context.channels` are already set.
  virtual void describe(const std::vector<Trial>& trials, Context& context) const = 0;
  // Ports at which laws of free form may be fitted.
  virtual std::vector<FreePort> free_ports(const Context& context) const = 0;
  // True if one simulation is slow. The search then fits only the best of the screen, and no laws with many
  // knots.
  virtual bool is_costly() const { return false; }
  // True if the trials can be simulated with all nuisances at their prior means, before any fit.
  virtual bool starts_as_believed() const { return false; }
  // True if the belief states how far its nuisances differ from trial to trial. A common shift of a nuisance
  // in all trials is then evidence of missing physics.
  virtual bool says_how_trials_differ(const Belief&) const { return false; }
  // Standard deviation of the drive's recorded timing, s. 0: the torque is a recorded input, as uncertain in
  // time as the channels are.
  virtual double drive_unsure_s() const { return 0.0; }
  // A number that the belief leaves open; it may be off by +-`most`.
  struct UnsureKey {
    std::string name, belief_key;
    double most = 1.0;
  };
  virtual std::vector<UnsureKey> unsure_keys() const { return {}; }
  // True if the motion is a recorded input, so that no trial's simulation can diverge.
  virtual bool motion_is_prescribed() const { return false; }
  // Balances of one trial. None if the plant's recordings do not suffice.
  virtual std::vector<Balance> balances(const Trial& /*trial*/, const Belief& /*belief*/) const { return {}; }
  // Rules that the trials break; `beliefs`: one for each trial.
  virtual std::vector<BrokenRule> broken_rules(const std::vector<Trial>& /*trials*/,
                                               const std::vector<Belief>& /*beliefs*/) const {
    return {};
  }
  // Possible next trials with set-ups within `reach`, simulated with `edits`. None if the plant cannot plan
  // trials.
  virtual std::vector<DoableTrial> doable(const std::vector<Trial>& recorded, const Belief& belief,
                                          const Edits& edits, const Reach& reach) const {
    (void)recorded, (void)belief, (void)edits, (void)reach;
    return {};
  }

 protected:
  double stretch_ = 1.0;  // one of `stretches`
};

std::unique_ptr<PlantModel> make_plant(PlantKind kind);

// Conversion time of one sample of a channel, s. A sample may be the mean over that time or the value at its
// end. 0: not known.
double conversion_s(const Belief& belief, const std::string& channel);

}  // namespace sandhopper::diagnose
