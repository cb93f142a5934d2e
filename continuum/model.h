// The continuum models that compete for the grains, behind one small interface.
// A new model is one file that implements Model and one line in continuum/registry.cc; one of
// finite elements a row beside its solver in continuum/fe and its ModelInfo in a list there.
#pragma once
#include <Eigen/Core>
#include <array>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "dem/shared/computation_failed.h"

namespace grainfield::continuum {

/// A parameter value that the model cannot take: names it, the value found and what is allowed.
class BadParameter : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Where a search for a constant keeps to, ends excluded; of lengths (unit m) over the height h.
struct SearchRange {
  double least = 0, most = 0;
  /// A limit that no material passes, of ratios of moduli: intervals are even in log(value -
  /// floor), so the same for a ratio and its reciprocal. -infinite: even in the value.
  double floor = -std::numeric_limits<double>::infinity();
};

/// Words of another parameter.
struct Words {
  std::string parameter;
  std::vector<std::string> any_of;
};

/// A parameter of a model, declared once: checks, documentation and command line come from it.
struct Parameter {
  std::string name;                  ///< as the user types it
  std::string unit;                  ///< "N/m", "m", "-", ...
  std::string meaning;               ///< one line, with what raising it does where not obvious
  std::string source;                ///< e.g. "Roul 5.2"
  double value = 0;                  ///< default of a number; nan: none
  double least = 0, most = 0;        ///< allowed range, inclusive unless the meaning says otherwise
  std::vector<std::string> choices;  ///< not empty: a parameter of words; the first is the default
  bool whole = false;                ///< only whole numbers
  std::optional<SearchRange> free = {};  ///< may be free in a fit: a constant of the material or an
                                         ///< angle of the model
  std::optional<Words> only_with = {};   ///< has no effect beside others
};

/// Values chosen by the user: numbers as text or words, by parameter name.
using Settings = std::map<std::string, std::string>;

/// n x dim matrix of positions in the project's axes (2D: x, y up; 3D: x, y, z up), m.
using Points = Eigen::MatrixXd;
/// n x 3 (2D: xx, yy, xy) or n x 6 (3D: xx, yy, zz, yz, xz, xy), tension positive; nan outside.
using Stresses = Eigen::MatrixXd;

/// A scalar at the points a model was asked at; nan outside its domain.
struct Quantity {
  std::string name;  ///< "displacement_x"; SI units
  Eigen::VectorXd values;
};

/// A model's own mesh of triangles with what it knows there, for files of pictures.
struct MeshField {
  Points corners;  ///< n x 2, m
  std::vector<std::array<int, 3>> triangles;
  std::vector<Quantity> at_corners, in_triangles;
  std::vector<std::pair<std::string, Points>> lines;  ///< of its own, by name
};

/// A model with its parameters set.
class Model {
 public:
  virtual ~Model() = default;
  /// Stress at the points, in Pa (3D) or N/m (2D), tension positive; a row of nan where a point is
  /// outside the model's domain. Throws ComputationFailed.
  virtual Stresses stress(const Points& points) = 0;
  /// What the model knows at the points besides the stress, in the order to be written; most models
  /// nothing. Throws ComputationFailed.
  virtual std::vector<Quantity> quantities(const Points&) { return {}; }
  /// The mesh it was solved on; without triangles where there is none. Throws ComputationFailed.
  virtual MeshField mesh() { return {}; }
  /// Figures of the evaluation that belong into summary.json, e.g. unknowns, iterations, residual.
  virtual std::map<std::string, double> figures() const { return {}; }
};

/// A figure of a model's evaluation, declared once: documentation and the check that there is no
/// other come from it.
struct Figure {
  std::string name;  ///< as in Model::figures(); '*' stands for a number
  std::string unit;  ///< "-" for pure numbers
  std::string meaning;
};

/// Makes a model from complete settings; throws BadParameter.
using MakeModel = std::function<std::unique_ptr<Model>(const Settings&)>;

/// The mesh with which a finite-element model begins.
struct FirstMesh {
  double unknowns = 0;
  std::vector<std::string> parameters;  ///< that make it fine
};

/// The registry knows this of a model before its parameters are set; settings are complete ones.
struct ModelInfo {
  std::string name;     ///< as in `grainfield model NAME`
  std::string summary;  ///< one line
  int dim = 2;          ///< of the points: 2, 3, or 0 = decided by parameter "dim"
  std::vector<Parameter> parameters;
  MakeModel make = {};
  std::vector<Figure> figures = {};  ///< all that Model::figures() may hold
  /// Why a parameter has no effect with these settings and what to do, e.g. "beside map = m.csv,
  /// which replaces it; leave one of the two out"; empty: it has one. Besides Parameter::only_with.
  std::function<std::string(const std::string& parameter, const Settings&)> without_effect = {};
  /// Its cost, told before anything is allocated. Throws BadParameter where there is no mesh.
  std::function<FirstMesh(const Settings&)> first_mesh = {};
};

/// Every model, in the order of the documentation.
const std::vector<ModelInfo>& registry();
/// The named model; throws BadParameter with the nearest names when there is none.
const ModelInfo& find_model(const std::string& name);
/// The range or the choices of a parameter in words, e.g. "above 0 m" or "smooth, rough".
std::string allowed(const Parameter& parameter);
/// The one of the names with the fewest differing letters; empty when there are none.
std::string nearest(const std::string& name, const std::vector<std::string>& names);
/// The same when it differs in at most a third of the letters: a misspelling; otherwise empty.
std::string misspelt(const std::string& name, const std::vector<std::string>& names);
/// The dimension of the points of this model with these settings: 2 or 3.
int dimension(const ModelInfo& info, const Settings& settings);
/// A model ready to evaluate. Every setting must be a known parameter within its range (throws
/// BadParameter naming the parameter, the value found, what is allowed and the nearest name).
std::unique_ptr<Model> make_model(const std::string& name, const Settings& settings);

}  // namespace grainfield::continuum
