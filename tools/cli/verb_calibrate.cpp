#include <fmt/chrono.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <map>

#include "config/edit.hpp"
#include "config/files.hpp"
#include "tools/calibrate/page.hpp"
#include "tools/calibrate/write.hpp"
#include "tools/cli/calibration.hpp"
#include "tools/cli/output_folder.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/verb.hpp"
#include "tools/plant/load_world.hpp"

namespace sandhopper::cli {
namespace {

namespace fs = std::filesystem;

std::vector<Calibration>& registered() {
  static std::vector<Calibration> all;
  return all;
}

struct Options {
  std::string board = "linux";
  std::string devices;
  std::string sim_devices;
  std::uint64_t seed = 1;
  std::vector<std::string> from;
  std::string output;
  bool dry_run = false;
};

struct Files {
  fs::path robot, board;
  const fs::path& of(calibrate::ConfigFile file) const {
    return file == calibrate::ConfigFile::robot ? robot : board;
  }
};

std::string utc_now() { return fmt::format("{:%Y-%m-%d %H:%M:%S}", fmt::gmtime(std::time(nullptr))); }

fs::path make_folder(const Options& options, const std::string& name) {
  if (!options.output.empty()) return made(options.output);
  return made(not_there_yet(fs::path("calibration") /
                            fmt::format("{:%Y-%m-%d_%H-%M-%S}_{}", fmt::gmtime(std::time(nullptr)), name)));
}

// On the robot a person carries out each prompt and confirms it.
bool asks_a_person(const Options& options) {
  return options.board == "linux" && std::string_view(board_file()) != "bench.toml";
}

void require_terminal() {
  if (::isatty(STDIN_FILENO) == 0)
    throw Failure(ExitCode::usage, "standard input is no terminal, and every recording waits for Enter",
                  "run this in a terminal (ssh -t), or give recordings made before with --from LOG…");
}

void wait_for_enter() {
  for (int c = std::getchar(); c != '\n'; c = std::getchar())
    if (c == EOF) throw Failure(ExitCode::usage, "the terminal has gone", "begin again");
}

std::unique_ptr<calibrate::Recorder> recorder_for(Session& session, const Options& options,
                                                  const calibrate::RecorderSetup& setup) {
  if (options.board == "linux") return calibrate::make_linux_recorder(setup);
  const fs::path real =
      options.sim_devices.empty() ? session.config_directory() : fs::path(options.sim_devices);
  const auto robot = load_robot(real);
  return make_sim_recorder(setup, {.world = load_world(real, robot),
                                   .real_robot = robot,
                                   .real_board = load_linux_board(real / "linux.toml", robot),
                                   .trial = {.seed = options.seed}});
}

std::vector<calibrate::Recording> record(Session& session, const Options& options,
                                         const CalibrationInput& input,
                                         const std::vector<calibrate::Step>& steps, const fs::path& folder) {
  if (asks_a_person(options)) require_terminal();
  std::unique_ptr<Progress> progress;
  const auto recorder = recorder_for(
      session, options, {.robot = input.robot, .board = input.board, .progress = [&](double share) {
                           if (progress) progress->at(share);
                         }});
  std::vector<calibrate::Recording> out;
  for (const auto& step : steps) {
    session.say("{} of {}: {}", out.size() + 1, steps.size(), step.prompt);
    if (asks_a_person(options)) {
      session.say("  then press Enter{}", step.during.empty() ? "" : ", and " + step.during);
      wait_for_enter();
    }
    const auto log = folder / fmt::format("recording_{:02}.mcap", out.size() + 1);
    if (fs::exists(log))
      throw Failure(ExitCode::usage, log.string() + " exists and is not overwritten",
                    "name another folder with --output");
    progress = std::make_unique<Progress>("recording", 1.0);
    out.push_back(recorder->record(step, log));
    progress.reset();
  }
  return out;
}

std::vector<calibrate::Recording> read_all(const Options& options, const CalibrationInput& input,
                                           std::size_t needed) {
  if (options.from.size() != needed)
    throw Failure(ExitCode::usage,
                  fmt::format("--from names {} recordings, {} are needed", options.from.size(), needed),
                  "name one for each step, in the order of the options; --help lists them");
  std::vector<calibrate::Recording> out;
  for (const auto& file : options.from) {
    // The intervals come from the scatter of repeats, so a file must not count twice.
    if (std::ranges::count(options.from, file) > 1)
      throw Failure(ExitCode::usage, file + " is named twice", "a repeat is a recording of its own");
    if (!fs::exists(file))
      throw Failure(ExitCode::usage, file + ": there is no such file", "name logs (.mcap) or tables (.csv)");
    out.push_back(calibrate::read_recording(file, input.board));
  }
  return out;
}

void tell_values(Session& session, const calibrate::Outcome& outcome) {
  auto& values = session.result["values"] = nlohmann::ordered_json::array();
  for (const auto& target : outcome.targets)
    for (const auto& value : target.values) {
      const auto interval = value.ci95 > 0.0 ? fmt::format(" +- {:.2g}", value.ci95) : "";
      session.say("{}: {:.6g} -> {}{} {}", value.key, value.before, value_text(value), interval, value.unit);
      values.push_back({{"key", value.key},
                        {"unit", value.unit},
                        {"before", value.before},
                        {"after", std::stod(value_text(value))},
                        {"ci95_half_width", value.ci95}});
    }
  session.result["points"] = outcome.points;
  session.result["residual_rms"] = outcome.residual_rms;
  session.result["residual_unit"] = outcome.residual_unit;
}

void tell_doubts(Session& session, const calibrate::Outcome& outcome) {
  session.result["notes"] = outcome.notes;
  for (const auto& note : outcome.notes) session.say("note: {}", note);
  auto& refusals = session.result["refusals"] = nlohmann::ordered_json::array();
  for (const auto& refusal : outcome.refusals) {
    session.say("REFUSED ({}): {}\n  -> {}", refusal.reason, refusal.text, refusal.cure);
    refusals.push_back({{"reason", refusal.reason}, {"found", refusal.text}, {"cure", refusal.cure}});
  }
}

// Builds and checks every new text before it changes the first file.
void write_all(Session& session, const calibrate::Outcome& outcome, const Files& files,
               const std::string& date, bool dry_run) {
  std::map<fs::path, std::string> texts;
  for (const auto& target : outcome.targets) {
    const auto& file = files.of(target.file);
    const auto so_far = texts.try_emplace(file, ConfigEditor::of_file(file).text()).first;
    so_far->second = with_calibration(file.string(), so_far->second, outcome, target, date);
  }
  for (const auto& [file, text] : texts) {
    if (!dry_run) replace_file(file, text);
    session.say("{} {}", dry_run ? "dry run, not written:" : "written to", file.string());
    session.result["files"].push_back(file.string());
  }
}

// Checked before the recordings, which may take an hour.
void require_writable(const Files& files) {
  for (const auto& file : {files.robot, files.board})
    if (::access(file.c_str(), W_OK) != 0 || ::access(fs::absolute(file).parent_path().c_str(), W_OK) != 0)
      throw Failure(ExitCode::usage, file.string() + ": you may not change this file or its folder",
                    "use sudo, another configuration with --config, or --dry-run");
}

ExitCode calibrate_one(Session& session, const Options& options, const std::string& name,
                       const Calibration::Actions& actions) {
  const Files files{session.config_file("robot.toml"),
                    options.devices.empty() ? session.config_file(board_file()) : options.devices};
  CalibrationInput input{.robot = load_robot(session.config_directory()), .board = {}};
  input.board = load_linux_board(files.board, input.robot);
  if (actions.prepare) actions.prepare(input);
  const auto steps = actions.steps(input);
  const auto date = utc_now();
  if (!options.dry_run) require_writable(files);
  const bool live = options.from.empty();
  std::vector<calibrate::Recording> recordings;
  fs::path folder;
  if (!live) recordings = read_all(options, input, steps.size());
  folder = make_folder(options, name);
  if (live) recordings = record(session, options, input, steps, folder);
  const auto outcome = actions.fit(recordings, input);
  const auto page = folder / (name + ".html");
  write_study_page(page_of(outcome, name, date), page);
  session.result["calibration"] = name;
  session.result["date"] = date;
  tell_values(session, outcome);
  tell_doubts(session, outcome);
  session.say("plots {}", page.string());
  session.result["page"] = page.string();
  session.result["dry_run"] = options.dry_run;
  const bool good = outcome.refusals.empty();
  session.result["ok"] = good;
  session.result["files"] = nlohmann::ordered_json::array();
  if (!good) {
    session.say("the configuration was left as it is");
    return ExitCode::no;
  }
  write_all(session, outcome, files, date, options.dry_run);
  return ExitCode::ok;
}

void add_options(Arguments& arguments, Options& options) {
  arguments.add_option("--from", options.from,
                       "recordings made before, one a step: logs (.mcap) or tables (.csv)");
  arguments
      .add_option("--board", options.board,
                  "whose devices are recorded: linux, this machine's; sim, simulated ones")
      .one_of({"linux", "sim"})
      .show_default();
  arguments.add_option(
      "--devices", options.devices,
      "device file that is read and written; default linux.toml, inside tools/bench bench.toml");
  arguments.add_option(
      "--sim-devices", options.sim_devices,
      "configuration directory that says what the simulated devices really are; default: as believed");
  arguments.add_option("--seed", options.seed, "of the simulated devices").show_default();
  arguments.add_option("--output", options.output,
                       "folder for recordings and plots; default calibration/DATE_NAME");
  arguments.add_flag("--dry-run", options.dry_run, "fit and show, but write no configuration");
}

Run set_up(Arguments& arguments) {
  auto options = std::make_shared<Options>();
  arguments.require_verb();
  arguments.footer(
      "Exit status: 0 written (or fitted, with --dry-run), 1 the fit was refused and nothing was written.");
  std::vector<std::tuple<Arguments, std::string, Calibration::Actions>> choices;
  for (const auto& calibration : known_calibrations()) {
    auto sub = arguments.add_verb(calibration.name, calibration.summary);
    choices.emplace_back(sub, calibration.name, calibration.set_up(sub));
    add_options(sub, *options);
  }
  return [options, choices](Session& session) {
    for (const auto& [sub, name, actions] : choices)
      if (sub.parsed()) return calibrate_one(session, *options, name, actions);
    return ExitCode::usage;
  };
}

const VerbRegistration kCalibrate("calibrate", set_up);

}  // namespace

CalibrationRegistration::CalibrationRegistration(Calibration calibration) {
  registered().push_back(std::move(calibration));
}

void add_seconds(Arguments& arguments, double& seconds) {
  arguments.add_option("--seconds", seconds, "of each recording").in_range(1.0, 60.0).show_default();
}

void add_gravity(Arguments& arguments, double& gravity_mps2, const std::string& help) {
  arguments.add_option("--gravity-mps2", gravity_mps2, help).in_range(9.7, 9.9).show_default();
}

std::vector<Calibration> known_calibrations() {
  auto all = registered();
  std::ranges::sort(all, {}, &Calibration::name);
  return all;
}

}  // namespace sandhopper::cli
