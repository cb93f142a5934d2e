#include "coupling/studies/point_load/space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>

#include "coupling/averaging/average.h"
#include "coupling/averaging/base_space.h"
#include "coupling/averaging/ensemble.h"
#include "coupling/averaging/layer.h"
#include "coupling/averaging/rings.h"
#include "coupling/compare/ring.h"
#include "coupling/models/model_record.h"
#include "coupling/models/models.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/run/comparison_page.h"
#include "coupling/run/realization_file.h"
#include "coupling/studies/point_load/predicted.h"
#include "coupling/studies/point_load/space_page.h"
#include "dem/snapshot/contact_changes.h"
#include "dem/study/setup.h"

namespace grainfield::coupling {
namespace {

using Eigen::Index;

// Places on a ring of the base are this share of the kernel's width apart.
constexpr double kRingSpacing = 1.0 / 3;
// An averaging that is wider, over the depth, is warned of.
constexpr double kWideKernel = 0.25;

// One averaging method over the ensemble.
struct SpaceAverages {
  std::string method;
  AverageOptions options;
  std::vector<Ensemble> rings, lines;  // one per depth
  Ensemble cut;
  double balance_rms = 0, balance_largest = 0;
};

// Radii about the load from 0 to the profile's end, and on with the same spacing to the corner of
// the square about it.
struct Radii {
  Eigen::VectorXd all;
  Index profile = 0;  // how many of them the profiles have

  Radii(double half, Index points) {
    profile = points / 2 + 1;
    const double spacing = half / static_cast<double>(profile - 1);
    const auto more = static_cast<Index>(std::ceil((std::sqrt(2.0) - 1) * half / spacing)) + 1;
    all = Eigen::VectorXd::LinSpaced(profile + more, 0,
                                     spacing * static_cast<double>(profile + more - 1));
  }
  Eigen::VectorXd own() const { return all.head(profile); }
};

// Points (r, 0, z) for these radii.
Eigen::MatrixXd at_height(const Eigen::VectorXd& radii, double z) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(radii.size(), 3);
  out.col(0) = radii;
  out.col(2).setConstant(z);
  return out;
}

Field on_points(Field field, const Eigen::MatrixXd& points, int nx = 0, int ny = 0, int nz = 0) {
  field.points = points;
  field.nx = nx;
  field.ny = ny;
  field.nz = nz;
  return field;
}

// Points inside the layer, away from its edges, where the balance of forces is looked at.
Eigen::MatrixXd inner_box(const LayerFrame& f) {
  const double w = f.width(), d = f.back - f.front, h = f.depth();
  return box_points({f.left + 0.1 * w, f.front + 0.1 * d, f.floor + 0.3 * h},
                    {f.right - 0.1 * w, f.back - 0.1 * d, f.surface - 0.3 * h}, 6, 6, 3);
}

class SpaceLoadAnalysis {
 public:
  SpaceLoadAnalysis(const Case& value, const std::vector<std::string>& files, int threads)
      : value_(value),
        files_(files),
        setup_(value.get<AverageSetup>()),
        force_(dem::force_of_load(value.get<dem::PointLoadSetup>())),
        layer_(mean_layer(files)),
        half_(setup_.half_width > 0 ? std::min(setup_.half_width, layer_.half_width)
                                    : layer_.half_width),
        radii_(half_, setup_.points),
        predicted_(predicted_response(files)) {
    columns_ = static_cast<int>(setup_.map_columns);
    rows_ = static_cast<int>(setup_.map_rows);
    cut_ = box_points({-half_, 0, -layer_.depth}, {half_, 0, 0}, columns_, 1, rows_);
    square_ = grid_points(-half_, half_, columns_, -half_, half_, columns_);
    for (const auto& method : setup_.methods) {
      SpaceAverages a;
      a.method = method;
      a.options = average_options(setup_, method, layer_.diameter, threads);
      a.rings.resize(setup_.depths.size());
      a.lines.resize(setup_.depths.size());
      methods_.push_back(std::move(a));
    }
    kernel_ = seeing_kernel(methods_.front().options, 3);
  }

