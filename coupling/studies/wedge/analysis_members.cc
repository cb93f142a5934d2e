// Which heaps a case of the study `wedge` combines, and what each of them bears.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <set>
#include <stdexcept>

#include "continuum/constants.h"
#include "continuum/settings.h"
#include "continuum/size.h"
#include "continuum/without_effect.h"
#include "coupling/models/subject.h"
#include "coupling/studies/wedge/analysis.h"
#include "coupling/studies/wedge/setup.h"
#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

constexpr char kHeap[] = "fe_mohr_coulomb_wedge";
// Distance of slip lines, and of the seeds from which they are begun, over the height.
constexpr double kLinesApart = 0.07, kSeedsApart = 0.05, kLineStep = 0.01;

double relative(const Eigen::VectorXd& of, const Eigen::VectorXd& from) {
  double apart = 0, size = 0;
  for (Eigen::Index i = 0; i < of.size(); ++i) {
    if (!std::isfinite(of[i]) || !std::isfinite(from[i])) continue;
    apart += (of[i] - from[i]) * (of[i] - from[i]);
    size += of[i] * of[i];
  }
  return size > 0 ? std::sqrt(apart / size) : kNan;
}

/// The angle a base stands for: none where it is a word.
bool is_angle(const std::string& base) {
  const std::optional<double> angle = parse_number(base);
  return angle && *angle >= 0 && *angle <= 80;
}

}  // namespace

WedgeAnalysis::WedgeAnalysis(const Case& value) : value_(value), setup_(value.get<WedgeSetup>()) {
  if (value.models.size() < 2)
    throw std::invalid_argument(fmt::format(
        "compare.models: found {} model(s), expected two or more", value.models.size()));
  if (value.compare.models != CompareSetup{}.models)
    require_subject(value.models, Subject::heap, 2, "compare.models");
  for (const auto& base : setup_.bases)
    if (base != "rough" && base != "smooth" && !is_angle(base))
      throw std::invalid_argument(
          fmt::format("wedge.bases: found \"{}\", expected rough, smooth, or a friction angle "
                      "from 0 to 80 degrees",
                      base));
  for (const auto& [key, slope] : {std::pair<const char*, double>{"left_deg", setup_.left_deg},
                                   {"right_deg", setup_.right_deg}})
    if (slope > setup_.phi_deg)
      throw std::invalid_argument(
          fmt::format("wedge.{}: found {:g}, expected at most wedge.phi_deg, {:g}: no slope is "
                      "steeper than the friction angle",
                      key, slope, setup_.phi_deg));
  for (const double dilation : setup_.dilations_deg)
    if (dilation > setup_.phi_deg)
      throw std::invalid_argument(
          fmt::format("wedge.dilations_deg: found {:g}, expected at most wedge.phi_deg, {:g}",
                      dilation, setup_.phi_deg));
  height_ = setup_.height;
  left_ = height_ / std::tan(setup_.left_deg * kDegree);
  right_ = height_ / std::tan(setup_.right_deg * kDegree);
  facts_.height = height_;
  facts_.dim = 2;
  facts_.numbers = {{"rho_g", setup_.rho_g},
                    {"phi_deg", setup_.phi_deg},
                    {"left_deg", setup_.left_deg},
                    {"right_deg", setup_.right_deg}};
  for (const double share : setup_.depths)
    if (share < 1) depths_.push_back(share * height_);
  std::sort(depths_.begin(), depths_.end());
  depths_.push_back(height_);
  for (const double depth : depths_) {
    // A little inside of the slopes, where round-off would decide.
    const double share = depth / height_ * (1 - 1e-9);
    const auto n = static_cast<int>(setup_.points);
    lines_.emplace_back(n, 2);
    for (int i = 0; i < n; ++i)
      lines_.back().row(i) << share * (-left_ + (left_ + right_) * i / (n - 1.)), -depth;
  }
  grid_ = grid_points(-left_, right_, kWedgeColumns, -height_, 0, kWedgeRows);
  mapped_ = !setup_.histories.empty() || !setup_.dilations_deg.empty() || !setup_.bases.empty();
  find_members();
}

std::size_t WedgeAnalysis::first_heap() const {
  for (std::size_t m = 0; m < members_.size(); ++m)
    if (members_[m].heap) return m;
  return 0;
}

