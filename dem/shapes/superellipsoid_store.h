// Superellipsoids as the engine keeps them: their shapes, and how they are turned.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "dem/checkpoint/checkpoint.h"
#include "dem/shapes/common_normal.h"
#include "dem/shapes/solid.h"
#include "dem/space/body.h"
#include "dem/space/elementary.h"
#include "dem/space/overlap.h"
#include "dem/space/plane.h"
#include "dem/space/space3.h"

namespace grainfield::dem {

class SuperellipsoidStore {
 public:
  static constexpr int dim = 3;
  static constexpr bool outlines = false;
  static constexpr bool central = false;
  static constexpr bool keeps_places = true;
  static constexpr bool offers(Measures m) {
    return m == Measures::depth || m == Measures::curvatures;
  }
  using Overlap = Overlap3;
  using Feature = PairNormal;
  // What rounding does to the sums of ways of a million steps is below this share of both sizes.
  static constexpr double kRoundedWay = 1e-9;

  /// Bounding radius of what is given, m. Throws std::invalid_argument as `superellipsoid` does.
  static double reach(const ShapeInput& shape) { return farthest_of(shape_of(shape)); }

  Solid<3> add(const ShapeInput& input) {
    Grain grain;
    grain.shape = shape_of(input);
    const Solid<3> solid = solid_of(grain.shape);
    grain.farthest = solid.radius;
    grain.nearest = nearest_of(grain.shape);
    // dh = |(x cross n) . turn|, |x cross n|^2 = x^2 - h^2.
    grain.lever =
        std::sqrt(std::max(grain.farthest * grain.farthest - grain.nearest * grain.nearest, 0.0));
    grain.equal_radius = cube_root(solid.volume / (4.0 / 3 * std::numbers::pi));
    grains_.push_back(grain);
    lanes_.push_back(lane_body(turned(grain), grain.equal_radius));
    ways_.push_back(0);
    places_.push_back(Eigen::Vector3d::Zero());
    return solid;
  }
  void place(int i, const Body<3>& b, const RotationOf<3>& rotation) {
    Grain& grain = grains_[i];
    const double chord =
        std::sqrt(std::min((rotation.coeffs() - grain.rotation.coeffs()).squaredNorm(),
                           (rotation.coeffs() + grain.rotation.coeffs()).squaredNorm()));
    // The angle is 4 asin(chord/2), and asin x <= x + (pi/2 - 1) x^3.
    const double swept = grain.lever * 2 * chord * (1 + 0.15 * chord * chord);
    grain.swept += swept;
    ways_[i] += swept + (b.position - places_[i]).norm();
    places_[i] = b.position;
    grain.rotation = rotation;
    grain.turn = rotation.toRotationMatrix();
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < 3; ++l) lanes_[i].turn[k][l] = grain.turn(l, k);
    }
  }
  void swap(int i, int j) {
    std::swap(grains_[i], grains_[j]);
    std::swap(lanes_[i], lanes_[j]);
  }
  void sort(const std::vector<int>& order) {
    std::vector<Grain> sorted(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) sorted[k] = grains_[order[k]];
    std::copy(sorted.begin(), sorted.end(), grains_.begin());
    fill_lanes();
  }
  /// By how much any distance between tangent planes across a fixed direction may have changed for
  /// each grain since start_ways(), m: the lengths of the ways of its centre and of its turning.
  const double* ways() const { return ways_.data(); }
  void start_ways(const Body<3>* bodies) {
    for (std::size_t i = 0; i < ways_.size(); ++i) {
      ways_[i] = 0;
      places_[i] = bodies[i].position;
    }
  }
  /// For a pair that `put` has just found apart: up to which sum of both ways it is apart for
  /// certain, and `put` would change nothing of what it remembers. With what rounding may do.
  double apart_until(int i, const Body<3>& a, int j, const Eigen::Vector3d& position,
                     const Feature& feature) const {
    const Grain &first = grains_[i], &second = grains_[j];
    const Eigen::Vector3d across = position - a.position;
    const double reach = first.farthest + second.farthest;
    const double gap = std::isfinite(feature.clear)
                           ? across.dot(feature.normal) - feature.clear - first.swept - second.swept
                           : across.norm() - reach;
    return ways_[i] + ways_[j] + gap - kRoundedWay * reach;
  }
  Outline outline(int) const { return {}; }
  const Superellipsoid& superellipsoid(int i) const { return grains_[i].shape; }

  template <Measures measures>
  bool overlap(int i, const Body<3>& a, int j, const Body<3>& b, Feature& feature,
               Overlap& o) const {
    const Grain &first = grains_[i], &second = grains_[j];
    const Eigen::Vector3d across = b.position - a.position;
    const double swept = first.swept + second.swept;
    if (across.dot(feature.normal) > feature.clear + swept) return false;
    CommonNormal contact;
    const bool touches = common_normal(turned(first), turned(second), across, feature, contact,
                                       measures == Measures::curvatures);
    return take<measures>(touches, first, second, across, contact, feature, o);
  }

  /// Pairs side by side, by slot. After finish the overlaps of those that touch.
  struct Batch {
    int count = 0;  ///< slots in use
    bool touches[kBatch];
    OverlapBatch overlaps{};

    Batch() {
      // What nobody has put in is looked at, too.
      std::fill_n(overlaps.depth, kBatch, 1.0);
      std::fill_n(overlaps.radius, kBatch, 1.0);
      std::fill_n(overlaps.lesser_curvature, kBatch, 1.0);
      std::fill_n(overlaps.greater_curvature, kBatch, 1.0);
    }

   private:
    friend class SuperellipsoidStore;
    PairBatch pairs;
    int i[kBatch], j[kBatch];
    Feature* features[kBatch];
  };
  /// Puts a pair into the next slot; false, and into none, when it is known already that the two do
  /// not touch. Bit by bit as `overlap`.
  template <Measures measures>
  bool put(Batch& batch, int i, const Body<3>& a, int j, const Eigen::Vector3d& position,
           Feature& feature) const {
    const int slot = batch.count;
    const Eigen::Vector3d across = position - a.position;
    const double reach = lanes_[i].farthest + lanes_[j].farthest;
    if (feature.touching == 0 || !(across.squaredNorm() < reach * reach)) {
      return put_alone<measures>(batch, i, a, j, position, feature);
    }
    PairBatch& p = batch.pairs;
    p.slots[p.count++] = slot;
    p.i[slot] = &lanes_[i];
    p.j[slot] = &lanes_[j];
    p.powers[slot] = &feature.powers;
    for (int k = 0; k < 3; ++k) {
      p.across[k][slot] = across[k];
      batch.overlaps.normal[k][slot] = feature.normal[k];
    }
    batch.i[slot] = i;
    batch.j[slot] = j;
    batch.features[slot] = &feature;
    ++batch.count;
    return true;
  }
  template <Measures measures>
  void finish(Batch& batch) const {
    PairBatch& p = batch.pairs;
    p.overlaps = &batch.overlaps;
    step_pairs(p, measures == Measures::curvatures);
    for (int n = 0; n < p.count; ++n) {
      const int slot = p.slots[n];
      Feature& feature = *batch.features[slot];
      const auto& normal = batch.overlaps.normal;
      if (p.ends[slot] != Stepped::neither) {
        feature.normal = {normal[0][slot], normal[1][slot], normal[2][slot]};
      }
      batch.touches[slot] = p.ends[slot] == Stepped::settled;
      if (batch.touches[slot]) continue;  // it remembers that already
      const Grain &first = grains_[batch.i[slot]], &second = grains_[batch.j[slot]];
      const Eigen::Vector3d across(p.across[0][slot], p.across[1][slot], p.across[2][slot]);
      CommonNormal contact;
      contact.depth = p.height[slot];
      feature.touching = 0;
      const bool touches = p.ends[slot] == Stepped::neither &&
                           descend_on(turned(first), turned(second), across, feature, contact);
      Overlap o;
      batch.touches[slot] = take<measures>(touches, first, second, across, contact, feature, o);
      if (touches) put_overlap(o, batch, slot);
    }
    p.count = 0;
  }
  static Overlap overlap_of(const Batch& batch, int slot) {
    const OverlapBatch& from = batch.overlaps;
    const auto vector = [slot](const double(&v)[3][kBatch]) {
      return Eigen::Vector3d(v[0][slot], v[1][slot], v[2][slot]);
    };
    Overlap o;
    o.normal = vector(from.normal);
    o.depth = from.depth[slot];
    o.arm_i = vector(from.arm_i);
    o.arm_j = vector(from.arm_j);
    o.radius = from.radius[slot];
    o.lesser_curvature = from.lesser_curvature[slot];
    o.greater_curvature = from.greater_curvature[slot];
    o.major = vector(from.major);
    return o;
  }

  /// The contact point is in the middle between the surface and the plane.
  template <Measures measures>
  bool overlap_plane(int i, const Body<3>& a, const Plane<3>& plane, Overlap& o) const {
    const double height = plane.height(a.position);
    if (height >= a.radius) return false;
    const Grain& grain = grains_[i];
    const Eigen::Vector3d n = -plane.normal, in_body = grain.turn.transpose() * n;
    const Support s = support_of(grain.shape, in_body);
    if (s.height <= height) return false;
    o.normal = n;
    o.depth = s.height - height;
    o.arm_i = grain.turn * s.point - 0.5 * o.depth * n;
    o.arm_j = Eigen::Vector3d::Zero();  // a wall does not turn
    if constexpr (measures == Measures::curvatures) {
      const Tangents tangents = tangents_of(n);
      const Bend bend = bend_of(s, turned(grain).in_body(tangents));
      const PlanePrincipal relative = relative_curvatures(bend);
      o.radius = grain.equal_radius;
      o.lesser_curvature = relative.lesser;
      o.greater_curvature = relative.greater;
      o.major = across_of(relative, tangents);
    }
    return true;
  }

  void write(CheckpointWriter& w) const { w.put(grains_); }
  void read(CheckpointReader& r, std::size_t grains) {
    r.get(grains_);
    r.require(grains_.size() == grains);
    lanes_.resize(grains);
    fill_lanes();
    ways_.resize(grains);
    places_.resize(grains);
  }

 private:
  struct Grain {
    Superellipsoid shape;
    double farthest = 0, nearest = 0;  ///< points of the surface from the centre, m
    double equal_radius = 0;           ///< of the sphere of equal volume, m
    double lever = 0;  ///< by how much the height of any normal changes a radian at most, m
    double swept = 0;  ///< and what it may have changed by so far, m
    RotationOf<3> rotation = RotationOf<3>::Identity();
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  };

  static Superellipsoid shape_of(const ShapeInput& input) {
    return dem::superellipsoid(input.axes, input.exponents);
  }
  static TurnedBody turned(const Grain& grain) {
    return {grain.shape, grain.turn, grain.farthest, grain.nearest};
  }

  template <Measures measures>
  [[gnu::noinline]] bool put_alone(Batch& batch, int i, const Body<3>& a, int j,
                                   const Eigen::Vector3d& position, Feature& feature) const {
    Overlap o;
    Body<3> b;
    b.position = position;
    if (!overlap<measures>(i, a, j, b, feature, o)) return false;
    put_overlap(o, batch, batch.count);
    batch.touches[batch.count] = true;
    ++batch.count;
    return true;
  }
  /// What a search for a pair's normal has found, as it is remembered and told.
  template <Measures measures>
  static bool take(bool touches, const Grain& first, const Grain& second,
                   const Eigen::Vector3d& across, const CommonNormal& contact, Feature& feature,
                   Overlap& o) {
    feature.clear = std::numeric_limits<double>::infinity();
    if (!touches) {
      // A search that ended exactly in touch tells nothing along the normal that it left.
      if (contact.depth < 0) {
        feature.clear = across.dot(feature.normal) + contact.depth - (first.swept + second.swept);
      }
      return false;
    }
    o.normal = contact.normal;
    o.depth = contact.depth;
    o.arm_i = contact.point;
    o.arm_j = contact.point - across;
    if constexpr (measures == Measures::curvatures) {
      o.radius =
          first.equal_radius * second.equal_radius / (first.equal_radius + second.equal_radius);
      o.lesser_curvature = contact.lesser_curvature;
      o.greater_curvature = contact.greater_curvature;
      o.major = contact.major;
    }
    return true;
  }
  static void put_overlap(const Overlap& o, Batch& batch, int slot) {
    OverlapBatch& to = batch.overlaps;
    for (int k = 0; k < 3; ++k) {
      to.normal[k][slot] = o.normal[k];
      to.arm_i[k][slot] = o.arm_i[k];
      to.arm_j[k][slot] = o.arm_j[k];
      to.major[k][slot] = o.major[k];
    }
    to.depth[slot] = o.depth;
    to.radius[slot] = o.radius;
    to.lesser_curvature[slot] = o.lesser_curvature;
    to.greater_curvature[slot] = o.greater_curvature;
  }
  void fill_lanes() {
    for (std::size_t i = 0; i < grains_.size(); ++i) {
      lanes_[i] = lane_body(turned(grains_[i]), grains_[i].equal_radius);
    }
  }

  std::vector<Grain> grains_;
  std::vector<LaneBody> lanes_;  // the same, for kernels
  std::vector<double> ways_;
  std::vector<Eigen::Vector3d> places_;  // of the last step
};

}  // namespace grainfield::dem
