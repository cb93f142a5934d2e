#include "coupling/app/cell_text.h"

#include <fmt/format.h>

namespace grainfield::coupling {

std::string cell_text(const dem::Cell<3>& cell) {
  std::string axes, edges;
  for (int a = 0; a < 3; ++a) {
    if (!cell.periodic[static_cast<std::size_t>(a)]) continue;
    const Eigen::Vector3d e = cell.edges.col(a);
    axes += fmt::format("{}{}", axes.empty() ? "" : ", ", "xyz"[a]);
    edges += fmt::format("{}({:g}, {:g}, {:g})", edges.empty() ? "" : " and ", e.x(), e.y(), e.z());
  }
  std::string text = fmt::format("periodic along {}; edges {} m from ({:g}, {:g}, {:g})", axes,
                                 edges, cell.low.x(), cell.low.y(), cell.low.z());
  if (cell.velocity_gradient.isZero(0)) return text;
  text += "; velocity gradient (1/s)";
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      if (const double rate = cell.velocity_gradient(a, b); rate != 0)
        text += fmt::format(" {}{} {:g}", "xyz"[a], "xyz"[b], rate);
  return text;
}

}  // namespace grainfield::coupling
