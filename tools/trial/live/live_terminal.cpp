#include "tools/trial/live/live_terminal.hpp"

#include <fcntl.h>
#include <langinfo.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <clocale>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace sandhopper {
namespace {

constexpr ScreenSize kSmallest{20, 60};

// Opens a separate file description, so that writes of other programs do not become non-blocking.
UniqueFd open_output() {
  std::array<char, 256> name{};
  if (::ttyname_r(STDOUT_FILENO, name.data(), name.size()) != 0) std::strcpy(name.data(), "/dev/tty");
  return UniqueFd(::open(name.data(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
}

ScreenSize size_of(int fd) {
  winsize size{};
  if (::ioctl(fd, TIOCGWINSZ, &size) != 0 || size.ws_row == 0 || size.ws_col == 0) return {};
  return {size.ws_row, size.ws_col};
}

// Enter: alternate screen, hidden cursor, bracketed paste. Leave: restore them.
constexpr std::string_view kEnter = "\x1b[?1049h\x1b[?25l\x1b[?2004h\x1b[2J";
constexpr std::string_view kLeave = "\x1b[0m\x1b[?2004l\x1b[?25h\x1b[?1049l";

}  // namespace

bool LiveTerminal::available() {
  const char* term = std::getenv("TERM");
  if (term == nullptr || std::string_view(term) == "dumb" || *term == '\0') return false;
  if (::isatty(STDIN_FILENO) == 0 || ::isatty(STDOUT_FILENO) == 0) return false;
  const auto [rows, columns] = size_of(STDOUT_FILENO);
  return rows >= kSmallest.rows && columns >= kSmallest.columns && static_cast<bool>(open_output());
}

LiveTerminal::LiveTerminal() : out_(open_output()) {
  const char* none = std::getenv("NO_COLOR");
  traits_.colour = none == nullptr || *none == '\0';
  std::setlocale(LC_CTYPE, "");
  traits_.utf8 = std::string_view(::nl_langinfo(CODESET)) == "UTF-8";
  ::tcgetattr(STDIN_FILENO, &before_);
  termios raw = before_;
  // Single keys without echo. Ctrl-C is read as a key, and Ctrl-S cannot stop the screen.
  ::cfmakeraw(&raw);
  raw.c_oflag = before_.c_oflag;
  ::tcsetattr(STDIN_FILENO, TCSANOW, &raw);
  pending_ = kEnter;
  flush();
}

LiveTerminal::~LiveTerminal() {
  constexpr int kPatience_ms = 300;
  pending_ += kLeave;
  for (int i = 0; i < 10 && !pending_.empty(); ++i) {
    pollfd ready{out_.get(), POLLOUT, 0};
    ::poll(&ready, 1, kPatience_ms / 10);
    flush();
  }
  if (!pending_.empty()) ::tcflush(STDOUT_FILENO, TCOFLUSH);
  ::tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

ScreenSize LiveTerminal::size() const { return size_of(out_.get()); }

void LiveTerminal::forget() { shown_ = Canvas({1, 1}); }

void LiveTerminal::show(const Canvas& canvas) {
  if (!ready()) return;
  pending_ = ansi_frame(shown_, canvas, traits_);
  shown_ = canvas;
  flush();
}

void LiveTerminal::flush() {
  while (!pending_.empty()) {
    const auto written = ::write(out_.get(), pending_.data(), pending_.size());
    if (written > 0) {
      pending_.erase(0, static_cast<std::size_t>(written));
      continue;
    }
    if (errno == EINTR) continue;
    if (errno != EAGAIN) pending_.clear();  // the terminal is gone; reading keys reports it, too
    return;
  }
}

bool LiveTerminal::read_keys(std::u32string& keys) {
  std::array<char, 256> bytes{};
  const auto got = ::read(STDIN_FILENO, bytes.data(), bytes.size());
  if (got > 0) keys += decoder_.take({bytes.data(), static_cast<std::size_t>(got)});
  return got > 0 || (got < 0 && (errno == EINTR || errno == EAGAIN));
}

}  // namespace sandhopper
