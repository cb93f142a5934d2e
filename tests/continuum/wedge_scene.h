// Heaps for tests of the elasto-plastic wedge, and what the model says of settings and failures.
#pragma once
#include <string>

#include "continuum/fe/wedge.h"
#include "continuum/model.h"
#include "tests/continuum/refused_model.h"

namespace grainfield::continuum {

inline WedgeProblem heap(int cells, double slope) {
  WedgeProblem p;
  p.cells = cells;
  p.left_deg = p.right_deg = slope;
  return p;
}

inline std::string failure(const WedgeProblem& p) {
  try {
    solve_wedge(p);
  } catch (const ComputationFailed& error) {
    return error.what();
  }
  return "solved";
}

inline std::string refusal(const Settings& settings) {
  return refusal("fe_mohr_coulomb_wedge", settings);
}

}  // namespace grainfield::continuum
