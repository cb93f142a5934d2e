#include "coupling/studies/sample/path_figures.h"

#include <algorithm>
#include <cmath>

#include "continuum/constants.h"
#include "dem/study/sample_path.h"

namespace grainfield::coupling {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

double slope(const VectorXd& strain, const VectorXd& stress, Index from, Index to) {
  return (stress[to] - stress[from]) / (strain[to] - strain[from]);
}

// The first state of the loading at a tenth of its strain or beyond.
Index first_after_start(Index end) { return std::max<Index>(1, (end + 9) / 10); }

double area_under(const VectorXd& strain, const VectorXd& stress, Index from, Index to) {
  double area = 0;
  for (Index k = from; k < to; ++k) {
    area += 0.5 * (stress[k] + stress[k + 1]) * (strain[k + 1] - strain[k]);
  }
  return area;
}

// Strain at which the stress falls to `level` after state `from`, by straight lines; nan: never.
double strain_at_fall(const VectorXd& strain, const VectorXd& stress, Index from, double level) {
  for (Index k = from + 1; k < stress.size(); ++k) {
    if (stress[k] > level) continue;
    const double share = (stress[k - 1] - level) / (stress[k - 1] - stress[k]);
    return strain[k - 1] + share * (strain[k] - strain[k - 1]);
  }
  return kNan;
}

}  // namespace

std::map<std::string, std::vector<double>> path_figures(const StateTable& table,
                                                        const dem::SamplePlan& plan) {
  std::map<std::string, std::vector<double>> out;
  const char* axial = plan.dim == 2 ? "sigma_yy" : "sigma_zz";
  const Index end = plan.records;
  for (Index r = 0; r < table.realizations(); ++r) {
    const auto column = [&](const std::string& name) -> VectorXd { return table.of(name).col(r); };
    const auto put = [&](const char* key, double value) {
      out[std::string("sample.") + key].push_back(value);
    };
    const VectorXd strain = column("strain"), p = column("p");
    const VectorXd kinetic = column("kinetic_energy"), elastic = column("elastic_energy");
    put("kinetic_share", (kinetic.array() / elastic.array()).tail(kinetic.size() - 1).maxCoeff());
    const Index started = first_after_start(end);
    const auto largest_late = [&](const VectorXd& values) {
      return values.segment(started, end - started + 1).maxCoeff();
    };
    put("late_kinetic_share", largest_late(kinetic.cwiseQuotient(elastic)));
    put("late_inertial_number", largest_late(column("inertial_number")));
    put("pressure_ratio", p[end] / p[0]);
    if (dem::shears(plan)) {
      const char* shear = plan.dim == 2 ? "sigma_xy" : "sigma_xz";
      put("shear_over_pressure", column(shear)[end] / p[0]);
      put("first_shear_stiffness", slope(strain, column(shear), 0, 1) / p[0]);
      if (plan.constant == "volume") {  // a held stress has no least value
        Index least = 0;
        column(axial).head(end + 1).maxCoeff(&least);
        put("axial_dip_strain", strain[least] / 2);
      }
    }
    const VectorXd inside = -column(axial);
    if (plan.deformation == "uniaxial") {
      put("end_stress_ratio", column("q_over_p")[end]);
      if (plan.dim == 3) put("end_axial_stress_ratio", column("axial_q_over_p")[end]);
      if (end >= 2) {
        put("stiffening", slope(strain, inside, end / 2, end) / slope(strain, inside, 0, end / 2));
      }
      if (end >= 4) {
        put("stiffening_late",
            slope(strain, inside, 3 * end / 4, end) / slope(strain, inside, end / 4, end / 2));
      }
    }
    if (!dem::unloads(plan) || dem::shears(plan)) continue;
    const VectorXd outside = dem::is_periodic(plan) ? inside : column("pressure_on_lid");
    const double unloaded = std::max(outside[0], dem::kLeastUnloaded * outside[end]);
    const double plastic = strain_at_fall(strain, outside, end, unloaded);
    if (std::isfinite(plastic)) put("plastic_strain", plastic);
    const Index late = std::min<Index>(end - 1, 3 * end / 4);
    const Index middle = end + std::max<Index>(1, plan.unload_records / 2);
    put("unloading_stiffness",
        slope(strain, outside, end, middle) / slope(strain, outside, late, end));
    const double loaded = area_under(strain, outside, 0, end);
    put("loop_loss", (loaded + area_under(strain, outside, end, strain.size() - 1)) / loaded);
    put("residual_stress", inside[inside.size() - 1] / inside[end]);
  }
  return out;
}

}  // namespace grainfield::coupling
