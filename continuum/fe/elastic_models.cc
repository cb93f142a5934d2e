// The layer and the half space on top of ElasticSolver. Both are symmetric about the load, so only
// x >= 0 (and in 3D y >= 0) is meshed; the vertical axis is the last one.
//
// Layer: the displacement is split into the half space's closed form under a point load, which
// holds the singularity, and a smooth rest, which the elements solve for: its data are minus the
// closed form's displacement and traction on base and sides. The point load is met exactly.
//
// Layer with the load below its surface: no closed form enters. The load is a smooth body force,
// around which the first mesh is refined in proportion to the distance.
//
// Half space: no closed form enters. The load is a uniform pressure on a small patch, and the mesh,
// whose cells grow with their distance from the load, reaches so far (each doubling of the radius
// costs the same number of cells) that holding its end fixed is not felt at the depth of interest.
//
// The material is isotropic, or in space has a vertical axis of symmetry. Its constants may change
// with the depth. The closed form of the layer is then that of the constants C_0 at the surface,
// and the elements solve for the rest with the initial stress (C - C_0) eps_0, as
// orthotropic_layer.cc does.
#include <deal.II/grid/grid_generator.h>
#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>

#include "continuum/closed/half_space.h"
#include "continuum/closed/transverse.h"
#include "continuum/fe/box_model.h"
#include "continuum/fe/plugin.h"
#include "continuum/moduli_by_depth.h"
#include "continuum/settings.h"

namespace grainfield::continuum {
namespace {

using fe::BoxModel;
using fe::ElasticProblem;
using fe::kOnBorder;
using fe::Stress;
using fe::Vector;
template <int dim>
using Point = dealii::Point<dim>;

template <int dim>
Stress<dim> point_load_stress(double F, double nu, const Point<dim>& p) {
  Stress<dim> s;
  if constexpr (dim == 2) {
    const auto found = flamant_stress(F, p[0], p[1]);
    for (int c = 0; c < 3; ++c) s[c] = found[c];
  } else {
    const auto found = boussinesq_stress(F, nu, p[0], p[1], p[2]);
    for (int c = 0; c < 6; ++c) s[c] = found[c];
  }
  return s;
}

template <int dim>
Vector<dim> point_load_displacement(double F, double E, double nu, const Point<dim>& p) {
  Vector<dim> u;
  if constexpr (dim == 2) {
    const auto found = flamant_displacement(F, E, nu, p[0], p[1]);
    for (int d = 0; d < 2; ++d) u[d] = found[d];
  } else {
    const auto found = boussinesq_displacement(F, E, nu, p[0], p[1], p[2]);
    for (int d = 0; d < 3; ++d) u[d] = found[d];
  }
  return u;
}

/// A material, and the half space of its constants at the surface under the load.
template <int dim>
struct Medium {
  fe::Stiffness<dim> stiffness;
  std::function<Stress<dim>(const Point<dim>&)> stress = {};
  std::function<Vector<dim>(const Point<dim>&)> displacement = {};
  /// The stiffness of a table at a place, and its inverse at the surface.
  std::function<fe::Stiffness<dim>(const Point<dim>&)> stiffness_at = {};
  fe::Stiffness<dim> compliance = {};

