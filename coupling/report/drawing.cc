#include "coupling/report/drawing.h"

#include <fmt/format.h>

namespace grainfield::coupling {

Drawing draw_picture(const std::string& gnuplot, const Picture& picture, bool bitmap) {
  const std::string font = "font 'DejaVu Sans,13'";
  const std::string terminal =
      bitmap ? fmt::format(
                   "pngcairo size {},{} fontscale 2 linewidth 2 pointscale 2 {} background 'white'",
                   2 * picture.width, 2 * picture.height, font)
             : fmt::format("svg size {},{} dynamic {} background 'white'", picture.width,
                           picture.height, font);
  return draw(gnuplot, terminal, picture.program);
}

}  // namespace grainfield::coupling
