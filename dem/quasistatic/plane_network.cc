#include "dem/quasistatic/plane_network.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "dem/neighbours/hierarchical_grid.h"
#include "dem/shapes/polygon.h"

namespace grainfield::dem {
namespace {

// Gap up to which grains that do not touch are watched, as a share of the mean radius. The list is
// made anew when a grain has moved by half of it.
constexpr double kSkinShare = 0.2;

}  // namespace

PlaneNetwork::PlaneNetwork(const Snapshot& start, const Materials& materials)
    : ContactNetwork(2), law_(materials.law), friction_(materials.friction), walls_(start.walls) {
  std::visit(
      [this]<class Law>(const Law& l) {
        if constexpr (ContactLaw<Law, 2>) {
          measures_ = Law::measures;
          stiffness_ = l.stiffness();
          tangential_stiffness_ = l.tangential_stiffness();
        } else {
          throw std::invalid_argument(
              fmt::format("material.law: found {}, allowed for quasi-static relaxation: {}",
                          Law::name, fmt::join(laws_in<2>(), ", ")));
        }
      },
      law_);
  const std::size_t n = start.grains.size();
  shapes_.resize(n);
  origin_.resize(n);
  committed_.assign(n, {0, 0, 0});
  load_.assign(n, {0, 0});
  double sum = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const Grain& g = start.grains[k];
    shapes_[k] = {g.radius, g.mass, g.fixed ? -1 : 3 * free_, equal_radius(g.volume), g.outline};
    if (!g.fixed) ++free_;
    origin_[k] = {g.position.x(), g.position.y(), g.angle};
    sum += g.radius;
  }
  skin_ = kSkinShare * sum / static_cast<double>(std::max<std::size_t>(n, 1));
  for (const Contact& c : start.contacts) {
    Pair pair;
    pair.i = static_cast<int>(c.i);
    pair.j = static_cast<int>(c.j);
    pair.spring = c.spring;
    pairs_.push_back(pair);
  }
  std::sort(pairs_.begin(), pairs_.end(),
            [](const Pair& a, const Pair& b) { return a.i != b.i ? a.i < b.i : a.j < b.j; });
  const Vector zero = Vector::Zero(size());
  search(zero);
  commit(zero);
}

void PlaneNetwork::set_load(const Vec3& gravity, const std::vector<Load>& loads) {
  for (std::size_t k = 0; k < shapes_.size(); ++k) {
    load_[k] = {shapes_[k].mass * gravity.x(), shapes_[k].mass * gravity.y()};
  }
  for (const Load& load : loads) {
    for (const std::int64_t grain : load.grains) {
      load_[grain][0] += load.force.x();
      load_[grain][1] += load.force.y();
    }
  }
}

double PlaneNetwork::displacement(int grain, int axis, const Vector& z) const {
  const Shape& s = shapes_[grain];
  double before = committed_[grain][axis];
  if (strains() && axis < 2) {
    const auto& start = origin_[grain];
    const auto& moved = committed_[grain];
    before +=
        gradient_(axis, 0) * (start[0] + moved[0]) + gradient_(axis, 1) * (start[1] + moved[1]);
  }
  return s.unknown < 0 ? before : before + (axis < 2 ? s.radius : 1.0) * z[s.unknown + axis];
}

/// Differences of displacements are taken before the (large) coordinates come in, so that an
/// overlap keeps its last digits far from the origin.
PlaneNetwork::Place PlaneNetwork::place(const Pair& pair, const Vector& z) const {
  Place p;
  const int i = pair.i;
  const double xi = displacement(i, 0, z), yi = displacement(i, 1, z);
  p.angle_i = origin_[i][2] + displacement(i, 2, z);
  p.ux = xi - committed_[i][0];
  p.uy = yi - committed_[i][1];
  p.turn_i = displacement(i, 2, z) - committed_[i][2];
  if (pair.j < 0) {
    const Wall& wall = walls_[-1 - pair.j];
    p.dx = (wall.point.x() - origin_[i][0]) - xi;
    p.dy = (wall.point.y() - origin_[i][1]) - yi;
    return p;
  }
  const int j = pair.j;
  const double xj = displacement(j, 0, z), yj = displacement(j, 1, z);
  p.dx = (origin_[j][0] - origin_[i][0]) + (xj - xi);
  p.dy = (origin_[j][1] - origin_[i][1]) + (yj - yi);
  p.angle_j = origin_[j][2] + displacement(j, 2, z);
  p.ux -= xj - committed_[j][0];
  p.uy -= yj - committed_[j][1];
  p.turn_j = displacement(j, 2, z) - committed_[j][2];
  return p;
}

