#pragma once
#include <cstdint>
#include <functional>

#include "firmware/controller.hpp"
#include "tools/plant/sim_board.hpp"
#include "tools/plant/world.hpp"

namespace sandhopper {

// A trial on the simulated robot, cycle by cycle. The controller gets the requests to arm and then to
// release.
class HoppedCycles {
 public:
  // The robot hangs for `hang_cycles` between arming and release. At 0 the height filter still has the spread
  // that it starts with; after kHang_cycles it has settled, as in every simulated trial of `hop trial`.
  HoppedCycles(const CycleConfig& cycle, const WorldConfig& world, const TrialSetup& setup,
               std::int64_t hang_cycles = 0);

  // Runs one cycle. Returns false when the trial is over. `change` may modify the controller's input.
  bool next(const std::function<void(SensorFrame&)>& change = {});

  const Controller& controller() const { return controller_; }
  const SensorFrame& frame() const { return reported_; }
  const StepOutput& output() const { return *output_; }
  const PlantTruth& truth() const { return truth_; }          // at the time of the cycle
  const PlantTruth& truth_before() const { return before_; }  // at the time of the newest motor reply
  bool faulted() const { return output_->state == State::fault; }

 private:
  static constexpr std::int64_t kPeriod_ns = 1'000'000;
  static constexpr std::int64_t kLongest_cycles = 5000;

  World world_;
  SimBoard board_;
  Controller controller_;
  SensorFrame frame_{}, reported_{};
  const StepOutput* output_ = nullptr;
  PlantTruth truth_{}, before_{};
  Request request_ = Request::arm;
  std::int64_t cycle_ = 0;
  std::int64_t hang_cycles_, release_cycle_ = kLongest_cycles;
};

}  // namespace sandhopper
