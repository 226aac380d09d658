#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/diagnose/evidence/unknown_law.hpp"
#include "tools/diagnose/search.hpp"

namespace sandhopper::diagnose {

// Posterior mass over all hypotheses: every set that was fitted, and an unknown law at a port beside the best
// set or alone.
struct Posterior {
  std::vector<std::size_t> best;               // the set with the largest mass, alone or beside an unknown law
  std::map<std::size_t, double> probability;  // of each effect of the best set or one of its alternatives
  std::map<std::size_t, std::vector<std::size_t>> alternatives;  // that explain as much in its place
  double unknown = 0.0;                        // that something acts that is on no list
  std::map<std::string, double> unknown_port;  // the same, port by port
  std::optional<LawBeside> law;                // the likeliest
  bool alone = false;                          // it is likelier without the best set's names
  double gap_closed = 1.0;                     // by the best set's names alone, of what can be explained
  double share = 0.0;                          // of all that can be explained, what it has
};

// `beside`: sets with an unknown law, fitted.
Posterior posterior(const Problem& problem, const Search& search, const std::vector<LawBeside>& beside);

// The port of a law, as the answer names it.
std::string port_of(const std::string& port, bool sensor);

}  // namespace sandhopper::diagnose
