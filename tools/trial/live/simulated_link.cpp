#include "tools/trial/live/simulated_link.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "drivers/clock.hpp"
#include "firmware/operator_channel.hpp"
#include "firmware/operator_text.hpp"
#include "tools/plant/sim_board.hpp"

namespace sandhopper {
namespace {

// The trial's own time, from zero, paced by this computer's clock. It shows the thread's wake-up latency, but
// a latency of more than a period counts as just below a period.
class PacedTime : public TimeSource {
 public:
  explicit PacedTime(double speed) : speed_(speed), origin_ns_(monotonic_ns()) {}
  std::int64_t now_ns() noexcept override { return now_ns_; }
  void sleep_until(std::int64_t time_ns) noexcept override {
    const auto due_ns = origin_ns_ + to_ns(static_cast<double>(time_ns) * 1e-9 / speed_);
    if (const auto wait_ns = due_ns - monotonic_ns(); wait_ns > 0) sleep_ns(wait_ns);
    const auto late_ns = std::max<std::int64_t>(0, monotonic_ns() - due_ns);
    if (late_ns > kCyclePeriod_ns) origin_ns_ += late_ns;  // delayed: continue from here without catching up
    now_ns_ = time_ns + std::min(late_ns, kCyclePeriod_ns - 1);
  }

 private:
  double speed_;
  std::int64_t origin_ns_;
  std::int64_t now_ns_ = 0;
};

// Also logs the true values for each cycle.
class WitnessedBoard : public Board {
 public:
  WitnessedBoard(World& world, TrialLogger& logger)
      : world_(world), board_(world), logger_(logger), truth_(logger.add_topic<PlantTruth>(topic::kTruth)) {}
  void read(SensorFrame& frame) noexcept override {
    board_.read(frame);
    time_ns_ = frame.time_ns;
  }
  void write(const Command& command) noexcept override {
    board_.write(command);
    logger_.push(truth_, time_ns_, world_.truth());
  }

 private:
  World& world_;
  SimBoard board_;
  TrialLogger& logger_;
  LogTopic<PlantTruth> truth_;
  std::int64_t time_ns_ = 0;
};

}  // namespace

SimulatedLink::SimulatedLink(const SimTrialSetup& setup, double speed, int status_Hz)
    : news_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (!news_) throw std::system_error(errno, std::generic_category(), "eventfd");
  cycle_ = std::thread([this, setup, speed] {
    try {
      run(setup, speed);
    } catch (const std::exception& error) {
      say(operator_text("error", error.what()));
    }
    cycle_over_ = true;
  });
  teller_ = std::thread([this, status_Hz] { tell_status(status_Hz); });
}

SimulatedLink::~SimulatedLink() {
  quit_ = Quit::at_once;
  cycle_.join();
  teller_.join();
}

// The simulated cycle has its own clock, so it stamps the word when it takes it.
void SimulatedLink::send(std::string_view word) {
  post_words(std::array{word_named(word)}, 0, requests_, quit_);
}

bool SimulatedLink::take(std::vector<std::string>& lines) {
  std::uint64_t count = 0;
  [[maybe_unused]] const auto got = ::read(news_.get(), &count, sizeof count);
  const std::lock_guard lock(mutex_);
  for (auto& line : lines_) lines.push_back(std::move(line));
  lines_.clear();
  return !ended_;
}

void SimulatedLink::say(std::string line) {
  const std::lock_guard lock(mutex_);
  lines_.push_back(std::move(line));
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = ::write(news_.get(), &one, sizeof one);
}

void SimulatedLink::tell_status(int rate_Hz) {
  LiveStatus newest;
  while (!cycle_over_) {
    sleep_ns(kNanosecondsPerSecond / rate_Hz);
    if (status_.take(newest)) say(operator_text(newest));
  }
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = ::write(news_.get(), &one, sizeof one);
}

void SimulatedLink::run(const SimTrialSetup& setup, double speed) {
  auto robot = setup.robot;
  robot.real_time = {.priority = 0, .lock_memory = false, .stack_prefault_kB = 0, .hold_cpu_awake = false};
  TrialLogOptions options;
  options.mcap_file = setup.log;
  options.realtime_offset_ns = setup.realtime_offset_ns;
  TrialLogger logger(options);
  describe_simulated_trial(logger, setup);
  World world(setup.world, setup.trial, 0);
  WitnessedBoard board(world, logger);
  HopSession session(robot, board, logger,
                     {.event = [this](const Event& event) { say(operator_text(event)); },
                      .stride = [this](const StrideResult& result) { say(operator_text(result)); },
                      .profile = [this](const StrengthProfile& profile,
                                        const GroundSummary& ground) { say(operator_text(profile, ground)); },
                      .ground_events = [this](const GroundEvents& found) { say(operator_text(found)); },
                      .request = [this](const RequestRecord& answer) { say(operator_text(answer)); }});
  Heartbeat heart;
  PacedTime time(speed);
  say(operator_text("ready", "arm"));
  auto result = session.run({.quit = quit_,
                             .requests = requests_,
                             .heart = heart,
                             .say = [](const std::string&) {},
                             .time = time,
                             .wall_clock = WallClock([] { return std::int64_t{0}; }),
                             .status = &status_});
  logger.close();
  result.log_error = logger.error();
  say(operator_text(result));
}

}  // namespace sandhopper
