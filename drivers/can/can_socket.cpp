#include "drivers/can/can_socket.hpp"

#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <linux/net_tstamp.h>
#include <linux/sock_diag.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>

#include "drivers/clock.hpp"
#include "drivers/device_error.hpp"

namespace sandhopper {

namespace {

constexpr std::size_t kBatchSize = 16;
constexpr std::int64_t kStampSlack_ns = 200'000;
constexpr std::size_t kControlSize = CMSG_SPACE(3 * sizeof(timespec)) + CMSG_SPACE(sizeof(std::uint32_t));

template <class T>
void set_option(int fd, int level, int name, const T& value, const std::string& interface, const char* what) {
  if (::setsockopt(fd, level, name, &value, sizeof value) != 0)
    throw DeviceError(interface, errno_cause(what),
                      "The kernel lacks a SocketCAN feature: use 5.10 or later");
}

// Not subscribed: lost arbitration is normal, and one frame per bus error would flood the socket if a cable
// is off.
constexpr can_err_mask_t kErrorClasses = CAN_ERR_TX_TIMEOUT | CAN_ERR_CRTL | CAN_ERR_PROT | CAN_ERR_TRX |
                                         CAN_ERR_ACK | CAN_ERR_BUSOFF | CAN_ERR_RESTARTED;

int index_of(const std::string& interface, int fd) {
  const std::string cure =
      "Bring it up: ip link set " + interface +
      " up type can bitrate 1000000 (on the virtual bench: run inside tools/bench), or name "
      "another in can.interface";
  ifreq request{};
  if (interface.empty() || interface.size() >= sizeof request.ifr_name)
    throw DeviceError("can.interface", "\"" + interface + "\" is not an interface's name", cure);
  std::memcpy(request.ifr_name, interface.c_str(), interface.size());
  if (::ioctl(fd, SIOCGIFINDEX, &request) != 0)
    throw DeviceError(interface, errno_cause("no such CAN interface"), cure);
  const int index = request.ifr_ifindex;
  if (::ioctl(fd, SIOCGIFFLAGS, &request) != 0)
    throw DeviceError(interface, errno_cause("cannot read the interface's state"), cure);
  if ((request.ifr_flags & IFF_UP) == 0) throw DeviceError(interface, "the interface is down", cure);
  return index;
}

}  // namespace

can_filter exact_standard_id(canid_t id) noexcept { return {id, CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG}; }

can_filter exact_extended_id(canid_t id) noexcept {
  return {id | CAN_EFF_FLAG, CAN_EFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG};
}

// Buffers of one recvmmsg call, prepared once.
struct CanSocket::Batch {
  Batch() {
    for (std::size_t i = 0; i < kBatchSize; ++i) {
      io[i] = {&raw[i], sizeof raw[i]};
      headers[i].msg_hdr.msg_iov = &io[i];
      headers[i].msg_hdr.msg_iovlen = 1;
      headers[i].msg_hdr.msg_control = control[i].data();
    }
  }

  std::array<can_frame, kBatchSize> raw{};
  std::array<ReceivedFrame, kBatchSize> frames{};
  std::array<iovec, kBatchSize> io{};
  std::array<mmsghdr, kBatchSize> headers{};
  alignas(cmsghdr) std::array<std::array<char, kControlSize>, kBatchSize> control{};
};

CanSocket::CanSocket(const std::string& interface, std::span<const can_filter> filters)
    : fd_(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW)),
      emptied_ns_(monotonic_ns()),
      batch_(std::make_unique<Batch>()),
      echoes_(!filters.empty()) {
  if (!fd_)
    throw DeviceError(interface, errno_cause("cannot open a CAN socket"),
                      "Load SocketCAN (modprobe can_raw), or run on the virtual bench: tools/bench COMMAND");
  const int fd = fd_.get();
  const int index = index_of(interface, fd);
  if (::setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(),
                   static_cast<socklen_t>(filters.size_bytes())) != 0)
    throw DeviceError(interface, errno_cause("cannot set the receive filter"),
                      "Use a kernel with CAN_RAW filters");
  set_option(fd, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, kErrorClasses, interface, "cannot receive error frames");
  set_option(fd, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, echoes_ ? 1 : 0, interface, "no echoes of own frames");
  set_option(fd, SOL_SOCKET, SO_RXQ_OVFL, 1, interface, "cannot count dropped frames");
  const int stamps = SOF_TIMESTAMPING_SOFTWARE | SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_RAW_HARDWARE;
  set_option(fd, SOL_SOCKET, SO_TIMESTAMPING, stamps, interface, "cannot ask for receive time stamps");
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = index;
  if (::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    throw DeviceError(interface, errno_cause("cannot bind"),
                      "Check that it is a CAN interface: ip -details link");
}

