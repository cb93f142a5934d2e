// Pictures as the bytes of an image, by gnuplot as a child process.
#pragma once
#include <optional>
#include <string>

#include "coupling/report/picture.h"

namespace grainfield::coupling {

/// Full path of gnuplot on PATH, or nothing.
std::optional<std::string> find_gnuplot();

struct Drawing {
  std::string bytes;  ///< the picture, SVG or PNG; empty when it failed
  std::string error;  ///< why it failed: gnuplot's own first line, or the time limit
};

/// Runs gnuplot on the program, through pipes, without a shell or any file, and kills it after
/// `seconds`. A signal to our process group does not reach it; one that stops it as it starts makes
/// it start again. `terminal`: e.g. "svg size 900,500". Throws
/// std::runtime_error only when no process can be made.
Drawing draw(const std::string& gnuplot, const std::string& terminal, const std::string& program,
             double seconds = 60);

/// As PNG (`bitmap`, at twice the picture's size, for sharp lines on dense screens) or SVG.
Drawing draw_picture(const std::string& gnuplot, const Picture& picture, bool bitmap);

}  // namespace grainfield::coupling
