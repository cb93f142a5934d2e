#include "continuum/closed/cantelaube_asymmetric.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include "continuum/closed/models.h"
#include "continuum/constants.h"
#include "continuum/settings.h"

namespace grainfield::continuum {
namespace {

constexpr double kHalfPi = std::numbers::pi / 2;
// The kink on the yield ray is looked for from 0 outwards in growing steps up to this size (rho g):
// there one half of the core is about 5 degrees wide, and the ends of the yield rays' window are
// not far.
constexpr double kFirstStep = 0.005, kGrowth = 1.1, kLargestKink = 300;
// Slopes up to this share of pi/2 above phi are phi: both are typed or computed in degrees.
constexpr double kEqual = 1e-12;
// The window of yield rays: directions tried across the heap, and halvings at its ends.
constexpr int kScan = 200, kHalvings = 12;

// Coefficients of a cubic Airy function: U = (p x^3 + 3 q x^2 y + 3 r x y^2 + s y^3) / 6.
using Cubic = Eigen::Vector4d;

Cubic cubic_of(const LinearStress& d) { return {d(1, 0), d(1, 1), d(0, 0), d(0, 1)}; }

Cubic kink_cubic(double theta) {
  const double x = std::cos(theta), y = std::sin(theta);
  return {x * x * x, x * x * y, x * y * y, y * y * y};
}

// Stress of the cubic (n.x)^3 / 6.
LinearStress kink_stress(double theta) {
  const double x = std::cos(theta), y = std::sin(theta);
  return Eigen::Vector3d(y * y, x * x, -x * y) * Eigen::RowVector2d(x, y);
}

// The two rays and their kinks.
struct Rays {
  double left = 0, right = 0, left_kink = 0, right_kink = 0;
};

// Sylvester: the rays' normals (1, m) are the roots of the quadratic that is apolar to the cubic.
std::optional<Rays> canonical(const Cubic& u) {
  const double a = u[1] * u[3] - u[2] * u[2], b = u[2] * u[1] - u[0] * u[3],
               c = u[0] * u[2] - u[1] * u[1];
  const double discriminant = b * b - 4 * a * c;
  if (!(discriminant > 0)) return std::nullopt;
  const double half = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  // half = 0 only for b = 0 and discriminant = 0. A root at infinity is a horizontal ray.
  double m1 = half / c, m2 = a / half;
  if (!std::isfinite(m1)) return std::nullopt;
  if (m1 > m2) std::swap(m1, m2);
  Rays out;
  out.left = std::atan(m1);
  out.right = std::atan(m2);
  const double x1 = std::cos(out.left), x2 = std::cos(out.right);
  out.left_kink = (u[0] * m2 - u[1]) / (m2 - m1) / (x1 * x1 * x1);
  out.right_kink = (u[1] - u[0] * m1) / (m2 - m1) / (x2 * x2 * x2);
  return out;
}

// The core of a heap, rho g = 1.
class Core {
 public:
  explicit Core(const AsymmetricHeap& heap)
      : Core(heap, flank_coefficient(heap.phi, heap.left, heap.left_active),
             flank_coefficient(heap.phi, heap.right, heap.right_active)) {}
  // With coefficients of their own: the roots of the heap do not count.
  Core(const AsymmetricHeap& heap, double k_left, double k_right)
      : heap_(heap),
        left_(mirrored(flank_stress(heap.left, k_left))),
        right_(flank_stress(heap.right, k_right)),
        cubic_(cubic_of(right_ - left_)) {}

  std::optional<Rays> linear() const {
    const auto rays = canonical(cubic_);
    if (!rays || !(rays->left > first() && rays->right < last())) return std::nullopt;
    return rays;
  }

  // With the kink on the ray between the core's two boundaries.
  std::optional<Rays> with_kink(double ray, double kink) const {
    const auto rays = canonical(cubic_ - kink * kink_cubic(ray));
    if (!rays ||
        !(rays->left > first() && rays->right < last() && rays->left < ray && rays->right > ray))
      return std::nullopt;
    return rays;
  }

