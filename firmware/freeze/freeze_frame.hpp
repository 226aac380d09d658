#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "firmware/freeze/freeze_ring.hpp"

namespace sandhopper {

// Metadata of a freeze frame's file: cause, fault, time_ns, cycle, log, start_ns, process.
inline constexpr std::string_view kFreezeMetadata = "freeze";

// Length of a freeze frame before and after its instant.
inline constexpr std::int64_t kFreezeBefore_ns = 5'000'000'000;
inline constexpr std::int64_t kFreezeAfter_ns = 1'000'000'000;

enum class FreezeCause : std::uint8_t {
  fault,   // the cycle raised a fault
  killed,  // hopperd ended, or still hangs, without having closed its log
};
template <>
struct EnumNames<FreezeCause> {
  static constexpr std::array<std::string_view, 2> value{"fault", "killed"};
};

// An instant that gets a freeze frame. `number` is the number of its cycle in the ring.
struct FreezeInstant {
  std::uint64_t number = 0;
  std::int64_t time_ns = 0;  // CLOCK_MONOTONIC
  FreezeCause cause = FreezeCause::fault;
  Fault fault = Fault::none;
};

// Faults raised in the cycles after `number`.
std::vector<FreezeInstant> faults_after(const FreezeReader& ring, std::uint64_t number);

// Instants of a ring whose process is gone: the faults without a freeze frame, and the process's end. The end
// is left out if the second after the last fault reaches to it.
std::vector<FreezeInstant> instants_left(const FreezeReader& ring);

// Name without ending: time, trial, fault or cause.
std::string frame_name_of(const FreezeReader& ring, const FreezeInstant& instant);

// Writes up to 5 s before the instant and 1 s after it as an ordinary log: topics /frame, /output and /event,
// attachments and metadata of the trial, and metadata "freeze". The file gets its name only when it is
// complete. Returns its path. An existing frame of that name is left as it is. Creates the folder. Throws
// std::system_error.
std::filesystem::path write_frame(const FreezeReader& ring, const FreezeInstant& instant,
                                  const std::filesystem::path& folder);

}  // namespace sandhopper
