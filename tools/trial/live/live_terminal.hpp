#pragma once
#include <termios.h>

#include <string>

#include "drivers/unique_fd.hpp"
#include "tools/trial/live/ansi_frame.hpp"
#include "tools/trial/live/key_decoder.hpp"

namespace sandhopper {

// The terminal of standard input and output, as a screen of its own with single keys, until the object goes.
// Writing never waits: a terminal that is stopped, or a connection that is slow, gets fewer frames, and the
// operator's loop goes on. (Curses would wait for the terminal in the middle of a frame.)
class LiveTerminal {
 public:
  // Whether there is one, good enough for a screen.
  static bool available();

  LiveTerminal();
  ~LiveTerminal();
  LiveTerminal(const LiveTerminal&) = delete;
  LiveTerminal& operator=(const LiveTerminal&) = delete;

  ScreenSize size() const;
  // Whether the last frame is out; a frame shown before that is left out.
  bool ready() const { return pending_.empty(); }
  void show(const Canvas& canvas);
  // Sends what the terminal takes now.
  void flush();
  int output() const { return out_.get(); }
  // The screen was changed by others (a resize): the next frame draws all of it.
  void forget();

  // False: the terminal is gone.
  bool read_keys(std::u32string& keys);

 private:
  TerminalTraits traits_;
  UniqueFd out_;
  termios before_{};
  KeyDecoder decoder_;
  Canvas shown_{{1, 1}};
  std::string pending_;
};

}  // namespace sandhopper
