#include "continuum/fe/wedge.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "continuum/constants.h"
#include "continuum/fe/triangle_refinement.h"
#include "continuum/model.h"
#include "continuum/progress.h"
#include "continuum/size.h"

namespace grainfield::continuum {
namespace {

using Eigen::Vector2d;
using plasticity::Vector4;

/// Heights and barycentric coordinates that differ by less than this part are equal.
constexpr double kOnBorder = 1e-9;
/// Depths, in heights, between which the core's boundary is fitted: the apex has too few cells, the
/// base holds the material.
constexpr double kCoreFrom = 0.3, kCoreTo = 0.9;
constexpr int kCoreDepths = 25, kCoreSamples = 400;
/// Part of the half width that is left out beside the slope: there is hardly any stress.
constexpr double kCoreSkin = 0.03;
/// Part of the depths: with a border at fewer of them there is no line through it.
constexpr double kCoreLeast = 0.5;
/// Least and most height and weight: squares and cubes of them occur.
constexpr double kLeast = 1e-50, kMost = 1e50;
/// A heap with more is elastic all over.
constexpr double kMostCohesion = 1e6;

const char* name_of(const WedgeProblem& p) { return p.cone ? "fe_cone" : "fe_mohr_coulomb_wedge"; }

double steepest(const WedgeProblem& p) {
  return p.cone ? p.right_deg : std::max(p.left_deg, p.right_deg);
}

/// Layers along two unlike slopes need mesh lines of their own in each half.
bool in_halves(const WedgeProblem& p) {
  return !p.cone && p.history == WedgeHistory::grow && p.left_deg != p.right_deg;
}

/// The heap (of a cone its right half) cut by lines along its sides into cells^2 congruent
/// triangles; or each of its halves below the apex likewise, the left one first.
class Lattice {
 public:
  explicit Lattice(const WedgeProblem& p)
      : left(p.cone ? 0 : -p.height / std::tan(p.left_deg * kDegree), -p.height),
        right(p.height / std::tan(p.right_deg * kDegree), -p.height),
        cells_(p.cells),
        halves_(in_halves(p)) {}

  fe::TriangleMesh mesh() const {
    const Vector2d apex = Vector2d::Zero(), below(0, left[1]);
    if (!halves_) return fe::triangle_lattice(left, right, apex, cells_);
    fe::TriangleMesh out = fe::triangle_lattice(left, below, apex, cells_);
    const fe::TriangleMesh other = fe::triangle_lattice(below, right, apex, cells_);
    // Rows of cells + 1, cells, ... 1 corners: the left half's last ones are the right's first.
    std::vector<int> renamed;
    int end = -1;
    for (int row = 0, i = 0; row <= cells_; ++row) {
      end += cells_ - row + 1;
      for (int k = 0; k <= cells_ - row; ++k, ++i) {
        if (k > 0) out.vertices.push_back(other.vertices[static_cast<std::size_t>(i)]);
        renamed.push_back(k > 0 ? static_cast<int>(out.vertices.size()) - 1 : end);
      }
    }
    for (auto t : other.triangles) {
      for (int& corner : t) corner = renamed[static_cast<std::size_t>(corner)];
      out.triangles.push_back(t);
    }
    return out;
  }

  /// Index of the triangle that holds the point; -1 outside.
  int triangle_at(const Vector2d& p) const {
    const bool on_right = halves_ && p[0] > 0;
    const double from = on_right ? 0 : left[0], to = halves_ && !on_right ? 0 : right[0];
    const int n = cells_;
    // Parts of the apex and of the right foot; the left foot has the rest.
    const double apex = 1 - p[1] / left[1], across = (p[0] - from * (1 - apex)) / (to - from);
    if (!(std::min({apex, across, 1 - apex - across}) >= -kOnBorder)) return -1;
    const double row = std::clamp(apex, 0., 1.) * n, column = std::clamp(across, 0., 1.) * n;
    const int r = std::min(static_cast<int>(row), n - 1);
    const int i = std::min(static_cast<int>(column), n - 1 - r);
    const bool down = (row - r) + (column - i) > 1 && i + r + 1 < n;
    // Row r starts after sum_{k<r} (2 (n - k) - 1) triangles.
    return (on_right ? n * n : 0) + r * (2 * n - r) + 2 * i + (down ? 1 : 0);
  }