bool PlaneNetwork::residual(const Vector& z, Vector& r) {
  if (!within_reach(z)) return false;
  ensure_candidates(z);
  r.setZero(size());
  for (std::size_t k = 0; k < shapes_.size(); ++k) {
    if (shapes_[k].unknown < 0) continue;
    r[shapes_[k].unknown] = load_[k][0];
    r[shapes_[k].unknown + 1] = load_[k][1];
  }
  for (const Pair& pair : pairs_) {
    Geometry g;
    if (!geometry(pair, place(pair, z), g)) continue;
    const Force f = force(pair, g);
    const Shape& a = shapes_[pair.i];
    if (a.unknown >= 0) {
      r[a.unknown] += f.fx;
      r[a.unknown + 1] += f.fy;
      r[a.unknown + 2] += f.torque_i / a.radius;
    }
    if (pair.j < 0 || shapes_[pair.j].unknown < 0) continue;
    const Shape& b = shapes_[pair.j];
    r[b.unknown] -= f.fx;
    r[b.unknown + 1] -= f.fy;
    r[b.unknown + 2] += f.torque_j / b.radius;
  }
  r /= scale_;
  return r.allFinite();
}

void PlaneNetwork::tangent(const Vector& z, const Vector& r, const Vector& drag, Matrix& matrix) {
  ensure_candidates(z);
  triplets_.clear();
  for (const Shape& s : shapes_) {
    if (s.unknown < 0) continue;
    const double loose =
        kFloor * stiffness_ * s.radius / scale_ + r.segment<3>(s.unknown).cwiseAbs().maxCoeff();
    for (int a = 0; a < 3; ++a) {
      triplets_.emplace_back(s.unknown + a, s.unknown + a, -loose - drag[s.unknown + a]);
    }
  }
  for (const Pair& pair : pairs_) {
    Slopes d;
    if (!slopes(pair, place(pair, z), d)) continue;
    // Six coordinates: x_i, y_i, angle_i, x_j, y_j, angle_j; the same order of forces.
    const Shape& a = shapes_[pair.i];
    const int ui = a.unknown, uj = pair.j < 0 ? -1 : shapes_[pair.j].unknown;
    const double ri = a.radius, rj = pair.j < 0 ? 1.0 : shapes_[pair.j].radius;
    for (int row = 0; row < 6; ++row) {
      const int grow = row < 3 ? ui : uj;
      if (grow < 0) continue;
      const int axis = row % 3;
      const double sign = row >= 3 && axis < 2 ? -1.0 : 1.0;
      const int source = axis < 2 ? axis : row == 2 ? 2 : 3;
      const double row_scale = sign / (axis < 2 ? 1.0 : row < 3 ? ri : rj) / scale_;
      for (int column = 0; column < 6; ++column) {
        const int gcol = column < 3 ? ui : uj;
        if (gcol < 0) continue;
        const int by = column % 3;
        const double value = by < 2 ? (column < 3 ? -d(source, by) * ri : d(source, by) * rj)
                                    : d(source, column == 2 ? 2 : 3);
        triplets_.emplace_back(grow + axis, gcol + by, row_scale * value);
      }
    }
  }
  matrix.resize(size(), size());
  matrix.setFromTriplets(triplets_.begin(), triplets_.end());
}

std::vector<ContactNetwork::ForceChange> PlaneNetwork::force_changes(const Vector& z) const {
  const Vector zero = Vector::Zero(size());
  std::vector<ForceChange> out;
  for (const Pair& pair : pairs_) {
    const int ui = shapes_[pair.i].unknown, uj = pair.j < 0 ? -1 : shapes_[pair.j].unknown;
    Slopes d;
    if ((ui < 0 && uj < 0) || !slopes(pair, place(pair, zero), d)) continue;
    Eigen::Vector4d moved = Eigen::Vector4d::Zero();
    if (ui >= 0) {
      moved.head<2>() -= shapes_[pair.i].radius * z.segment<2>(ui);
      moved[2] = z[ui + 2];
    }
    if (uj >= 0) {
      moved.head<2>() += shapes_[pair.j].radius * z.segment<2>(uj);
      moved[3] = z[uj + 2];
    }
    const Eigen::Vector2d force = d.topRows<2>() * moved;
    out.push_back({pair.i, pair.j, {0, 0, 0}, Vec3(force.x(), force.y(), 0)});
  }
  return out;
}

PlaneNetwork::Vector PlaneNetwork::drag_unit() const {
  Vector unit(size());
  for (const Shape& s : shapes_) {
    if (s.unknown >= 0) unit.segment<3>(s.unknown).setConstant(stiffness_ * s.radius / scale_);
  }
  return unit;
}

void PlaneNetwork::commit(const Vector& z) {
  ensure_candidates(z);
  for (Pair& pair : pairs_) {
    Geometry g;
    if (!geometry(pair, place(pair, z), g)) {
      pair.touched = false;
      pair.spring = 0;
      continue;
    }
    pair.spring = force(pair, g).tangential;
    pair.touched = true;
    pair.nx = g.nx;
    pair.ny = g.ny;
    pair.lever_i = g.lever_i;
    pair.lever_j = g.lever_j;
  }
  for (std::size_t k = 0; k < shapes_.size(); ++k) {
    const int grain = static_cast<int>(k);
    committed_[k] = {displacement(grain, 0, z), displacement(grain, 1, z),
                     displacement(grain, 2, z)};
  }
  gradient_.setZero();
}

