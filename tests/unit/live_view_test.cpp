#include <gtest/gtest.h>

#include <array>

#include "config/dump.hpp"
#include "config/files.hpp"
#include "firmware/fault_check.hpp"
#include "firmware/operator_text.hpp"
#include "tools/trial/live/ansi_frame.hpp"
#include "tools/trial/live/idle_close.hpp"
#include "tools/trial/live/key_decoder.hpp"
#include "tools/trial/live/operator_key.hpp"
#include "tools/trial/live/status_panes.hpp"
#include "tools/trial/live/trial_screen.hpp"

// The live view without a terminal: its response to status lines, keys and window sizes.
namespace sandhopper {
namespace {

// Emulates the terminal functions that ansi_frame uses: cursor position, erase, rendition, characters.
std::vector<std::string> played(const Canvas& before, const std::string& bytes, ScreenSize size) {
  std::vector<std::u32string> screen(static_cast<std::size_t>(size.rows),
                                     std::u32string(static_cast<std::size_t>(size.columns), U' '));
  if (before.size() == size)
    for (int row = 0; row < size.rows; ++row)
      for (int column = 0; column < size.columns; ++column)
        screen[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] =
            before.at(row, column).character;
  std::size_t row = 0, column = 0;
  const auto text = decode_utf8(bytes);
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != U'\x1b') {
      screen.at(row).at(column++) = text[i];
      continue;
    }
    std::string sequence;
    for (i += 2; text[i] < U'@'; ++i) sequence += static_cast<char>(text[i]);
    if (text[i] == U'J')
      for (auto& line : screen) line.assign(line.size(), U' ');
    if (text[i] == U'H') {
      row = std::stoul(sequence) - 1;
      column = std::stoul(sequence.substr(sequence.find(';') + 1)) - 1;
    }
  }
  std::vector<std::string> lines;
  for (const auto& line : screen) {
    lines.emplace_back();
    for (const char32_t c : line) append_utf8(lines.back(), c);
    lines.back().resize(lines.back().find_last_not_of(' ') + 1);
  }
  return lines;
}

std::vector<std::string> rows_of(const Canvas& canvas) {
  std::vector<std::string> rows;
  for (int row = 0; row < canvas.size().rows; ++row) rows.push_back(canvas.row_text(row));
  return rows;
}

bool shows(const Canvas& canvas, std::string_view text) {
  for (const auto& row : rows_of(canvas))
    if (row.find(text) != std::string::npos) return true;
  return false;
}

TrialModel in_state(State state) {
  TrialModel model;
  model.title = "hop trial 1 of 1";
  model.place = "robot";
  model.log = "trials/2026-01-01_12-00-00/trial_001.mcap";
  LiveStatus status;
  status.state = state;
  status.time_ns = 5'000'000'000;
  status.drives_on = state != State::idle && state != State::fault;
  status.estimating = status.drives_on;
  model.take(operator_text("ready", "arm"));
  model.take(operator_text(status));
  return model;
}

StrideResult solved_stride() {
  StrideResult stride;
  stride.summary = {.stride = 1, .touchdown_speed_mps = 0.98, .peak_force_N = 64.4, .max_depth_m = 0.0452};
  stride.joint.value_N_per_m = 1395.0;
  stride.joint.ci95_low_N_per_m = 1268.0;
  stride.joint.ci95_high_N_per_m = 1522.0;
  stride.joint.validity = Validity::valid;
  return stride;
}

TEST(LiveView, AStatusLineIsReadBackAsItWasPublished) {
  LiveStatus sent;
  sent.state = State::compression;
  sent.fault = Fault::imu_stale;
  sent.bus = BusState::passive;
  sent.cycle = 123456789012;
  sent.bed_force_N = 12.345678901234567;
  sent.motor_temperature_C = {25.5, kNotMeasured};
  sent.late_octaves[11] = 7;
  TrialModel model;
  model.take(operator_text(sent));
  ASSERT_TRUE(model.status);
  EXPECT_EQ(model.status->state, sent.state);
  EXPECT_EQ(model.status->fault, sent.fault);
  EXPECT_EQ(model.status->bus, sent.bus);
  EXPECT_EQ(model.status->cycle, sent.cycle);
  EXPECT_EQ(model.status->bed_force_N, sent.bed_force_N);
  EXPECT_EQ(model.status->motor_temperature_C[0], 25.5);
  EXPECT_TRUE(std::isnan(model.status->motor_temperature_C[1])) << "JSON has no NaN";
  EXPECT_EQ(model.status->late_octaves[11], 7U);
}

