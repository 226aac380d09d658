#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <memory>
#include <set>

#include "config/dump.hpp"
#include "config/files.hpp"
#include "firmware/freeze/freeze_folders.hpp"
#include "firmware/log/trial_description.hpp"
#include "tests/freeze/folders.hpp"
#include "tools/explain/explain_page.hpp"
#include "tools/explain/explanation.hpp"
#include "tools/faults/run_cell.hpp"

namespace sandhopper {
namespace {

using ::testing::HasSubstr;

// One cell of the fault matrix for each fault; of several the one latest in the hop, because its frame shows
// most.
std::vector<faults::Cell> one_cell_a_fault() {
  std::map<Fault, faults::Cell> cells;
  for (const auto& cell : faults::all_cells()) {
    if (cell.expected == Fault::none || cell.or_else != Fault::none) continue;
    const auto at = cells.find(cell.expected);
    if (at == cells.end() || at->second.phase < cell.phase) cells.insert_or_assign(cell.expected, cell);
  }
  std::vector<faults::Cell> result;
  for (const auto& [fault, cell] : cells) result.push_back(cell);
  return result;
}

// The robot's reaction must be the one of the fault's entry: limp switches the drives off, damp damps first
// if the leg moved, …
void expect_reaction(const Explanation& e, const faults::Cell& cell) {
  const auto& entry = entry_of(e.faults.front().fault);
  ASSERT_FALSE(e.steps.empty());
  const auto& last = e.steps.back();
  if (entry.reaction == Reaction::stop && cell.phase != faults::Phase::idle) {
    // The soft stop takes longer than the second after the fault that the frame shows.
    EXPECT_TRUE(
        std::ranges::any_of(e.steps, [](const auto& step) { return step.state == State::soft_stop; }));
    return;
  }
  EXPECT_EQ(last.state, State::fault);
  if (entry.reaction == Reaction::limp || cell.phase == faults::Phase::idle) {
    EXPECT_EQ(last.drives, "off");
  }
  const auto has = [&](std::string_view drives) {
    return std::ranges::any_of(e.steps, [&](const auto& step) { return step.drives == drives; });
  };
  if (cell.phase == faults::Phase::idle) return;
  if (entry.reaction == Reaction::damp) {
    EXPECT_TRUE(has("damping"));
  }
  if (entry.reaction == Reaction::hold) {
    EXPECT_TRUE(has("hold"));
  }
}

class FreezeOfTheMatrix {
 public:
  explicit FreezeOfTheMatrix(Folders& folders) : folders_(folders) {
    setup_.robot = load_robot(std::filesystem::path(SANDHOPPER_SOURCE_DIR) / "config");
    setup_.folder = folders.root();
    setup_.freeze = [this](const RobotConfig& robot) { return begin(robot); };
  }

  // Runs a cell's trial and returns its freeze frames.
  std::vector<std::filesystem::path> run(const faults::Cell& cell) {
    folders_.told.clear();
    const auto result = faults::run_cell(cell, setup_);
    EXPECT_TRUE(cell.names(result.found)) << cell.name() << " found " << name_of(result.found);
    recorder_->stop();
    recorder_.reset();
    return folders_.told;
  }

 private:
  FreezeRing* begin(const RobotConfig& robot) {
    auto options = folders_.options();
    options.start_ns += ++started_;
    options.newest = 1000;
    options.description.attachments = {
        {std::string(kRobotAttachment), "application/toml", to_toml(to_node(robot))}};
    recorder_ = std::make_unique<FreezeRecorder>(options);
    return recorder_->ring();
  }

