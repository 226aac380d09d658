#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "drivers/gpio/line_config.hpp"
#include "drivers/unique_fd.hpp"
#include "tools/virtual_bench/event_loop.hpp"

// The robot's GPIO lines, made with the kernel's gpio-sim, and what is wired to them.
namespace sandhopper::bench {

// The wire's far end: a level that the firmware reads, or the one that it drives. A line that is not fitted
// swallows what it is given.
class SimulatedLine {
 public:
  SimulatedLine() = default;
  SimulatedLine(UniqueFd pull, UniqueFd value) : pull_(std::move(pull)), value_(std::move(value)) {}

  // Overrides whatever bias the firmware asks for, as a switch or an output would. An edge is seen at once.
  void drive(bool high);
  bool high() const;

  // The kernel applies the bias asked for when a line is taken; what drives it is stronger.
  void drive_again();

 private:
  UniqueFd pull_;
  UniqueFd value_;
  bool driven_ = false;
  bool driven_high_ = false;
};

class SimulatedGpio {
 public:
  // Makes one chip for every `chip` that the lines name, labelled like it ("bench" where none is named), with
  // those lines. Throws std::runtime_error.
  SimulatedGpio(EventLoop& loop, const std::vector<LineConfig>& lines);
  ~SimulatedGpio();
  SimulatedGpio(const SimulatedGpio&) = delete;
  SimulatedGpio& operator=(const SimulatedGpio&) = delete;

  // One of the lines given above.
  SimulatedLine& line(const LineConfig& config);

 private:
  using Offsets = std::map<int, std::string>;  // line's name by its number on a chip
  struct Chip {
    UniqueFd device;
    std::map<int, SimulatedLine> lines;
  };

  static int number_for(const LineConfig& config, const Offsets& taken);
  void open_chip(const std::string& label, const Offsets& offsets);
  void watch(Chip& chip);
  static void drive_changed_lines(Chip& chip);

  EventLoop& loop_;
  std::map<std::string, Chip> chips_;
  std::map<std::pair<std::string, std::string>, SimulatedLine*> by_name_;
  SimulatedLine not_fitted_;
};

}  // namespace sandhopper::bench
