#include "coupling/studies/cone/cone_ensemble.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "continuum/constants.h"
#include "coupling/averaging/average.h"
#include "coupling/averaging/base.h"
#include "coupling/averaging/base_space.h"
#include "coupling/averaging/rings.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/run/comparison_page.h"
#include "coupling/specimen/cone_windows.h"
#include "coupling/specimen/scaled.h"
#include "coupling/studies/cone/figures.h"
#include "coupling/studies/cone/simulation.h"
#include "coupling/studies/pile/figures.h"
#include "coupling/studies/pile/pile_ensemble.h"
#include "dem/snapshot/contact_changes.h"

namespace grainfield::coupling {
namespace {

using Eigen::Index;

// Profiles and maps reach beyond the feet by this factor.
constexpr double kReachOfCones = 1.08;
// Places on a ring of the base are this share of half the kernel's range apart.
constexpr double kSpacingOnBase = 1.0 / 3;
// Share of a ring's places that some contact must reach for the ring to have a value.
constexpr double kCovered = 0.5;
// Heights inside a cone, over its own, where the balance of forces is looked at.
constexpr double kBalanceLow = -0.8, kBalanceHigh = -0.6;
// An averaging that is wider, over the height, and a larger share of grains lost are warned of.
constexpr double kWideKernel = 0.25, kManyLost = 0.05;

// The deviation of those sectors that have a slope; nan where half of them have none.
double deviation(const std::array<double, kConeSectors>& values) {
  std::vector<double> known;
  for (const double v : values) {
    if (std::isfinite(v)) known.push_back(v);
  }
  if (known.size() <= kConeSectors / 2) return kNan;
  const Eigen::Map<const Eigen::ArrayXd> v(known.data(), static_cast<Index>(known.size()));
  return std::sqrt((v - v.mean()).square().sum() / static_cast<double>(known.size() - 1));
}

// Rings of these scaled radii and heights (n x 2) about a cone's axis, m.
Eigen::MatrixXd rings_of(const Eigen::MatrixXd& scaled, const ConeFrame& frame) {
  Eigen::MatrixXd out = frame.height * scaled;
  out.col(1).array() += frame.floor + frame.height;
  return out;
}

// N, of the free grains.
double weight_of(const dem::Snapshot& cone, const ConeFrame& frame) {
  double weight = 0;
  for (const dem::Grain& g : cone.grains) weight += g.fixed ? 0 : g.mass * frame.gravity;
  return weight;
}

}  // namespace

Eigen::MatrixXd rings_in_space(const Eigen::MatrixXd& rings) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rings.rows(), 3);
  out.col(0) = rings.col(0);
  out.col(2) = rings.col(1);
  return out;
}

ConeEnsemble::ConeEnsemble(const Case& a_case, const std::vector<std::string>& realizations,
                           int threads)
    : value(a_case), files(realizations) {
  const AverageSetup& setup = value.get<AverageSetup>();
  double reach = 0, diameter = 0;
  for (const std::string& file : files) {
    frames.push_back(cone_frame(read_realization(file)["pile"]));
    const ConeFrame& f = frames.back();
    const auto n = static_cast<double>(files.size());
    height += f.height / n;
    pressure += f.pressure() / n;
    diameter += f.diameter / n;
    reach = std::max(reach, kReachOfCones * f.foot / f.height);
  }
  const auto [low, high] = std::minmax_element(
      frames.begin(), frames.end(),
      [](const ConeFrame& a, const ConeFrame& b) { return a.height < b.height; });
  if (high->height > kUnlikeHeights * low->height) {
    throw std::invalid_argument(
        fmt::format("cones of one ensemble are {:.3g} to {:.3g} m high, allowed: up to {:g} times "
                    "the lowest",
                    low->height, high->height, kUnlikeHeights));
  }
  columns = static_cast<int>(setup.map_columns);
  rows = static_cast<int>(setup.map_rows);
  radii = Eigen::VectorXd::LinSpaced(setup.points / 2 + 1, 0, reach);
  square = grid_points(-reach, reach, columns, -reach, reach, columns);
  inside = grid_points(0, reach, columns, -1, 0, rows);
  methods = methods_of(setup, diameter, threads, value.get<HeapSetup>().heights.size());
  for (MethodAverages& a : methods) a.options.quantities = {"sigma", "grains"};
  kernel = seeing_kernel(methods.front().options, 3);
}

