// A small pile, and runs and snapshots as several suites need them.
#pragma once
#include <string>

#include "coupling/studies/pile/simulation.h"
#include "dem/run/run.h"

namespace grainfield::dem {

// Grains ten times Roul's, so that a step is ten times as long.
inline PileSetup small_pile(const std::string& source, const std::string& shape) {
  PileSetup s;
  s.shape.kind = shape;
  s.shape.radius = 0.0275;
  s.source.kind = source;
  s.source.grains = 80;
  s.source.height = 1;
  s.source.interval = 0.15;
  s.source.length = 1.3;
  s.source.clearance = 0.08;
  s.floor.length = 4;
  s.floor.kind = shape == "disk" ? "rough" : "smooth";  // disks roll away on a flat floor
  // Disks without rolling resistance creep: a modest rest will do.
  s.rest.unbalanced_force_ratio = 1e-3;
  s.rest.kinetic_to_elastic_energy = 1e-4;
  return s;
}

inline void finish(Run& run) {
  while (!run.done()) run.advance(5000);
}

/// Same bits of places, velocities, outlines, forces and springs.
inline bool same(const Snapshot& a, const Snapshot& b) {
  if (a.grains.size() != b.grains.size() || a.contacts.size() != b.contacts.size()) return false;
  for (std::size_t k = 0; k < a.grains.size(); ++k) {
    if (a.grains[k].position != b.grains[k].position || a.grains[k].angle != b.grains[k].angle ||
        a.grains[k].velocity != b.grains[k].velocity ||
        a.grains[k].outline != b.grains[k].outline) {
      return false;
    }
  }
  for (std::size_t k = 0; k < a.contacts.size(); ++k) {
    if (a.contacts[k].force != b.contacts[k].force ||
        a.contacts[k].spring != b.contacts[k].spring) {
      return false;
    }
  }
  return true;
}

}  // namespace grainfield::dem
