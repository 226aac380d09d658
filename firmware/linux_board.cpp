#include "firmware/linux_board.hpp"

#include <exception>
#include <string>

#include "drivers/adc/load_cell_source.hpp"
#include "drivers/can/can_socket.hpp"
#include "drivers/can/cubemars_drives.hpp"
#include "drivers/clock.hpp"
#include "drivers/device_error.hpp"
#include "drivers/gpio/gpio.hpp"
#include "drivers/imu/imu_reader.hpp"
#include "drivers/latest.hpp"
#include "drivers/tof/afbr_s50.hpp"
#include "drivers/transmit_guard/guarded_port.hpp"
#include "firmware/acquisition_thread.hpp"
#include "firmware/drive_enable.hpp"
#include "firmware/transmit_limits.hpp"

namespace sandhopper {

struct LinuxBoardDevices {
  std::unique_ptr<GpioEdges> estop;
  std::unique_ptr<GpioOutput> body_catch;
  std::unique_ptr<GpioOutput> drive_enable_line;
  std::unique_ptr<DriveEnable> drive_enable;
  std::unique_ptr<ImuReader> imu_body;
  std::unique_ptr<ImuReader> imu_foot;
  std::unique_ptr<LoadCellSource> load_cell;
  std::unique_ptr<AfbrS50> tof;
  std::unique_ptr<CubeMarsDrives> drives;
  GuardedPort* guard = nullptr;  // owned by `drives`
};

struct LinuxBoard::Acquisition {
  Latest<ImuSample> imu_body;
  Latest<ImuSample> imu_foot;
  Latest<LoadCellSample> load_cell;
  Latest<TofSample> tof;
  // Last, so that the threads end before the members that they write to are destroyed.
  std::vector<std::unique_ptr<AcquisitionThread>> threads;
};

namespace {

// Wait from power-on to a drive's first answer. No manual states it.
constexpr std::int64_t kDriveBoot_ns = 2'000'000'000;

// Opens the devices one after another and collects the errors, so that one start shows all of them.
class Opening {
 public:
  template <class Device, class... Args>
  void open(const char* name, std::unique_ptr<Device>& device, const Args&... args) {
    attempt(name, [&] { device = std::make_unique<Device>(args...); });
  }

  template <class Action>
  void attempt(const char* name, Action&& action) {
    reports_.push_back({name, ""});
    try {
      action();
    } catch (const std::exception& error) {
      reports_.back().problem = error.what();
    }
  }

  const std::vector<DeviceReport>& reports() const { return reports_; }

