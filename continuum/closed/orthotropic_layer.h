// Layer of depth h on a rigid base whose elastic axes are the vertical and the horizontal, under a
// line load; the material of orthotropic.h. Waves and quadrature are those of all layers here.
//
// With d the depth, k the wave number, s = k d, u = k h, Airy's function is
//   phi = (F/pi) Int g(s) cos(k x) / k^2 dk,   g'''' - 2 r g'' + t g = 0,  so that
//   sigma_xx = (F/pi) Int g'' cos(k x) dk,  sigma_yy = -(F/pi) Int g cos(k x) dk,
//   sigma_xd = (F/pi) Int g' sin(k x) dk.
// Top: g(0) = 1, g'(0) = 0. Base, s = u: no vertical displacement, and no shear (smooth) or no
// horizontal displacement (rough):
//   smooth  g' = 0, g''' = 0                          stresses depend on r and t alone
//   rough   g'' + nu g = 0, g''' = (2 r + nu) g'      nu = nu_xy of the plane
// Solutions are exp(-m s) (a C(s) + b S(s)) and the same from the base up, with
//   m^2 = (r + sqrt t)/2,  D = (r - sqrt t)/2,  C = cosh(sqrt(D) s),  S = sinh(sqrt(D) s)/sqrt(D):
// real for either sign of D, and not degenerate at D = 0 (r = t = 1: the isotropic layer).
// The base adds what falls like exp(-k (2h - d)), also under the load.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "continuum/closed/orthotropic.h"

namespace grainfield::continuum {

class OrthotropicWaves {
 public:
  /// `tail`: what the base adds is left out where its decay is below exp(-tail).
  /// Needs t > 0 and r > -sqrt(t). nu counts on a rough base only, where the material must be a
  /// solid: r + nu > 0 (G > 0) and nu^2 <= t. Otherwise there are poles on the way of integration.
  OrthotropicWaves(const Orthotropy& medium, double nu, bool rough, double tail = 34);
  /// A place's index, u = k h, weight, g'', g, g'.
  using Take = std::function<void(Eigen::Index, double, double, double, double, double)>;
  /// Hands over what the base adds (the half plane's part is orthotropic_stress) at the nodes of a
  /// quadrature over u, for places at the depths `share` (d/h in [0, 1]); phases up to u * `phase`
  /// are resolved.
  void integrate_base(const Eigen::ArrayXd& share, double phase, const Take& take) const;
  /// g'', g, g' of layer and half plane together; shares x 3.
  Eigen::MatrixX3d total(double u, const Eigen::VectorXd& share) const;
  /// The base adds what falls like exp(-decay u (2 - share)); decay of the faster wave.
  double decay() const;
  double fast_decay() const { return 2 * m_ - decay(); }
  /// Waves of the integrand over u: sqrt(-D) for D < 0, else 0.
  double oscillation() const;

 private:
  struct Values {
    double g, g1, g2, g3;
  };
  // a C + b S, times exp(-m z), and its derivatives along z.
  Values pair(double a, double b, double z) const;
  // The pair from the top of the half plane: g(0) = 1, g'(0) = 0.
  Values half_plane(double s) const { return pair(1, m_, s); }
  Eigen::Vector4d coefficients(double u) const;
  void add_base(double u, double weight, const Eigen::ArrayXd& share, const Take& take) const;
  Eigen::Vector2d base_conditions(const Values& v) const;
  Values reflected(const Eigen::Vector4d& c, double s, double u) const;

  Orthotropy medium_;
  double nu_;
  bool rough_;
  double tail_;
  double m_, square_;  // m and D
};

/// Stress xx, yy, xy at points (n x 2: x, y up, -h <= y < 0), N/m, tension positive; n x 3.
Eigen::MatrixX3d orthotropic_layer_stress(const OrthotropicWaves& waves, const Orthotropy& medium,
                                          double F, double h, const Eigen::MatrixXd& points);

/// This stress as a model with these figures, nan outside the layer.
std::unique_ptr<Model> layer_in_plane(double F, double h, const Orthotropy& medium,
                                      const OrthotropicWaves& waves,
                                      std::map<std::string, double> figures);

}  // namespace grainfield::continuum
