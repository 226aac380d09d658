#include "firmware/log/mcap_unpack.hpp"

#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>
#include <string_view>

namespace sandhopper::mcap {
namespace {

// Chunks usually have 0.8 to 4 MiB; a larger stated size than this means damage.
constexpr std::uint64_t kLargestChunk = std::uint64_t{1} << 30;
constexpr std::size_t kStep = std::size_t{1} << 20;

struct Chunk {
  std::int64_t first_ns = 0, last_ns = 0;
  std::uint64_t unpacked = 0;  // bytes
  std::uint32_t crc = 0;       // of the unpacked records
  std::string_view compression;
  Bytes packed;
  bool whole = false;
};

std::optional<Chunk> read_chunk(Bytes content) {
  Cursor in(content);
  Chunk chunk;
  chunk.first_ns = in.take<std::int64_t>();
  chunk.last_ns = in.take<std::int64_t>();
  chunk.unpacked = in.take<std::uint64_t>();
  chunk.crc = in.take<std::uint32_t>();
  chunk.compression = in.take_text();
  const auto length = in.take<std::uint64_t>();
  if (!in.ok) return std::nullopt;
  chunk.packed = in.rest().first(std::min<std::uint64_t>(length, in.rest().size()));
  chunk.whole = chunk.packed.size() == length;
  return chunk;
}

bool is_packed(const Chunk& chunk) {
  return (chunk.compression == "zstd" || chunk.compression == "lz4") && chunk.unpacked <= kLargestChunk;
}

// Both functions append up to `most` bytes to `out`. They stop at the end of the packed bytes or at damage.
void unpack_zstd(Bytes packed, std::uint64_t most, Buffer& out) {
  const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream(ZSTD_createDStream(),
                                                                          ZSTD_freeDStream);
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  for (std::uint64_t done = 0; done < most;) {
    const auto step = static_cast<std::size_t>(std::min<std::uint64_t>(kStep, most - done));
    const std::size_t start = out.size();
    ZSTD_outBuffer piece{out.grow(step), step, 0};
    const std::size_t state = ZSTD_decompressStream(stream.get(), &piece, &in);
    out.bytes.resize(start + piece.pos);
    done += piece.pos;
    if (ZSTD_isError(state) != 0 || piece.pos == 0) return;
  }
}

void unpack_lz4(Bytes packed, std::uint64_t most, Buffer& out) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0) return;
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      raw, LZ4F_freeDecompressionContext);
  for (std::uint64_t done = 0; done < most;) {
    auto step = static_cast<std::size_t>(std::min<std::uint64_t>(kStep, most - done));
    const std::size_t start = out.size();
    std::size_t read = packed.size();
    const std::size_t state =
        LZ4F_decompress(context.get(), out.grow(step), &step, packed.data(), &read, nullptr);
    out.bytes.resize(start + (LZ4F_isError(state) != 0 ? 0 : step));
    if (LZ4F_isError(state) != 0 || (step == 0 && read == 0)) return;
    packed = packed.subspan(read);
    done += step;
  }
}

// False if the file ends within the chunk; nothing may follow then.
bool write_unpacked(const Chunk& chunk, Buffer& out) {
  const auto record = out.open_record(Op::chunk);
  out.put(chunk.first_ns);
  out.put(chunk.last_ns);
  const std::size_t head = out.size();
  out.put(chunk.unpacked);
  out.put(chunk.crc);
  out.put_text("");
  out.put(chunk.unpacked);
  const std::size_t start = out.size();
  chunk.compression == "zstd" ? unpack_zstd(chunk.packed, chunk.unpacked, out)
                              : unpack_lz4(chunk.packed, chunk.unpacked, out);
  std::uint64_t length = chunk.unpacked;
  const std::uint64_t present = out.size() - start;
  if (present < length && chunk.whole) {  // damaged chunk: make sure that its CRC is wrong
    length = present;
    const auto crc = crc32(0, Bytes(out.bytes).subspan(start));
    out.put_at(head, length);
    out.put_at(head + sizeof length, chunk.crc != 0 && chunk.crc != crc ? chunk.crc : (~crc | 1U));
    out.put_at(start - sizeof length, length);
  }
  out.put_at(record - sizeof length, static_cast<std::uint64_t>(start - record) + length);
  return present == length;
}

}  // namespace

std::optional<std::vector<std::byte>> unpack(Bytes file) {
  Buffer out;
  bool any = false;
  std::uint64_t kept = 0;  // bytes of the file already copied to `out`
  for (std::uint64_t at = kMagic.size(); at + kRecordHead <= file.size();) {
    const std::uint64_t length = length_at(file, at);
    const std::uint64_t rest = file.size() - at - kRecordHead;
    const auto content = file.subspan(at + kRecordHead, std::min(length, rest));
    const auto chunk = static_cast<Op>(file[at]) == Op::chunk ? read_chunk(content) : std::nullopt;
    const std::uint64_t next = at + kRecordHead + content.size();
    if (chunk && is_packed(*chunk)) {
      any = true;
      out.put(file.subspan(kept, at - kept));
      kept = next;
      if (!write_unpacked(*chunk, out)) return std::move(out.bytes);
    }
    if (length > rest) break;
    at = next;
  }
  if (!any) return std::nullopt;
  out.put(file.subspan(kept));
  return std::move(out.bytes);
}

}  // namespace sandhopper::mcap
