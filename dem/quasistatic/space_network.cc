#include "dem/quasistatic/space_network.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <tuple>

#include "dem/neighbours/hierarchical_grid.h"
#include "dem/quasistatic/block_matrix.h"
#include "dem/quasistatic/sphere_network.h"
#include "dem/quasistatic/superellipsoid_network.h"

namespace grainfield::dem {
namespace {

// Gap up to which grains that do not touch are watched, as a share of the mean radius. The list is
// made anew when one has moved by half of it.
constexpr double kSkinShare = 0.05;

Vec3 whole(const std::array<int, 3>& image) { return Vec3(image[0], image[1], image[2]); }

struct Image {
  int grain = 0;
  std::array<int, 3> image{0, 0, 0};
};

/// Images of the grains that may touch another across a face that repeats.
std::vector<Image> images_near_faces(const Cell<3>& cell, const std::vector<Reach<3>>& spheres) {
  std::vector<Image> out;
  if (!cell.is_periodic()) return out;
  Eigen::Matrix3d edges = cell.edges;
  for (int a = 0; a < 3; ++a) {
    if (edges.col(a).isZero(0)) edges.col(a) = Vec3::Unit(a);
  }
  const Eigen::Matrix3d inverse = edges.inverse();
  double most = 0;
  for (const Reach<3>& s : spheres) most = std::max(most, 2 * s.reach);
  for (std::size_t k = 0; k < spheres.size(); ++k) {
    const Vec3 share = inverse * (spheres[k].centre - Vec3(cell.low));
    std::array<int, 3> first{0, 0, 0}, last{0, 0, 0};
    for (int a = 0; a < 3; ++a) {
      const double margin = most * inverse.row(a).norm();
      if (!cell.periodic[a]) continue;
      if (share[a] < margin) last[a] = 1;
      if (share[a] > 1 - margin) first[a] = -1;
    }
    for (int x = first[0]; x <= last[0]; ++x) {
      for (int y = first[1]; y <= last[1]; ++y) {
        for (int z = first[2]; z <= last[2]; ++z) {
          if (x != 0 || y != 0 || z != 0) out.push_back({static_cast<int>(k), {x, y, z}});
        }
      }
    }
  }
  return out;
}

auto order(const auto& pair) { return std::tie(pair.i, pair.j, pair.image); }

}  // namespace

template <SpaceContacts Contacts>
SpaceNetwork<Contacts>::SpaceNetwork(const Snapshot& start, const Materials& materials)
    : ContactNetwork(3),
      contacts_(start, materials),
      friction_(materials.friction),
      cell_(start.cell),
      walls_(start.walls) {
  const std::size_t n = start.grains.size();
  bodies_.resize(n);
  origin_.resize(n);
  turned_.resize(n);
  committed_.assign(n, Vec3::Zero());
  load_.assign(n, Vec3::Zero());
  double sum = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const Grain& g = start.grains[k];
    bodies_[k] = {g.radius, g.mass, g.fixed ? -1 : 6 * free_};
    if (!g.fixed) ++free_;
    origin_[k] = g.position;
    const auto& q = g.orientation;
    turned_[k] = RotationOf<3>(q[0], q[1], q[2], q[3]);
    sum += g.radius;
  }
  skin_ = kSkinShare * sum / static_cast<double>(std::max<std::size_t>(n, 1));
  for (const Contact& c : start.contacts) {
    Pair pair;
    pair.i = static_cast<int>(c.i);
    pair.j = static_cast<int>(c.j);
    pair.image = c.image;
    pair.memory = contacts_.memory_of(c);
    pairs_.push_back(pair);
  }
  std::sort(pairs_.begin(), pairs_.end(),
            [](const Pair& a, const Pair& b) { return order(a) < order(b); });
  const Vector zero = Vector::Zero(size());
  search(zero);
  commit(zero);
  stiffness_ = mean_stiffness();
}

/// Mean stiffness of the contacts that touch; of lightly touching ones where none does.
template <SpaceContacts Contacts>
double SpaceNetwork<Contacts>::mean_stiffness() const {
  double sum = 0;
  int contacts = 0;
  for (const Pair& pair : pairs_) {
    if (!pair.memory.touched) continue;
    sum += contacts_.stiffness(placed(pair), pair.memory);
    ++contacts;
  }
  if (contacts > 0) return sum / contacts;
  return contacts_.stiffness(bodies_.empty() ? 1 : bodies_.front().radius);
}

