#include "tools/diagnose/answer/residuals_csv.hpp"

#include <fmt/format.h>

#include <iterator>

namespace sandhopper::diagnose {

std::string residuals_csv(const Diagnosis& diagnosis) {
  std::string text = "trial,channel,phase,t_s,before,after,noise_sd\n";
  for (const auto& r : diagnosis.residuals)
    fmt::format_to(std::back_inserter(text), "{},{},{},{:.6f},{:.6g},{:.6g},{:.6g}\n", r.trial, r.channel,
                   r.phase, r.time_s, r.before, r.after, r.noise_sd);
  return text;
}

}  // namespace sandhopper::diagnose
