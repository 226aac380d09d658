#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/log/mcap_reader.hpp"

namespace sandhopper {

// Byte position of each number in a topic's messages, derived from the schema in the log itself. So it reads
// logs of other versions and records of which this program knows only field names. Supports numbers of fixed
// size, nested records and fixed arrays of both; refuses strings and sequences.
class RecordLayout {
 public:
  enum class Kind : std::uint8_t { boolean, signed_integer, unsigned_integer, real };

  struct Field {
    std::string path;  // true names: "motor.0.current_A"
    Kind kind = Kind::real;
    std::uint8_t bytes = 0;
    std::size_t offset = 0;              // from the message's first byte, including the encapsulation header
    std::vector<std::string> constants;  // of an enum, indexed by value, in upper case with prefix:
                                         // "STATE_IDLE", …
  };

  // Throws mcap::Error with the line that cannot be parsed.
  explicit RecordLayout(const mcap::Channel& channel);

  const std::vector<Field>& fields() const { return fields_; }
  const Field* find(std::string_view path) const;  // null if there is none

  // Throw mcap::Error if the message is too short for the field.
  static double number(mcap::Bytes message, const Field& field);
  static std::int64_t integer(mcap::Bytes message, const Field& field);

 private:
  struct Line;
  struct Definition;
  void add_definition(const std::vector<Definition>& all, const Definition& definition,
                      const std::string& prefix, int depth);
  void add_field(const std::vector<Definition>& all, const Line& line, const std::string& path, int depth);

  std::string topic_;
  std::size_t offset_ = 0;  // behind the encapsulation header
  std::vector<Field> fields_;
};

}  // namespace sandhopper