  StudyResult run() {
    for (const auto& file : files_) add(read_realization(file));
    StudyResult out = begin_result(value_, files_);
    SpaceLoadPage page;
    add_fields(out, page);
    add_models(out, page);
    add_own_figures(out.summary);
    add_comparison(out.summary, out.comparison, out.comparison.profiles.size() - 1);
    for (const char* key : {"response.integral", "response.integral.standard_error"}) {
      out.summary.erase(key);  // along a line it is no force
    }
    out.page = [page](const StudyResult& result, const Realization* first) {
      return space_load_page(result, first, page);
    };
    const double width = methods_.front().options.width / layer_.depth;
    if (width > kWideKernel) {
      out.warnings.push_back(fmt::format(
          "The averaging is {:.2g} of the layers' depth wide, so profiles of grains and "
          "models alike are smeared; lower average.width_diameters or average.rve_diameters, or "
          "deepen the layer.",
          width));
    }
    out.overview = {{"peaks", "response.peaks", ""},
                    {"peak / (F/h²)", "response.peak_over_F_per_h", ""},
                    {"width (m)", "response.width", ""},
                    {"base force / F", "response.total_over_load", ""},
                    {"best model", "verdict.best_model", ""}};
    return out;
  }

 private:
  void add(const Realization& r) {
    const dem::Snapshot &unloaded = r["unloaded"], &loaded = r["loaded"];
    const LayerFrame frame = layer_frame(unloaded, loaded.loaded_grain);
    for (SpaceAverages& a : methods_) add_averages(unloaded, loaded, frame, a);
    add_base(unloaded, loaded, frame);
    for (const auto& [key, figure] : r.figures) figures_[key].push_back(figure);
    figures_["response.total_over_load"].push_back(
        (dem::base_force(loaded) - dem::base_force(unloaded)).z() /
        -dem::total_applied_force(loaded).z());
  }

  void add_averages(const dem::Snapshot& unloaded, const dem::Snapshot& loaded,
                    const LayerFrame& frame, SpaceAverages& a) {
    const FieldAt change = [&](const Eigen::MatrixXd& points, const AverageOptions& options) {
      return response(unloaded, loaded, points, options);
    };
    AverageOptions stress = a.options;
    stress.quantities = {"sigma", "grains"};
    const Eigen::VectorXd r = radii_.own(), x = both_sides(r);
    for (std::size_t d = 0; d < setup_.depths.size(); ++d) {
      const double z = -setup_.depths[d] * layer_.depth;
      Eigen::MatrixXd rings(r.size(), 2);
      rings << r, Eigen::VectorXd::Constant(r.size(), frame.surface + z);
      const Eigen::Vector2d axis(frame.load_x, frame.load_y);
      a.rings[d].add(on_points(average_on_rings(change, axis, rings, stress), at_height(r, z)));
      const Eigen::MatrixXd line = at_height(x, z);
      a.lines[d].add(on_points(change(frame.to_packing(line), stress), line));
    }
    a.cut.add(on_points(change(frame.to_packing(cut_), a.options), cut_, columns_, 1, rows_));
    const BalanceResidual balance = balance_residual(loaded, inner_box(frame), a.options);
    a.balance_rms += balance.rms / static_cast<double>(files_.size());
    a.balance_largest = std::max(a.balance_largest, balance.largest);
  }

  void add_base(const dem::Snapshot& unloaded, const dem::Snapshot& loaded,
                const LayerFrame& frame) {
    const Eigen::Vector2d axis(frame.load_x, frame.load_y);
    const auto change = [&](const Eigen::MatrixXd& places) {
      return base_stress_response(unloaded, loaded, places, *kernel_);
    };
    const auto on_base = [&](const Eigen::MatrixXd& places) {
      Eigen::MatrixXd out(places.rows(), 3);
      out << places, Eigen::VectorXd::Constant(places.rows(), -layer_.depth);
      return out;
    };
    const Eigen::MatrixXd square = square_.rowwise() + axis.transpose();
    base_.add(on_points(change(square), on_base(square_), columns_, columns_, 1));
    const RingPlaces rings = ring_places(axis, radii_.own(), kRingSpacing * kernel_->range() / 2);
    const auto means = [&](const Field& field) {
      Field out;
      out.points = at_height(radii_.own(), -layer_.depth);
      out.add("sigma_zz", "N/m2").value = ring_means(rings, field.find("sigma_zz")->value);
      return out;
    };
    base_rings_.add(means(change(rings.places)));
    base_unloaded_.add(means(base_stress(unloaded, rings.places, *kernel_)));
  }

