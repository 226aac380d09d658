#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "firmware/freeze/freeze_cycle.hpp"

namespace sandhopper {

// Cycles of a log, by the cycle counter in /frame.
struct LoggedCycles {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  std::int64_t first_ns = 0;  // the cycles' own times, CLOCK_MONOTONIC
  std::int64_t last_ns = 0;
  std::uint64_t missing_inside = 0;  // between first and last; skipped ones are not among them
  std::uint64_t skipped = 0;         // grid points that the cycle did not run in: its overruns
  std::uint64_t restored = 0;        // after `last`, from the freeze ring; they are in the copy
  // After `last`, and not restored. 0 of a log that was closed; nothing when nobody knows.
  std::optional<std::uint64_t> missing_at_end;
};

// What is in a log and what is missing from it.
struct LogRecovery {
  bool whole = false;  // closed in order and undamaged: nothing to do, no file is made
  std::uint64_t file_bytes = 0;
  std::uint64_t unreadable_bytes = 0;  // damage and the torn end

  struct Topic {
    std::uint64_t saved = 0;
    std::uint64_t lost = 0;  // by the jumps in the messages' own numbers; what the end took is not among them
  };
  std::map<std::string, Topic> topics;  // of CAN text: one for each interface
  std::int64_t first_ns = 0;            // log times of the first and last message saved
  std::int64_t last_ns = 0;

  struct Damage {
    std::uint64_t from_byte = 0;
    std::uint64_t to_byte = 0;
    std::string what;
  };
  std::vector<Damage> damage;
  std::optional<std::uint64_t> cut_at;  // the log ends without its end; what followed is not known
  std::uint64_t gaps = 0;               // that the log itself records, and the records missing in them
  std::uint64_t lost_in_gaps = 0;

  // Nothing where the log has no cycles of this build.
  std::optional<LoggedCycles> cycles;

  // All that is missing is counted in lost(): the log was closed, or its end was restored.
  bool end_is_known() const { return !cut_at || (cycles && cycles->missing_at_end); }

  std::uint64_t saved() const;
  std::uint64_t lost() const;  // without the gaps' own
};

// Writes all that can be read of an MCAP log, cut or damaged anywhere, into a new, closed one; `from` stays
// as it is. Messages are those of chunks whose CRC is right, and the whole ones of a chunk that is cut. In
// place of what is missing stands a LogGap with cause `damaged`, and metadata "recovery" tells what was done.
// When damage hides where records begin, the next chunk with a right CRC is searched for. A log of other
// encodings than this firmware's is refused.
//
// `newest` are the last cycles that ran in this trial, oldest first, from its freeze ring
// (find_newest_cycles()): those that a cut log lacks at its end are written to the copy, too.
//
// Throws mcap::Error when `from` is no such log or nothing can be read of it, std::system_error when a file
// cannot be opened or written; an existing `to` is not overwritten.
LogRecovery recover_mcap(const std::filesystem::path& from, const std::filesystem::path& to,
                         std::span<const FreezeCycle> newest = {});
// Only looks. Throws as recover_mcap does.
LogRecovery look_at_mcap(const std::filesystem::path& from);

// The same for CAN traffic as candump text: lines that are no frame, a torn last line among them, are left
// out. Throws CandumpError when there is no frame in it.
LogRecovery recover_candump(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace sandhopper
