#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "firmware/freeze/freeze_ring.hpp"

namespace sandhopper {

// Metadata of a freeze frame's file: cause, fault, time_ns, cycle, log, start_ns, process.
inline constexpr std::string_view kFreezeMetadata = "freeze";

// Time that a freeze frame holds before and after its instant.
inline constexpr std::int64_t kFreezeBefore_ns = 5'000'000'000;
inline constexpr std::int64_t kFreezeAfter_ns = 1'000'000'000;

enum class FreezeCause : std::uint8_t {
  fault,   // the cycle raised one
  killed,  // hopperd ended, or stood still to this day, without having closed its log
};
template <>
struct EnumNames<FreezeCause> {
  static constexpr std::array<std::string_view, 2> value{"fault", "killed"};
};

// An instant worth a frame. `number` is the cycle's place in the ring.
struct FreezeInstant {
  std::uint64_t number = 0;
  std::int64_t time_ns = 0;  // CLOCK_MONOTONIC
  FreezeCause cause = FreezeCause::fault;
  Fault fault = Fault::none;
};

// The faults raised in the cycles after `number`.
std::vector<FreezeInstant> faults_after(const FreezeReader& ring, std::uint64_t number);

// The instants of a ring whose process is gone: the faults that no frame shows yet, and its end, unless the
// second after the last fault reaches to that end.
std::vector<FreezeInstant> instants_left(const FreezeReader& ring);

// Name without ending: time, trial, fault or cause.
std::string frame_name_of(const FreezeReader& ring, const FreezeInstant& instant);

// Writes 5 s before the instant and 1 s after it, or what there is of that, as an ordinary log: topics
// /frame, /output and /event, attachments and metadata of the trial, and metadata "freeze". The file has its
// name when it is whole. Returns its path; a frame of that name that is there already stays as it is. Makes
// the folder. Throws std::system_error.
std::filesystem::path write_frame(const FreezeReader& ring, const FreezeInstant& instant,
                                  const std::filesystem::path& folder);

}  // namespace sandhopper
