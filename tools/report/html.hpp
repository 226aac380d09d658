#pragma once
#include <filesystem>
#include <string>
#include <string_view>

// Functions that assemble a page.
namespace sandhopper::html {

// Replaces every `what` in `text`.
std::string replaced(std::string_view text, std::string_view what, std::string_view with);
// Escapes the characters that have a meaning in HTML.
std::string escaped(std::string_view text);
// Escapes JSON so that it may stand inside a script element.
std::string embedded_json(std::string_view json);
// Throws std::runtime_error with path and cause if the file cannot be written.
void write(const std::string& page, const std::filesystem::path& path);

}  // namespace sandhopper::html
