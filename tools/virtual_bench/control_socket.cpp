#include "tools/virtual_bench/control_socket.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <sstream>
#include <stdexcept>

#include "tools/virtual_bench/control_client.hpp"

namespace sandhopper::bench {

ControlSocket::ControlSocket(EventLoop& loop, const std::string& path)
    : loop_(loop), socket_(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
  const auto address = control_address(path);
  ::unlink(path.c_str());
  if (!socket_ || ::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(socket_.get(), 8) != 0)
    throw std::runtime_error(path + " cannot be made: does its folder exist?");
  loop_.watch(socket_.get(), [this] { accept(); });
}

ControlSocket::~ControlSocket() {
  loop_.forget(socket_.get());
  for (const auto& [fd, client] : clients_) loop_.forget(fd);
}

void ControlSocket::accept() {
  UniqueFd fd(::accept4(socket_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (!fd) return;
  const int number = fd.get();
  clients_[number] = {std::move(fd), {}};
  loop_.watch(number, [this, number] { serve(number); });
}

void ControlSocket::serve(int fd) {
  char text[512];
  const auto count = ::read(fd, text, sizeof text);
  if (count <= 0) {
    loop_.forget(fd);
    clients_.erase(fd);
    return;
  }
  auto& unread = clients_.at(fd).unread;
  unread.append(text, static_cast<std::size_t>(count));
  for (auto end = unread.find('\n'); end != std::string::npos; end = unread.find('\n')) {
    const auto reply = answer(unread.substr(0, end)) + "\n";
    unread.erase(0, end + 1);
    [[maybe_unused]] const auto written = ::send(fd, reply.data(), reply.size(), MSG_NOSIGNAL);
  }
}

std::string ControlSocket::answer(const std::string& line) const {
  std::istringstream in(line);
  std::string name;
  in >> name;
  Words words;
  for (std::string word; in >> word;) words.push_back(word);
  const auto command = commands_.find(name);
  if (command == commands_.end()) {
    std::string known;
    for (const auto& [known_name, unused] : commands_) known += " " + known_name;
    return "error: unknown command '" + name + "'; known:" + known;
  }
  try {
    return command->second(words);
  } catch (const std::exception& error) {
    return std::string("error: ") + error.what();
  }
}

}  // namespace sandhopper::bench
