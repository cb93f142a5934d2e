#include "coupling/strain/strain.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "coupling/base/unknown_name.h"
#include "coupling/statistics/parallel.h"
#include "coupling/strain/measure.h"

namespace grainfield::coupling {
namespace {

using Verdict = GradientFit::Verdict;

void check(const MeasureEntry& measure, int dim, const Eigen::MatrixXd& points,
           const StrainOptions& options) {
  if (std::find(measure.supports.begin(), measure.supports.end(), options.support) ==
      measure.supports.end())
    throw std::invalid_argument(unknown_name("support of strain measure " + measure.name,
                                             options.support, measure.supports));
  if (!(options.width > 0) || !std::isfinite(options.width))
    throw std::invalid_argument(fmt::format(
        "strain width is {} m; it must be positive (some grain diameters)", options.width));
  if (!(options.step >= 0) || !std::isfinite(options.step))
    throw std::invalid_argument(
        fmt::format("strain step is {} m; it must be positive, or 0 for the width", options.step));
  if (options.least_grains < 1)
    throw std::invalid_argument(
        fmt::format("strain from at least {} grains; it must be 1 or more", options.least_grains));
  if (!(options.largest_condition > 1))
    throw std::invalid_argument(
        fmt::format("largest condition of the strain's matrix is {}; it must be above 1",
                    options.largest_condition));
  if (options.threads < 1)
    throw std::invalid_argument(
        fmt::format("strain on {} threads; at least 1 is needed", options.threads));
  if (points.cols() != dim)
    throw std::invalid_argument(fmt::format("points have {} coordinates; the {}D snapshots need {}",
                                            points.cols(), dim, dim));
  if (!points.allFinite()) throw std::invalid_argument("points hold a value that is not finite");
}

struct Values {
  std::vector<std::pair<std::string, std::string>> names;  // with units
  Eigen::MatrixXd rows;                                    // points x columns
};

// Names of everything that is written per point, in the order of put().
Values columns_for(int dim, Eigen::Index points) {
  const std::string axes = "xyz";
  const auto axis = [&](int k) { return axes[static_cast<std::size_t>(k)]; };
  Values values;
  for (int i = 0; i < dim; ++i) values.names.emplace_back(fmt::format("u_{}", axis(i)), "m");
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      values.names.emplace_back(fmt::format("du_{}_d{}", axis(i), axis(j)), "1");
  for (int i = 0; i < dim; ++i)
    values.names.emplace_back(fmt::format("strain_{}{}", axis(i), axis(i)), "1");
  if (dim == 3) {
    values.names.insert(values.names.end(), {{"strain_yz", "1"}, {"strain_xz", "1"}});
  }
  values.names.emplace_back("strain_xy", "1");
  if (dim == 3)
    values.names.insert(values.names.end(),
                        {{"rotation_x", "1"}, {"rotation_y", "1"}, {"rotation_z", "1"}});
  else
    values.names.emplace_back("rotation", "1");
  for (const char* name : {"grains", "contacts", "condition", "misfit"})
    values.names.emplace_back(name, "1");
  values.rows = Eigen::MatrixXd::Constant(points, static_cast<Eigen::Index>(values.names.size()),
                                          std::numeric_limits<double>::quiet_NaN());
  return values;
}

void put(const GradientFit& fit, int dim, Eigen::Index point, Eigen::MatrixXd& rows) {
  Eigen::Index column = 0;
  const auto next = [&](double value) { rows(point, column++) = value; };
  if (fit.verdict == Verdict::good) {
    const Eigen::MatrixXd& g = fit.gradient;
    for (int i = 0; i < dim; ++i) next(fit.displacement[i]);
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) next(g(i, j));
    for (int i = 0; i < dim; ++i) next(g(i, i));
    if (dim == 3) {
      next((g(1, 2) + g(2, 1)) / 2);
      next((g(0, 2) + g(2, 0)) / 2);
    }
    next((g(0, 1) + g(1, 0)) / 2);
    if (dim == 3) {
      next((g(2, 1) - g(1, 2)) / 2);
      next((g(0, 2) - g(2, 0)) / 2);
    }
    next((g(1, 0) - g(0, 1)) / 2);
  }
  column = rows.cols() - 4;
  next(fit.grains);
  next(fit.contacts);
  next(fit.condition);
  next(fit.misfit);
}

std::string place(const Eigen::MatrixXd& points, Eigen::Index p) {
  std::vector<std::string> text;
  for (Eigen::Index k = 0; k < points.cols(); ++k)
    text.push_back(fmt::format("{:.6g}", points(p, k)));
  return fmt::format("({})", fmt::join(text, ", "));
}

}  // namespace

std::string StrainResult::report() const {
  if (too_few.empty() && degenerate.empty()) return "";
  std::string text = fmt::format(
      "{} of {} points have no strain:", too_few.size() + degenerate.size(), field.points.rows());
  if (!too_few.empty())
    text +=
        fmt::format(" {} with too few grains or contacts (first at {} m: {} grains, {} contacts)",
                    too_few.size(), place(field.points, too_few.front()),
                    field.find("grains")->value[too_few.front()],
                    field.find("contacts")->value[too_few.front()]);
  if (!degenerate.empty())
    text += fmt::format("{} {} with a degenerate arrangement (first at {} m: condition {:.3g})",
                        too_few.empty() ? "" : ",", degenerate.size(),
                        place(field.points, degenerate.front()),
                        field.find("condition")->value[degenerate.front()]);
  return text;
}

StrainResult strain(const dem::Snapshot& before, const dem::Snapshot& after,
                    const Eigen::MatrixXd& points, const StrainOptions& options) {
  const MeasureEntry& entry = find_measure(options.measure);
  check(entry, before.dim, points, options);
  const GrainMotion motion = grain_motion(before, after);
  const auto measure = entry.make(motion, options);
  const Eigen::Index n = points.rows();
  Values values = columns_for(before.dim, n);
  std::vector<Verdict> verdicts(static_cast<std::size_t>(n));
  in_parts(n, options.threads, [&](Eigen::Index first, Eigen::Index last) {
    for (Eigen::Index p = first; p < last; ++p) {
      const GradientFit fit = measure->at(points.row(p).transpose());
      verdicts[static_cast<std::size_t>(p)] = fit.verdict;
      put(fit, before.dim, p, values.rows);
    }
  });

  StrainResult result;
  result.images = motion.images;
  result.doubt = motion.doubt;
  result.field.points = points;
  for (std::size_t c = 0; c < values.names.size(); ++c)
    result.field.add(values.names[c].first, values.names[c].second).value =
        values.rows.col(static_cast<Eigen::Index>(c));
  result.field.attributes = {{"what", "displacement gradient, after - before"},
                             {"measure", entry.name},
                             {"support", options.support},
                             {"width", options.width},
                             {"sign", "extension positive"}};
  for (Eigen::Index p = 0; p < n; ++p) {
    if (verdicts[static_cast<std::size_t>(p)] == Verdict::too_few) result.too_few.push_back(p);
    if (verdicts[static_cast<std::size_t>(p)] == Verdict::degenerate)
      result.degenerate.push_back(p);
  }
  return result;
}

}  // namespace grainfield::coupling