template <SpaceContacts Contacts>
void SpaceNetwork<Contacts>::set_load(const Vec3& gravity, const std::vector<Load>& loads) {
  for (std::size_t k = 0; k < bodies_.size(); ++k) load_[k] = bodies_[k].mass * gravity;
  for (const Load& load : loads) {
    for (const std::int64_t grain : load.grains) load_[grain] += load.force;
  }
}

template <SpaceContacts Contacts>
Vec3 SpaceNetwork<Contacts>::displacement(int grain, const Vector& z) const {
  const Body& s = bodies_[grain];
  Vec3 out = committed_[grain];
  if (strains()) out += gradient_ * (origin_[grain] + committed_[grain]);
  if (s.unknown >= 0) out += s.radius * z.segment<3>(s.unknown);
  return out;
}

template <SpaceContacts Contacts>
Vec3 SpaceNetwork<Contacts>::turn(int grain, const Vector& z) const {
  const Body& s = bodies_[grain];
  return s.unknown < 0 ? Vec3(0, 0, 0) : Vec3(z.segment<3>(s.unknown + 3));
}

/// Differences of displacements are taken before the (large) coordinates come in, so that an
/// overlap keeps its last digits far from the origin.
template <SpaceContacts Contacts>
Vec3 SpaceNetwork<Contacts>::across(const Pair& pair) const {
  if (pair.j < 0) return (walls_[-1 - pair.j].point - origin_[pair.i]) - committed_[pair.i];
  Vec3 out = (origin_[pair.j] - origin_[pair.i]) + (committed_[pair.j] - committed_[pair.i]);
  if (pair.image != std::array<int, 3>{0, 0, 0}) out += cell_.edges * whole(pair.image);
  return out;
}

template <SpaceContacts Contacts>
PlacedPair SpaceNetwork<Contacts>::placed(const Pair& pair) const {
  PlacedPair out;
  out.i = pair.i;
  out.j = pair.j;
  out.across = across(pair);
  out.friction = pair.friction;
  out.turned_i = turned_[pair.i];
  if (pair.j < 0) {
    out.plane = walls_[-1 - pair.j].normal;
  } else {
    out.turned_j = turned_[pair.j];
  }
  return out;
}

template <SpaceContacts Contacts>
PairMotion SpaceNetwork<Contacts>::motion(const Pair& pair, const Vector& z) const {
  const auto moved = [&](int grain) -> Vec3 {
    const Body& s = bodies_[grain];
    return s.unknown < 0 ? Vec3(0, 0, 0) : Vec3(s.radius * z.segment<3>(s.unknown));
  };
  PairMotion m;
  m.shift = moved(pair.i);
  m.turn_i = turn(pair.i, z);
  if (pair.j >= 0) {
    m.shift -= moved(pair.j);
    m.turn_j = turn(pair.j, z);
    if (strains()) m.shift -= gradient_ * across(pair);
  }
  return m;
}

template <SpaceContacts Contacts>
bool SpaceNetwork<Contacts>::force(const Pair& pair, const Vector& z, Force& out) const {
  return contacts_.force(placed(pair), pair.memory, motion(pair, z), out);
}

/// Rows: force on i, moment on i over its radius, the same of j; columns: the unknowns of i and j.
template <SpaceContacts Contacts>
bool SpaceNetwork<Contacts>::slopes(const Pair& pair, const Vector& z, PairBlock& out) const {
  PairSlopes by;
  if (!contacts_.slopes(placed(pair), pair.memory, motion(pair, z), by)) return false;
  const double ri = bodies_[pair.i].radius, rj = pair.j < 0 ? 1 : bodies_[pair.j].radius;
  Eigen::Matrix<double, 12, 9> d;
  d << by.topRows<3>(), by.middleRows<3>(3) / ri, -by.topRows<3>(), by.bottomRows<3>() / rj;
  d /= scale_;
  out.slopes.middleCols<3>(0) = ri * d.leftCols<3>();
  out.slopes.middleCols<3>(3) = d.middleCols<3>(3);
  out.slopes.middleCols<3>(6) = -rj * d.leftCols<3>();
  out.slopes.middleCols<3>(9) = d.rightCols<3>();
  return true;
}

