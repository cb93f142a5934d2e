#include "coupling/import/text_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/iostreams/device/file.hpp>
#include <boost/iostreams/filter/bzip2.hpp>
#include <boost/iostreams/filter/gzip.hpp>
#include <boost/iostreams/filter/lzma.hpp>
#include <boost/iostreams/filter/zstd.hpp>
#include <boost/iostreams/filtering_streambuf.hpp>
#include <boost/locale/encoding_utf.hpp>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "coupling/base/read_input.h"
#include "dem/cannot_read_now.h"

namespace grainfield::coupling {
namespace {

namespace io = boost::iostreams;
using std::string_view_literals::operator""sv;

enum class Packing { none, gzip, bzip2, xz, zstd };
enum class Encoding { utf8, utf16_little, utf16_big, utf32_little, utf32_big };

// First bytes that tell a packing.
std::optional<Packing> packing_of(std::string_view head) {
  if (head.starts_with("\x1f\x8b"sv)) return Packing::gzip;
  if (head.starts_with("BZh"sv)) return Packing::bzip2;
  if (head.starts_with("\xfd\x37zXZ\0"sv)) return Packing::xz;
  if (head.starts_with("\x28\xb5\x2f\xfd"sv)) return Packing::zstd;
  return std::nullopt;
}

// What cannot be read, and what to do; empty: nothing of these.
std::string foreign_kind(std::string_view head) {
  struct Kind {
    std::string_view head, what;
  };
  constexpr std::array kinds{
      Kind{"PK\x03\x04"sv,
           "a ZIP archive (of a spreadsheet: save it as CSV; of a text: unpack it first)"sv},
      Kind{"\x1f\x9d"sv, "compressed (compress, .Z); unpack it first"sv},
      Kind{"\x04\x22\x4d\x18"sv, "compressed (lz4); unpack it first"sv},
      Kind{"7z\xbc\xaf\x27\x1c"sv, "compressed (7z); unpack it first"sv},
      Kind{"Rar!"sv, "compressed (rar); unpack it first"sv},
      Kind{"\xd0\xcf\x11\xe0"sv, "an old spreadsheet (.xls); save it as CSV"sv},
      Kind{"\x89HDF\r\n"sv, "an HDF5 file, expected a text file"sv},
      Kind{"%PDF"sv, "a PDF, expected a text file"sv},
      Kind{"\x93NUMPY"sv,
           "an array of numpy (.npy), expected a text file: numpy.savetxt writes one"sv},
  };
  for (const Kind& kind : kinds)
    if (head.starts_with(kind.head)) return std::string(kind.what);
  constexpr std::size_t kTar = 257;  // POSIX.1, ustar: place of its sign
  if (head.size() > kTar && head.substr(kTar).starts_with("ustar"sv))
    return "an archive (tar) of files; unpack it (tar -xf) and give the files";
  return "";
}

// By the byte order mark, or by the zeros that letters of ASCII have beside them.
std::pair<Encoding, std::size_t> encoding_of(std::string_view head) {
  if (head.starts_with("\xef\xbb\xbf"sv)) return {Encoding::utf8, 3};
  if (head.starts_with("\xff\xfe\0\0"sv)) return {Encoding::utf32_little, 4};
  if (head.starts_with("\0\0\xfe\xff"sv)) return {Encoding::utf32_big, 4};
  if (head.starts_with("\xff\xfe"sv)) return {Encoding::utf16_little, 2};
  if (head.starts_with("\xfe\xff"sv)) return {Encoding::utf16_big, 2};
  if (head.size() < 4) return {Encoding::utf8, 0};
  const auto letter = [&](std::size_t k) { return head[k] >= ' ' && head[k] <= '~'; };
  const auto zero = [&](std::size_t k) { return head[k] == 0; };
  if (letter(0) && zero(1) && letter(2) && zero(3)) return {Encoding::utf16_little, 0};
  if (zero(0) && letter(1) && zero(2) && letter(3)) return {Encoding::utf16_big, 0};
  return {Encoding::utf8, 0};
}

std::size_t unit_bytes(Encoding encoding) {
  switch (encoding) {
    case Encoding::utf8:
      return 1;
    case Encoding::utf16_little:
    case Encoding::utf16_big:
      return 2;
    case Encoding::utf32_little:
    case Encoding::utf32_big:
      return 4;
  }
  return 1;
}

// Whole characters of `raw` as UTF-8; leaves the rest there.
template <class Unit>
std::string in_utf8(std::string& raw, bool big, bool last) {
  std::basic_string<Unit> units;
  const std::size_t count = raw.size() / sizeof(Unit);
  units.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    std::uint32_t unit = 0;
    for (std::size_t b = 0; b < sizeof(Unit); ++b) {
      const std::size_t at = k * sizeof(Unit) + (big ? b : sizeof(Unit) - 1 - b);
      unit = unit << 8 | static_cast<unsigned char>(raw[at]);
    }
    units.push_back(static_cast<Unit>(unit));
  }
  // The first half of a pair waits for the second.
  const bool half =
      sizeof(Unit) == 2 && !last && !units.empty() && (units.back() & 0xfc00u) == 0xd800u;
  if (half) units.pop_back();
  raw.erase(0, units.size() * sizeof(Unit));
  return boost::locale::conv::utf_to_utf<char>(units);
}

// Whether a file of zstd is frames from its first byte to its last (RFC 8878, 3.1): its
// decompressor does not say that the last one is cut off.
bool is_whole_zstd(const std::string& file) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  const std::streamoff size = in.tellg();
  std::streamoff at = 0;
  const auto number = [&](int bytes) {  // the lowest byte first
    std::uint32_t out = 0;
    in.seekg(at);
    for (int k = 0; k < bytes; ++k) out |= static_cast<std::uint32_t>(in.get() & 0xff) << (8 * k);
    at += bytes;
    return out;
  };
  while (at < size) {
    const std::uint32_t magic = number(4);
    if ((magic & 0xfffffff0u) == 0x184d2a50u) {  // to be skipped
      at += number(4);
      continue;
    }
    if (magic != 0xfd2fb528u) return false;
    const std::uint32_t descriptor = number(1);
    const bool single = (descriptor & 0x20u) != 0, checksum = (descriptor & 0x04u) != 0;
    constexpr std::array dictionary{0, 1, 2, 4}, content{0, 2, 4, 8};
    at += (single ? 0 : 1) + dictionary[descriptor & 3u] + content[descriptor >> 6];
    if (single && descriptor >> 6 == 0) at += 1;
    for (bool last = false; !last;) {
      if (at + 3 > size) return false;
      const std::uint32_t block = number(3), kind = block >> 1 & 3u;
      last = (block & 1u) != 0;
      at += kind == 1 ? 1 : block >> 3;  // a repeated byte, or bytes
    }
    at += checksum ? 4 : 0;
  }
  return at == size;
}