  /// A corner of the base near its middle.
  int base_corner() const { return halves_ ? cells_ : cells_ / 2; }

  Vector2d left, right;

 private:
  int cells_;
  bool halves_;
};

/// Mesh lines between layers: so many of `cells` are needed for each.
int cells_of_a_layer(const WedgeProblem& p) {
  return p.history == WedgeHistory::grow && !in_halves(p) && !p.cone ? 2 : 1;
}

/// The layer in which a point of the final heap is laid, from 0.
int layer_of(const WedgeProblem& p, const Lattice& lattice, const Vector2d& point) {
  double part = 0;  // of the heap that is there before
  if (p.history == WedgeHistory::rise) part = (point[1] + p.height) / p.height;
  if (p.history == WedgeHistory::grow) {
    // The smallest similar heap on the base, apex above x = 0, that holds the point.
    const double above = point[1] + p.height;
    const double slope = point[0] < 0 ? p.height / -lattice.left[0] : p.height / lattice.right[0];
    part = (above + slope * std::abs(point[0])) / p.height;
  }
  return std::clamp(static_cast<int>(part * p.layers), 0, p.layers - 1);
}

std::string advice(const WedgeProblem& p) {
  if (p.base == WedgeBase::smooth)
    return "a heap on a smooth base slides apart unless cohesion holds it: choose base = rough or "
           "frictional, or raise cohesion";
  std::string out = fmt::format("raise cohesion (now {:g} rho g h)", p.cohesion);
  if (p.base == WedgeBase::frictional) out += ", base_friction_deg";
  out += ", iterations or steps";
  // Along a slip line with this flow no more than this friction can act (Davis 1968).
  const double phi = p.friction_deg * kDegree, psi = p.dilation_deg * kDegree;
  const double davis =
      std::atan(std::sin(phi) * std::cos(psi) / (1 - std::sin(phi) * std::sin(psi))) / kDegree;
  if (steepest(p) > p.friction_deg)
    out +=
        fmt::format("; the slope, {:g} deg, is above phi_deg, {:g}", steepest(p), p.friction_deg);
  else if (steepest(p) > davis)
    out += fmt::format(
        "; with dilation_deg = {:g} slopes above {:.3g} deg may slide: raise dilation_deg or lower "
        "the slope",
        p.dilation_deg, davis);
  return out;
}

}  // namespace

void check_wedge(const WedgeProblem& p) {
  const auto refuse = [&p](bool wrong, const char* name, double found, const std::string& allowed) {
    if (!wrong) return;
    throw BadParameter(fmt::format("{}: {} = {:g} is out of range; allowed: {}", name_of(p), name,
                                   found, allowed));
  };
  if (!p.cone) {
    refuse(!(p.left_deg > 0 && p.left_deg < 90), "left_deg", p.left_deg, "above 0 to below 90 deg");
  }
  const char* right = p.cone ? "slope_deg" : "right_deg";
  refuse(!(p.right_deg > 0 && p.right_deg < 90), right, p.right_deg, "above 0 to below 90 deg");
  // Powers of these up to the third occur.
  refuse(!(p.height >= kLeast && p.height <= kMost), "h", p.height, "1e-50 to 1e50 m");
  refuse(!(p.rho_g >= kLeast && p.rho_g <= kMost), "rho_g", p.rho_g, "1e-50 to 1e50");
  refuse(!(p.cohesion >= 0 && p.cohesion <= kMostCohesion), "cohesion", p.cohesion,
         "0 to 1e6 (of rho g h)");
  refuse(p.dilation_deg > p.friction_deg, "dilation_deg", p.dilation_deg,
         fmt::format("0 to phi_deg, {:g}", p.friction_deg));
  // An infinite slope of this material, as deep as the heap, stands up to here.
  if (p.cohesion == 0)
    refuse(steepest(p) > p.friction_deg, !p.cone && p.left_deg >= p.right_deg ? "left_deg" : right,
           steepest(p), fmt::format("0 to phi_deg, {:g}, where cohesion = 0", p.friction_deg));
  refuse(p.cells < 2, "cells", p.cells, "at least 2");
  if (p.history != WedgeHistory::at_once) {
    const int step = cells_of_a_layer(p) * p.layers;
    refuse(p.layers < 1, "layers", p.layers, "1 or more");
    refuse(p.cells % step != 0, "cells", p.cells,
           fmt::format("multiples of {} (nearest: {}), so that mesh lines lie between layers = {}",
                       step, std::max(1, (p.cells + step / 2) / step) * step, p.layers));
  }
  refuse(p.refinements < 0, "refinements", p.refinements, "at least 0");
  refuse(!(p.refine_share > 0 && p.refine_share <= 1), "refine_share", p.refine_share,
         "above 0, at most 1");
  refuse(!(p.viscous_step >= 0 && p.viscous_step <= 1), "viscous_step", p.viscous_step, "0 to 1");
  refuse(p.steps < 1, "steps", p.steps, "at least 1");
  refuse(p.work < 1, "work", p.work, "at least 1");
}

namespace {

/// Weights of a triangle's corners at a point.
Eigen::Vector3d corner_weights(const fe::TriangleMesh& mesh, int triangle, const Vector2d& point) {
  const auto& t = mesh.triangles[static_cast<std::size_t>(triangle)];
  Eigen::Matrix3d system;
  for (int k = 0; k < 3; ++k)
    system.col(k) << mesh.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])], 1;
  return system.inverse() * Eigen::Vector3d(point[0], point[1], 1);
}

}  // namespace