void ConeEnsemble::collect() {
  for (std::size_t r = 0; r < files.size(); ++r) add(read_realization(files[r]), frames[r]);
}

Eigen::MatrixXd ConeEnsemble::rings_at(double share) const {
  Eigen::MatrixXd out(radii.size(), 2);
  out << radii, Eigen::VectorXd::Constant(radii.size(), share - 1);
  return out;
}

void ConeEnsemble::add(const Realization& realization, const ConeFrame& frame) {
  const dem::Snapshot& cone = realization["pile"];
  const FieldAt field = [&](const Eigen::MatrixXd& points, const AverageOptions& options) {
    return average(cone, points, options);
  };
  const Eigen::Vector2d axis(frame.apex_x, frame.apex_y);
  const double unit = frame.pressure();
  for (MethodAverages& a : methods) {
    const auto on = [&](const Eigen::MatrixXd& rings) {
      return scaled_field(average_on_rings(field, axis, rings_of(rings, frame), a.options),
                          rings_in_space(rings), unit);
    };
    for (std::size_t k = 0; k < a.lines.size(); ++k) {
      a.lines[k].add(on(rings_at(value.get<HeapSetup>().heights[k])));
    }
    a.map.add(on(inside));
    const double half = 0.3 * frame.foot / frame.height;
    const Eigen::MatrixXd inner =
        box_points({-half, -half, kBalanceLow}, {half, half, kBalanceHigh}, 6, 6, 3);
    a.add_balance(balance_residual(cone, frame.to_packing(inner), a.options), files.size());
  }
  const double force = add_base(cone, frame);
  const ConeWindows dip = cone_windows(cone, frame, value.get<HeapSetup>());
  windows.push_back(dip.mean);

  for (const auto& [key, figure] : realization.figures) figures[key].push_back(figure);
  const double weight = weight_of(cone, frame);
  const double carried = dem::base_force(cone).z();
  figures["base.weight_ratio"].push_back(carried / weight);
  add_samples(cone_rows(),
              {cone, frame, dip, weight, force, carried, deviation(frame.sector_repose_deg)},
              figures);
  add_samples(window_rows(), dip.mean, figures);
}

double ConeEnsemble::add_base(const dem::Snapshot& cone, const ConeFrame& frame) {
  const Eigen::Vector2d axis(frame.apex_x, frame.apex_y);
  const double unit = frame.pressure();
  Eigen::MatrixXd flat(square.rows(), 3);
  flat << square, Eigen::VectorXd::Constant(square.rows(), -1);
  base.add(
      scaled_field(base_stress(cone, (frame.height * square).rowwise() + axis.transpose(), *kernel),
                   flat, unit, columns, columns, 1));

  const RingPlaces rings =
      ring_places(axis, frame.height * radii, kSpacingOnBase * kernel->range() / 2);
  const Field on_rings = base_stress(cone, rings.places, *kernel);
  const Eigen::MatrixXd out = rings.places.rowwise() - axis.transpose();
  const Eigen::VectorXd away = out.rowwise().norm().cwiseMax(1e-300);
  const Eigen::VectorXd radial = (on_rings.find("sigma_xz")->value.array() * out.col(0).array() +
                                  on_rings.find("sigma_yz")->value.array() * out.col(1).array()) /
                                 away.array();
  Field means;
  means.points = rings_in_space(rings_at(0));
  const Eigen::VectorXd down = ring_means(rings, on_rings.find("sigma_zz")->value);
  means.add("sigma_zz", "1").value = down / unit;
  means.add("sigma_rz", "1").value = ring_means(rings, radial) / unit;
  const auto over_sectors = [&](const char* name, const Eigen::VectorXd& values) {
    Eigen::VectorXd error = ring_sector_errors(rings, values, kConeSectors) / unit;
    // Near the axis neighbouring sectors are within one kernel.
    for (Index k = 0; k < error.size(); ++k) {
      const double arc = 2 * std::numbers::pi / kConeSectors * radii[k] * frame.height;
      if (arc < kernel->independent_length()) error[k] = kNan;
    }
    means.add(name, "1").value = error;
  };
  over_sectors("sigma_zz_sector_error", on_rings.find("sigma_zz")->value);
  over_sectors("sigma_rz_sector_error", radial);
  // Beyond the heap nothing is measured, and nothing has no spread.
  const Eigen::VectorXd covered = ring_means(rings, on_rings.find("contacts")->value);
  for (Index k = 0; k < covered.size(); ++k) {
    if (covered[k] >= kCovered) continue;
    for (Column& column : means.columns) column.value[k] = kNan;
  }
  base_rings.add(means);
  double force = 0;
  for (Index k = 0; k + 1 < radii.size(); ++k) {
    force -= std::numbers::pi * (radii[k] * down[k] + radii[k + 1] * down[k + 1]) *
             (radii[k + 1] - radii[k]);
  }
  return force * frame.height * frame.height;
}

