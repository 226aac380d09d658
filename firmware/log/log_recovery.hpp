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

namespace mcap {
struct OneLog;
}

// Cycles of a log, determined from the cycle counter in /frame.
struct LoggedCycles {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  std::int64_t first_ns = 0;  // time stamps of these cycles, CLOCK_MONOTONIC
  std::int64_t last_ns = 0;
  std::uint64_t missing_inside = 0;  // cycles missing between first and last, without skipped ones
  std::uint64_t skipped = 0;         // grid points without a cycle: overruns
  std::uint64_t restored = 0;        // cycles after `last` that were restored from the freeze ring into the
                                     // copy
  // Cycles after `last` that were not restored. 0 for a log that was closed; empty if unknown.
  std::optional<std::uint64_t> missing_at_end;
};

// Content of a log and the parts that are missing.
struct LogRecovery {
  bool whole = false;  // closed in order and undamaged: no copy is made
  std::uint64_t file_bytes = 0;
  std::uint64_t unreadable_bytes = 0;  // damage and the torn end

  struct Topic {
    std::uint64_t saved = 0;
    std::uint64_t lost = 0;  // gaps in the messages' sequence numbers; messages lost at the end are not
                             // included
  };
  std::map<std::string, Topic> topics;  // for CAN text one per interface
  std::int64_t first_ns = 0;            // log times of the first and last message saved
  std::int64_t last_ns = 0;

  struct Damage {
    std::uint64_t from_byte = 0;
    std::uint64_t to_byte = 0;
    std::string what;
  };
  std::vector<Damage> damage;
  std::optional<std::uint64_t> cut_at;  // the log has no regular end; later content is unknown
  std::uint64_t gaps = 0;               // number of gaps that the log records, and of records missing in them
  std::uint64_t lost_in_gaps = 0;

  std::uint64_t copies = 1;            // number of times that the file holds this log, one behind the other
  std::uint64_t bytes_behind_end = 0;  // bytes behind the end of a closed log; they are no part of it
  bool zeros_behind_end = true;        // all of them are zeros
  bool loses_at_least = false;         // CAN text: a damaged stretch may have held more frames than `lost`

  // Empty if the log has no cycles with this build's schema.
  std::optional<LoggedCycles> cycles;

  // True if the end of the log is known: it was closed, or its end was restored. Then lost() counts
  // everything that is missing, unless `loses_at_least`.
  bool end_is_known() const { return !cut_at || (cycles && cycles->missing_at_end); }

  // Adds to the result of one log what its file holds besides it. Offsets then are those of the file.
  void add_rest_of_file(const mcap::OneLog& log);

  std::uint64_t saved() const;
  std::uint64_t lost() const;  // without lost_in_gaps
};

// Writes everything readable of an MCAP log, cut or damaged anywhere, into a new, closed file; `from` is not
// changed. Readable messages are those of chunks with a correct CRC and the whole ones of a cut chunk. A
// LogGap with cause `damaged` replaces what is missing, and metadata "recovery" describes the recovery. If
// damage hides the begin of the records, the next chunk with a correct CRC is searched for. A log with other
// encodings than this firmware's is refused.
//
// A file that holds the same log several times gives it once. Bytes behind a log's end are left out.
//
// `newest` are the last cycles of this trial, oldest first, from its freeze ring (find_newest_cycles()).
// Those that a cut log lacks at its end are also written to the copy.
//
// Throws mcap::SeveralLogs if the file holds different logs, mcap::Error if `from` is no such log or nothing
// in it can be read, and std::system_error if a file cannot be opened or written. An existing `to` is not
// overwritten.
LogRecovery recover_mcap(const std::filesystem::path& from, const std::filesystem::path& to,
                         std::span<const FreezeCycle> newest = {});
// Only inspects. Throws as recover_mcap does.
LogRecovery look_at_mcap(const std::filesystem::path& from);

// Recovery of CAN traffic in candump text: lines that are no frame, including a torn last line, are left out.
// Throws CandumpError if it contains no frame.
LogRecovery recover_candump(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace sandhopper
