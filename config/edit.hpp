#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "config/node.hpp"

namespace sandhopper {

// Changes single values of a TOML text and leaves every other byte unchanged, including comments and order.
class ConfigEditor {
 public:
  // Throws ConfigError if the text is not valid TOML. `name` is the file's name in messages.
  ConfigEditor(std::string name, std::string text);
  // Throws ConfigError if the file cannot be read.
  static ConfigEditor of_file(const std::filesystem::path& file);

  // Sets the value of a key. `key` includes its tables and array indices: "motor[1].sign",
  // "imu_body.accel_scale[2]". `value` is TOML. Throws std::invalid_argument if there is no such key.
  void set(std::string_view key, std::string_view value);

  // Adds `key = value` as the last line of a table, or a new table with it at the end. Empty `table`: the top
  // of the file. Throws ConfigError if the text then is no TOML.
  void add(std::string_view table, std::string_view line);

  // Writes a remark behind the value of a key, before a remark that stands there already. Throws
  // std::invalid_argument if there is no such key.
  void remark(std::string_view key, std::string_view text);

  bool has(std::string_view key) const { return find(key) != nullptr; }

  // Replaces the table [header] by these lines, or appends it. A comment directly above the old header is
  // also replaced.
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

// Replaces the file atomically: a reader sees the old file or the new one. The mode is kept. Throws
// std::system_error.
void replace_file(const std::filesystem::path& file, std::string_view text);

}  // namespace sandhopper
