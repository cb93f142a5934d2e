// A layer with vertical and horizontal elastic axes on a rigid base under a point load, plane
// strain, the same everywhere or from a map.
//
// As in the isotropic layer the displacement is split, u = u_0 + w: u_0, eps_0, sigma_0 are the
// closed form of the half plane (Lekhnitskii; Otto et al. 2003) with the constants C_0 at the load,
// which holds the singularity. The elements solve for w:
//   div(C eps(w) + s) = 0, s = (C - C_0) eps_0, bounded at the load where C is continuous,
// with w = -u_0 where the displacement is held and (C eps(w) + s) n = -sigma_0 n elsewhere. The
// stress is C eps(w) + C eps_0.
#include <deal.II/grid/grid_generator.h>
#include <fmt/format.h>

#include "continuum/closed/orthotropic.h"
#include "continuum/elastic_field.h"
#include "continuum/fe/box_model.h"
#include "continuum/fe/plugin.h"

namespace grainfield::continuum {
namespace {

using fe::ElasticProblem;
using fe::Stress;
using Vector = fe::Vector<2>;
using Point = dealii::Point<2>;

constexpr char kOrthotropic[] = "fe_orthotropic_layer";

Stress<2> stored(const Eigen::Vector3d& stress) {
  Stress<2> s;
  for (int c = 0; c < 3; ++c) s[static_cast<unsigned int>(c)] = stress[c];
  return s;
}

/// The constants of the settings: r and t, or moduli. nu_xy is nan where it is neither set nor
/// felt.
PlaneModuli moduli_of(const Settings& s) {
  PlaneModuli m{number_of(s, "E_x"), number_of(s, "E_y"), number_of(s, "nu_xy"), number_of(s, "G")};
  const int set = !std::isnan(m.E_x) + !std::isnan(m.E_y) + !std::isnan(m.G);
  if (set != 0 && (set != 3 || std::isnan(m.nu_xy)))
    throw BadParameter(
        fmt::format("model {}: found {} of E_x, E_y, G, nu_xy; allowed: all four, or r and t "
                    "(with nu_xy where it is felt)",
                    kOrthotropic, set + !std::isnan(m.nu_xy)));
  if (set == 3) {
    if (!is_stable(m))
      throw BadParameter(fmt::format(
          "model {}: nu_xy = {:.6g} is not elastic; allowed: between -{:.6g} and {:.6g} "
          "(sqrt(E_x/E_y))",
          kOrthotropic, m.nu_xy, std::sqrt(m.E_x / m.E_y), std::sqrt(m.E_x / m.E_y)));
    return m;
  }
  const double r = number_of(s, "r"), t = number_of(s, "t"), root = std::sqrt(t);
  if (!(r > -root))
    throw BadParameter(fmt::format(
        "model {}: r = {:.6g} is not elastic; allowed: above -sqrt(t) = {:.6g} at t = {:.6g}",
        kOrthotropic, r, -root, t));
  const double least = std::max(-r, -root);
  const bool rough = s.at("base") == "rough";
  if (std::isnan(m.nu_xy) && (rough || s.at("sides") == "smooth"))
    throw BadParameter(
        fmt::format("model {}: nu_xy is not set; {} needs it, allowed: between {:.6g} and {:.6g}",
                    kOrthotropic, rough ? "base = rough" : "sides = smooth", least, root));
  if (m.nu_xy <= least || m.nu_xy >= root)
    throw BadParameter(
        fmt::format("model {}: nu_xy = {:.6g} is not elastic with r = {:.6g}, t = {:.6g}; allowed: "
                    "between max(-r, -sqrt(t)) = {:.6g} and sqrt(t) = {:.6g}",
                    kOrthotropic, m.nu_xy, r, t, least, root));
  m.E_x = 1;
  m.E_y = 1 / t;
  m.G = 1 / (2 * (r + m.nu_xy));
  return m;
}

/// The same, with the middle of the admitted nu_xy where the stress does not depend on it.
PlaneModuli solvable(PlaneModuli m, double r, double t) {
  if (!std::isnan(m.nu_xy)) return m;
  const double root = std::sqrt(t);
  m.nu_xy = 0.5 * (std::max({-r, -root, 0.}) + root);
  m.G = 1 / (2 * (r + m.nu_xy));
  return m;
}

/// Points over |x| <= half width, -h <= y <= 0 that stand for equal parts of it.
Points over_the_box(double half_width, double h) {
  constexpr int kAcross = 320, kDeep = 40;
  Points points(kAcross * kDeep, 2);
  for (int j = 0; j < kDeep; ++j)
    for (int i = 0; i < kAcross; ++i)
      points.row(i + kAcross * j) << half_width * ((2 * i + 1.) / kAcross - 1),
          -h * (j + 0.5) / kDeep;
  return points;
}

class OrthotropicLayer : public fe::BoxModel<2> {
 public:
  explicit OrthotropicLayer(const Settings& s)
      : fe::BoxModel<2>(kOrthotropic, s, 2e-4, 3),
        h_(number_of(s, "h")),
        ratio_(number_of(s, "half_width")),
        cells_(static_cast<unsigned int>(number_of(s, "cells"))),
        rough_(s.at("base") == "rough"),
        free_sides_(s.at("sides") == "free") {
    if (s.at("map").empty()) {
      at_load_ = moduli_of(s);
      if (!std::isnan(at_load_.nu_xy)) figures_["nu_xy"] = at_load_.nu_xy;
      at_load_ = solvable(at_load_, number_of(s, "r"), number_of(s, "t"));
    } else {
      field_ = read_elastic_field(s.at("map"));
      figures_["map_share"] = field_->require_cover(
          kOrthotropic, "layer", over_the_box(ratio_ * h_, h_),
          "take half_width (in depths) to fit the map, whose load is at (0, 0)");
      at_load_ = field_->moduli(0, 0);
      figures_["nu_xy"] = at_load_.nu_xy;
      mirrored_ = false;
    }
    ratios_ = orthotropy(at_load_);
    stiffness_ = stiffness(at_load_);
    compliance_ = compliance(at_load_);
    figures_["r"] = ratios_.r;
    figures_["t"] = ratios_.t;
  }

