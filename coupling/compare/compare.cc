#include "coupling/compare/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "continuum/constants.h"

namespace grainfield::coupling {
namespace {

void check(const std::vector<Profile>& profiles, const std::vector<ModelProfiles>& models) {
  if (profiles.empty()) throw std::invalid_argument("nothing to compare: no profile");
  for (const Profile& p : profiles) {
    if (p.mean.size() != p.x.size() || (p.error.size() != 0 && p.error.size() != p.x.size()) ||
        (p.samples.size() != 0 && p.samples.rows() != p.x.size()))
      throw std::invalid_argument(
          fmt::format("profile \"{}\": {} positions, {} means, {} errors, {} rows of samples",
                      p.name, p.x.size(), p.mean.size(), p.error.size(), p.samples.rows()));
    if (!(p.mean.array().isFinite().any()))
      throw std::invalid_argument(
          fmt::format("profile \"{}\" has no value: no point has enough grains around it; take a "
                      "wider and deeper packing, or a lower average.width_diameters",
                      p.name));
  }
  for (const ModelProfiles& m : models) {
    if (m.values.size() != profiles.size())
      throw std::invalid_argument(fmt::format("model \"{}\" has {} profiles, the simulation {}",
                                              m.key, m.values.size(), profiles.size()));
    for (std::size_t k = 0; k < profiles.size(); ++k)
      if (m.values[k].size() != profiles[k].x.size())
        throw std::invalid_argument(
            fmt::format("model \"{}\" has {} values on profile \"{}\" of {} points", m.key,
                        m.values[k].size(), profiles[k].name, profiles[k].x.size()));
  }
}

// Sums over points that both the simulation and a model have.
struct Totals {
  double difference = 0, simulation = 0;
};

Measures measure(const Profile& p, const Eigen::VectorXd& model, Totals& totals) {
  Measures m;
  m.largest_in = p.name;
  m.chi2_per_dof = m.chance = m.dof = kNan;
  double difference = 0, simulation = 0;
  int points = 0;
  for (Eigen::Index k = 0; k < p.x.size(); ++k) {
    const double d = p.mean[k] - model[k];
    if (!std::isfinite(d)) continue;
    ++points;
    difference += d * d;
    simulation += p.mean[k] * p.mean[k];
    if (std::abs(d) > m.largest || points == 1) {
      m.largest = std::abs(d);
      m.largest_at = p.x[k];
    }
  }
  if (points == 0) {
    m.rel_l2 = m.largest = m.largest_at = kNan;
    return m;
  }
  m.rel_l2 = std::sqrt(difference / simulation);
  totals.difference += difference;
  totals.simulation += simulation;
  return m;
}

// Without one where there are too few values for it.
ProfileShape shape_of(const Eigen::VectorXd& x, const Eigen::VectorXd& value,
                      const Eigen::VectorXd& error) {
  if (value.array().isFinite().count() >= 3) return profile_shape(x, value, error);
  return {kNan, kNan, kNan, kNan, 0, kNan};
}

// Everything but models and profiles.
Comparison described(const std::vector<Profile>& profiles, const Scale& scale, int realizations) {
  Comparison c;
  c.scale = scale;
  c.realizations = realizations > 0
                       ? realizations
                       : std::max<int>(1, static_cast<int>(profiles.front().samples.cols()));
  for (const Profile& p : profiles) {
    c.shapes.push_back(shape_of(p.x, p.mean, p.error));
    c.shape_errors.push_back(shape_errors(p.x, p.samples));
  }
  return c;
}

}  // namespace

Scale scale_of_load(double force, double h, int dim, const std::string& more) {
  const bool space = dim == 3;
  Scale out{h, space ? force / (h * h) : force / h, force, space ? "F/h^2" : "F/h", "load", ""};
  out.note = fmt::format("F = {:.6g} N, h = {:.6g} m, {} = {:.6g} {}{}", force, h, out.stress,
                         out.unit, space ? "Pa" : "N/m", more);
  return out;
}

Scale scale_of_heaps(double h, double pressure, const std::string& what, const std::string& x_from,
                     int dim) {
  return {h,
          pressure,
          kNan,
          "rho g h",
          x_from,
          fmt::format("h = {:.6g} m, rho g h = {:.6g} {}{}", h, pressure, dim == 3 ? "Pa" : "N/m",
                      what)};
}

std::string scaled_alone(int realizations) {
  return fmt::format("; every pile scaled by its own; realizations: {}", realizations);
}

Comparison without_models(std::vector<Profile> profiles, const Scale& scale, int realizations) {
  check(profiles, {});
  Comparison c = described(profiles, scale, realizations);
  c.profiles = std::move(profiles);
  return c;
}

std::string family_of(const std::string& model_name) {
  if (model_name == "flamant" || model_name == "fe_elastic_half_space" ||
      model_name == "orthotropic_half_plane")
    return "half plane";
  if (model_name == "boussinesq" || model_name == "transverse_half_space" ||
      model_name == "fe_transverse_half_space")
    return "half space";
  if (model_name == "layer" || model_name == "fe_elastic_layer" ||
      model_name == "orthotropic_layer" || model_name == "fe_orthotropic_layer" ||
      model_name == "transverse_layer" || model_name == "fe_transverse_layer")
    return "finite layer";
  return model_name;
}

Comparison compare(std::vector<Profile> profiles, std::vector<ModelProfiles> models,
                   const Scale& scale, int realizations) {
  if (!profiles.empty() && models.empty()) {
    throw std::invalid_argument("nothing to compare with: no model");
  }
  check(profiles, models);
  Comparison c = described(profiles, scale, realizations);
  for (const ModelProfiles& model : models) {
    ModelComparison result{model.key, model.label, model.family, {}, {}, {}};
    Totals totals;
    for (std::size_t k = 0; k < profiles.size(); ++k) {
      result.per_profile.push_back(measure(profiles[k], model.values[k], totals));
      const Measures& m = result.per_profile.back();
      if (std::isfinite(m.largest) && !(result.overall.largest >= m.largest)) {
        result.overall.largest = m.largest;
        result.overall.largest_at = m.largest_at;
        result.overall.largest_in = m.largest_in;
      }
      result.shapes.push_back(shape_of(profiles[k].x, model.values[k], {}));
    }
    result.overall.rel_l2 = std::sqrt(totals.difference / totals.simulation);
    c.results.push_back(std::move(result));
  }
  if (std::none_of(c.results.begin(), c.results.end(),
                   [](const ModelComparison& r) { return std::isfinite(r.overall.rel_l2); })) {
    throw std::invalid_argument(fmt::format(
        "nothing to compare on {}{}: no point has a value both of the simulation and of "
        "a model; choose heights inside both",
        profiles.front().name, profiles.size() > 1 ? " and the others" : ""));
  }
  c.profiles = std::move(profiles);
  c.models = std::move(models);
  judge_comparison(c);
  return c;
}

std::string Comparison::label() const {
  if (measured()) return "measured";
  return realizations > 1 ? fmt::format("grains, mean of {}", realizations) : "grains";
}

std::vector<std::size_t> ranked(const Comparison& c) {
  std::vector<std::size_t> order(c.models.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto place = [&](std::size_t m) {
    const auto& ranking = c.judgement.models;
    return std::find_if(ranking.begin(), ranking.end(),
                        [&](const JudgedModel& j) { return j.name == c.models[m].key; }) -
           ranking.begin();
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return place(a) < place(b); });
  return order;
}

Eigen::MatrixXd drawn_places(const Eigen::MatrixXd& points) {
  Eigen::MatrixXd out = points.row(0).replicate(kDrawnPlaces, 1);
  out.col(0) =
      Eigen::VectorXd::LinSpaced(kDrawnPlaces, points.col(0).minCoeff(), points.col(0).maxCoeff());
  return out;
}

DrawnLine drawn_line(const Comparison& c, std::size_t model, std::size_t profile) {
  const ModelProfiles& m = c.models[model];
  if (profile < m.line.size() && m.line[profile].size() > 0) {
    return {m.line_x[profile], m.line[profile]};
  }
  return {c.profiles[profile].x, m.values[profile]};
}

std::map<std::string, double> summary_figures(const Comparison& c, std::size_t main) {
  std::map<std::string, double> figures;
  const auto put = [&](const std::string& prefix, const Measures& m) {
    figures[prefix + "rel_l2"] = m.rel_l2;
    figures[prefix + "max"] = m.largest;
    figures[prefix + "chi2_per_dof"] = m.chi2_per_dof;
    figures[prefix + "chance"] = m.chance;
    figures[prefix + "dof"] = m.dof;
  };
  for (const ModelComparison& result : c.results) {
    const std::string prefix = "compare." + result.key + ".";
    put(prefix, result.overall);
    for (std::size_t k = 0; k < c.profiles.size(); ++k)
      put(prefix + c.profiles[k].key + ".", result.per_profile[k]);
  }
  if (main < c.shapes.size()) {
    const ProfileShape &s = c.shapes[main], &error = c.shape_errors[main];
    const auto put_shape = [&](const std::string& name, double value, double its_error) {
      figures["response." + name] = value;
      if (std::isfinite(its_error)) figures["response." + name + ".standard_error"] = its_error;
    };
    put_shape("peak", s.peak, error.peak);
    put_shape("width", s.fwhm, error.fwhm);
    put_shape("rms_width", s.rms_width, error.rms_width);
    put_shape("integral", s.integral, error.integral);
    figures["response.peak_at"] = s.peak_at;
    figures["response.peaks"] = s.peaks;
  }
  return figures;
}

}  // namespace grainfield::coupling
