// Plays recorded replies onto a vcan interface with canplayer and reads them with the robot's driver, once a
// millisecond as the cycle does: can_playback FOLDER [INTERFACE]. Every CSV file of the folder is rebuilt to
// frames, written as candump text and played. Exit status 0: all rows read, bit-exact; 1: not; 77: something
// is missing.
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <set>

#include "drivers/can/cubemars_drives.hpp"
#include "drivers/clock.hpp"
#include "firmware/log/candump.hpp"
#include "tests/pendulum_recording.hpp"

namespace sandhopper {
namespace {

constexpr std::int64_t kCycle_ns = 1'000'000;
constexpr int kSkipped = 77;

void write_trace(const std::filesystem::path& path, const std::vector<pendulum::Row>& rows,
                 const char* interface) {
  CandumpWriter writer(path, {.decimals = 6, .direction = false});
  for (const auto& row : rows) {
    CandumpFrame frame;
    frame.time_ns = row.time_ns;
    const auto payload = row.payload();
    frame.length = payload.size();
    std::ranges::copy(payload, frame.data.begin());
    writer.write(frame, interface);
  }
  writer.close();
}

pid_t start_canplayer(std::string trace) {
  std::string program = "canplayer";
  std::string option = "-I";
  std::array<char*, 4> arguments{program.data(), option.data(), trace.data(), nullptr};
  pid_t child = 0;
  if (::posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments.data(), environ) != 0)
    throw std::runtime_error("canplayer cannot be started: install can-utils");
  return child;
}

// Reads as the cycle does, until the player has ended and no frame is left.
std::vector<MotorReading> read_while(pid_t player, CubeMarsDrives& drives) {
  std::vector<MotorReading> readings;
  int status = 0;
  bool playing = true;
  for (int quiet = 0; quiet < 20;) {
    sleep_ns(kCycle_ns);
    const auto before = readings.size();
    drives.drain([&](const MotorReading& reading) { readings.push_back(reading); });
    if (playing) playing = ::waitpid(player, &status, WNOHANG) == 0;
    quiet = playing || readings.size() > before ? 0 : quiet + 1;
  }
  if (status != 0) throw std::runtime_error("canplayer failed");
  return readings;
}

bool play(const std::filesystem::path& file, const char* interface) {
  const auto rows = pendulum::read(file);
  const auto trace = std::filesystem::temp_directory_path() / (file.stem().string() + ".log");
  write_trace(trace, rows, interface);
  auto config = pendulum::drive();
  config.interface = interface;
  CubeMarsDrives drives(config);
  const auto readings = read_while(start_canplayer(trace.string()), drives);
  std::filesystem::remove(trace);
  std::size_t exact = 0;
  for (std::size_t i = 0; i < std::min(rows.size(), readings.size()); ++i)
    exact += rows[i].is_exactly(readings[i].sample) && rows[i].is_near(readings[i].sample);
  std::printf(
      "%s: %zu rows played, %zu read by the driver on %s, %zu bit-exact in order, %u lost in the kernel\n",
      file.stem().c_str(), rows.size(), readings.size(), interface, exact,
      drives.port_counters().receive_overflows);
  return readings.size() == rows.size() && exact == rows.size();
}

int run(const std::filesystem::path& folder, const char* interface) {
  std::set<std::filesystem::path> files;
  if (std::filesystem::is_directory(folder))
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().extension() == ".csv") files.insert(entry.path());
  if (files.empty()) {
    std::printf("*** SKIPPED: no recordings in %s; set SANDHOPPER_SHARED_DATA ***\n", folder.c_str());
    return kSkipped;
  }
  bool good = true;
  for (const auto& file : files) good = play(file, interface) && good;
  return good ? 0 : 1;
}

}  // namespace
}  // namespace sandhopper

int main(int argc, char** argv) {
  try {
    const auto folder = argc > 1 ? std::filesystem::path(argv[1]) : sandhopper::pendulum::folder(".");
    return sandhopper::run(folder, argc > 2 ? argv[2] : "vcan0");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "can_playback: %s\n", error.what());
    return 1;
  }
}
