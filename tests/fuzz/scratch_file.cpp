#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/fuzz/fuzz.hpp"

namespace sandhopper::fuzz {

ScratchFile::ScratchFile(Input input, const char* name) {
  const std::filesystem::path memory = "/dev/shm";
  const auto parent = ::access(memory.c_str(), W_OK) == 0 ? memory : std::filesystem::temp_directory_path();
  folder_ = parent / ("sandhopper_fuzz_" + std::to_string(::getpid()));
  path_ = std::filesystem::path(folder_) / name;
  std::filesystem::create_directories(folder_);
  std::ofstream(path_, std::ios::binary) << text_of(input);
}

ScratchFile::~ScratchFile() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

}  // namespace sandhopper::fuzz
