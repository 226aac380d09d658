#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "firmware/log/mcap_reader.hpp"

namespace sandhopper {

// Files of a ROS 2 interface package (name to content) made from the schemas in a log. `ros2 bag play`, rclpy
// and rosbag2_py need it, besides the log, to construct messages. Viewers do not need it, because the log
// contains the schema. The package name is taken from the schemas. Throws mcap::Error if the schemas belong
// to several packages.
std::map<std::filesystem::path, std::string> ros2_package(const std::vector<mcap::Schema>& schemas);

// Reads the schemas of `log` and writes the package into the folder `into`, which is created.
void write_ros2_package(const std::filesystem::path& log, const std::filesystem::path& into);

}  // namespace sandhopper