constexpr std::size_t kHead = 512;       // bytes that are looked at
constexpr std::size_t kBlock = 1 << 16;  // bytes that are decoded at once

}  // namespace

struct TextSource::Parts {
  std::string file;
  Packing packing = Packing::none;
  Encoding encoding = Encoding::utf8;
  std::size_t mark = 0;  // bytes of the byte order mark
  std::ifstream plain;
  std::unique_ptr<io::filtering_streambuf<io::input>> unpacked;
  std::string raw, decoded;  // of another encoding than UTF-8: not decoded yet, not given yet
  std::streamoff place = 0;  // of read(), in decoded bytes

  void open() {
    errno = 0;
    if (packing == Packing::none) {
      plain.close();
      plain.clear();
      plain.open(file, std::ios::binary);
      if (!plain) throw std::invalid_argument(fmt::format("{}: {}", file, std::strerror(errno)));
      return;
    }
    unpacked = std::make_unique<io::filtering_streambuf<io::input>>();
    if (packing == Packing::gzip) unpacked->push(io::gzip_decompressor());
    if (packing == Packing::bzip2) unpacked->push(io::bzip2_decompressor());
    if (packing == Packing::xz) unpacked->push(io::lzma_decompressor());
    if (packing == Packing::zstd) unpacked->push(io::zstd_decompressor());
    unpacked->push(io::file_source(file, std::ios::in | std::ios::binary));
  }