template <SpaceContacts Contacts>
bool SpaceNetwork<Contacts>::residual(const Vector& z, Vector& r) {
  if (!within_reach(z)) return false;
  ensure_candidates(z);
  r.setZero(size());
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    if (bodies_[k].unknown >= 0) r.segment<3>(bodies_[k].unknown) = load_[k];
  }
  for (const Pair& pair : pairs_) {
    Force f;
    if (!force(pair, z, f)) continue;
    if (const Body& a = bodies_[pair.i]; a.unknown >= 0) {
      r.segment<3>(a.unknown) += f.force;
      r.segment<3>(a.unknown + 3) += f.moment_i / a.radius;
    }
    if (pair.j < 0 || bodies_[pair.j].unknown < 0) continue;
    const Body& b = bodies_[pair.j];
    r.segment<3>(b.unknown) -= f.force;
    r.segment<3>(b.unknown + 3) += f.moment_j / b.radius;
  }
  r /= scale_;
  return r.allFinite();
}

template <SpaceContacts Contacts>
void SpaceNetwork<Contacts>::tangent(const Vector& z, const Vector& r, const Vector& drag,
                                     Matrix& matrix) {
  ensure_candidates(z);
  blocks_.clear();
  std::vector<std::pair<int, int>> coupled;
  const auto number = [&](int grain) {
    return grain < 0 || bodies_[grain].unknown < 0 ? -1 : bodies_[grain].unknown / 6;
  };
  for (const Pair& pair : pairs_) {
    PairBlock block;
    block.i = number(pair.i);
    block.j = number(pair.j);
    if ((block.i < 0 && block.j < 0) || !slopes(pair, z, block)) continue;
    blocks_.push_back(block);
    if (block.i >= 0 && block.j >= 0) coupled.emplace_back(block.i, block.j);
  }
  std::sort(coupled.begin(), coupled.end());
  coupled.erase(std::unique(coupled.begin(), coupled.end()), coupled.end());
  lay_out_blocks(free_, 6, coupled, matrix);
  double* const values = matrix.valuePtr();
  const int* const outer = matrix.outerIndexPtr();
  const auto add = [&](int row, int column, const auto& block) {
    if (row < 0 || column < 0) return;
    const int place = place_of_block(matrix, 6, row, column);
    const int length = outer[6 * column + 1] - outer[6 * column];
    for (int c = 0; c < 6; ++c) {
      for (int k = 0; k < 6; ++k) values[place + c * length + k] += block(k, c);
    }
  };
  for (const PairBlock& b : blocks_) {
    add(b.i, b.i, b.slopes.topLeftCorner<6, 6>());
    add(b.i, b.j, b.slopes.topRightCorner<6, 6>());
    add(b.j, b.i, b.slopes.bottomLeftCorner<6, 6>());
    add(b.j, b.j, b.slopes.bottomRightCorner<6, 6>());
  }
  for (const Body& s : bodies_) {
    if (s.unknown < 0) continue;
    const double loose =
        kFloor * stiffness_ * s.radius / scale_ + r.segment<6>(s.unknown).cwiseAbs().maxCoeff();
    const int place = place_of_block(matrix, 6, s.unknown / 6, s.unknown / 6);
    const int length = outer[s.unknown + 1] - outer[s.unknown];
    for (int k = 0; k < 6; ++k) values[place + k * length + k] -= loose + drag[s.unknown + k];
  }
}

template <SpaceContacts Contacts>
std::vector<ContactNetwork::ForceChange> SpaceNetwork<Contacts>::force_changes(
    const Vector& z) const {
  const Vector zero = Vector::Zero(size());
  std::vector<ForceChange> out;
  for (const Pair& pair : pairs_) {
    PairBlock block;
    if (!any_free(pair) || !slopes(pair, zero, block)) continue;
    Eigen::Matrix<double, 12, 1> moved = Eigen::Matrix<double, 12, 1>::Zero();
    const int ui = bodies_[pair.i].unknown, uj = pair.j < 0 ? -1 : bodies_[pair.j].unknown;
    if (ui >= 0) moved.head<6>() = z.segment<6>(ui);
    if (uj >= 0) moved.tail<6>() = z.segment<6>(uj);
    out.push_back({pair.i, pair.j, pair.image, scale_ * block.slopes.topRows<3>() * moved});
  }
  return out;
}

