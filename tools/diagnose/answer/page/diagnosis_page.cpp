#include "tools/diagnose/answer/page/diagnosis_page.hpp"

#include <fmt/format.h>

#include "tools/diagnose/answer/diagnosis_text.hpp"
#include "tools/diagnose/answer/spread_text.hpp"

namespace sandhopper::diagnose {

Study diagnosis_study(const Diagnosis& d, const PageFacts& facts) {
  Study study;
  study.title = "Diagnosis: " + facts.campaign;
  study.facts = {{"plant", facts.plant},
                 {"trials", fmt::format("{}", d.trials)},
                 {"verdict", in_words(name_of(d.verdict, d.detail))},
                 {"simulations", fmt::format("{} in {:.1f} s, {:.0f} a second", d.simulations, d.seconds,
                                             simulations_per_second(d))}};
  if (const auto remarks = facts.findings.size() + d.notes.size(); remarks > 0)
    study.facts.emplace_back("recordings",
                             fmt::format("{} {}, see below", remarks, remarks == 1 ? "remark" : "remarks"));
  const auto limit = limit_text(d);
  study.verdict = headline(d) + (limit.empty() ? "" : " " + limit);
  study.verdict_mark = d.verdict == Verdict::consistent ? (beyond_spread(d).empty() ? "good" : "partly")
                       : is_open(d.verdict)             ? "partly"
                       : d.detail == Detail::known      ? "bad"
                                                        : "partly";
  study.answers = page_answers(d);
  study.sections = page_sections(d, facts);
  return study;
}

void write_diagnosis_page(const Diagnosis& diagnosis, const PageFacts& facts,
                          const std::filesystem::path& path) {
  write_study_page(diagnosis_study(diagnosis, facts), path);
}

}  // namespace sandhopper::diagnose
