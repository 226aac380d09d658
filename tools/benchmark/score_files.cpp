#include "tools/benchmark/score_files.hpp"

#include <algorithm>
#include <fstream>

#include "tools/benchmark/baselines.hpp"
#include "tools/conceal/core/plant.hpp"

namespace sandhopper::benchmark {
namespace {

std::vector<std::string> ids_of(const std::string& plant) {
  std::vector<std::string> ids;
  if (const auto* found = conceal::find_plant(plant))
    for (const auto& effect : found->listed()) ids.push_back(effect.id);
  return ids;
}

template <class Tool>
Score score_tool(const std::vector<Truth>& truths, const Tool& tool) {
  std::vector<Judged> cases;
  for (const auto& truth : truths) cases.push_back(judge(truth, tool(truth)));
  return score(std::move(cases));
}

Score score_folder(const std::vector<Truth>& truths, const std::filesystem::path& folder) {
  return score_tool(truths,
                    [&](const Truth& truth) { return read_diagnosis(folder / (truth.name + ".json")); });
}

}  // namespace

std::vector<Column> score_all(const std::vector<Truth>& truths, const std::filesystem::path& diagnoses,
                              const std::vector<std::pair<std::string, std::filesystem::path>>& others) {
  std::vector<Column> columns;
  columns.push_back({"hop diagnose", score_folder(truths, diagnoses)});
  columns.push_back(
      {"null only", score_tool(truths, [](const Truth&) { return std::optional(null_only()); })});
  columns.push_back({"random pick", score_tool(truths, [](const Truth& truth) {
                       return std::optional(random_pick(truth, ids_of(truth.plant)));
                     })});
  for (const char* method : {"largest_correlation", "fit_every_parameter"}) {
    auto name = std::string(method);
    std::replace(name.begin(), name.end(), '_', ' ');
    columns.push_back({name, score_tool(truths, [&](const Truth& truth) {
                         return plainer(read_diagnosis(diagnoses / (truth.name + ".json")), method);
                       })});
  }
  for (const auto& [name, folder] : others) columns.push_back({name, score_folder(truths, folder)});
  return columns;
}

std::vector<Figure> split_figures(const std::vector<Truth>& truths, const std::filesystem::path& diagnoses) {
  const auto root = diagnoses.parent_path();
  if (!std::filesystem::is_directory(root / "random" / "diagnoses")) return {};
  Figure recommended{"the recommended trial splits the class", 0, 0, 0.85, 0.95};
  Figure random{"a random trial splits the class (control)", 0, 0, 0.85, 0.95};
  Figure denied{"no trial would split the class, as told, and a random one does", 0, 0, 0.05, 0.0, true};
  for (const auto& truth : truths) {
    const auto diagnosis = read_diagnosis(diagnoses / (truth.name + ".json"));
    const auto before = judge(truth, diagnosis);
    if (!before.right || before.class_size < 2) continue;
    const auto splits = [&](const char* folder) {
      const auto after = judge(truth, read_diagnosis(root / folder / "diagnoses" / (truth.name + ".json")));
      return after.right && after.class_size < before.class_size;
    };
    if (!diagnosis->asks_for_a_split) {
      ++denied.of;
      denied.count += splits("random");
      continue;
    }
    ++recommended.of;
    ++random.of;
    recommended.count += splits("after");
    random.count += splits("random");
  }
  return {recommended, random, denied};
}

std::vector<double> seconds_taken(const std::vector<Truth>& truths, const std::filesystem::path& diagnoses) {
  std::vector<double> seconds;
  for (const auto& truth : truths) {
    std::ifstream in(diagnoses / (truth.name + ".run"));
    const auto json = nlohmann::json::parse(in, nullptr, false);
    if (json.is_object() && json.contains("seconds")) seconds.push_back(json["seconds"]);
  }
  return seconds;
}

}  // namespace sandhopper::benchmark
