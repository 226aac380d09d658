#include "firmware/log/ros2_package.hpp"

#include <fstream>
#include <sstream>

namespace sandhopper {
namespace {

std::string package_of(std::string_view type) { return std::string(type.substr(0, type.find('/'))); }
std::string name_of_type(std::string_view type) { return std::string(type.substr(type.rfind('/') + 1)); }

std::string manifest(const std::string& package) {
  return "<?xml version=\"1.0\"?>\n<package format=\"3\">\n  <name>" + package +
         "</name>\n"
         "  <version>0.0.0</version>\n"
         "  <description>Messages of a log, from the schemas in it</description>\n"
         "  <maintainer email=\"unknown@example.org\">unknown</maintainer>\n"
         "  <license>not stated</license>\n"
         "  <buildtool_depend>ament_cmake</buildtool_depend>\n"
         "  <buildtool_depend>rosidl_default_generators</buildtool_depend>\n"
         "  <exec_depend>rosidl_default_runtime</exec_depend>\n"
         "  <member_of_group>rosidl_interface_packages</member_of_group>\n"
         "  <export><build_type>ament_cmake</build_type></export>\n"
         "</package>\n";
}

std::string build_file(const std::string& package) {
  return "cmake_minimum_required(VERSION 3.16)\nproject(" + package +
         ")\n"
         "find_package(ament_cmake REQUIRED)\n"
         "find_package(rosidl_default_generators REQUIRED)\n"
         "file(GLOB messages RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} msg/*.msg)\n"
         "rosidl_generate_interfaces(${PROJECT_NAME} ${messages})\n"
         "ament_package()\n";
}

}  // namespace

std::map<std::filesystem::path, std::string> ros2_package(const std::vector<mcap::Schema>& schemas) {
  std::map<std::filesystem::path, std::string> files;
  std::string package;
  const auto message_file = [&](const std::string& type) -> std::string& {
    if (package.empty()) package = package_of(type);
    if (package_of(type) != package)
      throw mcap::Error("the log has types of the packages " + package + " and " + package_of(type) +
                        "; one package at a time can be made");
    std::string& text = files["msg/" + name_of_type(type) + ".msg"];
    text.clear();
    return text;
  };
  for (const mcap::Schema& schema : schemas) {
    std::string* text = &message_file(schema.name);
    std::istringstream lines(schema.text);
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("====")) continue;
      if (line.starts_with("MSG: ")) {
        text = &message_file(line.substr(5));
      } else {
        *text += line + '\n';
      }
    }
  }
  files["package.xml"] = manifest(package);
  files["CMakeLists.txt"] = build_file(package);
  return files;
}

void write_ros2_package(const std::filesystem::path& log, const std::filesystem::path& into) {
  std::vector<mcap::Schema> schemas;
  mcap::Reader reader(log);
  mcap::Message message;
  while (reader.next(message)) {
  }
  for (const auto& [number, channel] : reader.channels()) schemas.push_back(channel.schema);
  std::filesystem::create_directories(into / "msg");
  for (const auto& [name, text] : ros2_package(schemas)) {
    std::ofstream out(into / name);
    if (!(out << text)) throw mcap::Error((into / name).string() + ": cannot be written");
  }
}

}  // namespace sandhopper