  void put_stiffness(ElasticProblem<dim>& equations) const {
    if (stiffness_at)
      equations.stiffness_at = stiffness_at;
    else
      equations.stiffness = stiffness;
  }
};

/// C eps_0 of the half space's strain eps_0, C that of a place.
template <int dim>
Stress<dim> stress_of(const fe::Stiffness<dim>& C, const Medium<dim>& medium,
                      const Stress<dim>& at_surface) {
  Eigen::Matrix<double, fe::kStresses<dim>, 1> s;
  for (unsigned int c = 0; c < fe::kStresses<dim>; ++c) s[c] = at_surface[c];
  s = C * (medium.compliance * s);
  Stress<dim> out;
  for (unsigned int c = 0; c < fe::kStresses<dim>; ++c) out[c] = s[c];
  return out;
}

template <int dim>
Medium<dim> isotropic(const Settings& s) {
  const double F = number_of(s, "F"), E = number_of(s, "E"), nu = number_of(s, "nu");
  return {fe::isotropic_stiffness<dim>(E, nu),
          [=](const Point<dim>& p) { return point_load_stress<dim>(F, nu, p); },
          [=](const Point<dim>& p) { return point_load_displacement<dim>(F, E, nu, p); }};
}

/// Stress and displacement of the half plane of a vertical section.
Medium<2> plane_of(double F, const TransverseModuli& moduli) {
  const PlaneModuli plane = moduli.plane_strain();
  Medium<2> out{stiffness(plane)};
  out.stress = [F, ratios = orthotropy(plane)](const Point<2>& p) {
    const auto found = orthotropic_stress(F, ratios, p[0], p[1]);
    Stress<2> stress;
    for (unsigned int c = 0; c < 3; ++c) stress[c] = found[c];
    return stress;
  };
  out.displacement = [F, plane](const Point<2>& p) {
    const auto found = orthotropic_displacement(F, plane, p[0], p[1]);
    Vector<2> u;
    for (unsigned int d = 0; d < 2; ++d) u[d] = found[d];
    return u;
  };
  return out;
}

Medium<3> space_of(double F, const TransverseModuli& moduli) {
  const TransverseHalfSpace half_space(F, moduli);
  Medium<3> out{moduli.stiffness()};
  out.stress = [half_space](const Point<3>& p) {
    const auto found = half_space.stress(p[0], p[1], p[2]);
    Stress<3> stress;
    for (unsigned int c = 0; c < 6; ++c) stress[c] = found[c];
    return stress;
  };
  out.displacement = [half_space](const Point<3>& p) {
    const auto found = half_space.displacement(p[0], p[1], p[2]);
    Vector<3> u;
    for (unsigned int d = 0; d < 3; ++d) u[d] = found[d];
    return u;
  };
  return out;
}

/// Constants by depth, from a table that reaches as deep as the model.
template <int dim>
Medium<dim> graded(const Settings& s, double depth) {
  const ModuliByDepth table = read_moduli_by_depth(s.at("moduli"));
  table.require_cover(depth);
  const double F = number_of(s, "F");
  Medium<dim> out;
  if constexpr (dim == 2) {
    out = plane_of(F, table.at(0));
    out.stiffness_at = [table](const Point<2>& p) {
      return stiffness(table.at(-p[1]).plane_strain());
    };
  } else {
    out = space_of(F, table.at(0));
    out.stiffness_at = [table](const Point<3>& p) { return table.at(-p[2]).stiffness(); };
  }
  out.compliance = out.stiffness.inverse();
  return out;
}

template <int dim>
class ElasticLayer : public BoxModel<dim> {
 public:
  ElasticLayer(const std::string& name, const Settings& s, Medium<dim> medium)
      : BoxModel<dim>(name, s, dim == 2 ? 2e-4 : 5e-3, dim == 2 ? 3 : 2),
        medium_(std::move(medium)),
        h_(number_of(s, "h")),
        ratio_(number_of(s, "half_width")),
        cells_(static_cast<unsigned int>(number_of(s, "cells"))),
        below_(number_of(s, "load_depth") * h_),
        rough_(s.at("base") == "rough"),
        free_sides_(s.at("sides") == "free") {
    if (below_ == 0) return;
    if (below_ < kLeastBelow * h_)
      throw BadParameter(
          fmt::format("model {}: load_depth = {} is out of range; allowed: 0, or {} to 0.9", name,
                      below_ / h_, kLeastBelow));
    medium_.stress = [](const Point<dim>&) { return Stress<dim>(); };
    medium_.displacement = [](const Point<dim>&) { return Vector<dim>(); };
  }

 protected:
  void build_mesh(dealii::parallel::distributed::Triangulation<dim>& mesh) override {
    this->half_width_ = ratio_ * h_;
    this->bottom_ = -h_;
    std::vector<unsigned int> divisions(dim, static_cast<unsigned int>(std::ceil(ratio_ * cells_)));
    divisions[dim - 1] = cells_;
    Point<dim> low, high;
    for (int d = 0; d < dim - 1; ++d) high[d] = this->half_width_;
    low[dim - 1] = -h_;
    dealii::GridGenerator::subdivided_hyper_rectangle(mesh, divisions, low, high, true);
    if (below_ > 0) refine_around_load(mesh);
  }

