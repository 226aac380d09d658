#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>

namespace sandhopper::transmit {
namespace {

const std::filesystem::path kSource{SANDHOPPER_SOURCE_DIR};

// Collects a file and all files of the project that it includes; system headers only by name.
void collect(const std::filesystem::path& file, std::set<std::string>& seen) {
  static const std::regex include(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::ifstream in(kSource / file);
  for (std::string line; std::getline(in, line);) {
    std::smatch found;
    if (!std::regex_search(line, found, include) || !seen.insert(found[1]).second) continue;
    if (std::filesystem::exists(kSource / found[1].str())) collect(found[1].str(), seen);
  }
}

// The guard is written from the drives' manuals alone. If it used the driver's code, an error there would
// also be in the guard.
TEST(TransmitGuardFolder, ReachesNothingOfTheDriverButItsPort) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kSource / "drivers/transmit_guard")) {
    if (entry.path().extension() != ".hpp" && entry.path().extension() != ".cpp") continue;
    ++files;
    std::set<std::string> included;
    collect(std::filesystem::relative(entry.path(), kSource), included);
    for (const auto& name : included) {
      const bool port = name == "drivers/can/can_port.hpp";
      EXPECT_TRUE(port || !name.starts_with("drivers/can/")) << entry.path() << " reaches " << name;
      EXPECT_FALSE(name.starts_with("firmware/") || name.starts_with("tools/"))
          << entry.path() << ": " << name;
    }
  }
  EXPECT_GE(files, 5);
}

TEST(TransmitGuardFolder, CallsNoNameOfTheDriver) {
  const std::regex names(
      "MitCommand|MitPayload|MitReply|pack_mit|CubeMars|DriveSequence|DriveAction|servo_protocol");
  for (const auto& entry : std::filesystem::directory_iterator(kSource / "drivers/transmit_guard")) {
    if (entry.path().extension() == ".md") continue;
    std::ifstream in(entry.path());
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    EXPECT_FALSE(std::regex_search(text, names)) << entry.path();
  }
}

}  // namespace
}  // namespace sandhopper::transmit
