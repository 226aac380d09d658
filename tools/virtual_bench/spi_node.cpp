#include "tools/virtual_bench/spi_node.hpp"

#include <linux/spi/spidev.h>

#include <array>
#include <cerrno>
#include <vector>

namespace sandhopper::bench {
namespace {

constexpr std::size_t kBufferSize = 4096;  // spidev's own limit of one message
constexpr std::size_t kMaxTransfers = 64;

iovec at(std::uint64_t address, std::size_t size) {
  return {reinterpret_cast<void*>(static_cast<std::uintptr_t>(address)), size};
}

bool is_message(unsigned command) {
  return _IOC_TYPE(command) == SPI_IOC_MAGIC && _IOC_NR(command) == 0 && _IOC_DIR(command) == _IOC_WRITE &&
         _IOC_SIZE(command) % sizeof(spi_ioc_transfer) == 0;
}

}  // namespace

void SpiNode::ioctl(Ioctl& call, File&) {
  const auto take = [&](auto& setting) {
    if (const auto value = call.pointed_at<std::remove_reference_t<decltype(setting)>>()) {
      setting = *value;
      call.reply(0);
    }
  };
  switch (call.command()) {
    case SPI_IOC_RD_MODE:
      return call.return_value(static_cast<std::uint8_t>(mode_));
    case SPI_IOC_RD_MODE32:
      return call.return_value(mode_);
    case SPI_IOC_RD_LSB_FIRST:
      return call.return_value(least_significant_bit_first_);
    case SPI_IOC_RD_BITS_PER_WORD:
      return call.return_value(bits_per_word_);
    case SPI_IOC_RD_MAX_SPEED_HZ:
      return call.return_value(max_speed_Hz_);
    case SPI_IOC_WR_MODE:
      if (const auto mode = call.pointed_at<std::uint8_t>()) {
        mode_ = *mode;
        call.reply(0);
      }
      return;
    case SPI_IOC_WR_MODE32:
      return take(mode_);
    case SPI_IOC_WR_LSB_FIRST:
      return take(least_significant_bit_first_);
    case SPI_IOC_WR_BITS_PER_WORD:
      return take(bits_per_word_);
    case SPI_IOC_WR_MAX_SPEED_HZ:
      return take(max_speed_Hz_);
    default:
      return is_message(call.command()) ? transfer_message(call, _IOC_SIZE(call.command()))
                                        : call.fail(ENOTTY);
  }
}

// Three rounds: the transfers, then with them what they point at, then the answer.
void SpiNode::transfer_message(Ioctl& call, std::size_t size) {
  if (size == 0) return call.reply(0);
  const auto own = at(call.argument(), size);
  if (call.in().empty()) return call.fetch({&own, 1}, {});

  std::array<spi_ioc_transfer, kMaxTransfers> transfer;
  const std::size_t count = size / sizeof(spi_ioc_transfer);
  if (count > kMaxTransfers) return call.fail(EMSGSIZE);
  std::memcpy(transfer.data(), call.in().data(), size);

  std::vector<iovec> sent{own}, received;
  std::size_t sent_size = size, received_size = 0, total = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto& t = transfer[i];
    if (t.tx_buf != 0) sent.push_back(at(t.tx_buf, t.len)), sent_size += t.len;
    if (t.rx_buf != 0) received.push_back(at(t.rx_buf, t.len)), received_size += t.len;
    total += t.len;
  }
  if (total > kBufferSize) return call.fail(EMSGSIZE);
  if (call.in().size() < sent_size || call.out_size() < received_size) return call.fetch(sent, received);

  const std::uint8_t* next_sent = call.in().data() + size;
  std::vector<std::uint8_t> in, out, answer;
  for (std::size_t first = 0, i = 0; i < count; ++i) {
    const auto& t = transfer[i];
    in.resize(in.size() + t.len);
    if (t.tx_buf != 0) {
      std::memcpy(in.data() + in.size() - t.len, next_sent, t.len);
      next_sent += t.len;
    }
    const bool selected_on = t.cs_change == 0 && i + 1 < count;
    if (selected_on) continue;
    out.resize(in.size());
    chip_.transfer(in, out);
    for (std::size_t begin = 0; first <= i; begin += transfer[first++].len)
      if (transfer[first].rx_buf != 0)
        answer.insert(answer.end(), out.begin() + static_cast<std::ptrdiff_t>(begin),
                      out.begin() + static_cast<std::ptrdiff_t>(begin + transfer[first].len));
    in.clear();
  }
  call.reply(static_cast<int>(total), answer);
}

int SpiNode::read(std::span<std::uint8_t> out, File&) {
  const std::vector<std::uint8_t> in(out.size());
  chip_.transfer(in, out);
  return static_cast<int>(out.size());
}

int SpiNode::write(std::span<const std::uint8_t> in, File&) {
  std::vector<std::uint8_t> out(in.size());
  chip_.transfer(in, out);
  return static_cast<int>(in.size());
}

}  // namespace sandhopper::bench
