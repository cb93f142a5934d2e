// What acts between two bodies, or a body and a wall: overlap, law, force.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "dem/laws/contact.h"
#include "dem/laws/materials.h"
#include "dem/space/kinematics.h"
#include "dem/space/plane.h"

namespace grainfield::dem {

/// Laws put between the shapes, by the materials (`kind`) of the bodies. Knows of two bodies at a
/// time, and of what their pair remembers.
template <class Shape, class Law>
class Interaction {
 public:
  static constexpr int dim = Shape::dim;
  static constexpr bool central = Shape::central;
  using Body = dem::Body<dim>;
  using Overlap = typename Shape::Overlap;
  using Feature = typename Shape::Feature;
  using Memory = typename Law::template Memory<dim>;
  using Rule = typename Rules<Law>::Rule;

  Interaction() = default;
  explicit Interaction(const Rules<Law>& rules) : rules_(rules), grains_(rules.count(), false) {}

  /// Grains of this kind are there from now on. Throws std::invalid_argument when a pair with what
  /// is there already is missing.
  void add_grain(int kind) {
    if (grains_[kind]) return;
    rules_.require(kind, kind);
    for (int other = 0; other < rules_.count(); ++other) {
      if (grains_[other]) rules_.require(kind, other);
    }
    for (const int wall : wall_kinds_) rules_.require(kind, wall < 0 ? kind : wall);
    grains_[kind] = true;
  }
  /// The next wall, with its kind or (-1) with its own friction and each grain's own law. Throws
  /// likewise.
  void add_wall(int kind, double friction) {
    for (int grain = 0; grain < rules_.count(); ++grain) {
      if (grains_[grain] && kind >= 0) rules_.require(grain, kind);
    }
    wall_kinds_.push_back(kind);
    for (int grain = 0; grain < rules_.count(); ++grain) {
      Rule rule = rules_.of(grain, kind < 0 ? grain : kind);
      if (kind < 0) rule.friction = friction;
      wall_rules_.push_back(rule);
    }
  }

  int kinds() const { return rules_.count(); }
  /// Its name; "" where there is one without a name.
  std::string material(int kind) const { return rules_.name(kind); }
  const Rule& rule(int kind_i, int kind_j) const { return rules_.of(kind_i, kind_j); }
  const Rule& wall_rule(int kind, int wall) const {
    return wall_rules_[static_cast<std::size_t>(wall) * rules_.count() + kind];
  }

  /// At rest, of infinite mass: what a wall is to the laws.
  static const Body& wall_body() { return kWall; }

  bool overlap(const Shape& shapes, int i, const Body& a, int j, const Body& b, Feature& feature,
               Overlap& o) const {
    return shapes.template overlap<Law::measures>(i, a, j, b, feature, o);
  }
  /// With the image of j that is `shift` away; b is there already.
  bool overlap_image(const Shape& shapes, int i, const Body& a, int j, const Body& b,
                     const VectorOf<dim>& shift, Feature& feature, Overlap& o) const {
    if constexpr (requires {
                    shapes.template overlap_image<Law::measures>(i, a, j, b, shift, feature, o);
                  }) {
      return shapes.template overlap_image<Law::measures>(i, a, j, b, shift, feature, o);
    } else {
      static_assert(!Shape::outlines, "a shape with corners must have overlap_image");
      return overlap(shapes, i, a, j, b, feature, o);
    }
  }
  bool overlap(const Shape& shapes, int i, const Body& a, const Plane<dim>& wall,
               Overlap& o) const {
    return shapes.template overlap_plane<Law::measures>(i, a, wall, o);
  }

  /// Force of bodies that overlap. The memory advances by dt, s; with dt = 0 it stays.
  static ContactForce<dim> force(const Rule& rule, const Body& a, const Body& b, const Overlap& o,
                                 double dt, Memory& memory) {
    const ContactMotion<dim> motion = motion_at<central>(a, b, o);
    if constexpr (dim == 3 && central) {
      turn_with_contact(memory.spring, o.normal, twist_of(a, b, o, dt), o);
    } else if constexpr (dim == 3) {
      turn_with_material(memory.spring, o.normal, 0.5 * dt * (a.spin + b.spin));
    }
    const LawForce<dim> f = rule.law(o, motion, rule.friction, dt, memory);
    return forces_at<central>(o, f.normal, f.tangential);
  }
  /// Adds the moments against rolling and twisting (rolling.h) to such a force `f`, N m, and
  /// returns that on a. The memory advances by dt, s.
  static SpinOf<dim> roll(const Rule& rule, const Body& a, const Body& b, const Overlap& o,
                          double dt, RollingMemory<dim>& memory, ContactForce<dim>& f) {
    const SpinOf<dim> moment = rule.rolling.moment(a, b, o, repulsion_of(f.force, o), dt, memory);
    f.torque_i += moment;
    f.torque_j -= moment;
    return moment;
  }

 private:
  inline static const Body kWall{};

  Rules<Law> rules_;
  std::vector<bool> grains_;      // kinds that are there
  std::vector<int> wall_kinds_;   // of the walls in their order
  std::vector<Rule> wall_rules_;  // by wall, then by the grain's kind
};

}  // namespace grainfield::dem
