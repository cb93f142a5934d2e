// Pictures as gnuplot programs, built from data. Every builder puts the data into the program
// itself, so that drawing needs no other file.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "coupling/base/field.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

struct Picture {
  std::string title, caption;
  std::string program;            ///< gnuplot commands without terminal and output
  int width = 900, height = 500;  ///< pixels
  bool bitmap = false;            ///< PNG (many elements) instead of SVG
  bool curves = false;            ///< lines over an axis
  bool band = false;              ///< with the grey band of the grains' standard error
};

struct Series {
  std::string label;
  Eigen::VectorXd x, y, error;  ///< error empty or nan: no band
  bool simulation = false;      ///< drawn with points and its band; models as lines
  bool banded = false;          ///< its band is drawn as well where it is no simulation
  int colour = -1;              ///< of the models' ones; below 0: black, or the next one
  bool points = false;          ///< with a colour: points on a thin line, else a dashed line
  bool bars = false;            ///< with a colour: its errors as bars
};

/// One frame of curves; `frames` stand in a grid under a common legend, which has the curves of the
/// first one.
struct Frame {
  std::string title;
  std::vector<Series> series;
  bool own_legend = false;  ///< inside it, for curves that differ from the first frame's
};
/// `log_x`: x, above 0 then, on a logarithmic axis.
Picture curves(const std::string& title, const std::string& x_label, const std::string& y_label,
               const std::vector<Frame>& frames, bool log_x = false);

/// A picture of curves with what it needs to be put together with others of its title: those of the
/// members of a sweep.
struct Chart {
  std::string title, x_label, y_label, caption;
  std::vector<Frame> frames;
  bool log_x = false;

  Picture picture() const;
};
/// Every title once, in the order of the first that has it; the curves of frames of one title are
/// in one frame in the member's colour: points and lines that are alone with its name, other lines
/// with it before their label.
std::vector<Picture> side_by_side(const std::vector<std::string>& members,
                                  const std::vector<std::vector<Chart>>& charts);

/// A line drawn over a map.
struct Overlay {
  Eigen::MatrixXd points;  ///< n x 2
  std::string look;        ///< of gnuplot's `with lines`, e.g. "lw 1 lc rgb 'white'"
};

/// One map of a column on a regular grid; several side by side share the colour scale.
struct Map {
  std::string title;
  int nx = 0, ny = 0;
  Eigen::MatrixXd points;  ///< nx*ny x 2
  Eigen::VectorXd value;
  std::vector<Overlay> lines = {};
};
/// `diverging`: blue - white - red about 0; else dark - bright over the values' own range.
Picture maps(const std::string& title, const std::string& x_label, const std::string& y_label,
             const std::string& value_label, const std::vector<Map>& maps, bool diverging = true);

/// Grains with their contact forces as lines whose width grows with the force. With `reference` the
/// lines show the change of force from it (more: red, less: blue). `vertical`: the axis' name.
Picture packing(const std::string& title, const dem::Snapshot& snapshot,
                const dem::Snapshot* reference = nullptr, const std::string& vertical = "y");

/// The same of spheres, where the plane y = const in the middle cuts them.
Picture slice(const std::string& title, const dem::Snapshot& snapshot);

/// Grains coloured by the order of their ids, which is the order of dropping.
Picture grains_by_age(const std::string& title, const dem::Snapshot& snapshot);

/// Grains with those of value 1 in colour; one value a grain.
Picture marked_grains(const std::string& title, const dem::Snapshot& snapshot,
                      const std::vector<char>& marked, const std::string& caption);

/// Arrows from `before` to `after`, magnified (the caption says by how much). Throws
/// std::invalid_argument when the numbers of grains differ.
Picture displacements(const std::string& title, const dem::Snapshot& before,
                      const dem::Snapshot& after);

/// Polar histogram of contact directions, weighted by count and by force; contacts with walls and
/// fixed grains are left out.
Picture contact_angles(const std::string& title, const dem::Snapshot& snapshot);

}  // namespace grainfield::coupling
