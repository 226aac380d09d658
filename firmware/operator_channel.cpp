#include "firmware/operator_channel.hpp"

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>

#include "drivers/clock.hpp"
#include "firmware/operator_text.hpp"

namespace sandhopper {
namespace {

// Raises the urgency of the quit request; never lowers it.
void ask_to(Quit how, std::atomic<Quit>& quit) {
  if (quit.load() < how) quit.store(how);
}

void ask_again(std::atomic<Quit>& quit) {
  ask_to(quit.load() == Quit::no ? Quit::softly : Quit::at_once, quit);
}

}  // namespace

void post_words(std::span<const Word> words, std::int64_t received_ns, RequestBox& requests,
                std::atomic<Quit>& quit) {
  for (const Word word : words) {
    if (word == Word::end_of_input)
      ask_to(Quit::softly, quit);
    else if (means_quit(word))
      ask_again(quit);
  }
  requests.post(words, received_ns);
}

OperatorChannel::OperatorChannel() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGHUP, SIG_DFL);  // handle it also under nohup, because the robot must not run unattended
  signal_fd_ = signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
  if (signal_fd_ < 0) throw std::system_error(errno, std::generic_category(), "signalfd");
  outbox_.emplace(STDOUT_FILENO);  // created last, so that its thread has the signals blocked, too
}

OperatorChannel::~OperatorChannel() { close(signal_fd_); }

void OperatorChannel::listen(RequestBox& requests, std::atomic<Quit>& quit, const std::atomic<bool>& ended) {
  const int look_ms = status_Hz_ > 0 ? std::max(1, 1000 / status_Hz_) : 100;
  std::int64_t next_status_ns = 0;
  std::array<pollfd, 2> fds{pollfd{STDIN_FILENO, POLLIN, 0}, pollfd{signal_fd_, POLLIN, 0}};
  while (!ended.load()) {
    if (poll(fds.data(), fds.size(), look_ms) < 0 && errno != EINTR) ask_to(Quit::at_once, quit);
    if ((fds[1].revents & POLLIN) != 0) take_signal(requests, quit);
    if ((fds[0].revents & (POLLIN | POLLHUP | POLLERR | POLLNVAL)) != 0 && !read_lines(requests, quit))
      fds[0].fd = -1;
    if (status_Hz_ > 0 && monotonic_ns() >= next_status_ns) {
      next_status_ns = monotonic_ns() + look_ms * std::int64_t{1'000'000};
      tell_status();
    }
  }
}

void OperatorChannel::tell_status() {
  LiveStatus newest;
  if (status_.take(newest)) outbox_->put_status(operator_text(newest));
}

void OperatorChannel::take_signal(RequestBox& requests, std::atomic<Quit>& quit) {
  signalfd_siginfo info{};
  while (read(signal_fd_, &info, sizeof info) == sizeof info) {
    post_words(std::array{Word::signal}, monotonic_ns(), requests, quit);
    tell_text("signal", strsignal(static_cast<int>(info.ssi_signo)));
  }
}

// The words of one read are posted together: a stop among them overrules an arm or release (RequestBox).
// Returns false at the end of input.
bool OperatorChannel::read_lines(RequestBox& requests, std::atomic<Quit>& quit) {
  std::array<char, 4096> buffer{};
  const auto got = read(STDIN_FILENO, buffer.data(), buffer.size());
  if (got < 0 && (errno == EINTR || errno == EAGAIN)) return true;
  std::vector<WordReader::Line> lines;
  if (got > 0) {
    reader_.read({buffer.data(), static_cast<std::size_t>(got)}, lines);
  } else {
    reader_.end(lines);
    lines.push_back({Word::end_of_input, ""});
  }
  take_lines(lines, requests, quit);
  return got > 0;
}

void OperatorChannel::take_lines(const std::vector<WordReader::Line>& lines, RequestBox& requests,
                                 std::atomic<Quit>& quit) {
  std::vector<Word> words;
  words.reserve(lines.size());
  for (const auto& line : lines) words.push_back(line.word);
  post_words(words, monotonic_ns(), requests, quit);
  for (const auto& line : lines)
    if (line.word == Word::unknown)
      tell_text("error",
                "unknown word '" + line.text +
                    "': a robot whose drives are on stops softly; known: arm, release, stop, disarm, "
                    "quit");
}

void OperatorChannel::tell(const Event& event, const ConfigNode& robot) {
  outbox_->put(operator_text(event, &robot));
}
void OperatorChannel::tell(const StrideResult& result) { outbox_->put(operator_text(result)); }
void OperatorChannel::tell(const StrengthProfile& profile, const GroundSummary& ground) {
  outbox_->put(operator_text(profile, ground));
}
void OperatorChannel::tell(const GroundEvents& found) { outbox_->put(operator_text(found)); }
void OperatorChannel::tell(const RequestRecord& answer) { outbox_->put(operator_text(answer)); }
void OperatorChannel::tell(const SessionResult& result) { outbox_->put(operator_text(result)); }
void OperatorChannel::tell_text(const std::string& key, const std::string& text) {
  outbox_->put(operator_text(key, text));
}

}  // namespace sandhopper