  ElasticProblem<dim> problem() const override {
    const auto displacement = [this](const Point<dim>& p) { return -medium_.displacement(p); };
    const auto traction = [this](const Point<dim>& p, const Vector<dim>& normal) {
      return -fe::traction<dim>(medium_.stress(p), normal);
    };
    ElasticProblem<dim> equations;
    medium_.put_stiffness(equations);
    if (below_ > 0) {
      equations.body_force = [this](const Point<dim>& p) {
        Vector<dim> force;
        const double peak = this->load_ / std::pow(std::sqrt(2 * M_PI) * spread(), dim);
        force[dim - 1] = -peak * std::exp(-p.distance_square(load()) / (2 * spread() * spread()));
        return force;
      };
    } else if (medium_.stiffness_at) {
      equations.initial_stress = [this](const Point<dim>& p) {
        return stress_of<dim>(medium_.stiffness_at(p) - medium_.stiffness, medium_,
                              medium_.stress(p));
      };
    }
    for (int axis = 0; axis < dim - 1; ++axis) {
      equations.boundaries[2 * axis] = this->mirror_plane(axis);
      auto& side = equations.boundaries[2 * axis + 1];
      side = {{}, displacement, traction};
      side.fixed[axis] = !free_sides_;
    }
    auto& base = equations.boundaries[2 * (dim - 1)];
    base = {{}, displacement, traction};
    base.fixed.fill(rough_);
    base.fixed[dim - 1] = true;
    return equations;
  }

  std::vector<Point<dim>> probes() const override {
    std::vector<Point<dim>> points;
    for (const double depth : {0.5, 1.})
      for (const double x : {0., 0.2, 0.4, 0.6, 0.8, 1., 1.3, 1.6, 2., 2.5, 3., 4.})
        if (x <= ratio_) points.push_back(this->horizontal_and_height(x * h_, -depth * h_));
    return points;
  }
  /// At a load below the surface that of its distance, up to the depth.
  double scale(const Point<dim>& probe) const override {
    const double from = below_ > 0 ? std::clamp(probe.distance(load()), spread(), h_) : h_;
    return std::max(std::abs(this->load_) / std::pow(from, dim - 1),
                    std::numeric_limits<double>::min());
  }
  Stress<dim> closed_part(const Point<dim>& p) const override {
    const Stress<dim> stress = medium_.stress(p);
    return medium_.stiffness_at ? stress_of<dim>(medium_.stiffness_at(p), medium_, stress) : stress;
  }
  /// Jumps at a load below the surface would otherwise draw all the cells.
  double refinement_weight(const Point<dim>& p) const override {
    return below_ > 0 ? std::min(1., std::pow(2 * p.distance(load()) / h_, dim / 2.)) : 1;
  }

 private:
  static constexpr double kLeastBelow = 1e-4;
  Point<dim> load() const { return this->horizontal_and_height(0, -below_); }
  /// Standard deviation of a load below the surface.
  double spread() const { return below_ / 5; }

  // Cells at the load no larger than its spread, elsewhere than half their distance from it.
  void refine_around_load(dealii::parallel::distributed::Triangulation<dim>& mesh) const {
    const int levels = std::max(0, static_cast<int>(std::ceil(std::log2(h_ / cells_ / spread()))));
    for (int level = 0; level < levels; ++level) {
      for (const auto& cell : mesh.active_cell_iterators()) {
        if (!cell->is_locally_owned()) continue;
        const double edge = cell->extent_in_direction(dim - 1);
        const double distance = cell->center().distance(load()) - edge * std::sqrt(dim) / 2;
        if (edge > std::max(spread(), distance / 2)) cell->set_refine_flag();
      }
      mesh.execute_coarsening_and_refinement();
    }
  }

  Medium<dim> medium_;
  double h_, ratio_;
  unsigned int cells_;
  double below_;  // depth of the load
  bool rough_, free_sides_;
};

template <int dim>
class ElasticHalfSpace : public BoxModel<dim> {
 public:
  ElasticHalfSpace(const std::string& name, const Settings& s, const Medium<dim>& medium)
      : BoxModel<dim>(name, s, dim == 2 ? 2e-3 : 1e-2, 3),
        medium_(medium),
        depth_(number_of(s, "depth")),
        patch_(nonzero_or(s, "patch", dim == 2 ? 0.05 : 0.02) * depth_),
        cells_(nonzero_or(s, "cells", dim == 2 ? 2 : 1)) {
    const double reach = nonzero_or(s, "radius", dim == 2 ? 1e4 : 50);
    if (reach < 4)
      throw BadParameter(fmt::format(
          "model {}: radius = {} is out of range; allowed: 0, or at least 4", name, reach));
    if (patch_ < kLeastPatch * depth_)
      throw BadParameter(fmt::format("model {}: patch = {} is out of range; allowed: 0, or {} to 1",
                                     name, patch_ / depth_, kLeastPatch));
    // The half patch is a cell of the finest level, so that its border is a cell's border.
    levels_ = static_cast<int>(std::ceil(std::log2(reach * depth_ / (patch_ / 2))));
  }

