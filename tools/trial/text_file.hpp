#pragma once
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace sandhopper {

// Writes a text file. Throws if the disk does not accept all of it.
inline void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file);
  out << text;
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace sandhopper
