#pragma once
#include "tools/trial/child_process.hpp"
#include "tools/trial/live/cycle_link.hpp"

namespace sandhopper {

// hopperd, a process of its own. When this process goes, however it goes, hopperd's input ends and it stops
// the robot softly.
class DaemonLink : public CycleLink {
 public:
  // Throws std::system_error when it cannot be started.
  explicit DaemonLink(std::vector<std::string> command) : daemon_(std::move(command)) {}

  void send(std::string_view word) override { daemon_.write_line(std::string(word)); }
  int descriptor() const override { return daemon_.output(); }
  bool take(std::vector<std::string>& lines) override;

 private:
  ChildProcess daemon_;
  std::string partial_;
};

}  // namespace sandhopper
