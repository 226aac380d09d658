// Fuzz target of the operator's channel, from bytes to the cycle and back to JSON. The input is cut into
// reads, and cycles run between them. Every word must be answered once with valid JSON. No arm or release of
// a read with a stop may be served, and none after a quit.
#include <algorithm>
#include <atomic>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "firmware/operator_channel.hpp"
#include "firmware/operator_text.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace {

using namespace sandhopper;

void require_json(const std::string& line) {
  fuzz::require(!nlohmann::json::parse(line, nullptr, false).is_discarded(), "an answer is JSON");
}

bool starts(Word word) { return word == Word::arm || word == Word::release; }

class Channel {
 public:
  void read(std::string_view bytes) {
    lines_.clear();
    reader_.read(bytes, lines_);
    post();
  }
  void end() {
    lines_.clear();
    reader_.end(lines_);
    lines_.push_back({Word::end_of_input, ""});
    post();
    std::size_t before;
    do {
      before = answered_;
      cycle();
    } while (answered_ != before);
    fuzz::require(answered_ == posted_, "every word is answered once");
  }
  void cycle() {
    const auto taken = box_.take(++time_ns_, quit_);
    for (const auto& answer : taken.answers) {
      answered_ += answer.count;
      if (told_++ < kTold) require_json(operator_text(answer));
      if (answer.outcome == RequestOutcome::served && starts(answer.word)) {
        fuzz::require(!stopped_reads_.contains(answer.received_ns),
                      "no arm or release of a read with a stop");
        fuzz::require(quit_ == Quit::no, "nor after a quit");
      }
    }
    fuzz::require(taken.request == Request::none || !taken.answers.empty() || quit_ != Quit::no, "a cause");
  }

 private:
  void post() {
    std::vector<Word> words;
    ++read_;
    for (const auto& line : lines_) {
      words.push_back(line.word);
      fuzz::require(line.text.size() <= WordReader::kShown, "shown in short");
      if (line.word == Word::unknown && told_++ < kTold) require_json(operator_text("error", line.text));
      if (means_stop(line.word)) stopped_reads_.insert(read_);
    }
    posted_ += words.size();
    post_words(words, read_, box_, quit_);
  }

  static constexpr int kTold = 8;  // number of lines converted to text, which takes most of the time
  WordReader reader_;
  RequestBox box_;
  std::atomic<Quit> quit_{Quit::no};
  std::vector<WordReader::Line> lines_;
  std::set<std::int64_t> stopped_reads_;
  std::int64_t read_ = 0;
  std::int64_t time_ns_ = 0;
  std::size_t posted_ = 0;
  std::size_t answered_ = 0;
  int told_ = 0;
};

}  // namespace

// A byte that ends a piece: its low bits are the number of cycles before the next piece.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kMost = 4096;  // one read's worth; more only costs time
  Channel channel;
  size = std::min(size, kMost);
  fuzz::Bytes bytes({data, size});
  while (!bytes.empty()) {
    const std::uint8_t plan = bytes.byte();
    channel.read(fuzz::text_of(bytes.take(1U + (plan & 0x3FU) * 4U)));
    for (int i = 0; i < (plan >> 6); ++i) channel.cycle();
  }
  channel.end();
  return 0;
}
