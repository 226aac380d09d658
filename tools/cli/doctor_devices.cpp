#include <fmt/format.h>
#include <grp.h>
#include <net/if.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "drivers/device_error.hpp"
#include "drivers/gpio/gpio.hpp"
#include "tools/cli/doctor.hpp"

namespace sandhopper::cli {
namespace {

// Number in a file of /sys/class/net, decimal or hexadecimal; -1 if it does not exist.
long interface_attribute(const std::string& interface, const std::string& attribute) {
  std::ifstream file(fmt::format("/sys/class/net/{}/{}", interface, attribute));
  std::string text;
  return std::getline(file, text) ? std::stol(text, nullptr, 0) : -1;
}

Finding can_interface(const std::string& name) {
  constexpr long kIsCan = 280;  // ARPHRD_CAN
  const bool is_virtual = name.starts_with("v");
  const auto up = is_virtual
                      ? fmt::format("ip link add dev {0} type vcan; ip link set {0} up", name)
                      : fmt::format("ip link set {0} type can bitrate 1000000 && ip link set {0} up", name);
  const auto what = "can.interface " + name;
  if (interface_attribute(name, "type") < 0)
    return {Health::fail, what, "there is no such interface",
            is_virtual
                ? up + "; or use the virtual bench: tools/bench hop doctor"
                : "connect the CAN controller and load its driver; 'ip -br link' lists the interfaces"};
  if (interface_attribute(name, "type") != kIsCan)
    return {Health::fail, what, "is not a CAN interface",
            "correct can.interface; 'ip -br link' lists the interfaces"};
  if ((interface_attribute(name, "flags") & IFF_UP) == 0) return {Health::fail, what, "is down", up};
  return {Health::ok, what, fmt::format("up, queue of {}", interface_attribute(name, "tx_queue_len")), ""};
}

Finding device_node(const std::string& key, const std::string& path, const std::string& when_missing) {
  const auto what = key + " " + path;
  struct stat node {};
  if (::stat(path.c_str(), &node) != 0) return {Health::fail, what, std::strerror(errno), when_missing};
  if (!S_ISCHR(node.st_mode))
    return {Health::fail, what, "is not a device", fmt::format("correct {}; {}", key, when_missing)};
  if (::access(path.c_str(), R_OK | W_OK) == 0) return {Health::ok, what, "there", ""};
  const auto* group = ::getgrgid(node.st_gid);
  return {Health::fail, what, std::strerror(errno),
          fmt::format("run as root, or join the group: usermod -aG {} $USER, and log in again",
                      group ? group->gr_name : std::to_string(node.st_gid).c_str())};
}

// Checks the folder of the kernel's IIO device and reports its chip's name.
Finding iio_device(const std::string& path) {
  const auto what = "load_cell.iio.device " + path;
  std::ifstream file(path + "/name");
  std::string chip;
  if (file >> chip) return {Health::ok, what, chip, ""};
  return {Health::fail, what, "is no IIO device",
          "load the converter's overlay and driver (hx711 or nau7802): cat /sys/bus/iio/devices/*/name"};
}

Finding gpio_line(const std::string& key, const LineConfig& line) {
  const auto what = fmt::format("{} \"{}\"", key, line.line);
  if (!line.fitted()) return {Health::ok, what, "not fitted", ""};
  try {
    const auto user = user_of_gpio_line(key, line);
    if (user.empty()) return {Health::ok, what, "there and free", ""};
    return {Health::fail, what, fmt::format("in use by \"{}\"", user),
            "end that program, or remove its hog from the device tree"};
  } catch (const DeviceError& error) {
    return {Health::fail, what, error.cause(), error.cure()};
  }
}

}  // namespace

std::vector<Finding> examine_devices(const LinuxBoardConfig& board) {
  const std::string spi =
      "enable the SPI controller and its spidev nodes in the device tree; ls /dev/spidev*";
  const std::string i2c = "enable the I2C controller and load i2c-dev: modprobe i2c-dev; ls /dev/i2c-*";
  const std::string serial = "connect the time-of-flight sensor's companion controller; ls /dev/serial/by-id";
  const auto& cell = board.load_cell;
  return {can_interface(board.can.interface),
          device_node("imu_body.device", board.imu_body.device, spi),
          device_node("imu_foot.device", board.imu_foot.device, spi),
          cell.is_iio() && cell.iio ? iio_device(cell.iio->device)
                                    : device_node("load_cell.device", cell.device, i2c),
          device_node("tof.device", board.tof.device, serial),
          gpio_line("imu_body.data_ready", board.imu_body.data_ready),
          gpio_line("imu_foot.data_ready", board.imu_foot.data_ready),
          gpio_line("load_cell.ready", cell.is_iio() ? LineConfig{} : cell.ready),
          gpio_line("estop", board.estop),
          gpio_line("catch", board.body_catch),
          gpio_line("drive_enable", board.drive_enable)};
}

}  // namespace sandhopper::cli
