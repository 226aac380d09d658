#include "tools/trial/bench_control.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

namespace sandhopper {
namespace {

constexpr const char* kVariable = "SANDHOPPER_BENCH_SOCKET";

class Connection {
 public:
  explicit Connection(const char* path) : fd_(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path, sizeof address.sun_path - 1);
    if (fd_ < 0 || connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      throw std::runtime_error(
          fmt::format("the virtual bench's control socket {} does not answer ({}): is tools/bench "
                      "running without devices?",
                      path, std::strerror(errno)));
  }
  ~Connection() { close(fd_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  std::string ask(const std::string& line) {
    if (write(fd_, line.data(), line.size()) != static_cast<ssize_t>(line.size())) return "not sent";
    std::array<char, 512> answer{};
    const auto got = read(fd_, answer.data(), answer.size());
    std::string text(answer.data(), got > 0 ? static_cast<std::size_t>(got) : 0);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text;
  }

 private:
  int fd_;
};

}  // namespace

bool on_virtual_bench() { return std::getenv(kVariable) != nullptr; }

void reset_bench(const TrialSetup& setup) {
  Connection bench(std::getenv(kVariable));
  const auto answer = bench.ask(fmt::format("reset seed={} height={} noise={}\n", setup.seed,
                                            setup.release_height_m, setup.noise ? "on" : "off"));
  if (answer != "ok") throw std::runtime_error("the virtual bench refused to reset: " + answer);
}

}  // namespace sandhopper
