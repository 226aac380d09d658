#include "firmware/operator_channel.hpp"

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>
#include <system_error>

#include "drivers/clock.hpp"
#include "firmware/operator_text.hpp"

namespace sandhopper {
namespace {

std::optional<Request> request_named(std::string_view word) {
  for (std::size_t i = 1; i < EnumNames<Request>::value.size(); ++i)
    if (EnumNames<Request>::value[i] == word) return static_cast<Request>(i);
  return std::nullopt;
}

// Never gentler than it was asked before.
void ask_to(Quit how, std::atomic<Quit>& quit) {
  if (quit.load() < how) quit.store(how);
}

void ask_again(std::atomic<Quit>& quit) {
  ask_to(quit.load() == Quit::no ? Quit::softly : Quit::at_once, quit);
}

}  // namespace

bool take_word(std::string_view word, RequestBox& requests, std::atomic<Quit>& quit) {
  if (word == "quit") {
    ask_again(quit);
    return true;
  }
  const auto request = request_named(word);
  if (request) requests.post(*request);
  return request.has_value();
}

OperatorChannel::OperatorChannel() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGHUP, SIG_DFL);  // also under nohup: a robot is not left to itself
  signal_fd_ = signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
  if (signal_fd_ < 0) throw std::system_error(errno, std::generic_category(), "signalfd");
  outbox_.emplace(STDOUT_FILENO);  // its thread has the signals blocked, too
}

OperatorChannel::~OperatorChannel() { close(signal_fd_); }

void OperatorChannel::listen(RequestBox& requests, std::atomic<Quit>& quit, const std::atomic<bool>& ended) {
  const int look_ms = status_Hz_ > 0 ? std::max(1, 1000 / status_Hz_) : 100;
  std::int64_t next_status_ns = 0;
  std::array<pollfd, 2> fds{pollfd{STDIN_FILENO, POLLIN, 0}, pollfd{signal_fd_, POLLIN, 0}};
  while (!ended.load()) {
    if (poll(fds.data(), fds.size(), look_ms) < 0 && errno != EINTR) ask_to(Quit::at_once, quit);
    if ((fds[1].revents & POLLIN) != 0) take_signal(quit);
    if ((fds[0].revents & (POLLIN | POLLHUP | POLLERR | POLLNVAL)) != 0 && !read_lines(requests, quit)) {
      fds[0].fd = -1;
      ask_to(Quit::softly, quit);
    }
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

void OperatorChannel::take_signal(std::atomic<Quit>& quit) {
  signalfd_siginfo info{};
  while (read(signal_fd_, &info, sizeof info) == sizeof info) {
    tell_text("signal", strsignal(static_cast<int>(info.ssi_signo)));
    ask_again(quit);
  }
}

bool OperatorChannel::read_lines(RequestBox& requests, std::atomic<Quit>& quit) {
  std::array<char, 256> buffer{};
  const auto got = read(STDIN_FILENO, buffer.data(), buffer.size());
  if (got <= 0) return false;
  pending_.append(buffer.data(), static_cast<std::size_t>(got));
  for (auto end = pending_.find('\n'); end != std::string::npos; end = pending_.find('\n')) {
    take_line(pending_.substr(0, end), requests, quit);
    pending_.erase(0, end + 1);
  }
  if (pending_.size() > 1024) pending_.clear();
  return true;
}

void OperatorChannel::take_line(const std::string& line, RequestBox& requests, std::atomic<Quit>& quit) {
  if (!line.empty() && !take_word(line, requests, quit))
    tell_text("error", "unknown word '" + line + "'; known: arm, release, stop, disarm, quit");
}

void OperatorChannel::tell(const Event& event) { outbox_->put(operator_text(event)); }
void OperatorChannel::tell(const StrideResult& result) { outbox_->put(operator_text(result)); }
void OperatorChannel::tell(const SessionResult& result) { outbox_->put(operator_text(result)); }
void OperatorChannel::tell_text(const std::string& key, const std::string& text) {
  outbox_->put(operator_text(key, text));
}

}  // namespace sandhopper
