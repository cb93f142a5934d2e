// Bytes of text files: unpacked, and as UTF-8.
#pragma once
#include <cstddef>
#include <ios>
#include <memory>
#include <string>

namespace grainfield::coupling {

/// A text file as a stream of UTF-8 without a byte order mark, whatever it lies in: plain, packed
/// by gzip, bzip2, xz or zstd (one stream or several after another), UTF-16 or UTF-32. The file
/// tells by its first bytes, not by its name.
class TextSource {
 public:
  /// Throws std::invalid_argument naming the file: not there, a folder, packed by another program,
  /// no text (with what it is, and what makes text of it).
  explicit TextSource(const std::string& file);
  ~TextSource();
  TextSource(TextSource&&) noexcept;
  TextSource& operator=(TextSource&&) noexcept;

  /// Fills up to `most` bytes and returns how many; 0 at the end. Throws dem::CannotReadNow where
  /// the system cannot read on, std::invalid_argument where the packing is damaged or cut off.
  std::size_t read(char* to, std::size_t most);
  /// Goes to a place that read() has been at, in bytes of the decoded text. Of a plain file at
  /// once; of any other by reading on, or by beginning anew.
  void seek(std::streamoff place);

  /// All bytes of a file of any kind, unpacked. Throws likewise, but for what is no text.
  static std::string all_bytes(const std::string& file);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace grainfield::coupling