template <SpaceContacts Contacts>
ContactNetwork::Vector SpaceNetwork<Contacts>::drag_unit() const {
  Vector unit(size());
  for (const Body& s : bodies_) {
    if (s.unknown >= 0) unit.segment<6>(s.unknown).setConstant(stiffness_ * s.radius / scale_);
  }
  return unit;
}

template <SpaceContacts Contacts>
void SpaceNetwork<Contacts>::commit(const Vector& z) {
  ensure_candidates(z);
  for (Pair& pair : pairs_) {
    Force f;
    force(pair, z, f);
    pair.memory = f.reached;
  }
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const int grain = static_cast<int>(k);
    committed_[k] = displacement(grain, z);
    turned_[k] = (quaternion_of(turn(grain, z)) * turned_[k]).normalized();
  }
  if (!strains()) return;
  cell_.edges += gradient_ * cell_.edges;
  cell_.low += gradient_ * cell_.low;
  gradient_.setZero();
}

template <SpaceContacts Contacts>
void SpaceNetwork<Contacts>::take_back() {
  pairs_ = kept_.pairs;
  committed_ = kept_.committed;
  turned_ = kept_.turned;
  searched_ = kept_.searched;
  cell_ = kept_.cell;
  gradient_.setZero();
}

template <SpaceContacts Contacts>
bool SpaceNetwork<Contacts>::any_free(const Pair& pair) const {
  return bodies_[pair.i].unknown >= 0 || (pair.j >= 0 && bodies_[pair.j].unknown >= 0);
}

/// Pairs of two that are held are left out unless a strain moves them, too.
template <SpaceContacts Contacts>
std::unique_ptr<ContactNetwork> SpaceNetwork<Contacts>::part(const std::vector<int>& free) const {
  auto out = std::make_unique<SpaceNetwork>(*this);
  out->kept_ = {};
  out->free_ = 0;
  auto next = free.begin();
  for (Body& s : out->bodies_) {
    if (s.unknown < 0) continue;
    const bool stays = next != free.end() && *next == s.unknown / 6;
    if (stays) ++next;
    s.unknown = stays ? 6 * out->free_++ : -1;
  }
  if (!strains()) std::erase_if(out->pairs_, [&](const Pair& p) { return !out->any_free(p); });
  return out;
}

template <SpaceContacts Contacts>
void SpaceNetwork<Contacts>::adopt(const ContactNetwork& part) {
  const auto& from = dynamic_cast<const SpaceNetwork&>(part);
  committed_ = from.committed_;
  turned_ = from.turned_;
  cell_ = from.cell_;
  gradient_ = from.gradient_;
  std::erase_if(pairs_, [&](const Pair& p) { return from.any_free(p); });
  std::vector<Pair> all;
  std::set_union(from.pairs_.begin(), from.pairs_.end(), pairs_.begin(), pairs_.end(),
                 std::back_inserter(all),
                 [](const Pair& a, const Pair& b) { return order(a) < order(b); });
  pairs_.swap(all);
  search(Vector::Zero(size()));
}

template <SpaceContacts Contacts>
void SpaceNetwork<Contacts>::ensure_candidates(const Vector& z) {
  const double limit = 0.25 * skin_ * skin_;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    if ((displacement(static_cast<int>(k), z) - searched_[k]).squaredNorm() > limit) {
      search(z);
      return;
    }
  }
}

