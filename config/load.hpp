#pragma once
#include "config/reader.hpp"

// Strict reading of a TOML file into a struct that lists its `fields` (config/fields.hpp). A file that is not
// right in every key is not read at all.
//
//   double, float       a finite number, integer or not, within its Range
//   integers            an integer within its Range and its type
//   bool, std::string   true/false, text
//   NamedEnum           one of its names as text
//   a struct            a table
//   std::array<X, N>    an array of exactly N numbers, texts or tables
//   std::vector<X>      an array of any size
//   std::optional<X>    as X, and may be left out
//
// A struct may also have `template <class Report> void check(Report&& report) const` for rules between its
// keys: it calls report("key", "expected …, got …"), where the key may lie deeper ("motor[1].can_id"). It is
// called when every key of that table is right by itself.
namespace sandhopper {

// Throw ConfigError with everything that is wrong. With MissingKeys::use_default an absent key keeps its
// value in `base`; unknown keys remain errors.
template <HasFields T>
T load_document(const ConfigDocument& document, MissingKeys missing = MissingKeys::error, T base = {}) {
  ConfigReader reader(document.name, missing);
  reader.read(document.root, "", base);
  if (auto problems = reader.take_problems(); !problems.empty()) throw ConfigError(problems);
  return base;
}

template <HasFields T>
T load_file(const std::string& path, MissingKeys missing = MissingKeys::error, T base = {}) {
  return load_document<T>(parse_config_file(path), missing, std::move(base));
}

// `name` stands for the file in messages.
template <HasFields T>
T load_text(std::string name, std::string_view text, MissingKeys missing = MissingKeys::error, T base = {}) {
  return load_document<T>(parse_config_text(std::move(name), text), missing, std::move(base));
}

}  // namespace sandhopper
