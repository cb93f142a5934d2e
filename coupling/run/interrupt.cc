#include "coupling/run/interrupt.h"

#include <csignal>

namespace grainfield::coupling {
namespace {

volatile std::sig_atomic_t flag = 0;

extern "C" void note_signal(int number) {
  flag = 1;
  std::signal(number, SIG_DFL);
}

}  // namespace

InterruptGuard::InterruptGuard() {
  flag = 0;
  std::signal(SIGINT, note_signal);
  std::signal(SIGTERM, note_signal);
}

InterruptGuard::~InterruptGuard() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

bool interrupted() { return flag != 0; }

}  // namespace grainfield::coupling