  double yield_on(double ray, const Rays& rays) const {
    const Eigen::Vector2d e(std::sin(ray), -std::cos(ray));
    return yield_residual((left_ + rays.left_kink * kink_stress(rays.left)) * e, heap_.phi);
  }

  // The kink nearest to 0 of the sign for which the ray yields.
  std::optional<double> yielding_kink(double ray, double sign) const {
    double before = 0;
    std::optional<double> residual_before;
    if (const auto rays = with_kink(ray, 0)) residual_before = yield_on(ray, *rays);
    const auto residual = [&](double kink) { return yield_on(ray, *with_kink(ray, kink)); };
    for (double step = kFirstStep, at = step; at < kLargestKink; step *= kGrowth, at += step) {
      const auto rays = with_kink(ray, sign * at);
      if (!rays) {
        if (residual_before) return edge(ray, before, sign * at, *residual_before);
        before = sign * at;
        continue;
      }
      const double here = yield_on(ray, *rays);
      if (residual_before && *residual_before * here <= 0)
        return root(residual, before, sign * at, *residual_before, here);
      residual_before = here;
      before = sign * at;
    }
    return std::nullopt;
  }

  const LinearStress& left() const { return left_; }
  const LinearStress& right() const { return right_; }
  double first() const { return heap_.left - kHalfPi; }
  double last() const { return kHalfPi - heap_.right; }

 private:
  template <class Function>
  static double root(const Function& f, double a, double b, double fa, double fb) {
    if (fa == 0) return a;
    if (fb == 0) return b;
    if (a > b) {
      std::swap(a, b);
      std::swap(fa, fb);
    }
    std::uintmax_t most = 200;
    const auto found = boost::math::tools::toms748_solve(
        f, a, b, fa, fb, boost::math::tools::eps_tolerance<double>(52), most);
    return (found.first + found.second) / 2;
  }

  // The rays leave the heap between `inside` and `outside`: the last kink before that, and the root
  // if there is one on the way.
  std::optional<double> edge(double ray, double inside, double outside, double residual) const {
    double low = inside, high = outside;
    for (int i = 0; i < 200 && low != (low + high) / 2 && high != (low + high) / 2; ++i) {
      const double middle = (low + high) / 2;
      (with_kink(ray, middle) ? low : high) = middle;
    }
    if (low == inside) return std::nullopt;
    const double last = yield_on(ray, *with_kink(ray, low));
    if (residual * last > 0) return std::nullopt;
    return root([&](double kink) { return yield_on(ray, *with_kink(ray, kink)); }, inside, low,
                residual, last);
  }

