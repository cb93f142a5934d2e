// Table and pictures of the study `wedge`.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "continuum/constants.h"
#include "continuum/settings.h"
#include "coupling/studies/wedge/analysis.h"

namespace grainfield::coupling {
Table WedgeAnalysis::table() const {
  Table out;
  out.title = "The heaps";
  out.caption =
      "Pressures over rho g h. Axis: mean within 5 % of the half width; dip: axis below 0.98 of "
      "the largest on either side, plateau: at a quarter of the half width on both sides still "
      "0.98 of the axis, else peak. "
      "Core angle: left and right, with the median distance of the border from the line in "
      "|x|/depth. Nearest: of the closed wedges, by the relative L2 distance on the base.";
  out.header = {"heap",           "axis",    "largest",    "at |x|/h",
                "axis / largest", "shape",   "core angle", "nearest",
                "rel. L2",        "plastic", "unknowns",   "steps, iterations"};
  const double unit = setup_.rho_g * height_;
  for (const WedgeMember& m : members_) {
    const auto figure = [&m](const std::string& name) {
      const auto at = m.figures.find(name);
      return at == m.figures.end() ? kNan : at->second;
    };
    if (!m.failed.empty()) {
      // Whatever follows the first clause is advice.
      out.rows.push_back({m.choice.label, "-", "-", "-", "-",
                          m.failed.substr(0, m.failed.find(';')), "-", "-", "-", "-", "-", "-"});
      continue;
    }
    std::vector<std::string> row{m.choice.label,
                                 fmt::format("{:.3f}", m.shape.axis / unit),
                                 fmt::format("{:.3f}", m.shape.largest / unit),
                                 fmt::format("{:.2f}", m.shape.largest_at / height_),
                                 fmt::format("{:.3f}", m.shape.dip_ratio),
                                 m.shape.word};
    if (m.heap) {
      const auto core = [&](const std::string& side) {
        const double angle = figure("beta_hat_" + side + "_deg");
        return std::isnan(angle)
                   ? std::string("none")
                   : fmt::format("{:.1f}° ({:.2f})", angle, figure("beta_hat_" + side + "_misfit"));
      };
      row.push_back(core("left") + ", " + core("right"));
      row.push_back(m.nearest.empty() ? "-" : m.nearest);
      row.push_back(std::isnan(m.nearest_rel_l2) ? "-"
                                                 : fmt::format("{:.1f} %", 100 * m.nearest_rel_l2));
      row.push_back(fmt::format("{:.0f} %", 100 * figure("plastic_share")));
      row.push_back(fmt::format("{:.0f}", figure("unknowns")));
      row.push_back(fmt::format("{:.0f} + {:.0f}, {:.0f}", figure("load_steps"),
                                figure("viscous_steps"), figure("newton_iterations")));
    } else {
      const auto angle = m.figures.find("beta_hat_deg");
      row.push_back(angle == m.figures.end() ? "-" : fmt::format("{:.1f}°", angle->second));
      row.insert(row.end(), 5, "-");
    }
    out.rows.push_back(std::move(row));
  }
  return out;
}

Frame WedgeAnalysis::frame(std::size_t depth, const std::string& title,
                           const std::vector<const WedgeMember*>& heaps) const {
  Frame out;
  out.title = title;
  const double unit = setup_.rho_g * height_;
  const Eigen::VectorXd x = lines_[depth].col(0) / height_;
  for (const WedgeMember* m : heaps) {
    std::string label = m->choice.label;
    if (mapped_ && !m->dilation.empty() && setup_.dilations_deg.size() > 1)
      label = "dilation " + m->dilation + "°";
    out.series.push_back(
        {label, x, m->pressures[depth] / unit, {}, out.series.empty() && !mapped_});
  }
  for (const WedgeMember& m : members_)
    if (!m.heap) out.series.push_back({m.choice.label, x, m.pressures[depth] / unit, {}, false});
  return out;
}

WedgeReport WedgeAnalysis::report(const StudyResult& result) const {
  WedgeReport in;
  in.title = title_of(value_);
  in.subtitle = fmt::format("friction angle {:g}°, slopes {:g}° and {:g}°", setup_.phi_deg,
                            setup_.left_deg, setup_.right_deg);
  in.judgement = result.comparison.judgement;
  in.heaps = table();
  const std::size_t base = depths_.size() - 1;
  std::vector<const WedgeMember*> heaps;
  std::map<std::string, std::vector<const WedgeMember*>>
      groups;  // of the map: all but the dilation
  std::vector<std::string> order;
  for (const WedgeMember& m : members_) {
    if (!m.heap || !m.failed.empty()) continue;
    heaps.push_back(&m);
    std::string name = m.choice.label;
    if (!m.dilation.empty() && setup_.dilations_deg.size() > 1) {
      const std::string part = "_dilation" + m.dilation;
      name.erase(name.find(part), part.size());
    }
    if (groups[name].empty()) order.push_back(name);
    groups[name].push_back(&m);
  }
  if (mapped_) {
    // The legend is the first frame's: the fullest group comes first.
    std::stable_sort(order.begin(), order.end(), [&](const auto& a, const auto& b) {
      return groups[a].size() > groups[b].size();
    });
    for (const auto& name : order) in.base.push_back(frame(base, name, groups[name]));
  } else {
    in.base.push_back(frame(base, "base", heaps));
    for (std::size_t d = 0; d < base; ++d)
      in.cuts.push_back(frame(d, result.comparison.profiles[d].name, heaps));
  }
  if (!mapped_ || heaps.size() <= kMostWedgeMaps) {
    for (const WedgeMember* m : heaps) {
      if (in.mobilized.size() == kMostWedgeMaps) break;
      add_maps(*m, in);
    }
  }
  in.figures = figure_rows(result);
  return in;
}

void WedgeAnalysis::add_maps(const WedgeMember& m, WedgeReport& in) const {
  const Eigen::MatrixXd points = grid_ / height_;
  Map mobilized{m.choice.label, kWedgeColumns, kWedgeRows, points,
                Eigen::VectorXd::Constant(points.rows(), kNan)};
  Map shear = mobilized;
  // In rho g h, so that the product does not depend on it.
  const auto mapped = m.figures.find("map_young");
  const double young = mapped != m.figures.end()
                           ? mapped->second
                           : continuum::number_of({{"E", continuum_setting(m, "E")}}, "E");
  for (const auto& quantity : m.quantities) {
    if (quantity.name == "mobilized") mobilized.value = quantity.values.cwiseMin(1.05);
    if (quantity.name == "plastic_shear")
      shear.value =
          quantity.values.unaryExpr([&](double v) { return v > 0 ? std::log10(v * young) : kNan; });
  }
  Eigen::MatrixXd outline(4, 2);
  outline << -left_ / height_, -1, 0, 0, right_ / height_, -1, -left_ / height_, -1;
  Eigen::MatrixXd slip(0, 2);
  for (const auto& line : m.slip) {
    const Eigen::Index before = slip.rows();
    slip.conservativeResize(before + line.rows() + 1, 2);
    slip.middleRows(before, line.rows()) = line / height_;
    slip.row(before + line.rows()).setConstant(kNan);
  }
  if (slip.rows() > 0) mobilized.lines.push_back({slip, "lw 0.7 lc rgb 'white'"});
  for (const auto& [name, line] : m.mesh.lines)
    mobilized.lines.push_back({line / height_, "lw 2.2 lc rgb '#d01c1c'"});
  for (const auto& [key, side, slope] : {std::tuple("beta_hat_left_deg", -1., setup_.left_deg),
                                         std::tuple("beta_hat_right_deg", 1., setup_.right_deg)}) {
    const auto angle = m.figures.find(key);
    if (angle == m.figures.end()) continue;
    const double foot = std::min(std::tan(angle->second * kDegree), 1 / std::tan(slope * kDegree));
    Eigen::MatrixXd ray(2, 2);
    ray << 0, 0, side * foot, -1;
    mobilized.lines.push_back({ray, "lw 1.4 dt 2 lc rgb '#d01c1c'"});
  }
  mobilized.lines.push_back({outline, "lw 1 lc rgb 'black'"});
  shear.lines.push_back({outline, "lw 1 lc rgb 'black'"});
  in.mobilized.push_back(std::move(mobilized));
  in.plastic.push_back(std::move(shear));
}

std::string WedgeAnalysis::continuum_setting(const WedgeMember& m, const std::string& name) const {
  const auto settings = filled_settings(m.choice, facts_);
  const auto at = settings.find(name);
  if (at != settings.end()) return at->second;
  for (const auto& parameter : continuum::find_model(m.choice.name).parameters)
    if (parameter.name == name) return fmt::format("{}", parameter.value);
  return "1";
}

}  // namespace grainfield::coupling
