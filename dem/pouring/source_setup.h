// A source of grains.
#pragma once
#include <string>
#include <tuple>

namespace grainfield::dem {

/// How a pile is poured (Roul 3.1, 3.11, table 2).
struct SourceSetup {
  std::string kind = "point";  ///< point: grain by grain from above | line: layer by layer
  int grains = 6500;           ///< 3 or more; line: fewer when the pile has come to a point before
  double speed = 0.2;          ///< m/s downwards at the start, of both
  double height = 0.5;         ///< m above the floor; point: of the funnel's mouth
  double above = 0;            ///< mean diameters; point: each grain starts this far above the
                               ///< pile's top, as it is then, in place of `height` (Liffman fig.
                               ///< 20); 0: from the mouth
  double interval = 0.1;       ///< s from one grain to the next; point
  double spread = 0.5;  ///< mean radii; point: grains start within +- this from the funnel's axis
  double opening = 0;   ///< m; point: width of the mouth between two immobile plates; 0: no plates,
                        ///< grains fall freely from the mouth (dem/pouring/funnel.h)
  double move = 0;      ///< m; point: the funnel moves this far to the right while it pours,
                        ///< from -move/2 to move/2 (asymmetric piles)
  double clearance = 0.008;  ///< m above the pile from which a layer falls; line
  double length = 0.77;      ///< m; line: length of the first layer, about 0.7 of the base of the
                             ///< finished pile; later ones cover the pile's plateau
  double shift = 0;  ///< m; line: each layer's middle lies this far to the right of the last one's
                     ///< (asymmetric piles)

  auto members() const {
    return std::tie(kind, grains, speed, height, above, interval, spread, opening, move, clearance,
                    length, shift);
  }
};

}  // namespace grainfield::dem
