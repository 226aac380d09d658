#pragma once
#include "tools/trial/child_process.hpp"
#include "tools/trial/live/cycle_link.hpp"

namespace sandhopper {

// Connection to hopperd in its own process. When this process ends in any way, hopperd's input ends and
// hopperd stops the robot softly.
class DaemonLink : public CycleLink {
 public:
  // Throws std::system_error if it cannot be started.
  explicit DaemonLink(std::vector<std::string> command) : daemon_(std::move(command)) {}

  void send(std::string_view word) override { daemon_.write_line(std::string(word)); }
  int descriptor() const override { return daemon_.output(); }
  bool take(std::vector<std::string>& lines) override;

 private:
  ChildProcess daemon_;
  std::string partial_;
};

}  // namespace sandhopper
