#pragma once
#include <functional>

#include "tools/benchmark/process.hpp"
#include "tools/conceal/case.hpp"

// Makes concealed campaigns, runs a tool on each, and records the trial that the tool recommends. Finished
// parts are not repeated, so an interrupted run can be continued.
//
//   FOLDER/campaigns/NNN/          input of the tool
//   FOLDER/answers/NNN.json        hidden from the tool
//   FOLDER/diagnoses/NNN.json      standard output of the tool; NNN.log: standard error,
//                                  NNN.run: run time and exit status
//   FOLDER/after/campaigns/NNN/    if the tool named a class: the campaign with the recommended trial
//   FOLDER/after/diagnoses/NNN.json
//   FOLDER/random/…                the same with a random set-up, as control
namespace sandhopper::benchmark {

// `limit_s`: time limit of the tool per campaign. `jobs`: campaigns in parallel. `follow_up`: also record the
// recommended and a random trial.
struct RunOptions {
  std::filesystem::path folder;
  conceal::Request request;
  std::uint64_t campaigns = 300;
  double limit_s = 30.0;
  unsigned jobs = 1;
  bool follow_up = true;
  std::vector<std::string>
      tool;  // {campaign}: folder of the campaign, {output}: a folder that the tool may write to
};

// Calls `done` after each campaign with the number of finished ones: from any thread, but never concurrently.
void run_benchmark(const RunOptions& options, const std::function<void(std::uint64_t count)>& done);

}  // namespace sandhopper::benchmark
