#include "tools/trial/live/key_decoder.hpp"

namespace sandhopper {

// ECMA-48: CSI sequences end with a byte from '@' to '~'; SS3 sequences have one byte. Pasted text is
// enclosed in CSI 200~ and CSI 201~.
std::u32string KeyDecoder::take(std::string_view bytes) {
  constexpr char kEscape = '\x1b';
  std::u32string keys;
  for (const char c : bytes) {
    if (c == kEscape) {
      in_ = In::escape;
    } else if (in_ == In::escape) {
      sequence_.clear();
      in_ = c == '[' || c == 'O' ? In::sequence : In::text;
    } else if (in_ == In::sequence) {
      sequence_ += c;
      if (c < '@' || c > '~') continue;
      if (sequence_ == "200~") pasting_ = true;
      if (sequence_ == "201~") pasting_ = false;
      in_ = In::text;
    } else if (!pasting_ && static_cast<unsigned char>(c) < 0x80) {
      keys.push_back(static_cast<unsigned char>(c));
    }
  }
  return keys;
}

}  // namespace sandhopper
