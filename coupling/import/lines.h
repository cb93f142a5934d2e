// Text files line by line through one fixed buffer, whatever the file's size.
#pragma once
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace grainfield::coupling {

class Lines {
 public:
  /// Longest line that is read, bytes: outlines of thousands of corners fit.
  static constexpr std::size_t longest = std::size_t{1} << 20;

  /// Throws std::invalid_argument naming the file: not there, a folder, compressed.
  explicit Lines(const std::string& file);
  /// The next line without its end ("\n" or "\r\n"), valid until the next call; false at the end of
  /// the file. Throws std::invalid_argument for a line that is too long, dem::CannotReadNow where
  /// the system cannot read on.
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
  Place place();
  void seek(const Place& place);

 private:
  std::string file_;
  std::ifstream in_;
  std::unique_ptr<char[]> buffer_;  // of `longest` bytes
  long long line_ = 0;
  bool unfinished_ = false;
};

/// Parts of a line: separated by white space (separator ' ') or by `separator`, then trimmed and
/// freed of quotation marks around them. `parts` is filled anew.
void split(std::string_view line, char separator, std::vector<std::string_view>& parts);
std::string_view trimmed(std::string_view text);

}  // namespace grainfield::coupling