Field ConeEnsemble::in_metres(const Ensemble& ensemble, const AverageOptions& options) const {
  Field field = of_mean_heap(ensemble, height, pressure);
  say_averaging(options, field);
  field.attributes["apex_height"] = height * spanned();
  field.attributes["repose_deg"] = mean(&ConeFrame::repose_deg);
  return field;
}

double ConeEnsemble::spanned() const {
  double sum = 0;
  for (const ConeFrame& f : frames) sum += f.apex_height() / f.height;
  return sum / static_cast<double>(frames.size());
}

double ConeEnsemble::mean(double ConeFrame::*member) const {
  double sum = 0;
  for (const ConeFrame& f : frames) sum += f.*member;
  return sum / static_cast<double>(frames.size());
}

std::vector<std::string> ConeEnsemble::warnings() const {
  std::vector<std::string> out;
  const double width = methods.front().options.width / height;
  if (width > kWideKernel) {
    out.push_back(fmt::format(
        "The averaging is {:.2g} of the cones' height wide, so what it shows of the apex "
        "and the dip is smeared; lower average.width_diameters or average.rve_diameters, or pour "
        "more grains.",
        width));
  }
  const auto lost = figures.find("cone.grains_lost"), kept = figures.find("dem.grains");
  const std::string& source = value.get<dem::ConeSetup>().plan.source;
  if (lost != figures.end() && kept != figures.end() && source != "rain") {
    double gone = 0, all = 0;
    for (std::size_t r = 0; r < lost->second.size(); ++r) {
      gone += lost->second[r];
      all += lost->second[r] + kept->second[r];
    }
    if (gone > kManyLost * all) {
      out.push_back(
          fmt::format("{:.0f} % of the grains left the floor, so the cones' foot is cut off: raise "
                      "cone.floor_radius.",
                      100 * gone / all));
    }
  }
  return out;
}

std::vector<ObservedLine> ConeEnsemble::lines() const {
  const MethodAverages& first = methods.front();
  const auto line = [&](const Ensemble& rings, const std::string& name, const std::string& key,
                        Smoothing smoothing) {
    return observed_line(in_metres(rings, first.options), {"sigma_zz", name, key, smoothing, true},
                         kernel);
  };
  std::vector<ObservedLine> out{line(base_rings, "base", "base", Smoothing::marginal)};
  for (std::size_t k = 0; k < first.lines.size(); ++k) {
    const double share = value.get<HeapSetup>().heights[k];
    ObservedLine cut = line(first.lines[k], fmt::format("height {:g} h", share),
                            fmt::format("height_{:g}", share), Smoothing::kernel);
    // High cuts of small heaps may have no value at all.
    if (cut.profile.mean.array().isFinite().count() >= 3) out.push_back(std::move(cut));
  }
  return out;
}

}  // namespace grainfield::coupling
