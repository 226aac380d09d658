#include <algorithm>
#include <fstream>
#include <thread>

#include "config/files.hpp"
#include "tools/cli/experiment.hpp"
#include "tools/cli/output_folder.hpp"
#include "tools/cli/progress.hpp"
#include "tools/experiment/paper/claims/claims.hpp"
#include "tools/experiment/paper/report.hpp"
#include "tools/plant/load_world.hpp"
#include "tools/report/study_text.hpp"

namespace sandhopper::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
  bool quick = false;
  int seeds = 8;
  unsigned threads = std::max(1U, std::thread::hardware_concurrency());
  std::string output = "experiments/paper";
};

paper::ProgrammeSetup programme(Session& session, const Options& options) {
  const auto robot = load_robot(session.config_directory());
  paper::ProgrammeSetup setup;
  setup.cycle = cycle_config(robot);
  setup.world = load_world(session.config_directory(), robot);
  setup.seeds = options.quick ? 1 : options.seeds;
  setup.condition_seeds = options.quick ? 0 : std::min(2, options.seeds);
  setup.threads = options.threads;
  return setup;
}

void write_json(const nlohmann::ordered_json& json, const fs::path& path) {
  std::ofstream file(path);
  file << json.dump(1) << '\n';
  file.close();
  if (!file)
    throw Failure(ExitCode::fault, "cannot write " + path.string(), "check the folder and the free space");
}

void tell(Session& session, const std::vector<paper::Claim>& claims) {
  for (const auto& claim : claims)
    session.say("{:2}  {:20}  {}", claim.number, paper::words(claim.verdict), without_marks(claim.statement));
  session.say("{}", paper::summary(claims));
}

ExitCode run(Session& session, const Options& options) {
  auto setup = programme(session, options);
  const auto folder = made(options.output);
  Progress progress("hops", 1.0);
  setup.progress = [&progress](int done, int total) { progress.at(static_cast<double>(done) / total); };
  const auto results = paper::run_programme(setup);
  const auto claims = paper::claim_table(results);
  const auto page = folder / "paper.html";
  const auto numbers = folder / "paper.json";
  write_study_page(paper::programme_report(results, claims), page);
  session.result = paper::programme_json(results, claims);
  write_json(session.result, numbers);
  session.result["report"] = page.string();
  tell(session, claims);
  session.say("report  {}\nnumbers {}", page.string(), numbers.string());
  return ExitCode::ok;
}

Run set_up(Arguments& arguments) {
  auto options = std::make_shared<Options>();
  arguments.add_option("--seeds", options->seeds, "repetitions of the 75 hops")
      .in_range(1, 1000)
      .show_default();
  arguments.add_flag("--quick", options->quick, "one repetition, and no other conditions");
  arguments.add_option("--threads", options->threads, "default: one a core").in_range(1U, 1024U);
  arguments.add_option("--output", options->output, "folder for paper.html and paper.json").show_default();
  return [options](Session& session) { return run(session, *options); };
}

const ExperimentRegistration kPaper({"paper",
                                     "the programme of arXiv 2604.02563: actuator strokes, 75 hops, three "
                                     "treatments, and a verdict on every claim",
                                     set_up});

}  // namespace
}  // namespace sandhopper::cli