  AsymmetricHeap heap_;
  LinearStress left_, right_;
  Cubic cubic_;
};

std::string described(const AsymmetricHeap& heap) {
  return fmt::format("phi_deg = {:g}, left_deg = {:g}, right_deg = {:g}", heap.phi / kDegree,
                     heap.left / kDegree, heap.right / kDegree);
}

SectorField one_core(const Core& core, const Rays& rays, double rho_g, double phi) {
  return {{{"left flank", core.first(), rays.left},
           {"core", rays.left, rays.right},
           {"right flank", rays.right, core.last()}},
          {rho_g * core.left(), rho_g * (core.left() + rays.left_kink * kink_stress(rays.left)),
           rho_g * core.right()},
          rho_g,
          phi};
}

SectorField one_core(const AsymmetricHeap& heap, const Core& core, double rho_g) {
  const auto rays = core.linear();
  if (!rays)
    throw BadParameter(fmt::format(
        "model cantelaube_asymmetric: with {} and these roots no linear core fits between the "
        "flanks; allowed: left_root and right_root = active, slopes up to phi_deg",
        described(heap)));
  return one_core(core, *rays, rho_g, heap.phi);
}

SectorField sectors(const Core& core, const Rays& rays, double ray, double kink, double rho_g,
                    double phi) {
  const LinearStress left = core.left() + rays.left_kink * kink_stress(rays.left);
  return SectorField({{"left flank", core.first(), rays.left},
                      {"left core", rays.left, ray},
                      {"right core", ray, rays.right},
                      {"right flank", rays.right, core.last()}},
                     {rho_g * core.left(), rho_g * left, rho_g * (left + kink * kink_stress(ray)),
                      rho_g * core.right()},
                     rho_g, phi);
}

AsymmetricHeap heap_of(const Settings& s) {
  AsymmetricHeap heap;
  const double phi = number_of(s, "phi_deg");
  heap.phi = phi * kDegree;
  for (const char* name : {"left_deg", "right_deg"}) {
    if (number_of(s, name) > phi * (1 + kEqual))
      throw BadParameter(
          fmt::format("model cantelaube_asymmetric: {} = {} is steeper than the friction angle; "
                      "allowed: above 0 and at most phi_deg = {} deg",
                      name, s.at(name), s.at("phi_deg")));
  }
  const auto slope = [&](const char* name) {
    const double degrees = number_of(s, name);
    return std::isnan(degrees) ? heap.phi : std::min(heap.phi, degrees * kDegree);
  };
  heap.left = slope("left_deg");
  heap.right = slope("right_deg");
  heap.left_active = s.at("left_root") == "active";
  heap.right_active = s.at("right_root") == "active";
  return heap;
}

std::unique_ptr<Model> make(const Settings& s) {
  const AsymmetricHeap heap = heap_of(s);
  const std::string& word = s.at("branch");
  const CoreBranch branch = word == "zero"    ? CoreBranch::zero
                            : word == "minus" ? CoreBranch::minus
                                              : CoreBranch::plus;
  const double ray = number_of(s, "yield_ray_deg") * kDegree;
  auto field =
      std::make_unique<SectorField>(asymmetric_field(heap, branch, ray, number_of(s, "rho_g")));
  return std::make_unique<HeapModel>(std::move(field), [](const HeapField& f) {
    const std::size_t last = f.regions().size() - 1;
    const auto on = last == 3 ? std::vector<std::size_t>{2} : std::vector<std::size_t>{};
    return std::map<std::string, double>{{"core_left_deg", -f.regions()[1].from / kDegree},
                                         {"core_right_deg", f.regions().back().from / kDegree},
                                         {"yield_residual", f.off_yield({0, last}, on)}};
  });
}

}  // namespace

double flank_coefficient(double phi, double alpha, bool active) {
  const double ratio = std::cos(phi) / std::cos(alpha);
  // 1 - q without cancellation: sin^2 phi - sin^2 alpha over cos^2 alpha.
  const double rest =
      std::sqrt(std::max(0.0, std::sin(phi - alpha) * std::sin(phi + alpha))) / std::cos(alpha);
  const double root =
      active ? std::cos(phi) / (1 + rest) : std::cos(phi) * (1 + rest) / (ratio * ratio);
  return root * root;
}

LinearStress flank_stress(double phi, double alpha, bool active) {
  return flank_stress(alpha, flank_coefficient(phi, alpha, active));
}

LinearStress flank_stress(double alpha, double k) {
  const double t = std::tan(alpha);
  // Depth below the slope: -t x - y.
  return Eigen::Vector3d(k, 1 + t * t * k, -t * k) * Eigen::RowVector2d(t, 1);
}

std::optional<SectorField> kinked_field(const KinkedCore& heap, double rho_g, double phi) {
  const Core core({phi, heap.left, heap.right, true, true}, heap.k_left, heap.k_right);
  if (heap.kink == 0) {
    const auto rays = core.linear();
    return rays ? std::optional(one_core(core, *rays, rho_g, phi)) : std::nullopt;
  }
  const auto found = core.with_kink(heap.ray, heap.kink);
  if (!found) return std::nullopt;
  return sectors(core, *found, heap.ray, heap.kink, rho_g, phi);
}

std::optional<SectorField> yielding_field(const AsymmetricHeap& heap, CoreBranch branch,
                                          double yield_ray, double rho_g) {
  const Core core(heap);
  if (!(yield_ray > core.first() && yield_ray < core.last())) return std::nullopt;
  const auto kink = core.yielding_kink(yield_ray, branch == CoreBranch::minus ? -1 : 1);
  if (!kink) return std::nullopt;
  const auto found = core.with_kink(yield_ray, *kink);
  if (!found) return std::nullopt;
  return sectors(core, *found, yield_ray, *kink, rho_g, heap.phi);
}

std::optional<std::pair<double, double>> yield_rays(const AsymmetricHeap& heap, CoreBranch branch) {
  const auto exists = [&](double ray) { return yielding_field(heap, branch, ray, 1).has_value(); };
  const double from = heap.left - kHalfPi, step = (kHalfPi - heap.right - from) / kScan;
  int first = 1, last = kScan - 1;
  while (first < kScan && !exists(from + first * step)) ++first;
  while (last > first && !exists(from + last * step)) --last;
  if (first == kScan) return std::nullopt;
  const auto end = [&](double inside, double outside) {
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = (inside + outside) / 2;
      (exists(middle) ? inside : outside) = middle;
    }
    return inside;
  };
  return std::pair(end(from + first * step, from + (first - 1) * step),
                   end(from + last * step, from + (last + 1) * step));
}

