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
#include "coupling/heap/cone_windows.h"
#include "coupling/heap/scaled.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/run/comparison_page.h"
#include "coupling/studies/pile/pile_ensemble.h"
#include "dem/snapshot/contact_changes.h"
#include "dem/study/cone.h"

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

// Of those sectors that have a slope; nan where half of them have none.
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

ConeEnsemble::ConeEnsemble(const Case& value, const std::vector<std::string>& files, int threads)
    : value_(value), files_(files) {
  const AverageSetup& setup = value.get<AverageSetup>();
  double reach = 0, diameter = 0;
  for (const std::string& file : files) {
    frames_.push_back(cone_frame(read_realization(file)["pile"]));
    const ConeFrame& f = frames_.back();
    const auto n = static_cast<double>(files.size());
    height_ += f.height / n;
    pressure_ += f.pressure() / n;
    diameter += f.diameter / n;
    reach = std::max(reach, kReachOfCones * f.foot / f.height);
  }
  const auto [low, high] = std::minmax_element(
      frames_.begin(), frames_.end(),
      [](const ConeFrame& a, const ConeFrame& b) { return a.height < b.height; });
  if (high->height > kUnlikeHeights * low->height) {
    throw std::invalid_argument(
        fmt::format("cones of one ensemble are {:.3g} to {:.3g} m high, allowed: up to {:g} times "
                    "the lowest",
                    low->height, high->height, kUnlikeHeights));
  }
  columns_ = static_cast<int>(setup.map_columns);
  rows_ = static_cast<int>(setup.map_rows);
  radii_ = Eigen::VectorXd::LinSpaced(setup.points / 2 + 1, 0, reach);
  square_ = grid_points(-reach, reach, columns_, -reach, reach, columns_);
  inside_ = grid_points(0, reach, columns_, -1, 0, rows_);
  for (const std::string& method : setup.methods) {
    ConeAverages a;
    a.method = method;
    a.options = average_options(setup, method, diameter, threads);
    a.options.quantities = {"sigma", "grains"};
    a.cuts.resize(value.get<HeapSetup>().heights.size());
    methods_.push_back(std::move(a));
  }
  kernel_ = seeing_kernel(methods_.front().options, 3);
}

void ConeEnsemble::collect() {
  for (std::size_t r = 0; r < files_.size(); ++r) add(read_realization(files_[r]), frames_[r]);
}

Eigen::MatrixXd ConeEnsemble::rings_at(double share) const {
  Eigen::MatrixXd out(radii_.size(), 2);
  out << radii_, Eigen::VectorXd::Constant(radii_.size(), share - 1);
  return out;
}

