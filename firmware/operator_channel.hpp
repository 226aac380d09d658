#pragma once
#include <atomic>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/node.hpp"
#include "firmware/hop_session.hpp"
#include "firmware/outbox.hpp"
#include "firmware/word_reader.hpp"

namespace sandhopper {

// Passes the words of one read to the cycle. A quit among them sets `quit` first, so that the cycle cannot
// serve another word without seeing it. A second quit or signal means at once. received_ns is
// CLOCK_MONOTONIC, or 0 if the cycle uses another clock.
void post_words(std::span<const Word> words, std::int64_t received_ns, RequestBox& requests,
                std::atomic<Quit>& quit);

// hopperd's interface to its operator: one word per line on standard input (arm, release, stop, disarm, quit;
// WordReader), one JSON object per line on standard output, including an answer to each word (RequestBox). An
// unknown word stops the robot softly. End of input, SIGINT, SIGTERM and SIGHUP (lost terminal) mean quit; a
// second `quit` or signal means at once. A reader that does not read blocks nothing (Outbox).
class OperatorChannel {
 public:
  // Takes these signals over for the whole process, so construct it before any thread starts.
  OperatorChannel();
  ~OperatorChannel();
  OperatorChannel(const OperatorChannel&) = delete;
  OperatorChannel& operator=(const OperatorChannel&) = delete;

  // The cycle publishes its status here. rate_Hz is the rate of the status lines; 0: none.
  Latest<LiveStatus>& status() { return status_; }
  void tell_status_at(int rate_Hz) { status_Hz_ = rate_Hz; }

  // Listens on the calling thread until `ended` is set.
  void listen(RequestBox& requests, std::atomic<Quit>& quit, const std::atomic<bool>& ended);

  void tell(const Event& event, const ConfigNode& robot);  // robot.toml, for the limits of faults
  void tell(const StrideResult& result);
  void tell(const StrengthProfile& profile, const GroundSummary& ground);
  void tell(const GroundEvents& found);
  void tell(const RequestRecord& answer);
  void tell(const SessionResult& result);
  void tell_text(const std::string& key, const std::string& text);

 private:
  void take_lines(const std::vector<WordReader::Line>& lines, RequestBox& requests, std::atomic<Quit>& quit);
  bool read_lines(RequestBox& requests, std::atomic<Quit>& quit);
  void take_signal(RequestBox& requests, std::atomic<Quit>& quit);
  void tell_status();

  int signal_fd_ = -1;
  int status_Hz_ = 0;
  Latest<LiveStatus> status_;
  std::optional<Outbox> outbox_;
  WordReader reader_;
};

}  // namespace sandhopper
