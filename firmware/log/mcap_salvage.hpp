#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/log/mcap_format.hpp"

namespace sandhopper::mcap {

// Walks the records outside chunks of an MCAP file that may be cut or damaged anywhere: sound records are
// given, what is not is passed over and noted. A chunk is sound when its lengths agree and its CRC-32 is
// right (a CRC of 0 means there is none). Where damage hides how long a record is, the next sound chunk with
// a CRC is searched for.
class Salvage {
 public:
  struct Piece {
    Op op{};
    Bytes content;  // of a chunk: the records in it
    std::uint64_t offset = 0;
    bool is_cut = false;  // a chunk without its end; its records up to the cut
  };
  struct Damage {
    std::uint64_t from = 0;
    std::uint64_t to = 0;
    std::string what;
  };

  explicit Salvage(Bytes file);

  [[nodiscard]] bool next(Piece& piece);

  // After next() said false.
  const std::vector<Damage>& damage() const { return damage_; }
  std::optional<std::uint64_t> cut_at() const { return cut_at_; }  // there is no end of an MCAP file

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
