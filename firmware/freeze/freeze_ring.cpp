#include "firmware/freeze/freeze_ring.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <new>
#include <stdexcept>
#include <system_error>

#include "firmware/log/schema_text.hpp"
#include "firmware/version.hpp"

namespace sandhopper {
namespace {

constexpr std::array<char, 8> kMagic{'H', 'O', 'P', 'F', 'R', 'Z', '0', '\n'};

template <std::size_t N>
void put_text(std::array<char, N>& field, std::string_view text) {
  text.copy(field.data(), std::min(text.size(), N - 1));
}

template <std::size_t N>
std::string text_in(const std::array<char, N>& field) {
  return {field.data(),
          static_cast<std::size_t>(std::find(field.begin(), field.end(), '\0') - field.begin())};
}

// Writes texts one after the other, each after its length. A text without enough room is left out, and so are
// all that follow it.
class TextWriter {
 public:
  explicit TextWriter(std::span<char> room) : room_(room) {}
  bool put(std::string_view text) {
    const auto length = static_cast<std::uint32_t>(text.size());
    if (full_ || used_ + sizeof length + text.size() > room_.size()) return !(full_ = true);
    std::memcpy(room_.data() + used_, &length, sizeof length);
    text.copy(room_.data() + used_ + sizeof length, text.size());
    used_ += sizeof length + text.size();
    return true;
  }
  std::size_t used() const { return used_; }

 private:
  std::span<char> room_;
  std::size_t used_ = 0;
  bool full_ = false;
};

class TextReader {
 public:
  explicit TextReader(std::string_view all) : rest_(all) {}
  std::optional<std::string> take() {
    std::uint32_t length = 0;
    if (rest_.size() < sizeof length) return std::nullopt;
    std::memcpy(&length, rest_.data(), sizeof length);
    rest_.remove_prefix(sizeof length);
    if (rest_.size() < length) return std::nullopt;
    std::string text(rest_.substr(0, length));
    rest_.remove_prefix(length);
    return text;
  }

 private:
  std::string_view rest_;
};

// An attachment is "A", name, media type, text; a metadata entry is "M", name, key, value. Only whole entries
// count.
std::size_t write_description(const LogDescription& description, std::span<char> room) {
  TextWriter out(room);
  std::size_t whole = 0;
  const auto item = [&](std::string_view kind, std::string_view a, std::string_view b, std::string_view c) {
    if (out.put(kind) && out.put(a) && out.put(b) && out.put(c)) whole = out.used();
  };
  for (const auto& [name, entries] : description.metadata)
    for (const auto& [key, value] : entries) item("M", name, key, value);
  for (const auto& a : description.attachments) item("A", a.name, a.media_type, a.text);
  return whole;
}

// Creates a file with all of its memory reserved. So a full tmpfs is an error here and not a SIGBUS in the
// cycle.
UniqueFd make_file(const std::filesystem::path& path) {
  const auto fail = [&](int error, const char* what) -> UniqueFd {
    throw std::system_error(error, std::generic_category(), path.string() + ": " + what);
  };
  UniqueFd file(::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0640));
  if (!file) return fail(errno, "cannot make the memory of the freeze frames");
  if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0) return fail(errno, "cannot be locked");
  if (const int error = ::posix_fallocate(file.get(), 0, sizeof(freeze::Block)); error != 0) {
    ::unlink(path.c_str());
    return fail(error, "no memory for the freeze frames");
  }
  return file;
}

}  // namespace

std::uint64_t freeze::schema_hash() {
  std::uint64_t hash = 14'695'981'039'346'656'037U;
  const auto add = [&](std::string_view text) {
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1'099'511'628'211U;
  };
  for (const auto& text :
       {schema::text_of<SensorFrame>(), schema::text_of<StepOutput>(), schema::text_of<Event>()})
    add(text);
  for (const std::size_t size : {sizeof(SensorFrame), sizeof(StepOutput), sizeof(Event), sizeof(Slot)})
    add(std::to_string(size));
  return hash;
}

