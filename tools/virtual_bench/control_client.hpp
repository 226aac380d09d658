#pragma once
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <stdexcept>
#include <string>

#include "drivers/unique_fd.hpp"

namespace sandhopper::bench {

inline constexpr const char* kControlPath = "/run/sandhopper/bench.sock";

inline sockaddr_un control_address(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path)
    throw std::runtime_error(path + " is too long for a socket's name");
  std::memcpy(address.sun_path, path.c_str(), path.size());
  return address;
}

// Asks the bench's emulated devices for something (tools/virtual_bench/README.md lists what) and returns
// their one line of answer, without "ok". Throws std::runtime_error when there is no bench or the answer is
// an error.
inline std::string tell_bench(const std::string& line, const std::string& path = kControlPath) {
  const auto address = control_address(path);
  const UniqueFd fd(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (!fd || ::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    throw std::runtime_error("no emulated devices listen on " + path + ": run this inside tools/bench");
  const auto request = line + "\n";
  if (::send(fd.get(), request.data(), request.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(request.size()))
    throw std::runtime_error("the emulated devices do not take a request");
  std::string answer;
  char text[1024];
  while (answer.empty() || answer.back() != '\n') {
    const auto count = ::read(fd.get(), text, sizeof text);
    if (count <= 0) throw std::runtime_error("the emulated devices ended before they answered");
    answer.append(text, static_cast<std::size_t>(count));
  }
  answer.pop_back();
  if (answer.rfind("error: ", 0) == 0) throw std::runtime_error(answer.substr(7));
  return answer.substr(answer.rfind("ok ", 0) == 0 ? 3 : 2);
}

}  // namespace sandhopper::bench