int WedgeResult::triangle_at(const Vector2d& point) const {
  const int whole = Lattice(problem).triangle_at(point);
  if (whole < 0) return -1;
  const auto& parts_of = pieces[static_cast<std::size_t>(whole)];
  int best = parts_of.front();
  double depth = -std::numeric_limits<double>::infinity();
  for (const int piece : parts_of) {
    if (parts_of.size() == 1) break;
    const double inside = corner_weights(mesh, piece, point).minCoeff();
    if (inside > depth) depth = inside, best = piece;
  }
  return best;
}

namespace {

Eigen::VectorXd interpolated(const WedgeResult& result, const Eigen::MatrixXd& values,
                             const Vector2d& point) {
  const int triangle = result.triangle_at(point);
  if (triangle < 0) return Eigen::VectorXd::Constant(values.cols(), kNan);
  const Eigen::Vector3d weights = corner_weights(result.mesh, triangle, point);
  Eigen::VectorXd out = Eigen::VectorXd::Zero(values.cols());
  for (int k = 0; k < 3; ++k)
    out += weights[k] *
           values
               .row(result.mesh
                        .triangles[static_cast<std::size_t>(triangle)][static_cast<std::size_t>(k)])
               .transpose();
  return out;
}

}  // namespace

Vector4 WedgeResult::stress_at(const Vector2d& point) const {
  return interpolated(*this, stress, point);
}

Vector2d WedgeResult::displacement_at(const Vector2d& point) const {
  return interpolated(*this, displacement, point);
}

double WedgeResult::mobilized_at(const Vector2d& point) const {
  const Vector4 s = stress_at(point);
  if (!s.allFinite()) return kNan;
  const Eigen::Vector3d p = plasticity::principal(s);
  const double phi = problem.friction_deg * kDegree;
  const double cohesion = problem.cohesion * problem.rho_g * problem.height;
  const double borne = 2 * cohesion * std::cos(phi) - (p[0] + p[2]) * std::sin(phi);
  // No point of integration lies beyond the cone's tip; a mean of several may.
  return borne > 0 ? (p[0] - p[2]) / borne : 1;
}

