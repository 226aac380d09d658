#include "tools/diagnose/next/bench_test.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/report/html.hpp"

namespace sandhopper::diagnose {
namespace {

const char* robot_of(PlantKind plant) {
  switch (plant) {
    case PlantKind::falling_body:
      return "body";
    case PlantKind::rotary_axis:
      return "axis";
    case PlantKind::intruder:
      return "rig";
    case PlantKind::hopper:
      break;
  }
  return "robot";
}

const char* foot_of(PlantKind plant) {
  if (plant == PlantKind::hopper) return "foot";
  return plant == PlantKind::intruder ? "plate" : "body";
}

std::string listed(const std::vector<std::string>& names, const char* last) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? fmt::format(" {} ", last) : ", ") + names[i];
  return text;
}

std::string id_of(const std::string& label) { return label.substr(0, label.find('[')); }

}  // namespace

std::string sentence_of(const BenchTest& test, PlantKind plant, const std::string& channel) {
  const auto text = html::replaced(test.sentence, "{robot}", robot_of(plant));
  return html::replaced(html::replaced(text, "{foot}", foot_of(plant)), "{channel}", channel);
}

std::optional<RecommendedBenchTest> bench_test_for(const std::vector<std::string>& names,
                                                   const std::vector<Candidate>& candidates,
                                                   PlantKind plant) {
  for (const auto& name : names) {
    const auto own = std::ranges::find_if(candidates, [&](const Candidate& c) { return c.label() == name; });
    const BenchTest* test = own == candidates.end() ? nullptr : bench_test_of(*own->effect, plant);
    if (test == nullptr) continue;
    std::vector<std::string> distinguished, alike;
    for (const auto& other : names)
      if (other != name)
        (std::ranges::count(test->same_for, id_of(other)) > 0 ? alike : distinguished).push_back(other);
    if (distinguished.empty()) continue;
    RecommendedBenchTest out{test->kind, {}, sentence_of(*test, plant, own->channel)};
    out.order = out.why.substr(0, out.why.find(": "));
    out.why += fmt::format(" It distinguishes {} from {}", name, listed(distinguished, "and"));
    out.why += alike.empty() ? "." : fmt::format(", but not from {}.", listed(alike, "or"));
    return out;
  }
  return std::nullopt;
}

}  // namespace sandhopper::diagnose
