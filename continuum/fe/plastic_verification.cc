#include "continuum/fe/plastic_verification.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "continuum/constants.h"

namespace grainfield::continuum {
namespace {

using Eigen::Vector2d;

/// From 0 to `end` in steps of 1/m, longer by `growth` per length beyond `even`.
std::vector<double> lines(double end, double even, double growth, int m) {
  std::vector<double> out{0};
  while (out.back() < end * (1 - 1e-9))
    out.push_back(out.back() + (1 + growth * std::max(0., out.back() - even + 1e-9)) / m);
  const double last = out.back();
  // The even part, in which the strip ends, stays where it is.
  for (double& x : out)
    if (x > even) x = even + (x - even) * (end - even) / (last - even);
  return out;
}

/// Rectangles between the lines x and -y, each cut into four triangles by its diagonals.
fe::TriangleMesh crossed(const std::vector<double>& x, const std::vector<double>& y) {
  fe::TriangleMesh out;
  const int nx = static_cast<int>(x.size()) - 1, ny = static_cast<int>(y.size()) - 1;
  const auto corner = [nx](int i, int j) { return j * (nx + 1) + i; };
  const auto at = [&](int i, int j) {
    return Vector2d(x[static_cast<std::size_t>(i)], -y[static_cast<std::size_t>(ny - j)]);
  };
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) out.vertices.push_back(at(i, j));
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const int middle = static_cast<int>(out.vertices.size());
      out.vertices.push_back((at(i, j) + at(i + 1, j + 1)) / 2);
      const std::array<int, 4> around{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1),
                                      corner(i, j + 1)};
      for (std::size_t k = 0; k < 4; ++k)
        out.triangles.push_back({around[k], around[(k + 1) % 4], middle});
    }
  }
  return out;
}

}  // namespace

FlankCheck check_infinite_slope(const InfiniteSlope& slope) {
  const double phi = slope.phi_deg * kDegree, young = 1000, nu = 0.3;
  const double t = std::tan(slope.slope_deg * kDegree), cells = slope.cells;
  const plasticity::MohrCoulomb material{young, nu, slope.phi_deg, slope.dilation_deg, 0};
  // Stress is (sxx, syy, sxy) times y + t x.
  const double ratio = std::cos(phi) / std::cos(slope.slope_deg * kDegree);
  const double root = std::sqrt(std::max(0., 1 - ratio * ratio));
  const double active = std::cos(phi) / (1 + root), passive = std::cos(phi) / (1 - root);
  const double sxx = std::pow(active, 2 - 2 * slope.share) * std::pow(passive, 2 * slope.share);
  const double syy = 1 + t * t * sxx, sxy = -t * sxx;
  const auto stress = [&](const Vector2d& p) {
    const double d = p[1] + t * p[0];
    return plasticity::Vector4(sxx * d, syy * d, nu * (sxx + syy) * d, sxy * d);
  };
  // Its strain likewise, out-of-plane strain none.
  const double exx = (1 + nu) / young * ((1 - nu) * sxx - nu * syy);
  const double eyy = (1 + nu) / young * ((1 - nu) * syy - nu * sxx);
  const double gxy = 2 * (1 + nu) / young * sxy;
  // Flow: (1 + sin psi) along the least compressive direction, -(1 - sin psi) along the other.
  const double angle = std::atan2(2 * sxy, sxx - syy) / 2;  // of the larger of (sxx, syy, sxy)
  const double psi = std::sin(slope.dilation_deg * kDegree);
  const Vector2d most(std::cos(angle), std::sin(angle)), least(-most[1], most[0]);
  const bool limit = slope.share == 0 || slope.share == 1;
  const Eigen::Matrix2d flow =
      (limit ? slope.shear : 0) / 2 *
      ((1 + psi) * least * least.transpose() - (1 - psi) * most * most.transpose());
  const auto displacement = [&](const Vector2d& p) -> Vector2d {
    const double x = p[0], y = p[1];
    const Vector2d elastic(exx * (x * y + t * x * x / 2) + (gxy - t * eyy) * y * y / 2,
                           eyy * (y * y / 2 + t * x * y) + (gxy * t - exx) * x * x / 2);
    return elastic + flow * p;
  };
  const Vector2d apex(0.5, -0.5 * t), left(0.2, -1.5), right(1, -1.2 - t * 0.1);
  fe::PlasticSettings settings;
  settings.name = "plastic flank";
  settings.force_scale = 1. / (cells * cells);
  settings.tolerance = 1e-11;
  const auto mesh = fe::triangle_lattice(left, right, apex, slope.cells);
  fe::PlasticSolver solver(
      mesh, [&](const Vector2d&) { return material; },
      [](const Vector2d&) {
        return fe::Support{{true, true}, false};
      },
      {}, settings);
  solver.load(std::vector<Vector2d>(mesh.triangles.size(), Vector2d(0, -1)), displacement);

  FlankCheck out;
  const double scale = syy * 1.5;
  for (const auto& p : solver.points()) {
    out.stress_error =
        std::max(out.stress_error, (p.stress - stress(p.position)).cwiseAbs().maxCoeff() / scale);
    out.plastic_share += p.regime != plasticity::Regime::elastic;
  }
  out.plastic_share /= static_cast<double>(solver.points().size());
  const Eigen::MatrixXd corners = solver.corner_stress();
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    out.corner_error =
        std::max(out.corner_error,
                 (corners.row(static_cast<Eigen::Index>(i)).transpose() - stress(mesh.vertices[i]))
                         .cwiseAbs()
                         .maxCoeff() /
                     scale);
  out.steps = solver.steps();
  return out;
}

