#include "config/edit.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "config/problem.hpp"
#include "drivers/unique_fd.hpp"

namespace sandhopper {
namespace {

// "motor[1].sign" -> "motor", "[1]", "sign".
std::string_view take_step(std::string_view& key) {
  if (key.starts_with('.')) key.remove_prefix(1);
  const auto end = key.find_first_of(".[", 1);
  const auto step = key.substr(0, end);
  key.remove_prefix(step.size());
  return step;
}

const ConfigNode* element(const ConfigNode& array, std::string_view step) {
  std::size_t index = 0;
  std::from_chars(step.data() + 1, step.data() + step.size(), index);
  return array.kind == ConfigNode::Kind::array && index < array.children.size() ? &array.children[index]
                                                                                : nullptr;
}

// Start of the line that contains `at`.
std::size_t line_begin(std::string_view text, std::size_t at) {
  const auto before = at == 0 ? std::string_view::npos : text.rfind('\n', at - 1);
  return before == std::string_view::npos ? 0 : before + 1;
}

std::size_t line_end(std::string_view text, std::size_t at) {
  const auto end = text.find('\n', at);
  return end == std::string_view::npos ? text.size() : end + 1;
}

bool is_comment(std::string_view line) {
  const auto first = line.find_first_not_of(" \t");
  return first != std::string_view::npos && line[first] == '#';
}

}  // namespace

ConfigEditor::ConfigEditor(std::string name, std::string text)
    : name_(std::move(name)), text_(std::move(text)) {
  reparse();
}

ConfigEditor ConfigEditor::of_file(const std::filesystem::path& file) {
  parse_config_file(file.string());  // reports the error of a file that cannot be read
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return {file.string(), text.str()};
}

void ConfigEditor::reparse() { root_ = parse_config_text(name_, text_).root; }

const ConfigNode* ConfigEditor::find(std::string_view key) const {
  const ConfigNode* node = &root_;
  while (node != nullptr && !key.empty()) {
    const auto step = take_step(key);
    node = step.starts_with('[') ? element(*node, step) : node->find(step);
  }
  return node;
}

// Columns count characters of UTF-8, not bytes.
std::size_t ConfigEditor::offset_of(ConfigPosition position) const {
  std::size_t at = 0;
  for (std::uint32_t line = 1; line < position.line; ++line) at = line_end(text_, at);
  for (std::uint32_t column = 1; column < position.column; ++column) do
      ++at;
    while (at < text_.size() && (static_cast<unsigned char>(text_[at]) & 0xC0U) == 0x80U);
  return at;
}

// End of a value: a number, a truth value, a one-line text or an array of these.
std::size_t ConfigEditor::end_of_value(std::size_t begin) const {
  int depth = 0;
  bool quoted = false;
  for (std::size_t at = begin; at < text_.size(); ++at) {
    const char c = text_[at];
    if (quoted) {
      if (c == '\\') ++at;
      if (c == '"') quoted = false;
      if (c == '"' && depth == 0) return at + 1;
      continue;
    }
    if (c == '"') quoted = true;
    if (c == '[') ++depth;
    if (c == ']' && --depth <= 0) return depth == 0 ? at + 1 : at;
    if (depth == 0 && std::string_view(" \t\r\n,#}").find(c) != std::string_view::npos) return at;
  }
  return text_.size();
}

void ConfigEditor::set(std::string_view key, std::string_view value) {
  const auto* node = find(key);
  if (node == nullptr) throw std::invalid_argument(fmt::format("{}: there is no key '{}'", name_, key));
  const auto begin = offset_of(node->position);
  const auto end = end_of_value(begin);
  // A comment on the same line keeps its column if the spaces before it suffice.
  std::size_t spaces = 0;
  while (end + spaces < text_.size() && text_[end + spaces] == ' ') ++spaces;
  const bool aligned = end + spaces < text_.size() && text_[end + spaces] == '#';
  const auto grown = static_cast<std::ptrdiff_t>(value.size()) - static_cast<std::ptrdiff_t>(end - begin);
  const auto wanted = std::max<std::ptrdiff_t>(1, static_cast<std::ptrdiff_t>(spaces) - grown);
  const std::string gap(static_cast<std::size_t>(aligned ? wanted : 0), ' ');
  text_.replace(begin, end - begin + (aligned ? spaces : 0), std::string(value) + gap);
  reparse();
}

void ConfigEditor::remark(std::string_view key, std::string_view text) {
  const auto* node = find(key);
  if (node == nullptr) throw std::invalid_argument(fmt::format("{}: there is no key '{}'", name_, key));
  auto at = end_of_value(offset_of(node->position));
  const auto end = std::min(text_.find('\n', at), text_.size());
  const auto old = text_.find('#', at);
  std::string more;
  if (old < end) {
    const auto words = text_.find_first_not_of("# \t", old);
    if (words < end) more = "; " + text_.substr(words, end - words);
  }
  text_.replace(at, end - at, fmt::format("   # {}{}", text, more));
  reparse();
}

void ConfigEditor::add(std::string_view table, std::string_view line) {
  std::size_t at = 0;
  if (!table.empty()) {
    const auto title = fmt::format("[{}]", table);
    while (at < text_.size() && !std::string_view(text_).substr(at).starts_with(title))
      at = line_end(text_, at);
    if (at >= text_.size()) {
      if (!text_.empty() && text_.back() != '\n') text_ += '\n';
      text_ += fmt::format("{}{}\n{}\n", text_.empty() ? "" : "\n", title, line);
      return reparse();
    }
    at = line_end(text_, at);
    for (auto next = at; next < text_.size() && text_[next] != '[';) {  // behind the table's last value
      const auto end = line_end(text_, next);
      const auto one = std::string_view(text_).substr(next, end - next);
      if (!is_comment(one) && one.find_first_not_of(" \t\r\n") != std::string_view::npos) at = end;
      next = end;
    }
    if (text_[at - 1] != '\n') text_.insert(at++, 1, '\n');
  }
  text_.insert(at, fmt::format("{}\n", line));
  reparse();
}

void ConfigEditor::set_table(std::string_view header, std::string_view comment, std::string_view lines) {
  const auto block = fmt::format("# {}\n[{}]\n{}", comment, header, lines);
  const auto title = fmt::format("[{}]", header);
  std::size_t begin = 0;
  while (begin < text_.size() && !std::string_view(text_).substr(begin).starts_with(title))
    begin = line_end(text_, begin);
  if (begin >= text_.size()) {
    if (!text_.empty() && text_.back() != '\n') text_ += '\n';
    text_ += "\n" + block;
    return reparse();
  }
  auto end = line_end(text_, begin);  // the table ends where the next one's header or comment begins
  auto last = end;
  while (end < text_.size() && text_[end] != '[') {
    const auto next = line_end(text_, end);
    const auto line = std::string_view(text_).substr(end, next - end);
    if (!is_comment(line) && line.find_first_not_of(" \t\r\n") != std::string_view::npos) last = next;
    end = next;
  }
  if (begin > 0) {
    const auto above = line_begin(text_, begin - 1);
    if (is_comment(std::string_view(text_).substr(above, begin - above))) begin = above;
  }
  text_.replace(begin, last - begin, block);
  reparse();
}

void replace_file(const std::filesystem::path& file, std::string_view text) {
  const auto real = std::filesystem::canonical(file);  // follows a symbolic link instead of replacing it
  const auto fail = [&](const std::string& what) {
    throw std::system_error(errno, std::generic_category(), what);
  };
  struct stat before {};
  if (::stat(real.c_str(), &before) != 0) fail(real.string());
  auto scratch = real;
  scratch += ".new";
  {
    const UniqueFd fd(
        ::open(scratch.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, before.st_mode & 0777U));
    if (!fd) fail("cannot make " + scratch.string());
    for (std::size_t done = 0; done < text.size();) {
      const auto count = ::write(fd.get(), text.data() + done, text.size() - done);
      if (count < 0 && errno != EINTR) fail("cannot write " + scratch.string());
      if (count > 0) done += static_cast<std::size_t>(count);
    }
    if (::fchmod(fd.get(), before.st_mode & 07777U) != 0 || ::fsync(fd.get()) != 0)
      fail("cannot write " + scratch.string());
  }
  if (std::rename(scratch.c_str(), real.c_str()) != 0) fail("cannot replace " + real.string());
}

}  // namespace sandhopper
