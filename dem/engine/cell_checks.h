// What does not go with a cell that repeats or flows.
#pragma once
#include "dem/snapshot/snapshot.h"
#include "dem/space/moving_cell.h"
#include "dem/walls/wall_motion.h"

namespace grainfield::dem {

/// Throws std::invalid_argument naming the wall when it does not repeat with the cell: a plane that
/// is not along the periodic edges, a cylinder whose axis is not the only periodic one or that
/// ends, any other shape.
void check_wall(const Cell<3>& cell, const Wall& wall, int dim);
/// Throws std::invalid_argument naming the wall when its turning does not repeat with the cell:
/// only a cylinder about its own axis does.
void check_wall_motion(const Cell<3>& cell, const Wall& wall, const WallMotion& motion);

/// The cell holds grains of this radius, m: by kLeastCell.
template <int D>
bool holds(const MovingCell<D>& cell, double radius) {
  return cell.shortest() >= kLeastCell * radius;
}
/// Throws std::invalid_argument saying so, and with what it would; `shortest` as of the cell, m.
[[noreturn]] void refuse_small_cell(double shortest, double radius);
/// Throws ComputationFailed: it has shrunk since.
[[noreturn]] void report_small_cell(double shortest, double radius, double time, long step);

/// Throws std::invalid_argument saying why not: grains `fixed`, or that may sleep, in a cell that
/// flows.
void check_rest_in_flow(bool flows, bool fixed, bool sleeping);

}  // namespace grainfield::dem
