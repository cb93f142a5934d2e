#include "continuum/fe/plastic_verification.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grainfield::continuum {
namespace {

using Eigen::Vector2d;
constexpr double kDegree = std::numbers::pi / 180;

/// Squares of edge 1/m over width x depth below y = 0, each cut into four triangles by its
/// diagonals.
fe::TriangleMesh crossed_squares(int width, int depth, int m) {
  fe::TriangleMesh out;
  const int nx = width * m, ny = depth * m;
  const auto corner = [nx](int i, int j) { return j * (nx + 1) + i; };
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i)
      out.vertices.emplace_back(static_cast<double>(i) / m, static_cast<double>(j - ny) / m);
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const int middle = static_cast<int>(out.vertices.size());
      out.vertices.emplace_back((i + 0.5) / m, (j - ny + 0.5) / m);
      const std::array<int, 4> around{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1),
                                      corner(i, j + 1)};
      for (std::size_t k = 0; k < 4; ++k)
        out.triangles.push_back({around[k], around[(k + 1) % 4], middle});
    }
  }
  return out;
}

}  // namespace

FlankCheck check_plastic_flank(double phi_deg, double dilation_deg, double shear, int cells) {
  const double phi = phi_deg * kDegree, t = std::tan(phi), young = 1000, nu = 0.3;
  const double sb = std::cos(phi), cb = std::sin(phi);  // of b
  const plasticity::MohrCoulomb material{young, nu, phi_deg, dilation_deg, 0};
  // Stress is (sxx, syy, sxy) times y + t x.
  const double sxx = sb * sb, syy = 1 + cb * cb, sxy = -sb * cb;
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
  const double psi = std::sin(dilation_deg * kDegree);
  const Vector2d most(std::cos(angle), std::sin(angle)), least(-most[1], most[0]);
  const Eigen::Matrix2d flow =
      shear / 2 * ((1 + psi) * least * least.transpose() - (1 - psi) * most * most.transpose());
  const auto displacement = [&](const Vector2d& p) -> Vector2d {
    const double x = p[0], y = p[1];
    const Vector2d elastic(exx * (x * y + t * x * x / 2) + (gxy - t * eyy) * y * y / 2,
                           eyy * (y * y / 2 + t * x * y) + (gxy * t - exx) * x * x / 2);
    return elastic + flow * p;
  };
  const Vector2d apex(0.5, -0.5 * t), left(0.2, -1.5), right(1, -1.2);
  fe::PlasticSettings settings;
  settings.name = "plastic flank";
  settings.force_scale = 1. / (cells * cells);
  settings.tolerance = 1e-11;
  const auto mesh = fe::triangle_lattice(left, right, apex, cells);
  fe::PlasticSolver solver(
      mesh, material,
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

FootingCheck check_strip_footing(double phi_deg, double dilation_deg, int cells,
                                 double settlement) {
  // Half of it, the strip's half width and the cohesion are 1. The failing ground reaches 3 far and
  // 1.4 deep without friction.
  constexpr int width = 5, depth = 2, load_steps = 10;
  const plasticity::MohrCoulomb material{200, 0.3, phi_deg, dilation_deg, 1};
  const auto mesh = crossed_squares(width, depth, cells);
  constexpr double slack = 1e-9;
  const auto strip = [](const Vector2d& p) { return p[1] > -slack && p[0] < 1 + slack; };
  const auto supports = [&](const Vector2d& p) -> fe::Support {
    if (strip(p) || p[1] < -depth + slack) return {{true, true}, false};
    return {{p[0] < slack || p[0] > width - slack, false}, false};
  };
  fe::PlasticSettings settings;
  settings.name = "strip footing";
  settings.force_scale = 1. / cells;
  fe::PlasticSolver solver(mesh, material, supports, {}, settings);
  const std::vector<Vector2d> weightless(mesh.triangles.size(), Vector2d::Zero());
  FootingCheck out;
  for (int k = 1; k <= load_steps; ++k) {
    solver.load(weightless, [&](const Vector2d& p) {
      return Vector2d(0, strip(p) ? -settlement / load_steps : 0);
    });
    out.settlement.push_back(settlement * k / load_steps);
    out.pressure.push_back(-solver.reaction(strip)[1]);
  }
  out.capacity = out.pressure.back();
  out.last_rise = 1 - out.pressure[load_steps - 1 - load_steps / 10] / out.capacity;
  out.steps = solver.steps();
  return out;
}

}  // namespace grainfield::continuum
