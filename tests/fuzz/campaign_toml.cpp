// Fuzz target of campaign.toml, which describes recordings of other people.
#include "config/problem.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tools/campaign/campaign.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sandhopper;
  // A trial may name any file. Inputs with a path are skipped, so that the search reads no other files.
  if (fuzz::text_of({data, size}).find("..") != std::string_view::npos) return 0;
  if (fuzz::text_of({data, size}).find("/") != std::string_view::npos) return 0;
  const fuzz::ScratchFile file({data, size}, "campaign.toml");
  try {
    const Campaign campaign = load_campaign(file.folder());
    for (const auto& trial : campaign.trials) static_cast<void>(trial.number("release_height_m"));
  } catch (const ConfigError& error) {
    fuzz::require(!error.problems().empty(), "an error names a problem");
  }
  return 0;
}
