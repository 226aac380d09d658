#include "tools/trial/sim_trial.hpp"

#include <stdexcept>

#include "config/dump.hpp"
#include "firmware/cycle.hpp"
#include "firmware/log/trial_description.hpp"
#include "tools/plant/bed_truth.hpp"
#include "tools/plant/sim_board.hpp"
#include "tools/plant/trial_draw.hpp"

namespace sandhopper {
namespace {

constexpr std::uint64_t kArm_cycle = 10;
constexpr std::uint64_t kTail_cycles = 20;  // after the end

// Acts as the operator of a simulated trial.
class Script {
 public:
  Request next(std::uint64_t cycle) noexcept {
    if (cycle == kArm_cycle) return Request::arm;
    if (armed_at_ != 0 && cycle == armed_at_ + static_cast<std::uint64_t>(kHang_cycles))
      return Request::release;
    return Request::none;
  }
  void see(const Event& event, std::uint64_t cycle) noexcept {
    if (event.kind == EventKind::armed) armed_at_ = cycle;
    const bool ends = event.kind == EventKind::stopped || event.kind == EventKind::fault_raised ||
                      event.kind == EventKind::arming_refused;
    if (ends && ended_at_ == 0) ended_at_ = cycle;
  }
  bool over(std::uint64_t cycle, DriveRequest drive) const noexcept {
    return ended_at_ != 0 && drive == DriveRequest::off && cycle > ended_at_ + kTail_cycles;
  }

 private:
  std::uint64_t armed_at_ = 0;
  std::uint64_t ended_at_ = 0;
};

TrialLogOptions log_options(const SimTrialSetup& setup) {
  TrialLogOptions options;
  options.mcap_file = setup.log;
  options.realtime_offset_ns = setup.realtime_offset_ns;
  options.own_thread = false;
  return options;
}

}  // namespace

void describe_simulated_trial(TrialLogger& logger, const SimTrialSetup& setup) {
  describe_trial(logger, setup.robot, "sim");
  logger.attach("world.toml", "application/toml", to_toml(to_node(setup.world)));
  const TrialDraw draw(setup.world, {.seed = setup.trial.seed, .noise = setup.trial.noise, .start_ns = 0});
  logger.attach(kBedTruthAttachment, "application/json", bed_truth_text(draw.bed()));
  logger.add_metadata("simulated trial",
                      {{"seed", std::to_string(setup.trial.seed)},
                       {"noise", setup.trial.noise ? "on" : "off"},
                       {"bed_family", std::string(name_of(setup.world.bed_family.family))},
                       {"release_height_m", std::to_string(setup.trial.release_height_m)}});
  if (setup.sheet) add_sheet(logger, *setup.sheet);
}

SimTrialResult run_sim_trial(const SimTrialSetup& setup) {
  World world(setup.world, setup.trial, 0);
  SimBoard board(world);
  TrialLogger logger(log_options(setup));
  const TrialTopics topics(logger);
  const auto truth = logger.add_topic<PlantTruth>(topic::kTruth);
  describe_simulated_trial(logger, setup);
  logger.start();
  Controller controller(cycle_config(setup.robot));
  Aftermath aftermath(setup.robot.stiffness, logger, topics, {});
  Cycle cycle({board, controller, logger, topics, aftermath});
  Script script;
  SimTrialResult result;
  const auto longest = static_cast<std::uint64_t>(setup.longest_s * 1e9 / kCyclePeriod_ns);
  for (std::uint64_t k = 1; k <= longest; ++k) {
    const std::int64_t now_ns = static_cast<std::int64_t>(k) * kCyclePeriod_ns;
    const auto& output = cycle.run({.time_ns = now_ns, .cycle = k, .request = script.next(k)});
    logger.push(truth, now_ns, world.truth());
    for (const auto& event : controller.events()) script.see(event, k);
    aftermath.serve();
    result = {output.state, output.fault, k};
    if (setup.progress && k % 256 == 0) setup.progress(static_cast<double>(now_ns) * 1e-9);
    if (script.over(k, output.command.drive)) break;
  }
  logger.stop();
  logger.close();
  if (!logger.error().empty()) throw std::runtime_error(logger.error());
  return result;
}

}  // namespace sandhopper
