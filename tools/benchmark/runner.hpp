#pragma once
#include <functional>

#include "tools/benchmark/process.hpp"
#include "tools/conceal/case.hpp"

// Makes concealed campaigns, has a tool diagnose each, and adds the trial the tool asked for. What is done is
// not done again, so that a run that was stopped goes on where it was.
//
//   FOLDER/campaigns/NNN/          what the tool sees
//   FOLDER/answers/NNN.json        what it must not see
//   FOLDER/diagnoses/NNN.json      its standard output; NNN.log its standard error, NNN.run time and exit
//   status FOLDER/after/campaigns/NNN/    the campaign with the trial it asked for where it named a class;
//   after/diagnoses/ FOLDER/random/…                the same with a set-up drawn at random, as control
namespace sandhopper::benchmark {

struct RunOptions {
  std::filesystem::path folder;
  conceal::Request request;
  std::uint64_t campaigns = 300;
  double limit_s = 30.0;
  unsigned jobs = 1;
  bool follow_up = true;
  std::vector<std::string>
      tool;  // {campaign}: the campaign's folder; {output}: a folder of its own to write to
};

// Calls `done` after each campaign, from any thread but one at a time.
void run_benchmark(const RunOptions& options, const std::function<void(std::uint64_t count)>& done);

}  // namespace sandhopper::benchmark
