#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "continuum/constants.h"
#include "coupling/result/csv.h"
#include "coupling/studies/sample/rve.h"

namespace grainfield::coupling {
namespace {

using Eigen::Matrix3d;
using Of = double (*)(const RveValue&);
using Value = std::optional<double>;

double symmetric(const Matrix3d& m, int a, int b) { return 0.5 * (m(a, b) + m(b, a)); }

struct RveColumn {
  const char *name, *unit, *meaning;
  Of of;
};

const std::vector<RveColumn>& rve_columns() {
  using V = const RveValue&;
  // clang-format off
  static const std::vector<RveColumn> columns{
      {"grains", "", "in an RVE", [](V v) { return v.count; }},
      {"strain_xx", "", "of the hull (Wellmann 30), against the first state, extension positive", [](V v) { return v.hull(0, 0); }},
      {"strain_yy", "", "likewise", [](V v) { return v.hull(1, 1); }},
      {"strain_zz", "", "likewise", [](V v) { return v.hull(2, 2); }},
      {"strain_xy", "", "likewise", [](V v) { return symmetric(v.hull, 0, 1); }},
      {"strain_xz", "", "likewise", [](V v) { return symmetric(v.hull, 0, 2); }},
      {"strain_yz", "", "likewise", [](V v) { return symmetric(v.hull, 1, 2); }},
      {"strain_vol", "", "trace over three (Wellmann 34)", [](V v) { return v.hull.trace() / 3; }},
      {"fit_zz", "", "strain by least squares over the RVE's grains", [](V v) { return v.fit(2, 2); }},
      {"fit_xz", "", "likewise", [](V v) { return symmetric(v.fit, 0, 2); }},
      {"sigma_xx", "Pa", "from all contacts of its grains, over the sphere's volume, tension positive", [](V v) { return v.grains(0, 0); }},
      {"sigma_yy", "Pa", "likewise", [](V v) { return v.grains(1, 1); }},
      {"sigma_zz", "Pa", "likewise", [](V v) { return v.grains(2, 2); }},
      {"sigma_xy", "Pa", "likewise", [](V v) { return symmetric(v.grains, 0, 1); }},
      {"sigma_xz", "Pa", "likewise", [](V v) { return symmetric(v.grains, 0, 2); }},
      {"sigma_yz", "Pa", "likewise", [](V v) { return symmetric(v.grains, 1, 2); }},
      {"boundary_zz", "Pa", "from the forces on the boundary over the hull's volume (Wellmann 29): too large, the more so the fewer grains", [](V v) { return v.boundary(2, 2); }},
      {"boundary_xz", "Pa", "likewise", [](V v) { return symmetric(v.boundary, 0, 2); }},
      {"inside_zz", "Pa", "from the contacts inside, over the same volume", [](V v) { return v.inside(2, 2); }},
      {"field_zz", "Pa", "coarse-grained at the RVE's point; first state and end of loading", [](V v) { return v.field_zz; }},
  };
  // clang-format on
  return columns;
}

// Components that tell of a deformation.
struct Axis {
  int a = 2, b = 2;
};
Axis axis_of(const std::string& deformation) {
  return deformation == "simple_shear" ? Axis{0, 2} : Axis{2, 2};
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return values.empty() ? kNan : sum / static_cast<double>(values.size());
}

double boundary_zz(const RveValue& v) { return v.boundary(2, 2); }
double grains_zz(const RveValue& v) { return v.grains(2, 2); }

// s/sqrt(N) over the mean, mean of the second half of the loading.
double late_bar(const RveStates& states, std::size_t loading, Of of) {
  std::vector<double> bars;
  for (std::size_t s = loading / 2 + 1; s <= loading; ++s) {
    const RveMean one = mean_over(states[s], of);
    bars.push_back(std::fabs(one.error_bar / one.mean));
  }
  return mean_of(bars);
}

// q/p of the mean over the RVEs as the source has it (Wellmann 29, 32, 33): s1 along z, s2 = s3 the
// mean of x and y.
double axial_stress_ratio(const std::vector<RveValue>& values) {
  const auto mean = [&](double (*of)(const RveValue&)) { return mean_over(values, of).mean; };
  const double axial = mean(boundary_zz), lateral = mean([](const RveValue&v) {
                                            return 0.5 * (v.boundary(0, 0) + v.boundary(1, 1));
                                          });
  return 3 * (axial - lateral) / (axial + 2 * lateral);
}

// Largest |boundary - inside| over |inside| of the RVEs in a state.
double closure(const std::vector<RveValue>& values) {
  double worst = 0;
  for (const RveValue& v : values) {
    worst = std::max(worst, (v.boundary - v.inside).norm() / v.inside.norm());
  }
  return worst;
}

// Largest mean shear strain of the hulls beside the component that is imposed.
double other_shear(const std::vector<RveValue>& values, const Axis& imposed) {
  double largest = 0;
  for (const Axis at : {Axis{0, 1}, Axis{0, 2}, Axis{1, 2}}) {
    if (at.a == imposed.a && at.b == imposed.b) continue;
    double sum = 0;
    for (const RveValue& v : values) sum += symmetric(v.hull, at.a, at.b);
    largest = std::max(largest, std::fabs(sum) / static_cast<double>(values.size()));
  }
  return largest;
}

// One sample's RVEs of one radius.
struct RvesOfSample {
  const RveStates& states;
  std::size_t loading;                // the last state of it
  const Matrix3d &stress, &gradient;  // of the sample at its end
  std::string deformation;

