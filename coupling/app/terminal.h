// The program's two streams. Nothing else writes to them.
#pragma once
#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "coupling/base/failure.h"
#include "dem/space/cell.h"

namespace grainfield::coupling {

inline constexpr int kExitPipe = 141;  ///< as the shell reports a program ended by SIGPIPE

/// Puts something harmless where a standard stream is closed, before all else: the next file that
/// is opened would take its place, and get what is meant for the terminal.
void hold_standard_streams();

/// Text for standard output, with what could steer a terminal written out. It is kept until
/// finish_output(), except on a terminal.
void put(const std::string& text);
template <class... Args>
void say(fmt::format_string<Args...> form, Args&&... args) {
  put(fmt::format(form, std::forward<Args>(args)...));
}

/// One line on standard error; a long one is cut in the middle. A stream that cannot be written
/// changes nothing.
void put_log(const std::string& line);
/// The same with "grainfield: " before it: mistakes, failures, warnings.
template <class... Args>
void note(fmt::format_string<Args...> form, Args&&... args) {
  put_log("grainfield: " + fmt::format(form, std::forward<Args>(args)...));
}
/// A note of gone_note (coupling/store/output_folder.h), where something is gone.
void note_gone(const std::string& folder, const std::vector<std::filesystem::path>& gone);
/// The same without end of line, over the line that stands there: progress on a terminal.
void put_progress(const std::string& line);

/// Writes what put() has kept. Returns 0; kExitPipe when the reader has gone; kExitStorage after
/// one line on standard error when it cannot be written: a file is then cut back to the length it
/// had.
int finish_output();

/// "periodic along x, y; edges (0.1, 0, 0) and (0, 0.1, 0) m from (0, 0, 0)", and how it flows.
std::string cell_text(const dem::Cell<3>& cell);

}  // namespace grainfield::coupling
