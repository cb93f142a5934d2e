// Tests run on a core each (one_core), so that a run which takes as many threads as there are cores
// takes one. Those that are about threads ask for all cores.
#pragma once
#include <sched.h>

namespace grainfield::test {

/// This thread, and what it starts, may use every core of the machine while this object lives.
class AllCores {
 public:
  AllCores() {
    sched_getaffinity(0, sizeof before_, &before_);
    cpu_set_t all;
    CPU_ZERO(&all);
    for (int core = 0; core < CPU_SETSIZE; ++core) CPU_SET(core, &all);
    sched_setaffinity(0, sizeof all, &all);
  }
  ~AllCores() { sched_setaffinity(0, sizeof before_, &before_); }
  AllCores(const AllCores&) = delete;
  AllCores& operator=(const AllCores&) = delete;

 private:
  cpu_set_t before_{};
};

}  // namespace grainfield::test
