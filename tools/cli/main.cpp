#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "config/program.hpp"
#include "tools/cli/program.hpp"

// `hop`: finds out which verb is meant and becomes that verb's program.
namespace sandhopper::cli {
namespace {

Run become(const std::string& name, char** argv) {
  return [name, argv](Session&) -> ExitCode {
    const auto program = find_program("hop-" + name);
    ::execv(program.c_str(), argv);
    throw std::system_error(errno, std::generic_category(), program.string());
  };
}

}  // namespace
}  // namespace sandhopper::cli

int main(int argc, char** argv) {
  using namespace sandhopper::cli;
  auto verbs = all_verbs();
  for (auto& verb : verbs)
    verb.set_up = [name = verb.name, argv](Arguments& arguments) {
      arguments.leave_the_rest();
      return become(name, argv);
    };
  return run_program(verbs, argc, argv);
}
