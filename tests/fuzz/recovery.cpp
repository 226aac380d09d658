// Fuzz target of hop recover: the copy must be a closed log, and recovering it again must change nothing.
#include <filesystem>

#include "firmware/log/candump.hpp"
#include "firmware/log/log_recovery.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace {

using namespace sandhopper;

void mcap_log(const fuzz::ScratchFile& file) {
  const std::string copy = file.folder() + "/copy.mcap";
  try {
    const LogRecovery found = recover_mcap(file.path(), copy);
    fuzz::require(found.unreadable_bytes <= found.file_bytes, "no more is unreadable than there is");
    if (found.whole) return;
    mcap::Reader log{std::filesystem::path(copy)};
    std::uint64_t messages = 0;
    for (mcap::Message message; log.next(message);) ++messages;
    fuzz::require(!log.truncated_at(), "the copy is closed");
    fuzz::require(messages >= found.saved(), "what is said to be saved is in the copy");
  } catch (const mcap::Error&) {
  }
}

void can_text(const fuzz::ScratchFile& file) {
  const std::string copy = file.folder() + "/copy.candump";
  try {
    const LogRecovery found = recover_candump(file.path(), copy);
    if (found.whole) return;
    const LogRecovery again = recover_candump(copy, copy + ".2");
    fuzz::require(again.whole && again.saved() == found.saved(), "the copy is whole");
  } catch (const CandumpError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::ScratchFile file({data, size}, "log");
  mcap_log(file);
  can_text(file);
  return 0;
}
