#include "coupling/run/averaging_setup.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace grainfield::coupling {

AverageOptions average_options(const AverageSetup& setup, const std::string& method,
                               double diameter, int threads) {
  AverageOptions out;
  out.method = method;
  out.threads = threads;
  if (method == "coarse_graining") {
    out.kernel = setup.kernel;
    out.width = setup.width > 0 ? setup.width : setup.width_diameters * diameter;
  } else {
    out.kernel = setup.rve_shape;
    out.width = setup.rve_radius > 0 ? setup.rve_radius : setup.rve_diameters * diameter;
  }
  return out;
}

std::vector<AveragedValues> averaged_values(const AverageSetup& setup, std::size_t profiles) {
  const auto number = [](auto n) { return static_cast<double>(n); };
  const double methods = number(setup.methods.size());
  return {{{{"average.map_columns", number(setup.map_columns)},
            {"average.map_rows", number(setup.map_rows)}},
           methods},
          {{{"average.points", number(setup.points)}}, methods * number(profiles)}};
}

std::unique_ptr<Kernel> seeing_kernel(const AverageOptions& options, int dim) {
  if (options.method == "coarse_graining") return make_kernel(options.kernel, options.width, dim);
  const double disk = 2 / std::sqrt(std::numbers::pi), ball = std::cbrt(6 / std::numbers::pi);
  const double side = options.kernel == "square" ? (dim == 3 ? ball : disk) : 1;
  return make_kernel("heaviside", side * options.width, dim);
}

std::string describe(const AverageOptions& options) {
  const bool kernel = options.method == "coarse_graining";
  std::string method = options.method;
  for (char& c : method) {
    if (c == '_') c = ' ';
  }
  return fmt::format("{}, {} {}, {} = {:.3g} m", method, options.kernel,
                     kernel ? "kernel" : "volume", kernel ? "w" : "half width", options.width);
}

}  // namespace grainfield::coupling
