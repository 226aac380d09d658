#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/diagnose/model/effect.hpp"

namespace sandhopper::diagnose {

// A test for names that no trial within reach tells apart.
struct RecommendedBenchTest {
  std::string kind;   // kind of trial; empty: the test is no recording
  std::string order;  // "Weigh the body on a balance"
  std::string why;    // The test's sentence, which begins with `order`, and the names for which it decides.
};

// Chooses among the tests of `names` (labels of candidates, the found effect first): of the first one whose
// test shows at least one of the others in another way. None if there is no such test.
std::optional<RecommendedBenchTest> bench_test_for(const std::vector<std::string>& names,
                                                   const std::vector<Candidate>& candidates, PlantKind plant);

// Sentence of a test, with the words of this plant and channel in place of {robot}, {foot}, {channel}.
std::string sentence_of(const BenchTest& test, PlantKind plant, const std::string& channel);

}  // namespace sandhopper::diagnose
