#include "carried_stress_scene.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "dem/random/random.h"

namespace grainfield::test {
namespace {

constexpr double kDensity = 5000, kGravity = 9.81;
const double kLift = std::sqrt(3.0) / 2;  // of a row, diameters
constexpr int kCorrections = 4;           // the second already leaves round-off

double normal(dem::Random& random) {
  double sum = -6;  // of twelve uniform numbers
  for (int k = 0; k < 12; ++k) sum += random.uniform();
  return sum;
}

struct Network {
  dem::Snapshot packing;
  std::vector<Eigen::Vector2d> area;  // of every contact: normal x share, m
};

// Grains by row and column in half diameters.
using Places = std::map<std::pair<int, int>, std::int64_t>;

void add_grain(Network& net, Places& at, int row, int column, double diameter,
               const Eigen::Vector2d& place, const Disorder& disorder, dem::Random& random) {
  dem::Grain g;
  g.id = static_cast<std::int64_t>(net.packing.grains.size());
  for (int a = 0; a < 2; ++a) {
    g.position[a] = place[a] + disorder.jitter * diameter * random.uniform(-1, 1);
  }
  // Jittered neighbours still touch.
  g.radius = diameter / 2 * (1 + 3 * disorder.jitter);
  g.volume = std::numbers::pi * g.radius * g.radius;
  g.mass = kDensity * std::numbers::pi * diameter * diameter / 4;
  g.inertia = g.mass * g.radius * g.radius / 2;
  at[{row, column}] = g.id;
  net.packing.grains.push_back(g);
}

void add_wall(dem::Snapshot& s, const char* name, const dem::Vec3& point, const dem::Vec3& normal) {
  dem::Wall wall;
  wall.name = name;
  wall.point = point;
  wall.normal = normal;
  wall.friction = 0.5;
  s.walls.push_back(wall);
}

void add_contact(Network& net, std::int64_t i, std::int64_t j, const dem::Vec3& point,
                 const dem::Vec3& normal, const Eigen::Vector2d& area) {
  dem::Contact c;
  c.i = i;
  c.j = j;
  c.point = point;
  c.normal = normal;
  c.friction = 0.5;
  net.packing.contacts.push_back(c);
  net.area.push_back(area);
}

// The three bonds to the right, and up to either side: every pair once.
struct Bond {
  int up, aside;
};
constexpr Bond kBonds[] = {{0, 2}, {1, 1}, {1, -1}};

void add_pairs(Network& net, const Places& at, double diameter) {
  for (const auto& [place, i] : at) {
    const dem::Vec3 own = net.packing.grains[static_cast<std::size_t>(i)].position;
    for (const Bond& bond : kBonds) {
      const auto other = at.find({place.first + bond.up, place.second + bond.aside});
      if (other == at.end()) continue;
      const dem::Vec3 branch =
          net.packing.grains[static_cast<std::size_t>(other->second)].position - own;
      const dem::Vec3 n = branch.normalized();
      add_contact(net, i, other->second, own + branch / 2, n,
                  n.head<2>() * diameter / std::sqrt(3.0));
    }
  }
}

// Forces that balance every grain, as the page's head says. `stress`: at the contacts, n x 3;
// `load`: on the grains, N; `least`: stress below which neither noise nor correction shrinks, N/m.
std::vector<Eigen::Vector2d> balanced_forces(const Network& net, const Eigen::MatrixXd& stress,
                                             const std::vector<Eigen::Vector2d>& load, double least,
                                             double noise, dem::Random& random) {
  const dem::Snapshot& s = net.packing;
  const auto contacts = static_cast<Eigen::Index>(s.contacts.size());
  const auto grains = static_cast<Eigen::Index>(s.grains.size());
  Eigen::VectorXd force(2 * contacts), weight(2 * contacts), right(3 * grains);
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index c = 0; c < contacts; ++c) {
    const dem::Contact& contact = s.contacts[static_cast<std::size_t>(c)];
    const Eigen::Vector2d& area = net.area[static_cast<std::size_t>(c)];
    Eigen::Matrix2d t;
    t << stress(c, 0), stress(c, 2), stress(c, 2), stress(c, 1);
    const double size = std::max(t.norm(), least) * area.norm();
    for (int a = 0; a < 2; ++a) {
      force[2 * c + a] = t.row(a).dot(area) + noise * size * normal(random);
      weight[2 * c + a] = size * size;
    }
    // On grain g with this sign; the moment over the radius.
    const auto enter = [&](std::int64_t g, double sign) {
      const dem::Grain& grain = s.grains[static_cast<std::size_t>(g)];
      const dem::Vec3 arm = (contact.point - grain.position) / grain.radius;
      entries.emplace_back(3 * g, 2 * c, sign);
      entries.emplace_back(3 * g + 1, 2 * c + 1, sign);
      entries.emplace_back(3 * g + 2, 2 * c, -sign * arm.y());
      entries.emplace_back(3 * g + 2, 2 * c + 1, sign * arm.x());
    };
    enter(contact.i, 1);
    if (contact.j >= 0) enter(contact.j, -1);
  }
  for (Eigen::Index g = 0; g < grains; ++g) {
    right.segment<3>(3 * g) << -load[static_cast<std::size_t>(g)], 0;
  }
  Eigen::SparseMatrix<double> balance(3 * grains, 2 * contacts);
  balance.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SparseMatrix<double> turned = weight.asDiagonal() * balance.transpose();
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(balance * turned);
  if (solver.info() != Eigen::Success) throw std::runtime_error("carried stress: a loose grain");
  for (int k = 0; k < kCorrections; ++k) {
    force += turned * solver.solve(right - balance * force);
  }
  std::vector<Eigen::Vector2d> out;
  for (Eigen::Index c = 0; c < contacts; ++c) out.emplace_back(force.segment<2>(2 * c));
  return out;
}

void add_forces(const std::vector<Eigen::Vector2d>& forces, dem::Snapshot& s) {
  for (std::size_t k = 0; k < forces.size(); ++k) {
    dem::Contact& c = s.contacts[k];
    c.force.head<2>() += forces[k];
    c.normal_force = -c.force.dot(c.normal);
    c.tangential_force = c.force.dot(dem::Vec3(-c.normal.y(), c.normal.x(), 0));
    c.sliding = std::fabs(c.tangential_force) > c.friction * c.normal_force;
  }
}

Eigen::MatrixXd contact_points(const dem::Snapshot& s, const Eigen::Vector2d& origin) {
  Eigen::MatrixXd out(static_cast<Eigen::Index>(s.contacts.size()), 2);
  for (Eigen::Index k = 0; k < out.rows(); ++k) {
    out.row(k) = s.contacts[static_cast<std::size_t>(k)].point.head<2>() - origin;
  }
  return out;
}

std::vector<Eigen::Vector2d> weights(const dem::Snapshot& s) {
  std::vector<Eigen::Vector2d> out;
  for (const dem::Grain& g : s.grains) out.emplace_back(0, -kGravity * g.mass);
  return out;
}

}  // namespace

