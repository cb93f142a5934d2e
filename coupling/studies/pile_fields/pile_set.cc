#include "coupling/studies/pile_fields/pile_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace grainfield::coupling {
namespace {

// The grid reaches beyond the feet by this factor.
constexpr double kReach = 1.02;
// Fewer points inside than this say nothing about a heap.
constexpr std::size_t kLeastPoints = 8;
// Fewer grains in an RVE: nan.
constexpr int kLeastGrains = 6;
// Share of an RVE's radius by which points of the maps lie inside the heap.
constexpr double kShown = 0.5;
// w of the lucy kernel (5/14 w^2 along an axis) with the second moment of the unit circle (1/4):
// sqrt(0.7).
constexpr double kLucyOfCircle = 0.8367;

bool is_stress(const std::string& name) { return name.compare(0, 6, "sigma_") == 0; }

}  // namespace

PileSet::PileSet(const Case& value, const std::vector<std::string>& files, int threads)
    : value_(value), files_(files), threads_(threads), fields_(files.size()) {
  double reach = 0;
  for (const std::string& file : files) {
    const Realization one = read_realization(file);
    frames_.push_back(pile_frame(one["pile"]));
    const PileFrame& f = frames_.back();
    reach = std::max(reach, kReach * std::max(f.half_left, f.half_right) / f.height);
    if (!changes_.empty()) continue;
    std::vector<std::pair<double, std::string>> found;
    for (const auto& [name, state] : one.snapshots) {
      if (dem::is_change(name)) found.emplace_back(state.gravity.norm() / f.gravity, name);
    }
    if (found.empty()) {
      throw std::invalid_argument(
          "change.gravity: found no gravity besides that of the piles, expected one or more");
    }
    std::sort(found.begin(), found.end());
    double nearest = INFINITY;
    for (const auto& [ratio, name] : found) {
      changes_.push_back(name);
      ratios_.push_back(ratio);
      if (std::fabs(ratio - 1) >= nearest) continue;
      nearest = std::fabs(ratio - 1);
      change_ = name;
    }
  }
  radius_ = value.get<FieldsSetup>().rve_diameters * diameter();
  columns_ =
      static_cast<int>(value.get<FieldsSetup>().columns) / 2 * 2 + 1;  // one column under the apex
  rows_ = static_cast<int>(value.get<FieldsSetup>().rows);
  grid_ = grid_points(-reach, reach, columns_, -1, 0, rows_);
  const double rve = radius_ / height();
  for (Eigen::Index p = 0; p < grid_.rows(); ++p) {
    const double d = room(grid_.row(p));
    if (d >= rve) inside_.push_back(p);
    shown_.push_back(d >= kShown * rve);
  }
  if (inside_.size() < kLeastPoints) {
    throw std::invalid_argument(fmt::format(
        "fields.rve_diameters: found {:g} (an RVE of radius {:.3g} m), which fits into heaps "
        "{:.3g} "
        "m high at {} of the {} points of the map; lower it, or raise fields.columns and rows",
        value.get<FieldsSetup>().rve_diameters, radius_, height(), inside_.size(), grid_.rows()));
  }
}

double PileSet::mean(double PileFrame::*member) const {
  double sum = 0;
  for (const PileFrame& f : frames_) sum += f.*member;
  return sum / count();
}

double PileSet::pressure() const {
  double sum = 0;
  for (const PileFrame& f : frames_) sum += f.pressure();
  return sum / count();
}

int PileSet::row_at(double height_share) const {
  return std::clamp(static_cast<int>(std::lround(height_share * (rows_ - 1))), 0, rows_ - 1);
}

double PileSet::room(const Eigen::Vector2d& p) const {
  const double h = height();
  const auto flank = [&](double half, double x) {
    // Line from the apex (0, 0) to the foot (half, -1); positive below it.
    return (-p.y() * half - x) / std::hypot(half, 1);
  };
  return std::min({p.y() + 1, flank(mean(&PileFrame::half_right) / h, p.x()),
                   flank(mean(&PileFrame::half_left) / h, -p.x())});
}

AverageOptions PileSet::average_options(double radius) const {
  AverageOptions out;
  out.method = "particle_centre";
  out.kernel = "circle";
  out.width = radius;
  out.least_grains = kLeastGrains;
  out.threads = threads_;
  return out;
}

StrainOptions PileSet::strain_options(const std::string& measure, double radius) const {
  StrainOptions out;
  out.measure = measure;
  out.width = radius;
  out.least_grains = kLeastGrains;
  out.threads = threads_;
  if (measure == "kernel") {
    out.support = "lucy";
    out.width = kLucyOfCircle * radius;
  }
  return out;
}

const PileFields& PileSet::fields(int r) const {
  auto& known = fields_[at(r)];
  if (!known) {
    const Realization one = realization(r);
    const dem::Snapshot &pile = one["pile"], &changed = one[change_];
    const Eigen::MatrixXd points = frame(r).to_packing(grid_);
    auto made = std::make_unique<PileFields>();
    const AverageOptions options = average_options(radius_);
    made->rest = average(pile, points, options, &made->gaps);
    AverageOptions stress = options;
    stress.quantities = {"sigma"};
    made->stress_change = response(pile, changed, points, stress);
    made->strain =
        strain(pile, changed, points, strain_options(value_.get<FieldsSetup>().measure, radius_));
    known = std::move(made);
  }
  return *known;
}

Field PileSet::on_grid() const {
  Field out;
  out.points = grid_ * height();
  out.nx = columns_;
  out.ny = rows_;
  out.realizations = count();
  out.attributes["frame"] = "heap";
  out.attributes["lengths"] = "m";
  out.attributes["what"] = "every pile scaled by its own height";
  out.attributes["h"] = height();
  out.attributes["rho_g_h"] = pressure();
  out.attributes["rve_radius"] = radius_;
  return out;
}

Field PileSet::in_metres(const Ensemble& scaled) const {
  Field out = on_grid();
  out.columns = scaled.mean().columns;
  for (Column& column : out.columns) {
    if (!is_stress(column.name)) continue;
    column.value *= pressure();
    column.error *= pressure();
    column.unit = "N/m";
  }
  return out;
}

std::string PileSet::gaps_text() const {
  Gaps all;
  for (int r = 0; r < count(); ++r) {
    Gaps own;
    own.points = static_cast<Eigen::Index>(inside_.size());
    own.least_grains = kLeastGrains;
    const auto& gaps = fields(r).gaps;
    for (const Eigen::Index p : inside_) {
      const auto few = gaps.few_grains.find(p);
      if (few != gaps.few_grains.end()) own.few_grains.insert(*few);
    }
    all.add(own);
  }
  return all.text(grid_ * height());
}

}  // namespace grainfield::coupling
