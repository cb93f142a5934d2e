#include "dem/pouring/source.h"

#include <algorithm>
#include <cmath>

#include "dem/pouring/funnel.h"

namespace grainfield::dem {

PointSource::PointSource(const SourceSetup& source, double gravity, double time_step)
    : source_(source), gravity_(gravity), time_step_(time_step) {}

long PointSource::release_step(int k) const {
  return std::lround(k * source_.interval / time_step_);
}

long PointSource::arrival_step(int k, double y) const {
  const double fall = start_height() - y;
  if (fall <= 0) return release_step(k);
  return release_step(k) +
         static_cast<long>(least_interval(source_.speed, gravity_, fall) / time_step_);
}

void PointSource::place(NewGrain& grain, int k, long step) const {
  const double t = static_cast<double>(step - release_step(k)) * time_step_;
  grain.y = start_height() - source_.speed * t - 0.5 * gravity_ * t * t;
  grain.vy = -source_.speed - gravity_ * t;
}

double PointSource::start_height() const { return source_.height + funnel_rise(source_); }

double PointSource::axis(int k) const {
  return source_.move * (static_cast<double>(k) / (source_.grains - 1) - 0.5);
}

double least_interval(double speed, double gravity, double diameter) {
  // The positive root without cancellation.
  return 2 * diameter / (speed + std::sqrt(speed * speed + 2 * gravity * diameter));
}

}  // namespace grainfield::dem
