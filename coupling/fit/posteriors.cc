#include "coupling/fit/posteriors.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace grainfield::coupling {
namespace {

constexpr int kPoints = 101;
constexpr double kReach = 4;  // errors to either side

}  // namespace

std::vector<Section> posterior_sections(const std::vector<const Fit*>& fits, int realizations,
                                        int most) {
  std::vector<Frame> frames;
  for (const Fit* f : fits) {
    for (const FittedParameter& p : f->parameters) {
      if (!(p.covariance_error > 0) || realizations < 2 || static_cast<int>(frames.size()) >= most)
        continue;
      const bool drawn = p.bootstrap_error > 0;
      const double reach = kReach * std::max(p.covariance_error, drawn ? p.bootstrap_error : 0.0);
      const double low = std::max(p.value - reach, p.parameter.least);
      const double high = std::min(p.value + reach, p.parameter.most);
      Frame frame;
      frame.title = fmt::format("{} of {}{}", p.parameter.name, f->name,
                                p.parameter.unit == "-" ? "" : " (" + p.parameter.unit + ")");
      Series covariance{"from the covariance",
                        Eigen::VectorXd::LinSpaced(kPoints, low, high),
                        Eigen::VectorXd(kPoints),
                        {},
                        false};
      Series bootstrap{"from the bootstrap", covariance.x, Eigen::VectorXd(kPoints), {}, false};
      const boost::math::students_t t(realizations - 1.0);
      const boost::math::normal normal;
      for (Eigen::Index k = 0; k < kPoints; ++k) {
        const double off = covariance.x[k] - p.value;
        covariance.y[k] = pdf(t, off / p.covariance_error) / p.covariance_error;
        bootstrap.y[k] =
            drawn ? pdf(normal, off / p.bootstrap_error) / p.bootstrap_error : std::nan("");
      }
      frame.series = {std::move(covariance), std::move(bootstrap)};
      frames.push_back(std::move(frame));
    }
  }
  if (frames.empty()) return {};
  Picture picture =
      curves("What the data say of the constants", "value", "density of probability", frames);
  picture.caption =
      "Densities about the best values: Student's t with the errors from the covariance, and a "
      "normal one with the standard deviation over draws of the realizations. Where the two differ "
      "the errors are uncertain by as much.";
  return {std::move(picture)};
}

}  // namespace grainfield::coupling
