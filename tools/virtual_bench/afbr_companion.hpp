#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "drivers/samples.hpp"
#include "drivers/tof/tof_config.hpp"
#include "drivers/unique_fd.hpp"
#include "tools/virtual_bench/event_loop.hpp"
#include "tools/virtual_bench/sample_rate.hpp"
#include "tools/virtual_bench/sci_frame.hpp"

namespace sandhopper::bench {

// The companion controller of the AFBR-S50 with Broadcom's ExplorerApp, on a pseudo-terminal that the
// configured device path links to: acknowledges configuration, streams 1-D results between start and stop,
// gives single shots. Its clock starts with the bench. A slower frame time than the world's thins the world's
// measurements out.
class AfbrCompanion {
 public:
  // Throws std::runtime_error.
  AfbrCompanion(EventLoop& loop, const TofConfig& config, double world_rate_Hz);
  ~AfbrCompanion();
  AfbrCompanion(const AfbrCompanion&) = delete;
  AfbrCompanion& operator=(const AfbrCompanion&) = delete;

  // A result is to be on the wire, now.
  void complete(const TofSample& sample);

 private:
  void receive();
  void answer(const SciMessage& request);
  void acknowledge(std::uint8_t command, std::vector<std::uint8_t> data = {});
  void refuse(std::uint8_t command);
  void send(const SciMessage& message);

  EventLoop& loop_;
  TofConfig config_;
  SampleRate rate_;
  UniqueFd controller_;
  UniqueFd terminal_;  // held open, so that the terminal lives on between two users
  SciDecoder decoder_;
  double frame_time_s_ = 0.1;  // ExplorerApp's own default
  bool streaming_ = false;
  bool single_shot_ = false;
};

}  // namespace sandhopper::bench
