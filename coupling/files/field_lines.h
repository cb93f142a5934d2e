// Horizontal lines of an averaged field, as profiles that models are compared with.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "coupling/averaging/kernel.h"
#include "coupling/compare/compare.h"
#include "coupling/field.h"
#include "coupling/models/models.h"

namespace grainfield::coupling {

/// What a field shows.
enum class Scene {
  response,  ///< of a layer to a load: attributes F and h; unit F/h, in space F/h^2
  heap,      ///< frame "heap": unit rho g h
  layer,     ///< a layer at rest, or any field whose origin is known: unit 1 N/m
};

/// One horizontal line of one stress.
struct FieldLine {
  Profile profile;
  Eigen::MatrixXd points;  ///< models' frame, m
  bool flat = false;       ///< seen along x, in space over the plane
  int component = 1;       ///< of the models' stresses: 0 xx, 1 yy, 2 xy; in space kSpaceStress
  double sign = -1;        ///< profile over stress: pressures are positive, shear keeps its sign
  std::shared_ptr<const Kernel> kernel;
};

/// A field in the models' frame, in m and N/m (in space Pa). Rings (rings.h) lie in the half plane
/// y = 0, with r, t and z for x, y and z.
struct SceneField {
  Scene scene = Scene::response;
  std::string name;
  Field field;
  RunFacts facts;   ///< what it knows for models; force nan without a load
  double unit = 1;  ///< N/m
  double apex = 0;  ///< m, of the models' cone above the field's origin
  std::shared_ptr<const Kernel> kernel;
  std::string seen;    ///< "coarse_graining, lucy, 0.009 m"
  bool rings = false;  ///< averages over rings
};

struct LineOptions {
  std::vector<std::string> components;  ///< empty: sigma_yy, in space sigma_zz
  std::vector<double> heights;          ///< of a grid's rows: shares of the height; empty: three
  std::vector<double> origin;  ///< x, y of the models' origin in the field's frame; empty: (0, 0)
};

/// `name`: of the field in its file; `where`: for messages. Throws std::invalid_argument beginning
/// with `where` for missing attributes, or frame "packing" without an origin.
SceneField scene_field(Field field, const std::string& name, const LineOptions& options,
                       const std::string& where);

/// Every horizontal row of lines and cuts; of a grid the rows nearest to options.heights. In space
/// rows run along x, at each height those nearest to y = 0. Rows with
/// fewer than 3 values are left out. Throws std::invalid_argument for missing components, and when
/// no row is left.
std::vector<FieldLine> lines_of(const SceneField& scene, const LineOptions& options,
                                const std::string& where);

}  // namespace grainfield::coupling
