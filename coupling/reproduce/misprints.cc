#include "coupling/reproduce/misprints.h"

namespace grainfield::coupling {

const std::vector<Misprint>& misprints() {
  static const std::vector<Misprint> all{
      {"Roul 4.9 (and the labels in 4.15, 4.17)", "a11 = 1+cos²β, a22 = sin²β",
       "swapped: σxx carries sin²β, σyy carries 1+cos²β"},
      {"Roul p. \"line source\" of 4.3", "the 49° fit called the theory's plateau",
       "49° is the + (peak) branch; the plateau branch is 39°"},
      {"Roul 4.21", "σxy/σyy → tanφ at the slope", "→ η0 tanφ"},
      {"Roul 4.23", "μ = 2(K+1) tan²τ/(…)", "2(K+1) tanτ/(…)"},
      {"Roul 4.28", "s_xy = s* μ(1−S)", "s* η(1−S)"},
      {"Roul 4.25", "right side g", "ρ g"},
      {"Roul 2.19", "velocity Verlet with a(t)+½a(t+Δt)", "½(a(t)+a(t+Δt))"},
      {"Roul 2.10", "√(m/Y·π)/10",
       "a tenth of the contact's half period, π√(m/Y)/10 (Roul ran 2e-6 s, well below either)"},
      {"Roul 2.23 (matrix)", "two equal rows", "Pascal triangle of 2.22"},
      {"Roul 5.1", "unloaded minus loaded", "loaded minus unloaded (with the sign of −σ)"},
      {"Wellmann 11", "(1/κ)² E − K", "κ² E − K"},
      {"Wellmann 6", "\"c_end = 0.4\"", "0.04"},
      {"Liffman 30", "(x_{k+1} − x_k)/2", "(x_{k+1} + x_k)/2"},
      {"Liffman 7, 19", "P_t = μ P_n, signed comparison",
       "magnitudes, with the sign of the no-slip impulse"},
      {"Liffman 14", "ω2* = ω2 − r2×P/I2", "ω2 + r2×P/I2"},
      {"Liffman 29", "−μ F_k t̂", "with the sign of the slip"},
      {"Liffman 36", "τ = σ F_slip/2", "−(σ/2) F_t, F_t the tangential force that acts"},
      {"Roul 2.39", "the viscous part accumulates in the spring", "beside the spring"},
  };
  return all;
}

}  // namespace grainfield::coupling
