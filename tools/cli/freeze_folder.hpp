#pragma once
#include <exception>
#include <string>

#include "config/files.hpp"
#include "config/robot_config.hpp"
#include "tools/cli/session.hpp"

namespace sandhopper::cli {

// log.freeze_folder of the configuration; empty if it cannot be read.
inline std::string configured_freeze_folder(Session& session) {
  try {
    return load_robot(session.config_directory()).log.freeze_folder;
  } catch (const std::exception&) {
    return "";
  }
}

}  // namespace sandhopper::cli
