#include "dem/run/soft_snapshot.h"

#include <cstdint>
#include <numbers>

namespace grainfield::dem {

std::vector<Grain> grains_of(const std::vector<Body<2>>& bodies,
                             const std::vector<double>& angles) {
  std::vector<Grain> out;
  out.reserve(bodies.size());
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const Body<2>& b = bodies[k];
    Grain g;
    g.id = static_cast<std::int64_t>(k);
    g.position = {b.position.x(), b.position.y(), 0};
    g.velocity = {b.velocity.x(), b.velocity.y(), 0};
    g.angle = angles[k];
    g.spin = b.spin;
    g.radius = b.radius;
    g.mass = 1 / b.inverse_mass;
    g.inertia = 0.5 * g.mass * b.radius * b.radius;
    g.volume = std::numbers::pi * b.radius * b.radius;
    g.rotates = b.inverse_inertia > 0;
    out.push_back(g);
  }
  return out;
}

Contact contact_of(const SoftTouch& touch, const std::vector<Grain>& grains) {
  const Grain& grain = grains[static_cast<std::size_t>(touch.i)];
  const auto& n = touch.normal;
  Contact c;
  c.i = touch.i;
  c.j = touch.j;
  c.normal = {n.x(), n.y(), 0};
  c.point = grain.position + (grain.radius - (touch.j < 0 ? 1 : 0.5) * touch.overlap) * c.normal;
  c.normal_force = touch.repulsion;
  c.tangential_force = c.spring = touch.tangential;
  c.force = Vec3(-touch.repulsion * n.x() - touch.tangential * n.y(),
                 -touch.repulsion * n.y() + touch.tangential * n.x(), 0);
  return c;
}

}  // namespace grainfield::dem