 protected:
  void build_mesh(dealii::parallel::distributed::Triangulation<2>& mesh) override {
    half_width_ = ratio_ * h_;
    bottom_ = -h_;
    const auto across = static_cast<unsigned int>(std::ceil(ratio_ * cells_));
    dealii::GridGenerator::subdivided_hyper_rectangle(
        mesh, {mirrored_ ? across : 2 * across, cells_}, Point(mirrored_ ? 0 : -half_width_, -h_),
        Point(half_width_, 0), true);
  }

  ElasticProblem<2> problem() const override {
    const auto displacement = [this](const Point& p) {
      const auto u = orthotropic_displacement(load_, at_load_, p[0], p[1]);
      Vector w;
      w[0] = -u[0];
      w[1] = -u[1];
      return w;
    };
    const auto traction = [this](const Point& p, const Vector& normal) {
      return -fe::traction<2>(stored(half_plane_stress(p)), normal);
    };
    ElasticProblem<2> equations;
    if (field_) {
      equations.stiffness_at = [this](const Point& p) { return field_->at(p[0], p[1]); };
      equations.initial_stress = [this](const Point& p) {
        return stored((field_->at(p[0], p[1]) - stiffness_) * half_plane_strain(p));
      };
    } else {
      equations.stiffness = stiffness_;
    }
    for (const unsigned int side : {0, 1}) {
      auto& condition = equations.boundaries[side];
      if (side == 0 && mirrored_) {
        condition.fixed[0] = true;
        continue;
      }
      condition.displacement = displacement;
      condition.traction = traction;
      condition.fixed[0] = !free_sides_;
    }
    auto& base = equations.boundaries[2];
    base.displacement = displacement;
    base.traction = traction;
    base.fixed = {rough_, true};
    // Nothing else holds it against sliding as a whole; no force acts on the pin.
    if (!mirrored_ && free_sides_ && !rough_) equations.pins = {{Point(0, -h_), {true, false}}};
    return equations;
  }

  std::vector<Point> probes() const override {
    std::vector<Point> points;
    for (const double depth : {0.5, 1.}) {
      for (const double x : {0., 0.2, 0.4, 0.6, 0.8, 1., 1.3, 1.6, 2., 2.5, 3., 4.}) {
        if (x > ratio_) continue;
        points.emplace_back(x * h_, -depth * h_);
        if (!mirrored_ && x > 0) points.emplace_back(-x * h_, -depth * h_);
      }
    }
    return points;
  }
  double scale(const Point&) const override {
    return std::max(std::abs(load_) / h_, std::numeric_limits<double>::min());
  }
  Stress<2> closed_part(const Point& p) const override {
    return stored(field_ ? field_->at(p[0], p[1]) * half_plane_strain(p) : half_plane_stress(p));
  }

 private:
  Eigen::Vector3d half_plane_stress(const Point& p) const {
    const auto s = orthotropic_stress(load_, ratios_, p[0], p[1]);
    return {s[0], s[1], s[2]};
  }
  Eigen::Vector3d half_plane_strain(const Point& p) const {
    return compliance_ * half_plane_stress(p);
  }

  double h_, ratio_;
  unsigned int cells_;
  bool rough_, free_sides_;
  std::optional<ElasticField> field_;
  PlaneModuli at_load_;
  Orthotropy ratios_;
  Eigen::Matrix3d stiffness_, compliance_;
};

const fe::ModelRow orthotropic_row{kOrthotropic, fe::made<OrthotropicLayer>};

}  // namespace
}  // namespace grainfield::continuum