  const std::vector<RveValue>& end() const { return states[loading]; }
  double mean(Of of) const { return mean_over(end(), of).mean; }
  double strain(Matrix3d RveValue::*of) const {
    const Axis axis = axis_of(deformation);
    std::vector<double> all;
    for (const RveValue& v : end()) all.push_back(symmetric(v.*of, axis.a, axis.b));
    return mean_of(all);
  }
};

const std::vector<Figure<RvesOfSample>>& rve_rows() {
  using R = const RvesOfSample&;
  // clang-format off
  static const std::vector<Figure<RvesOfSample>> rows{
      {"grains", "-", "grains of an RVE whose radius is so many sample.radius", [](R r) { return r.mean([](const RveValue& v) { return v.count; }); }},
      {"error_bar", "-", "s/sqrt(N) of sigma_zz over the RVEs of a sample, over its mean; mean of the second half of the loading; the stress from the forces on the boundary over the hull", [](R r) { return late_bar(r.states, r.loading, boundary_zz); }},
      {"grain_error_bar", "-", "the same of the stress from all contacts of the RVEs' grains over the sphere", [](R r) { return late_bar(r.states, r.loading, grains_zz); }},
      {"closure", "-", "largest |boundary - inside| over |inside| of the stress from the forces on the boundary and from the contacts inside, at rest", [](R r) { return closure(r.states.front()); }},
      {"stress_ratio", "-", "sigma_zz of the RVEs from the forces on their boundary over that of the sample, at the end of the loading", [](R r) { return r.mean(boundary_zz) / r.stress(2, 2); }},
      {"grain_stress_ratio", "-", "the same from all contacts of the RVEs' grains", [](R r) { return r.mean(grains_zz) / r.stress(2, 2); }},
      {"field_ratio", "-", "the same of the coarse-grained field at their points", [](R r) { return r.mean([](const RveValue& v) { return v.field_zz; }) / r.stress(2, 2); }},
      {"axial_stress_ratio", "-", "q/p of the RVEs' mean stress from the forces on their boundary at the end of the loading, but for simple shear: q the stress along z less the mean along x and y (Wellmann 32)", [](R r) { return r.deformation == "simple_shear" ? Value() : Value(axial_stress_ratio(r.end())); }},
      {"strain_ratio", "-", "strain of the hulls over that of the sample's edges at the end of the loading: zz, of a simple shear xz", [](R r) { const Axis axis = axis_of(r.deformation); return r.strain(&RveValue::hull) / symmetric(r.gradient, axis.a, axis.b); }},
      {"other_shear", "-", "largest of the hulls' mean shear strains that are not imposed over the imposed strain, at the end of the loading", [](R r) { const Axis axis = axis_of(r.deformation); return other_shear(r.end(), axis) / std::fabs(symmetric(r.gradient, axis.a, axis.b)); }},
      {"fit_ratio", "-", "strain by least squares over that of the hulls, likewise", [](R r) { return r.strain(&RveValue::fit) / r.strain(&RveValue::hull); }},
  };
  // clang-format on
  return rows;
}

}  // namespace

std::vector<std::string> rve_warnings(const RveTable& table) {
  std::vector<std::string> out;
  if (!table.too_large.empty()) {
    out.push_back(fmt::format("rve.radii: left out, for the sample is narrower: {}",
                              fmt::join(table.too_large, ", ")));
  }
  for (std::size_t r = 0; r < table.radii.size(); ++r) {
    if (table.left_out[r] == 0) continue;
    out.push_back(fmt::format(
        "rve.radii: {} RVEs of radius {:g} have fewer than four grains and are left out",
        table.left_out[r], table.radii[r]));
  }
  return out;
}

std::string rve_csv(const RveTable& table) {
  const std::size_t realizations = table.gradients.size();
  Csv out;
  out.comment(fmt::format(
      "RVEs: of each column the mean over the RVEs and the realizations, and the error bar "
      "s/sqrt(N) over the RVEs of a realization (Wellmann 31), mean over realizations: {}",
      realizations));
  out.comment("radius: over sample.radius").comment("strain: of the deformation");
  out.comment("imposed_zz, imposed_xz: of the sample's edges");
  out.comment("sample_zz_Pa, sample_xz_Pa: of all contacts of the sample over its volume");
  for (const std::string& line : rve_warnings(table)) out.comment(line);
  std::vector<std::string> names;
  for (const RveColumn& c : rve_columns()) {
    names.push_back(csv_heading(c.name, c.unit));
    out.comment(names.back() + ": " + c.meaning);
    names.push_back(names.back() + "_error_bar");
  }
  out.row("radius", "state", "strain", "imposed_zz", "imposed_xz", "sample_zz_Pa", "sample_xz_Pa",
          names);
  for (std::size_t r = 0; r < table.radii.size(); ++r) {
    for (std::size_t s = 0; s < table.strain.size(); ++s) {
      const auto over = [&](auto&& of) {
        std::vector<double> values;
        for (std::size_t k = 0; k < realizations; ++k) values.push_back(of(k));
        return mean_of(values);
      };
      const auto of_sample = [&](const auto& tensors, int a, int b) {
        return over([&](std::size_t k) { return symmetric(tensors[k][s], a, b); });
      };
      out.add(table.radii[r]).add(s).add(table.strain[s]);
      for (const auto* tensors : {&table.gradients, &table.stresses}) {
        out.add(of_sample(*tensors, 2, 2)).add(of_sample(*tensors, 0, 2));
      }
      for (const RveColumn& c : rve_columns()) {
        for (double RveMean::*part : {&RveMean::mean, &RveMean::error_bar}) {
          out.add(
              over([&](std::size_t k) { return mean_over(table.values[r][k][s], c.of).*part; }));
        }
      }
      out.end_row();
    }
  }
  return out.text();
}

FigureSamples rve_figures(const RveTable& table, const std::string& deformation) {
  FigureSamples out;
  const auto end = static_cast<std::size_t>(table.loading);
  for (std::size_t r = 0; r < table.radii.size(); ++r) {
    for (std::size_t k = 0; k < table.values[r].size(); ++k) {
      const RvesOfSample one{table.values[r][k], end, table.stresses[k][end],
                             table.gradients[k][end], deformation};
      add_samples(rve_rows(), one, out, fmt::format("rve.r{:g}.", table.radii[r]));
    }
  }
  return out;
}

std::vector<SummaryKey> rve_summary_keys() { return declared(rve_rows(), "rve.r*."); }

}  // namespace grainfield::coupling