 protected:
  void build_mesh(dealii::parallel::distributed::Triangulation<dim>& mesh) override {
    this->half_width_ = std::ldexp(patch_ / 2, levels_);
    this->bottom_ = -this->half_width_;
    Point<dim> low, high;
    for (int d = 0; d < dim - 1; ++d) high[d] = this->half_width_;
    low[dim - 1] = this->bottom_;
    dealii::GridGenerator::hyper_rectangle(mesh, low, high, true);
    for (int level = 0; level < levels_; ++level) {
      for (const auto& cell : mesh.active_cell_iterators()) {
        if (!cell->is_locally_owned()) continue;
        const double edge = cell->extent_in_direction(0);
        const double distance = std::max(0., cell->center().norm() - edge * std::sqrt(dim) / 2);
        // Beyond ten depths a mesh half as fine does: what is wrong there is hardly felt at the
        // depth.
        const double per_distance = distance > 10 * depth_ ? cells_ / 2 : cells_;
        if (edge * per_distance > std::max(distance, patch_ / 2 * per_distance * (1 + kOnBorder)))
          cell->set_refine_flag();
      }
      mesh.execute_coarsening_and_refinement();
    }
    this->figures_["truncation_radius"] = this->half_width_;
    this->figures_["patch_width"] = patch_;
  }

  ElasticProblem<dim> problem() const override {
    ElasticProblem<dim> equations;
    medium_.put_stiffness(equations);
    for (int axis = 0; axis < dim - 1; ++axis) {
      equations.boundaries[2 * axis] = this->mirror_plane(axis);
      equations.boundaries[2 * axis + 1].fixed.fill(true);
    }
    equations.boundaries[2 * (dim - 1)].fixed.fill(true);
    const double half = patch_ / 2, pressure = this->load_ / std::pow(patch_, dim - 1);
    equations.boundaries[2 * dim - 1].traction = [=](const Point<dim>& p, const Vector<dim>&) {
      Vector<dim> t;
      bool loaded = true;
      for (int d = 0; d < dim - 1; ++d) loaded = loaded && p[d] < half;
      if (loaded) t[dim - 1] = -pressure;
      return t;
    };
    return equations;
  }

  std::vector<Point<dim>> probes() const override {
    std::vector<Point<dim>> points;
    for (const double depth : {0.5, 1., 2.})
      for (const double x : {0., 0.5, 1., 2.})
        points.push_back(this->horizontal_and_height(x * depth * depth_, -depth * depth_));
    return points;
  }
  double scale(const Point<dim>& probe) const override {
    return std::max(std::abs(this->load_) / std::pow(probe.norm(), dim - 1),
                    std::numeric_limits<double>::min());
  }
  /// Jumps at the patch's border, a local matter, would otherwise draw all the cells.
  double refinement_weight(const Point<dim>& p) const override {
    return std::min(1., std::pow(2 * p.norm() / depth_, dim));
  }

 private:
  static constexpr double kLeastPatch = 1e-4;
  Medium<dim> medium_;
  double depth_, patch_, cells_;
  int levels_ = 0;
};

/// The setting that says how deep the model is.
template <template <int> class Kind>
constexpr const char* kDepth = "h";
template <>
constexpr const char* kDepth<ElasticHalfSpace> = "depth";

template <template <int> class Kind, int dim>
std::unique_ptr<Model> make_elastic_in(const std::string& name, const Settings& s) {
  return std::make_unique<Kind<dim>>(
      name, s,
      s.at("moduli").empty() ? isotropic<dim>(s) : graded<dim>(s, number_of(s, kDepth<Kind>)));
}

template <template <int> class Kind>
std::unique_ptr<Model> make_elastic(const std::string& name, const Settings& s) {
  return s.at("dim") == "3" ? make_elastic_in<Kind, 3>(name, s) : make_elastic_in<Kind, 2>(name, s);
}

template <template <int> class Kind>
std::unique_ptr<Model> make_transverse(const std::string& name, const Settings& s) {
  return std::make_unique<Kind<3>>(name, s,
                                   space_of(number_of(s, "F"), transverse_moduli(name, s)));
}

const fe::ModelRow rows[] = {{"fe_elastic_layer", make_elastic<ElasticLayer>},
                             {"fe_elastic_half_space", make_elastic<ElasticHalfSpace>},
                             {"fe_transverse_layer", make_transverse<ElasticLayer>},
                             {"fe_transverse_half_space", make_transverse<ElasticHalfSpace>}};

}  // namespace
}  // namespace grainfield::continuum
