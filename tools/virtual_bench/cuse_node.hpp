#pragma once
#include <sys/uio.h>

#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "drivers/unique_fd.hpp"
#include "tools/virtual_bench/event_loop.hpp"

struct fuse_buf;
struct fuse_req;
struct fuse_session;

// A character device under /dev served by this process (CUSE): I2C and SPI nodes with the ioctls of the real
// ones.
namespace sandhopper::bench {

// An ioctl under way. Its argument points into the caller's memory, which the kernel copies only where it is
// told to: a device that needs more calls fetch() and is called again with more in in(). End with reply() or
// fail().
class Ioctl {
 public:
  struct Call {
    fuse_req* request;
    unsigned command;
    void* argument;
    std::span<const std::uint8_t> in;
    std::size_t out_size;
  };
  explicit Ioctl(const Call& call) : call_(call) {}

  unsigned command() const noexcept { return call_.command; }
  std::uintptr_t argument() const noexcept { return reinterpret_cast<std::uintptr_t>(call_.argument); }
  std::span<const std::uint8_t> in() const noexcept { return call_.in; }
  std::size_t out_size() const noexcept { return call_.out_size; }

  void fetch(std::span<const iovec> in, std::span<const iovec> out);
  bool goes_on() const noexcept { return goes_on_; }  // after fetch()
  void reply(int result, std::span<const std::uint8_t> out = {});
  void fail(int error);

  // A value the argument points at, once it is here; nothing: it has been asked for.
  template <class T>
  std::optional<T> pointed_at() {
    T value;
    if (in().size() < sizeof value) {
      const iovec where{call_.argument, sizeof value};
      fetch({&where, 1}, {});
      return std::nullopt;
    }
    std::memcpy(&value, in().data(), sizeof value);
    return value;
  }

  // Writes a value to where the argument points, and ends the ioctl.
  template <class T>
  void return_value(const T& value) {
    const iovec where{call_.argument, sizeof value};
    if (out_size() < sizeof value) return fetch({}, {&where, 1});
    reply(0, {reinterpret_cast<const std::uint8_t*>(&value), sizeof value});
  }

 private:
  Call call_;
  bool goes_on_ = false;
};

class CuseNode {
 public:
  // Creates /dev/<name>. Throws std::runtime_error.
  CuseNode(EventLoop& loop, const std::string& name);
  virtual ~CuseNode();
  CuseNode(const CuseNode&) = delete;
  CuseNode& operator=(const CuseNode&) = delete;

 protected:
  // One number an open file carries; read, written and changed by its calls.
  using File = std::uint64_t;

  virtual void ioctl(Ioctl& call, File& file) = 0;
  // Number of bytes, or a negative error number.
  virtual int read(std::span<std::uint8_t> out, File& file) = 0;
  virtual int write(std::span<const std::uint8_t> in, File& file) = 0;

 private:
  friend struct CuseCallbacks;
  void serve();
  bool serve_one();

  EventLoop& loop_;
  UniqueFd fd_;
  fuse_session* session_ = nullptr;
  std::unique_ptr<fuse_buf, void (*)(fuse_buf*)> buffer_;
  bool ready_ = false;
  bool more_soon_ = false;  // the ioctl just served comes back at once
};

}  // namespace sandhopper::bench
