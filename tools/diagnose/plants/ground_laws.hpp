#pragma once
#include <vector>

#include "terrain/bed.hpp"
#include "tools/diagnose/model/context.hpp"
#include "tools/diagnose/model/edits.hpp"
#include "tools/diagnose/model/trial.hpp"

namespace sandhopper::diagnose {

// The bed before a trial, from the set-up.
struct BedHistory {
  double pushes = 0.0;  // since the bed was prepared
  double wait_s = 0.0;
  double bed_depth_m = 0.0;  // depth of the container; 0: unknown
};

// Facts of the set-ups that laws of the bed's history go by.
void describe_bed_history(const std::vector<Trial>& trials, PlantFacts& facts);

// Effects on the bed, at the ports ground_* (model/ports.hpp). Their laws see a GroundState.
//   F_d = curve (1 + ground_factor) + ground_static,   depth + ground_surface
class GroundLaws final : public BedExtension {
 public:
  explicit GroundLaws(const Edits& edits, const BedHistory& history = {});

  double quasi_static_N(double curve_N, double depth_m) const override;
  double unloading_factor() const override;
  BedReaction added(const BedContact& contact, double quasi_static_N, double bearing_N,
                    bool virgin) const override;

  // Time that the laws see from now on, s.
  void at_time(double time_s) { time_s_ = time_s; }
  void pushed() { history_.pushes += 1.0; }  // counts one more push
  // Sets if the foot is below the surface now. The time since touch starts when it enters.
  void touching(bool now) {
    if (now && !touching_) touched_s_ = time_s_;
    touching_ = now;
  }
  // Sum of ground_surface: to be added to every depth.
  double deeper_m() const;
  bool empty() const {
    return factor_.empty() && static_.empty() && unloading_.empty() && force_.empty() && mass_.empty() &&
           tension_.empty();
  }

 private:
  double floor_m() const;

  std::vector<const Law*> factor_, static_, unloading_, force_, mass_, tension_, surface_;
  BedHistory history_;
  double time_s_ = 0.0, touched_s_ = 0.0;
  bool touching_ = false;
};

// The [terrain] numbers of the belief after the edits, clamped to their ranges.
BedParameters bed_parameters(const Belief& belief, const Edits& edits);

}  // namespace sandhopper::diagnose