double carried_rho_g() { return kDensity * kGravity * std::numbers::pi / (4 * kLift); }

double CarriedLayer::depth() const {
  return diameter * ((rows - 1) * kLift + 1 + 1.5 * disorder.jitter);
}

LoadedLayer carried_layer(const CarriedLayer& setup, const StressAt& response) {
  const double d = setup.diameter, depth = setup.depth();
  dem::Random random(setup.disorder.seed);
  Network net;
  net.packing.gravity = {0, -kGravity, 0};
  const double half = (setup.columns + 0.5) * d / 2;
  add_wall(net.packing, "floor", {0, 0, 0}, {0, 1, 0});
  add_wall(net.packing, "left", {-half, 0, 0}, {1, 0, 0});
  add_wall(net.packing, "right", {half, 0, 0}, {-1, 0, 0});
  Places at;
  for (int row = 0; row < setup.rows; ++row) {
    for (int k = 0; k < setup.columns; ++k) {
      const int column = 2 * k + row % 2;
      add_grain(net, at, row, column, d, {(column + 1) * d / 2 - half, d * (0.5 + row * kLift)},
                setup.disorder, random);
    }
  }
  for (const auto& [place, i] : at) {
    const auto& [row, column] = place;
    const dem::Vec3 centre = net.packing.grains[static_cast<std::size_t>(i)].position;
    if (row == 0) add_contact(net, i, -1, {centre.x(), 0, 0}, {0, -1, 0}, {0, -d});
    // A row that reaches the wall lacks three bonds there, the next row one.
    const int last = 2 * (setup.columns - 1);
    if (column < 2) {
      const double share = (column == 0 ? 2 : 1) / std::sqrt(3.0) * d;
      add_contact(net, i, -2, {centre.x() - d / 2, centre.y(), 0}, {-1, 0, 0}, {-share, 0});
    }
    if (column >= last) {
      const double share = (column > last ? 2 : 1) / std::sqrt(3.0) * d;
      add_contact(net, i, -3, {centre.x() + d / 2, centre.y(), 0}, {1, 0, 0}, {share, 0});
    }
  }
  add_pairs(net, at, d);

  LoadedLayer out;
  const Eigen::MatrixXd places = contact_points(net.packing, {0, depth});
  Eigen::MatrixXd own = Eigen::MatrixXd::Zero(places.rows(), 3);
  own.col(1) = carried_rho_g() * places.col(1);
  own.col(0) = own.col(1) / 2;
  out.unloaded = net.packing;
  add_forces(balanced_forces(net, own, weights(net.packing), carried_rho_g() * d / 2,
                             setup.disorder.noise, random),
             out.unloaded);
  out.loaded = out.unloaded;
  const int top = setup.rows - 1, middle = 2 * (setup.columns / 2) + top % 2;
  const std::int64_t grain = at.at({top, middle});
  out.loaded.loaded_grain = grain;
  out.loaded.applied_force = {0, -setup.load, 0};
  std::vector<Eigen::Vector2d> load(net.packing.grains.size(), Eigen::Vector2d::Zero());
  load[static_cast<std::size_t>(grain)].y() = -setup.load;
  const double x = net.packing.grains[static_cast<std::size_t>(grain)].position.x();
  Eigen::MatrixXd seen = contact_points(net.packing, {x, depth});
  seen.col(1) = seen.col(1).cwiseMax(-depth);
  add_forces(balanced_forces(net, response(seen), load, 0.02 * setup.load / depth,
                             setup.disorder.noise, random),
             out.loaded);
  return out;
}

