#include "tools/trial/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <deque>
#include <memory>

#include "config/load.hpp"
#include "config/robot_config.hpp"
#include "firmware/controller.hpp"
#include "firmware/log/topics.hpp"
#include "firmware/log/trial_description.hpp"
#include "terrain/ground_events.hpp"
#include "terrain/ground_summary.hpp"
#include "tools/trial/record_difference.hpp"

namespace sandhopper {
namespace {

RobotConfig robot_of(const mcap::Reader& log, const std::filesystem::path& file) {
  for (const auto& attachment : log.attachments()) {
    if (attachment.name != kRobotAttachment) continue;
    const std::string_view text(reinterpret_cast<const char*>(attachment.data.data()),
                                attachment.data.size());
    // A key that the log's version did not have gets its default.
    return load_text<RobotConfig>(file.string() + ": " + std::string(kRobotAttachment), text,
                                  MissingKeys::use_default);
  }
  throw mcap::Error(file.string() + ": has no attachment " + std::string(kRobotAttachment) +
                    ", so the cycle's configuration is not known; was it made by hopperd or `hop trial`?");
}

// In a log without this attachment the cycle started without a kept state.
StartState start_of(const mcap::Reader& log, const std::filesystem::path& file) {
  for (const auto& attachment : log.attachments()) {
    if (attachment.name != kStartAttachment) continue;
    const std::string_view text(reinterpret_cast<const char*>(attachment.data.data()),
                                attachment.data.size());
    return load_text<StartState>(file.string() + ": " + std::string(kStartAttachment), text,
                                 MissingKeys::use_default);
  }
  return {};
}

CycleConfig config_of(const mcap::Reader& log, const RobotConfig& robot, const std::filesystem::path& file) {
  auto config = cycle_config(robot);
  config.start = start_of(log, file);
  return config;
}

// trial.mcap, trial.part0002.mcap, trial.part0003.mcap, ... (firmware/log/segmented_log.hpp)
std::filesystem::path next_segment(const std::filesystem::path& file) {
  constexpr std::size_t kDigits = 4;
  const auto stem = file.stem().string();
  const auto part = stem.rfind(".part");
  int number = 1;
  if (part != std::string::npos && part + 5 + kDigits == stem.size())
    number = std::stoi(stem.substr(part + 5));
  const auto name = fmt::format("{}.part{:04}{}", number == 1 ? stem : stem.substr(0, part), number + 1,
                                file.extension().string());
  return file.parent_path() / name;
}

// Compares one topic of the log, in order, with the replayed cycle's records.
template <class Record>
class Comparison {
 public:
  explicit Comparison(std::string_view name) : name_(name), topic_(name) {}

  // A topic's channel belongs to one file.
  void begin_file() { topic_ = TopicOf<Record>(name_); }

  // A record of the replayed cycle; it is compared when the logged record is read.
  void expect(const Record& record) { expected_.push_back(record); }

  // True if the message was of this topic.
  bool take(const mcap::Message& message, std::optional<ReplayMismatch>& mismatch) {
    if (!topic_.take(message, logged_)) return false;
    if (expected_.empty()) {
      if (!mismatch)
        mismatch = ReplayMismatch{name_, count_, message.stamp.log_ns, "logged, but not given by the replay"};
    } else {
      if (!mismatch && !same_bytes(expected_.front(), message.data))
        mismatch =
            ReplayMismatch{name_, count_, message.stamp.log_ns, first_difference(logged_, expected_.front())};
      expected_.pop_front();
    }
    ++count_;
    return true;
  }

  std::uint64_t count() const { return count_; }
  bool complete() const { return expected_.empty(); }
  const std::string& name() const { return name_; }

 private:
  bool same_bytes(const Record& record, mcap::Bytes data) {
    cdr::encode(record, buffer_.data());
    return buffer_.size() == data.size() && std::memcmp(buffer_.data(), data.data(), data.size()) == 0;
  }

  std::string name_;
  TopicOf<Record> topic_;
  Record logged_{};
  std::deque<Record> expected_;
  std::array<std::byte, cdr::size_of<Record>()> buffer_{};
  std::uint64_t count_ = 0;
};

class Replay {
 public:
  Replay(const std::filesystem::path& file, const std::function<void(double)>& progress,
         const std::function<void(const StrideSums&)>& stride)
      : file_(file),
        log_(std::make_unique<mcap::Reader>(file)),
        robot_(robot_of(*log_, file)),
        controller_(config_of(*log_, robot_, file)),
        profile_(robot_.stiffness),
        progress_(progress),
        stride_(stride) {}

