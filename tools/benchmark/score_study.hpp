#pragma once
#include "tools/benchmark/score_files.hpp"
#include "tools/report/study.hpp"

namespace sandhopper::benchmark {

// The benchmark's report as a page: targets and baselines, reliability, results by size, results by effect,
// every case.
Study score_study(const std::vector<Column>& columns, const std::vector<Figure>& splits,
                  const std::vector<double>& seconds);

// The figures as text for a terminal.
std::vector<std::string> score_text(const std::vector<Column>& columns, const std::vector<Figure>& splits,
                                    const std::vector<double>& seconds);

}  // namespace sandhopper::benchmark
