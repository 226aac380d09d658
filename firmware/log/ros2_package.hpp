#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "firmware/log/mcap_reader.hpp"

namespace sandhopper {

// A ROS 2 interface package made from the schemas in a log, file name to content: what `ros2 bag play`, rclpy
// and rosbag2_py need besides the log to make messages of it. Viewers need nothing: the schema travels in the
// file. The package is named after the schemas' own. Throws mcap::Error when the schemas are of several
// packages.
std::map<std::filesystem::path, std::string> ros2_package(const std::vector<mcap::Schema>& schemas);

// Reads the schemas of `log` and writes the package to the folder `into`, which is made.
void write_ros2_package(const std::filesystem::path& log, const std::filesystem::path& into);

}  // namespace sandhopper
