#include "tools/benchmark/figures.hpp"

#include <cmath>

namespace sandhopper::benchmark {
namespace {

void add(Figure& figure, bool counted) {
  ++figure.of;
  figure.count += counted;
}

bool typical(const Truth& truth) {
  return truth.kind == "single" && truth.effects.size() == 1 && truth.effects[0].size >= kTypicalFrom &&
         truth.effects[0].size <= kTypicalTo;
}

std::vector<Figure> section_6(const std::vector<Judged>& cases) {
  Figure alarms{"false alarms, nothing missing", 0, 0, 0.05, 0.01, true};
  Figure named{"right name or class, one effect of typical size", 0, 0, 0.90, 0.97};
  Figure wrong{"confident wrong name, all campaigns", 0, 0, 0.03, 0.01, true};
  Figure unknown{"outside the list: unknown at the right port", 0, 0, 0.80, 0.90};
  Figure exact{"exact set, two or three effects", 0, 0, 0.75, 0.90};
  Figure alike{"indistinguishable: class holds the truth", 0, 0, 0.90, 0.97};
  Figure floor{"held-out error within 1.2 of the floor, solved", 0, 0, 0.90, 0.90};
  Figure intervals{"95 % intervals that hold the truth", 0, 0, 0.90, 0.94};
  // Hidden effects that were called absent with a bound below their size: none is allowed.
  Figure bounds{"upper bounds of absent effects that hold", 0, 0, 1.0, 1.0};
  for (const auto& j : cases) {
    const auto& truth = *j.truth;
    add(wrong, j.confident_wrong);
    if (truth.nothing_hidden()) add(alarms, j.alarm);
    if (typical(truth)) add(named, j.right);
    if (truth.unknown_port) add(unknown, j.unknown_at_port);
    if (truth.kind == "several") add(exact, j.exact);
    if (truth.kind == "indistinguishable") add(alike, j.right);
    if (j.heldout_over_floor) add(floor, *j.heldout_over_floor <= 1.2);
    intervals.of += j.intervals;
    intervals.count += j.intervals_hold;
    bounds.of += j.bounded;
    bounds.count += j.bounds_hold;
  }
  return {alarms, named, wrong, unknown, exact, alike, floor, intervals, bounds};
}

void grade(Score& s) {
  for (int i = 0; i < 10; ++i) s.reliability.push_back({0.1 * i, 0.1 * (i + 1)});
  for (const auto& j : s.cases)
    for (const auto& graded : j.graded) {
      auto& bin = s.reliability[std::min<std::size_t>(
          9, static_cast<std::size_t>(std::max(0.0, graded.probability) * 10.0))];
      ++bin.count;
      ++s.names_claimed;
      bin.right += graded.right;
      bin.probability_sum += graded.probability;
    }
  for (const auto& bin : s.reliability)
    s.expected_calibration_error += std::abs(static_cast<double>(bin.right) - bin.probability_sum);
  if (s.names_claimed) s.expected_calibration_error /= static_cast<double>(s.names_claimed);
}

void climb(Score& s) {
  s.ladder = {{0.1, 0.25}, {0.25, 0.5}, {0.5, 1.0}, {1.0, 2.0}, {2.0, 3.0001}};
  for (const auto& j : s.cases) {
    if (j.truth->kind != "single" || j.truth->effects.size() != 1) continue;
    for (auto& step : s.ladder) {
      if (j.truth->effects[0].size < step.from || j.truth->effects[0].size >= step.to) continue;
      ++step.cases;
      step.noticed += j.alarm;
      step.right += j.right;
      step.confident_wrong += j.confident_wrong;
    }
  }
}

void sort_by_effect(Score& s) {
  for (const auto& j : s.cases) {
    if (j.truth->kind != "single" || j.truth->effects.size() != 1) continue;
    auto& fate = s.by_effect[j.truth->effects[0].id];
    ++fate.cases;
    if (!j.answered)
      ++fate.no_answer;
    else if (j.right)
      ++(j.class_size == 1 ? fate.right_alone : fate.right_in_class);
    else if (j.insufficient)
      ++fate.too_little;
    else if (!j.alarm)
      ++fate.nothing;
    else if (j.unknown_flagged)
      ++fate.unknown;
    else
      ++fate.other_names[j.said.substr(j.said.find(' ') + 1)];
  }
}

}  // namespace

nlohmann::ordered_json to_json(const Figure& f) {
  const auto wilson = wilson95(f.count, f.of), exact = clopper_pearson95(f.count, f.of);
  return {{"figure", f.name},
          {"value", f.of ? nlohmann::ordered_json(f.value()) : nlohmann::ordered_json()},
          {"count", f.count},
          {"of", f.of},
          {"wilson95", {wilson.low, wilson.high}},
          {"clopper_pearson95", {exact.low, exact.high}},
          {"must", f.must},
          {"aim", f.aim},
          {"less_is_better", f.less_is_better},
          {"met", f.met()}};
}

Score score(std::vector<Judged> cases) {
  Score s;
  s.cases = std::move(cases);
  s.figures = section_6(s.cases);
  std::size_t right = 0, sizes = 0;
  for (const auto& j : s.cases) {
    if (typical(*j.truth) && j.right) ++right, sizes += j.class_size;
    if (typical(*j.truth))
      add(s.right_by_plant.try_emplace(j.truth->plant, Figure{j.truth->plant, 0, 0, 0.9, 0.97}).first->second,
          j.right);
    s.intervals_without_counterpart += j.intervals_without_counterpart;
    if (j.localisation) {
      s.localisation += *j.localisation;
      s.localisation_by_plant[j.truth->plant] += *j.localisation;
    }
  }
  if (right) s.mean_class_size = static_cast<double>(sizes) / static_cast<double>(right);
  grade(s);
  climb(s);
  sort_by_effect(s);
  return s;
}

nlohmann::ordered_json to_json(const Score& s) {
  nlohmann::ordered_json json;
  for (const auto& figure : s.figures) json["figures"].push_back(to_json(figure));
  json["mean_class_size"] = s.mean_class_size;
  json["expected_calibration_error"] = s.expected_calibration_error;
  json["intervals_without_counterpart"] = s.intervals_without_counterpart;
  json["localisation"] = to_json(s.localisation);
  json["localisation"]["must"] = Localisation::kMust;
  json["localisation"]["aim"] = Localisation::kAim;
  json["localisation"]["met"] = s.localisation.met();
  for (const auto& [plant, localisation] : s.localisation_by_plant)
    json["localisation"]["by_plant"][plant] = to_json(localisation);
  for (const auto& bin : s.reliability)
    if (bin.count)
      json["reliability"].push_back(
          {{"from", bin.from},
           {"to", bin.to},
           {"count", bin.count},
           {"mean_probability", bin.probability_sum / static_cast<double>(bin.count)},
           {"share_right", static_cast<double>(bin.right) / static_cast<double>(bin.count)}});
  for (const auto& step : s.ladder)
    json["size_ladder"].push_back({{"from", step.from},
                                   {"to", step.to},
                                   {"cases", step.cases},
                                   {"noticed", step.noticed},
                                   {"right", step.right},
                                   {"confident_wrong", step.confident_wrong}});
  for (const auto& [id, fate] : s.by_effect)
    json["by_effect"][id] = {{"cases", fate.cases},
                             {"right_alone", fate.right_alone},
                             {"right_in_class", fate.right_in_class},
                             {"unknown", fate.unknown},
                             {"nothing_missing", fate.nothing},
                             {"insufficient", fate.too_little},
                             {"no_answer", fate.no_answer},
                             {"other_names", fate.other_names}};
  for (const auto& j : s.cases) {
    nlohmann::ordered_json hidden = nlohmann::ordered_json::array();
    for (const auto& effect : j.truth->effects)
      hidden.push_back({{"id", effect.id}, {"size_relative", effect.size}});
    json["cases"].push_back(
        {{"campaign", j.truth->name},
         {"plant", j.truth->plant},
         {"kind", j.truth->kind},
         {"hidden", hidden},
         {"visibility", j.truth->visibility},
         {"said", j.said},
         {"localisation", j.localisation ? to_json(*j.localisation) : nlohmann::ordered_json()},
         {"right", passed(j)},
         {"confident_wrong", j.confident_wrong}});
  }
  return json;
}

}  // namespace sandhopper::benchmark
