// Files as whole texts; one that is written appears complete or not at all.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "coupling/base/signals.h"

namespace grainfield::coupling {

/// Gives a temporary name beside `path`; commit() renames it to `path`; without commit() the
/// destructor removes it, and so does a signal that ends the program. Where `path` is a link, what
/// it leads to is written. A file that is replaced hands on its permissions. The folder must exist.
/// Throws std::invalid_argument naming the path when the folder is missing or cannot be written, or
/// something stands there that is no regular file (a folder, a device, a pipe); dem::StorageFailed
/// when it cannot take its place on the disk. Only the process that is to write it and this host
/// are in the temporary name: what a killed process left can be told (remove_orphans).
class AtomicFile {
 public:
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  const std::string& path() const { return path_; }
  const std::string& temporary() const { return temporary_; }
  /// All of the temporary file. Throws dem::StorageFailed.
  void write(const std::string& text) const;
  /// Lets `work` write it under its temporary name. A signal that would end the program waits for
  /// it: what it has removed must not be made anew.
  void write_with(const std::function<void(const std::string& temporary)>& work) const;
  void commit();

 private:
  std::string path_, target_, temporary_;
  std::unique_ptr<OnSignal> undo_;
  bool committed_ = false;
};

/// Writes text through an AtomicFile. Throws dem::StorageFailed when it cannot be written to its
/// end.
void write_text_file(const std::string& path, const std::string& text);
/// The same for files that belong together, as pairs of path and text: all are written before the
/// first appears.
void write_text_files(const std::vector<std::pair<std::string, std::string>>& files);
/// Removes the temporary files in this folder, not below it, of AtomicFiles whose process has ended
/// on this host without removing them (kill -9).
void remove_orphans(const std::string& folder);
/// "a folder", "a device", "a pipe", "a socket", "a file", for messages.
const char* kind_of(std::filesystem::file_type type);
/// All of a file; empty when there is none. Throws std::invalid_argument naming one that is there
/// and cannot be read.
std::string read_text_file(const std::string& path);

}  // namespace grainfield::coupling
