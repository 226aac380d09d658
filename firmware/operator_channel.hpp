#pragma once
#include <atomic>
#include <optional>
#include <string>
#include <string_view>

#include "firmware/hop_session.hpp"
#include "firmware/outbox.hpp"

namespace sandhopper {

// arm, release, stop, disarm, quit: what the operator may say. False: not one of these. A second quit means
// at once.
bool take_word(std::string_view word, RequestBox& requests, std::atomic<Quit>& quit);

// hopperd's conversation with whoever operates it: one word a line on standard input (arm, release, stop,
// disarm, quit; end of input, SIGINT, SIGTERM and SIGHUP, a lost terminal, mean quit), one JSON object a line
// on standard output. A second `quit` or signal means at once. A reader who does not read holds nobody up
// (Outbox).
class OperatorChannel {
 public:
  // Takes these signals over for the whole process: construct before any thread starts.
  OperatorChannel();
  ~OperatorChannel();
  OperatorChannel(const OperatorChannel&) = delete;
  OperatorChannel& operator=(const OperatorChannel&) = delete;

  // Where the cycle publishes how it stands, and how often that is told; 0: never.
  Latest<LiveStatus>& status() { return status_; }
  void tell_status_at(int rate_Hz) { status_Hz_ = rate_Hz; }

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
  void tell_status();

  int signal_fd_ = -1;
  int status_Hz_ = 0;
  Latest<LiveStatus> status_;
  std::optional<Outbox> outbox_;
  std::string pending_;
};

}  // namespace sandhopper
