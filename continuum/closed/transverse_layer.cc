#include "continuum/closed/transverse_layer.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "continuum/closed/about_axis.h"
#include "continuum/closed/models.h"
#include "continuum/closed/transverse.h"
#include "continuum/constants.h"
#include "continuum/settings.h"

namespace grainfield::continuum {
namespace {

// As in orthotropic_layer.cc.
constexpr double kOnBase = 1e-9;
constexpr double kLeastRatio = -0.99;
// Oscillation over decay: up to here the singularity stays a depth away from all depths of the
// layer.
constexpr double kMostOscillation = 0.5;
// Slow over fast wave's decay: from here on the nodes of about_axis resolve the depths to
// round-off.
constexpr double kLeastSlow = 0.5;

class LayerInSpace : public Model {
 public:
  LayerInSpace(double load, double depth, const OrthotropicWaves& waves, const Crests& crests,
               HalfSpaceStress half_space)
      : load_(load),
        h_(depth),
        waves_(waves),
        crests_(crests),
        half_space_(std::move(half_space)) {}

  Stresses stress(const Points& points) override {
    Stresses out = Stresses::Constant(points.rows(), 6, kNan);
    std::vector<Eigen::Index> inside;
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const double z = points(i, 2);
      if (z < 0 && z >= -h_ * (1 + kOnBase) && points.row(i).allFinite()) inside.push_back(i);
    }
    if (inside.empty()) return out;
    const auto n = static_cast<Eigen::Index>(inside.size());
    Eigen::ArrayXd radius(n), share(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto p = points.row(inside[static_cast<std::size_t>(k)]);
      radius[k] = std::hypot(p[0], p[1]) / h_;
      share[k] = std::min(-p[2] / h_, 1.0);
    }
    const auto field = [this](const Eigen::ArrayXd& r, const Eigen::ArrayXd& d) {
      return of_base(r, d);
    };
    // A slow wave that the base sends back as a fast one brings the singularity to the depth
    // 1 + slow/fast, and waves that oscillate bring it near, too.
    const double slow = waves_.decay();
    const bool smooth =
        waves_.oscillation() <= kMostOscillation * slow && slow >= kLeastSlow * waves_.fast_decay();
    const Eigen::ArrayX4d base =
        smooth ? about_axis(field, std::min(1.0, slow), radius, share) : of_base(radius, share);
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto i = inside[static_cast<std::size_t>(k)];
      const double x = points(i, 0), y = points(i, 1), r = radius[k] * h_;
      const double c = r > 0 ? x / r : 1, s = r > 0 ? y / r : 0;
      const auto half = half_space_(x, y, -share[k] * h_);
      const double rr = base(k, 0), tt = base(k, 1), zz = base(k, 2), rz = base(k, 3);
      const double added[6] = {rr * c * c + tt * s * s, rr * s * s + tt * c * c, zz, rz * s, rz * c,
                               (rr - tt) * c * s};
      for (int a = 0; a < 6; ++a) out(i, a) = half[static_cast<std::size_t>(a)] + added[a];
    }
    return out;
  }

 private:
  /// What the base adds at these radii and depths over h: rr, tt, zz, rz (z up), Pa.
  Eigen::ArrayX4d of_base(const Eigen::ArrayXd& radius, const Eigen::ArrayXd& share) const {
    Eigen::ArrayX4d sum = Eigen::ArrayX4d::Zero(radius.size(), 4);
    waves_.integrate_base(
        share, radius.maxCoeff(),
        [&](Eigen::Index i, double u, double weight, double g2, double g, double g1) {
          const double k = weight * u;
          const double at = u * radius[i], j0 = ::j0(at), j1 = ::j1(at);
          const double beside = at > 1e-4 ? j1 / at : 0.5 - at * at / 16, ahead = j0 - beside;
          const double crest = crests_.nu_h * g2 - crests_.across * g;
          sum(i, 0) += k * (g2 * ahead + crest * beside);
          sum(i, 1) += k * (g2 * beside + crest * ahead);
          sum(i, 2) -= k * g * j0;
          sum(i, 3) -= k * g1 * j1;  // changes sign with the axis that points up
        });
    return sum * (load_ / (2 * std::numbers::pi * h_ * h_));
  }

  double load_, h_;
  OrthotropicWaves waves_;
  Crests crests_;
  HalfSpaceStress half_space_;
};

std::unique_ptr<Model> make(const Settings& s) {
  const TransverseModuli m = transverse_moduli("transverse_layer", s);
  const Orthotropy plane = orthotropy(m.plane_strain());
  const double least = kLeastRatio * std::sqrt(plane.t);
  if (!(plane.r > least) || !std::isfinite(plane.r + plane.t)) {
    throw BadParameter(
        fmt::format("model transverse_layer: G_v = {:.6g} is too large beside the Young's moduli: "
                    "r = {:.6g} of its vertical planes; allowed: above {:g} sqrt(t) = {:.6g}",
                    m.G_v, plane.r, kLeastRatio, least));
  }
  const double F = number_of(s, "F");
  return layer_in_space(F, number_of(s, "h"),
                        {plane, m.plane_strain().nu_xy, s.at("base") == "rough"},
                        {m.nu_h, m.nu_v * m.E_h / m.E_v},
                        [half_space = TransverseHalfSpace(F, m)](double x, double y, double z) {
                          return half_space.stress(x, y, z);
                        });
}

}  // namespace

std::unique_ptr<Model> layer_in_space(double F, double h, const OrthotropicWaves& waves,
                                      const Crests& crests, HalfSpaceStress half_space) {
  return std::make_unique<LayerInSpace>(F, h, waves, crests, std::move(half_space));
}

ModelInfo transverse_layer_info() {
  const char* source = "Elliott 1948, waves of orthotropic_layer";
  std::vector<Parameter> parameters{
      number("F", "N", "load at the origin, down", source, 1, 0, kUnbounded),
      number("h", "m", "depth of the layer", source, 1, kAboveZero, kUnbounded)};
  for (Parameter& p : transverse_parameters()) parameters.push_back(std::move(p));
  parameters.push_back(
      choice("base", "smooth: no shear; rough: no displacement", source, {"smooth", "rough"}));
  return {"transverse_layer",
          "elastic layer with a vertical axis of symmetry on a rigid base under a point load", 3,
          std::move(parameters), make};
}

}  // namespace grainfield::continuum
