// Headers of Boost.Geometry 1.74 include one that Boost itself calls deprecated.
#define BOOST_ALLOW_DEPRECATED_HEADERS
#include "dem/walls/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/function_output_iterator.hpp>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "dem/shared/refuse.h"
#include "dem/space/space3.h"

namespace grainfield::dem {
namespace {

std::string named(const std::string& what, std::size_t facet) {
  return fmt::format("{}: facet {}", what, facet + 1);
}

namespace bg = boost::geometry;
using Point = bg::model::point<double, 3, bg::cs::cartesian>;
using Box = bg::model::box<Point>;

constexpr double kLeastShape = 1e-10;  // area of a facet / longest edge squared
constexpr double kSamePlace = 1e-9;    // of the reach: two nearest points are one
constexpr int kMostMinima = 32;        // kept while a ball's triangles are looked at

/// A place where a triangle is nearest to a centre.
struct Minimum {
  Vec3 at, normal;  // from there to the centre
  double distance = 0;
  int triangle = 0;
};

class MeshSurface final : public WallSurface<3> {
 public:
  explicit MeshSurface(MeshTopology mesh) : mesh_(std::move(mesh)) {
    const std::size_t n = mesh_.triangles.size();
    std::vector<std::pair<Box, int>> boxes;
    boxes.reserve(n);
    normals_.resize(n);
    inwards_.resize(n);
    around_.resize(mesh_.corners.size());
    corner_normals_.assign(mesh_.corners.size(), Vec3::Zero());
    for (std::size_t t = 0; t < n; ++t) add(static_cast<int>(t), boxes);
    tree_ = Tree(boxes);
  }

  int slots() const override { return kMostPatches; }

  double sweeping_arm(const Vec3& centre, const Vec3& spin) const override {
    double far = 0;
    for (const Vec3& at : mesh_.corners) {
      far = std::max(far, (at - centre).cross(spin.normalized()).norm());
    }
    return far;
  }

  int patches(const Vec3& c, double reach, Patch<3>* found) const override {
    std::array<Minimum, kMostMinima> minima;
    int count = 0;
    const auto look = [&](const std::pair<Box, int>& entry) {
      Minimum m;
      m.triangle = entry.second;
      if (!nearest(c, reach, m)) return;
      if (count == kMostMinima && !before(m, minima[kMostMinima - 1])) return;
      int k = count < kMostMinima ? count++ : kMostMinima - 1;
      for (; k > 0 && before(m, minima[k - 1]); --k) minima[k] = minima[k - 1];
      minima[k] = m;
    };
    const Box ball(Point(c.x() - reach, c.y() - reach, c.z() - reach),
                   Point(c.x() + reach, c.y() + reach, c.z() + reach));
    tree_.query(bg::index::intersects(ball), boost::make_function_output_iterator(look));
    int kept = 0;
    for (int k = 0; k < count && kept < kMostPatches; ++k) {
      const Minimum& m = minima[k];
      const auto is_known = [&](const Patch<3>& p) {
        return p.plane.normal.dot(m.normal) > kSmoothCosine ||
               (p.plane.point - m.at).norm() < kSamePlace * reach;
      };
      if (std::any_of(found, found + kept, is_known)) continue;
      found[kept++] = {{m.at, m.normal}, 0};
    }
    return kept;
  }

 private:
  using Tree = bg::index::rtree<std::pair<Box, int>, bg::index::rstar<16>>;

  static bool before(const Minimum& a, const Minimum& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.triangle < b.triangle;
  }
  const Vec3& corner(int t, int k) const { return mesh_.corners[mesh_.triangles[t][k % 3]]; }

  void add(int t, std::vector<std::pair<Box, int>>& boxes) {
    const Vec3 &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
    normals_[t] = (b - a).cross(c - a).normalized();
    const Vec3 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    boxes.emplace_back(Box(Point(low.x(), low.y(), low.z()), Point(high.x(), high.y(), high.z())),
                       t);
    for (int k = 0; k < 3; ++k) {
      const Vec3 edge = (corner(t, k + 1) - corner(t, k)).normalized();
      const Vec3 back = (corner(t, k + 2) - corner(t, k)).normalized();
      inwards_[t][k] = normals_[t].cross(edge);
      const int at = mesh_.triangles[t][k];
      around_[at].push_back(edge);
      around_[at].push_back(back);
      // Weighted by angle: tells inside from outside at a corner (Baerentzen and Aanaes 2005).
      const double angle = std::acos(std::clamp(edge.dot(back), -1.0, 1.0));
      corner_normals_[at] += angle * normals_[t];
    }
  }