void PlaneNetwork::ensure_candidates(const Vector& z) {
  const double limit = 0.25 * skin_ * skin_;
  for (std::size_t k = 0; k < shapes_.size(); ++k) {
    const int grain = static_cast<int>(k);
    const double dx = displacement(grain, 0, z) - searched_[k][0];
    const double dy = displacement(grain, 1, z) - searched_[k][1];
    if (dx * dx + dy * dy > limit) {
      search(z);
      return;
    }
  }
}

/// Pairs within reach of where z puts the grains, with what the old ones remember; and those that
/// touched in the committed state, wherever z puts them: a step that is taken back finds their
/// springs again.
void PlaneNetwork::search(const Vector& z) {
  const int n = static_cast<int>(shapes_.size());
  std::vector<Reach<2>> reaches(n);
  searched_.resize(n);
  for (int k = 0; k < n; ++k) {
    searched_[k] = {displacement(k, 0, z), displacement(k, 1, z)};
    reaches[k] = {{origin_[k][0] + searched_[k][0], origin_[k][1] + searched_[k][1]},
                  shapes_[k].radius + 0.5 * skin_,
                  shapes_[k].unknown < 0};
  }
  std::vector<std::pair<int, int>> found, all;
  HierarchicalGrid<2> grid;
  grid.build(reaches);
  grid.pairs(found);
  std::size_t next = 0;
  for (int i = 0; i < n; ++i) {
    for (int w = static_cast<int>(walls_.size()) - 1; w >= 0 && shapes_[i].unknown >= 0; --w) {
      const Wall& wall = walls_[w];
      const double height = (reaches[i].centre.x() - wall.point.x()) * wall.normal.x() +
                            (reaches[i].centre.y() - wall.point.y()) * wall.normal.y();
      if (height < shapes_[i].radius + skin_) all.emplace_back(i, -1 - w);
    }
    for (; next < found.size() && found[next].first == i; ++next) all.push_back(found[next]);
  }
  std::vector<std::pair<int, int>> touching, wanted;
  for (const Pair& pair : pairs_) {
    if (pair.touched) touching.emplace_back(pair.i, pair.j);
  }
  std::set_union(all.begin(), all.end(), touching.begin(), touching.end(),
                 std::back_inserter(wanted));
  std::vector<Pair> pairs;
  pairs.reserve(wanted.size());
  auto old = pairs_.begin();
  for (const auto& [i, j] : wanted) {
    while (old != pairs_.end() && (old->i != i ? old->i < i : old->j < j)) ++old;
    Pair pair;
    if (old != pairs_.end() && old->i == i && old->j == j) pair = *old;
    pair.i = i;
    pair.j = j;
    pair.friction = j < 0 ? walls_[-1 - j].friction : friction_;
    pairs.push_back(pair);
  }
  pairs_.swap(pairs);
}

void PlaneNetwork::add_contact_forces(double& sum, int& contacts) const {
  const Vector zero = Vector::Zero(size());
  for (const Pair& pair : pairs_) {
    Geometry g;
    if (!geometry(pair, place(pair, zero), g)) continue;
    const Force f = force(pair, g);
    if (f.normal <= 0) continue;
    sum += std::hypot(f.fx, f.fy);
    ++contacts;
  }
}

void PlaneNetwork::take_back() {
  pairs_ = kept_.pairs;
  committed_ = kept_.committed;
  searched_ = kept_.searched;
  gradient_.setZero();
}

Snapshot PlaneNetwork::snapshot(const Snapshot& like) {
  Snapshot s = like;
  for (std::size_t k = 0; k < shapes_.size(); ++k) {
    Grain& g = s.grains[k];
    g.velocity = Vec3(0, 0, 0);
    g.spin = 0;
    g.position.x() = origin_[k][0] + committed_[k][0];
    g.position.y() = origin_[k][1] + committed_[k][1];
    if (g.fixed) continue;
    g.angle = origin_[k][2] + committed_[k][2];
  }
  s.contacts.clear();
  const Vector zero = Vector::Zero(size());
  for (const Pair& pair : pairs_) {
    Geometry g;
    if (!geometry(pair, place(pair, zero), g)) continue;
    const Force f = force(pair, g);
    if (f.fx == 0 && f.fy == 0) continue;
    Contact c;
    c.i = pair.i;
    c.j = pair.j;
    c.point = s.grains[pair.i].position +
              Vec3(g.lever_i * g.nx - g.shift_i * g.ny, g.lever_i * g.ny + g.shift_i * g.nx, 0);
    c.normal = Vec3(g.nx, g.ny, 0);
    c.force = Vec3(f.fx, f.fy, 0);
    c.normal_force = f.normal;
    c.tangential_force = c.spring = f.tangential;
    c.friction = pair.friction;
    c.sliding =
        c.friction > 0 && std::fabs(f.tangential) >= c.friction * f.normal * (1 - kSlidingMargin);
    s.contacts.push_back(c);
  }
  return s;
}

}  // namespace grainfield::dem