  Folders& folders_;
  faults::MatrixSetup setup_;
  std::unique_ptr<FreezeRecorder> recorder_;
  std::int64_t started_ = 0;
};

// SANDHOPPER_FREEZE_PAGES: folder in which the page of each fault is kept.
TEST(FreezeFrames, OneOfEveryFaultTellsFaultValueLimitReactionAndCure) {
  Folders folders;
  FreezeOfTheMatrix matrix(folders);
  const auto cells = one_cell_a_fault();
  const char* pages = std::getenv("SANDHOPPER_FREEZE_PAGES");
  std::set<Fault> seen;
  for (const auto& cell : cells) {
    SCOPED_TRACE(cell.name());
    const auto frames = matrix.run(cell);
    ASSERT_FALSE(frames.empty());
    EXPECT_THAT(frames.front().string(), HasSubstr(std::string(name_of(cell.expected))));
    const Explanation e = explain(read_recording(frames.front()));
    ASSERT_FALSE(e.faults.empty());
    const auto& fault = e.faults.front();
    EXPECT_EQ(fault.fault, cell.expected);
    EXPECT_EQ(fault.time_s, 0.0);
    EXPECT_GE(e.after_s, 0.999);
    EXPECT_LE(e.after_s, 1.001);
    const double since_start_s = 1e-9 * static_cast<double>(read_recording(frames.front()).time_ns) - 0.002;
    EXPECT_GE(e.before_s, std::min(5.0, since_start_s) - 0.06) << "a stall of 50 ms may stand at the start";
    EXPECT_EQ(e.missing_cycles, 0U);
    EXPECT_FALSE(fault.reading.quantity.empty());
    EXPECT_FALSE(fault.reading.limit_text.empty());
    if (!fault.reading.limit_key.empty()) {
      EXPECT_FALSE(fault.reading.limits.empty()) << fault.reading.limit_key;
    }
    expect_reaction(e, cell);
    const auto text = explanation_text(e);
    EXPECT_THAT(text, HasSubstr(std::string(entry_of(cell.expected).cure)));
    EXPECT_THAT(text, HasSubstr(fault.reading.value_text));
    EXPECT_THAT(explanation_page(e), HasSubstr("\"explained\""));
    if (pages != nullptr)
      write_explanation_page(e,
                             std::filesystem::path(pages) / (std::string(name_of(cell.expected)) + ".html"));
    seen.insert(cell.expected);
  }
  for (const auto& entry : kFaults)
    if (entry.fault != Fault::none) {
      EXPECT_TRUE(seen.contains(entry.fault)) << entry.name;
    }
  std::printf("%zu faults, a freeze frame of each\n", seen.size());
}

TEST(FaultChecks, EveryFaultHasItsOwnAndEveryLimitIsAKeyOfTheRobotsFile) {
  const auto robot = to_node(load_robot(std::filesystem::path(SANDHOPPER_SOURCE_DIR) / "config"));
  for (const auto& entry : kFaults) {
    if (entry.fault == Fault::none) continue;
    EXPECT_TRUE(has_check(entry.fault)) << entry.name << ": add a line to firmware/fault_checks.hpp";
    for (std::string_view keys = check_of(entry.fault).limit; !keys.empty();) {
      const auto bar = keys.find('|');
      EXPECT_TRUE(number_at(robot, keys.substr(0, bar))) << keys;
      keys = bar == std::string_view::npos ? std::string_view{} : keys.substr(bar + 1);
    }
  }
}

TEST(FaultChecks, TheLimitIsThatOfTheDeviceThatTheEventNumbers) {
  const auto robot = to_node(load_robot(std::filesystem::path(SANDHOPPER_SOURCE_DIR) / "config"));
  const Event event{
      .kind = EventKind::fault_raised, .fault = Fault::sensor_intermittent, .values = {3.0, 412.0, 0.0, 0.0}};
  const auto reading = read_fault(event, &robot);
  EXPECT_EQ(reading.device, "load cell");
  EXPECT_EQ(reading.value_text, "412 Hz");
  EXPECT_EQ(reading.limit_text, "at least 600 Hz (supervision.load_cell_rate_Hz)");
}

}  // namespace
}  // namespace sandhopper
