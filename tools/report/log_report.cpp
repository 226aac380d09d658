#include "tools/report/log_report.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <ctime>
#include <optional>
#include <utility>

#include "config/node.hpp"
#include "firmware/log/lost_records.hpp"
#include "firmware/log/topics.hpp"
#include "firmware/log/trial_description.hpp"
#include "firmware/log/trial_sheet.hpp"
#include "tools/plant/bed_truth.hpp"
#include "tools/report/report_builder.hpp"

namespace sandhopper {
namespace {

template <HasFields Record>
bool pass_on(TopicOf<Record>& topic, const mcap::Message& message, Record& record, ReportBuilder& builder) {
  if (!topic.take(message, record)) return false;
  builder.add(record);
  return true;
}

// Passes every record to the builder and counts the records that the log lost.
struct Feed {
  TopicOf<SensorFrame> frames{topic::kFrame};
  TopicOf<StepOutput> outputs{topic::kOutput};
  TopicOf<Event> events{topic::kEvent};
  TopicOf<StrideResult> strides{topic::kStride};
  TopicOf<StrengthProfile> profiles{topic::kProfile};
  TopicOf<GroundSummary> grounds{topic::kGround};
  TopicOf<GroundEvents> ground_events{topic::kGroundEvents};
  TopicOf<PlantTruth> truths{topic::kTruth};
  TopicOf<LogGap> gaps{topic::kGap};
  SensorFrame frame{};
  StepOutput output{};
  Event event{};
  StrideResult stride{};
  StrengthProfile profile{};
  GroundSummary ground{};
  GroundEvents found{};
  PlantTruth truth{};
  LogGap gap{};
  LostRecords lost{};

  void take(const mcap::Message& message, ReportBuilder& builder) {
    if (pass_on(frames, message, frame, builder) || pass_on(outputs, message, output, builder) ||
        pass_on(events, message, event, builder) || pass_on(strides, message, stride, builder) ||
        pass_on(profiles, message, profile, builder) || pass_on(grounds, message, ground, builder) ||
        pass_on(ground_events, message, found, builder) || pass_on(truths, message, truth, builder))
      return;
    if (gaps.take(message, gap)) lost.add(gap);
  }
};

// Fact with its unit, lengths in mm as in the figures: "release_height_m", "0.061800" becomes "release
// height", "61.8 mm".
std::pair<std::string, std::string> fact_of(std::string key, std::string value) {
  struct Unit {
    std::string_view suffix, text;
    double scale = 1.0;
  };
  static constexpr std::array<Unit, 7> kUnits{{{"_kg", " kg"},
                                               {"_N_per_m", " N/m"},
                                               {"_mps", " m/s"},
                                               {"_Hz", " Hz"},
                                               {"_m", " mm", 1e3},
                                               {"_s", " s"},
                                               {"_N", " N"}}};
  for (const auto& [suffix, unit, scale] : kUnits) {
    if (!key.ends_with(suffix)) continue;
    double number = 0.0;
    const auto end = value.data() + value.size();
    if (std::from_chars(value.data(), end, number).ptr != end) break;
    key.resize(key.size() - suffix.size());
    value = fmt::format("{:g}{}", scale * number, unit);
    break;
  }
  std::ranges::replace(key, '_', ' ');
  return {key, value};
}

std::string utc(std::int64_t realtime_ns) {
  return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC",
                     fmt::gmtime(static_cast<std::time_t>(realtime_ns / 1'000'000'000)));
}

// Short metadata become facts under the title. Longer ones (explanations) and attached text become the
// configuration.
void add_attached(const mcap::Reader& log, ReportData& data) {
  constexpr std::size_t kLongest = 24;
  if (const auto sheet = sheet_of(log))
    for (const auto& [key, text] : entries_of(*sheet)) data.facts.push_back(fact_of(key, text));
  for (const mcap::Metadata& metadata : log.metadata()) {
    if (metadata.name == kSheetMetadata) continue;
    for (const auto& [key, value] : metadata.entries) {
      if (value.size() <= kLongest) {
        data.facts.push_back(fact_of(key, value));
      } else {
        data.configuration += fmt::format("# {}: {}\n", key, value);
      }
    }
  }
  for (const mcap::Attachment& attachment : log.attachments()) {
    if (attachment.name == kBedTruthAttachment) {
      auto truth = read_bed_truth(mcap::text_of(attachment.data));
      data.bed_depth_m = std::move(truth.depth_m);
      data.bed_force_N = std::move(truth.force_N);
    }
    const bool is_text =
        attachment.media_type.starts_with("text/") || attachment.media_type == "application/toml";
    if (!is_text) continue;
    if (!data.configuration.empty()) data.configuration += '\n';
    data.configuration += fmt::format("# {}\n{}", attachment.name, mcap::text_of(attachment.data));
  }
}

void add_notes(const mcap::Reader& log, const LostRecords& lost, ReportData& data) {
  if (log.truncated_at()) {
    data.notes.push_back(
        fmt::format("The log was cut: it is read up to byte {} of {}, its last whole record.",
                    *log.truncated_at(), log.file_bytes()));
  }
  if (!log.damaged_chunks().empty()) {
    data.notes.push_back(
        fmt::format("{} damaged chunks of the log were passed over: hop recover says what is missing.",
                    log.damaged_chunks().size()));
  }
  if (lost.total() > 0) data.notes.push_back(lost.text() + ".");
  if (data.time_s.empty()) data.notes.push_back("The log holds no cycle.");
}

}  // namespace

ReportData report_data_from_log(const std::filesystem::path& file) {
  mcap::Reader log(file, {.check_crc = true, .skip_damaged = true});
  ReportBuilder builder;
  Feed feed;
  std::optional<std::int64_t> began_ns;
  mcap::Message message;
  while (log.next(message)) {
    if (!began_ns) began_ns = message.stamp.log_ns;
    feed.take(message, builder);
  }

  for (const auto& attachment : log.attachments())
    if (attachment.name == kRobotAttachment)
      builder.set_robot(parse_config_text(file.string(), std::string(mcap::text_of(attachment.data))).root);
  ReportData data = builder.data();
  data.title = "Hop trial " + file.stem().string();
  if (began_ns) data.facts.emplace_back("date", utc(*began_ns));
  if (!data.time_s.empty()) {
    data.facts.emplace_back("duration", fmt::format("{:.2f} s", data.time_s.back() - data.time_s.front()));
    data.facts.emplace_back("cycles", std::to_string(data.time_s.size()));
    data.facts.emplace_back("overruns", std::to_string(feed.frame.overruns));
  }
  add_attached(log, data);
  add_notes(log, feed.lost, data);
  return data;
}

}  // namespace sandhopper
