#pragma once
#include <termios.h>

#include <string>

#include "drivers/unique_fd.hpp"
#include "tools/trial/live/ansi_frame.hpp"
#include "tools/trial/live/key_decoder.hpp"

namespace sandhopper {

// Uses the terminal of standard input and output as a full screen with single keys, until the object is
// destroyed. Writing never waits: a stopped terminal or a slow connection gets fewer frames, and the
// operator's loop continues. (Curses would wait for the terminal in the middle of a frame.)
class LiveTerminal {
 public:
  // True if there is a terminal that can show a screen.
  static bool available();

  LiveTerminal();
  ~LiveTerminal();
  LiveTerminal(const LiveTerminal&) = delete;
  LiveTerminal& operator=(const LiveTerminal&) = delete;

  ScreenSize size() const;
  // True if the last frame was sent completely; frames shown before that are skipped.
  bool ready() const { return pending_.empty(); }
  void show(const Canvas& canvas);
  // Sends as much as the terminal accepts now.
  void flush();
  int output() const { return out_.get(); }
  // Call it after the screen was changed from outside (a resize): the next frame draws everything.
  void forget();

  // False if the terminal is gone.
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
