// Lattice piles: the forces of every base disk beside Liffman's closed forms.
#include "coupling/case/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "continuum/closed/liffman.h"
#include "coupling/models/evaluate_model.h"
#include "coupling/models/model_record.h"
#include "coupling/models/subject.h"
#include "coupling/report/force_lines.h"
#include "coupling/run/ensemble.h"
#include "coupling/run/grain_keys.h"
#include "coupling/run/measured_base.h"
#include "coupling/run/study_result.h"
#include "coupling/studies/lattice_pile/keys.h"
#include "coupling/studies/lattice_pile/page.h"
#include "coupling/studies/lattice_pile/simulation.h"
#include "dem/grains/lattice_pile.h"
#include "dem/run/setup.h"

namespace grainfield::coupling {
namespace {

// A contact whose normal rises less than this is one between neighbours of a row: those along the
// lattice lines rise by about 0.87.
constexpr double kRowRise = 0.5;

class LatticePileAnalysis {
 public:
  LatticePileAnalysis(const Case& value, const std::vector<std::string>& files)
      : value_(value), files_(files), lattice_(value.get<dem::LatticePileSetup>().lattice) {
    const dem::MaterialSetup& material = value.get<dem::LatticePileSetup>().material;
    rows_ = dem::lattice_rows(lattice_);
    base_ = rows_.front();
    spacing_ = dem::lattice_spacing(lattice_);
    weight_ =
        material.density * std::numbers::pi * lattice_.radius * lattice_.radius * material.gravity;
    stiffness_ = material.law == "linear" ? material.normal_stiffness : material.young;
    alpha_ = lattice_.slope_deg * std::numbers::pi / 180;
    const double top = lattice_.top_slope_deg * std::numbers::pi / 180;
    heap_ = {alpha_, top > 0 ? top : alpha_, base_ * spacing_, lattice_.bend * base_ * spacing_};
    points_.resize(base_, 2);
    for (int i = 0; i < base_; ++i) {
      points_.row(i) << (i - 0.5 * (base_ - 1)) * spacing_, -heap_.height();
    }
  }

  StudyResult run() {
    measure();
    close();
    StudyResult out = begin_result(value_, files_);
    add_figures(out.summary, figures_);
    add_values(lattice_rows(), facts_of_base(), out.summary, "liffman.");
    std::optional<Chart> beside;
    if (const MeasuredSetup& measured = value_.get<MeasuredSetup>(); !measured.field.empty()) {
      beside =
          beside_measured(profile_of(normal(), horizontal()), measured_base(measured), out.summary);
      out.sweep_charts.push_back(*beside);
    }
    add_comparison_of_models(out);
    out.comparison.judgement.findings = {sentence(out.summary)};
    add_fields(out);
    const double weight = weight_, width = heap_.width, spacing = spacing_;
    out.page = [=](const StudyResult& result, const Realization* first) {
      return page(result, first, weight, width, spacing, beside);
    };
    out.sweep_sections = [first = files_.front()](const std::string& name) {
      const Realization one = read_realization(first);
      return std::vector<Section>{
          force_lines(name + ": lines of maximum force", one["pile"], Extreme::strongest),
          force_lines(name + ": lines of minimum force", one["pile"], Extreme::weakest)};
    };
    out.sweep_frames = base_frames(out.comparison, weight_, heap_.width, spacing_,
                                   fmt::format("{:g}°", lattice_.slope_deg));
    out.sweep_x = "x / B";
    out.sweep_y = "force / (m g)";
    out.overview = {{"disks", "dem.grains", ""}};
    return out;
  }

 private:
  void measure() {
    const auto count = static_cast<Eigen::Index>(files_.size());
    normal_.setZero(base_, count);
    horizontal_.setZero(base_, count);
    for (Eigen::Index r = 0; r < count; ++r) {
      const Realization one = read_realization(files_[static_cast<std::size_t>(r)]);
      int in_rows = 0;
      for (const dem::Contact& c : one["pile"].contacts) {
        if (c.j < 0) {
          if (c.i < base_) normal_(c.i, r) += c.force.y();
          if (c.i < base_) horizontal_(c.i, r) -= c.force.x();
        } else if (std::fabs(c.normal.y()) < kRowRise) {
          ++in_rows;
        }
      }
      for (const auto& [key, figure] : one.figures) figures_[key].push_back(figure);
      figures_["liffman.row_contacts"].push_back(in_rows);
      const auto level = [&](Extreme which) {
        return horizontal_share(one["pile"], extreme_contacts(one["pile"], which));
      };
      figures_["liffman.maximum_lines_level"].push_back(level(Extreme::strongest));
      figures_["liffman.minimum_lines_level"].push_back(level(Extreme::weakest));
    }
  }

