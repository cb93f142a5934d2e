#include "coupling/run/wedge.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <numbers>
#include <set>
#include <stdexcept>

#include "continuum/idle.h"
#include "coupling/averaging/average.h"
#include "coupling/output/triangles_vtu.h"
#include "coupling/report/wedge.h"
#include "coupling/run/models.h"
#include "coupling/run/slip_lines.h"

namespace grainfield::coupling {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr char kHeap[] = "fe_mohr_coulomb_wedge";
// Of BaseShape: half the width of "the axis", and what counts as equal.
constexpr double kAxis = 0.05, kEqual = 0.98;
constexpr int kColumns = 141, kRows = 61;
// Pictures of more heaps than this would hide each other.
constexpr std::size_t kMostMaps = 6;
// Distance of slip lines, and of the seeds from which they are begun, over the height.
constexpr double kLinesApart = 0.07, kSeedsApart = 0.05, kLineStep = 0.01;

/// A heap or a closed form, evaluated.
struct Seen {
  ModelChoice choice;
  std::string history, dilation, base;  ///< as varied by the study; else empty
  bool heap = false;
  std::string failed;                      ///< why it is not there
  std::vector<Eigen::VectorXd> pressures;  ///< one per depth, N/m
  Eigen::MatrixXd map;                     ///< stress
  std::vector<continuum::Quantity> quantities;
  continuum::MeshField mesh;
  std::vector<Eigen::MatrixXd> slip;
  std::map<std::string, double> figures;
  double seconds = 0;
  BaseShape shape;
  std::string nearest;
  double nearest_rel_l2 = kNan;
};

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
  char* end = nullptr;
  const double angle = std::strtod(base.c_str(), &end);
  return !base.empty() && *end == '\0' && angle >= 0 && angle <= 80;
}

class Analysis {
 public:
  explicit Analysis(const Case& value) : value_(value), setup_(value.wedge) {
    if (value.models.size() < 2)
      throw std::invalid_argument(fmt::format(
          "compare.models: found {} model(s), expected two or more", value.models.size()));
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
    grid_ = grid_points(-left_, right_, kColumns, -height_, 0, kRows);
    mapped_ = !setup_.histories.empty() || !setup_.dilations_deg.empty() || !setup_.bases.empty();
    find_members();
  }

  StudyResult run() {
    for (Seen& member : members_) evaluate(member);
    const auto first = std::find_if(members_.begin(), members_.end(),
                                    [](const Seen& s) { return s.heap && s.failed.empty(); });
    if (first == members_.end())
      throw continuum::ComputationFailed("no heap of the study has an equilibrium; the first: " +
                                         members_[first_heap()].failed);
    for (Seen& member : members_) find_nearest(member);
    StudyResult out;
    out.value = value_;
    add_identity(out.summary, value_);
    compare_with(*first, out);
    summarize(out);
    add_files(out);
    const WedgeReport page = report(out);
    out.page = [page](const StudyResult& result, const Realization*) {
      WedgeReport in = page;
      in.made = origin_rows(result);
      return wedge_report(in);
    };
    return out;
  }

 private:
  std::size_t first_heap() const {
    for (std::size_t m = 0; m < members_.size(); ++m)
      if (members_[m].heap) return m;
    return 0;
  }

  void find_members() {
    const auto or_one = [](auto list) {
      if (list.empty()) list.emplace_back();
      return list;
    };
    std::vector<std::string> dilations;
    for (const double d : setup_.dilations_deg) dilations.push_back(fmt::format("{:g}", d));
    for (const ModelChoice& choice : value_.models) {
      Seen one;
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
            Seen member = one;
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
      drop_idle(choice, begin);
    }
    if (!members_[first_heap()].heap)
      throw std::invalid_argument(
          fmt::format("compare.models: found no {}, expected one or more", kHeap));
  }

  /// Takes from the combinations of a heap what they leave without effect, as `layers` from one
  /// that is laid at once. Throws BadParameter for a setting without effect in all of them.
  void drop_idle(const ModelChoice& choice, std::size_t begin) {
    const auto& info = continuum::find_model(choice.name);
    std::map<std::string, std::string> refused;  // of the case's settings, by the first combination
    std::set<std::string> used;
    for (std::size_t m = begin; m < members_.size(); ++m) {
      auto& settings = members_[m].choice.settings;
      while (const auto idle = continuum::find_idle(info, settings)) {
        refused.emplace(idle->parameter, idle->refusal);
        settings.erase(idle->parameter);
      }
      for (const auto& [name, value] : settings) used.insert(name);
    }
    for (const auto& [name, refusal] : refused)
      if (used.count(name) == 0) throw continuum::BadParameter(refusal);
  }

