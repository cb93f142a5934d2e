// What heaps tell models whose constants are fitted.
#pragma once

namespace grainfield::coupling {

/// What the grains have fixed: the models' other numbers.
struct HeapFacts {
  double slope_deg = 30;  ///< of both flanks: counts as the friction angle of the theories
  double rho_g = 1;       ///< N/m3 (2D: N/m2): mean density times gravity
  double height = 1;      ///< m; apex at (0, 0), inside y < 0
  double blend = 0.011;   ///< m: width over which cantelaube passes from core to
                          ///< flank, the kernel's standard deviation along a line
  double left_deg = 0, right_deg = 0;  ///< slopes for models that take the flanks apart; 0:
                                       ///< slope_deg
  double friction_deg = 0;             ///< of these models; 0: the steeper slope

  double left() const { return left_deg > 0 ? left_deg : slope_deg; }
  double right() const { return right_deg > 0 ? right_deg : slope_deg; }
  double friction() const {
    return friction_deg > 0 ? friction_deg : (left() > right() ? left() : right());
  }
};

}  // namespace grainfield::coupling
