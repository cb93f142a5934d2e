// Cones poured from a point, rained, or left by a lifted cylinder: base pressure, dip, stress
// inside, against models of cones.
#include "coupling/case/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>

#include "continuum/constants.h"
#include "coupling/averaging/average.h"
#include "coupling/averaging/base.h"
#include "coupling/averaging/base_space.h"
#include "coupling/averaging/ensemble.h"
#include "coupling/averaging/layer.h"
#include "coupling/averaging/rings.h"
#include "coupling/heap/cone_windows.h"
#include "coupling/models/model_record.h"
#include "coupling/models/models.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/run/ensemble.h"
#include "coupling/run/finished_runs.h"
#include "coupling/run/grain_keys.h"
#include "coupling/run/radial_page.h"
#include "coupling/run/realization_file.h"
#include "coupling/run/summary_keys.h"
#include "coupling/studies/cone/keys.h"
#include "coupling/studies/cone/page.h"
#include "coupling/studies/pile/keys.h"
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

// The stresses of a field in units of `pressure`, on scaled points.
Field in_units(const Field& field, const Eigen::MatrixXd& points, double pressure) {
  Field out;
  out.points = points;
  for (const Column& column : field.columns) {
    if (!column.name.starts_with("sigma_")) continue;
    out.add(column.name, "1").value = column.value / pressure;
  }
  return out;
}

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

// One averaging method over the ensemble: by radius at each of heap.heights, and inside.
struct ConeAverages {
  std::string method;
  AverageOptions options;
  std::vector<Ensemble> cuts;
  Ensemble inside;
  double balance_rms = 0, balance_largest = 0;
};

