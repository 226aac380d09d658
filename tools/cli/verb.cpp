#include "tools/cli/verb.hpp"

#include <algorithm>

namespace sandhopper::cli {
namespace {

std::vector<Verb>& registry() {
  static std::vector<Verb> verbs;
  return verbs;
}

}  // namespace

VerbRegistration::VerbRegistration(Verb verb) { registry().push_back(std::move(verb)); }

std::vector<Verb> known_verbs() {
  auto verbs = registry();
  std::sort(verbs.begin(), verbs.end(), [](const Verb& a, const Verb& b) { return a.name < b.name; });
  return verbs;
}

}  // namespace sandhopper::cli