  Profile profile(const Ensemble& ensemble, const std::string& name, const std::string& key,
                  double depth) const {
    const Field mean = ensemble.mean();
    const Column& column = *mean.find("sigma_zz");
    Profile out;
    out.name = name;
    out.key = key;
    out.depth = depth;
    out.quantity = "-sigma_zz";
    out.unit = "Pa";
    out.x = both_sides(radii_.own());
    out.x.head(radii_.profile - 1) *= -1;
    out.mean = both_sides(Eigen::VectorXd(-column.value));
    if (column.error.size() > 0) out.error = both_sides(column.error);
    out.samples = both_sides(Eigen::MatrixXd(-ensemble.samples("sigma_zz")));
    out.independent_length = 2 * kernel_->independent_length();  // either side says the same
    return out;
  }

  std::vector<Profile> profiles() const {
    std::vector<Profile> out;
    for (std::size_t d = 0; d < setup_.depths.size(); ++d) {
      const double share = setup_.depths[d];
      out.push_back(profile(methods_.front().rings[d],
                            fmt::format("depth {:g} h ({:.4g} m)", share, share * layer_.depth),
                            fmt::format("depth_{:g}", share), share * layer_.depth));
    }
    out.push_back(profile(base_rings_, "base", "base", layer_.depth));
    return out;
  }

  // What `grainfield compare` needs to know of a field.
  Field described(Field field, const AverageOptions& options) const {
    field.attributes["method"] = options.method;
    field.attributes["kernel"] = options.kernel;
    field.attributes["width"] = fmt::format("{}", options.width);
    field.attributes["h"] = fmt::format("{}", layer_.depth);
    field.attributes["F"] = fmt::format("{}", force_);
    field.attributes["frame"] = "models: load at (0, 0, 0), surface z = 0";
    return field;
  }

  void add_fields(StudyResult& out, SpaceLoadPage& page) const {
    for (const SpaceAverages& a : methods_) {
      Field cut = described(a.cut.mean(), a.options);
      if (&a == &methods_.front()) page.cut = cut;
      out.fields.emplace_back(a.method + "_cut", std::move(cut));
      double largest = 0, error = 0;
      Index n = 0;
      for (std::size_t d = 0; d < setup_.depths.size(); ++d) {
        Field rings = described(a.rings[d].mean(), a.options);
        const Column& column = *rings.find("sigma_zz");
        for (Index i = 0; i < column.value.size(); ++i) {
          if (std::isnan(column.value[i])) continue;
          largest = std::max(largest, std::fabs(column.value[i]));
          if (column.error.size() > i && !std::isnan(column.error[i])) {
            error += column.error[i];
            ++n;
          }
        }
        const std::string depth = fmt::format("{:g}", setup_.depths[d]);
        out.fields.emplace_back(a.method + "_rings_" + depth, std::move(rings));
        out.fields.emplace_back(a.method + "_line_" + depth,
                                described(a.lines[d].mean(), a.options));
      }
      const std::string prefix = "average." + a.method + ".";
      out.summary[prefix + "balance_rms"] = a.balance_rms;
      out.summary[prefix + "balance_largest"] = a.balance_largest;
      if (n > 0 && largest > 0) {
        out.summary[prefix + "fluctuation"] = error / static_cast<double>(n) / largest;
      }
    }
    const AverageOptions& first = methods_.front().options;
    page.base = described(base_.mean(), first);
    page.base_unloaded = described(base_unloaded_.mean(), first);
    out.fields.emplace_back("base_response", page.base);
    out.fields.emplace_back("base_rings", described(base_rings_.mean(), first));
    out.fields.emplace_back("base_unloaded_rings", page.base_unloaded);
  }

