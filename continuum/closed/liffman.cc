#include "continuum/closed/liffman.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "continuum/closed/models.h"
#include "continuum/constants.h"
#include "continuum/settings.h"

namespace grainfield::continuum {
namespace {

constexpr double kRoot3 = std::numbers::sqrt3;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Points this share of the height outside still belong to the heap: the base and the slopes are
// typed in decimal numbers.
constexpr double kOutlineTolerance = 1e-5;
// A line and a slope are parallel when their rises per length differ by less than this.
constexpr double kParallel = 1e-12;

// Length of the line from (x, y) along (dx, sqrt3/2), dx = -+1/2, up to the straight slope
// s x' + c with s <= sqrt 3 in magnitude. A line along the slope itself never ends there.
double length_to(double s, double c, double x, double y, double dx) {
  const double above = s * x + c - y, closing = kRoot3 / 2 - s * dx;
  if (closing < kParallel) {
    const double scale = std::max(std::fabs(c), std::fabs(y));
    return above > -4 * kOutlineTolerance * scale ? kInfinity : 0;
  }
  return std::max(above / closing, 0.0);
}

// A flank's two slopes as seen from its side: the surface is the higher of them where the upper one
// is steeper, else the lower.
template <class Value>
double on_flank(const HeapProfile& heap, Value value) {
  const double t1 = std::tan(heap.alpha), t2 = std::tan(heap.top_alpha);
  const double low = value(t1, t1 * heap.width / 2 - heap.height()), high = value(t2, 0.0);
  if (heap.bend <= 0) return high;
  if (heap.bend >= heap.width / 2 || t1 == t2) return low;
  return t2 > t1 ? std::max(low, high) : std::min(low, high);
}

class Liffman : public Model {
 public:
  Liffman(const HeapProfile& heap, double chi_g, double spacing)
      : heap_(heap), chi_g_(chi_g), spacing_(spacing) {}

  Stresses stress(const Points& points) override {
    Stresses out = Stresses::Constant(points.rows(), 3, kNan);
    const double tolerance = kOutlineTolerance * heap_.height();
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const double x = points(i, 0), y = points(i, 1);
      if (!(y >= -heap_.height() - tolerance && y <= heap_.surface(x) + tolerance)) continue;
      const LineLengths lengths = line_lengths(heap_, x, std::max(y, -heap_.height()));
      const BaseForce f = line_force(lengths, chi_g_);
      const double pressure = f.normal / spacing_;
      out.row(i) << -pressure / 3, -pressure, f.horizontal / spacing_;
    }
    return out;
  }

 private:
  HeapProfile heap_;
  double chi_g_, spacing_;
};

}  // namespace

double HeapProfile::height() const {
  return bend * std::tan(alpha) + (width / 2 - bend) * std::tan(top_alpha);
}

double HeapProfile::surface(double x) const {
  return on_flank(*this, [x](double s, double c) { return c - s * std::fabs(x); });
}

LineLengths line_lengths(const HeapProfile& heap, double x, double y) {
  const auto along = [&](double dx) {
    const double left =
        on_flank(heap, [&](double s, double c) { return length_to(s, c, x, y, dx); });
    const double right =
        on_flank(heap, [&](double s, double c) { return length_to(-s, c, x, y, dx); });
    return std::min(left, right);
  };
  return {along(-0.5), along(0.5)};
}

BaseForce line_force(const LineLengths& lengths, double chi_g) {
  return {chi_g * (lengths.left + lengths.right) / 2,
          chi_g * (lengths.left - lengths.right) / (2 * kRoot3)};
}

BaseForce equilateral_base_force(int layers, int i, double weight) {
  if (i < 1 || i > layers) {
    throw std::invalid_argument(
        fmt::format("grain {} of the base: allowed: 1 to {} layers", i, layers));
  }
  return {(layers + 1) * weight / 2, weight / kRoot3 * (2 * i - layers - 1) / 2};
}

std::vector<BaseForce> lattice_base_forces(const std::vector<int>& rows, double weight,
                                           double tan_theta) {
  for (std::size_t j = 0; j < rows.size(); ++j) {
    const int most = j == 0 ? std::numeric_limits<int>::max() : rows[j - 1] - 1;
    if (rows[j] < 1 || rows[j] > most || (j > 0 && (rows[j - 1] - rows[j]) % 2 == 0)) {
      throw std::invalid_argument(
          fmt::format("row {} of a lattice pile: found {} grains, allowed: 1 or more, and an odd "
                      "number less than the row below",
                      j, rows[j]));
    }
  }
  std::vector<BaseForce> out;
  for (int i = 0; !rows.empty() && i < rows.front(); ++i) {
    // Twice the abscissa in spacings, from the middle; a line moves it by -+1 per row.
    const int at = 2 * i - (rows.front() - 1);
    int n1 = 0, n2 = 0;
    for (std::size_t j = 0; j < rows.size(); ++j) {
      const int reach = rows[j] - 1, up = static_cast<int>(j);
      if (std::abs(at - up) <= reach) ++n1;
      if (std::abs(at + up) <= reach) ++n2;
    }
    out.push_back({weight * (n1 + n2) / 2, weight * tan_theta * (n1 - n2) / 2});
  }
  return out;
}

ModelInfo liffman_info() {
  return {
      "liffman",
      "heap whose weight runs down lattice lines at +-60 degrees",
      2,
      {number("alpha_deg", "deg", "slope of the heap, above 0 and at most 60 (equilateral pile)",
              "Liffman 49", 30, kAboveZero, 60),
       number("chi_g", "N/m", "weight per length of a line of grains, m g / d", "Liffman 60", 1,
              -kUnbounded, kUnbounded),
       number("width", "m", "base B; the base is y = -h, h = width/2 tan(alpha)", "Liffman 49", 1,
              kAboveZero, kUnbounded),
       number("spacing", "m",
              "distance d of the lines along the base: sigma_yy = -N/d; with 1 the stress is the "
              "force N of Liffman 52",
              "Liffman 52", 1, kAboveZero, kUnbounded),
       number("top_alpha_deg", "deg",
              "tent profile: slope above the bend; 0: as alpha_deg, a triangle", "Liffman fig. 18",
              0, 0, 60),
       number("bend", "-",
              "tent profile: distance of the bend from the corner as a share of the width",
              "Liffman fig. 18", 0.25, 0, 0.5)},
      [](const Settings& s) -> std::unique_ptr<Model> {
        HeapProfile heap;
        heap.width = number_of(s, "width");
        heap.alpha = number_of(s, "alpha_deg") * kDegree;
        const double top = number_of(s, "top_alpha_deg") * kDegree;
        heap.top_alpha = top > 0 ? top : heap.alpha;
        heap.bend = number_of(s, "bend") * heap.width;
        return std::make_unique<Liffman>(heap, number_of(s, "chi_g"), number_of(s, "spacing"));
      },
      {},
      [](const std::string& parameter, const Settings& s) -> std::string {
        const double top = number_of(s, "top_alpha_deg"), bend = number_of(s, "bend");
        if (parameter == "bend" && top == 0)
          return "with top_alpha_deg = 0, a triangle; leave it out or set top_alpha_deg";
        if (parameter == "top_alpha_deg" && top != 0 && bend == 0.5)
          return "with bend = 0.5, on the axis; leave it out or set bend below 0.5";
        return {};
      }};
}

}  // namespace grainfield::continuum
