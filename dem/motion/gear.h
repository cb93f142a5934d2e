// Gear's predictor-corrector of fifth order for a second-order equation (Roul 2.20-2.23; Allen and
// Tildesley, appendix E). Each coordinate carries x_n = dt^n/n! d^n x/dt^n, n = 0..5.
//
// Predictor: Pascal's triangle. Corrector: with the error of the second derivative
// e = dt^2/2 a(predicted) - x_2(predicted), x_n += c_n e, c = (3/16, 251/360, 1, 11/18, 1/6, 1/60);
// c_0 = 3/16 because the forces depend on the velocity (3/20 when they do not).
#pragma once
#include "dem/motion/load.h"

namespace grainfield::dem {

template <int D>
class GearIntegrator;

/// In the plane.
template <>
class GearIntegrator<2> {
 public:
  static constexpr bool end_moves = true;
  /// Scaled derivatives 2..5 of a place or an angle.
  template <class T>
  struct Derivatives {
    T x2 = zero<T>(), x3 = zero<T>(), x4 = zero<T>(), x5 = zero<T>();
  };
  /// Per grain: angle and the higher derivatives.
  struct Memory {
    double rotation = 0;
    Derivatives<VectorOf<2>> place;
    Derivatives<double> turning;
  };

  explicit GearIntegrator(double dt) : dt_(dt), inverse_dt_(1 / dt), half_square_(0.5 * dt * dt) {}

  /// Sets a grain's acceleration where it is, before it has moved.
  void start(const Body<2>& b, Memory& m, const Inertia<2>&, const Load<2>& load) const {
    m.place.x2 = half_square_ * acceleration_of(b, load);
    m.turning.x2 = half_square_ * spin_rate_of(b, load);
  }
  void begin(Body<2>& b, Memory& m, const Inertia<2>&) const {
    predict(b.position, b.velocity, m.place);
    predict(m.rotation, b.spin, m.turning);
  }
  void end(Body<2>& b, Memory& m, const Inertia<2>&, const Load<2>& load) const {
    const VectorOf<2> a = acceleration_of(b, load);
    const double rate = spin_rate_of(b, load);
    correct(b.position, b.velocity, m.place, a);
    correct(m.rotation, b.spin, m.turning, rate);
  }

 private:
  template <class T>
  void predict(T& x, T& v, Derivatives<T>& d) const {
    const T x1 = v * dt_;
    x += x1 + d.x2 + d.x3 + d.x4 + d.x5;
    v = (x1 + 2 * d.x2 + 3 * d.x3 + 4 * d.x4 + 5 * d.x5) * inverse_dt_;
    d.x2 += 3 * d.x3 + 6 * d.x4 + 10 * d.x5;
    d.x3 += 4 * d.x4 + 10 * d.x5;
    d.x4 += 5 * d.x5;
  }
  template <class T>
  void correct(T& x, T& v, Derivatives<T>& d, const T& a) const {
    const T e = half_square_ * a - d.x2;
    x += (3.0 / 16) * e;
    v += (251.0 / 360) * e * inverse_dt_;
    d.x2 += e;
    d.x3 += (11.0 / 18) * e;
    d.x4 += (1.0 / 6) * e;
    d.x5 += (1.0 / 60) * e;
  }

  double dt_, inverse_dt_, half_square_;
};

/// The kind, for the registry. The corrector evaluates the forces once per step and is stable only
/// for dt * rate <= 0.16 (from its amplification matrix).
struct Gear {
  static constexpr const char* name = "gear";
  static constexpr double viscous_limit = 0.16, edge_limit = 0.16;
  static constexpr bool bears_irregular_edges = false;
  static constexpr bool leaps = false;
  static constexpr bool moves_round = true;
  template <int D>
  using In = GearIntegrator<D>;
};

}  // namespace grainfield::dem
