// The folder of a command's results: complete or not at all.
//
// FOLDER/.partial  what is being written; moved when all of it is there
// FOLDER/.lock     who works here (coupling/base/file_lock.h)
// FOLDER/.results  the results that stand here, a name a line: the next ones replace these and no
//                  other file
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "coupling/base/file_lock.h"
#include "coupling/base/signals.h"

namespace grainfield::coupling {

class OutputFolder {
 public:
  /// Makes the folder where it is missing, locks it and empties the staging area. `command` is what
  /// the lock tells others. Throws std::invalid_argument naming the folder: it cannot be made or
  /// written, or another process works there.
  OutputFolder(const std::string& folder, const std::string& command);
  /// Without publish(): the staging area goes, and the folder if this object made it and it is
  /// empty. A signal that ends the program does the same.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Throws std::invalid_argument when one of these files is a result that publish() would replace.
  void require_other_than(const std::vector<std::string>& inputs) const;
  /// Throws std::invalid_argument when something stands where one of these results would come and
  /// is none of an earlier command: the user's own file. publish() looks at all results; who knows
  /// some names before hours of work asks before.
  void require_free(const std::vector<std::filesystem::path>& names) const;
  /// Path of a file to be written: staging area / inner. Folders on the way are made, and one whose
  /// name ends with a slash.
  std::string staging(const std::string& inner = "") const;
  /// Files that publish() will move to their place, sorted, below the folder.
  std::vector<std::filesystem::path> staged() const;
  /// Removes the results of an earlier command, summary.json before all, and moves everything from
  /// the staging area to its place, summary.json last: a summary never stands beside another run's
  /// data. Whatever else is in the folder stays. Returns the earlier results that are gone, sorted:
  /// those in whose place no new one stands. Throws dem::StorageFailed, and as require_free.
  std::vector<std::filesystem::path> publish();

 private:
  void abandon() noexcept;
  std::vector<std::filesystem::path> earlier_results() const;
  bool is_ours(const std::filesystem::path& name,
               const std::vector<std::filesystem::path>& earlier) const;

  std::filesystem::path folder_, partial_, made_;
  std::unique_ptr<FileLock> lock_;
  std::unique_ptr<OnSignal> undo_;
};

/// "out: 3 results of an earlier command are gone: a.svg, b.svg, ..." of what publish() returned;
/// empty: nothing is.
std::string gone_note(const std::string& folder, const std::vector<std::filesystem::path>& gone);

/// Throws std::invalid_argument "OPTION: FILE is an input; ..." when `output` names one of the
/// input files, under any path.
void require_other_file(const std::string& option, const std::string& output,
                        const std::vector<std::string>& inputs);

}  // namespace grainfield::coupling