  void close() {
    lattice_normal_.resize(base_);
    lattice_horizontal_ = line_normal_ = line_horizontal_ = lattice_normal_;
    const auto hard = continuum::lattice_base_forces(rows_, weight_, 1 / std::numbers::sqrt3);
    for (int i = 0; i < base_; ++i) {
      lattice_normal_[i] = hard[static_cast<std::size_t>(i)].normal;
      lattice_horizontal_[i] = hard[static_cast<std::size_t>(i)].horizontal;
      const auto lines = continuum::line_force(
          continuum::line_lengths(heap_, points_(i, 0), points_(i, 1)), weight_ / spacing_);
      line_normal_[i] = lines.normal;
      line_horizontal_[i] = lines.horizontal;
    }
  }

  BaseProfile profile_of(const Eigen::VectorXd& normal, const Eigen::VectorXd& horizontal) const {
    return {points_.col(0) / heap_.width, normal, horizontal, {}, {}, heap_.height() / heap_.width};
  }

  Eigen::VectorXd normal() const { return normal_.rowwise().mean(); }
  Eigen::VectorXd horizontal() const { return horizontal_.rowwise().mean(); }

  LatticeFacts facts_of_base() const {
    return {static_cast<int>(rows_.size()),
            base_,
            weight_,
            stiffness_ * 2 * lattice_.radius,
            {normal(), horizontal()},
            {lattice_normal_, lattice_horizontal_},
            {line_normal_, line_horizontal_},
            profile_of(normal(), horizontal()),
            profile_of(line_normal_, line_horizontal_)};
  }

  std::string sentence(const Summary& summary) const {
    const auto percent = [&](const char* key) { return 100 * std::get<double>(summary.at(key)); };
    std::string out = fmt::format(
        "{} disks in {} rows at {:g}°: N within {:.2g} % and H within {:.2g} % of the lattice's "
        "closed form, {:.2g} % and {:.2g} % of the line model.",
        std::get<double>(summary.at("dem.grains")), rows_.size(), lattice_.slope_deg,
        percent("liffman.normal_max_error"), percent("liffman.horizontal_max_error"),
        percent("liffman.line_normal_max_difference"),
        percent("liffman.line_horizontal_max_difference"));
    const double in_rows = std::get<double>(summary.at("liffman.row_contacts"));
    if (in_rows > 0) {
      out += fmt::format(" {:g} contacts within rows carry force: the closed forms have none.",
                         in_rows);
    }
    out += fmt::format(" N in the middle over the largest N: {:.3g}, of the lines {:.3g}.",
                       std::get<double>(summary.at("liffman.normal_centre")),
                       std::get<double>(summary.at("liffman.line_normal_centre")));
    return out;
  }

  Profile profile(const char* name, const char* key, const char* quantity,
                  const Eigen::MatrixXd& forces) const {
    Profile out;
    out.name = name;
    out.key = key;
    out.depth = heap_.height();
    out.quantity = quantity;
    out.x = points_.col(0);
    out.samples = forces / spacing_;
    out.mean = out.samples.rowwise().mean();
    out.independent_length = spacing_;
    return out;
  }

  RunFacts facts() const {
    RunFacts out;
    out.height = out.depth = heap_.height();
    out.numbers = {{"alpha_deg", lattice_.slope_deg},
                   {"phi_deg", lattice_.slope_deg},
                   {"left_deg", lattice_.slope_deg},
                   {"right_deg", lattice_.slope_deg},
                   {"top_alpha_deg", lattice_.top_slope_deg},
                   {"bend", lattice_.bend},
                   {"chi_g", weight_ / spacing_},
                   {"width", heap_.width},
                   {"spacing", spacing_},
                   {"rho_g", weight_ / (spacing_ * dem::lattice_rise(lattice_))}};
    return out;
  }

  void add_comparison_of_models(StudyResult& out) const {
    std::vector<Profile> profiles{profile("base", "base", "-sigma_yy", normal_),
                                  profile("base sigma_xy", "base_shear", "sigma_xy", horizontal_)};
    std::vector<ModelProfiles> models{
        {"lattice",
         "lattice, closed form",
         "lattice",
         {lattice_normal_ / spacing_, lattice_horizontal_ / spacing_}}};
    const RunFacts known = facts();
    double seconds = 0;
    for (const ModelChoice& choice : value_.models) {
      const Evaluation e =
          evaluate_model(choice, known, {{points_, Smoothing::none, nullptr, true}});
      seconds += e.seconds;
      const Eigen::MatrixXd& stress = e.stresses.front();
      models.push_back({choice.label,
                        model_label(choice),
                        family_of(choice.name),
                        {-stress.col(1), stress.col(2)}});
      out.fields.emplace_back("model_" + choice.label, model_field(choice, known, points_, stress));
      add_model(out.summary, choice, e.figures, e.seconds);
    }
    out.summary["time.continuum_s"] = seconds;
    const double h = heap_.height(), unit = known.numbers.at("rho_g") * h;
    out.comparison = compare(
        std::move(profiles), std::move(models),
        scale_of_heaps(
            h, unit,
            fmt::format(", rho g = {:.6g} N/m2 of the lattice; forces of the base disks over their "
                        "spacing {:.6g} m, N/d as -sigma_yy and H/d as sigma_xy; m g = {:.6g} N; "
                        "realizations: {}",
                        unit / h, spacing_, weight_, files_.size()),
            "middle"),
        static_cast<int>(files_.size()));
    for (const auto& [key, figure] : summary_figures(out.comparison, 0)) {
      if (key.compare(0, 8, "compare.") == 0) out.summary[key] = figure;
    }
  }

