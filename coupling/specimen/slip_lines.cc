#include "coupling/specimen/slip_lines.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "continuum/constants.h"

namespace grainfield::coupling {
namespace {

using Eigen::Vector2d;
/// Most steps of a line in one direction.
constexpr int kMostSteps = 2000;
/// A line ends where it comes nearer to another of its family than this part of their distance.
constexpr double kNear = 0.4;

/// Direction of the family's line; none: not at the limit.
std::optional<Vector2d> direction(const PlaneStress& stress, const SlipLines& how, double side,
                                  const Vector2d& at) {
  const Eigen::MatrixXd s = stress(at.transpose());
  const double xx = s(0, 0), yy = s(0, 1), xy = s(0, 2);
  if (!(mobilized_friction(xx, yy, xy, how.phi_deg) >= how.mobilized)) return std::nullopt;
  // The larger principal stress stands at this angle, the larger compression across it.
  const double tension = std::atan2(2 * xy, xx - yy) / 2;
  const double angle = tension + 90 * kDegree + side * (45 * kDegree - how.phi_deg * kDegree / 2);
  return Vector2d(std::cos(angle), std::sin(angle));
}

bool near(const std::vector<Eigen::MatrixXd>& lines, const Vector2d& at, double distance) {
  for (const auto& line : lines)
    if ((line.rowwise() - at.transpose()).rowwise().squaredNorm().minCoeff() < distance * distance)
      return true;
  return false;
}

}  // namespace

double mobilized_friction(double xx, double yy, double xy, double phi_deg) {
  const double sum = xx + yy, difference = std::hypot(xx - yy, 2 * xy);
  if (!(sum < 0)) return kNan;
  return difference / (-sum * std::sin(phi_deg * kDegree));
}

std::vector<Eigen::MatrixXd> slip_lines(const PlaneStress& stress, const Eigen::MatrixXd& seeds,
                                        const SlipLines& how) {
  std::vector<Eigen::MatrixXd> all;
  for (const double side : {-1., 1.}) {
    std::vector<Eigen::MatrixXd> family;
    for (Eigen::Index k = 0; k < seeds.rows(); ++k) {
      const Vector2d seed = seeds.row(k).transpose();
      const auto first = direction(stress, how, side, seed);
      if (!first || near(family, seed, how.apart)) continue;
      std::vector<Vector2d> ways[2];
      for (const int way : {0, 1}) {
        Vector2d at = seed, before = way == 0 ? *first : Vector2d(-*first);
        for (int n = 0; n < kMostSteps; ++n) {
          const auto ahead = [&](const Vector2d& p) -> std::optional<Vector2d> {
            auto d = direction(stress, how, side, p);
            if (d && d->dot(before) < 0) *d = -*d;
            return d;
          };
          const auto start = ahead(at);
          if (!start) break;
          const auto middle = ahead(at + how.step / 2 * *start);
          if (!middle) break;
          at += how.step * *middle;
          if (near(family, at, kNear * how.apart)) break;
          before = *middle;
          ways[way].push_back(at);
        }
      }
      Eigen::MatrixXd line(ways[0].size() + ways[1].size() + 1, 2);
      Eigen::Index row = 0;
      for (auto p = ways[1].rbegin(); p != ways[1].rend(); ++p) line.row(row++) = p->transpose();
      line.row(row++) = seed.transpose();
      for (const auto& p : ways[0]) line.row(row++) = p.transpose();
      if (line.rows() > 1) family.push_back(std::move(line));
    }
    all.insert(all.end(), family.begin(), family.end());
  }
  return all;
}

}  // namespace grainfield::coupling
