#include <fmt/format.h>

#include "firmware/state/recollection.hpp"
#include "tools/cli/doctor.hpp"

namespace sandhopper::cli {

std::vector<Finding> examine_state(const RobotConfig& robot) {
  const auto places = state_places("");
  const auto boot = read_state_file(places.boot);
  const auto lasting = read_state_file(places.lasting);
  const auto memory = recollect(boot, lasting, state_clock(), robot);
  std::vector<Finding> findings{
      {memory.trusted ? Health::ok : Health::warn, "motor temperatures", memory.text,
       memory.trusted ? "" : fmt::format("run hopperd once so that {} is written", places.lasting.string())}};
  if (!boot.state && !lasting.state) return findings;
  const auto allowed = static_cast<std::uint32_t>(robot.supervision.hop_count);
  const bool due = memory.start.touchdowns > allowed;
  findings.push_back({due ? Health::fail : Health::ok, "touchdowns since inspection",
                      fmt::format("{} of {}", memory.start.touchdowns, allowed),
                      due ? "inspect the leg, then start hopperd once with --leg-inspected" : ""});
  const auto& last = boot.state ? *boot.state : *lasting.state;
  if (last.fault != Fault::none)
    findings.push_back({Health::warn, "last run's fault",
                        fmt::format("{}, not disarmed{}", name_of(last.fault),
                                    last.closed ? "" : "; the run did not end in order or goes on"),
                        fmt::format("hop explain {}", name_of(last.fault))});
  if (!memory.positions.empty())
    findings.push_back({Health::fail, "motor positions", memory.positions, "hop calibrate encoders"});
  else if (last.positions_known)
    findings.push_back({Health::ok, "motor positions",
                        fmt::format("last {:.3f} and {:.3f} rad", last.position_rad[0], last.position_rad[1]),
                        ""});
  return findings;
}

}  // namespace sandhopper::cli
