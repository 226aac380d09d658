#include "firmware/log/mcap_salvage.hpp"

#include <algorithm>

namespace sandhopper::mcap {
namespace {

struct ChunkHead {
  std::uint64_t length = 0;  // of the whole record
  std::uint32_t crc = 0;
  bool lengths_agree = false;
};

// `content` holds at least kChunkHead bytes.
ChunkHead chunk_head(Bytes content, std::uint64_t length) {
  Cursor in(content);
  in.take(2 * sizeof(std::uint64_t));  // first and last time
  const auto unpacked = in.take<std::uint64_t>();
  const auto crc = in.take<std::uint32_t>();
  const auto compression = in.take<std::uint32_t>();
  const auto records = in.take<std::uint64_t>();
  return {length, crc, compression == 0 && records == unpacked && length - kChunkHead == records};
}

bool is_known(std::byte op) { return op >= std::byte{0x01} && op <= std::byte{0x0F}; }

}  // namespace

Salvage::Salvage(Bytes file) : file_(file) {
  const std::size_t seen = std::min(file_.size(), kMagic.size());
  const bool starts =
      std::equal(kMagic.begin(), kMagic.begin() + static_cast<std::ptrdiff_t>(seen), file_.begin());
  closed_ =
      file_.size() >= 2 * kMagic.size() &&
      std::equal(kMagic.begin(), kMagic.end(), file_.end() - static_cast<std::ptrdiff_t>(kMagic.size()));
  if (!starts)
    resynchronise("the file does not begin as an MCAP file does");
  else if (seen < kMagic.size())
    end_at(0);
  else
    position_ = kMagic.size();
}

bool Salvage::next(Piece& piece) {
  while (!ended_)
    if (take(piece)) return true;
  return false;
}

// True if `piece` is a sound record. False if damage was skipped or the end was reached.
bool Salvage::take(Piece& piece) {
  const Bytes rest = file_.subspan(static_cast<std::size_t>(position_));
  if (std::all_of(rest.begin(), rest.end(), [](std::byte b) { return b == std::byte{0}; }))
    return end_at(position_);
  if (!is_known(rest.front())) {
    resynchronise("no record begins here");
    return false;
  }
  if (rest.size() < kRecordHead) return end_at(position_);
  const std::uint64_t length = length_at(file_, position_);
  const bool whole = length <= rest.size() - kRecordHead;
  piece = {static_cast<Op>(rest.front()), {}, position_, false};
  if (piece.op == Op::chunk) return take_chunk(piece, length, whole);
  if (!whole) {
    if (const auto chunk = find_chunk(position_ + 1))
      skip_to(*chunk, "a record that reaches beyond what follows it");
    else
      return end_at(position_);
    return false;
  }
  piece.content = rest.subspan(kRecordHead, static_cast<std::size_t>(length));
  position_ += kRecordHead + length;
  if (piece.op == Op::footer && file_.size() - position_ == kMagic.size() && closed_) {
    ended_ = true;
    return false;
  }
  return true;
}

bool Salvage::take_chunk(Piece& piece, std::uint64_t length, bool whole) {
  const Bytes content = file_.subspan(static_cast<std::size_t>(position_) + kRecordHead);
  if (content.size() < kChunkHead || length < kChunkHead) {
    if (length >= kChunkHead) return end_at(position_);
    resynchronise("a chunk shorter than its head");
    return false;
  }
  const ChunkHead head = chunk_head(content, length);
  if (!head.lengths_agree) {
    resynchronise("a chunk whose lengths disagree, or that is compressed");
    return false;
  }
  if (!whole) {
    if (const auto chunk = find_chunk(position_ + 1)) {
      skip_to(*chunk, "a chunk that reaches beyond the end of the file");
      return false;
    }
    piece.content = content.subspan(kChunkHead);
    piece.is_cut = true;
    end_at(file_.size());
    return true;
  }
  piece.content = content.subspan(kChunkHead, static_cast<std::size_t>(length - kChunkHead));
  if (head.crc != 0 && crc32(0, piece.content) != head.crc) {
    const std::uint64_t after = position_ + kRecordHead + length;
    if (after == file_.size() || is_known(file_[static_cast<std::size_t>(after)]))
      skip_to(after, "a chunk whose CRC is wrong");
    else
      resynchronise("a chunk whose CRC is wrong");
    return false;
  }
  position_ += kRecordHead + length;
  return true;
}

bool Salvage::end_at(std::uint64_t offset) {
  ended_ = true;
  cut_at_ = offset;
  return false;
}

void Salvage::skip_to(std::uint64_t offset, const char* what) {
  damage_.push_back({position_, offset, what});
  position_ = offset;
}

void Salvage::resynchronise(const char* what) {
  if (const auto chunk = find_chunk(position_ + 1)) {
    skip_to(*chunk, what);
    return;
  }
  skip_to(file_.size(), what);
  ended_ = true;
  if (!closed_) cut_at_ = file_.size();
}

std::optional<std::uint64_t> Salvage::find_chunk(std::uint64_t from) const {
  constexpr std::uint64_t kLeast = kRecordHead + kChunkHead;
  const auto chunk = static_cast<std::byte>(Op::chunk);
  for (auto place = file_.begin() + static_cast<std::ptrdiff_t>(std::min<std::uint64_t>(from, file_.size()));;
       ++place) {
    place = std::find(place, file_.end(), chunk);
    const auto left = static_cast<std::uint64_t>(file_.end() - place);
    if (left < kLeast) return std::nullopt;
    const auto offset = static_cast<std::uint64_t>(place - file_.begin());
    const std::uint64_t length = length_at(file_, offset);
    if (length < kChunkHead || length > left - kRecordHead) continue;
    const Bytes content =
        file_.subspan(static_cast<std::size_t>(offset) + kRecordHead, static_cast<std::size_t>(length));
    const ChunkHead head = chunk_head(content, length);
    if (head.lengths_agree && head.crc != 0 && crc32(0, content.subspan(kChunkHead)) == head.crc)
      return offset;
  }
}

}  // namespace sandhopper::mcap
