#include "firmware/operator_channel.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <optional>
#include <system_error>

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

// In one call: the logger's and the stride's thread speak, too.
void print(const std::string& line) {
  std::fputs((line + '\n').c_str(), stdout);
  std::fflush(stdout);
}

std::string json_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\n') {
      out += "\\n";
      continue;
    }
    out += c;
  }
  return out + '"';
}

template <class Estimate>
std::string stiffness(const Estimate& k) {
  return fmt::format(R"({{"value":{},"ci95":[{},{}],"valid":{},"reason":"{}"}})", k.value_N_per_m,
                     k.ci95_low_N_per_m, k.ci95_high_N_per_m, k.validity == Validity::valid,
                     name_of(k.validity));
}

}  // namespace

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
}

OperatorChannel::~OperatorChannel() { close(signal_fd_); }

void OperatorChannel::listen(RequestBox& requests, std::atomic<Quit>& quit, const std::atomic<bool>& ended) {
  constexpr int kLook_ms = 100;
  std::array<pollfd, 2> fds{pollfd{STDIN_FILENO, POLLIN, 0}, pollfd{signal_fd_, POLLIN, 0}};
  while (!ended.load()) {
    if (poll(fds.data(), fds.size(), kLook_ms) < 0 && errno != EINTR) ask_to(Quit::at_once, quit);
    if ((fds[1].revents & POLLIN) != 0) take_signal(quit);
    if ((fds[0].revents & (POLLIN | POLLHUP | POLLERR | POLLNVAL)) != 0 && !read_lines(requests, quit)) {
      fds[0].fd = -1;
      ask_to(Quit::softly, quit);
    }
  }
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
  if (line == "quit") {
    ask_again(quit);
    return;
  }
  if (const auto request = request_named(line))
    requests.post(*request);
  else if (!line.empty())
    tell_text("error", "unknown word '" + line + "'; known: arm, release, stop, disarm, quit");
}

void OperatorChannel::tell(const Event& e) {
  print(fmt::format(
      R"({{"event":"{}","reason":"{}","fault":"{}","stride":{},"time_ns":{},"values":[{},{},{},{}]}})",
      name_of(e.kind), name_of(e.reason), name_of(e.fault), e.stride, e.time_ns, e.values[0], e.values[1],
      e.values[2], e.values[3]));
}

void OperatorChannel::tell(const StrideResult& r) {
  print(fmt::format(R"({{"stride":{},"touchdown_speed_mps":{},"peak_force_N":{},"max_depth_m":{},)"
                    R"("stiffness_N_per_m":{{"qs_ols":{},"mo_ols":{},"mo_wls":{},"joint":{}}}}})",
                    r.summary.stride, r.summary.touchdown_speed_mps, r.summary.peak_force_N,
                    r.summary.max_depth_m, stiffness(r.quasi_static_ols), stiffness(r.observer_ols),
                    stiffness(r.observer_wls), stiffness(r.joint)));
}

void OperatorChannel::tell(const SessionResult& r) {
  print(fmt::format(R"({{"end":{{"state":"{}","fault":"{}","cycles":{},"overruns":{},"lost_records":{},)"
                    R"("lost_can_frames":{},"log_error":{},"clock_steps":{},"watchdog_trips":{},)"
                    R"("longest_stall_ms":{:.1f},)"
                    R"("latency_us":{{"p50":{},"p99":{},"p99_9":{},"max":{},"histogram":{}}}}}}})",
                    name_of(r.last_state), name_of(r.last_fault), r.cycles, r.overruns, r.lost_records,
                    r.lost_can_frames, json_string(r.log_error), r.clock_steps, r.watchdog_trips,
                    1e3 * r.longest_stall_s, r.latency.quantile_us(0.5), r.latency.quantile_us(0.99),
                    r.latency.quantile_us(0.999), r.latency.largest_us(), r.latency.as_json()));
}

void OperatorChannel::tell_text(const std::string& key, const std::string& text) {
  print(fmt::format("{{{}:{}}}", json_string(key), json_string(text)));
}

}  // namespace sandhopper
