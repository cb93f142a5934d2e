// What acts between two bodies, or a body and a wall: overlap, law, force.
#pragma once
#include "dem/engine/walls.h"
#include "dem/laws/contact.h"
#include "dem/space/kinematics.h"

namespace grainfield::dem {

/// The law put between the shapes: needs nothing but two bodies and what their pair remembers.
template <class Shape, class Law>
struct Interaction {
  static constexpr int dim = Shape::dim;
  static constexpr bool central = !Shape::outlines;
  using Body = dem::Body<dim>;
  using Overlap = typename Shape::Overlap;
  using Feature = typename Shape::Feature;
  using Memory = typename Law::template Memory<dim>;

  Law law;
  double friction = 0;  ///< grain on grain

  /// At rest, of infinite mass: what a wall is to the laws.
  static const Body& wall_body() {
    static const Body kWall{};
    return kWall;
  }

  bool overlap(const Shape& shapes, int i, const Body& a, int j, const Body& b, Feature& feature,
               Overlap& o) const {
    return shapes.template overlap<Law::needs_area>(i, a, j, b, feature, o);
  }
  bool overlap(const Shape& shapes, int i, const Body& a, const Plane<dim>& wall,
               Overlap& o) const {
    return shapes.template overlap_plane<Law::needs_area>(i, a, wall, o);
  }

  /// Force of bodies that overlap. The memory advances by dt, s; with dt = 0 it stays.
  ContactForce<dim> force(const Body& a, const Body& b, const Overlap& o, double mu, double dt,
                          Memory& memory) const {
    const ContactMotion<dim> motion = motion_at<central>(a, b, o);
    const LawForce<dim> f = law(o, motion, mu, dt, memory);
    return forces_at<central>(o, f.normal, f.tangential);
  }
};

}  // namespace grainfield::dem
