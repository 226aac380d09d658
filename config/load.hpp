#pragma once
#include "config/reader.hpp"

// Strict reading of a TOML file into a struct with `fields` (config/fields.hpp). A file with any error is
// rejected as a whole.
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
// keys. It calls report("key", "expected …, got …"); the key may be nested ("motor[1].can_id"). It is called
// only if every key of the table is valid by itself.
namespace sandhopper {

// Throw ConfigError with all errors. With MissingKeys::use_default a missing key keeps its value in `base`;
// unknown keys remain errors.
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

// `name` is the file's name in messages.
template <HasFields T>
T load_text(std::string name, std::string_view text, MissingKeys missing = MissingKeys::error, T base = {}) {
  return load_document<T>(parse_config_text(std::move(name), text), missing, std::move(base));
}

}  // namespace sandhopper
