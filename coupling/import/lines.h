// Text files line by line through one buffer, whatever the file's size.
#pragma once
#include <ios>
#include <string>
#include <string_view>
#include <vector>

#include "coupling/import/text_source.h"

namespace grainfield::coupling {

/// No-break blanks, the typographic minus and other signs that mean a plain one are read as it.
class Lines {
 public:
  /// Longest line that is read, bytes: outlines of thousands of corners fit.
  static constexpr std::size_t longest = std::size_t{1} << 20;

  /// Throws as TextSource.
  explicit Lines(const std::string& file);
  /// The next line without its end ("\n", "\r\n" or "\r"), valid until the next call; false at the
  /// end of the file. Throws std::invalid_argument for a line that is too long, and as TextSource.
  bool next(std::string_view& line);
  const std::string& file() const { return file_; }
  /// Number of the line that next() gave last, from 1.
  long long line() const { return line_; }
  /// The last line that next() gave ended the file without an end of line.
  bool unfinished() const { return unfinished_; }
  /// "FILE:LINE", for messages.
  std::string where() const;

  /// Where next() goes on; give it back to seek().
  struct Place {
    std::streamoff offset = 0;
    long long line = 0;
  };
  Place place() const { return {start_ + static_cast<std::streamoff>(at_), line_}; }
  void seek(const Place& place);

 private:
  /// Reads on; false at the end of the file.
  bool fill();
  /// Where the line at at_ ends, and where the next one begins; npos: not in the buffer.
  struct End {
    std::size_t text = std::string::npos, next = 0;
  };
  End find_end() const;

  std::string file_;
  TextSource source_;
  std::string buffer_;
  std::streamoff start_ = 0;  // of the buffer in the text
  std::size_t at_ = 0;        // of the next line in the buffer
  bool ended_ = false;
  long long line_ = 0;
  bool unfinished_ = false;
};

/// Parts of a line: separated by white space (separator ' ') or by `separator`, then trimmed and
/// freed of quotation marks around them. `parts` is filled anew.
void split(std::string_view line, char separator, std::vector<std::string_view>& parts);
std::string_view trimmed(std::string_view text);

}  // namespace grainfield::coupling
