// A packing to scale, on which pictures draw what they show. Used by the pictures of grains only.
#pragma once
#include <functional>
#include <string>

#include "coupling/report/picture.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

class Scene {
 public:
  /// Fits the picture's size to the packing's; `above`: pixels kept free over it. Grains that
  /// have rolled off the bulk, with a gap of three of the largest diameters between, are left
  /// outside. `headroom`: metres kept free over it, for what is drawn on the grains.
  Scene(Picture& picture, const dem::Snapshot& snapshot, int above = 24, double headroom = 0);

  /// Puts the grains into the program with their true outlines; `colour` gives "0xrrggbb".
  void add_grains(const std::function<std::string(const dem::Grain&)>& colour);
  /// Margins, ranges and axes: comes after all data, before the plot command.
  void set_axes(const std::string& vertical = "y");
  /// Begins the plot command with the grains.
  void plot_grains(const char* edge);
  /// Goes on with the outline of a cell that is periodic along both axes; without one, nothing.
  void plot_cell();

  /// For captions: " 3 grains that rolled off lie outside the picture."; empty without any.
  std::string strays() const;

  double pixels(double metres) const { return metres * plot_width_ / (right_ - left_); }
  double width() const { return right_ - left_; }   ///< m
  int plot_height() const { return plot_height_; }  ///< pixels

 private:
  void find_bulk(double gap);

  Picture& picture_;
  const dem::Snapshot& snapshot_;
  double left_ = 0, right_ = 1, bottom_ = 0, top_ = 1;
  int strays_ = 0;
  int above_, plot_width_ = 0, plot_height_ = 0;
};

}  // namespace grainfield::coupling
