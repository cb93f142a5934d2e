#include "coupling/specimen/setup.h"

#include <fmt/format.h>

#include <stdexcept>

namespace grainfield::coupling {

void check_heap_windows(const HeapSetup& h) {
  if (h.shoulder_from >= h.shoulder_to) {
    throw std::invalid_argument(
        fmt::format("heap.shoulder_from: found {:g}, allowed: below heap.shoulder_to = {:g}",
                    h.shoulder_from, h.shoulder_to));
  }
  if (h.centre > h.shoulder_from) {
    throw std::invalid_argument(
        fmt::format("heap.centre: found {:g}, allowed: up to heap.shoulder_from = {:g}", h.centre,
                    h.shoulder_from));
  }
  if (h.axis_from >= h.axis_to) {
    throw std::invalid_argument(fmt::format(
        "heap.axis_from: found {:g}, allowed: below heap.axis_to = {:g}", h.axis_from, h.axis_to));
  }
}

}  // namespace grainfield::coupling
