// Writes a log, and prints what this project's reader finds in one, for comparison with another reader:
//   reference_log write FILE SECONDS     a log of made-up records that fill every field
//   reference_log dump FILE              JSON lines: a topic's fields once, then each message
//   reference_log count FILE             messages, time of the last one, place of the cut or -1
#include <bit>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>
#include <random>

#include "firmware/log/topics.hpp"
#include "firmware/log/trial_logger.hpp"
#include "firmware/records.hpp"
#include "firmware/sensor_frame.hpp"
#include "tools/plant/plant_truth.hpp"

namespace sandhopper {
namespace {

template <class T>
inline constexpr bool kIsArray = cdr::detail::kIsArray<T>;

// Fills every field with random bits. A double gets any value that JavaScript can represent (no payload of a
// NaN).
struct Filler {
  std::mt19937_64& random;
  template <class T>
  void operator()(std::string_view, T& value) {
    fill(value);
  }
  template <class T>
  void fill(T& value) {
    if constexpr (kIsArray<T>) {
      for (auto& element : value) fill(element);
    } else if constexpr (HasFields<T>) {
      T::fields(value, *this);
    } else if constexpr (std::is_same_v<T, bool>) {
      value = (random() & 1) != 0;
    } else if constexpr (std::is_same_v<T, double>) {
      const auto any = std::bit_cast<double>(random());
      value = std::isnan(any) ? kNotMeasured : any;
    } else if constexpr (NamedEnum<T>) {
      value = static_cast<T>(random() % EnumNames<T>::value.size());
    } else {
      value = static_cast<T>(random());
    }
  }
};

// Paths and values in the order of encoding: integers as decimals, doubles as their 64 bits.
struct Printer {
  std::string paths;
  std::string values;
  std::string prefix{};
  template <class T>
  void operator()(std::string_view name, const T& value) {
    const std::string outer = prefix;
    prefix += (prefix.empty() ? "" : ".") + schema::detail::lower_case(name);
    print(value);
    prefix = outer;
  }
  template <class T>
  void print(const T& value) {
    if constexpr (kIsArray<T>) {
      const std::string outer = prefix;
      for (std::size_t i = 0; i < value.size(); ++i) {
        prefix = outer + '.' + std::to_string(i);
        print(value[i]);
      }
      prefix = outer;
    } else if constexpr (HasFields<T>) {
      T::fields(value, *this);
    } else {
      paths += (paths.empty() ? "\"" : ",\"") + prefix + '"';
      values += (values.empty() ? "\"" : ",\"") + text(value) + '"';
    }
  }
  template <class T>
  static std::string text(T value) {
    if constexpr (std::is_same_v<T, double>) {
      if (std::isnan(value)) return "nan";
      char bits[17];
      std::snprintf(bits, sizeof bits, "%016lx", std::bit_cast<std::uint64_t>(value));
      return bits;
    } else {
      return std::to_string(
          static_cast<std::conditional_t<std::is_unsigned_v<T>, std::uint64_t, std::int64_t>>(value));
    }
  }
};

template <class Record>
bool dump_message(const mcap::Message& message, bool first) {
  if (message.channel->schema.name != schema::message_name<Record>()) return false;
  mcap::require_schema<Record>(*message.channel);
  Record record;
  if (!cdr::decode(message.data, record)) throw mcap::Error("a message of the wrong size");
  Printer printer;
  Record::fields(record, printer);
  const std::string topic = "{\"topic\":\"" + message.channel->topic + "\",";
  if (first) std::cout << topic << "\"paths\":[" << printer.paths << "]}\n";
  std::cout << topic << "\"sequence\":" << message.sequence << ",\"log\":\"" << message.stamp.log_ns
            << "\",\"publish\":\"" << message.stamp.publish_ns << "\",\"values\":[" << printer.values
            << "]}\n";
  return true;
}

int dump(const char* file) {
  mcap::Reader log(file);
  std::map<std::string, int> seen;
  for (mcap::Message message; log.next(message);) {
    const bool first = seen[message.channel->topic]++ == 0;
    if (!dump_message<SensorFrame>(message, first) && !dump_message<StepOutput>(message, first) &&
        !dump_message<Event>(message, first) && !dump_message<StrideResult>(message, first) &&
        !dump_message<PlantTruth>(message, first) && !dump_message<LogGap>(message, first))
      throw mcap::Error("no record here is called " + message.channel->schema.name);
  }
  return 0;
}

int count(const char* file) {
  mcap::Reader log(file);
  std::uint64_t messages = 0;
  std::int64_t last_ns = 0;
  for (mcap::Message message; log.next(message); ++messages) last_ns = message.stamp.log_ns;
  std::cout << messages << ' ' << last_ns << ' '
            << (log.truncated_at() ? static_cast<std::int64_t>(*log.truncated_at()) : -1) << '\n';
  return 0;
}

template <class Record>
void push_random(TrialLogger& logger, LogTopic<Record> topic, std::int64_t time_ns, std::mt19937_64& random) {
  Record record;
  Filler filler{random};
  Record::fields(record, filler);
  logger.push(topic, time_ns, record);
}

int write(const char* file, int seconds) {
  std::mt19937_64 random(2);
  TrialLogOptions options;
  options.mcap_file = file;
  options.realtime_offset_ns = 1'700'000'000'123'456'789;
  TrialLogger logger(options);
  const auto frames = logger.add_topic<SensorFrame>(topic::kFrame);
  const auto outputs = logger.add_topic<StepOutput>(topic::kOutput);
  const auto events = logger.add_topic<Event>(topic::kEvent);
  const auto strides = logger.add_topic<StrideResult>(topic::kStride, Lane::background);
  const auto truths = logger.add_topic<PlantTruth>(topic::kTruth);
  logger.attach("robot.toml", "application/toml", "# what the trial ran with\nmass_kg = 1.0\n");
  logger.add_metadata("build", {{"version", "0"}, {"commit", "none"}});
  logger.start();
  for (std::int64_t i = 0; i < std::int64_t{1'000} * seconds; ++i) {
    const std::int64_t time_ns = 1'000'000 * i;
    push_random(logger, frames, time_ns, random);
    push_random(logger, outputs, time_ns, random);
    push_random(logger, truths, time_ns, random);
    if (i % 97 == 0) push_random(logger, events, time_ns, random);
    if (i % 401 == 400) push_random(logger, strides, time_ns - 5'000'000, random);
    // the ring holds 2.7 s of records
    if (i % 1'000 == 999) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  logger.stop();
  logger.close();
  if (logger.lost_records() == 0) return 0;
  std::cerr << logger.lost_records() << " records lost\n";
  return 1;
}

}  // namespace
}  // namespace sandhopper

int main(int argc, char** argv) try {
  const std::string_view verb = argc > 2 ? argv[1] : "";
  if (verb == "write" && argc == 4) return sandhopper::write(argv[2], std::atoi(argv[3]));
  if (verb == "dump") return sandhopper::dump(argv[2]);
  if (verb == "count") return sandhopper::count(argv[2]);
  std::cerr << "reference_log write FILE SECONDS | dump FILE | count FILE\n";
  return 2;
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