FlankCheck check_plastic_flank(double phi_deg, double dilation_deg, double shear, int cells) {
  InfiniteSlope slope;
  slope.phi_deg = slope.slope_deg = phi_deg;
  slope.dilation_deg = dilation_deg;
  slope.shear = shear;
  slope.cells = cells;
  return check_infinite_slope(slope);
}

double prandtl_n_q(double phi_deg) {
  const double tangent = std::tan((45 + phi_deg / 2) * kDegree);
  return std::exp(std::numbers::pi * std::tan(phi_deg * kDegree)) * tangent * tangent;
}

double prandtl_n_c(double phi_deg) {
  if (phi_deg == 0) return 2 + std::numbers::pi;
  return (prandtl_n_q(phi_deg) - 1) / std::tan(phi_deg * kDegree);
}

FootingCheck check_strip_footing(const Footing& footing) {
  // Half of it. The strip's half width, the cohesion and the surcharge are 1. Prandtl's failing
  // ground reaches 2 tan(45 + phi/2) exp(pi/2 tan phi) beyond the strip; without friction 3 far
  // from the middle and 1.4 deep.
  constexpr int load_steps = 10;
  constexpr double slack = 1e-9, far = 5. / 3, deep = 1.42, even = 2;
  const double phi = footing.phi_deg * kDegree, t = std::tan(phi);
  const double wedge = 45 * kDegree + phi / 2;
  const double reach = 1 + 2 * std::tan(wedge) * std::exp(std::numbers::pi / 2 * t);
  const double depth = std::exp(wedge * t) / std::cos(wedge);
  const double width = far * reach, bottom = deep * depth, growth = 0.5 * t;
  const double pressure =
      footing.surcharge ? prandtl_n_q(footing.phi_deg) : prandtl_n_c(footing.phi_deg);
  const plasticity::MohrCoulomb material{40 * pressure, 0.3, footing.phi_deg, footing.dilation_deg,
                                         footing.surcharge ? 0. : 1.};
  const auto mesh = crossed(lines(width, even, growth, footing.cells),
                            lines(bottom, std::min(even, bottom), growth, footing.cells));
  const auto strip = [](const Vector2d& p) { return p[1] > -slack && p[0] < 1 + slack; };
  const auto supports = [&](const Vector2d& p) -> fe::Support {
    if (strip(p) || p[1] < -bottom + slack) return {{true, true}, false};
    return {{p[0] < slack || p[0] > width - slack, false}, false};
  };
  fe::PlasticSettings settings;
  settings.name = "strip footing";
  settings.force_scale = 1. / footing.cells;
  fe::PlasticSolver solver(
      mesh, [&](const Vector2d&) { return material; }, supports, {}, settings);
  const std::vector<Vector2d> weightless(mesh.triangles.size(), Vector2d::Zero());
  FootingCheck out;
  out.unknowns = solver.unknowns();
  if (footing.surcharge) {
    // The strip goes down with the ground beside it, confined as it is: uniform stress, which
    // bears the surcharge elastically where nu/(1 - nu) is above the active pressure, else yields.
    const double modulus =
        material.E * (1 - material.nu) / ((1 + material.nu) * (1 - 2 * material.nu));
    solver.load(
        weightless,
        [&](const Vector2d& p) { return Vector2d(0, strip(p) ? -bottom / modulus : 0); },
        [&](const Vector2d& p) { return Vector2d(0, p[1] > -slack && p[0] > 1 ? -1 : 0); });
  }
  for (int k = 1; k <= load_steps; ++k) {
    solver.load(weightless, [&](const Vector2d& p) {
      return Vector2d(0, strip(p) ? -footing.settlement / load_steps : 0);
    });
    out.settlement.push_back(footing.settlement * k / load_steps);
    out.pressure.push_back(-solver.reaction(strip)[1]);
  }
  out.capacity = out.pressure.back();
  out.last_rise = 1 - out.pressure[load_steps - 1 - load_steps / 10] / out.capacity;
  out.steps = solver.steps();
  return out;
}