void WedgeAnalysis::find_members() {
  const auto or_one = [](auto list) {
    if (list.empty()) list.emplace_back();
    return list;
  };
  std::vector<std::string> dilations;
  for (const double d : setup_.dilations_deg) dilations.push_back(fmt::format("{:g}", d));
  for (const ModelChoice& choice : value_.models) {
    WedgeMember one;
    one.choice = choice;
    one.heap = choice.name == kHeap;
    if (!one.heap) {
      members_.push_back(one);
      continue;
    }
    const std::size_t begin = members_.size();
    for (const auto& history : or_one(setup_.histories)) {
      for (const auto& dilation : or_one(dilations)) {
        for (const auto& base : or_one(setup_.bases)) {
          WedgeMember member = one;
          member.history = history;
          member.dilation = dilation;
          member.base = base;
          auto& settings = member.choice.settings;
          auto& label = member.choice.label;
          if (!history.empty()) {
            settings["history"] = history;
            label += "_" + history;
          }
          if (!dilation.empty()) {
            settings["dilation_deg"] = dilation;
            label += "_dilation" + dilation;
          }
          if (!base.empty()) {
            settings["base"] = is_angle(base) ? "frictional" : base;
            if (is_angle(base)) settings["base_friction_deg"] = base;
            label += "_base" + base;
          }
          members_.push_back(member);
        }
      }
    }
    drop_without_effect(choice, begin);
  }
  for (const WedgeMember& m : members_) {
    const auto& info = continuum::find_model(m.choice.name);
    continuum::require_possible(info, continuum::complete(info, filled_settings(m.choice, facts_)));
  }
  std::set<std::string> labels;
  for (const WedgeMember& m : members_) {
    if (!labels.insert(m.choice.label).second)
      throw std::invalid_argument(
          fmt::format("compare.models: found \"{}\" twice, with what wedge.histories, "
                      "dilations_deg and bases add; choose another label",
                      m.choice.label));
  }
  if (!members_[first_heap()].heap)
    throw std::invalid_argument(
        fmt::format("compare.models: found no {}, expected one or more", kHeap));
}

void WedgeAnalysis::drop_without_effect(const ModelChoice& choice, std::size_t begin) {
  const auto& info = continuum::find_model(choice.name);
  std::map<std::string, std::string> refused;  // of the case's settings, by the first combination
  std::set<std::string> used;
  for (std::size_t m = begin; m < members_.size(); ++m) {
    auto& settings = members_[m].choice.settings;
    while (const auto found = continuum::find_without_effect(info, settings)) {
      refused.emplace(found->parameter, found->refusal);
      settings.erase(found->parameter);
    }
    for (const auto& [name, value] : settings) used.insert(name);
  }
  for (const auto& [name, refusal] : refused)
    if (used.count(name) == 0) throw continuum::BadParameter(refusal);
}

void WedgeAnalysis::evaluate(WedgeMember& member) const {
  const auto start = std::chrono::steady_clock::now();
  try {
    const auto model =
        continuum::make_model(member.choice.name, filled_settings(member.choice, facts_));
    const auto stress = [&](const Eigen::MatrixXd& points) -> Eigen::MatrixXd {
      return model->stress(points);
    };
    for (const auto& line : lines_) member.pressures.emplace_back(-stress(line).col(1));
    member.map = stress(grid_);
    if (member.heap) {
      member.quantities = model->quantities(grid_);
      member.mesh = model->mesh();
      if (!mapped_ || members_.size() <= kMostWedgeMaps) find_slip_lines(member, stress);
    }
    member.figures = model->figures();
    member.shape =
        base_shape(lines_.back().col(0), member.pressures.back(), std::min(left_, right_));
  } catch (const ComputationFailed& failure) {
    if (!mapped_ || !member.heap)
      throw ComputationFailed(fmt::format("model {}: {}", member.choice.label, failure.what()));
    member.failed = failure.what();
  }
  member.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void WedgeAnalysis::find_slip_lines(WedgeMember& member, const PlaneStress& stress) const {
  SlipLines how;
  how.phi_deg = setup_.phi_deg;
  how.step = kLineStep * height_;
  how.apart = kLinesApart * height_;
  std::vector<Eigen::Vector2d> seeds;
  const int rows = static_cast<int>(1 / kSeedsApart);
  for (int r = 1; r <= rows; ++r) {
    const double share = (r - 0.5) / rows;
    const int columns = static_cast<int>((left_ + right_) * share / (kSeedsApart * height_));
    for (int c = 0; c < columns; ++c)
      seeds.emplace_back(share * (-left_ + (left_ + right_) * (c + 0.5) / columns),
                         -share * height_);
  }
  Eigen::MatrixXd points(seeds.size(), 2);
  for (std::size_t i = 0; i < seeds.size(); ++i)
    points.row(static_cast<Eigen::Index>(i)) = seeds[i].transpose();
  member.slip = slip_lines(stress, points, how);
}

void WedgeAnalysis::find_nearest(WedgeMember& member) const {
  if (!member.heap || !member.failed.empty()) return;
  for (const WedgeMember& other : members_) {
    if (other.heap) continue;
    const double apart = relative(member.pressures.back(), other.pressures.back());
    if (std::isnan(member.nearest_rel_l2) || apart < member.nearest_rel_l2) {
      member.nearest_rel_l2 = apart;
      member.nearest = other.choice.label;
    }
  }
}

}  // namespace grainfield::coupling
