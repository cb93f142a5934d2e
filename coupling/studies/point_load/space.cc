#include "coupling/studies/point_load/space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coupling/averaging/average.h"
#include "coupling/averaging/base_space.h"
#include "coupling/averaging/rings.h"
#include "coupling/compare/ring.h"
#include "coupling/observe/seen_models.h"
#include "coupling/run/comparison_page.h"
#include "coupling/studies/point_load/figures.h"
#include "coupling/studies/point_load/loaded_layers.h"
#include "coupling/studies/point_load/predicted.h"
#include "coupling/studies/point_load/space_page.h"

namespace grainfield::coupling {
namespace {

using Eigen::Index;

// Places on a ring of the base are this share of the kernel's width apart.
constexpr double kRingSpacing = 1.0 / 3;
// An averaging that is wider, over the depth, is warned of.
constexpr double kWideKernel = 0.25;

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

// Points inside the layer, away from its edges, where the balance of forces is looked at.
Eigen::MatrixXd inner_box(const LayerFrame& f) {
  const double w = f.width(), d = f.back - f.front, h = f.depth();
  return box_points({f.left + 0.1 * w, f.front + 0.1 * d, f.floor + 0.3 * h},
                    {f.right - 0.1 * w, f.back - 0.1 * d, f.surface - 0.3 * h}, 6, 6, 3);
}

class SpaceAnalysis {
 public:
  SpaceAnalysis(const Case& value, const std::vector<std::string>& files, int threads)
      : all_(value, files, threads, 3, value.get<AverageSetup>().depths.size()),
        radii_(all_.half, all_.setup.points),
        predicted_(predicted_response(files)) {
    const double half = all_.half;
    cut_ = box_points({-half, 0, -all_.layer.depth}, {half, 0, 0}, all_.columns, 1, all_.rows);
    square_ = grid_points(-half, half, all_.columns, -half, half, all_.columns);
  }

  StudyResult run() {
    for (const auto& file : all_.files) add(read_realization(file));
    StudyResult out = begin_result(all_.value, all_.files);
    SpaceLoadPage page;
    add_fields(out, page);
    compare_models(out, page);
    add_own_figures(out.summary);
    for (const char* key : {"response.integral", "response.integral.standard_error"}) {
      out.summary.erase(key);  // along a line it is no force
    }
    out.page = [page](const StudyResult& result, const Realization* first) {
      return space_load_page(result, first, page);
    };
    const double width = all_.methods.front().options.width / all_.layer.depth;
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
    for (MethodAverages& a : all_.methods) add_averages(unloaded, loaded, frame, a);
    add_base(unloaded, loaded, frame);
    all_.add_figures_of(r);
  }

  void add_averages(const dem::Snapshot& unloaded, const dem::Snapshot& loaded,
                    const LayerFrame& frame, MethodAverages& a) {
    const FieldAt change = [&](const Eigen::MatrixXd& points, const AverageOptions& options) {
      return response(unloaded, loaded, points, options);
    };
    AverageOptions stress = a.options;
    stress.quantities = {"sigma", "grains"};
    const Eigen::VectorXd r = radii_.own(), x = both_sides(r);
    for (std::size_t d = 0; d < a.lines.size(); ++d) {
      const double z = all_.height(d);
      Eigen::MatrixXd rings(r.size(), 2);
      rings << r, Eigen::VectorXd::Constant(r.size(), frame.surface + z);
      const Eigen::Vector2d axis(frame.load_x, frame.load_y);
      a.lines[d].add(
          in_models_frame(average_on_rings(change, axis, rings, stress), at_height(r, z)));
      const Eigen::MatrixXd line = at_height(x, z);
      a.beside[d].add(in_models_frame(change(frame.to_packing(line), stress), line));
    }
    a.map.add(in_models_frame(change(frame.to_packing(cut_), a.options), cut_, all_.columns, 1,
                              all_.rows));
    a.add_balance(balance_residual(loaded, inner_box(frame), a.options), all_.files.size());
  }

