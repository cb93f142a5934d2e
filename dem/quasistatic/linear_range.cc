#include "dem/quasistatic/linear_range.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace grainfield::dem {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// The least s > 0 with a s^2 + 2 b s + c = 0 for c < 0, without cancellation.
double first_root(double a, double b, double c) {
  const double square = b * b - a * c;
  if (!(square >= 0)) return kNever;
  const double root = std::sqrt(square);
  if (b > 0) return -c / (b + root);
  return a > 0 ? (root - b) / a : kNever;
}

double opening(const Contact& rest, const Contact& change) {
  return change.normal_force < 0 ? rest.normal_force / -change.normal_force : kNever;
}

double sliding(const Contact& rest, const Contact& change) {
  if (rest.sliding || !(rest.friction > 0)) return kNever;
  const double normal = rest.friction * rest.normal_force, by = rest.friction * change.normal_force;
  const Vec3 along = rest.force + rest.normal_force * rest.normal;
  const Vec3 added = change.force + change.normal_force * rest.normal;
  const double left = along.squaredNorm() - normal * normal;
  if (left >= 0) return kNever;  // slides to the last digit
  return first_root(added.squaredNorm() - by * by, along.dot(added) - normal * by, left);
}

}  // namespace

double LinearRange::changed(double share) const {
  if (changes.empty()) return kNever;
  const double count = std::ceil(share * static_cast<double>(changes.size()));
  const auto last = static_cast<double>(changes.size() - 1);
  return changes[static_cast<std::size_t>(std::clamp(count - 1, 0.0, last))];
}

LinearRange linear_range(const Snapshot& rest, const Snapshot& change) {
  if (rest.contacts.size() != change.contacts.size())
    throw std::invalid_argument("linear range: found a change of other contacts");
  LinearRange out;
  for (std::size_t k = 0; k < rest.contacts.size(); ++k) {
    const Contact &before = rest.contacts[k], &by = change.contacts[k];
    if (!(before.normal_force > 0)) continue;
    const double opens = opening(before, by), slides = sliding(before, by);
    out.opens = std::min(out.opens, opens);
    out.slides = std::min(out.slides, slides);
    out.changes.push_back(std::min(opens, slides));
  }
  std::ranges::sort(out.changes);
  return out;
}

}  // namespace grainfield::dem