/// Pairs within reach of where z puts the grains, sorted.
template <SpaceContacts Contacts>
auto SpaceNetwork<Contacts>::near(const Vector& z) const -> std::vector<Pair> {
  const int n = static_cast<int>(bodies_.size());
  std::vector<Reach<3>> reaches(n);
  for (int k = 0; k < n; ++k) {
    reaches[k] = {origin_[k] + displacement(k, z), bodies_[k].radius + 0.5 * skin_,
                  bodies_[k].unknown < 0};
  }
  std::vector<Pair> all;
  const auto add = [&](int i, int j, const std::array<int, 3>& image) {
    Pair pair;
    pair.i = i;
    pair.j = j;
    pair.image = image;
    all.push_back(pair);
  };
  for (int i = 0; i < n; ++i) {
    if (bodies_[i].unknown < 0) continue;
    for (std::size_t w = 0; w < walls_.size(); ++w) {
      const double height = (reaches[i].centre - walls_[w].point).dot(walls_[w].normal);
      if (height < bodies_[i].radius + skin_) add(i, -1 - static_cast<int>(w), {0, 0, 0});
    }
  }
  // Images of the grains near a face that repeats, behind the real ones.
  const std::vector<Image> images = images_near_faces(cell_, reaches);
  for (const Image& m : images) {
    reaches.push_back({reaches[m.grain].centre + Vec3(cell_.edges * whole(m.image)),
                       reaches[m.grain].reach, reaches[m.grain].fixed});
  }
  std::vector<std::pair<int, int>> found;
  HierarchicalGrid<3> grid;
  grid.build(reaches);
  grid.pairs(found);
  for (const auto& [i, j] : found) {
    if (i >= n) break;  // two images
    if (j < n) {
      add(i, j, {0, 0, 0});
    } else if (images[j - n].grain > i) {
      add(i, images[j - n].grain, images[j - n].image);
    }
  }
  std::sort(all.begin(), all.end(),
            [](const Pair& a, const Pair& b) { return order(a) < order(b); });
  return all;
}

/// The near pairs with what the old ones remember; and those that touched in the committed state,
/// wherever z puts them: a step that is taken back finds their springs again.
template <SpaceContacts Contacts>
void SpaceNetwork<Contacts>::search(const Vector& z) {
  searched_.resize(bodies_.size());
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    searched_[k] = displacement(static_cast<int>(k), z);
  }
  std::vector<Pair> pairs;
  auto old = pairs_.cbegin();
  const auto keep_old = [&] {
    if (old->memory.touched) pairs.push_back(*old);
    ++old;
  };
  for (Pair& pair : near(z)) {
    while (old != pairs_.cend() && order(*old) < order(pair)) keep_old();
    if (old != pairs_.cend() && order(*old) == order(pair)) {
      pair = *old;
      ++old;
    }
    pair.friction = pair.j < 0 ? walls_[-1 - pair.j].friction : friction_;
    pairs.push_back(pair);
  }
  while (old != pairs_.cend()) keep_old();
  pairs_.swap(pairs);
}

template <SpaceContacts Contacts>
void SpaceNetwork<Contacts>::add_contact_forces(double& sum, int& contacts) const {
  const Vector zero = Vector::Zero(size());
  for (const Pair& pair : pairs_) {
    Force f;
    if (!force(pair, zero, f) || !(f.normal > 0)) continue;
    sum += f.force.norm();
    ++contacts;
  }
}

template <SpaceContacts Contacts>
Snapshot SpaceNetwork<Contacts>::snapshot(const Snapshot& like) {
  Snapshot s = like;
  s.cell = cell_;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    Grain& g = s.grains[k];
    g.velocity = g.angular_velocity = Vec3(0, 0, 0);
    g.spin = 0;
    g.position = origin_[k] + committed_[k];
    if (g.fixed) continue;
    const RotationOf<3>& q = turned_[k];
    g.orientation = {q.w(), q.x(), q.y(), q.z()};
  }
  s.contacts.clear();
  const Vector zero = Vector::Zero(size());
  for (const Pair& pair : pairs_) {
    Force f;
    if (!force(pair, zero, f) || f.force.isZero(0)) continue;
    Contact c;
    c.i = pair.i;
    c.j = pair.j;
    c.image = pair.image;
    c.normal = f.reached.normal;
    c.point = s.grains[pair.i].position + contacts_.arm_of(f.reached);
    c.force = f.force;
    c.normal_force = f.normal;
    c.spring_vector = f.friction;
    c.tangential_force = c.spring = f.friction.norm();
    contacts_.tell(f.reached, c);
    c.friction = pair.friction;
    c.sliding = c.friction > 0 && c.spring >= c.friction * f.normal * (1 - kSlidingMargin);
    s.contacts.push_back(c);
  }
  return s;
}

template class SpaceNetwork<SphereContacts>;
template class SpaceNetwork<SuperellipsoidContacts>;

}  // namespace grainfield::dem