dem::Snapshot carried_heap(const CarriedHeap& setup, const StressAt& stress) {
  const double d = setup.diameter, height = d * (1 + (setup.rows - 1) * kLift);
  const double slope = std::tan(setup.slope_deg * std::numbers::pi / 180);
  dem::Random random(setup.disorder.seed);
  Network net;
  net.packing.gravity = {0, -kGravity, 0};
  add_wall(net.packing, "floor", {0, 0, 0}, {0, 1, 0});
  Places at;
  for (int row = 0; row < setup.rows; ++row) {
    const double y = d * (0.5 + row * kLift) - height;  // from the apex
    const int reach = static_cast<int>(2 * height / slope / d) + 2;
    for (int column = -reach; column <= reach; ++column) {
      if ((column + row) % 2 != 0) continue;
      const double x = column * d / 2;
      // Centres below the slope's line, so that the heap weighs what the wedge does.
      const double over = std::fabs(x) < d ? 1e-9 : d / 2;
      if (y + d / 2 - over > -slope * std::fabs(x)) continue;
      add_grain(net, at, row, column, d, {x, height + y}, setup.disorder, random);
    }
  }
  for (const auto& [place, i] : at) {
    const double x = net.packing.grains[static_cast<std::size_t>(i)].position.x();
    if (place.first == 0) add_contact(net, i, -1, {x, 0, 0}, {0, -1, 0}, {0, -d});
  }
  add_pairs(net, at, d);
  Eigen::MatrixXd places = contact_points(net.packing, {0, height});
  for (Eigen::Index k = 0; k < places.rows(); ++k) {
    // Contacts above the slope's line carry what is just below it.
    places(k, 1) = std::min(places(k, 1), -slope * std::fabs(places(k, 0)) - 0.05 * d);
  }
  dem::Snapshot out = net.packing;
  add_forces(balanced_forces(net, stress(places), weights(net.packing), carried_rho_g() * d / 2,
                             setup.disorder.noise, random),
             out);
  return out;
}

double largest_imbalance(const dem::Snapshot& s) {
  std::vector<dem::Vec3> force, moment(s.grains.size(), dem::Vec3::Zero());
  for (const dem::Grain& g : s.grains) force.emplace_back(g.mass * s.gravity);
  double mean = 0;
  for (const dem::Contact& c : s.contacts) {
    mean += c.force.norm() / static_cast<double>(s.contacts.size());
    const auto act = [&](std::int64_t on, const dem::Vec3& f) {
      const auto g = static_cast<std::size_t>(on);
      force[g] += f;
      moment[g] += (c.point - s.grains[g].position).cross(f);
    };
    act(c.i, c.force);
    if (c.j >= 0) act(c.j, -c.force);
  }
  double largest = 0;
  for (std::size_t g = 0; g < s.grains.size(); ++g) {
    if (s.grains[g].fixed) continue;
    if (is_loaded(s, s.grains[g].id)) force[g] += s.applied_force;
    largest = std::max({largest, force[g].norm(), moment[g].norm() / s.grains[g].radius});
  }
  return largest / mean;
}

double pulling_share(const dem::Snapshot& s) {
  const auto pulling = std::count_if(s.contacts.begin(), s.contacts.end(),
                                     [](const auto& c) { return c.force.dot(c.normal) > 0; });
  return static_cast<double>(pulling) / static_cast<double>(s.contacts.size());
}

}  // namespace grainfield::test