SectorField asymmetric_field(const AsymmetricHeap& heap, CoreBranch branch, double yield_ray,
                             double rho_g) {
  if (branch == CoreBranch::zero) return one_core(heap, Core(heap), rho_g);
  if (auto field = yielding_field(heap, branch, yield_ray, rho_g)) return std::move(*field);
  const auto rays = yield_rays(heap, branch);
  throw BadParameter(fmt::format(
      "model cantelaube_asymmetric: with {} no core of branch {} yields on the ray yield_ray_deg = "
      "{:g}; allowed: {}",
      described(heap), branch == CoreBranch::minus ? "minus" : "plus", yield_ray / kDegree,
      rays ? fmt::format("{:.2f} to {:.2f} deg", rays->first / kDegree, rays->second / kDegree)
           : "other slopes, or branch = zero"));
}

ModelInfo cantelaube_asymmetric_info() {
  return {
      "cantelaube_asymmetric",
      "heap with two slopes: plastic flanks, one linear core or one that yields on an inner ray",
      2,
      {may_be_free(number("phi_deg", "deg", "friction angle, at least as large as the slopes",
                          "Roul 4.2", 28, 1, 80),
                   1, 75),
       optional_number("left_deg", "deg", "slope on the left; unset: phi_deg", "Roul 4.3",
                       kAboveZero, 80),
       optional_number("right_deg", "deg", "slope on the right; unset: phi_deg", "Roul 4.3",
                       kAboveZero, 80),
       weight(),
       choice("branch",
              "zero: one linear core, which continuity determines; minus, plus: a core that yields "
              "on an inner ray, with a dip or a peak there",
              "Roul, below 4.12", {"zero", "minus", "plus"}),
       only_with(
           may_be_free(
               number("yield_ray_deg", "deg",
                      "branches minus and plus: angle of the inner ray from the downward vertical, "
                      "positive to the right",
                      "Roul 4.3", 0, -89, 89),
               -89, 89),
           "branch", {"minus", "plus"}),
       choice("left_root",
              "which root of the yield condition the left flank takes; the same at "
              "slope phi_deg",
              "Mohr-Coulomb", {"active", "passive"}),
       choice("right_root", "which root the right flank takes", "Mohr-Coulomb",
              {"active", "passive"})},
      make,
      heap_figures({{"core_left_deg", "deg", "ray between core and left flank, from the vertical"},
                    {"core_right_deg", "deg", "ray between core and right flank"},
                    yield_figure("flanks and a yielding inner ray")})};
}

}  // namespace grainfield::continuum
