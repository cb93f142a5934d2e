// Where the grains of a pile come from: one by one out of a funnel, or in layers on its top.
#pragma once
#include "dem/grains/grain_family.h"
#include "dem/pouring/source_setup.h"

namespace grainfield::dem {

/// Point source (Roul 3.1.1). Grain k starts at k intervals, in the mouth or, with a funnel,
/// between the upper ends of its plates, and falls freely. Without a funnel it joins the simulation
/// where it comes near the pile: the flight before has a closed form, and one grain in flight alone
/// would cost a neighbour search every few steps.
class PointSource {
 public:
  PointSource(const SourceSetup& source, double gravity, double time_step);

  /// Where grains start, m.
  double start_height() const;
  /// Step at which grain k starts, from the start of the pour.
  long release_step(int k) const;
  /// Step at which its centre has come down to height y, m; not before its release.
  long arrival_step(int k, double y) const;
  /// Height (m) and velocity (m/s, downwards negative) of its centre at a step after its release.
  void place(NewGrain& grain, int k, long step) const;
  /// Abscissa of the funnel's axis when grain k starts, m.
  double axis(int k) const;

 private:
  SourceSetup source_;
  double gravity_, time_step_;
};

/// Least interval, s, between grains of largest diameter d so that one has cleared the mouth by d
/// when the next one starts: v t + g t^2/2 = d.
double least_interval(double speed, double gravity, double diameter);

}  // namespace grainfield::dem
