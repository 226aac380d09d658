#include <sys/resource.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "config/files.hpp"
#include "tools/cli/experiment.hpp"
#include "tools/cli/progress.hpp"
#include "tools/experiment/stride_campaign.hpp"
#include "tools/plant/load_world.hpp"

namespace sandhopper::cli {
namespace {

struct Options {
  long strides = 600;
  long seed = 1;
  unsigned threads = std::max(1U, std::thread::hardware_concurrency());
  std::string part = "1/1";
  std::string output;
  std::vector<std::string> files;  // to merge
};

void report(Session& session, const StrideCampaign& campaign) {
  const auto total = campaign.total();
  session.say("{:.0f} strides, {:.0f} without liftoff; k_est/k, k that trial's own bed", total.strides,
              total.incomplete);
  session.say("  {:<10} {:>10} {:>10} {:>14} {:>10} {:>9} {:>7}", "", "mean error", "worst five",
              "mean ratio", "sd", "coverage", "valid");
  auto& ways = session.result["ways"];
  for (std::size_t w = 0; w < kWays; ++w) {
    const auto way = static_cast<Way>(w);
    const auto& sums = total.ways[w];
    if (sums.strides == 0.0) continue;
    const double mean = sums.ratio / sums.strides;
    const double sd = std::sqrt(std::max(0.0, sums.ratio_squared / sums.strides - mean * mean));
    session.say("  {:<10} {:>10.4f} {:>10.4f} {:>14.4f} {:>10.4f} {:>9.3f} {:>7.3f}", kWayNames[w],
                campaign.mean_error(way), campaign.worst_cell_error(way), mean, sd, campaign.coverage(way),
                sums.valid / sums.strides);
    ways[std::string(kWayNames[w])] = {{"mean_error", campaign.mean_error(way)},
                                       {"worst_group_error", campaign.worst_cell_error(way)},
                                       {"mean_ratio", mean},
                                       {"sd_ratio", sd},
                                       {"coverage", campaign.coverage(way)},
                                       {"valid_share", sums.valid / sums.strides}};
  }
  session.result["strides"] = total.strides;
  session.result["incomplete"] = total.incomplete;
  session.result["simulated_s"] = total.simulated_s;
  session.result["cells"] = campaign;
}

void write(Session& session, const std::string& file) {
  if (file.empty()) return;
  std::ofstream out(file);
  out << session.result.dump(1) << "\n";
  out.close();
  if (!out) throw Failure(ExitCode::usage, "cannot write " + file, "name a file in a folder that exists");
  session.say("sums in {}", file);
}

// Parses "2/4" as the second of four parts.
void read_part(const std::string& text, CampaignSetup& setup) {
  char rest = 0;
  if (std::sscanf(text.c_str(), "%ld/%ld%c", &setup.part, &setup.parts, &rest) != 2 || setup.parts < 1 ||
      setup.part < 1 || setup.part > setup.parts)
    throw Failure(ExitCode::usage, "'" + text + "' is not a part",
                  "write I/N with 1 <= I <= N, e.g. --part 2/4 for the second of four");
  --setup.part;
}

ExitCode run(Session& session, const Options& options) {
  const auto robot = load_robot(session.config_directory());
  CampaignSetup setup;
  setup.cycle = cycle_config(robot);
  setup.world = load_world(session.config_directory(), robot);
  setup.strides = options.strides;
  setup.first_seed = options.seed;
  setup.threads = options.threads;
  read_part(options.part, setup);
  Progress progress("hopping", static_cast<double>(options.strides) / 5.0 / static_cast<double>(setup.parts));
  setup.progress = [&](long done, long) { progress.at(static_cast<double>(done)); };
  const auto start = std::chrono::steady_clock::now();
  const auto campaign = run_stride_campaign(setup);
  const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  report(session, campaign);
  const auto total = campaign.total();
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const double cpu_s = static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                       1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
  session.say(
      "{:.1f} s on {} threads: {:.0f} strides/s and {:.0f} x real time per core; peak memory {:.1f} MiB",
      wall_s, options.threads, total.strides / cpu_s, total.simulated_s / cpu_s,
      static_cast<double>(usage.ru_maxrss) / 1024.0);
  session.result["part"] = options.part;
  session.result["wall_s"] = wall_s;
  session.result["cpu_s"] = cpu_s;
  session.result["strides_per_s_per_core"] = total.strides / cpu_s;
  session.result["x_real_time_per_core"] = total.simulated_s / cpu_s;
  session.result["peak_memory_MiB"] = static_cast<double>(usage.ru_maxrss) / 1024.0;
  write(session, options.output);
  return ExitCode::ok;
}

ExitCode merge(Session& session, const Options& options) {
  StrideCampaign campaign;
  for (const auto& file : options.files) {
    std::ifstream in(file);
    if (!in) throw Failure(ExitCode::usage, "cannot read " + file, "name files that --output wrote");
    try {
      campaign.add(nlohmann::ordered_json::parse(in).at("cells").get<StrideCampaign>());
    } catch (const nlohmann::json::exception& error) {
      throw Failure(ExitCode::usage, file + ": " + error.what(),
                    "name files that 'hop experiment strides --output' wrote");
    }
  }
  report(session, campaign);
  write(session, options.output);
  return ExitCode::ok;
}

Run set_up(Arguments& arguments) {
  auto o = std::make_shared<Options>();
  arguments.add_option("--strides", o->strides, "how many, over the 15 cells of the hop set, five at a time")
      .in_range(1L, 100'000'000L)
      .show_default();
  arguments.add_option("--seed", o->seed, "of the first stride").non_negative().show_default();
  arguments.add_option("--threads", o->threads, "default: one a core").in_range(1U, 1024U);
  arguments.add_option("--part", o->part, "only this part of the whole, I/N; merge the parts with --merge")
      .show_default();
  arguments.add_option("--output", o->output, "file for the sums (JSON)");
  arguments.add_option("--merge", o->files, "add up what parts wrote instead of running").type_name("FILES");
  return [o](Session& session) { return o->files.empty() ? run(session, *o) : merge(session, *o); };
}

const ExperimentRegistration kStrides(
    {"strides", "any number of hops against their own bed: how right is each way to a stiffness", set_up});

}  // namespace
}  // namespace sandhopper::cli