  /// The place of the triangle nearest to c, when it is nearer than `reach`, no neighbour is nearer
  /// there, and the mesh pushes towards c.
  bool nearest(const Vec3& c, double reach, Minimum& m) const {
    const int t = m.triangle;
    const Vec3& n = normals_[t];
    const double height = (c - corner(t, 0)).dot(n);
    if (!(std::fabs(height) < reach)) return false;
    const auto edges = sides(t, c);
    if (edges[0] >= 0 && edges[1] >= 0 && edges[2] >= 0) {
      if (mesh_.closed && !(height > 0)) return false;
      m.normal = height >= 0 ? n : Vec3(-n);
      m.at = c - height * n;
      m.distance = std::fabs(height);
      return true;
    }
    for (int k = 0; k < 3; ++k) {
      if (edges[k] < 0 && on_edge(t, k, c, reach, m)) return true;
    }
    for (int k = 0; k < 3; ++k) {
      if (on_corner(mesh_.triangles[t][k], c, reach, m)) return true;
    }
    return false;
  }

  /// How far c lies on the inner side of each edge, m.
  std::array<double, 3> sides(int t, const Vec3& c) const {
    std::array<double, 3> out{};
    for (int k = 0; k < 3; ++k) out[k] = (c - corner(t, k)).dot(inwards_[t][k]);
    return out;
  }

  bool on_edge(int t, int k, const Vec3& c, double reach, Minimum& m) const {
    const Vec3 &a = corner(t, k), &b = corner(t, k + 1);
    const Vec3 edge = b - a;
    const double share = (c - a).dot(edge) / edge.squaredNorm();
    if (!(share > 0 && share < 1)) return false;
    m.at = a + share * edge;
    const Vec3 way = c - m.at;
    m.distance = way.norm();
    if (!(m.distance < reach && m.distance > 0)) return false;
    const int other = mesh_.beyond[t][k];
    if (other >= 0 && way.dot(inward_of(other, t)) > kSamePlace * reach) return false;
    if (mesh_.closed && !(way.dot(normals_[t] + normals_[other]) > 0)) return false;
    m.normal = way / m.distance;
    return true;
  }
  /// Inward direction at the edge that triangle t has with `other`.
  const Vec3& inward_of(int t, int other) const {
    const auto& beyond = mesh_.beyond[t];
    const auto at = std::find(beyond.begin(), beyond.end(), other);
    return inwards_[t][at - beyond.begin()];
  }

  bool on_corner(int corner, const Vec3& c, double reach, Minimum& m) const {
    m.at = mesh_.corners[corner];
    const Vec3 way = c - m.at;
    m.distance = way.norm();
    if (!(m.distance < reach && m.distance > 0)) return false;
    for (const Vec3& edge : around_[corner]) {
      if (way.dot(edge) > kSamePlace * reach) return false;
    }
    if (mesh_.closed && !(way.dot(corner_normals_[corner]) > 0)) return false;
    m.normal = way / m.distance;
    return true;
  }

  MeshTopology mesh_;
  std::vector<Vec3> normals_;
  std::vector<std::array<Vec3, 3>> inwards_;  // in the triangle's plane, away from its edges
  std::vector<std::vector<Vec3>> around_;     // by corner: along its edges
  std::vector<Vec3> corner_normals_;
  Tree tree_;
};

}  // namespace

MeshTopology topology_of(const Triangles& triangles, const std::string& what) {
  if (triangles.empty()) throw std::invalid_argument(what + ": found no facet");
  MeshTopology mesh;
  std::map<std::array<double, 3>, int> places;
  std::map<std::pair<int, int>, std::pair<int, int>> edges;  // from, to: triangle, edge
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    if (!(a.allFinite() && b.allFinite() && c.allFinite())) {
      refuse(named(what, t), "a corner's coordinate is not a finite number");
    }
    const double longest =
        std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    if (!((b - a).cross(c - a).norm() > kLeastShape * longest)) {
      refuse(named(what, t), "has no area; leave it out");
    }
    mesh.volume += a.dot(b.cross(c)) / 6;
    std::array<int, 3> corners{};
    for (int k = 0; k < 3; ++k) {
      const Vec3 at = triangles[t][k] + Vec3::Zero();  // -0 is 0
      const auto [it, is_new] =
          places.emplace(std::array{at.x(), at.y(), at.z()}, static_cast<int>(places.size()));
      if (is_new) mesh.corners.push_back(at);
      corners[k] = it->second;
    }
    for (int k = 0; k < 3; ++k) {
      const std::pair edge(corners[k], corners[(k + 1) % 3]);
      const auto [it, is_new] = edges.emplace(edge, std::pair(static_cast<int>(t), k));
      if (!is_new) {
        refuse(named(what, t),
               fmt::format("turned against facet {}, or a third one at their edge; neighbours must "
                           "be counter-clockwise from the same side",
                           it->second.first + 1));
      }
    }
    mesh.triangles.push_back(corners);
  }
  mesh.beyond.assign(triangles.size(), {-1, -1, -1});
  for (const auto& [edge, from] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    if (back != edges.end()) {
      mesh.beyond[from.first][from.second] = back->second.first;
    } else {
      mesh.closed = false;
    }
  }
  return mesh;
}

std::unique_ptr<WallSurface<3>> mesh_surface(const Triangles& triangles, const std::string& what) {
  return std::make_unique<MeshSurface>(topology_of(triangles, what));
}

}  // namespace grainfield::dem