namespace {

/// Errors of the stress by recovery, of every triangle.
void estimate_errors(WedgeResult& r) {
  double all = 0, size = 0;
  r.errors.assign(r.mesh.triangles.size(), 0);
  for (std::size_t t = 0; t < r.mesh.triangles.size(); ++t) {
    for (std::size_t q = 0; q < fe::kPoints; ++q) {
      const fe::PointState& p = r.points[fe::kPoints * t + q];
      const Eigen::Vector3d weights = corner_weights(r.mesh, static_cast<int>(t), p.position);
      Vector4 smooth = Vector4::Zero();
      for (int k = 0; k < 3; ++k)
        smooth +=
            weights[k] * r.stress.row(r.mesh.triangles[t][static_cast<std::size_t>(k)]).transpose();
      r.errors[t] += p.area * (p.stress - smooth).squaredNorm();
      size += p.area * p.stress.squaredNorm();
    }
    all += r.errors[t];
    r.errors[t] = std::sqrt(r.errors[t]);
  }
  r.relative_error = std::sqrt(all / size);
}

WedgeResult solve_on(const WedgeProblem& p, const fe::TriangleMesh& mesh) {
  const Lattice lattice(p);
  WedgeResult out;
  out.problem = p;
  out.mesh = mesh;

  const double scale = p.rho_g * p.height;
  const plasticity::MohrCoulomb material{p.young * scale, p.poisson, p.friction_deg, p.dilation_deg,
                                         p.cohesion * scale};
  const double width = lattice.right[0] - lattice.left[0];
  const double cell_area = width * p.height / 2 / (p.cells * p.cells);
  fe::PlasticSettings settings;
  settings.name = name_of(p);
  settings.revolution = p.cone;
  settings.force_scale = p.rho_g * cell_area;
  if (p.cone) settings.force_scale *= std::numbers::pi * width;  // of the ring half way out
  settings.stress_scale = scale;
  settings.displacement_scale = p.height / p.young;
  settings.tolerance = p.tolerance;
  settings.iterations = p.iterations;
  settings.first_step = 1. / p.steps;
  settings.viscous_step = p.viscous_step;
  settings.work = p.work;
  int stage = 0;
  const int layers = p.history == WedgeHistory::at_once ? 1 : p.layers;
  settings.progress = [&](double reached) {
    tell_progress(settings.name, (stage + reached) / layers);
  };
  fe::Ground ground{p.base_stiffness * p.young * scale / p.height,
                    std::tan(p.base_friction_deg * kDegree)};
  const double slack = kOnBorder * p.height;
  // On the smooth base one node is held against gliding; nothing pulls it.
  const Vector2d held = out.mesh.vertices[static_cast<std::size_t>(lattice.base_corner())];
  const auto on_base = [&](const Vector2d& x) { return x[1] < -p.height + slack; };
  const auto supports = [&](const Vector2d& x) -> fe::Support {
    const bool on_axis = p.cone && x[0] < slack;
    if (!on_base(x)) return {{on_axis, false}, false};
    if (p.base == WedgeBase::rough) return {{true, true}, false};
    if (p.base == WedgeBase::smooth)
      return {{on_axis || (!p.cone && (x - held).norm() < slack), true}, false};
    return {{on_axis, false}, true};
  };
  fe::PlasticSolver solver(
      out.mesh,
      [&](const Vector2d& x) {
        plasticity::MohrCoulomb here = material;
        if (p.elasticity) {
          const Vector2d constants = p.elasticity(x);
          here.E = constants[0];
          here.nu = constants[1];
        }
        return here;
      },
      supports, ground, settings);

  const std::size_t triangles = out.mesh.triangles.size();
  std::vector<int> layer(triangles, 0);
  for (std::size_t c = 0; c < triangles; ++c) {
    Vector2d centre = Vector2d::Zero();
    for (const int corner : out.mesh.triangles[c])
      centre += out.mesh.vertices[static_cast<std::size_t>(corner)] / 3;
    if (layers > 1) layer[c] = layer_of(p, lattice, centre);
  }
  std::vector<Vector2d> gravity(triangles, Vector2d::Zero());
  try {
    for (; stage < layers; ++stage) {
      std::vector<bool> active(triangles);
      for (std::size_t c = 0; c < triangles; ++c) {
        active[c] = layer[c] <= stage;
        if (layer[c] == stage) gravity[c] = {0, -p.rho_g};
      }
      solver.activate(active);
      solver.load(gravity);
    }
  } catch (const ComputationFailed& failure) {
    throw ComputationFailed(fmt::format("{}; {}", failure.what(), advice(p)));
  }
  out.stress = solver.corner_stress();
  out.displacement = solver.corner_displacement();
  out.points = solver.points();
  out.steps = solver.steps();
  out.weight = p.rho_g * p.height * (p.cone ? std::numbers::pi * width * width / 3 : width / 2);
  out.base_force = solver.reaction(on_base);
  out.unknowns = solver.unknowns();
  estimate_errors(out);
  return out;
}

}  // namespace