void ConeEnsemble::add(const Realization& realization, const ConeFrame& frame) {
  const dem::Snapshot& cone = realization["pile"];
  const FieldAt field = [&](const Eigen::MatrixXd& points, const AverageOptions& options) {
    return average(cone, points, options);
  };
  const Eigen::Vector2d axis(frame.apex_x, frame.apex_y);
  const double unit = frame.pressure();
  for (ConeAverages& a : methods_) {
    const auto on = [&](const Eigen::MatrixXd& rings) {
      return scaled_field(average_on_rings(field, axis, rings_of(rings, frame), a.options),
                          rings_in_space(rings), unit);
    };
    for (std::size_t k = 0; k < a.cuts.size(); ++k) {
      a.cuts[k].add(on(rings_at(value_.get<HeapSetup>().heights[k])));
    }
    a.inside.add(on(inside_));
    const double half = 0.3 * frame.foot / frame.height;
    const BalanceResidual balance =
        balance_residual(cone,
                         frame.to_packing(box_points({-half, -half, kBalanceLow},
                                                     {half, half, kBalanceHigh}, 6, 6, 3)),
                         a.options);
    a.balance_rms += balance.rms / static_cast<double>(files_.size());
    a.balance_largest = std::max(a.balance_largest, balance.largest);
  }
  const double force = add_base(cone, frame);
  const ConeWindows windows = cone_windows(cone, frame, value_.get<HeapSetup>());
  windows_.push_back(windows.mean);

  for (const auto& [key, figure] : realization.figures) figures_[key].push_back(figure);
  const double weight = weight_of(cone, frame);
  const double carried = dem::base_force(cone).z();
  figures_["base.weight_ratio"].push_back(carried / weight);
  figures_["cone.base_over_weight"].push_back(force / carried);
  figures_["cone.repose_deg"].push_back(frame.repose_deg);
  figures_["cone.sector_repose_deviation_deg"].push_back(deviation(frame.sector_repose_deg));
  figures_["cone.height"].push_back(frame.height);
  figures_["cone.foot"].push_back(frame.foot);
  figures_["cone.apex_height"].push_back(frame.apex_height());
  figures_["cone.model_over_height"].push_back(frame.apex_height() / frame.height);
  // Of the cone with the flank's line and the grains' rho g.
  const double model =
      unit / frame.height * std::numbers::pi / 3 * frame.foot * frame.foot * frame.apex_height();
  figures_["cone.model_over_weight"].push_back(model / weight);
  figures_["cone.volume_fraction"].push_back(frame.volume_fraction);
  figures_["cone.rho_g_h"].push_back(unit);
  figures_["cone.mean_diameter"].push_back(frame.diameter);
  figures_["cone.coordination"].push_back(coordination(cone));
  figures_["dip.centre"].push_back(windows.mean.centre);
  figures_["dip.shoulder"].push_back(windows.mean.shoulder);
  figures_["dip.sector_error"].push_back(windows.sector_error);
  figures_["dip.contacts_in_disk"].push_back(windows.in_disk);
}

