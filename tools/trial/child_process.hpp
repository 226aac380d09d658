#pragma once
#include <sys/types.h>

#include <cstdio>
#include <string>
#include <vector>

namespace sandhopper {

// A program whose standard input and output this process writes and reads line by line. It shares the
// standard error. It has a session of its own, so signals of the terminal (Ctrl-C, a lost connection) reach
// only this process, which passes them on.
class ChildProcess {
 public:
  // Throws std::system_error if it cannot be started.
  explicit ChildProcess(std::vector<std::string> command);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  void write_line(const std::string& line);
  bool read_line(std::string& line);  // false at the end of its output
  // Alternative to read_line for a caller that waits for several descriptors: its output, and the available
  // part of it.
  int output() const;
  bool read_some(std::string& text);  // appends to `text`; false at the end
  int wait();                         // exit status; 128 + signal if it was killed

 private:
  pid_t pid_ = -1;
  FILE* to_ = nullptr;
  FILE* from_ = nullptr;
};

}  // namespace sandhopper
