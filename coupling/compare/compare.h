// The simulation's profiles against the models', with the ensemble's errors, and the verdict
// (docs/comparison.md).
#pragma once
#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "continuum/constants.h"
#include "coupling/compare/shape.h"
#include "coupling/judge/judgement.h"

namespace grainfield::coupling {

/// The simulation along one horizontal line.
struct Profile {
  std::string name;                    ///< "depth 0.075 m", "base"
  std::string key;                     ///< for summary keys: "depth_0.075", "base"
  double depth = 0;                    ///< m below the surface
  std::string quantity = "-sigma_yy";  ///< what the columns hold
  std::string unit = "N/m";
  Eigen::VectorXd x;              ///< m from the load, ascending
  Eigen::VectorXd mean;           ///< over realizations
  Eigen::VectorXd error;          ///< standard error of the mean; nan or empty with one realization
  Eigen::MatrixXd samples;        ///< x.size() x realizations, or empty
  double independent_length = 0;  ///< m: Kernel::independent_length; 0: every point counts
  bool measured = false;          ///< in a laboratory: texts speak of no grains
};

/// One model on all the profiles' points, smoothed as the data are (compare/smooth.h).
struct ModelProfiles {
  std::string key;                      ///< for summary keys, e.g. "layer_smooth"
  std::string label;                    ///< for people, e.g. "elastic layer, smooth base"
  std::string family;                   ///< "half plane", "finite layer", ...; see family_of
  std::vector<Eigen::VectorXd> values;  ///< one per profile, same points; nan = no value there
  /// The same between the points, for pictures of profiles with few: x, m, and values, one of each
  /// per profile. Empty: nothing is known there.
  std::vector<Eigen::VectorXd> line_x = {}, line = {};
};

/// A profile with fewer points than kFewPlaces is too coarse for a model's line, which is drawn
/// through kDrawnPlaces of its own.
inline constexpr Eigen::Index kFewPlaces = 60, kDrawnPlaces = 101;
/// kDrawnPlaces points from the least to the largest first coordinate of these, which share the
/// rest.
Eigen::MatrixXd drawn_places(const Eigen::MatrixXd& points);

/// What the verdict calls a registry model: flamant, orthotropic_half_plane, fe_elastic_half_space:
/// "half plane"; boussinesq, transverse_half_space: "half space"; layer, fe_elastic_layer: "finite
/// layer"; others: their own name.
std::string family_of(const std::string& model_name);

/// Distance of a model from the simulation.
struct Measures {
  double rel_l2 = 0;        ///< |simulation - model| / |simulation|, root of the sums of squares
  double largest = 0;       ///< largest |simulation - model|, the profile's unit
  double largest_at = 0;    ///< its x, m
  std::string largest_in;   ///< its profile's name
  double chi2_per_dof = 0;  ///< the misfit of statistics/agreement.h; nan without errors
  double chance = 0;        ///< the misfit that a true model exceeds in 1 of 100 ensembles
  double dof = 0;           ///< independent values behind the misfit
};

struct ModelComparison {
  std::string key, label, family;
  std::vector<Measures> per_profile;
  Measures overall;
  std::vector<ProfileShape> shapes;  ///< of the model, one per profile
};

/// How lengths and stresses of a comparison are made dimensionless.
struct Scale {
  double h = 0;                 ///< m
  double unit = 0;              ///< of stresses, N/m (3D: Pa)
  double load = kNan;           ///< F, N; nan: there is none
  std::string stress = "F/h";   ///< name of the unit
  std::string x_from = "load";  ///< where x = 0
  std::string note;             ///< one line for tables
};
/// The scale of responses to a load: F/h, in space F/h^2. `more` ends the note.
Scale scale_of_load(double force, double h, int dim = 2, const std::string& more = "");
/// The scale of heaps: rho g h. `what` ends the note.
Scale scale_of_heaps(double h, double pressure, const std::string& what,
                     const std::string& x_from = "apex", int dim = 2);
/// "; every pile scaled by its own; realizations: N".
std::string scaled_alone(int realizations);

struct Comparison {
  std::vector<Profile> profiles;
  std::vector<Profile> beside;  ///< other averages of the same places: in tables, not compared
  std::vector<ModelProfiles> models;
  std::vector<ProfileShape> shapes;        ///< of the simulation, one per profile
  std::vector<ProfileShape> shape_errors;  ///< their standard errors: compare/shape.h
  std::vector<ModelComparison> results;    ///< in the order of models
  Judgement judgement;
  int realizations = 1;
  Scale scale;
  int dim = 2;  ///< of the grains

  bool measured() const { return !profiles.empty() && profiles.front().measured; }
  /// "measurement" or "grains".
  const char* subject() const { return measured() ? "measurement" : "grains"; }
  /// What tables call the profiles' own column.
  const char* column() const { return measured() ? "measured" : "simulation"; }
  /// What pictures call the profiles: "grains, mean of 8", "grains", "measured".
  std::string label() const;
};

/// The simulation alone: shapes of the profiles, no models, no verdict. Throws
/// std::invalid_argument for no profile, sizes that differ, or a profile that is nan everywhere.
Comparison without_models(std::vector<Profile> profiles, const Scale& scale, int realizations = 0);

/// `realizations`: behind the profiles' errors; 0: as many as the profiles have samples. Throws
/// std::invalid_argument for no profile, no model, sizes that differ, a simulation that is nan
/// everywhere, or no point that both it and a model have.
Comparison compare(std::vector<Profile> profiles, std::vector<ModelProfiles> models,
                   const Scale& scale, int realizations = 0);

/// Indices of the models in the judgement's order; without models in their own order.
std::vector<std::size_t> ranked(const Comparison& comparison);

struct DrawnLine {
  Eigen::VectorXd x, y;  ///< m, the profile's unit
};
/// A model on a profile, for pictures: at the points between where they are known, else at its own.
DrawnLine drawn_line(const Comparison& comparison, std::size_t model, std::size_t profile);

/// The comparison's summary keys: compare.MODEL.{rel_l2,max,chi2_per_dof,chance,dof}, also per
/// profile as compare.MODEL.PROFILE.*, and of the profile `main` (index)
/// response.{peak,peak_at,width,rms_width,peaks,integral}, with .standard_error from two
/// realizations on (not of peak_at and peaks).
std::map<std::string, double> summary_figures(const Comparison& comparison, std::size_t main);

/// Fills chi2_per_dof, chance and dof of comparison.results, per profile and overall, and
/// comparison.judgement. Needs profiles, models and the rest of the results.
void judge_comparison(Comparison& comparison);

}  // namespace grainfield::coupling