class ConeAnalysis {
 public:
  ConeAnalysis(const Case& value, const std::vector<std::string>& files, int threads)
      : value_(value), files_(files), setup_(value.get<AverageSetup>()) {
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
      throw std::invalid_argument(fmt::format(
          "cones of one ensemble are {:.3g} to {:.3g} m high, allowed: up to {:g} times "
          "the lowest",
          low->height, high->height, kUnlikeHeights));
    }
    columns_ = static_cast<int>(setup_.map_columns);
    rows_ = static_cast<int>(setup_.map_rows);
    radii_ = Eigen::VectorXd::LinSpaced(setup_.points / 2 + 1, 0, reach);
    square_ = grid_points(-reach, reach, columns_, -reach, reach, columns_);
    inside_ = grid_points(0, reach, columns_, -1, 0, rows_);
    for (const std::string& method : setup_.methods) {
      ConeAverages a;
      a.method = method;
      a.options = average_options(setup_, method, diameter, threads);
      a.options.quantities = {"sigma", "grains"};
      a.cuts.resize(heap().heights.size());
      methods_.push_back(std::move(a));
    }
    kernel_ = seeing_kernel(methods_.front().options, 3);
  }

  StudyResult run() {
    for (std::size_t r = 0; r < files_.size(); ++r) add(read_realization(files_[r]), frames_[r]);
    StudyResult out = begin_result(value_, files_);
    add_figures(out.summary, figures_);
    ConePage page;
    page.averaged = describe(methods_.front().options);
    add_fields(out, page);
    add_comparison_of_models(out, page);
    add_own_figures(out.summary);
    add_dip(out);
    out.page = [page](const StudyResult& result, const Realization* first) {
      return cone_page(result, first, page);
    };
    out.overview = {{"dip difference (rho g h)", "dip.difference", "dip.standard_error"},
                    {"p of a dip", "dip.p_value", ""},
                    {"repose (deg)", "cone.repose_deg", ""},
                    {"h (m)", "cone.height", ""},
                    {"centre pressure (rho g h)", "dip.centre", ""},
                    {"shoulder pressure (rho g h)", "dip.shoulder", ""},
                    {"volume fraction", "cone.volume_fraction", ""}};
    return out;
  }

 private:
  const HeapSetup& heap() const { return value_.get<HeapSetup>(); }

  // Rings of these scaled radii and heights (n x 2) about a cone's axis, m.
  static Eigen::MatrixXd rings_of(const Eigen::MatrixXd& scaled, const ConeFrame& frame) {
    Eigen::MatrixXd out = frame.height * scaled;
    out.col(1).array() += frame.floor + frame.height;
    return out;
  }
  // (r, 0, z) of scaled radii and heights.
  static Eigen::MatrixXd in_space(const Eigen::MatrixXd& rings) {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rings.rows(), 3);
    out.col(0) = rings.col(0);
    out.col(2) = rings.col(1);
    return out;
  }
  Eigen::MatrixXd at_height_share(double share) const {
    Eigen::MatrixXd out(radii_.size(), 2);
    out << radii_, Eigen::VectorXd::Constant(radii_.size(), share - 1);
    return out;
  }

  void add(const Realization& realization, const ConeFrame& frame) {
    const dem::Snapshot& cone = realization["pile"];
    const FieldAt field = [&](const Eigen::MatrixXd& points, const AverageOptions& options) {
      return average(cone, points, options);
    };
    const Eigen::Vector2d axis(frame.apex_x, frame.apex_y);
    const double unit = frame.pressure();
    for (ConeAverages& a : methods_) {
      const auto on = [&](const Eigen::MatrixXd& rings) {
        return in_units(average_on_rings(field, axis, rings_of(rings, frame), a.options),
                        in_space(rings), unit);
      };
      for (std::size_t k = 0; k < a.cuts.size(); ++k) {
        a.cuts[k].add(on(at_height_share(heap().heights[k])));
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
    const ConeWindows windows = cone_windows(cone, frame, heap());
    windows_.push_back(windows.mean);

    for (const auto& [key, figure] : realization.figures) figures_[key].push_back(figure);
    double weight = 0;
    for (const dem::Grain& g : cone.grains) weight += g.fixed ? 0 : g.mass * frame.gravity;
    const double carried = dem::base_force(cone).z();
    figures_["base.weight_ratio"].push_back(carried / weight);
    figures_["cone.base_over_weight"].push_back(force / carried);
    figures_["cone.repose_deg"].push_back(frame.repose_deg);
    figures_["cone.sector_repose_deviation_deg"].push_back(deviation(frame.sector_repose_deg));
    figures_["cone.height"].push_back(frame.height);
    figures_["cone.foot"].push_back(frame.foot);
    figures_["cone.apex_height"].push_back(frame.apex_height());
    figures_["cone.volume_fraction"].push_back(frame.volume_fraction);
    figures_["cone.rho_g_h"].push_back(unit);
    figures_["cone.mean_diameter"].push_back(frame.diameter);
    figures_["cone.coordination"].push_back(coordination(cone));
    figures_["dip.centre"].push_back(windows.mean.centre);
    figures_["dip.shoulder"].push_back(windows.mean.shoulder);
    figures_["dip.sector_error"].push_back(windows.sector_error);
    figures_["dip.contacts_in_disk"].push_back(windows.in_disk);
  }

  // Returns the force within the rings, N.
  double add_base(const dem::Snapshot& cone, const ConeFrame& frame) {
    const Eigen::Vector2d axis(frame.apex_x, frame.apex_y);
    const double unit = frame.pressure();
    Eigen::MatrixXd flat(square_.rows(), 3);
    flat << square_, Eigen::VectorXd::Constant(square_.rows(), -1);
    Field square =
        in_units(base_stress(cone, (frame.height * square_).rowwise() + axis.transpose(), *kernel_),
                 flat, unit);
    square.nx = square.ny = columns_;
    square.nz = 1;
    base_.add(square);

    const RingPlaces rings =
        ring_places(axis, frame.height * radii_, kSpacingOnBase * kernel_->range() / 2);
    const Field on_rings = base_stress(cone, rings.places, *kernel_);
    const Eigen::MatrixXd out = rings.places.rowwise() - axis.transpose();
    const Eigen::VectorXd away = out.rowwise().norm().cwiseMax(1e-300);
    const Eigen::VectorXd radial = (on_rings.find("sigma_xz")->value.array() * out.col(0).array() +
                                    on_rings.find("sigma_yz")->value.array() * out.col(1).array()) /
                                   away.array();
    Field means;
    means.points = in_space(at_height_share(0));
    const Eigen::VectorXd pressure = ring_means(rings, on_rings.find("sigma_zz")->value);
    means.add("sigma_zz", "1").value = pressure / unit;
    means.add("sigma_rz", "1").value = ring_means(rings, radial) / unit;
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

  // Values in Pa on points in m, in the heap's frame.
  Field in_metres(const Ensemble& ensemble, const AverageOptions& options) const {
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
    field.attributes["repose_deg"] = fmt::format("{}", mean(&ConeFrame::repose_deg));
    field.attributes["frame"] =
        "heap: apex at (0, 0, 0), floor z = -h; every cone scaled by its own height and rho g h; "
        "means over the angle at (r, 0, z)";
    return field;
  }

  // Height of the models' cone over h, mean over the cones: its flanks are the grains' own, and its
  // apex is above a round one.
  double spanned() const {
    double sum = 0;
    for (const ConeFrame& f : frames_) sum += f.apex_height() / f.height;
    return sum / static_cast<double>(frames_.size());
  }
  // From the heap's frame, whose origin is its highest point, to that of the models.
  Eigen::MatrixXd in_models_axes(Eigen::MatrixXd points) const {
    points.col(2).array() -= height_ * (spanned() - 1);
    return points;
  }

  double mean(double ConeFrame::*member) const {
    double sum = 0;
    for (const ConeFrame& f : frames_) sum += f.*member;
    return sum / static_cast<double>(frames_.size());
  }

  void add_fields(StudyResult& out, ConePage& page) const {
    for (const ConeAverages& a : methods_) {
      Field inside = in_metres(a.inside, a.options);
      inside.nx = columns_;
      inside.ny = 1;
      inside.nz = rows_;
      out.fields.emplace_back(a.method + "_inside", std::move(inside));
      for (std::size_t k = 0; k < a.cuts.size(); ++k) {
        out.fields.emplace_back(fmt::format("{}_height_{:g}", a.method, heap().heights[k]),
                                in_metres(a.cuts[k], a.options));
      }
      const std::string prefix = "average." + a.method + ".";
      out.summary[prefix + "balance_rms"] = a.balance_rms;
      out.summary[prefix + "balance_largest"] = a.balance_largest;
      out.summary[a.method == "coarse_graining" ? "average.width" : "average.rve_radius"] =
          a.options.width;
    }
    page.base = base_.mean();
    page.base.nx = page.base.ny = columns_;
    page.rings = base_rings_.mean();
    page.inside = methods_.front().inside.mean();
    page.inside.nx = columns_;
    page.inside.nz = rows_;
    Field square = in_metres(base_, methods_.front().options);
    square.nx = square.ny = columns_;
    square.nz = 1;
    out.fields.emplace_back("base", std::move(square));
    out.fields.emplace_back("base_rings", in_metres(base_rings_, methods_.front().options));
  }

  Profile profile(const Ensemble& ensemble, const std::string& name, const std::string& key,
                  double share) const {
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

  std::vector<Profile> profiles() const {
    std::vector<Profile> out{profile(base_rings_, "base", "base", 0)};
    for (std::size_t k = 0; k < methods_.front().cuts.size(); ++k) {
      const double share = heap().heights[k];
      Profile p = profile(methods_.front().cuts[k], fmt::format("height {:g} h", share),
                          fmt::format("height_{:g}", share), share);
      // High cuts of small heaps may have no value at all.
      if (p.mean.array().isFinite().count() >= 3) out.push_back(std::move(p));
    }
    return out;
  }

  RunFacts facts() const {
    RunFacts out;
    out.height = out.depth = height_ * spanned();
    out.dim = 3;
    out.numbers = {{"rho_g", pressure_ / height_}, {"phi_deg", mean(&ConeFrame::repose_deg)}};
    return out;
  }

  std::vector<ModelProfiles> models(StudyResult& out, ConePage& page,
                                    const std::vector<Profile>& profiles) const {
    std::vector<PointSet> sets;
    for (const Profile& p : profiles) {
      const Eigen::MatrixXd rings = at_height_share(1 - p.depth / height_);
      sets.push_back({in_models_axes(height_ * in_space(rings)),
                      p.key == "base" ? Smoothing::marginal : Smoothing::kernel, kernel_.get(),
                      true});
    }
    const Eigen::MatrixXd grid = height_ * in_space(inside_);
    sets.push_back({in_models_axes(grid), Smoothing::none, nullptr, true});
    const RunFacts known = facts();
    std::vector<ModelProfiles> all;
    double seconds = 0;
    for (const ModelChoice& choice : value_.models) {
      const Evaluation e = evaluate_model(choice, known, sets);
      seconds += e.seconds;
      ModelProfiles m{choice.label, model_label(choice), family_of(choice.name), {}};
      for (std::size_t s = 0; s + 1 < sets.size(); ++s) {
        m.values.push_back(both_sides(Eigen::VectorXd(-e.stresses[s].col(2))));
      }
      all.push_back(std::move(m));
      page.models.push_back(
          {choice.label, model_label(choice), e.stresses.back().col(2) / pressure_});
      Field field = model_field(choice, known, grid, e.stresses.back(), columns_, 1);
      field.nz = rows_;
      field.attributes["apex_z"] = fmt::format("{}", height_ * (spanned() - 1));
      out.fields.emplace_back("model_" + choice.label, std::move(field));
      // Over the model's own height and rho g h there, over those of the grains here.
      std::map<std::string, double> figures = e.figures;
      for (const char* name : {"base_centre", "base_largest", "base_largest_at"}) {
        if (figures.count(name) > 0) figures[name] *= spanned();
      }
      add_model(out.summary, choice, figures, e.seconds);
    }
    out.summary["time.continuum_s"] = seconds;
    return all;
  }

  void add_comparison_of_models(StudyResult& out, ConePage& page) const {
    const int n = static_cast<int>(files_.size());
    const double load = pressure_ * height_ * height_;  // whose F/h^2 is rho g h
    std::vector<Profile> own = profiles();
    if (value_.models.empty()) {
      out.comparison = without_models(std::move(own), load, height_, n);
      out.comparison.dim = 3;
    } else {
      std::vector<ModelProfiles> all = models(out, page, own);
      out.comparison = compare(std::move(own), std::move(all), load, height_, n);
      out.comparison.dim = 3;
      for (const auto& [key, figure] : summary_figures(out.comparison, 0)) {
        // The response.* keys speak of a load.
        if (!key.starts_with("response.")) out.summary[key] = figure;
      }
      out.summary["verdict.best_model"] = out.comparison.verdict.best_model;
    }
    out.comparison.scale = {
        "h", "rho g h", "apex",
        fmt::format("h = {:.6g} m, rho g h = {:.6g} Pa (rho = {:.6g} kg/m3 times mean volume "
                    "fraction {:.4g}); every cone scaled by its own; means over the angle at "
                    "radius |x|; realizations: {}",
                    height_, pressure_, mean(&ConeFrame::grain_density),
                    mean(&ConeFrame::volume_fraction), n)};
  }

  void add_own_figures(Summary& summary) const {
    if (value_.get<GrainFiles>().files.empty()) {
      summary["cone.source"] = value_.get<dem::ConeSetup>().plan.source;
    }
    const Field base = base_rings_.mean();
    const Eigen::VectorXd pressure = -base.find("sigma_zz")->value;
    // The floor pulls the grains inwards with -sigma_rz.
    const Eigen::VectorXd shear = base.find("sigma_rz")->value;
    Index at = 0, shear_at = 0;
    for (Index k = 1; k < pressure.size(); ++k) {
      if (pressure[k] > pressure[at]) at = k;
      if (shear[k] > shear[shear_at]) shear_at = k;
    }
    summary["base.centre_pressure"] = pressure[0];
    summary["base.largest_pressure"] = pressure[at];
    summary["base.largest_at"] = radii_[at];
    summary["base.largest_shear"] = shear[shear_at];
    summary["base.largest_shear_at"] = radii_[shear_at];
    summary["base.smearing_width"] = methods_.front().options.width;
    summary["dip.ratio"] = pressure[0] / pressure[at];
  }

  void add_dip(StudyResult& out) const {
    const Dip dip = judge_dip(windows_);
    out.summary["dip.window_ratio"] = dip.window_ratio;
    out.summary["dip.difference"] = dip.difference.mean;
    out.summary["dip.standard_error"] = dip.difference.standard_error;
    out.summary["dip.p_value"] = dip.difference.p_value;
    out.summary["dip.verdict"] = dip.verdict;
    std::string sentence = dip_sentence(dip);
    if (std::isnan(dip.centre)) {
      sentence = fmt::format(
          "Whether there is a dip cannot be said: of some cone fewer than {} contacts with the "
          "base are within heap.centre = {:g} of the foot's radius; raise it, or take more grains.",
          kLeastInDisk, heap().centre);
    }
    if (!out.comparison.models.empty()) sentence += " " + out.comparison.verdict.sentence;
    out.comparison.verdict.sentence = sentence;
    out.summary["verdict.sentence"] = sentence;
  }

  const Case& value_;
  const std::vector<std::string>& files_;
  const AverageSetup& setup_;
  std::vector<ConeFrame> frames_;
  double height_ = 0, pressure_ = 0;
  Eigen::VectorXd radii_;            // over h
  Eigen::MatrixXd square_, inside_;  // over h: of the base; radius and height
  int columns_ = 0, rows_ = 0;
  std::vector<ConeAverages> methods_;
  Ensemble base_, base_rings_;
  std::vector<BaseWindows> windows_;
  std::map<std::string, std::vector<double>> figures_;
  std::unique_ptr<Kernel> kernel_;
};

dem::ConeSetup setup_of_cone(const Case& value) {
  dem::ConeSetup out = value.get<dem::ConeSetup>();
  out.sleep = value.get<dem::PileSetup>().sleep;  // the section's keys are those of piles
  return out;
}

const std::vector<std::string> kConeStates{"pile"};

dem::RunResult finished_cone(const FinishedRun& place) {
  const dem::Snapshot cone = dem::read_snapshot(place.file, place.group + "/pile");
  if (cone.dim != 3) {
    throw std::invalid_argument(
        fmt::format("grains.files: {}:{}/pile is 2D, a 3D one is needed", place.file, place.group));
  }
  const bool any = std::any_of(cone.grains.begin(), cone.grains.end(),
                               [](const dem::Grain& g) { return !g.fixed; });
  if (!any || !has_base(cone)) {
    throw std::invalid_argument(
        fmt::format("grains.files: {}:{}/pile has no {}", place.file, place.group,
                    any ? "base: a wall \"floor\" or fixed grains" : "free grain"));
  }
  dem::RunResult out;
  out.snapshots.emplace_back("pile", cone);
  out.figures["dem.grains"] = static_cast<double>(std::count_if(
      cone.grains.begin(), cone.grains.end(), [](const dem::Grain& g) { return !g.fixed; }));
  return out;
}

std::unique_ptr<dem::Run> make_cone(const Case& value, std::int64_t number, int threads) {
  if (value.get<GrainFiles>().files.empty()) {
    return dem::make_cone_run(setup_of_cone(value), realization_seed(value, number), threads);
  }
  return run_of(finished_cone(finished_run(value, number, kConeStates, "cone")));
}

dem::Outlook foresee_cones(const Case& value, std::int64_t draws) {
  if (value.get<GrainFiles>().files.empty()) {
    return dem::foresee_cone(setup_of_cone(value), realization_seeds(value), draws);
  }
  try_finished_runs(value, kConeStates, "cone",
                    [](const FinishedRun& cone) { finished_cone(cone); });
  return {};
}

}  // namespace

Study cone_study() {
  Study out;
  out.name = "cone";
  out.meaning = "cones of spheres or superellipsoids: base pressure and dip, repose, stress inside";
  out.sections = {kGrainFilesKeys, kMaterialKeys, kMotionKeys,  kRestKeys,
                  kConeKeys,       kSleepKeys,    kAverageKeys, kHeapKeys};
  out.material = [](Case& c) -> dem::MaterialSetup& { return c.get<dem::ConeSetup>().material; };
  out.motion = [](Case& c) -> dem::MotionSetup& { return c.get<dem::ConeSetup>().motion; };
  out.rest = [](Case& c) -> dem::RestSetup& { return c.get<dem::ConeSetup>().rest; };
  out.figures = {cone_figures};
  out.models_optional = true;
  out.check = [](const Case& value) { check_heap_windows(value.get<HeapSetup>()); };
  out.averaged = [](const Case& value) {
    return averaged_values(value.get<AverageSetup>(), value.get<HeapSetup>().heights.size() + 1);
  };
  out.without = {"average.depths", "average.half_width", "heap.axis_from", "heap.axis_to"};
  out.fills = {"rho_g", "phi_deg", "h", "dim", "depth"};
  out.dimension = [](const Case&) { return 3; };
  out.dimension_key = "study";
  out.make_run = make_cone;
  out.foresee = foresee_cones;
  out.left_unused = [](const Case& value) { return unused_runs(value, kConeStates, "cone"); };
  out.longest_part = [](const Case&, const dem::Outlook& outlook) -> LongestPart {
    if (outlook.time_key != "cone.rate") return {};
    return {"pouring", "; sleeping makes it less"};
  };
  out.analyse = [](const Case& value, const std::vector<std::string>& files, int threads) {
    return ConeAnalysis(value, files, threads).run();
  };
  return out;
}

}  // namespace grainfield::coupling
