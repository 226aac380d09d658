#pragma once
#include <filesystem>

namespace sandhopper::cli {

// Creates the folder if it does not exist. Throws a Failure that names --output if it cannot.
const std::filesystem::path& made(const std::filesystem::path& folder);

// The folder itself if it does not exist, otherwise its name with _2, _3, …: two runs that start within a
// second get different folders.
std::filesystem::path not_there_yet(const std::filesystem::path& folder);

}  // namespace sandhopper::cli
