#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/log/mcap_format.hpp"

namespace sandhopper::mcap {

// Iterates over the records outside chunks of an MCAP file that may be cut or damaged anywhere. Sound records
// are returned, damage is skipped and noted. A chunk is sound if its lengths are consistent and its CRC-32 is
// correct (a CRC of 0 means that there is none). If damage hides the length of a record, the next sound chunk
// with a CRC is searched for.
class Salvage {
 public:
  struct Piece {
    Op op{};
    Bytes content;  // for a chunk: the records in it
    std::uint64_t offset = 0;
    bool is_cut = false;  // a chunk without its end; `content` holds its records up to the cut
  };
  struct Damage {
    std::uint64_t from = 0;
    std::uint64_t to = 0;
    std::string what;
  };

  explicit Salvage(Bytes file);

  [[nodiscard]] bool next(Piece& piece);

  // Valid after next() returned false.
  const std::vector<Damage>& damage() const { return damage_; }
  std::optional<std::uint64_t> cut_at() const { return cut_at_; }  // the file lacks the end of an MCAP file

 private:
  bool take(Piece& piece);
  bool take_chunk(Piece& piece, std::uint64_t length, bool whole);
  bool end_at(std::uint64_t offset);
  void skip_to(std::uint64_t offset, const char* what);
  void resynchronise(const char* what);
  std::optional<std::uint64_t> find_chunk(std::uint64_t from) const;

  Bytes file_;
  std::uint64_t position_ = 0;
  bool ended_ = false;
  bool closed_ = false;
  std::vector<Damage> damage_;
  std::optional<std::uint64_t> cut_at_;
};

}  // namespace sandhopper::mcap