  void evaluate(Seen& member) const {
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
        if (!mapped_ || members_.size() <= kMostMaps) find_slip_lines(member, stress);
      }
      member.figures = model->figures();
      member.shape =
          base_shape(lines_.back().col(0), member.pressures.back(), std::min(left_, right_));
    } catch (const continuum::ComputationFailed& failure) {
      if (!mapped_ || !member.heap)
        throw continuum::ComputationFailed(
            fmt::format("model {}: {}", member.choice.label, failure.what()));
      member.failed = failure.what();
    }
    member.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  void find_slip_lines(Seen& member, const PlaneStress& stress) const {
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

  void find_nearest(Seen& member) const {
    if (!member.heap || !member.failed.empty()) return;
    for (const Seen& other : members_) {
      if (other.heap) continue;
      const double apart = relative(member.pressures.back(), other.pressures.back());
      if (std::isnan(member.nearest_rel_l2) || apart < member.nearest_rel_l2) {
        member.nearest_rel_l2 = apart;
        member.nearest = other.choice.label;
      }
    }
  }

  void compare_with(const Seen& reference, StudyResult& out) const {
    std::vector<Profile> profiles;
    for (std::size_t d = 0; d < depths_.size(); ++d) {
      Profile p;
      p.name = d + 1 < depths_.size() ? fmt::format("depth {:g} m", depths_[d]) : "base";
      p.key = d + 1 < depths_.size() ? fmt::format("depth_{:g}", depths_[d]) : "base";
      p.depth = depths_[d];
      p.x = lines_[d].col(0);
      p.mean = reference.pressures[d];
      p.independent_length = p.x[1] - p.x[0];
      profiles.push_back(std::move(p));
    }
    std::vector<ModelProfiles> others;
    for (const Seen& member : members_) {
      if (&member == &reference || !member.failed.empty()) continue;
      others.push_back({member.choice.label, member.choice.label, family_of(member.choice.name),
                        member.pressures});
    }
    out.comparison =
        compare(std::move(profiles), std::move(others), setup_.rho_g * height_ * height_, height_);
    out.comparison.scale = {"h", "rho g h", "apex",
                            fmt::format("h = {:.6g} m, rho g h = {:.6g} N/m; the first column is "
                                        "the heap {}",
                                        height_, setup_.rho_g * height_, reference.choice.label)};
    add_comparison(out.summary, out.comparison, out.comparison.profiles.size() - 1);
  }

  void summarize(StudyResult& out) const {
    const double unit = setup_.rho_g * height_;
    double seconds = 0;
    std::int64_t heaps = 0, equilibria = 0;
    std::map<std::string, std::int64_t> words{{"dip", 0}, {"plateau", 0}, {"peak", 0}};
    std::string sentence;
    for (const Seen& m : members_) {
      const std::string prefix = "model." + m.choice.label + ".";
      out.summary[prefix + "name"] = m.choice.name;
      for (const auto& [name, figure] : m.figures) out.summary[prefix + name] = figure;
      out.summary["time.model." + m.choice.label + "_s"] = m.seconds;
      seconds += m.seconds;
      heaps += m.heap;
      const std::string own = "wedge." + m.choice.label + ".";
      if (!m.failed.empty()) {
        out.summary[own + "failed"] = m.failed;
        continue;
      }
      out.summary[own + "base_shape"] = m.shape.word;
      out.summary[own + "base_axis"] = m.shape.axis / unit;
      out.summary[own + "base_largest"] = m.shape.largest / unit;
      out.summary[own + "base_largest_at"] = m.shape.largest_at / height_;
      out.summary[own + "dip_ratio"] = m.shape.dip_ratio;
      if (!m.heap) continue;
      ++equilibria;
      ++words[m.shape.word];
      if (m.nearest.empty()) continue;
      out.summary[own + "nearest"] = m.nearest;
      out.summary[own + "nearest_rel_l2"] = m.nearest_rel_l2;
      if (!mapped_)
        sentence += fmt::format("{}{}: {} ({:.3f} rho g h on the axis), nearest {} ({:.1f} %)",
                                sentence.empty() ? "" : "; ", m.choice.label, m.shape.word,
                                m.shape.axis / unit, m.nearest, 100 * m.nearest_rel_l2);
    }
    out.summary["wedge.heaps"] = heaps;
    out.summary["wedge.equilibria"] = equilibria;
    out.summary["wedge.dips"] = words["dip"];
    out.summary["wedge.plateaus"] = words["plateau"];
    out.summary["wedge.peaks"] = words["peak"];
    out.summary["time.continuum_s"] = seconds;
    if (mapped_)
      sentence = fmt::format(
          "{} heaps, {} with an equilibrium: {} with a dip under the apex, {} with a plateau, {} "
          "with a peak",
          heaps, equilibria, words["dip"], words["plateau"], words["peak"]);
    out.comparison.verdict.sentence = sentence + ".";
    out.summary["verdict.sentence"] = out.comparison.verdict.sentence;
  }

  Table table() const {
    Table out;
    out.title = "The heaps";
    out.caption =
        "Pressures over rho g h. Axis: mean within 5 % of the half width; dip: axis below 0.98 of "
        "the largest, plateau: at a quarter of the half width still 0.98 of the axis, else peak. "
        "Core angle: left and right, with the median distance of the border from the line in "
        "|x|/depth. Nearest: of the closed wedges, by the relative L2 distance on the base.";
    out.header = {"heap",           "axis",    "largest",    "at |x|/h",
                  "axis / largest", "shape",   "core angle", "nearest",
                  "rel. L2",        "plastic", "unknowns",   "steps, iterations"};
    const double unit = setup_.rho_g * height_;
    for (const Seen& m : members_) {
      const auto figure = [&m](const char* name) {
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
        row.push_back(fmt::format("{:.1f}°, {:.1f}° ({:.2f}, {:.2f})", figure("beta_hat_left_deg"),
                                  figure("beta_hat_right_deg"), figure("beta_hat_left_misfit"),
                                  figure("beta_hat_right_misfit")));
        row.push_back(m.nearest.empty() ? "-" : m.nearest);
        row.push_back(
            std::isnan(m.nearest_rel_l2) ? "-" : fmt::format("{:.1f} %", 100 * m.nearest_rel_l2));
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

  void add_files(StudyResult& out) const {
    const Table heaps = table();
    std::string csv = fmt::format("{}\n", fmt::join(heaps.header, ";"));
    for (const auto& row : heaps.rows) csv += fmt::format("{}\n", fmt::join(row, ";"));
    out.texts.emplace_back("heaps.csv", csv);
    for (const Seen& m : members_) {
      if (!m.failed.empty()) continue;
      Field field;
      field.points = grid_;
      field.nx = kColumns;
      field.ny = kRows;
      field.attributes["model"] = m.choice.name;
      for (const auto& [name, setting] : filled_settings(m.choice, facts_))
        field.attributes["model." + name] = setting;
      int column = 0;
      for (const char* name : {"sigma_xx", "sigma_yy", "sigma_xy"})
        field.add(name, "N/m").value = m.map.col(column++);
      for (const auto& quantity : m.quantities) {
        if (field.find(quantity.name) == nullptr)
          field.add(quantity.name, "").value = quantity.values;
      }
      out.fields.emplace_back("model_" + m.choice.label, std::move(field));
      if (!m.heap || !value_.output.vtu) continue;
      out.texts.emplace_back("wedge_" + m.choice.label + ".vtu", triangles_vtu(m.mesh));
      std::vector<Eigen::MatrixXd> lines = m.slip;
      if (!lines.empty())
        out.texts.emplace_back("slip_lines_" + m.choice.label + ".vtu", lines_vtu(lines));
      lines.clear();
      for (const auto& [name, line] : m.mesh.lines) lines.push_back(line);
      out.texts.emplace_back("core_" + m.choice.label + ".vtu", lines_vtu(lines));
    }
  }

  Frame frame(std::size_t depth, const std::string& title,
              const std::vector<const Seen*>& heaps) const {
    Frame out;
    out.title = title;
    const double unit = setup_.rho_g * height_;
    const Eigen::VectorXd x = lines_[depth].col(0) / height_;
    for (const Seen* m : heaps) {
      std::string label = m->choice.label;
      if (mapped_ && !m->dilation.empty() && setup_.dilations_deg.size() > 1)
        label = "dilation " + m->dilation + "°";
      out.series.push_back(
          {label, x, m->pressures[depth] / unit, {}, out.series.empty() && !mapped_});
    }
    for (const Seen& m : members_)
      if (!m.heap) out.series.push_back({m.choice.label, x, m.pressures[depth] / unit, {}, false});
    return out;
  }

  WedgeReport report(const StudyResult& result) const {
    WedgeReport in;
    in.title = value_.title.empty() ? value_.name : value_.title;
    in.subtitle = fmt::format("friction angle {:g}°, slopes {:g}° and {:g}°", setup_.phi_deg,
                              setup_.left_deg, setup_.right_deg);
    in.sentence = result.comparison.verdict.sentence;
    in.heaps = table();
    const std::size_t base = depths_.size() - 1;
    std::vector<const Seen*> heaps;
    std::map<std::string, std::vector<const Seen*>> groups;  // of the map: all but the dilation
    std::vector<std::string> order;
    for (const Seen& m : members_) {
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
    if (!mapped_ || heaps.size() <= kMostMaps) {
      for (const Seen* m : heaps) {
        if (in.mobilized.size() == kMostMaps) break;
        add_maps(*m, in);
      }
    }
    in.figures = figure_rows(result.summary, {"wedge.heaps", "wedge.equilibria", "wedge.dips",
                                              "wedge.plateaus", "wedge.peaks", "time.continuum_s"});
    return in;
  }

  void add_maps(const Seen& m, WedgeReport& in) const {
    const Eigen::MatrixXd points = grid_ / height_;
    Map mobilized{m.choice.label, kColumns, kRows, points,
                  Eigen::VectorXd::Constant(points.rows(), kNan)};
    Map shear = mobilized;
    // In rho g h, so that the product does not depend on it.
    const auto mapped = m.figures.find("map_young");
    const double young =
        mapped != m.figures.end() ? mapped->second : std::stod(continuum_setting(m, "E"));
    for (const auto& quantity : m.quantities) {
      if (quantity.name == "mobilized") mobilized.value = quantity.values.cwiseMin(1.05);
      if (quantity.name == "plastic_shear")
        shear.value = quantity.values.unaryExpr(
            [&](double v) { return v > 0 ? std::log10(v * young) : kNan; });
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
    for (const auto& [key, side, slope] :
         {std::tuple("beta_hat_left_deg", -1., setup_.left_deg),
          std::tuple("beta_hat_right_deg", 1., setup_.right_deg)}) {
      const auto angle = m.figures.find(key);
      if (angle == m.figures.end()) continue;
      const double foot =
          std::min(std::tan(angle->second * kDegree), 1 / std::tan(slope * kDegree));
      Eigen::MatrixXd ray(2, 2);
      ray << 0, 0, side * foot, -1;
      mobilized.lines.push_back({ray, "lw 1.4 dt 2 lc rgb '#d01c1c'"});
    }
    mobilized.lines.push_back({outline, "lw 1 lc rgb 'black'"});
    shear.lines.push_back({outline, "lw 1 lc rgb 'black'"});
    in.mobilized.push_back(std::move(mobilized));
    in.plastic.push_back(std::move(shear));
  }

  std::string continuum_setting(const Seen& m, const std::string& name) const {
    const auto settings = filled_settings(m.choice, facts_);
    const auto at = settings.find(name);
    if (at != settings.end()) return at->second;
    for (const auto& parameter : continuum::find_model(m.choice.name).parameters)
      if (parameter.name == name) return fmt::format("{}", parameter.value);
    return "1";
  }

  const Case& value_;
  const WedgeSetup& setup_;
  RunFacts facts_;
  double height_ = 1, left_ = 1, right_ = 1;
  std::vector<double> depths_;  ///< the last one is the base
  std::vector<Eigen::MatrixXd> lines_;
  Eigen::MatrixXd grid_;
  bool mapped_ = false;  ///< combinations are studied; heaps without equilibrium are entries
  std::vector<Seen> members_;
};

}  // namespace

BaseShape base_shape(const Eigen::VectorXd& x, const Eigen::VectorXd& pressure, double half_width) {
  BaseShape out;
  out.largest = -std::numeric_limits<double>::infinity();
  double axis = 0, quarter = 0;
  int near = 0, at_quarter = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double p = pressure[i], at = std::abs(x[i]);
    if (!std::isfinite(p)) continue;
    if (at <= kAxis * half_width) axis += p, ++near;
    // Slack: symmetric points count on both sides or on none.
    if (std::abs(at - half_width / 4) <= kAxis * half_width * (1 + 1e-9))
      quarter += p, ++at_quarter;
    if (p > out.largest * (1 + 1e-9)) out.largest = p, out.largest_at = at;
  }
  if (near == 0 || at_quarter == 0)
    throw std::invalid_argument(
        "base_shape: no pressure near the axis or at a quarter of the base");
  out.axis = axis / near;
  out.quarter = quarter / at_quarter;
  out.dip_ratio = out.axis / out.largest;
  const bool aside = out.largest_at > kAxis * half_width;
  out.word = aside && out.dip_ratio < kEqual    ? "dip"
             : out.quarter >= kEqual * out.axis ? "plateau"
                                                : "peak";
  return out;
}

StudyResult analyse_wedge(const Case& value) { return Analysis(value).run(); }

Study wedge_study() {
  Study out;
  out.name = "wedge";
  out.meaning = "elastic-plastic heaps by how they were laid, beside the closed wedges";
  out.sections = {"wedge"};
  out.fills = {"h", "rho_g", "phi_deg", "left_deg", "right_deg"};
  out.analyse = [](const Case& value, const std::vector<std::string>&, int) {
    return analyse_wedge(value);
  };
  return out;
}

}  // namespace grainfield::coupling
