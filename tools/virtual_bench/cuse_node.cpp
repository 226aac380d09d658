#include "tools/virtual_bench/cuse_node.hpp"

#define FUSE_USE_VERSION 31
#include <cuse_lowlevel.h>
#include <fcntl.h>
#include <fuse_lowlevel.h>

#include <cerrno>
#include <cstdlib>
#include <stdexcept>
#include <vector>

namespace sandhopper::bench {

// What libfuse calls: each finds its node, and its open file, whose address is libfuse's file handle.
struct CuseCallbacks {
  static CuseNode& node(fuse_req_t request) { return *static_cast<CuseNode*>(fuse_req_userdata(request)); }
  static CuseNode::File& file(const fuse_file_info* info) {
    return *reinterpret_cast<CuseNode::File*>(info->fh);
  }

  static void init_done(void* node) { static_cast<CuseNode*>(node)->ready_ = true; }

  static void open(fuse_req_t request, fuse_file_info* info) {
    info->fh = reinterpret_cast<std::uintptr_t>(new CuseNode::File{0});
    fuse_reply_open(request, info);
  }

  static void release(fuse_req_t request, fuse_file_info* info) {
    delete &file(info);
    fuse_reply_err(request, 0);
  }

  static void read(fuse_req_t request, size_t size, off_t, fuse_file_info* info) {
    std::vector<std::uint8_t> data(size);
    const int count = node(request).read(data, file(info));
    if (count < 0)
      fuse_reply_err(request, -count);
    else
      fuse_reply_buf(request, reinterpret_cast<const char*>(data.data()), static_cast<size_t>(count));
  }

  static void write(fuse_req_t request, const char* data, size_t size, off_t, fuse_file_info* info) {
    const int count = node(request).write({reinterpret_cast<const std::uint8_t*>(data), size}, file(info));
    if (count < 0)
      fuse_reply_err(request, -count);
    else
      fuse_reply_write(request, static_cast<size_t>(count));
  }

  static void ioctl(fuse_req_t request, int command, void* argument, fuse_file_info* info, unsigned,
                    const void* in, size_t in_size, size_t out_size) {
    Ioctl call({.request = request,
                .command = static_cast<unsigned>(command),
                .argument = argument,
                .in = {static_cast<const std::uint8_t*>(in), in_size},
                .out_size = out_size});
    auto& served = node(request);  // `request` is gone once it is answered
    served.ioctl(call, file(info));
    served.more_soon_ = call.goes_on();
  }
};

namespace {

void free_buffer(fuse_buf* buffer) {
  std::free(buffer->mem);
  delete buffer;
}

}  // namespace

void Ioctl::fetch(std::span<const iovec> in, std::span<const iovec> out) {
  goes_on_ = true;
  fuse_reply_ioctl_retry(call_.request, in.data(), in.size(), out.data(), out.size());
}

void Ioctl::reply(int result, std::span<const std::uint8_t> out) {
  fuse_reply_ioctl(call_.request, result, out.data(), out.size());
}

void Ioctl::fail(int error) { fuse_reply_err(call_.request, error); }

CuseNode::CuseNode(EventLoop& loop, const std::string& name)
    : loop_(loop), fd_(::open("/dev/cuse", O_RDWR | O_CLOEXEC)), buffer_(new fuse_buf{}, free_buffer) {
  if (!fd_) throw std::runtime_error("/dev/cuse cannot be opened: run this inside tools/bench");
  cuse_lowlevel_ops operations{};
  operations.init_done = CuseCallbacks::init_done;
  operations.open = CuseCallbacks::open;
  operations.release = CuseCallbacks::release;
  operations.read = CuseCallbacks::read;
  operations.write = CuseCallbacks::write;
  operations.ioctl = CuseCallbacks::ioctl;

  const std::string device_name = "DEVNAME=" + name;
  const char* information[] = {device_name.c_str()};
  cuse_info device{};
  device.dev_info_argc = 1;
  device.dev_info_argv = information;
  device.flags = CUSE_UNRESTRICTED_IOCTL;

  char program[] = "bench-devices";
  char* arguments_text[] = {program, nullptr};
  fuse_args arguments = FUSE_ARGS_INIT(1, arguments_text);
  session_ = cuse_lowlevel_new(&arguments, &device, &operations, this);
  // libfuse takes an open descriptor in place of a mount point.
  const auto opened = "/dev/fd/" + std::to_string(fd_.get());
  if (session_ == nullptr || fuse_session_mount(session_, opened.c_str()) != 0)
    throw std::runtime_error("/dev/" + name + " cannot be made: libfuse refuses");
  while (!ready_ && fuse_session_exited(session_) == 0) serve();
  if (!ready_)
    throw std::runtime_error("/dev/" + name + " cannot be made: the kernel refuses, or it is there already");
  ::fcntl(fd_.get(), F_SETFL, O_NONBLOCK);
  loop_.watch(fd_.get(), [this] { serve(); });
}

CuseNode::~CuseNode() {
  loop_.forget(fd_.get());
  if (session_ != nullptr) fuse_session_destroy(session_);
}

// The parts of one ioctl follow each other without a wait: the caller is woken by each answer and asks on.
void CuseNode::serve() {
  do more_soon_ = false;
  while (serve_one() && more_soon_);
}

bool CuseNode::serve_one() {
  const int size = fuse_session_receive_buf(session_, buffer_.get());
  if (size > 0) fuse_session_process_buf(session_, buffer_.get());
  if (size == 0 || (size < 0 && size != -EINTR && size != -EAGAIN)) fuse_session_exit(session_);
  return size > 0;
}

}  // namespace sandhopper::bench
