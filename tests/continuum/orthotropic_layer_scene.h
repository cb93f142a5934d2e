// Points, numbers as text and maps in files for the tests of orthotropic layers.
#pragma once
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>

#include "continuum/model.h"

namespace grainfield::continuum::testing {

/// n points at a depth, from x = least to most.
inline Points along(double depth, double least, double most, int n) {
  Points points(n, 2);
  for (int i = 0; i < n; ++i) points.row(i) << least + (most - least) * i / (n - 1), -depth;
  return points;
}

/// All digits of a number.
inline std::string text_of(double value) {
  std::ostringstream out;
  out.precision(17);
  out << value;
  return out.str();
}

/// A CSV file of 9 x 5 nodes over |x| <= 4, -1 <= y <= 0 with these columns; removed at its end.
class Map {
 public:
  Map(const std::string& header, const std::function<std::string(double, double)>& values)
      : file_(std::filesystem::temp_directory_path() /
              ("grainfield_orthotropic_" + std::to_string(::getpid()) + ".csv")) {
    std::ofstream out(file_);
    out << "# a map\nx,y," << header << "\n";
    for (int j = 0; j <= 4; ++j)
      for (int i = 0; i <= 8; ++i) {
        const double x = -4 + i, y = -1 + 0.25 * j;
        out << x << "," << y << "," << values(x, y) << "\n";
      }
  }
  ~Map() { std::filesystem::remove(file_); }
  std::string file() const { return file_.string(); }

 private:
  std::filesystem::path file_;
};

}  // namespace grainfield::continuum::testing
