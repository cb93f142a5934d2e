#include "continuum/closed/heap_field.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "continuum/constants.h"

namespace grainfield::continuum {
namespace {

// Points this share of their distance from the apex outside a slope still belong to the heap: they
// are typed or computed on it.
constexpr double kOnSlope = 1e-9;
// Directions inside of a region in which the largest mobilised friction is looked for, besides its
// two rays.
constexpr int kDirections = 64;

Eigen::Vector2d normal_of(double theta) { return {std::cos(theta), std::sin(theta)}; }

}  // namespace

HeapField::HeapField(std::vector<HeapRegion> regions, double rho_g, double phi)
    : regions_(std::move(regions)), rho_g_(rho_g), phi_(phi) {
  for (const double theta : rays()) normals_.push_back(normal_of(theta));
}

std::vector<double> HeapField::rays() const {
  std::vector<double> out{regions_.front().from};
  for (const HeapRegion& region : regions_) out.push_back(region.to);
  return out;
}

int HeapField::region_of(double x, double y) const {
  const Eigen::Vector2d p(x, y);
  const double slack = kOnSlope * p.norm();
  if (!(y <= 0 && normals_.front().dot(p) >= -slack && normals_.back().dot(p) <= slack)) return -1;
  int region = 0;
  const int last = static_cast<int>(regions_.size()) - 1;
  while (region < last && normals_[static_cast<std::size_t>(region) + 1].dot(p) >= 0) ++region;
  return region;
}

// A field that grows in proportion along rays is its gradient times the position (Euler).
Eigen::Vector3d HeapField::stress(double x, double y) const {
  const int region = region_of(x, y);
  if (region < 0) return Eigen::Vector3d::Constant(kNan);
  return gradient(static_cast<std::size_t>(region), x, y) * Eigen::Vector2d(x, y);
}

Stresses HeapField::stress(const Points& points) const {
  Stresses out(points.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    out.row(i) = stress(points(i, 0), points(i, 1)).transpose();
  }
  return out;
}

Eigen::Vector2d HeapField::equilibrium_residual(std::size_t region, double x, double y) const {
  const LinearStress g = gradient(region, x, y);
  return {g(0, 0) + g(2, 1), g(2, 0) + g(1, 1) - rho_g_};
}

double HeapField::jump(std::size_t ray) const {
  const double theta = regions_[ray].from;
  const Eigen::Vector2d e(std::sin(theta), -std::cos(theta));
  return ((gradient(ray, e.x(), e.y()) - gradient(ray - 1, e.x(), e.y())) * e)
      .cwiseAbs()
      .maxCoeff();
}

Eigen::Vector3d HeapField::inside(std::size_t region, double share) const {
  const HeapRegion& at = regions_[region];
  const bool first = share == 0, last = share == 1;
  const double theta = first ? at.from : last ? at.to : at.from + (at.to - at.from) * share;
  const Eigen::Vector2d e(std::sin(theta), -std::cos(theta));
  const LinearStress g = gradient(region, e.x(), e.y());
  if (first && region == 0) return g * normal_of(theta);
  if (last && region + 1 == regions_.size()) return -g * normal_of(theta);
  return g * e;
}

// In a linear field radius^2 over centre^2 is a quadratic function of 1/centre with a positive
// leading coefficient (the radius' square where the centre vanishes): where the centre keeps its
// sign it is largest on one of the two rays.
double HeapField::largest_mobilised() const {
  double largest = 0;
  for (std::size_t k = 0; k < regions_.size(); ++k) {
    for (int i = 0; i <= kDirections + 1; ++i) {
      const Eigen::Vector3d s = inside(k, static_cast<double>(i) / (kDirections + 1));
      if (s.hasNaN()) return kNan;
      largest = std::max(
          largest, s[0] + s[1] < 0 ? mobilised_sine(s) : std::numeric_limits<double>::infinity());
    }
  }
  return largest / std::sin(phi_);
}

double HeapField::largest_imbalance() const {
  double largest = 0;
  for (std::size_t k = 0; k < regions_.size(); ++k) {
    const double from = regions_[k].from, width = regions_[k].to - from;
    for (int i = 0; i < kDirections; ++i) {
      const double theta = from + width * (i + 0.5) / kDirections;
      largest =
          std::max(largest, equilibrium_residual(k, std::sin(theta), -std::cos(theta)).norm());
    }
  }
  return largest / rho_g_;
}

double HeapField::off_yield(const std::vector<std::size_t>& in,
                            const std::vector<std::size_t>& on) const {
  double largest = 0;
  const auto add = [&](const Eigen::Vector3d& s) {
    largest = std::max(largest, std::fabs(mobilised_sine(s) / std::sin(phi_) - 1));
  };
  for (const std::size_t k : in)
    for (int i = 0; i < kDirections; ++i) add(inside(k, (i + 0.5) / kDirections));
  for (const std::size_t ray : on) {
    add(inside(ray - 1, 1));
    add(inside(ray, 0));
  }
  return largest;
}

SectorField::SectorField(std::vector<HeapRegion> regions, std::vector<LinearStress> fields,
                         double rho_g, double phi)
    : HeapField(std::move(regions), rho_g, phi), fields_(std::move(fields)) {}

LinearStress SectorField::gradient(std::size_t region, double, double) const {
  return fields_[region];
}

LinearStress mirrored(const LinearStress& field) {
  LinearStress out = field;
  out(0, 0) = -field(0, 0);
  out(1, 0) = -field(1, 0);
  out(2, 1) = -field(2, 1);
  return out;
}

double yield_residual(const Eigen::Vector3d& s, double phi) {
  const double difference = s[0] - s[1], sum = (s[0] + s[1]) * std::sin(phi);
  return difference * difference + 4 * s[2] * s[2] - sum * sum;
}

double mobilised_sine(const Eigen::Vector3d& s) {
  return std::hypot(s[0] - s[1], 2 * s[2]) / std::fabs(s[0] + s[1]);
}

HeapModel::HeapModel(std::unique_ptr<HeapField> field, std::function<Figures(const HeapField&)> own)
    : field_(std::move(field)), own_(std::move(own)) {}

HeapModel::Figures HeapModel::figures() const {
  Figures out = own_(*field_);
  out["equilibrium_residual"] = field_->largest_imbalance();
  out["mobilised_sine_ratio"] = field_->largest_mobilised();
  const auto& regions = field_->regions();
  for (std::size_t k = 1; k < regions.size(); ++k) {
    out[fmt::format("ray_{}_deg", k)] = regions[k].from * 180 / std::numbers::pi;
  }
  return out;
}

Figure yield_figure(const std::string& where) {
  return {
      "yield_residual", "-",
      "largest |sin(mobilised friction angle)/sin(phi) - 1| where the field is to yield: " + where};
}

std::vector<Figure> heap_figures(std::vector<Figure> own) {
  own.push_back({"equilibrium_residual", "-",
                 "largest |div sigma - (0, rho g)| over rho g, of samples inside the heap"});
  own.push_back({"mobilised_sine_ratio", "-",
                 "largest sin(mobilised friction angle)/sin(phi): above 1 the limit of friction is "
                 "exceeded somewhere, inf: the heap pulls somewhere"});
  own.push_back(
      {"ray_*_deg", "deg", "ray between two regions, counted from the left, from the vertical"});
  return own;
}

}  // namespace grainfield::continuum
