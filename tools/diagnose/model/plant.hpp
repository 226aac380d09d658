#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/diagnose/model/context.hpp"
#include "tools/diagnose/model/edits.hpp"
#include "tools/diagnose/model/reach.hpp"
#include "tools/diagnose/model/trial.hpp"

namespace sandhopper::diagnose {

// One recorded sample that the simulation predicts.
struct Row {
  std::uint32_t channel = 0;  // index into the plant's channels
  std::uint32_t block = 0;    // stretch that starts from an initial state of its own
  std::uint32_t phase = 0;    // index into the plant's phases
  double time_s = 0.0;
  double measured = 0.0;
  // Against one sample's: less for a mean of several, more where what the prediction is made from is itself
  // uncertain.
  double relative_sd = 1.0;
  double numerical_sd = 0.0;  // that two honest simulations differ by here, in the channel's unit
};

// Something that differs from trial to trial and is fitted along, with the spread that is believed.
struct Nuisance {
  std::string name;
  double sd = 1.0;
  double step = 0.01;  // of numerical derivatives
  std::string port{};  // where it acts, if what moves it in all trials alike can be placed by that
  // Whether it says something where it is off by as much in all trials: not of how readings were written
  // down, nor where nobody said how far trials differ.
  bool may_lean = true;
  // A number of the robot, which trials may share as well as differ in (`spread_seen`): the label of the
  // effect that this is then.
  std::string shared_as{};
};

// What can be told about a row besides its value: the axes on which a mismatch is placed.
struct Coordinate {
  std::string name;            // of a channel or a plant's own, with unit
  std::vector<double> values;  // one per row
};

// Another honest simulation of the same physics: which number of the program is changed, and by how much.
struct Variant {
  enum class Kind : std::uint8_t { none, step, event };
  Kind kind = Kind::none;
  std::size_t event = 0;  // which of the recorded instants
  double amount = 0.0;    // factor of the step; rows by which an instant is later

  bool empty() const { return kind == Kind::none; }
};
// Two that differ from the simulation in opposite ways, or one alone.
struct VariantPair {
  Variant sooner{}, later{};
};

// One trial as a simulation: recorded inputs and set-up inside, effects and nuisances as arguments.
class TrialModel {
 public:
  virtual ~TrialModel() = default;

  // Predictions for all rows. `nuisances`: those of the trial, then those of each block in turn.
  virtual void predict(const Edits& edits, std::span<const double> nuisances,
                       std::span<double> out) const = 0;

  // Simulations that no recording can tell from this one, and what they predict.
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

  double sd_of(std::size_t nuisance) const {
    const std::size_t q = trial_nuisances.size();
    return nuisance < q ? trial_nuisances[nuisance].sd
                        : block_nuisances[(nuisance - q) % block_nuisances.size()].sd;
  }

  std::string name;
  std::vector<Row> rows;  // channel by channel, in time within each channel
  std::uint32_t blocks = 1;
  std::vector<Nuisance> trial_nuisances;
  std::vector<Nuisance> block_nuisances;
  std::vector<Coordinate> coordinates;
  // By channel: how much noisier this trial is than the campaign; empty where all are alike.
  std::vector<double> noise_factor;

