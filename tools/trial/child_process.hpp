#pragma once
#include <sys/types.h>

#include <cstdio>
#include <string>
#include <vector>

namespace sandhopper {

// A program with its standard input and output in our hands, line by line. Its standard error is ours. It has
// a session of its own: signals of our terminal (Ctrl-C, a lost connection) reach us alone, and we tell it.
class ChildProcess {
 public:
  // Throws std::system_error when it cannot be started.
  explicit ChildProcess(std::vector<std::string> command);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  void write_line(const std::string& line);
  bool read_line(std::string& line);  // false at the end of its output
  // Instead of read_line, for who waits for several things: its output, and what there is of it.
  int output() const;
  bool read_some(std::string& text);  // adds to text; false at the end
  int wait();                         // exit status; 128 + signal when killed

 private:
  pid_t pid_ = -1;
  FILE* to_ = nullptr;
  FILE* from_ = nullptr;
};

}  // namespace sandhopper