  ReplayResult run() {
    const auto start = std::chrono::steady_clock::now();
    do {
      mcap::Message message;
      while (log_->next(message)) take(message);
      result_.truncated_at = log_->truncated_at();
      salvaged_ = salvaged_ || std::ranges::any_of(log_->metadata(), [](const mcap::Metadata& metadata) {
                    return metadata.name == "recovery";
                  });
      ++result_.files;
    } while (!result_.truncated_at && open_next());
    result_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const double logged_s = static_cast<double>(last_ns_ - first_ns_) * 1e-9;
    result_.x_real_time = result_.seconds > 0.0 ? logged_s / result_.seconds : 0.0;
    result_.events = events_.count();
    result_.strides = strides_.count();
    // A cut log, or one that `hop recover` restored, may lack the last records. A log that was closed must
    // have all of them.
    if (!result_.truncated_at && !salvaged_ && result_.gaps == 0) {
      report_missing(outputs_);
      report_missing(events_);
      report_missing(strides_);
      // Logs of versions without the strength profile lack these topics.
      if (profiles_.count() > 0) report_missing(profiles_);
      if (grounds_.count() > 0) report_missing(grounds_);
      if (ground_events_.count() > 0) report_missing(ground_events_);
    }
    return result_;
  }

 private:
  bool open_next() {
    file_ = next_segment(file_);
    if (!std::filesystem::exists(file_)) return false;
    log_ = std::make_unique<mcap::Reader>(file_);
    frames_ = TopicOf<SensorFrame>(topic::kFrame);
    gaps_ = TopicOf<LogGap>(topic::kGap);
    outputs_.begin_file();
    events_.begin_file();
    strides_.begin_file();
    profiles_.begin_file();
    grounds_.begin_file();
    ground_events_.begin_file();
    return true;
  }

  void take(const mcap::Message& message) {
    if (frames_.take(message, frame_)) {
      step();
      if (progress_ && result_.cycles % 4096 == 0)
        progress_(static_cast<double>(message.offset) / static_cast<double>(log_->file_bytes()));
      return;
    }
    if (outputs_.take(message, result_.mismatch) || events_.take(message, result_.mismatch) ||
        strides_.take(message, result_.mismatch) || profiles_.take(message, result_.mismatch) ||
        grounds_.take(message, result_.mismatch) || ground_events_.take(message, result_.mismatch))
      return;
    LogGap gap;
    if (gaps_.take(message, gap)) result_.gaps += gap.lost;
  }

  void step() {
    if (result_.cycles++ == 0) first_ns_ = frame_.time_ns;
    last_ns_ = frame_.time_ns;
    outputs_.expect(controller_.step(frame_));
    for (const auto& event : controller_.events()) events_.expect(event);
    if (controller_.stride_finished()) expect_stride(controller_.stride_sums());
    if (controller_.ground_events_complete())
      ground_events_.expect(find_ground_events(controller_.ground_event_sums(),
                                               ground_event_config(robot_.stiffness), profile_.profile()));
  }

  void expect_stride(const StrideSums& sums) {
    if (stride_) stride_(sums);
    strides_.expect(solve_stride(sums, robot_.stiffness));
    profile_.add(sums.profile, sums.summary.stride);
    profiles_.expect(profile_.profile());
    grounds_.expect(summarise(profile_));
  }

  template <class Record>
  void report_missing(const Comparison<Record>& topic) {
    if (!topic.complete() && !result_.mismatch)
      result_.mismatch =
          ReplayMismatch{topic.name(), topic.count(), last_ns_, "given by the replay, but not logged"};
  }

  std::filesystem::path file_;
  std::unique_ptr<mcap::Reader> log_;
  RobotConfig robot_;
  Controller controller_;
  ProfileSolver profile_;
  std::function<void(double)> progress_;
  std::function<void(const StrideSums&)> stride_;
  TopicOf<SensorFrame> frames_{topic::kFrame};
  TopicOf<LogGap> gaps_{topic::kGap};
  Comparison<StepOutput> outputs_{topic::kOutput};
  Comparison<Event> events_{topic::kEvent};
  Comparison<StrideResult> strides_{topic::kStride};
  Comparison<StrengthProfile> profiles_{topic::kProfile};
  Comparison<GroundSummary> grounds_{topic::kGround};
  Comparison<GroundEvents> ground_events_{topic::kGroundEvents};
  SensorFrame frame_{};
  ReplayResult result_{};
  bool salvaged_ = false;
  std::int64_t first_ns_ = 0;
  std::int64_t last_ns_ = 0;
};

}  // namespace

ReplayResult replay_log(const std::filesystem::path& log, const std::function<void(double)>& progress,
                        const std::function<void(const StrideSums&)>& stride) {
  return Replay(log, progress, stride).run();
}

}  // namespace sandhopper
