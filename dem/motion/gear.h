// Gear's predictor-corrector of fifth order for a second-order equation (Roul 2.20-2.23; Allen and
// Tildesley, appendix E). Each coordinate carries x_n = dt^n/n! d^n x/dt^n, n = 0..5.
//
// Predictor: Pascal's triangle. Corrector: with the error of the second derivative
// e = dt^2/2 a(predicted) - x_2(predicted), x_n += c_n e, c = (3/16, 251/360, 1, 11/18, 1/6, 1/60);
// c_0 = 3/16 because the forces depend on the velocity (3/20 when they do not).
#pragma once
#include "dem/space/body.h"

namespace grainfield::dem {

class GearIntegrator {
 public:
  /// Scaled derivatives 2..5 of one coordinate.
  struct Derivatives {
    double x2 = 0, x3 = 0, x4 = 0, x5 = 0;
  };
  /// Per grain: angle and the higher derivatives of x, y, angle.
  struct Memory {
    double angle = 0;
    Derivatives x, y, rotation;
  };
  static constexpr const char* name = "gear";

  explicit GearIntegrator(double dt) : dt_(dt), inverse_dt_(1 / dt), half_square_(0.5 * dt * dt) {}

  /// Of a grain that has not moved yet: its acceleration where it stands.
  void start(Memory& m, double ax, double ay, double aspin) const {
    m.x.x2 = half_square_ * ax;
    m.y.x2 = half_square_ * ay;
    m.rotation.x2 = half_square_ * aspin;
  }
  void begin(Body& b, Memory& m) const {
    predict(b.x, b.vx, m.x);
    predict(b.y, b.vy, m.y);
    predict(m.angle, b.spin, m.rotation);
  }
  void end(Body& b, Memory& m, double ax, double ay, double aspin) const {
    correct(b.x, b.vx, m.x, ax);
    correct(b.y, b.vy, m.y, ay);
    correct(m.angle, b.spin, m.rotation, aspin);
  }

 private:
  void predict(double& x, double& v, Derivatives& d) const {
    const double x1 = v * dt_;
    x += x1 + d.x2 + d.x3 + d.x4 + d.x5;
    v = (x1 + 2 * d.x2 + 3 * d.x3 + 4 * d.x4 + 5 * d.x5) * inverse_dt_;
    d.x2 += 3 * d.x3 + 6 * d.x4 + 10 * d.x5;
    d.x3 += 4 * d.x4 + 10 * d.x5;
    d.x4 += 5 * d.x5;
  }
  void correct(double& x, double& v, Derivatives& d, double a) const {
    const double e = half_square_ * a - d.x2;
    x += (3.0 / 16) * e;
    v += (251.0 / 360) * e * inverse_dt_;
    d.x2 += e;
    d.x3 += (11.0 / 18) * e;
    d.x4 += (1.0 / 6) * e;
    d.x5 += (1.0 / 60) * e;
  }

  double dt_, inverse_dt_, half_square_;
};

}  // namespace grainfield::dem
