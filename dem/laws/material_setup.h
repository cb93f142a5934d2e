// What grains and walls are made of, with Roul's table 5.1 as defaults. SI, 2D: areal density in
// kg/m2, stiffness and Young's modulus in N/m.
#pragma once
#include <string>

namespace grainfield::dem {

struct MaterialSetup {
  std::string law = "overlap_area";       ///< overlap_area | linear | hertz (3D)
  double density = 5000;                  ///< kg/m2
  double young = 1e7;                     ///< N/m; overlap_area; Pa: hertz
  double damping = 0.75;                  ///< gamma of overlap_area, -
  double poisson = 0.3;                   ///< of hertz, -
  double normal_stiffness = 1e7;          ///< N/m; linear
  double tangential_stiffness = 2e7 / 7;  ///< N/m; linear
  double normal_damping = 500;            ///< 1/s; linear: force m_eff * gamma_n * v_n
  double tangential_damping = 250;        ///< 1/s; linear
  double friction = 0.5;                  ///< grain on grain
  double floor_friction = 0.5;            ///< grain on flat floor
  double wall_friction = 0;               ///< grain on side walls
  double gravity = 9.81;                  ///< m/s2, downwards
};

}  // namespace grainfield::dem