 private:
  std::vector<KeySpread> key_spreads_;
  std::size_t first_key_spread_ = 0;  // its place among the trial's nuisances
};

// A free-form law at this port: what it is a function of is found out by trying.
struct FreePort {
  std::string port;  // of Edits::laws, or a channel for a sensor
  bool sensor = false;
  double scale = 1.0;  // of the force, torque or reading
  // So much can be done here that noise itself would pass for it: no part of how large the noise is.
  bool takes_up_noise = false;
};

// What the recorded motion and the belief leave over of one force or torque of one trial, instant by instant,
// without a simulation: accelerations come from accelerometers, nothing is integrated along the trial. A
// simulation that was led astray says nothing of where; this still does.
struct Balance {
  std::string port;
  std::vector<double> rest;  // recorded less believed: N or N m
  std::vector<PortState> states;
  // What effects on the list would leave there, each a shape of free size: sign and size of a speed, an
  // acceleration, the change of a reading that lags.
  std::vector<std::vector<double>> known;
};

// A trial that could be done next, as it would be recorded, without noise, if the edits it was planned with
// are true.
struct DoableTrial {
  Trial trial;
  Belief belief;                             // the campaign's with this set-up's own values
  std::map<std::string, std::string> words;  // set-up keys that are no numbers: profile
  double cost = 0.0;  // trouble: 1 for something unusual, or twice what was done so far
};

// What the recordings contradict by themselves, whatever a simulation may say.
struct BrokenRule {
  std::string id;
  Port port{};
  std::string statement, equation;  // as of an effect
  std::string parameter;
  double value = 0.0, low = 0.0, high = 0.0;
};

// A plant is one file in plants/ that makes one of these.
class PlantModel {
 public:
  virtual ~PlantModel() = default;
  virtual std::vector<std::string> channels() const = 0;
  virtual std::vector<std::string> phases() const = 0;
  // The share of what is explained that laws of a true form other than the candidates' may leave.
  virtual double form_error() const { return 0.05; }
  // What two programs that simulate this plant by the same equations may differ by, of the noise's power, as
  // if something acted at that port, or changed "readings" alone: integrators, current loops and instants of
  // sampling are nobody's physics.
  virtual double simulations_differ(const std::string& /*port*/) const { return 0.0; }
  // Standard deviation of a force or torque at each port that differs from trial to trial though nothing is
  // missing, in the port's scale. 0: not learned for this plant.
  virtual double port_error() const { return 0.0; }
  // True for a plant whose forces change within a row: then a channel may record the mean over the row.
  virtual bool changes_within_rows() const { return false; }
  // Of a channel that is no sensor's but a condition the simulation must meet; 0: a sensor's.
  virtual double least_sd(const std::string& /*channel*/) const { return 0.0; }
  // Whether a channel is low-passed by what records it, perhaps no more often than it is recorded.
  virtual bool filtered_in_rows(const std::string& /*channel*/, const Belief& /*belief*/) const {
    return false;
  }
  // A phase in which nothing acts on what is recorded, if there is one.
  virtual std::optional<std::size_t> quiet_phase() const { return std::nullopt; }
  // Null where the trial has nothing that can be predicted; `why` then says what is missing.
  virtual std::unique_ptr<TrialModel> trial(const Trial& trial, const Belief& belief,
                                            std::string& why) const = 0;
  // Scales and whatever else the effects ask for.
  virtual void describe(const std::vector<Trial>& trials, Context& context) const = 0;
  virtual std::vector<FreePort> free_ports(const Context& context) const = 0;
  // Whether a simulation takes long: what a screen puts first is tried, not all, and laws with few knots.
  virtual bool is_costly() const { return false; }
  // Whether trials can be simulated with their nuisances as they are believed, before anything is fitted.
  virtual bool starts_as_believed() const { return false; }
  // Whether this belief says how far its nuisances differ from trial to trial, and not only that nobody knows
  // them: then what is off by the same in all trials is something.
  virtual bool says_how_trials_differ(const Belief&) const { return false; }
  // By how much the drive may act late or early, as it is written down, s. 0: its torque is a recorded input,
  // whose time is as unsure as that of what is recorded.
  virtual double drive_unsure_s() const { return 0.0; }
  // Numbers that a belief leaves open, and how far at most.
  struct UnsureKey {
    std::string name, belief_key;
    double most = 1.0;
  };
  virtual std::vector<UnsureKey> unsure_keys() const { return {}; }
  // Motion is recorded, not simulated: no trial's simulation can go astray.
  virtual bool motion_is_prescribed() const { return false; }
  // Of one trial; none where this plant's recordings do not say enough.
  virtual std::vector<Balance> balances(const Trial& /*trial*/, const Belief& /*belief*/) const { return {}; }
  virtual std::vector<BrokenRule> broken_rules(const std::vector<Trial>& /*trials*/,
                                               const std::vector<Belief>& /*beliefs*/) const {
    return {};
  }
  // Trials like the recorded ones, with set-ups within `reach`; none where planning is not known.
  virtual std::vector<DoableTrial> doable(const std::vector<Trial>& recorded, const Belief& belief,
                                          const Edits& edits, const Reach& reach) const {
    (void)recorded, (void)belief, (void)edits, (void)reach;
    return {};
  }
};

std::unique_ptr<PlantModel> make_plant(PlantKind kind);

// How long the converter of a channel takes over one sample, s: it may give the mean of that time or its end.
// 0: not known.
double conversion_s(const Belief& belief, const std::string& channel);

}  // namespace sandhopper::diagnose