  void add_models(StudyResult& out, SpaceLoadPage& page) const {
    std::vector<PointSet> sets;
    for (const double share : setup_.depths) {
      sets.push_back(
          {at_height(radii_.own(), -share * layer_.depth), Smoothing::kernel, kernel_.get()});
    }
    sets.push_back({at_height(radii_.all, -layer_.depth), Smoothing::marginal, kernel_.get()});
    sets.push_back({cut_, Smoothing::none, nullptr});
    const double least_share = *std::min_element(setup_.depths.begin(), setup_.depths.end());
    const RunFacts facts{force_, layer_.depth, 3, least_share * layer_.depth, "", {}};
    std::vector<ModelProfiles> models;
    double seconds = 0;
    std::vector<ModelChoice> choices = value_.models;
    choices.insert(choices.end(), predicted_.models.begin(), predicted_.models.end());
    for (const auto& choice : choices) {
      const Evaluation e = evaluate_model(choice, facts, sets);
      seconds += e.seconds;
      ModelProfiles m;
      m.key = choice.label;
      m.label = model_label(choice);
      m.family = family_of(choice.name);
      for (std::size_t s = 0; s + 1 < sets.size(); ++s) {
        m.values.push_back(both_sides(Eigen::VectorXd(-e.stresses[s].col(2).head(radii_.profile))));
      }
      models.push_back(std::move(m));
      const Eigen::VectorXd on_base = e.stresses[sets.size() - 2].col(2);
      page.models.push_back(
          {choice.label, model_label(choice), over_square(on_base), e.stresses.back().col(2)});
      Field field = model_field(choice, facts, cut_, e.stresses.back(), columns_, 1);
      field.nz = rows_;
      out.fields.emplace_back("model_" + choice.label, std::move(field));
      add_model(out.summary, choice, e.figures, e.seconds);
    }
    out.summary["time.continuum_s"] = seconds;
    predicted_.add_peak(facts, *kernel_, out.summary);
    out.comparison =
        compare(profiles(), std::move(models),
                scale_of_load(force_, layer_.depth, 3, "; means over the angle at radius |x|"));
    out.comparison.judgement.noun = "layer";
    out.comparison.dim = 3;
  }

  // On the grid of the base, from values at radii_.all, linear between them.
  Eigen::VectorXd over_square(const Eigen::VectorXd& by_radius) const {
    Eigen::VectorXd out(square_.rows());
    const double spacing = radii_.all[1];
    for (Index i = 0; i < out.size(); ++i) {
      const double at = square_.row(i).norm() / spacing;
      const Index k = std::min<Index>(static_cast<Index>(at), by_radius.size() - 2);
      const double part = at - static_cast<double>(k);
      out[i] = (1 - part) * by_radius[k] + part * by_radius[k + 1];
    }
    return out;
  }

  // Force of the mean base response within the profile's radius, over F.
  double force_within() const {
    const Field mean = base_rings_.mean();
    const Eigen::VectorXd r = radii_.own(), p = -mean.find("sigma_zz")->value;
    double sum = 0;
    for (Index k = 0; k + 1 < r.size(); ++k) {
      sum += std::numbers::pi * (r[k] * p[k] + r[k + 1] * p[k + 1]) * (r[k + 1] - r[k]);
    }
    return sum / force_;
  }

  // Elliptic models have a peak, hyperbolic ones a ring.
  void add_ring(Summary& summary) const {
    const double unit = force_ / (layer_.depth * layer_.depth);
    const RingAgainstAxis found = ring_against_axis(
        radii_.own(), -base_rings_.samples("sigma_zz") / unit, kernel_->independent_length());
    if (found.word().empty()) return;
    summary["response.ring_less_axis"] = found.difference;
    summary["response.ring_less_axis.standard_error"] = found.error;
    summary["response.ring_at"] = found.at / layer_.depth;
    summary["response.ring_p"] = found.p;
    summary["response.ring"] = found.word();
  }

  void add_own_figures(Summary& summary) const {
    add_ring(summary);
    add_figures(summary, figures_);
    add_figures(summary, predicted_.figures);
    if (!predicted_.refusal.empty()) summary["predicted.refusal"] = predicted_.refusal;
    summary["layer.depth"] = layer_.depth;
    summary["layer.F_over_h2"] = force_ / (layer_.depth * layer_.depth);
    summary["layer.mean_diameter"] = layer_.diameter;
    summary["response.within_radius"] = half_;
    summary["response.within_over_load"] = force_within();
    for (const SpaceAverages& a : methods_) {
      summary[a.method == "coarse_graining" ? "average.width" : "average.rve_radius"] =
          a.options.width;
    }
  }

  const Case& value_;
  const std::vector<std::string>& files_;
  const AverageSetup& setup_;
  double force_;
  MeanLayer layer_;
  double half_;
  Radii radii_;
  PredictedResponse predicted_;
  Eigen::MatrixXd cut_, square_;
  int columns_ = 0, rows_ = 0;
  std::vector<SpaceAverages> methods_;
  Ensemble base_, base_rings_, base_unloaded_;
  std::map<std::string, std::vector<double>> figures_;
  std::unique_ptr<Kernel> kernel_;
};

}  // namespace

StudyResult analyse_space_load(const Case& value, const std::vector<std::string>& realizations,
                               int threads) {
  return SpaceLoadAnalysis(value, realizations, threads).run();
}

}  // namespace grainfield::coupling