CylinderCheck check_cylinder(const Cylinder& cylinder) {
  constexpr double inside = 1, outside = 2, slack = 1e-9, young = 1000, poisson = 0.3;
  const double sine = std::sin(cylinder.phi_deg * kDegree);
  const double N = (1 + sine) / (1 - sine);
  const double s = 2 * std::cos(cylinder.phi_deg * kDegree) / (1 - sine);
  const double end = std::max(cylinder.yields, inside), square = outside * outside;
  double A = s / (N * (1 + square / (end * end)) - 1 + square / (end * end));
  if (cylinder.yields <= inside) A /= 2;
  const double at_end = A * (1 - square / (end * end));
  const auto radial = [&](double r) {
    if (r >= end) return A * (1 - square / (r * r));
    if (sine == 0) return at_end - s * std::log(end / r);
    const double constant = s / (N - 1);
    return constant + (at_end - constant) * std::pow(r / end, 1 / N - 1);
  };
  const auto hoop = [&](double r) {
    return r >= end ? A * (1 + square / (r * r)) : (s + radial(r)) / N;
  };

  std::vector<double> x;
  for (int k = 0; k <= cylinder.cells; ++k) {
    x.push_back(inside + (outside - inside) * k / cylinder.cells);
  }
  const double height = (outside - inside) / cylinder.cells;
  const auto mesh = crossed(x, {0, height});
  fe::PlasticSettings settings;
  settings.name = "cylinder";
  settings.revolution = true;
  settings.force_scale = height;
  settings.first_step = 0.25;
  const plasticity::MohrCoulomb material{young, poisson, cylinder.phi_deg, cylinder.dilation_deg,
                                         1};
  fe::PlasticSolver solver(
      mesh, [&](const Vector2d&) { return material; },
      [&](const Vector2d& p) -> fe::Support {
        return {{false, p[1] > -slack || p[1] < -height + slack}, false};
      },
      {}, settings);
  CylinderCheck out;
  out.pressure = -radial(inside);
  solver.load(
      std::vector<Vector2d>(mesh.triangles.size(), Vector2d::Zero()), {},
      [&](const Vector2d& p) { return Vector2d(p[0] < inside + slack ? out.pressure : 0, 0); });
  double error = 0, size = 0, yielded = 0;
  for (const auto& p : solver.points()) {
    const double r = p.position[0];
    const Vector2d exact(radial(r), hoop(r)), found(p.stress[0], p.stress[2]);
    error += p.area * (found - exact).squaredNorm();
    size += p.area * exact.squaredNorm();
    yielded += p.area * (p.regime != plasticity::Regime::elastic);
  }
  out.stress_error = std::sqrt(error / size);
  const double volume = std::numbers::pi * height;
  out.yielded_error =
      yielded / (volume * (square - inside)) - (end * end - inside) / (square - inside);
  out.steps = solver.steps();
  return out;
}

double check_column(int cells) {
  constexpr double slack = 1e-9, poisson = 0.3;
  std::vector<double> lines;
  for (int k = 0; k <= cells; ++k) lines.push_back(static_cast<double>(k) / cells);
  const auto mesh = crossed(lines, lines);
  fe::PlasticSettings settings;
  settings.name = "column";
  settings.revolution = true;
  settings.force_scale = 1. / (cells * cells);
  const plasticity::MohrCoulomb material{1000, poisson, 30, 0, 100};
  fe::PlasticSolver solver(
      mesh, [&](const Vector2d&) { return material; },
      [&](const Vector2d& p) -> fe::Support {
        return {{p[0] < slack || p[0] > 1 - slack, p[1] < -1 + slack}, false};
      },
      {}, settings);
  solver.load(std::vector<Vector2d>(mesh.triangles.size(), Vector2d(0, -1)));
  double error = 0, size = 0;
  for (const auto& p : solver.points()) {
    const double vertical = p.position[1], side = poisson / (1 - poisson) * vertical;
    const plasticity::Vector4 exact(side, vertical, side, 0);
    error += p.area * (p.stress - exact).squaredNorm();
    size += p.area * exact.squaredNorm();
  }
  return std::sqrt(error / size);
}

}  // namespace grainfield::continuum
