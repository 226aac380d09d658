#pragma once
#include <filesystem>

namespace sandhopper::cli {

// The folder, made where it is not there; a `Failure` that names --output where it cannot be.
const std::filesystem::path& made(const std::filesystem::path& folder);

// Of that name, or with _2, _3, … where it is there already: two runs that begin within a second get a folder
// each.
std::filesystem::path not_there_yet(const std::filesystem::path& folder);

}  // namespace sandhopper::cli
