#include "firmware/log/record_layout.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstring>
#include <limits>
#include <optional>
#include <sstream>

namespace sandhopper {
namespace {

constexpr int kMaxDepth = 16;
constexpr std::size_t kMaxFields = 100'000;

struct Scalar {
  std::string_view name;
  RecordLayout::Kind kind;
  std::uint8_t bytes;
};
using Kind = RecordLayout::Kind;
constexpr std::array kScalars{Scalar{"bool", Kind::boolean, 1},
                              Scalar{"byte", Kind::unsigned_integer, 1},
                              Scalar{"char", Kind::unsigned_integer, 1},
                              Scalar{"int8", Kind::signed_integer, 1},
                              Scalar{"uint8", Kind::unsigned_integer, 1},
                              Scalar{"int16", Kind::signed_integer, 2},
                              Scalar{"uint16", Kind::unsigned_integer, 2},
                              Scalar{"int32", Kind::signed_integer, 4},
                              Scalar{"uint32", Kind::unsigned_integer, 4},
                              Scalar{"int64", Kind::signed_integer, 8},
                              Scalar{"uint64", Kind::unsigned_integer, 8},
                              Scalar{"float32", Kind::real, 4},
                              Scalar{"float64", Kind::real, 8}};

std::string_view last_part(std::string_view type) { return type.substr(type.rfind('/') + 1); }

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

template <class T>
T value_at(mcap::Bytes message, std::size_t offset) {
  T value{};
  std::memcpy(&value, message.data() + offset, sizeof(T));
  return value;
}

}  // namespace

// One field of a definition in the schema text.
struct RecordLayout::Line {
  std::string type;
  std::optional<std::size_t> count;  // of an array
  std::string name;
  std::vector<std::string> constants;
};

struct RecordLayout::Definition {
  std::string name;
  std::vector<Line> lines;
};

namespace {

// Splits "type[3] name=value  # true_name" into the part before the comment and the comment.
struct Parts {
  std::string type;
  std::string rest;
  std::string comment;
};

Parts split(const std::string& line) {
  Parts parts;
  const auto hash = line.find('#');
  std::istringstream words(line.substr(0, hash));
  words >> parts.type;
  std::getline(words >> std::ws, parts.rest);
  while (!parts.rest.empty() && std::isspace(static_cast<unsigned char>(parts.rest.back())))
    parts.rest.pop_back();
  if (hash != std::string::npos) std::istringstream(line.substr(hash + 1)) >> parts.comment;
  return parts;
}

}  // namespace

RecordLayout::RecordLayout(const mcap::Channel& channel) : topic_(channel.topic), offset_(cdr::kHeaderBytes) {
  if (channel.message_encoding != "cdr" || channel.schema.encoding != "ros2msg")
    throw mcap::Error("topic " + topic_ + ": messages are " + channel.message_encoding + " with schema " +
                      channel.schema.encoding + ", not cdr with ros2msg");
  std::vector<Definition> all{{channel.schema.name, {}}};
  std::vector<std::string> constants;
  std::istringstream text(channel.schema.text);
  for (std::string line; std::getline(text, line);) {
    Parts parts = split(line);
    if (parts.type.empty() || parts.type.starts_with("====")) continue;
    if (parts.type == "MSG:") {
      all.push_back({parts.rest, {}});
      constants.clear();
      continue;
    }
    const auto bad = [&] {
      return mcap::Error("topic " + topic_ + ": schema line \"" + line + "\" is not understood");
    };
    if (const auto equals = parts.rest.find('='); equals != std::string::npos) {
      std::size_t value = 0;
      const char* const end = parts.rest.data() + parts.rest.size();
      if (std::from_chars(parts.rest.data() + equals + 1, end, value).ec != std::errc{} ||
          value != constants.size())
        continue;  // a constant that does not belong to an enum
      constants.push_back(parts.rest.substr(0, equals));
      continue;
    }
    Line field;
    if (const auto bracket = parts.type.find('['); bracket != std::string::npos) {
      std::size_t count = 0;
      const char* const end = parts.type.data() + parts.type.size();
      const auto [place, error] = std::from_chars(parts.type.data() + bracket + 1, end, count);
      if (error != std::errc{} || place + 1 != end || *place != ']') throw bad();
      field.count = count;
      parts.type.resize(bracket);
    }
    field.type = parts.type;
    field.name = lower_case(parts.comment) == parts.rest ? parts.comment : parts.rest;
    if (field.name.empty() || field.name.find(' ') != std::string::npos) throw bad();
    field.constants = std::exchange(constants, {});
    all.back().lines.push_back(std::move(field));
  }
  add_definition(all, all.front(), "", 0);
}

void RecordLayout::add_definition(const std::vector<Definition>& all, const Definition& definition,
                                  const std::string& prefix, int depth) {
  if (depth > kMaxDepth) throw mcap::Error("topic " + topic_ + ": the schema nests without end");
  for (const Line& line : definition.lines) {
    const std::string path = prefix + line.name;
    if (!line.count) {
      add_field(all, line, path, depth);
      continue;
    }
    for (std::size_t i = 0; i < *line.count; ++i) add_field(all, line, path + '.' + std::to_string(i), depth);
  }
}

void RecordLayout::add_field(const std::vector<Definition>& all, const Line& line, const std::string& path,
                             int depth) {
  const auto scalar =
      std::find_if(kScalars.begin(), kScalars.end(), [&](const Scalar& s) { return s.name == line.type; });
  if (scalar != kScalars.end()) {
    if (fields_.size() >= kMaxFields) throw mcap::Error("topic " + topic_ + ": more fields than can be");
    const std::size_t start =
        cdr::detail::aligned(offset_ - cdr::kHeaderBytes, scalar->bytes) + cdr::kHeaderBytes;
    fields_.push_back({path, scalar->kind, scalar->bytes, start, line.constants});
    offset_ = start + scalar->bytes;
    return;
  }
  const auto nested = std::find_if(all.begin() + 1, all.end(), [&](const Definition& d) {
    return d.name == line.type || last_part(d.name) == last_part(line.type);
  });
  if (nested == all.end())
    throw mcap::Error("topic " + topic_ + ": field " + path + " is of type " + line.type +
                      ", which has no fixed size or no definition in the log");
  add_definition(all, *nested, path + '.', depth + 1);
}

const RecordLayout::Field* RecordLayout::find(std::string_view path) const {
  const auto found =
      std::find_if(fields_.begin(), fields_.end(), [&](const Field& f) { return f.path == path; });
  return found == fields_.end() ? nullptr : &*found;
}

double RecordLayout::number(mcap::Bytes message, const Field& field) {
  if (field.kind != Kind::real) return static_cast<double>(integer(message, field));
  if (field.offset + field.bytes > message.size())
    throw mcap::Error("a message is too short for " + field.path);
  return field.bytes == 4 ? double{value_at<float>(message, field.offset)}
                          : value_at<double>(message, field.offset);
}

std::int64_t RecordLayout::integer(mcap::Bytes message, const Field& field) {
  if (field.offset + field.bytes > message.size())
    throw mcap::Error("a message is too short for " + field.path);
  const bool is_signed = field.kind == Kind::signed_integer;
  switch (field.bytes) {
    case 1:
      return is_signed ? value_at<std::int8_t>(message, field.offset)
                       : value_at<std::uint8_t>(message, field.offset);
    case 2:
      return is_signed ? value_at<std::int16_t>(message, field.offset)
                       : value_at<std::uint16_t>(message, field.offset);
    case 4:
      return is_signed ? value_at<std::int32_t>(message, field.offset)
                       : std::int64_t{value_at<std::uint32_t>(message, field.offset)};
    default:
      return value_at<std::int64_t>(message, field.offset);
  }
}

}  // namespace sandhopper
