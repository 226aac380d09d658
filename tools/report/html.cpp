#include "tools/report/html.hpp"

#include <fstream>
#include <stdexcept>

namespace sandhopper::html {

std::string replaced(std::string_view text, std::string_view what, std::string_view with) {
  std::string result;
  while (true) {
    const std::size_t at = text.find(what);
    result += text.substr(0, at);
    if (at == std::string_view::npos) return result;
    result += with;
    text.remove_prefix(at + what.size());
  }
}

std::string escaped(std::string_view text) { return replaced(replaced(text, "&", "&amp;"), "<", "&lt;"); }

// A "<" in the data could end the script element that carries them.
std::string embedded_json(std::string_view json) { return replaced(json, "<", "\\u003c"); }

void write(const std::string& page, const std::filesystem::path& path) {
  std::ofstream file(path, std::ios::binary);
  file << page;
  file.flush();
  if (!file)
    throw std::runtime_error("cannot write the report " + path.string() +
                             "; is the folder there and writable?");
}

}  // namespace sandhopper::html
