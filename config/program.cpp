#include "config/program.hpp"

#include <stdexcept>

namespace sandhopper {

std::filesystem::path find_program(const std::string& name) {
  namespace fs = std::filesystem;
  const auto here = fs::read_symlink("/proc/self/exe").parent_path();
  // Relative to bin/ and to libexec/sandhopper/.
  for (const auto* folder : {".", "../libexec/sandhopper", "../../bin"}) {
    const auto program = (here / folder / name).lexically_normal();
    if (fs::exists(program)) return program;
  }
  throw std::runtime_error(name + " is not in " + here.string() + ": build it with 'tools/build " + name +
                           "', or install the package sandhopper again");
}

}  // namespace sandhopper
