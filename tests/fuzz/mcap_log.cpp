// Fuzz target of MCAP files: reads front to back, with and without CRCs, each record by this build's layout
// and by the log's own.
#include "firmware/log/mcap_reader.hpp"
#include "firmware/log/mcap_salvage.hpp"
#include "firmware/log/record_layout.hpp"
#include "firmware/log/topics.hpp"
#include "firmware/records.hpp"
#include "firmware/sensor_frame.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace {

using namespace sandhopper;

void read(mcap::Bytes file, mcap::ReaderOptions options) {
  TopicOf<SensorFrame> frames(topic::kFrame);
  TopicOf<StepOutput> outputs(topic::kOutput);
  TopicOf<Event> events(topic::kEvent);
  TopicOf<LogGap> gaps(topic::kGap);
  SensorFrame frame;
  StepOutput output;
  Event event;
  LogGap gap;
  try {
    mcap::Reader log(file, "input", options);
    std::size_t bytes = 0;
    for (mcap::Message message; log.next(message);) {
      bytes += message.data.size();
      fuzz::require(message.channel != nullptr, "a message has a channel");
      try {
        if (!frames.take(message, frame) && !outputs.take(message, output) && !events.take(message, event))
          static_cast<void>(gaps.take(message, gap));
        const RecordLayout layout(*message.channel);
        for (const auto& field : layout.fields()) RecordLayout::number(message.data, field);
      } catch (const mcap::Error&) {
      }
    }
    fuzz::require(bytes <= file.size(), "messages lie in the file");
    fuzz::require(!log.truncated_at() || *log.truncated_at() <= file.size(), "a cut lies in the file");
  } catch (const mcap::Error&) {
  }
}

void salvage(mcap::Bytes file) {
  mcap::Salvage pieces(file);
  std::uint64_t last = 0;
  for (mcap::Salvage::Piece piece; pieces.next(piece);) {
    fuzz::require(piece.offset >= last, "pieces are in the order of the file");
    fuzz::require(
        piece.content.empty() || piece.content.data() + piece.content.size() <= file.data() + file.size(),
        "a piece lies in the file");
    last = piece.offset + 1;
  }
  for (const auto& damage : pieces.damage())
    fuzz::require(damage.from <= damage.to && damage.to <= file.size(), "damage lies in the file");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const mcap::Bytes file = std::as_bytes(std::span(data, size));
  read(file, {});
  read(file, {.check_crc = false});
  read(file, {.skip_damaged = true});
  salvage(file);
  return 0;
}
