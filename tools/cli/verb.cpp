#include "tools/cli/verb.hpp"

#include <stdexcept>

namespace sandhopper::cli {
namespace {

Verb& registered() {
  static Verb verb;
  return verb;
}

}  // namespace

VerbRegistration::VerbRegistration(std::string name, std::function<Run(Arguments&)> set_up) {
  registered().name = std::move(name);
  registered().set_up = std::move(set_up);
}

Verb verb_of_this_program() {
  auto verb = registered();
  for (const auto& known : all_verbs())
    if (known.name == verb.name) {
      verb.summary = known.summary;
      return verb;
    }
  throw std::logic_error("tools/cli/verbs.cmake does not list the verb '" + verb.name + "'");
}

}  // namespace sandhopper::cli
