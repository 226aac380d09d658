#include "tools/virtual_bench/i2c_node.hpp"

#include <linux/i2c-dev.h>
#include <linux/i2c.h>

#include <array>
#include <cerrno>
#include <vector>

namespace sandhopper::bench {
namespace {

constexpr std::uint64_t kLastAddress = 0x7F;
constexpr std::size_t kMaxMessageSize = 8192;  // i2c-dev's own

}  // namespace

I2cChip* I2cNode::chip_at(std::uint64_t address) const {
  const auto found = chips_.find(static_cast<int>(address));
  return found == chips_.end() ? nullptr : found->second;
}

void I2cNode::ioctl(Ioctl& call, File& address) {
  switch (call.command()) {
    case I2C_FUNCS:
      return call.return_value(static_cast<unsigned long>(I2C_FUNC_I2C));
    case I2C_SLAVE:
    case I2C_SLAVE_FORCE:
      if (call.argument() > kLastAddress) return call.fail(EINVAL);
      address = call.argument();
      return call.reply(0);
    case I2C_TIMEOUT:
    case I2C_RETRIES:
      return call.reply(0);
    case I2C_TENBIT:
    case I2C_PEC:
      return call.argument() == 0 ? call.reply(0) : call.fail(EINVAL);
    case I2C_RDWR:
      return transfer_messages(call);
    case I2C_SMBUS:
      return call.fail(EOPNOTSUPP);
    default:
      return call.fail(ENOTTY);
  }
}

// Four rounds: the outer structure, the messages, what they point at, then the answer.
void I2cNode::transfer_messages(Ioctl& call) {
  const auto outer = call.pointed_at<i2c_rdwr_ioctl_data>();
  if (!outer) return;
  if (outer->nmsgs == 0 || outer->nmsgs > I2C_RDWR_IOCTL_MAX_MSGS) return call.fail(EINVAL);
  const std::size_t messages_size = outer->nmsgs * sizeof(i2c_msg);
  const std::size_t head_size = sizeof *outer + messages_size;
  std::vector<iovec> sent{{reinterpret_cast<void*>(call.argument()), sizeof *outer},
                          {outer->msgs, messages_size}};
  if (call.in().size() < head_size) return call.fetch(sent, {});

  std::vector<i2c_msg> messages(outer->nmsgs);
  std::memcpy(messages.data(), call.in().data() + sizeof *outer, messages_size);
  std::vector<iovec> received;
  std::size_t sent_size = head_size, received_size = 0;
  for (const auto& message : messages) {
    if (message.len > kMaxMessageSize) return call.fail(EINVAL);
    const bool reads = (message.flags & I2C_M_RD) != 0;
    (reads ? received : sent).push_back({message.buf, message.len});
    (reads ? received_size : sent_size) += message.len;
  }
  if (call.in().size() < sent_size || call.out_size() < received_size) return call.fetch(sent, received);

  const std::uint8_t* next_sent = call.in().data() + head_size;
  std::vector<std::uint8_t> answer(received_size);
  std::span<std::uint8_t> unanswered(answer);
  for (const auto& message : messages) {
    auto* const chip = chip_at(message.addr);
    if (chip == nullptr) return call.fail(ENXIO);
    if ((message.flags & I2C_M_RD) != 0) {
      chip->read(unanswered.first(message.len));
      unanswered = unanswered.subspan(message.len);
    } else {
      chip->write({next_sent, message.len});
      next_sent += message.len;
    }
  }
  call.reply(static_cast<int>(outer->nmsgs), answer);
}

int I2cNode::read(std::span<std::uint8_t> out, File& address) {
  auto* const chip = chip_at(address);
  if (chip == nullptr) return -ENXIO;
  chip->read(out);
  return static_cast<int>(out.size());
}

int I2cNode::write(std::span<const std::uint8_t> in, File& address) {
  auto* const chip = chip_at(address);
  if (chip == nullptr) return -ENXIO;
  chip->write(in);
  return static_cast<int>(in.size());
}

}  // namespace sandhopper::bench
