#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "config/node.hpp"

namespace sandhopper {

// Changes single values of a TOML text and leaves every other byte, comments and order included, as it is.
class ConfigEditor {
 public:
  // Throws ConfigError where the text is no TOML; `name` stands for the file in messages.
  ConfigEditor(std::string name, std::string text);
  // Throws ConfigError when the file cannot be read.
  static ConfigEditor of_file(const std::filesystem::path& file);

  // `key` with its tables, elements of arrays by number: "motor[1].sign", "imu_body.accel_scale[2]". `value`
  // is TOML. Throws std::invalid_argument where there is no such key.
  void set(std::string_view key, std::string_view value);

  // Puts a table [header] with these lines in place of the one there, or at the end. A comment right above
  // the old header goes with it.
  void set_table(std::string_view header, std::string_view comment, std::string_view lines);

  const std::string& text() const noexcept { return text_; }

 private:
  const ConfigNode* find(std::string_view key) const;
  std::size_t offset_of(ConfigPosition position) const;
  std::size_t end_of_value(std::size_t begin) const;
  void reparse();

  std::string name_;
  std::string text_;
  ConfigNode root_;
};

// Writes the text in one step: a reader sees the old file or the new one, and its mode stays. Throws
// std::system_error.
void replace_file(const std::filesystem::path& file, std::string_view text);

}  // namespace sandhopper
