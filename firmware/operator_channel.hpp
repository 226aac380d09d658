#pragma once
#include <atomic>
#include <string>

#include "firmware/hop_session.hpp"

namespace sandhopper {

// hopperd's conversation with whoever operates it: one word a line on standard input (arm, release, stop,
// disarm, quit; end of input, SIGINT, SIGTERM and SIGHUP, a lost terminal, mean quit), one JSON object a line
// on standard output. A second `quit` or signal means at once.
class OperatorChannel {
 public:
  // Takes these signals over for the whole process: construct before any thread starts.
  OperatorChannel();
  ~OperatorChannel();
  OperatorChannel(const OperatorChannel&) = delete;
  OperatorChannel& operator=(const OperatorChannel&) = delete;

  // Listens on the calling thread until `ended` is set.
  void listen(RequestBox& requests, std::atomic<Quit>& quit, const std::atomic<bool>& ended);

  void tell(const Event& event);
  void tell(const StrideResult& result);
  void tell(const SessionResult& result);
  void tell_text(const std::string& key, const std::string& text);

 private:
  void take_line(const std::string& line, RequestBox& requests, std::atomic<Quit>& quit);
  bool read_lines(RequestBox& requests, std::atomic<Quit>& quit);
  void take_signal(std::atomic<Quit>& quit);

  int signal_fd_ = -1;
  std::string pending_;
};

}  // namespace sandhopper
