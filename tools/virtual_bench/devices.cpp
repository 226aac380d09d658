#include "tools/virtual_bench/devices.hpp"

#include <charconv>
#include <map>
#include <stdexcept>

#include "config/json.hpp"
#include "config/load.hpp"
#include "drivers/clock.hpp"
#include "tools/plant/bed_truth.hpp"

namespace sandhopper::bench {
namespace {

std::string node_name(const std::string& path) {
  constexpr std::string_view kFolder = "/dev/";
  if (!path.starts_with(kFolder))
    throw std::runtime_error(path + ": the bench makes device nodes under /dev only");
  return path.substr(kFolder.size());
}

// "seed=3" -> 3.
template <class T>
bool take(const std::string& word, std::string_view name, T& value) {
  if (!word.starts_with(std::string(name) + "=")) return false;
  const char* const begin = word.data() + name.size() + 1;
  const char* const end = word.data() + word.size();
  if (const auto read = std::from_chars(begin, end, value); read.ec != std::errc{} || read.ptr != end)
    throw std::invalid_argument("'" + word + "' is not " + std::string(name) + "=NUMBER");
  return true;
}

bool take_switch(const std::string& word, const std::string& name, bool& value) {
  if (word != name + "=on" && word != name + "=off") return false;
  value = word == name + "=on";
  return true;
}

TrialSetup with(TrialSetup setup, const ControlSocket::Words& words) {
  for (const auto& word : words)
    if (!take(word, "seed", setup.seed) && !take(word, "height", setup.release_height_m) &&
        !take_switch(word, "noise", setup.noise) && !take_switch(word, "bed_memory", setup.bed_memory))
      throw std::invalid_argument("'" + word + "'; known: seed=N height=M noise=on|off bed_memory=on|off");
  return setup;
}

// "load_N=9.81": the keys of Fixture, those left out as they are by default.
Fixture fixture_of(const ControlSocket::Words& words) {
  std::string lines;
  for (const auto& word : words) lines += word + "\n";
  return load_text<Fixture>("hold", lines, MissingKeys::use_default);
}

std::string only(const ControlSocket::Words& words, const std::string& choices) {
  if (words.size() != 1) throw std::invalid_argument("expected one of: " + choices);
  return words[0];
}

}  // namespace

Devices::Devices(EventLoop& loop, BenchWorld& world, const LinuxBoardConfig& board,
                 const DeviceOptions& options)
    : loop_(loop),
      world_(world),
      board_(board),
      gpio_(loop, {board.imu_body.data_ready, board.imu_foot.data_ready, board.load_cell.ready, board.estop,
                   board.body_catch}),
      imu_body_({loop, gpio_.line(board.imu_body.data_ready)}, board.imu_body,
                world.config().sensors.imu_rate_Hz),
      imu_foot_({loop, gpio_.line(board.imu_foot.data_ready)}, board.imu_foot,
                world.config().sensors.imu_rate_Hz),
      load_cell_({loop, gpio_.line(board.load_cell.ready)}, board.load_cell,
                 world.config().sensors.load_cell_rate_Hz),
      tof_(loop, board.tof, world.config().sensors.tof_rate_Hz),
      imu_body_node_(loop, node_name(board.imu_body.device), imu_body_),
      imu_foot_node_(loop, node_name(board.imu_foot.device), imu_foot_),
      load_cell_node_(loop, node_name(board.load_cell.device)),
      can_(loop, board.can.interface),
      control_(loop, options.control_path) {
  load_cell_node_.connect(board.load_cell.address, load_cell_);
  connect_sensors();
  connect_drives(options.drive_timeout_s);
  connect_control();
  press_emergency_stop(false);
  gpio_.line(board_.body_catch).drive(!board_.body_catch.active_low);  // holds while nobody drives it
  world_.on_reset = [this] { catch_holds_ = false; };
}

// A device has a sample ready `latency_s` of its own configuration after the instant of measurement: the age
// that the firmware subtracts again.
void Devices::connect_sensors() {
  const auto connect = [](auto& outlet, auto& device, double latency_s) {
    outlet.delay_ns = to_ns(latency_s);
    outlet.complete = [&device](const auto& sample) { device.complete(sample); };
  };
  connect(world_.imu_body, imu_body_, board_.imu_body.latency_s);
  connect(world_.imu_foot, imu_foot_, board_.imu_foot.latency_s);
  connect(world_.tof, tof_, board_.tof.latency_s);
  connect(world_.load_cell, load_cell_, board_.load_cell.latency_s);
}

void Devices::connect_drives(double drive_timeout_s) {
  // Before the drives: what one cycle does to catch and drives is seen in one go.
  can_.connect([this](const can_frame&) { look_at_catch(); });
  for (std::size_t i = 0; i < static_cast<std::size_t>(board_.can.motor_count); ++i) {
    drives_.push_back(
        std::make_unique<DriveNode>(DriveNode::Place{loop_, world_, can_, to_ns(drive_timeout_s)},
                                    static_cast<Side>(i), board_.can.motor[i]));
    can_.connect([drive = drives_.back().get()](const can_frame& frame) { drive->receive(frame); });
  }
}

void Devices::press_emergency_stop(bool pressed) {
  gpio_.line(board_.estop).drive(pressed != board_.estop.active_low);
}

void Devices::look_at_catch() {
  if (!board_.body_catch.fitted() || world_.released()) return;
  const bool holds = gpio_.line(board_.body_catch).high() != board_.body_catch.active_low;
  if (catch_holds_ && !holds) world_.now().open_catch();
  catch_holds_ = holds;
}

void Devices::connect_control() {
  control_.on("reset", [this](const auto& words) {
    world_.reset(with(world_.setup(), words));
    return "ok start_ns=" + std::to_string(world_.now().now_ns());
  });
  control_.on("estop", [this](const auto& words) {
    const auto what = only(words, "press release");
    if (what != "press" && what != "release") throw std::invalid_argument("expected one of: press release");
    press_emergency_stop(what == "press");
    return std::string("ok");
  });
  control_.on("catch", [this](const auto& words) {
    if (only(words, "open") != "open") throw std::invalid_argument("expected: open");
    world_.now().open_catch();
    return std::string("ok");
  });
  control_.on("hold", [this](const auto& words) {
    world_.now().hold(fixture_of(words));
    return std::string("ok");
  });
  control_.on("truth", [this](const auto&) { return "ok " + to_json(world_.now().truth()).dump(); });
  control_.on("bed", [this](const auto&) { return "ok " + bed_truth_text(world_.now().plant().bed()); });
}

}  // namespace sandhopper::bench
