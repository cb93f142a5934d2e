// Files as whole texts; one that is written appears complete or not at all.
#pragma once
#include <string>

namespace grainfield::coupling {

/// Gives a temporary name beside `path`; commit() renames it to `path`; without commit() the
/// destructor removes it. The folder must exist. Throws std::invalid_argument naming the path when
/// the folder is missing or cannot be written; commit() throws dem::StorageFailed when it cannot
/// take its place on the disk.
class AtomicFile {
 public:
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  const std::string& path() const { return path_; }
  const std::string& temporary() const { return temporary_; }
  void commit();

 private:
  std::string path_, temporary_;
  bool committed_ = false;
};

/// Writes text through an AtomicFile. Throws dem::StorageFailed, too, when the disk is full.
void write_text_file(const std::string& path, const std::string& text);
/// All of a file; empty when it cannot be read.
std::string read_text_file(const std::string& path);

}  // namespace grainfield::coupling