  void add_base(const dem::Snapshot& unloaded, const dem::Snapshot& loaded,
                const LayerFrame& frame) {
    const Eigen::Vector2d axis(frame.load_x, frame.load_y);
    const auto change = [&](const Eigen::MatrixXd& places) {
      return base_stress_response(unloaded, loaded, places, *all_.kernel);
    };
    const auto on_base = [&](const Eigen::MatrixXd& places) {
      Eigen::MatrixXd out(places.rows(), 3);
      out << places, Eigen::VectorXd::Constant(places.rows(), -all_.layer.depth);
      return out;
    };
    const Eigen::MatrixXd square = square_.rowwise() + axis.transpose();
    base_.add(in_models_frame(change(square), on_base(square_), all_.columns, all_.columns, 1));
    const RingPlaces rings =
        ring_places(axis, radii_.own(), kRingSpacing * all_.kernel->range() / 2);
    const auto means = [&](const Field& field) {
      Field out;
      out.points = at_height(radii_.own(), -all_.layer.depth);
      out.add("sigma_zz", "N/m2").value = ring_means(rings, field.find("sigma_zz")->value);
      return out;
    };
    base_rings_.add(means(change(rings.places)));
    base_unloaded_.add(means(base_stress(unloaded, rings.places, *all_.kernel)));
  }

  void add_fields(StudyResult& out, SpaceLoadPage& page) const {
    const auto add = [&](const std::string& name, Field field, const MethodAverages& a) {
      out.fields.emplace_back(name, all_.described(std::move(field), a.options));
      return out.fields.back().second;
    };
    const MethodAverages& first = all_.methods.front();
    for (const MethodAverages& a : all_.methods) {
      const Field cut = add(a.method + "_cut", a.map.mean(), a);
      if (&a == &first) page.cut = cut;
      for (std::size_t d = 0; d < a.lines.size(); ++d) {
        const std::string depth = fmt::format("{:g}", all_.setup.depths[d]);
        // With the layers' single values, by which `compare` judges as this run does.
        add(a.method + "_rings_" + depth, a.lines[d].with_samples(), a);
        add(a.method + "_line_" + depth, a.beside[d].mean(), a);
      }
    }
    page.base = add("base_response", base_.mean(), first);
    add("base_rings", base_rings_.with_samples(), first);
    page.base_unloaded = add("base_unloaded_rings", base_unloaded_.mean(), first);
  }

  void compare_models(StudyResult& out, SpaceLoadPage& page) const {
    Observations seen =
        all_.observed(base_rings_, page.cut, "; means over the angle at radius |x|");
    seen.lines.back().places.points = at_height(radii_.all, -all_.layer.depth);
    std::vector<ModelChoice> choices = all_.value.models;
    choices.insert(choices.end(), predicted_.models.begin(), predicted_.models.end());
    const std::vector<SeenModel> models = see_models(seen, choices);
    add_models(out, seen, models);
    for (const SeenModel& m : models) {
      page.models.push_back(
          {m.choice.label, m.profiles.label, over_square(m.stresses.back().col(2)), m.map.col(2)});
    }
    predicted_.add_peak(seen.told, *all_.kernel, out.summary);
    out.comparison = compared(seen, models);
    all_.add_doubts(out.comparison.judgement.doubts);
    add_compared(out.summary, seen, out.comparison, seen.lines.size() - 1);
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
    return sum / all_.force;
  }

  void add_own_figures(Summary& summary) const {
    const double unit = all_.force / (all_.layer.depth * all_.layer.depth);
    // Elliptic models have a peak, hyperbolic ones a ring.
    const RingAgainstAxis ring = ring_against_axis(
        radii_.own(), -base_rings_.samples("sigma_zz") / unit, all_.kernel->independent_length());
    add_values(ring_rows(), {ring, all_.layer.depth, all_.half, force_within()}, summary);
    all_.add_own_figures(summary);
    add_figures(summary, predicted_.figures);
    if (!predicted_.refusal.empty()) summary["predicted.refusal"] = predicted_.refusal;
  }

  LoadedLayers all_;
  Radii radii_;
  PredictedResponse predicted_;
  Eigen::MatrixXd cut_, square_;
  Ensemble base_, base_rings_, base_unloaded_;
};

}  // namespace

StudyResult analyse_space_load(const Case& value, const std::vector<std::string>& realizations,
                               int threads) {
  return SpaceAnalysis(value, realizations, threads).run();
}

}  // namespace grainfield::coupling
