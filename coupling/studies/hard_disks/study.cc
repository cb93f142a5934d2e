// The study "hard-disks": gases of hard disks or spheres, their pressure and how they cool.
#include "coupling/case/study.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>

#include "coupling/report/judgement.h"
#include "coupling/run/ensemble.h"
#include "coupling/run/recorded.h"
#include "coupling/run/study_result.h"
#include "coupling/studies/hard_disks/keys.h"
#include "coupling/studies/hard_disks/page.h"
#include "dem/collisions/gas.h"

namespace grainfield::coupling {
namespace {

GasValue value_of(const std::vector<double>& samples) {
  const auto n = static_cast<double>(samples.size());
  double mean = 0, square = 0;
  for (const double x : samples) mean += x / n;
  for (const double x : samples) square += (x - mean) * (x - mean);
  const double none = std::numeric_limits<double>::quiet_NaN();
  return {mean, samples.size() > 1 ? std::sqrt(square / (n * (n - 1))) : none};
}

// A column's mean over realizations, row by row.
std::vector<GasValue> mean_rows(const std::vector<std::vector<double>>& columns) {
  std::vector<GasValue> out;
  for (std::size_t row = 0; row < columns.front().size(); ++row) {
    std::vector<double> samples;
    for (const auto& column : columns) samples.push_back(column.at(row));
    out.push_back(value_of(samples));
  }
  return out;
}

class GasAnalysis {
 public:
  GasAnalysis(const Case& value, const std::vector<std::string>& files)
      : value_(value), files_(files) {
    results_.setup = value.get<dem::HardParticlesSetup>();
    for (const std::string& file : files) {
      realizations_.push_back(read_realization(file));
    }
    figures_ = simulated_figures(files);
    for (const double f : results_.setup.fractions) results_.states.push_back(state_of(f));
  }

  StudyResult run() const {
    StudyResult out = begin_result(value_, files_);
    add_figures(out.summary, figures_);
    add_values(gas_rows(), {results_, figures_}, out.summary, "gas.");
    out.comparison.judgement.findings = {gas_sentence(results_)};
    out.texts.emplace_back("profiles.csv", gas_csv(results_));
    out.overview = overview();
    out.sweep_charts = gas_charts(results_);
    const GasResults results = results_;
    out.page = [results](const StudyResult& result, const Realization* first) {
      return page(result, first, results);
    };
    return out;
  }

 private:
  GasState state_of(double fraction) const {
    GasState out;
    out.fraction = fraction;
    const std::string state = dem::name_of_fraction(fraction), name = "gas." + state + ".";
    if (results_.setup.kind == "pressure") {
      out.theory = gas_theory(results_.setup, fraction);
      out.series = gas_series(results_.setup, fraction);
      out.compressibility = value_of(figures_.at(name + "compressibility"));
      out.rate_over_enskog = value_of(figures_.at(name + "collision_rate_over_enskog"));
      return out;
    }
    std::map<std::string, std::vector<std::vector<double>>> columns;
    for (std::size_t r = 0; r < files_.size(); ++r) {
      const RecordedColumns own =
          recorded_columns(realizations_[r][state], "gas", dem::kCoolingColumns, files_[r]);
      for (const auto& [column, values] : own) columns[column].push_back(values);
      if (own.at("time").size() != columns["time"].front().size()) {
        throw std::invalid_argument(
            fmt::format("{}: gas:time is not as long as the others'", files_[r]));
      }
    }
    out.time = columns["time"].front();
    for (const GasValue& v : mean_rows(columns["collisions"])) out.collisions.push_back(v.mean);
    out.temperature = mean_rows(columns["temperature"]);
    out.spin_temperature = mean_rows(columns["spin_temperature"]);
    return out;
  }

  std::vector<OverviewColumn> overview() const {
    std::vector<OverviewColumn> out;
    for (const double f : results_.setup.fractions) {
      const std::string name = "gas." + dem::name_of_fraction(f) + ".";
      if (results_.setup.kind == "pressure") {
        out.push_back({fmt::format("Z at {:g}", f), name + "compressibility", ""});
        out.push_back({"over theory", name + "compressibility_over_theory", ""});
      } else {
        out.push_back({fmt::format("T / T_0 at {:g}", f), name + "temperature", ""});
      }
    }
    return out;
  }

  static Report page(const StudyResult& result, const Realization* first,
                     const GasResults& results) {
    Report out;
    out.title = title_of(result.value);
    out.subtitle = gas_subtitle(results.setup);
    add_verdict(out, result.comparison.judgement);
    for (const Chart& chart : gas_charts(results)) out.sections.emplace_back(chart.picture());
    out.sections.emplace_back(gas_table(results));
    const std::string last = dem::name_of_fraction(results.setup.fractions.back());
    const dem::Snapshot* snapshot = first != nullptr ? first->find(last) : nullptr;
    if (snapshot != nullptr) {
      const std::string caption =
          fmt::format("Grains of the first realization in their periodic box, at {:g}.",
                      results.setup.fractions.back());
      Picture grains = results.setup.is_3d()
                           ? slice("At the end", *snapshot)
                           : marked_grains("At the end", *snapshot,
                                           std::vector<char>(snapshot->grains.size(), 1), caption);
      grains.caption = caption;
      out.sections.emplace_back(std::move(grains));
    }
    add_rows(out, "Figures", figure_rows(result));
    add_rows(out, "How it was made", origin_rows(result));
    return out;
  }

  const Case& value_;
  const std::vector<std::string>& files_;
  std::vector<Realization> realizations_;
  FigureSamples figures_;
  GasResults results_;
};

}  // namespace

Study hard_disks_study() {
  Study out;
  out.name = "hard-disks";
  out.meaning = "gases of hard disks or spheres: pressure by their collisions, and cooling";
  out.sections = {kGasKeys};
  out.figures = {gas_figures};
  out.without = {"compare.models", "output.fields"};
  out.models_optional = true;
  out.make_run = [](const Case& value, std::int64_t number, int /*threads*/) {
    return dem::make_hard_particles_run(value.get<dem::HardParticlesSetup>(),
                                        realization_seed(value, number));
  };
  out.foresee = [](const Case& value, std::int64_t /*draws*/) {
    return dem::foresee_hard_particles(value.get<dem::HardParticlesSetup>());
  };
  out.dimension = [](const Case& value) {
    return value.get<dem::HardParticlesSetup>().is_3d() ? 3 : 2;
  };
  out.dimension_key = "gas.shape";
  out.analyse = [](const Case& value, const std::vector<std::string>& files, int /*threads*/) {
    return GasAnalysis(value, files).run();
  };
  return out;
}

}  // namespace grainfield::coupling