WedgeResult solve_wedge(const WedgeProblem& p) {
  check_wedge(p);
  auto mesh = Lattice(p).mesh();
  const std::size_t whole = mesh.triangles.size();
  std::vector<int> lattice_cell(whole);
  std::iota(lattice_cell.begin(), lattice_cell.end(), 0);
  for (int cycle = 0;; ++cycle) {
    WedgeResult out = solve_on(p, mesh);
    if (cycle == p.refinements) {
      out.pieces.resize(whole);
      for (std::size_t t = 0; t < lattice_cell.size(); ++t)
        out.pieces[static_cast<std::size_t>(lattice_cell[t])].push_back(static_cast<int>(t));
      return out;
    }
    std::vector<int> parent;
    const auto before = static_cast<double>(mesh.triangles.size());
    mesh = fe::refined(mesh, fe::largest_errors(out.errors, p.refine_share), parent);
    require_unknowns(name_of(p), out.unknowns * static_cast<double>(mesh.triangles.size()) / before,
                     p.most_unknowns, "refinements");
    std::vector<int> cell(parent.size());
    for (std::size_t t = 0; t < parent.size(); ++t)
      cell[t] = lattice_cell[static_cast<std::size_t>(parent[t])];
    lattice_cell = std::move(cell);
  }
}

WedgeCore wedge_core(const WedgeResult& result, double mobilized) {
  const WedgeProblem& p = result.problem;
  WedgeCore core;
  for (int k = 0; k < kCoreDepths; ++k) {
    const double depth = p.height * (kCoreFrom + (kCoreTo - kCoreFrom) * k / (kCoreDepths - 1.));
    core.depth.push_back(depth);
    for (const double side : {-1., 1.}) {
      if (p.cone && side < 0) {
        core.left.push_back(kNan);
        continue;
      }
      const double slope = side < 0 ? p.left_deg : p.right_deg;
      const double outside = depth / std::tan(slope * kDegree);
      const auto plastic = [&](int s) {
        return result.mobilized_at({side * outside * s / kCoreSamples, -depth}) >= mobilized;
      };
      // Without a plastic flank there is no border.
      double x = kNan;
      const int first = static_cast<int>((1 - kCoreSkin) * kCoreSamples);
      if (plastic(first)) {
        for (int s = first - 1; s >= 0 && std::isnan(x); --s)
          if (!plastic(s)) x = outside * s / kCoreSamples;
      }
      (side < 0 ? core.left : core.right).push_back(side * x);
    }
    core.axis_mobilized += result.mobilized_at({0, -depth}) / kCoreDepths;
  }
  const auto median = [](std::vector<double> values) {
    if (values.empty()) return kNan;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  };
  const auto fit = [&](const std::vector<double>& x, double& degrees, double& misfit) {
    std::vector<double> tangents, apart;
    for (std::size_t k = 0; k < x.size(); ++k) {
      if (std::isnan(x[k])) continue;
      tangents.push_back(std::abs(x[k]) / core.depth[k]);
      core.share += (p.cone ? 1 : 0.5) / static_cast<double>(x.size());
    }
    const bool enough =
        static_cast<double>(tangents.size()) >= kCoreLeast * static_cast<double>(x.size());
    const double tangent = enough ? median(tangents) : kNan;
    if (enough)
      for (const double t : tangents) apart.push_back(std::abs(t - tangent));
    degrees = std::atan(tangent) / kDegree;
    misfit = median(apart);
  };
  fit(core.left, core.left_deg, core.left_misfit);
  fit(core.right, core.right_deg, core.right_misfit);
  return core;
}

}  // namespace grainfield::continuum
