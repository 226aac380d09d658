#pragma once
#include <filesystem>

#include "tools/conceal/case.hpp"

namespace sandhopper::conceal {

// Writes FOLDER/campaign.toml, FOLDER/nominal.toml and FOLDER/trials/001.csv …
// (tools/docs/guide/recordings.md). `extra` trials are recorded after those of the case. Throws
// std::runtime_error if a file cannot be written.
void write_campaign(const std::filesystem::path& folder, const Case& c, const std::vector<Setup>& extra = {});

// The answer. It must be stored outside the campaign's folder (README.md).
Json answer(const Case& c, const Request& request, std::uint64_t index);

// Writes `text` to a file. Throws std::runtime_error if that fails.
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace sandhopper::conceal