 private:
  std::vector<DeviceReport> reports_;
};

// Open this before the drives: without their supply they do not answer.
void open_drive_enable(Opening& opening, const LineConfig& config, LinuxBoardDevices& d) {
  opening.open("drive_enable", d.drive_enable_line, "drive_enable", config, true);
  if (d.drive_enable_line == nullptr) return;
  auto& line = *d.drive_enable_line;
  d.drive_enable = std::make_unique<DriveEnable>([&line](bool active) { return line.set(active); });
  sleep_ns(kDriveBoot_ns);
}

// The driver reaches the bus only through the transmit guard.
void open_drives(const LinuxBoardConfig& config, LinuxBoardDevices& d) {
  auto socket = std::make_unique<CanSocket>(config.can.interface, CubeMarsBus(config.can).filters());
  auto guard = std::make_unique<GuardedPort>(std::move(socket), transmit_limits(config.can, config.limits));
  d.guard = guard.get();
  d.drives = std::make_unique<CubeMarsDrives>(config.can, std::move(guard));
}

std::vector<DeviceReport> open_all(const LinuxBoardConfig& config, LinuxBoardDevices& d, CanTap* tap) {
  Opening opening;
  opening.open("estop", d.estop, "estop", config.estop);
  if (config.body_catch.fitted()) opening.open("catch", d.body_catch, "catch", config.body_catch, true);
  if (config.drive_enable.fitted()) open_drive_enable(opening, config.drive_enable, d);
  opening.open("imu_body", d.imu_body, "imu_body", config.imu_body);
  opening.open("imu_foot", d.imu_foot, "imu_foot", config.imu_foot);
  opening.attempt("load_cell", [&] { d.load_cell = open_load_cell(config.load_cell); });
  opening.open("tof", d.tof, config.tof);
  opening.attempt("can", [&] { open_drives(config, d); });
  if (d.drives) {
    d.drives->set_tap(tap);
    opening.attempt("motors", [&] { d.drives->probe(); });
  }
  return opening.reports();
}

template <class Reader, class Sample>
std::unique_ptr<AcquisitionThread> acquire(const char* name, int priority, Reader& reader,
                                           Latest<Sample>& latest) {
  return std::make_unique<AcquisitionThread>(AcquisitionThread::Setup{name, priority}, [&reader, &latest] {
    Sample sample;
    if (reader.acquire(sample)) latest.publish(sample);
  });
}

template <class Sample>
void take(Latest<Sample>& latest, Sample& sample) noexcept {
  sample.fresh = false;
  latest.take(sample);
}

LinuxBoardStatus::SlowBus counted(const DeviceCounters& counters) noexcept {
  return {counters.failed_transfers, counters.missed_edges, counters.invalid};
}

}  // namespace

LinuxBoard::LinuxBoard(const LinuxBoardConfig& config, CanTap* tap)
    : devices_(std::make_unique<LinuxBoardDevices>()), acquisition_(std::make_unique<Acquisition>()) {
  std::string problems;
  for (const auto& report : open_all(config, *devices_, tap))
    if (!report.problem.empty()) problems += "\n  " + report.problem;
  if (!problems.empty())
    throw DeviceError("Linux board", "cannot start, and nothing was energised" + problems + "\n",
                      "Put right what is named above, or name other devices in the board's file");
  auto& d = *devices_;
  auto& a = *acquisition_;
  a.threads.push_back(acquire("imu_body", config.imu_body.thread_priority, *d.imu_body, a.imu_body));
  a.threads.push_back(acquire("imu_foot", config.imu_foot.thread_priority, *d.imu_foot, a.imu_foot));
  a.threads.push_back(acquire("load_cell", config.load_cell.thread_priority, *d.load_cell, a.load_cell));
  a.threads.push_back(acquire("tof", config.tof.thread_priority, *d.tof, a.tof));
}

LinuxBoard::~LinuxBoard() { shut_down(); }

void LinuxBoard::cut_supply() noexcept {
  if (devices_->drive_enable) devices_->drive_enable->drop();
}

// The relay opens at the same delay as in the cycle. After that frames are sent until the drives confirm or
// time is up.
std::string LinuxBoard::shut_down() {
  if (shut_down_) return *shut_down_;
  shut_down_.emplace();
  auto& drives = *devices_->drives;
  constexpr std::int64_t kFirst_ns = CubeMarsDrives::kLeaveOverdue * std::int64_t{1'000'000};
  bool off = drives.shut_down(kFirst_ns);
  if (!off) cut_supply();
  off = off || drives.shut_down(CubeMarsDrives::kShutDown_ns - kFirst_ns);
  if (off) return *shut_down_;
  for (std::size_t i = 0; i < drives.bus().motor_count(); ++i) {
    const auto side = static_cast<Side>(i);
    if (!drives.may_be_on(side)) continue;
    *shut_down_ += (shut_down_->empty() ? "" : ", ") + drives.bus().codec(side).config().name;
  }
  if (shut_down_->empty()) *shut_down_ = "unknown";  // all confirmed, but a sent frame may still leave
  return *shut_down_;
}

void LinuxBoard::read(SensorFrame& frame) noexcept {
  auto& d = *devices_;
  auto& a = *acquisition_;
  for (auto& motor : frame.motor) motor.fresh = false;
  d.drives->drain([&](const MotorReading& reading) {
    frame.motor[static_cast<std::size_t>(reading.side)] = reading.sample;
  });
  take(a.imu_body, frame.imu_body);
  take(a.imu_foot, frame.imu_foot);
  take(a.load_cell, frame.load_cell);
  take(a.tof, frame.tof);
  frame.bus = d.drives->bus_sample();
  frame.bus.refused = d.guard->refused();
  // A short press that ends before this read leaves an edge. If the edge was lost the level shows the press.
  const bool pressed = d.estop->wait(0).has_value();
  frame.emergency_stop = emergency_stop_ = d.estop->active() || pressed;
}

void LinuxBoard::write(const Command& command) noexcept {
  const bool tripped = heart_ != nullptr && heart_->tripped();
  const auto now_ns = monotonic_ns();
  devices_->guard->begin(
      {.now_ns = now_ns, .allowance = allowance_of(latched_), .emergency_stop = emergency_stop_});
  devices_->drives->command(command.motor, tripped ? DriveRequest::off : command.drive, now_ns);
  if (tripped || devices_->drives->leave_overdue()) cut_supply();
  if (devices_->body_catch) devices_->body_catch->set(!command.open_catch);
}

LinuxBoardStatus LinuxBoard::status() const noexcept {
  const auto& d = *devices_;
  LinuxBoardStatus out;
  out.can = d.drives->port_counters();
  for (std::size_t i = 0; i < kMotorCount; ++i) out.motor[i] = d.drives->bus().counters(static_cast<Side>(i));
  out.imu_body = counted(d.imu_body->counters());
  out.imu_foot = counted(d.imu_foot->counters());
  out.load_cell = counted(d.load_cell->counters());
  out.tof = counted(d.tof->counters());
  return out;
}

std::vector<DeviceReport> examine_devices(const LinuxBoardConfig& config) {
  LinuxBoardDevices devices;
  return open_all(config, devices, nullptr);
}

}  // namespace sandhopper
