#pragma once
#include <string>

#include "firmware/log/mcap_reader.hpp"

namespace sandhopper::mcap {

// The file is a log, and some of its bytes are wrong or missing: `hop recover` saves the rest.
class Damaged : public Error {
 public:
  using Error::Error;
};

// Format of a file that is mistaken for a log, with the command that converts it, by its first bytes; empty
// if they show nothing.
std::string other_format_of(Bytes file);

}  // namespace sandhopper::mcap
