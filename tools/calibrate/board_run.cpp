#include "tools/calibrate/board_run.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>

#include "drivers/clock.hpp"
#include "firmware/cycle.hpp"
#include "firmware/log/trial_description.hpp"

namespace sandhopper::calibrate {
namespace {

constexpr double kSettle_s = 0.05;

TrialLogOptions log_options(const BoardRun& run, const std::filesystem::path& log) {
  TrialLogOptions options;
  options.mcap_file = log;
  options.start_ns = run.time.now_ns();
  options.realtime_offset_ns = realtime_offset_ns();
  options.own_thread = run.board_name == "linux";
  return options;
}

class FrameLog {
 public:
  FrameLog(const BoardRun& run, const Step& step, const std::filesystem::path& log)
      : logger_(log_options(run, log)), frames_(logger_.add_topic<SensorFrame>(topic::kFrame)) {
    describe_trial(logger_, run.setup.robot, run.board_name);
    describe_devices(logger_, run.setup.board);
    logger_.add_metadata("calibration", {{"asked", step.prompt}});
    logger_.start();
  }
  void push(const SensorFrame& frame) { logger_.push(frames_, frame.time_ns, frame); }
  void close() {
    logger_.stop();
    logger_.close();
    if (!logger_.error().empty()) throw std::runtime_error(logger_.error());
  }

 private:
  TrialLogger logger_;
  LogTopic<SensorFrame> frames_;
};

Command command_at(const Step& step, double time_s) {
  Command command;
  if (!step.torque_Nm) return command;
  command.drive = time_s < 0.0 ? DriveRequest::enable : DriveRequest::run;
  const auto torque_Nm = step.torque_Nm(std::max(0.0, time_s));
  for (std::size_t i = 0; i < kMotorCount; ++i) command.motor[i].torque_Nm = torque_Nm[i];
  return command;
}

// Reason why the step must end; empty: it may go on.
std::string reason_to_end(const Step& step, const SensorFrame& frame, Heartbeat* heart) {
  if (heart != nullptr && heart->take_trip() != 0)
    return "this program stood still and the watchdog took the torque away; end other programs and begin "
           "again";
  if (frame.emergency_stop && step.torque_Nm) return "the e-stop is pressed; release it and begin again";
  if (step.torque_Nm)
    for (const auto& motor : frame.motor)
      if (motor.fresh && std::abs(motor.velocity_radps) > kFastest_radps)
        return "a motor moves under torque; clamp body and foot, check its sign with `hop calibrate "
               "encoders`, and "
               "begin again";
  return {};
}

}  // namespace

Recording run_board(const BoardRun& run, const Step& step, const std::filesystem::path& log) {
  std::optional<FrameLog> written;
  if (!log.empty()) written.emplace(run, step, log);
  CycleClock clock(kCyclePeriod_ns, run.time);
  SensorFrame frame;
  Recording out;
  out.name = log.filename().string();
  std::string trouble;
  std::int64_t begin_ns = 0;
  while (trouble.empty()) {
    frame.time_ns = clock.wait();
    frame.cycle = clock.cycle();
    if (begin_ns == 0) begin_ns = frame.time_ns;
    if (run.heart != nullptr) run.heart->beat(State::idle, Fault::none);
    const double time_s = static_cast<double>(frame.time_ns - begin_ns) * 1e-9 - kSettle_s;
    if (time_s > step.seconds) break;
    run.board.read(frame);
    trouble = reason_to_end(step, frame, run.heart);
    run.board.write(trouble.empty() ? command_at(step, time_s) : Command{});
    if (time_s < 0.0) continue;
    if (out.begin_ns == 0) out.begin_ns = frame.time_ns;
    out.add(frame);
    if (written) written->push(frame);
    if (run.setup.progress && frame.cycle % 64 == 0) run.setup.progress(time_s / step.seconds);
  }
  run.board.write(Command{});
  if (run.heart != nullptr) run.heart->end();
  if (written) written->close();
  if (!trouble.empty()) throw std::runtime_error(trouble);
  return out;
}

}  // namespace sandhopper::calibrate
