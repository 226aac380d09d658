#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "config/edit.hpp"
#include "config/problem.hpp"

namespace sandhopper {
namespace {

constexpr std::string_view kText = R"(# Größe; a comment with [brackets]
[cell]
scale_N_per_V = 100.0            # with weights
zero_V = 0.0  # none
text = "a # b"    # c
mount = [1, 0,   # first row
         0, 1]
[[motor]]
sign = 1
[[motor]]
sign = 1   # the right one
)";

std::string changed(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(ConfigEdit, OneValueChangesAndEveryOtherByteStays) {
  ConfigEditor editor("test", std::string(kText));
  editor.set("cell.scale_N_per_V", "92.5");
  EXPECT_EQ(editor.text(), changed(std::string(kText), "100.0            #", "92.5             #"));
}

TEST(ConfigEdit, ALongerValuePushesItsCommentOnlyWhenItMust) {
  ConfigEditor editor("test", std::string(kText));
  editor.set("cell.zero_V", "-0.0123456");
  EXPECT_EQ(editor.text(), changed(std::string(kText), "0.0  # none", "-0.0123456 # none"));
}

TEST(ConfigEdit, ElementsOfArraysAndOfArraysOfTablesAreReached) {
  ConfigEditor editor("test", std::string(kText));
  editor.set("cell.mount[3]", "-1");
  editor.set("motor[1].sign", "-1");
  auto expected = changed(std::string(kText), "0, 1]", "0, -1]");
  expected = changed(expected, "sign = 1   # the", "sign = -1  # the");
  EXPECT_EQ(editor.text(), expected);
}

TEST(ConfigEdit, QuotedTextIsOneValue) {
  ConfigEditor editor("test", std::string(kText));
  editor.set("cell.text", "\"x\"");
  EXPECT_EQ(editor.text(), changed(std::string(kText), "\"a # b\"    # c", "\"x\"        # c"));
}

TEST(ConfigEdit, AKeyThatIsNotThereIsNamed) {
  ConfigEditor editor("test", std::string(kText));
  EXPECT_THROW(editor.set("cell.gain", "1"), std::invalid_argument);
  EXPECT_THROW(editor.set("motor[2].sign", "1"), std::invalid_argument);
}

TEST(ConfigEdit, ATableIsPutAtTheEndAndReplacedTheNextTime) {
  ConfigEditor editor("test", std::string(kText));
  editor.set_table("calibration.cell", "first", "date = \"a\"\n");
  EXPECT_EQ(editor.text(), std::string(kText) + "\n# first\n[calibration.cell]\ndate = \"a\"\n");
  editor.set_table("calibration.other", "second", "date = \"b\"\n");
  editor.set_table("calibration.cell", "third", "date = \"c\"\npoints = 3\n");
  EXPECT_EQ(editor.text(), std::string(kText) +
                               "\n# third\n[calibration.cell]\ndate = \"c\"\npoints = 3\n"
                               "\n# second\n[calibration.other]\ndate = \"b\"\n");
}

TEST(ConfigEdit, AKeyIsAddedAtTheEndOfItsTableOrInANewOne) {
  ConfigEditor editor("test", "a = 1\n\n[cell]\nb = 2   # two\n# remark\n\n[other]\nc = 3");
  editor.add("cell", "d = 4");
  editor.add("new", "e = 5");
  editor.add("other", "f = 6");
  editor.add("", "g = 7");
  EXPECT_EQ(
      editor.text(),
      "g = 7\na = 1\n\n[cell]\nb = 2   # two\nd = 4\n# remark\n\n[other]\nc = 3\nf = 6\n\n[new]\ne = 5\n");
  EXPECT_TRUE(editor.has("new.e") && !editor.has("cell.e"));
  EXPECT_THROW(editor.add("cell", "d = 8"), ConfigError);
}

TEST(ConfigEdit, ARemarkStandsBeforeTheOneThatIsThere) {
  ConfigEditor editor("test", "b = 2   # two\nc = 3");
  editor.remark("b", "found");
  editor.remark("c", "new");
  EXPECT_EQ(editor.text(), "b = 2   # found; two\nc = 3   # new");
}

TEST(ConfigEdit, AFileIsReplacedThroughItsLinkAndKeepsItsMode) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / "config_edit";
  std::filesystem::create_directories(folder);
  const auto file = folder / "a.toml", link = folder / "b.toml";
  std::filesystem::remove(link);
  std::ofstream(file) << "old";
  ::chmod(file.c_str(), 0640);
  std::filesystem::create_symlink(file, link);
  replace_file(link, "new");
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  EXPECT_EQ(text.str(), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  struct stat state {};
  ::stat(file.c_str(), &state);
  EXPECT_EQ(state.st_mode & 0777U, 0640U);
}

}  // namespace
}  // namespace sandhopper