FreezeRing::FreezeRing(const Options& options) : file_(options.file), lock_(make_file(options.file)) {
  void* memory = ::mmap(nullptr, sizeof(freeze::Block), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE,
                        lock_.get(), 0);
  if (memory == MAP_FAILED) {
    const int error = errno;
    remove();
    throw std::system_error(error, std::generic_category(), file_.string() + ": cannot be mapped");
  }
  ::mlock(memory, sizeof(freeze::Block));  // if it is not permitted the pages may be swapped out
  block_ = ::new (memory) freeze::Block;
  freeze::Header& header = block_->header;
  header.layout = freeze::kLayout;
  header.slot_bytes = sizeof(freeze::Slot);
  header.slots = freeze::kSlots;
  header.schema_hash = freeze::schema_hash();
  header.start_ns = options.start_ns;
  header.realtime_offset_ns = options.realtime_offset_ns;
  header.process = ::getpid();
  put_text(header.version, kVersion);
  put_text(header.log_file, options.log_file.string());
  header.text_bytes = static_cast<std::uint32_t>(write_description(options.description, block_->text));
  std::atomic_thread_fence(std::memory_order_release);
  header.magic = kMagic;
}

FreezeRing::~FreezeRing() {
  if (block_ != nullptr) ::munmap(block_, sizeof(freeze::Block));
}

void FreezeRing::remove() noexcept { ::unlink(file_.c_str()); }

FreezeReader::FreezeReader(std::span<const std::byte> bytes) {
  if (bytes.size() < sizeof(freeze::Header))
    throw std::runtime_error("too short for a freeze frame's memory");
  header_ = reinterpret_cast<const freeze::Header*>(bytes.data());
  if (header_->magic != kMagic) throw std::runtime_error("no freeze frame's memory");
  if (header_->layout != freeze::kLayout || header_->schema_hash != freeze::schema_hash() ||
      header_->slot_bytes != sizeof(freeze::Slot) || header_->slots != freeze::kSlots)
    throw std::runtime_error("written by another build of hopperd (version " + version() +
                             "); read it with that build's hop");
  if (bytes.size() < sizeof(freeze::Block)) throw std::runtime_error("cut short");
  const auto* block = reinterpret_cast<const freeze::Block*>(bytes.data());
  if (header_->text_bytes > block->text.size()) throw std::runtime_error("its description is damaged");
  text_ = block->text.data();
  slots_ = block->slots.data();
}

std::string FreezeReader::version() const { return text_in(header_->version); }

std::filesystem::path FreezeReader::log_file() const { return text_in(header_->log_file); }

LogDescription FreezeReader::description() const {
  LogDescription description;
  TextReader in({text_, header_->text_bytes});
  while (const auto kind = in.take()) {
    const auto a = in.take(), b = in.take(), c = in.take();
    if (!c) break;
    if (*kind == "A") {
      description.attachments.push_back({*a, *b, *c});
      continue;
    }
    auto& metadata = description.metadata;
    if (metadata.empty() || metadata.back().first != *a) metadata.push_back({*a, {}});
    metadata.back().second[*b] = *c;
  }
  return description;
}

std::uint64_t FreezeReader::oldest() const {
  const std::uint64_t newest = count();
  return newest > freeze::kSlots ? newest - freeze::kSlots + 1 : 1;
}

std::optional<FreezeCycle> FreezeReader::cycle(std::uint64_t number) const {
  if (number == 0) return std::nullopt;
  const freeze::Slot& slot = slots_[(number - 1) % freeze::kSlots];
  if (slot.number.load(std::memory_order_acquire) != number) return std::nullopt;
  FreezeCycle copy = slot.cycle;
  std::atomic_thread_fence(std::memory_order_acquire);
  if (slot.number.load(std::memory_order_relaxed) != number) return std::nullopt;
  return copy;
}

}  // namespace sandhopper