TEST(LiveView, AStrideThatCouldNotBeSolvedIsStillJson) {
  StrideResult stride = solved_stride();
  stride.joint.value_N_per_m = kNotMeasured;
  stride.joint.validity = Validity::too_few_samples;
  TrialModel model;
  model.take(operator_text(stride));
  ASSERT_EQ(model.strides.size(), 1U);
  EXPECT_FALSE(model.strides[0].joint.valid);
  EXPECT_TRUE(shows(trial_screen(model, {24, 80}), "none: too few samples"));
}

TEST(LiveView, TheLastStridesStiffnessStandsThereWithItsInterval) {
  auto model = in_state(State::flight);
  model.take(operator_text(solved_stride()));
  for (const ScreenSize size : {ScreenSize{24, 80}, ScreenSize{50, 200}})
    EXPECT_TRUE(shows(trial_screen(model, size), "1395  [  1268,   1522] N/m"));
}

StrengthProfile known_to(double depth_m) {
  StrengthProfile profile;
  profile.stride = 1;
  profile.samples = 40;
  profile.depth_min_m = 0.001;
  profile.depth_max_m = depth_m;
  for (std::size_t i = 0; i < kProfilePoints; ++i) {
    profile.force_N[i] = 2.0F * static_cast<float>(i + 1);
    profile.force_sd_N[i] = 1.0F;
  }
  return profile;
}

TEST(LiveView, GroundThatIsNoLineSaysItsShapeAndItsForceInEightyColumns) {
  GroundSummary ground;
  ground.shape = GroundShape::power_law;
  ground.exponent = {1.42, 1.21, 1.63};
  auto model = in_state(State::flight);
  model.take(operator_text(solved_stride()));
  model.take(operator_text(known_to(0.045), ground));
  for (const ScreenSize size : {ScreenSize{24, 80}, ScreenSize{50, 200}}) {
    const auto screen = trial_screen(model, size);
    EXPECT_TRUE(shows(screen, "power law; at 20 mm 32.0 [30.0, 34.0] N"));
    EXPECT_TRUE(shows(screen, "ground known from 1 to 45 mm: no line fits"));
    EXPECT_TRUE(shows(screen, "1.42  [1.21, 1.63]"));
  }
}

TEST(LiveView, AStrideInItsCraterSaysThatAndTheGroundStaysKnown) {
  GroundSummary line;
  line.shape = GroundShape::line;
  line.line_valid = true;
  line.line_N_per_m = {1500.0, 1400.0, 1600.0};
  auto model = in_state(State::flight);
  model.take(operator_text(solved_stride()));
  model.take(operator_text(known_to(0.045), line));
  EXPECT_TRUE(model.strides.back().ground.empty());
  auto second = solved_stride();
  second.summary.stride = 2;
  auto nothing_new = known_to(0.045);
  nothing_new.stride = 2;
  nothing_new.samples = 0;
  model.take(operator_text(second));
  model.take(operator_text(nothing_new, line));
  const auto screen = trial_screen(model, {24, 80});
  EXPECT_TRUE(shows(screen, "in its crater: no new ground"));
  EXPECT_TRUE(shows(screen, "ground known from 1 to 45 mm: a line, 1500 N/m"));
}

TEST(LiveView, OfASearchForEventsOnlyWhatWasFoundIsAMessage) {
  auto model = in_state(State::flight);
  const auto before = model.messages;
  GroundEvents found{.stride = 2};
  model.take(operator_text(found));
  EXPECT_EQ(model.messages, before);
  found.rupture = {GroundEventKind::crust_rupture, 0.0123, 14.2, 0.45, 3.1, 0.4, 20.0, 13.7};
  model.take(operator_text(found));
  ASSERT_EQ(model.messages.size(), before.size() + 1);
  EXPECT_EQ(model.messages.back(),
            "stride 2: a crust broke at 12.3 mm: 14.2 N at 0.45 m/s, size 3.1 +- 0.4 N");
}

