// Elastic-plastic heaps beside the closed wedges, without grains: how they were laid, their
// dilation and their base against what presses on the base.
#include "coupling/case/study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "coupling/models/model_record.h"
#include "coupling/result/csv.h"
#include "coupling/store/vtu.h"
#include "coupling/studies/point_load/page.h"
#include "coupling/studies/wedge/analysis.h"
#include "coupling/studies/wedge/keys.h"

namespace grainfield::coupling {

StudyResult WedgeAnalysis::run() {
  for (WedgeMember& member : members_) evaluate(member);
  const auto first = std::find_if(members_.begin(), members_.end(),
                                  [](const WedgeMember& s) { return s.heap && s.failed.empty(); });
  if (first == members_.end())
    throw ComputationFailed("no heap of the study has an equilibrium; the first: " +
                            members_[first_heap()].failed);
  for (WedgeMember& member : members_) find_nearest(member);
  StudyResult out = begin_result(value_, {});
  compare_with(*first, out);
  summarize(out);
  add_files(out);
  out.overview = layer_overview();
  const WedgeReport page = report(out);
  out.page = [page](const StudyResult& result, const Realization*) {
    WedgeReport in = page;
    in.made = origin_rows(result);
    return wedge_report(in);
  };
  return out;
}

void WedgeAnalysis::compare_with(const WedgeMember& reference, StudyResult& out) const {
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
  for (const WedgeMember& member : members_) {
    if (&member == &reference || !member.failed.empty()) continue;
    others.push_back({member.choice.label, member.choice.label, family_of(member.choice.name),
                      member.pressures});
  }
  out.comparison = compare(
      std::move(profiles), std::move(others),
      scale_of_heaps(height_, setup_.rho_g * height_,
                     fmt::format("; the first column is the heap {}", reference.choice.label)));
  add_comparison(out.summary, out.comparison, out.comparison.profiles.size() - 1);
}

void WedgeAnalysis::summarize(StudyResult& out) const {
  const double unit = setup_.rho_g * height_;
  double seconds = 0;
  WedgeCounts counts;
  std::string sentence;
  for (const WedgeMember& m : members_) {
    add_model(out.summary, m.choice, m.figures, m.seconds);
    seconds += m.seconds;
    counts.heaps += m.heap;
    add_values(wedge_member_rows(), {m, unit, height_}, out.summary,
               "wedge." + m.choice.label + ".");
    if (!m.failed.empty() || !m.heap) continue;
    ++counts.equilibria;
    ++counts.words[m.shape.word];
    if (mapped_) continue;
    sentence += fmt::format("{}{}: {} ({:.3f} rho g h on the axis)", sentence.empty() ? "" : "; ",
                            m.choice.label, m.shape.word, m.shape.axis / unit);
    if (!m.nearest.empty())
      sentence += fmt::format(", nearest {} ({:.1f} %)", m.nearest, 100 * m.nearest_rel_l2);
  }
  add_values(wedge_rows(), counts, out.summary, "wedge.");
  out.summary["time.continuum_s"] = seconds;
  if (sentence.empty())
    sentence = fmt::format(
        "{} heaps, {} with an equilibrium: {} with a dip under the apex, {} with a plateau, {} "
        "with a peak",
        counts.heaps, counts.equilibria, counts.of("dip"), counts.of("plateau"), counts.of("peak"));
  // No grains here: nothing to support.
  out.comparison.judgement = {};
  out.comparison.judgement.findings = {sentence + "."};
}

void WedgeAnalysis::add_files(StudyResult& out) const {
  const Table heaps = table();
  Csv csv;
  csv.row(heaps.header);
  for (const auto& row : heaps.rows) csv.row(row);
  out.texts.emplace_back("heaps.csv", csv.text());
  for (const WedgeMember& m : members_) {
    if (!m.failed.empty()) continue;
    Field field = model_field(m.choice, facts_, grid_, m.map, kWedgeColumns, kWedgeRows);
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

Study wedge_study() {
  Study out;
  out.name = "wedge";
  out.meaning = "elastic-plastic heaps by how they were laid, beside the closed wedges";
  out.sections = {kWedgeKeys};
  out.figures = {wedge_figures};
  out.varies_models = true;
  out.fills = {"h", "rho_g", "phi_deg", "left_deg", "right_deg"};
  out.check = [](const Case& value) { WedgeAnalysis{value}; };
  out.analyse = [](const Case& value, const std::vector<std::string>&, int) {
    return WedgeAnalysis(value).run();
  };
  return out;
}

}  // namespace grainfield::coupling
