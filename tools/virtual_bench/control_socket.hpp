#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "drivers/unique_fd.hpp"
#include "tools/virtual_bench/event_loop.hpp"

namespace sandhopper::bench {

// A stream socket in the file system on which an operator, a script or a test speaks to the devices: one line
// of text asks, one line answers, "ok…" or "error: …".
class ControlSocket {
 public:
  // The words after the command's own, already split at blanks. May throw std::exception to answer an error.
  using Words = std::vector<std::string>;
  using Command = std::function<std::string(const Words& words)>;

  // Throws std::runtime_error.
  ControlSocket(EventLoop& loop, const std::string& path);
  ~ControlSocket();
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;

  void on(const std::string& name, Command command) { commands_[name] = std::move(command); }

 private:
  struct Client {
    UniqueFd fd;
    std::string unread;
  };

  void accept();
  void serve(int fd);
  std::string answer(const std::string& line) const;

  EventLoop& loop_;
  UniqueFd socket_;
  std::map<int, Client> clients_;
  std::map<std::string, Command> commands_;
};

}  // namespace sandhopper::bench