TEST(LiveView, AFaultIsShownInFullWithItsCureOnTheSmallestScreen) {
  for (const auto& entry : kFaults) {
    if (entry.fault == Fault::none) continue;
    auto model = in_state(State::fault);
    model.robot = to_node(load_robot(std::filesystem::path(SANDHOPPER_SOURCE_DIR) / "config"));
    Event event{.kind = EventKind::fault_raised, .fault = entry.fault, .values = {1.0, 1.0, 0.0, 0.0}};
    model.take(operator_text(event));
    model.status->fault = model.fault = entry.fault;
    for (int i = 0; i < 5; ++i) model.take(operator_text(solved_stride()));
    std::string text;
    for (const auto& row : rows_of(trial_screen(model, {24, 80}))) text += row + ' ';
    std::string joined;
    for (const char c : text)
      if (c != ' ' || (!joined.empty() && joined.back() != ' ')) joined += c;
    EXPECT_NE(joined.find(entry.meaning), std::string::npos) << entry.name;
    EXPECT_NE(joined.find(entry.cure), std::string::npos) << entry.name << "\n" << text;
    EXPECT_NE(joined.find(in_words(read_fault(event, &model.robot))), std::string::npos) << text;
  }
}

TEST(LiveView, EveryKeyIsOnTheScreenAndOneThatDoesNothingSaysWhy) {
  for (const State state : {State::idle, State::armed, State::flight, State::compression, State::extension,
                            State::soft_stop, State::fault}) {
    const auto model = in_state(state);
    const auto screen = trial_screen(model, {24, 80});
    for (const auto& key : kOperatorKeys) {
      const bool dead = why_not(key.word, model).has_value();
      const auto mark = key.word == "stop" ? std::string("s or space") : std::string(1, key.key);
      EXPECT_TRUE(shows(screen, dead ? "(" + mark + ") " : " " + mark + " "))
          << key.word << " in " << name_of(state);
      if (dead) {
        EXPECT_LE(why_not(key.word, model)->size(), 78U) << "must fit the line";
      }
    }
  }
}

TEST(LiveView, OnlyWhatTheCycleWouldObeyIsOffered) {
  const auto offered = [](State state, bool zero_checked = false) {
    auto model = in_state(state);
    model.zero_checked = zero_checked;
    std::string keys;
    for (const auto& key : kOperatorKeys)
      if (!why_not(key.word, model)) keys += key.key;
    return keys;
  };
  EXPECT_EQ(offered(State::idle), "aq");
  EXPECT_EQ(offered(State::armed), "sdq") << "the zero check runs";
  EXPECT_EQ(offered(State::armed, true), "rsdq");
  EXPECT_EQ(offered(State::flight), "sq") << "disarming would drop it";
  EXPECT_EQ(offered(State::compression), "sq");
  EXPECT_EQ(offered(State::soft_stop), "q");
  EXPECT_EQ(offered(State::fault), "dq");
}

TEST(LiveView, AFrameTurnsWhatTheTerminalShowsIntoTheNewScreen) {
  auto model = in_state(State::idle);
  const auto first = trial_screen(model, {24, 80});
  model = in_state(State::flight);
  model.take(operator_text(solved_stride()));
  const auto second = trial_screen(model, {24, 80});
  const auto frame = ansi_frame(first, second, {});
  EXPECT_EQ(played(first, frame, {24, 80}), rows_of(second));
  EXPECT_LT(frame.size(), 1500U) << "only what changed is sent";
  EXPECT_EQ(ansi_frame(second, second, {}), "");
  const auto wide = trial_screen(model, {50, 200});
  EXPECT_EQ(played(second, ansi_frame(second, wide, {}), {50, 200}), rows_of(wide)) << "after a resize";
}

