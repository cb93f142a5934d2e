#include "coupling/base/printable.h"

#include <fmt/format.h>

#include <algorithm>

namespace grainfield::coupling {
namespace {

struct Character {
  char32_t code = 0;
  std::size_t bytes = 0;  ///< 0: these bytes are no UTF-8
};

Character first_of(std::string_view text) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t bytes = lead >= 0xC2 && lead < 0xE0   ? 2
                            : lead >= 0xE0 && lead < 0xF0 ? 3
                            : lead >= 0xF0 && lead < 0xF5 ? 4
                                                          : 0;
  if (bytes == 0 || text.size() < bytes) return {};
  char32_t code = lead & (0x7Fu >> bytes);
  for (std::size_t k = 1; k < bytes; ++k) {
    if ((byte(k) & 0xC0u) != 0x80u) return {};
    code = code << 6 | (byte(k) & 0x3Fu);
  }
  const bool longer_than_need = (bytes == 3 && code < 0x800) || (bytes == 4 && code < 0x10000);
  const bool surrogate = code >= 0xD800 && code < 0xE000;
  return longer_than_need || surrogate || code > 0x10FFFF ? Character{} : Character{code, bytes};
}

bool steers(char32_t c) {
  return (c >= 0x200E && c <= 0x200F) || (c >= 0x2028 && c <= 0x202E) ||
         (c >= 0x2066 && c <= 0x2069);
}

bool is_control(char32_t c) {
  return (c < 0x20 && c != '\n' && c != '\t') || (c >= 0x7F && c < 0xA0);
}

bool continues(char byte) { return (static_cast<unsigned char>(byte) & 0xC0u) == 0x80u; }

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const Character c = first_of(text);
    const std::size_t bytes = std::max<std::size_t>(c.bytes, 1);
    if (c.bytes == 0 || is_control(c.code)) {
      for (std::size_t k = 0; k < bytes; ++k) {
        out += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[k]));
      }
    } else if (steers(c.code)) {
      out += fmt::format("\\u{{{:x}}}", static_cast<unsigned>(c.code));
    } else {
      out += text.substr(0, bytes);
    }
    text.remove_prefix(bytes);
  }
  return out;
}

std::string printable_name(std::string_view name) {
  std::string out;
  for (const char ch : printable(name)) {
    if (ch == '\n' || ch == '\t') {
      out += fmt::format("\\x{:02x}", static_cast<unsigned char>(ch));
    } else {
      out += ch;
    }
  }
  return out;
}

std::string one_line(std::string_view text, std::size_t most) {
  std::string line = printable(text);
  std::replace(line.begin(), line.end(), '\n', ' ');
  if (line.size() <= most) return line;
  std::size_t head = most * 2 / 3, tail = line.size() - most / 3;
  while (head > 0 && continues(line[head])) --head;
  while (tail < line.size() && continues(line[tail])) ++tail;
  return fmt::format("{} [... {} bytes ...] {}", line.substr(0, head), tail - head,
                     line.substr(tail));
}

}  // namespace grainfield::coupling
