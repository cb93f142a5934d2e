#include "coupling/averaging/average.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>
#include <vector>

#include "coupling/averaging/kernel.h"
#include "coupling/averaging/nearest.h"
#include "coupling/averaging/weights.h"

namespace grainfield::coupling {
namespace {

struct Method {
  std::string name;
  AddBand add;
  const std::vector<std::string>& (*kernels)();
};

const std::vector<Method>& methods() {
  static const std::vector<Method> all{
      {"coarse_graining", add_coarse_graining, kernel_names},
      {"particle_centre", add_particle_centre, support_names},
  };
  return all;
}

const Method& find_method(const AverageOptions& options) {
  std::vector<std::string> names;
  for (const Method& method : methods()) {
    names.push_back(method.name);
    if (method.name != options.method) continue;
    for (const std::string& kernel : method.kernels())
      if (kernel == options.kernel) return method;
    throw std::invalid_argument(
        unknown_name("kernel of " + method.name, options.kernel, method.kernels()));
  }
  throw std::invalid_argument(unknown_name("averaging method", options.method, names));
}

void check(const dem::Snapshot& snapshot, const Eigen::MatrixXd& points,
           const AverageOptions& options) {
  if (!(options.width > 0) || !std::isfinite(options.width))
    throw std::invalid_argument(fmt::format(
        "averaging width is {} m; it must be positive (a grain diameter or more)", options.width));
  if (options.threads < 1)
    throw std::invalid_argument(
        fmt::format("averaging on {} threads; at least 1 is needed", options.threads));
  if (snapshot.dim != 2)
    throw std::invalid_argument(fmt::format(
        "the snapshot is {}D; averaging on points of the plane needs a 2D one", snapshot.dim));
  if (points.cols() != 2)
    throw std::invalid_argument(
        fmt::format("points have {} coordinates; averaging needs 2", points.cols()));
  if (!points.allFinite()) throw std::invalid_argument("points hold a value that is not finite");
}

Field average_in(const dem::Snapshot& snapshot, const LayerFrame& frame,
                 const Eigen::MatrixXd& points, const AverageOptions& options) {
  const Method& method = find_method(options);
  Sums sums = Sums::Zero(points.rows(), kSums);
  // Every point belongs to one thread and sums in the order of grains and contacts.
  const Eigen::Index n = points.rows(),
                     bands = std::max<Eigen::Index>(1, std::min<Eigen::Index>(options.threads, n));
  std::vector<std::thread> threads;
  for (Eigen::Index b = 1; b < bands; ++b)
    threads.emplace_back([&, b] {
      method.add(snapshot, frame, points, n * b / bands, n * (b + 1) / bands, options, sums);
    });
  method.add(snapshot, frame, points, 0, n / bands, options, sums);
  for (std::thread& thread : threads) thread.join();

  for (Eigen::Index p = 0; p < n; ++p)
    if (sums(p, kGrains) < options.least_grains)
      sums.row(p).head<kGrains>().setConstant(std::numeric_limits<double>::quiet_NaN());

  Field field;
  field.points = points;
  const auto put = [&](const char* name, const char* unit, const Eigen::VectorXd& value) {
    field.add(name, unit).value = value;
  };
  // Kinetic stress of the velocities about their local mean: density V V - sum m v v phi.
  const auto kinetic = [&](Sum flux, Sum a, Sum b) -> Eigen::VectorXd {
    Eigen::VectorXd value(n);
    for (Eigen::Index p = 0; p < n; ++p) {
      const double mass = sums(p, kMass);
      value[p] = mass == 0 ? 0 : sums(p, a) * sums(p, b) / mass - sums(p, flux);
    }
    return value;
  };
  put("sigma_xx", "N/m", sums.col(kXX));
  put("sigma_yy", "N/m", sums.col(kYY));
  put("sigma_xy", "N/m", sums.col(kXY));
  put("sigma_yx", "N/m", sums.col(kYX));
  put("kinetic_xx", "N/m", kinetic(kFluxXX, kMomentumX, kMomentumX));
  put("kinetic_yy", "N/m", kinetic(kFluxYY, kMomentumY, kMomentumY));
  put("kinetic_xy", "N/m", kinetic(kFluxXY, kMomentumX, kMomentumY));
  put("density", "kg/m2", sums.col(kMass));
  put("volume_fraction", "1", sums.col(kVolume));
  put("traction_x", "N/m2", sums.col(kTractionX));
  put("traction_y", "N/m2", sums.col(kTractionY));
  put("load_x", "N/m2", sums.col(kLoadX));
  put("load_y", "N/m2", sums.col(kLoadY));
  put("grains", "1", sums.col(kGrains));
  field.attributes = {{"method", options.method},
                      {"kernel", options.kernel},
                      {"width", fmt::format("{} m", options.width)},
                      {"sign", "tension positive"}};
  return field;
}

}  // namespace

void add_grain(const dem::Snapshot& snapshot, const dem::Grain& grain, double weight,
               Eigen::Index point, Sums& sums) {
  const double m = grain.mass * weight, vx = grain.velocity.x(), vy = grain.velocity.y();
  sums(point, kMass) += m;
  sums(point, kVolume) += grain.volume * weight;
  sums(point, kMomentumX) += m * vx;
  sums(point, kMomentumY) += m * vy;
  sums(point, kFluxXX) += m * vx * vx;
  sums(point, kFluxYY) += m * vy * vy;
  sums(point, kFluxXY) += m * vx * vy;
  if (grain.id == snapshot.loaded_grain) {
    sums(point, kLoadX) += weight * snapshot.applied_force.x();
    sums(point, kLoadY) += weight * snapshot.applied_force.y();
  }
  sums(point, kGrains) += 1;
}

Field average(const dem::Snapshot& snapshot, const Eigen::MatrixXd& points,
              const AverageOptions& options) {
  check(snapshot, points, options);
  return average_in(snapshot, layer_frame(snapshot), points, options);
}

void require_same_grains(const dem::Snapshot& unloaded, const dem::Snapshot& loaded) {
  const auto refuse = [](const std::string& why) {
    throw std::invalid_argument("snapshots do not belong together: " + why);
  };
  if (unloaded.dim != loaded.dim)
    refuse(fmt::format("one is {}D, the other {}D", unloaded.dim, loaded.dim));
  if (unloaded.grains.size() != loaded.grains.size())
    refuse(
        fmt::format("{} grains unloaded, {} loaded", unloaded.grains.size(), loaded.grains.size()));
  if (unloaded.walls.size() != loaded.walls.size())
    refuse(fmt::format("{} walls unloaded, {} loaded", unloaded.walls.size(), loaded.walls.size()));
  for (std::size_t g = 0; g < unloaded.grains.size(); ++g) {
    const dem::Grain &a = unloaded.grains[g], &b = loaded.grains[g];
    if (a.id != b.id)
      refuse(fmt::format("grain {} is id {} unloaded, id {} loaded", g, a.id, b.id));
    if (a.radius != b.radius)
      refuse(fmt::format("grain id {} has radius {} m unloaded, {} m loaded", a.id, a.radius,
                         b.radius));
    if (a.outline != b.outline)
      refuse(fmt::format("grain id {} has another outline loaded than unloaded", a.id));
    if (a.fixed != b.fixed) refuse(fmt::format("grain id {} is fixed in one of them only", a.id));
  }
}

Field response(const dem::Snapshot& unloaded, const dem::Snapshot& loaded,
               const Eigen::MatrixXd& points, const AverageOptions& options) {
  require_same_grains(unloaded, loaded);
  check(unloaded, points, options);
  const LayerFrame frame = layer_frame(unloaded);
  const Field before = average_in(unloaded, frame, points, options);
  Field change = average_in(loaded, frame, points, options);
  for (std::size_t c = 0; c < change.columns.size(); ++c) {
    Eigen::VectorXd& value = change.columns[c].value;
    if (change.columns[c].name == "grains")
      value = value.cwiseMin(before.columns[c].value);
    else
      value -= before.columns[c].value;
  }
  change.attributes["what"] = "loaded - unloaded";
  return change;
}

BalanceResidual balance_residual(const dem::Snapshot& snapshot, const Eigen::MatrixXd& points,
                                 const AverageOptions& options, double step) {
  check(snapshot, points, options);
  if (step <= 0) step = options.width * (options.method == "particle_centre" ? 0.5 : 0.05);
  // Nine stencil points each: the point, then -2, -1, 1, 2 steps along x and along y.
  const double offset[4] = {-2, -1, 1, 2}, weight[4] = {1. / 12, -8. / 12, 8. / 12, -1. / 12};
  const Eigen::Index n = points.rows();
  Eigen::MatrixXd stencil(9 * n, 2);
  for (Eigen::Index p = 0; p < n; ++p) {
    stencil.middleRows(9 * p, 9).rowwise() = points.row(p);
    for (int k = 0; k < 4; ++k) {
      stencil(9 * p + 1 + k, 0) += offset[k] * step;
      stencil(9 * p + 5 + k, 1) += offset[k] * step;
    }
  }
  const Field field = average_in(snapshot, layer_frame(snapshot), stencil, options);
  const auto at = [&](const char* name, Eigen::Index row) { return field.find(name)->value[row]; };
  BalanceResidual result;
  result.step = step;
  double density = 0, squares = 0;
  std::vector<Eigen::Vector2d> residuals;
  for (Eigen::Index p = 0; p < n; ++p) {
    const Eigen::Index row = 9 * p;
    const double rho = at("density", row);
    Eigen::Vector2d r = rho * snapshot.gravity.head<2>();
    r += Eigen::Vector2d(at("traction_x", row) + at("load_x", row),
                         at("traction_y", row) + at("load_y", row));
    for (int k = 0; k < 4; ++k) {
      const Eigen::Index x = row + 1 + k, y = row + 5 + k;
      const double xx = at("sigma_xx", x) + at("kinetic_xx", x);
      const double yy = at("sigma_yy", y) + at("kinetic_yy", y);
      const double xy = at("sigma_xy", y) + at("kinetic_xy", y);
      const double yx = at("sigma_yx", x) + at("kinetic_xy", x);
      r += weight[k] / step * Eigen::Vector2d(xx + xy, yx + yy);
    }
    if (!r.allFinite()) continue;
    residuals.push_back(r);
    density += rho;
  }
  result.points = static_cast<int>(residuals.size());
  const double count = static_cast<double>(residuals.size());
  result.rho_g = density / count * snapshot.gravity.norm();
  for (const Eigen::Vector2d& r : residuals) {
    squares += r.squaredNorm();
    result.largest = std::max(result.largest, r.norm() / result.rho_g);
  }
  result.rms = std::sqrt(squares / (2 * count)) / result.rho_g;
  return result;
}

Eigen::MatrixXd line_points(double x0, double x1, int n, double y) {
  return grid_points(x0, x1, n, y, y, 1);
}

Eigen::MatrixXd grid_points(double x0, double x1, int nx, double y0, double y1, int ny) {
  if (nx < 1 || ny < 1)
    throw std::invalid_argument(fmt::format("a grid of {} x {} points; at least 1 x 1", nx, ny));
  Eigen::MatrixXd points(static_cast<Eigen::Index>(nx) * ny, 2);
  const auto between = [](double a, double b, int k, int n) {
    return n == 1 ? a : a + (b - a) * k / (n - 1);
  };
  for (int iy = 0; iy < ny; ++iy)
    for (int ix = 0; ix < nx; ++ix) {
      const Eigen::Index row = ix + static_cast<Eigen::Index>(nx) * iy;
      points(row, 0) = between(x0, x1, ix, nx);
      points(row, 1) = between(y0, y1, iy, ny);
    }
  return points;
}

}  // namespace grainfield::coupling
