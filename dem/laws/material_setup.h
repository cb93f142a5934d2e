// What grains and walls are made of, with Roul's table 5.1 as defaults. SI, 2D: areal density in
// kg/m2, stiffness and Young's modulus in N/m.
#pragma once
#include <string>
#include <tuple>

namespace grainfield::dem {

struct MaterialSetup {
  std::string law = "overlap_area";         ///< overlap_area | energy | linear | hertz (3D)
  double density = 5000;                    ///< kg/m2
  double young = 1e7;                       ///< N/m; overlap_area; Pa: hertz
  double damping = 0.75;                    ///< gamma of overlap_area, -
  double tangential_ratio = 2.0 / 7;        ///< k_t/E of overlap_area and energy, -
  std::string energy = "square";            ///< of energy: square | power
  double linear_share = 1e-3;               ///< of energy, power: A_c / l0^2, -
  double poisson = 0.3;                     ///< of hertz, -
  double normal_stiffness = 1e7;            ///< N/m; linear
  double tangential_stiffness = 2e7 / 7;    ///< N/m; linear
  double normal_damping = 500;              ///< 1/s; linear: force m_eff * gamma_n * v_n; hertz,
                                            ///< viscoelastic: 1/(m s), force a m_eff gamma_n v_n
  double tangential_damping = 250;          ///< likewise
  double restitution = 0.9;                 ///< material_defaults.h: what the dashpots follow
  double friction = 0.5;                    ///< grain on grain
  double floor_friction = 0.5;              ///< grain on flat floor
  double wall_friction = 0;                 ///< grain on side walls
  double gravity = 9.81;                    ///< m/s2, downwards
  std::string tangential_memory = "force";  ///< of hertz: force | displacement
  std::string damping_model = "critical";   ///< of hertz: critical | viscoelastic
  double least_radius = 0.1;                ///< of hertz_elliptic: radii of curvature over R, -
  double most_radius = 10;                  ///< likewise
  double rolling_stiffness = 0;             ///< N/m; rolling and twisting: rolling.h
  double rolling_damping = 0;               ///< kg/s
  double rolling_friction = 0;              ///< -; 0: none
  double twisting_stiffness = 0;            ///< N m; 3D
  double twisting_damping = 0;              ///< N m s
  double twisting_friction = 0;             ///< m; 0: none

  auto members() const {
    return std::tie(law, density, young, damping, tangential_ratio, energy, linear_share, poisson,
                    normal_stiffness, tangential_stiffness, normal_damping, tangential_damping,
                    friction, floor_friction, wall_friction, gravity, tangential_memory,
                    damping_model, least_radius, most_radius, rolling_stiffness, rolling_damping,
                    rolling_friction, twisting_stiffness, twisting_damping, twisting_friction,
                    restitution);
  }
};

}  // namespace grainfield::dem
