#pragma once
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "firmware/log/candump.hpp"
#include "firmware/log/spsc_ring.hpp"

namespace sandhopper {

// CAN part of a trial's log: frames of any number of interfaces, each fed by one thread, go into one candump
// file in the order of their times. Frames arrive slightly out of order (a reply is read a cycle after the
// command that followed it). So they are held for 50 ms of their own time and sorted. The file does not
// depend on the timing of the threads or the logger.
class CanLog {
 public:
  CanLog(const std::filesystem::path& file, std::int64_t realtime_offset_ns, std::size_t slots,
         FileCalls calls = FileCalls::of_the_system());

  // Call it before the first frame. Returns the number for push().
  std::size_t add_interface(std::string name);

  // Wait-free, from one thread per interface. `frame.time_ns` is CLOCK_MONOTONIC. Frames that do not fit or
  // that the disk does not take are lost, counted, and noted in the file as a comment.
  void push(std::size_t interface, const CandumpFrame& frame) noexcept;

  // The following are called by the logger's thread. begin_file and the constructor throw std::system_error.
  void drain();
  void begin_file(const std::filesystem::path& file);  // later frames go into this file
  void close();
  const std::string& error() const { return error_; }  // the first error

  // Any thread. Frames that did not fit or that the disk did not take.
  std::uint64_t lost() const;

 private:
  static constexpr std::int64_t kHold_ns = 50'000'000;
  static constexpr std::int64_t kSyncSpan_ns =
      1'000'000'000;  // of the frames' time, between two fdatasync(2)

  struct Interface {  // NOLINT(clang-analyzer-optin.performance.Padding): the ring's own
    Interface(std::string its_name, std::size_t slots) : name(std::move(its_name)), ring(slots) {}
    std::string name;
    SpscRing<CandumpFrame> ring;
    std::uint64_t noted_drops = 0;
  };
  struct Held {
    CandumpFrame frame;
    std::size_t interface = 0;
  };

  void hold(const CandumpFrame& frame, std::size_t interface);
  void write_until(std::int64_t time_ns);
  void note_drops();
  void sync();
  void note_error(const std::string& error);
  std::unique_ptr<CandumpWriter> make_writer(const std::filesystem::path& file) const;

  FileCalls calls_;
  std::unique_ptr<CandumpWriter> writer_;
  std::int64_t realtime_offset_ns_;
  std::size_t slots_;
  std::vector<std::unique_ptr<Interface>> interfaces_;
  std::vector<Held> held_;  // sorted
  std::int64_t newest_ns_ = INT64_MIN;
  std::int64_t synced_ns_ = INT64_MIN;
  std::uint64_t lost_in_older_files_ = 0;
  std::atomic<std::uint64_t> lost_on_disk_{0};
  std::string error_;
};

}  // namespace sandhopper
