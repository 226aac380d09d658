#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <utility>

namespace sandhopper {

// A file mapped for sequential reading; the kernel may drop its pages. Throws std::system_error.
class MappedFile {
 public:
  MappedFile() = default;
  explicit MappedFile(const std::filesystem::path& file);
  ~MappedFile();
  MappedFile(MappedFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}
  MappedFile& operator=(MappedFile&&) = delete;

  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace sandhopper
