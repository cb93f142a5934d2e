#include "dem/quasistatic/contact_network.h"

#include <limits>
#include <stdexcept>

#include "dem/quasistatic/plane_network.h"
#include "dem/quasistatic/sphere_network.h"
#include "dem/quasistatic/superellipsoid_network.h"

namespace grainfield::dem {

std::unique_ptr<ContactNetwork> make_contact_network(const Snapshot& start,
                                                     const Materials& materials) {
  if (start.dim == 2) return std::make_unique<PlaneNetwork>(start, materials);
  if (start.grains.front().axes.isZero(0)) return std::make_unique<SphereNetwork>(start, materials);
  return std::make_unique<SuperellipsoidNetwork>(start, materials);
}

std::unique_ptr<ContactNetwork> ContactNetwork::part(const std::vector<int>& /*free*/) const {
  throw std::logic_error("a contact network in the plane has no parts");
}

void ContactNetwork::adopt(const ContactNetwork& /*part*/) {
  throw std::logic_error("a contact network in the plane has no parts");
}

double ContactNetwork::mean_resultant(const Vector& r) const {
  double sum = 0;
  for (int k = 0; k < size(); k += per_grain()) {
    sum += dim_ == 2 ? std::hypot(r[k], r[k + 1]) : r.segment<3>(k).norm();
  }
  return sum / free_;
}

double ContactNetwork::mean_moment(const Vector& r) const {
  double sum = 0;
  for (int k = 0; k < size(); k += per_grain()) {
    sum += dim_ == 2 ? std::fabs(r[k + 2]) : r.segment<3>(k + 3).norm();
  }
  return sum / free_;
}

ContactNetwork::Balance ContactNetwork::balance() {
  const Vector zero = Vector::Zero(size());
  Vector r;
  Balance b;
  b.ratio = b.moment_ratio = std::numeric_limits<double>::infinity();
  if (!residual(zero, r)) return b;
  add_contact_forces(b.mean_contact_force, b.contacts);
  if (b.contacts > 0) b.mean_contact_force /= b.contacts;
  for (int k = 0; k < size(); k += per_grain()) {
    if (dim_ == 2) {
      b.mean_unbalanced_force += std::hypot(r[k], r[k + 1]) * scale_;
      b.mean_unbalanced_moment += std::fabs(r[k + 2]) * scale_;
    } else {
      b.mean_unbalanced_force += r.segment<3>(k).norm() * scale_;
      b.mean_unbalanced_moment += r.segment<3>(k + 3).norm() * scale_;
    }
  }
  if (free_ > 0) {
    b.mean_unbalanced_force /= free_;
    b.mean_unbalanced_moment /= free_;
  }
  if (b.mean_contact_force > 0) {
    b.ratio = b.mean_unbalanced_force / b.mean_contact_force;
    b.moment_ratio = b.mean_unbalanced_moment / b.mean_contact_force;
  }
  return b;
}

}  // namespace grainfield::dem