CanSocket::~CanSocket() = default;

// The kernel charges queued frames to the socket until the driver takes them (getsockopt SO_MEMINFO, Linux
// 4.12). If the call fails the queue is unknown and the cycle continues. The ledger tracks frames that the
// driver has taken.
void CanSocket::begin_cycle() noexcept {
  std::array<std::uint32_t, SK_MEMINFO_VARS> memory{};
  socklen_t size = sizeof memory;
  holding_ = ::getsockopt(fd_.get(), SOL_SOCKET, SO_MEMINFO, memory.data(), &size) == 0 &&
             memory[SK_MEMINFO_WMEM_ALLOC] > 0;
  holding_ = holding_ || ledger_.holds(monotonic_ns());
  if (holding_) ++counters_.send_failures;
}

std::optional<std::int64_t> CanSocket::send(const can_frame& frame) noexcept {
  if (holding_) return std::nullopt;
  const auto now = monotonic_ns();
  if (::write(fd_.get(), &frame, sizeof frame) != static_cast<ssize_t>(sizeof frame)) {
    ++counters_.send_failures;
    return std::nullopt;
  }
  ++counters_.sent;
  if (echoes_) ledger_.sent(frame.can_id, now);
  if (tap_ != nullptr) tap_->on_frame(frame, now, true);
  return now;
}

std::span<const ReceivedFrame> CanSocket::receive(bool& more) noexcept {
  auto& b = *batch_;
  for (auto& header : b.headers) header.msg_hdr.msg_controllen = kControlSize;
  const int count = ::recvmmsg(fd_.get(), b.headers.data(), kBatchSize, MSG_DONTWAIT, nullptr);
  more = count >= static_cast<int>(kBatchSize);
  const auto now_ns = monotonic_ns();
  const auto earliest_ns = emptied_ns_ - kStampSlack_ns;
  if (!more) emptied_ns_ = now_ns;
  if (count <= 0) return {};
  const auto offset_ns = realtime_offset_ns();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    if ((b.headers[i].msg_hdr.msg_flags & MSG_CONFIRM) != 0) {
      ledger_.departed(b.raw[i].can_id);
      continue;
    }
    std::int64_t time_ns = 0;
    for (auto* c = CMSG_FIRSTHDR(&b.headers[i].msg_hdr); c != nullptr;
         c = CMSG_NXTHDR(&b.headers[i].msg_hdr, c)) {
      if (c->cmsg_level != SOL_SOCKET) continue;
      if (c->cmsg_type == SO_TIMESTAMPING) {
        timespec software{};
        std::memcpy(&software, CMSG_DATA(c), sizeof software);
        if (software.tv_sec != 0) time_ns = to_ns(software) - offset_ns;
      } else if (c->cmsg_type == SO_RXQ_OVFL) {
        std::uint32_t drops = 0;
        std::memcpy(&drops, CMSG_DATA(c), sizeof drops);
        counters_.receive_overflows += drops - kernel_drops_;
        kernel_drops_ = drops;
      }
    }
    // The kernel stamps in CLOCK_REALTIME. If that clock was set since, a stamp can lie outside the possible
    // interval: clamp it.
    if (time_ns == 0) time_ns = now_ns;
    time_ns = std::clamp(time_ns, earliest_ns, now_ns + kStampSlack_ns);
    if (b.headers[i].msg_len != sizeof(can_frame)) continue;
    if (tap_ != nullptr) tap_->on_frame(b.raw[i], time_ns, false);
    if ((b.raw[i].can_id & CAN_ERR_FLAG) != 0) {
      count_error_frame(b.raw[i], counters_);
      continue;
    }
    ++counters_.received;
    b.frames[kept++] = {b.raw[i], time_ns};
  }
  return {b.frames.data(), kept};
}

void CanSocket::pause(std::int64_t duration_ns) noexcept { sleep_ns(duration_ns); }

bool CanSocket::wait(std::int64_t timeout_ns) noexcept {
  pollfd p{fd_.get(), POLLIN, 0};
  const timespec timeout{timeout_ns / kNanosecondsPerSecond, timeout_ns % kNanosecondsPerSecond};
  return ::ppoll(&p, 1, &timeout, nullptr) > 0;
}

}  // namespace sandhopper
