#include "coupling/structure/packing_structure.h"

#include <cmath>
#include <stdexcept>

#include "coupling/structure/tensor_axes.h"

namespace grainfield::coupling {
namespace {

GrainStructure structure_of(const GrainFacts& facts, int dim) {
  const TensorAxes stress = tensor_axes(facts.virial / facts.grain->volume, dim);
  GrainStructure out;
  out.contacts = facts.contacts;
  out.rattler = !facts.bearing;
  out.stress_trace = stress.trace();
  out.stress_deviator = stress.deviator();
  out.compression_angle = stress.angle_deg(dim - 1);
  out.fabric_angle = tensor_axes(facts.fabric, dim).angle_deg();
  out.long_angle = dim == 2 ? tensor_axes(facts.inertia, 2).angle_deg(1) : NAN;
  return out;
}

}  // namespace

PackingStructure packing_structure(const dem::Snapshot& snapshot) {
  PackingStructure out;
  out.counts = coordination_counts(snapshot);
  out.size = size_factor(snapshot);
  out.chains = force_chains(snapshot);
  for (const GrainFacts& facts : grain_facts(snapshot)) {
    out.grains.push_back(structure_of(facts, snapshot.dim));
    out.grains.back().chain = out.chains.chain_of[out.grains.size() - 1];
  }
  if (snapshot.dim == 2) out.axes = grain_axes(snapshot);
  try {
    out.base = base_forces(snapshot);
    out.tail = exponential_tail(out.base->normalised, 1);
  } catch (const std::invalid_argument& e) {
    out.base.reset();
    out.no_base = e.what();
  }
  return out;
}

}  // namespace grainfield::coupling