  std::size_t read_bytes(char* to, std::size_t most) {
    if (packing == Packing::none) {
      errno = 0;
      plain.read(to, static_cast<std::streamsize>(most));
      if (plain.bad())
        throw dem::CannotReadNow(
            fmt::format("{}: cannot be read{}: {}", file,
                        place == 0 ? "" : fmt::format(" on behind byte {}", place),
                        errno != 0 ? std::strerror(errno) : "the system gives no reason"));
      return static_cast<std::size_t>(plain.gcount());
    }
    try {
      const std::streamsize count = unpacked->sgetn(to, static_cast<std::streamsize>(most));
      return count > 0 ? static_cast<std::size_t>(count) : 0;
    } catch (const std::ios_base::failure&) {
      throw std::invalid_argument(
          fmt::format("{}: is damaged or cut off: its packing does not fit its end", file));
    }
  }

  // Decoded bytes, without regard to `place`.
  std::size_t decode(char* to, std::size_t most) {
    if (encoding == Encoding::utf8) return read_bytes(to, most);
    while (decoded.empty()) {
      const std::size_t old = raw.size();
      raw.resize(old + kBlock);
      const std::size_t count = read_bytes(raw.data() + old, kBlock);
      raw.resize(old + count);
      const bool big = encoding == Encoding::utf16_big || encoding == Encoding::utf32_big;
      decoded = unit_bytes(encoding) == 2 ? in_utf8<char16_t>(raw, big, count == 0)
                                          : in_utf8<char32_t>(raw, big, count == 0);
      if (count == 0) break;
    }
    const std::size_t count = std::min(most, decoded.size());
    std::memcpy(to, decoded.data(), count);
    decoded.erase(0, count);
    return count;
  }

  // Opens the file and sets its packing; returns its first bytes, unpacked.
  std::string settle_packing() {
    std::array<char, kHead> bytes{};
    const auto head = [&] {
      open();
      return std::string(bytes.data(), read_bytes(bytes.data(), kHead));
    };
    const std::string start = head();
    const auto told = packing_of(start);
    if (!told) return start;
    packing = *told;
    if (packing == Packing::zstd && !is_whole_zstd(file))
      throw std::invalid_argument(file +
                                  ": is damaged or cut off: its packing does not fit its end");
    std::string inner = head();
    if (packing_of(inner))
      throw std::invalid_argument(file + ": is packed twice; unpack it once first");
    return inner;
  }

  // To the first byte of the text.
  void begin() {
    open();
    raw.clear();
    decoded.clear();
    std::array<char, 4> skipped{};
    read_bytes(skipped.data(), mark);
    place = 0;
  }
};

TextSource::TextSource(const std::string& file) : parts_(std::make_unique<Parts>()) {
  Parts& p = *parts_;
  p.file = file;
  require_regular_file(file, "a text file");
  const std::string start = p.settle_packing();
  if (const std::string kind = foreign_kind(start); !kind.empty())
    throw std::invalid_argument(file + ": is " + kind);
  std::tie(p.encoding, p.mark) = encoding_of(start);
  if (p.encoding == Encoding::utf8 && start.find('\0') != std::string_view::npos)
    throw std::invalid_argument(
        file +
        ": holds bytes of 0: it is binary, expected a text file (of a binary dump LAMMPS' tool "
        "binary2txt makes one)");
  p.begin();
}

std::string TextSource::all_bytes(const std::string& file) {
  require_regular_file(file, "a file");
  Parts p;
  p.file = file;
  p.settle_packing();
  p.open();
  std::string out;
  for (std::size_t count = kBlock; count > 0;) {
    const std::size_t old = out.size();
    out.resize(old + kBlock);
    count = p.read_bytes(out.data() + old, kBlock);
    out.resize(old + count);
    p.place = static_cast<std::streamoff>(out.size());
  }
  return out;
}

TextSource::~TextSource() = default;
TextSource::TextSource(TextSource&&) noexcept = default;
TextSource& TextSource::operator=(TextSource&&) noexcept = default;

std::size_t TextSource::read(char* to, std::size_t most) {
  const std::size_t count = parts_->decode(to, most);
  parts_->place += static_cast<std::streamoff>(count);
  return count;
}

void TextSource::seek(std::streamoff place) {
  Parts& p = *parts_;
  if (p.packing == Packing::none && p.encoding == Encoding::utf8) {
    p.plain.clear();
    p.plain.seekg(place + static_cast<std::streamoff>(p.mark));
    p.place = place;
    return;
  }
  if (place < p.place) p.begin();
  std::string skipped(kBlock, '\0');
  while (p.place < place &&
         read(skipped.data(), std::min(kBlock, static_cast<std::size_t>(place - p.place))) > 0) {
  }
}

}  // namespace grainfield::coupling