TEST(LiveView, ATerminalWithoutUtf8GetsAsciiOnly) {
  auto model = in_state(State::flight);
  for (int i = 0; i < 100; ++i) model.history.push_back(*model.status);
  for (const char c :
       ansi_frame(Canvas({1, 1}), trial_screen(model, {50, 200}), {.colour = false, .utf8 = false}))
    ASSERT_LT(static_cast<unsigned char>(c), 0x80);
}

TEST(LiveView, NoColourIsSentWhereNoneIsWanted) {
  auto model = in_state(State::fault);
  model.fault = Fault::imu_stale;
  const auto frame = ansi_frame(Canvas({1, 1}), trial_screen(model, {24, 80}), {.colour = false});
  for (const auto* colour : {"31m", "32m", "33m", "37;41m"}) EXPECT_EQ(frame.find(colour), std::string::npos);
}

TEST(LiveView, ArrowKeysAndPastedTextPressNothing) {
  KeyDecoder keys;
  EXPECT_EQ(keys.take("a\x1b[Ar"), U"ar");
  EXPECT_EQ(keys.take("\x1b[1;5"), U"");
  EXPECT_EQ(keys.take("Dq"), U"q") << "a sequence that came in two parts";
  EXPECT_EQ(keys.take("\x1bOPs"), U"s");
  EXPECT_EQ(keys.take("\x1b[200~arm and release\x1b[201~d"), U"d");
}

TEST(LiveView, SpaceStopsAndControlCQuits) {
  EXPECT_EQ(operator_key(U' ')->word, "stop");
  EXPECT_EQ(operator_key(U'S')->word, "stop");
  EXPECT_EQ(operator_key(char32_t{3})->word, "quit");
  EXPECT_EQ(operator_key(U'x'), nullptr);
}

TEST(LiveView, AnySizeIsDrawn) {
  auto model = in_state(State::flight);
  for (int i = 0; i < 300; ++i)
    model.say("a message that is long enough to be broken into several lines here");
  for (int rows = 1; rows < 60; rows += 7)
    for (int columns = 1; columns < 230; columns += 13)
      EXPECT_EQ(trial_screen(model, {rows, columns}).size(), (ScreenSize{rows, columns}));
}

TEST(LiveView, TheHistogramShowsASingleOutlierBesideAMillion) {
  std::array<std::uint64_t, LatencyHistogram::kOctaves> counts{};
  counts[3] = 1'000'000;
  counts[10] = 1;
  EXPECT_EQ(log_histogram(counts), "   █      ▁ ");
}

TEST(LiveView, ItClosesByItselfAfterTheStatedTimeWithoutAKey) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  IdleClose idle(5.0);
  EXPECT_FALSE(idle.is_due(false, 1 * kSecond_ns));
  EXPECT_FALSE(idle.is_due(true, 2 * kSecond_ns));
  EXPECT_FALSE(idle.is_due(true, 7 * kSecond_ns));
  EXPECT_TRUE(idle.is_due(true, 7 * kSecond_ns + 1));
  idle.key_pressed();
  EXPECT_FALSE(idle.is_due(true, 8 * kSecond_ns));
  EXPECT_TRUE(idle.is_due(true, 14 * kSecond_ns));
  EXPECT_FALSE(idle.is_due(false, 15 * kSecond_ns)) << "armed again";
  EXPECT_FALSE(idle.is_due(true, 16 * kSecond_ns));
  IdleClose never(0.0);
  EXPECT_FALSE(never.is_due(true, 1 * kSecond_ns));
  EXPECT_FALSE(never.is_due(true, 1'000'000 * kSecond_ns));
}

TEST(LiveView, TheHintSaysWhenItClosesByItself) {
  TrialModel model;
  model.ready = model.over = true;
  model.close_after_s = 120.0;
  EXPECT_NE(hint(model).text.find("after 120 s without a key"), std::string::npos) << hint(model).text;
  model.close_after_s = 0.0;
  EXPECT_EQ(hint(model).text.find("closes itself"), std::string::npos) << hint(model).text;
}

}  // namespace
}  // namespace sandhopper
