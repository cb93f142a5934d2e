// Work that may crash, in a process of its own.
#pragma once
#include <functional>
#include <string>

namespace grainfield::dem {

struct ChildLimits {
  double seconds = 1;   ///< of CPU time, whole ones
  double memory = 1e9;  ///< bytes of address space beyond this process's; without sanitizers
  double clock = 0;     ///< s on the clock; 0: thirty times `seconds`
};

enum class ChildEnd { ok, failed, refused, crashed, endless, killed, unknown };

struct ChildResult {
  ChildEnd end = ChildEnd::ok;
  std::string signal;  ///< "SIGSEGV", when the system told it
};

/// Does `work` in a copy of this process, silent and without a core dump, and waits: ok or failed
/// as it returned true or false (or threw), refused when it threw std::invalid_argument, crashed
/// when it did not return, endless when it took too long, killed when somebody else ended it, such
/// as a system out of memory; unknown when there can be no child now. Signals that ask to stop do
/// not reach it. Of what other threads hold locked (but memory) it must not need anything.
ChildResult run_in_child(const ChildLimits& limits, const std::function<bool()>& work);

}  // namespace grainfield::dem
