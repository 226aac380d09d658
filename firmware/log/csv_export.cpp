#include "firmware/log/csv_export.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <ostream>
#include <string_view>

#include "firmware/log/csv_channels.hpp"
#include "firmware/log/lost_records.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "firmware/log/record_layout.hpp"
#include "firmware/log/topics.hpp"

namespace sandhopper {
namespace {

void append_number(std::string& line, double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  line.append(text.data(), end);
}

// Appends the time in seconds, exact to the nanosecond, without trailing zeros.
void append_seconds(std::string& line, std::int64_t time_ns) {
  if (time_ns < 0) line += '-';
  const std::uint64_t size_ns =
      time_ns < 0 ? -static_cast<std::uint64_t>(time_ns) : static_cast<std::uint64_t>(time_ns);
  line += std::to_string(size_ns / 1'000'000'000);
  std::string fraction = std::to_string(1'000'000'000 + size_ns % 1'000'000'000).substr(1);
  fraction.erase(fraction.find_last_not_of('0') + 1);
  if (!fraction.empty()) line += '.' + fraction;
}

// Newest message of one topic and the layout of its fields.
struct Source {
  explicit Source(std::string_view name) : topic(name) {}
  std::string topic;
  const mcap::Channel* channel = nullptr;
  std::optional<RecordLayout> layout;
  mcap::Bytes message;  // empty: no message in this row

  void open(const mcap::Reader& log) {
    channel = log.find(topic);
    if (channel != nullptr) layout.emplace(*channel);
  }
};

struct ExportCell {
  const CsvChannel* channel = nullptr;
  const Source* source = nullptr;
  const RecordLayout::Field* field = nullptr;
  const Source* guard_source = nullptr;
  const RecordLayout::Field* guard = nullptr;
  const RecordLayout::Field* status = nullptr;
  const RecordLayout::Field* state = nullptr;
  std::optional<std::int64_t> last{};

  // Empty if the cell stays empty.
  std::optional<double> value() {
    if (source->message.empty()) return std::nullopt;
    if (channel->when == CsvCell::phase) return phase();
    if (guard != nullptr) {
      if (guard_source->message.empty()) return std::nullopt;
      const std::int64_t now = RecordLayout::integer(guard_source->message, *guard);
      const bool stale = channel->when == CsvCell::changed ? last == now : now == 0;
      last = now;
      if (stale) return std::nullopt;
    }
    if (status != nullptr && RecordLayout::integer(guard_source->message, *status) != 0) return std::nullopt;
    if (state != nullptr && unserved()) return std::nullopt;
    const double number = RecordLayout::number(source->message, *field);
    return std::isfinite(number) ? std::optional(number) : std::nullopt;
  }

  bool unserved() const {
    const auto value = static_cast<std::size_t>(RecordLayout::integer(source->message, *state));
    return value < state->constants.size() && std::find(kCsvUnservedStates.begin(), kCsvUnservedStates.end(),
                                                        state->constants[value]) != kCsvUnservedStates.end();
  }

  std::optional<double> phase() const {
    const auto state = static_cast<std::size_t>(RecordLayout::integer(source->message, *field));
    if (state >= field->constants.size()) return std::nullopt;
    for (std::size_t i = 0; i < kCsvPhases.size(); ++i)
      if (field->constants[state] == kCsvPhases[i]) return static_cast<double>(i);
    return std::nullopt;
  }
};

class Exporter {
 public:
  Exporter(const std::filesystem::path& file, std::ostream& out, CsvExportOptions options)
      : log_(file), out_(out), phase_names_(options.phase_names) {
    for (Source& source : sources_) source.open(log_);
    if (!frame_.layout)
      throw mcap::Error(file.string() + ": holds no " + frame_.topic + "; not a trial's log");
    time_ = frame_.layout->find("time_ns");
    if (time_ == nullptr) throw mcap::Error(file.string() + ": " + frame_.topic + " has no time_ns");
    for (const CsvChannel& channel : kCsvChannels)
      if (options.optional_channels || !channel.optional) add_cell(channel);
  }

  CsvExportResult run() {
    std::string line = "t_s";
    for (const ExportCell& cell : cells_) {
      line += ',';
      line += cell.channel->name;
      result_.columns.emplace_back(cell.channel->name);
    }
    out_ << line << '\n';
    TopicOf<LogGap> gaps(topic::kGap);
    LogGap gap;
    LostRecords lost;
    for (mcap::Message message; log_.next(message);) {
      if (message.channel == frame_.channel) write_row();
      for (Source& source : sources_)
        if (message.channel == source.channel) source.message = message.data;
      if (gaps.take(message, gap)) lost.add(gap);
    }
    write_row();
    result_.lost_records = lost.total();
    result_.lost_text = lost.text();
    result_.truncated_at = log_.truncated_at();
    return std::move(result_);
  }

 private:
  Source* source_of(std::string_view topic) {
    for (Source& source : sources_)
      if (source.topic == topic) return &source;
    return nullptr;
  }

  void add_cell(const CsvChannel& channel) {
    ExportCell cell;
    cell.channel = &channel;
    cell.source = source_of(channel.topic);
    if (!cell.source->layout) return;  // if the log lacks the topic the column is left out
    cell.field = cell.source->layout->find(channel.path);
    if (cell.field == nullptr) return;
    if (!channel.guard.empty()) {
      cell.guard_source = channel.when == CsvCell::changed ? cell.source : &frame_;
      cell.guard = cell.guard_source->layout->find(channel.guard);
      if (cell.guard == nullptr) return;
    }
    if (channel.when == CsvCell::served) cell.state = cell.source->layout->find("state");
    if (channel.when == CsvCell::good) cell.status = frame_.layout->find("tof.status");
    cells_.push_back(cell);
  }

  void write_row() {
    if (frame_.message.empty()) return;
    const std::int64_t time_ns = RecordLayout::integer(frame_.message, *time_);
    if (!start_ns_) start_ns_ = time_ns;
    line_.clear();
    append_seconds(line_, time_ns - *start_ns_);
    for (ExportCell& cell : cells_) {
      line_ += ',';
      const auto value = cell.value();
      if (!value) continue;
      if (phase_names_ && cell.channel->when == CsvCell::phase)
        line_ += kCsvPhaseNames[static_cast<std::size_t>(*value)];
      else
        append_number(line_, *value);
    }
    line_ += '\n';
    out_ << line_;
    ++result_.rows;
    for (Source& source : sources_) source.message = {};
  }

  mcap::Reader log_;
  std::ostream& out_;
  bool phase_names_ = false;
  std::array<Source, 3> sources_{Source{topic::kFrame}, Source{topic::kOutput}, Source{topic::kTruth}};
  Source& frame_ = sources_[0];
  const RecordLayout::Field* time_ = nullptr;
  std::vector<ExportCell> cells_;
  std::optional<std::int64_t> start_ns_;
  std::string line_;
  CsvExportResult result_;
};

}  // namespace

CsvExportResult export_csv(const std::filesystem::path& log, std::ostream& out, CsvExportOptions options) {
  return Exporter(log, out, options).run();
}

}  // namespace sandhopper