double ConeEnsemble::add_base(const dem::Snapshot& cone, const ConeFrame& frame) {
  const Eigen::Vector2d axis(frame.apex_x, frame.apex_y);
  const double unit = frame.pressure();
  Eigen::MatrixXd flat(square_.rows(), 3);
  flat << square_, Eigen::VectorXd::Constant(square_.rows(), -1);
  base_.add(scaled_field(
      base_stress(cone, (frame.height * square_).rowwise() + axis.transpose(), *kernel_), flat,
      unit, columns_, columns_, 1));

  const RingPlaces rings =
      ring_places(axis, frame.height * radii_, kSpacingOnBase * kernel_->range() / 2);
  const Field on_rings = base_stress(cone, rings.places, *kernel_);
  const Eigen::MatrixXd out = rings.places.rowwise() - axis.transpose();
  const Eigen::VectorXd away = out.rowwise().norm().cwiseMax(1e-300);
  const Eigen::VectorXd radial = (on_rings.find("sigma_xz")->value.array() * out.col(0).array() +
                                  on_rings.find("sigma_yz")->value.array() * out.col(1).array()) /
                                 away.array();
  Field means;
  means.points = rings_in_space(rings_at(0));
  const Eigen::VectorXd pressure = ring_means(rings, on_rings.find("sigma_zz")->value);
  means.add("sigma_zz", "1").value = pressure / unit;
  means.add("sigma_rz", "1").value = ring_means(rings, radial) / unit;
  const auto over_sectors = [&](const char* name, const Eigen::VectorXd& values) {
    Eigen::VectorXd error = ring_sector_errors(rings, values, kConeSectors) / unit;
    // Near the axis neighbouring sectors are within one kernel.
    for (Index k = 0; k < error.size(); ++k) {
      const double arc = 2 * std::numbers::pi / kConeSectors * radii_[k] * frame.height;
      if (arc < kernel_->independent_length()) error[k] = kNan;
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
  base_rings_.add(means);
  double force = 0;
  for (Index k = 0; k + 1 < radii_.size(); ++k) {
    force -= std::numbers::pi * (radii_[k] * pressure[k] + radii_[k + 1] * pressure[k + 1]) *
             (radii_[k + 1] - radii_[k]);
  }
  return force * frame.height * frame.height;
}

Field ConeEnsemble::in_metres(const Ensemble& ensemble, const AverageOptions& options) const {
  Field field = ensemble.mean();
  field.points *= height_;
  for (Column& column : field.columns) {
    if (ensemble.realizations() > 1) column.samples = pressure_ * ensemble.samples(column.name);
    column.unit = "Pa";
    column.value *= pressure_;
    column.error *= pressure_;
  }
  field.attributes["method"] = options.method;
  field.attributes["kernel"] = options.kernel;
  field.attributes["width"] = fmt::format("{}", options.width);
  field.attributes["h"] = fmt::format("{}", height_);
  field.attributes["rho_g_h"] = fmt::format("{}", pressure_);
  field.attributes["apex_height"] = fmt::format("{}", height_ * spanned());
  field.attributes["repose_deg"] = fmt::format("{}", mean(&ConeFrame::repose_deg));
  field.attributes["frame"] =
      "heap: apex at (0, 0, 0), floor z = -h; every cone scaled by its own height and rho g h; "
      "means over the angle at (r, 0, z)";
  return field;
}

double ConeEnsemble::spanned() const {
  double sum = 0;
  for (const ConeFrame& f : frames_) sum += f.apex_height() / f.height;
  return sum / static_cast<double>(frames_.size());
}

double ConeEnsemble::mean(double ConeFrame::*member) const {
  double sum = 0;
  for (const ConeFrame& f : frames_) sum += f.*member;
  return sum / static_cast<double>(frames_.size());
}

Profile ConeEnsemble::profile(const Ensemble& ensemble, const std::string& name,
                              const std::string& key, double share) const {
  const Field mean = ensemble.mean();
  const Column& column = *mean.find("sigma_zz");
  Profile out;
  out.name = name;
  out.key = key;
  out.depth = (1 - share) * height_;
  out.quantity = "-sigma_zz";
  out.unit = "Pa";
  out.x = height_ * both_sides(radii_);
  out.x.head(radii_.size() - 1) *= -1;
  out.mean = both_sides(Eigen::VectorXd(-pressure_ * column.value));
  if (column.error.size() > 0) out.error = both_sides(Eigen::VectorXd(pressure_ * column.error));
  out.samples = both_sides(Eigen::MatrixXd(-pressure_ * ensemble.samples("sigma_zz")));
  out.independent_length = 2 * kernel_->independent_length();  // either side says the same
  return out;
}

std::vector<std::string> ConeEnsemble::warnings() const {
  std::vector<std::string> out;
  const double width = methods_.front().options.width / height_;
  if (width > kWideKernel) {
    out.push_back(fmt::format(
        "The averaging is {:.2g} of the cones' height wide, so what it shows of the apex "
        "and the dip is smeared; lower average.width_diameters or average.rve_diameters, or pour "
        "more grains.",
        width));
  }
  const auto lost = figures_.find("cone.grains_lost"), kept = figures_.find("dem.grains");
  const std::string& source = value_.get<dem::ConeSetup>().plan.source;
  if (lost != figures_.end() && kept != figures_.end() && source != "rain") {
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

std::vector<Profile> ConeEnsemble::profiles() const {
  std::vector<Profile> out{profile(base_rings_, "base", "base", 0)};
  for (std::size_t k = 0; k < methods_.front().cuts.size(); ++k) {
    const double share = value_.get<HeapSetup>().heights[k];
    Profile p = profile(methods_.front().cuts[k], fmt::format("height {:g} h", share),
                        fmt::format("height_{:g}", share), share);
    // High cuts of small heaps may have no value at all.
    if (p.mean.array().isFinite().count() >= 3) out.push_back(std::move(p));
  }
  return out;
}

}  // namespace grainfield::coupling