  void add_fields(StudyResult& out) const {
    Field base;
    base.points = points_;
    base.add("N", "N").value = normal();
    base.add("H", "N").value = horizontal();
    base.add("N_lattice", "N").value = lattice_normal_;
    base.add("H_lattice", "N").value = lattice_horizontal_;
    base.add("N_lines", "N").value = line_normal_;
    base.add("H_lines", "N").value = line_horizontal_;
    base.attributes["frame"] = "heap";
    base.attributes["lengths"] = "m";
    base.attributes["what"] = "base of the outline";
    base.attributes["h"] = heap_.height();
    base.attributes["grain_weight"] = weight_;
    out.fields.emplace_back("base", std::move(base));
  }

  static Report page(const StudyResult& result, const Realization* first, double weight,
                     double width, double spacing, const std::optional<Chart>& beside) {
    LatticePileReport in;
    in.title = title_of(result.value);
    const dem::LatticePileSetup& setup = result.value.get<dem::LatticePileSetup>();
    const std::string top = setup.lattice.top_slope_deg > 0
                                ? fmt::format(", {:g}° above the bend", setup.lattice.top_slope_deg)
                                : "";
    in.subtitle = fmt::format("slope {:g}°{}, {} base disks, {} law", setup.lattice.slope_deg, top,
                              setup.lattice.base_grains, setup.material.law);
    if (beside) in.beside = beside->picture();
    in.pile = first != nullptr ? first->find("pile") : nullptr;
    in.comparison = result.comparison;
    in.weight = weight;
    in.width = width;
    in.spacing = spacing;
    in.figures = figure_rows(result);
    in.made = origin_rows(result);
    return lattice_pile_report(in);
  }

  const Case& value_;
  const std::vector<std::string>& files_;
  const dem::LatticeSetup& lattice_;
  std::vector<int> rows_;
  int base_ = 0;
  double spacing_ = 0, weight_ = 0, stiffness_ = 0, alpha_ = 0;
  continuum::HeapProfile heap_;
  Eigen::MatrixXd points_;               // of the base disks, heap's frame
  Eigen::MatrixXd normal_, horizontal_;  // base disks x realizations, N
  Eigen::VectorXd lattice_normal_, lattice_horizontal_, line_normal_, line_horizontal_;
  FigureSamples figures_;
};

// N and H of the base disks (means over realizations) against the closed form of hard close-packed
// disks, the line model, and the case's models. Throws what models throw.
StudyResult analyse_lattice_pile(const Case& value, const std::vector<std::string>& realizations,
                                 int) {
  StudyResult out = LatticePileAnalysis(value, realizations).run();
  return out;
}

}  // namespace

Study lattice_pile_study() {
  Study out;
  out.name = "lattice-pile";
  out.meaning = "disks on a triangular lattice against Liffman's closed forms of the base forces";
  out.sections = {kMaterialKeys, kMotionKeys, kRestKeys, kLatticeKeys, kMeasuredKeys};
  out.material = [](Case& c) -> dem::MaterialSetup& {
    return c.get<dem::LatticePileSetup>().material;
  };
  out.grain_radius = [](const Case& c) { return c.get<dem::LatticePileSetup>().lattice.radius; };
  out.motion = [](Case& c) -> dem::MotionSetup& { return c.get<dem::LatticePileSetup>().motion; };
  out.rest = [](Case& c) -> dem::RestSetup& { return c.get<dem::LatticePileSetup>().rest; };
  out.figures = {lattice_pile_figures, measured_figures};
  out.without = {"material.wall_friction"};
  out.fills = {"alpha_deg", "top_alpha_deg", "bend",  "phi_deg", "left_deg", "right_deg", "chi_g",
               "width",     "spacing",       "rho_g", "h",       "dim",      "depth"};
  out.models_optional = true;
  out.make_run = [](const Case& value, std::int64_t number, int threads) {
    return dem::make_lattice_pile_run(value.get<dem::LatticePileSetup>(),
                                      realization_seed(value, number), threads);
  };
  out.check = [](const Case& value) {
    require_subject(value.models, Subject::heap, 2, "compare.models");
    const MeasuredSetup& measured = value.get<MeasuredSetup>();
    if (!measured.field.empty()) measured_base(measured);
  };
  out.foresee = [](const Case& value, std::int64_t) {
    return dem::foresee_lattice_pile(value.get<dem::LatticePileSetup>());
  };
  out.analyse = analyse_lattice_pile;
  return out;
}

}  // namespace grainfield::coupling
