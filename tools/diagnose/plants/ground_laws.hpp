#pragma once
#include <vector>

#include "terrain/bed.hpp"
#include "tools/diagnose/model/context.hpp"
#include "tools/diagnose/model/edits.hpp"

namespace sandhopper::diagnose {

struct BedHistory {
  double pushes = 0.0;  // since it was prepared
  double wait_s = 0.0;
  double bed_depth_m = 0.0;  // 0: not told
};

// The bed with what effects add to it. Ports:
//   ground.factor   F_d is multiplied by 1 + law(position = depth)
//   ground.static   law is added to F_d, and with it to the force where unloading begins
//   ground.unloading  the unloading line's stiffness is multiplied by 1 + law
//   ground.force    law is added to the force, everywhere below the surface
//   ground.mass     law times downward acceleration is added: an added mass
//   ground.tension  how far below zero the force may go
// `extreme` is the deepest point; `accel` is 1 on the virgin curve (new depth, going down), else 0; `load`
// the quasi-static force at this depth; `bearing` that which is there without any law; `time_s` that of the
// trial, `since_touch_s` from this contact's beginning.
//   ground.surface  law is added to the depth: the surface is lower by so much less
class GroundLaws final : public BedExtension {
 public:
  explicit GroundLaws(const Edits& edits, const BedHistory& history = {});

  double quasi_static_N(double curve_N, double depth_m) const override;
  double unloading_factor() const override;
  BedReaction added(const BedContact& contact, double quasi_static_N, double bearing_N,
                    bool virgin) const override;

  void at_time(double time_s) { time_s_ = time_s; }
  void pushed() { history_.pushes += 1.0; }
  // Whether the foot is below the surface now.
  void touching(bool now) {
    if (now && !touching_) touched_s_ = time_s_;
    touching_ = now;
  }
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

BedParameters bed_parameters(const Belief& belief, const Edits& edits);

}  // namespace sandhopper::diagnose
