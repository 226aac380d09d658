#include <unistd.h>

#include <cerrno>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "config/program.hpp"
#include "tools/cli/program.hpp"

// `hop` finds out which verb is meant and replaces itself by that verb's program.
namespace sandhopper::cli {
namespace {

Run become(const std::string& name, char** argv) {
  return [name, argv](Session&) -> ExitCode {
    const auto program = find_program("hop-" + name);
    ::execv(program.c_str(), argv);
    throw std::system_error(errno, std::generic_category(), program.string());
  };
}

// `hop help` is `hop --help`, `hop help VERB…` is `hop VERB… --help`.
std::vector<char*> without_help_verb(int argc, char** argv) {
  static std::string option = "--help";
  std::vector<char*> words(argv, argv + argc);
  if (argc < 2 || std::string_view(argv[1]) != "help") return words;
  words.erase(words.begin() + 1);
  words.push_back(option.data());
  return words;
}

}  // namespace
}  // namespace sandhopper::cli

int main(int argument_count, char** arguments) {
  using namespace sandhopper::cli;
  auto words = without_help_verb(argument_count, arguments);
  const auto argc = static_cast<int>(words.size());
  words.push_back(nullptr);
  char** const argv = words.data();
  auto verbs = all_verbs();
  for (auto& verb : verbs)
    verb.set_up = [name = verb.name, argv](Arguments& arguments) {
      arguments.leave_the_rest();
      return become(name, argv);
    };
  return run_program(verbs, argc, argv);
}
