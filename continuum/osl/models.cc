#include "continuum/osl/models.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "continuum/closed/models.h"
#include "continuum/closed/osl.h"
#include "continuum/fe_models.h"
#include "continuum/osl/field_map.h"
#include "continuum/osl/flux.h"
#include "continuum/settings.h"
#include "continuum/without_effect.h"

namespace grainfield::continuum {
namespace osl {
namespace {

constexpr char wedge_name[] = "fe_osl_wedge";
constexpr char layer_name[] = "fe_osl_layer";
/// Points this share of a heap's width beyond its slope are on it.
constexpr double kOnSlope = 1e-9;
/// Width of the load and room beyond the farthest characteristic where none are chosen, in depths.
constexpr double kLoadWidth = 0.1, kRoom = 0.1;
/// Columns of at most half the load's width, on either side.
constexpr double kMostColumns = 1e6;
/// A million unknowns take 190 MB and a second of CPU time.
constexpr double kMostUnknowns = 1e7;

double number_or(const Settings& s, const std::string& name, double otherwise) {
  const double value = number_of(s, name);
  return std::isnan(value) ? otherwise : value;
}

/// The same closure as of the closed form `osl`: what is left open is such that the slope yields.
Closure heap_closure(const Settings& s, double phi) {
  const double eta = number_of(s, "eta"), mu = number_of(s, "mu");
  if (std::isnan(eta)) {
    const double free = std::isnan(mu) ? -std::tan(phi) : mu;
    return {eta_at_yield(phi, free), free};
  }
  return {eta, std::isnan(mu) ? mu_at_yield(phi, eta) : mu};
}

/// Where a map gives eta or mu alone and the other is left open, it is everywhere as the yielding
/// slope asks for with the map's value.
void leave_open(Problem& p, const Settings& s, const FieldMap& map, double phi) {
  const bool has_eta = map.values.count("eta") != 0, has_mu = map.values.count("mu") != 0;
  if (has_eta && !has_mu && std::isnan(number_of(s, "mu")))
    p.mu = [eta = p.eta, phi](double x, double y) { return mu_at_yield(phi, eta(x, y)); };
  if (has_mu && !has_eta && std::isnan(number_of(s, "eta")))
    p.eta = [mu = p.mu, phi](double x, double y) { return eta_at_yield(phi, mu(x, y)); };
}

/// Before a mesh of so many columns in all is made.
void require_memory(const std::string& name, const Settings& s, double columns,
                    const std::string& remedy) {
  const bool march = s.at("solver") == "march";
  const double order = number_of(s, "order");
  const double unknowns =
      2 * columns * (march ? 1 : number_of(s, "rows") * (order + 1) * (order + 1));
  if (unknowns <= kMostUnknowns) return;
  const std::string also =
      march ? "" : fmt::format(", rows = {} and order = {}", s.at("rows"), s.at("order"));
  throw BadParameter(fmt::format(
      "model {}: {:.0f} columns (columns = {}){} ask for {:.3g} unknowns; allowed: up to {:g}; "
      "lower columns{}{}",
      name, columns, s.at("columns"), also, unknowns, kMostUnknowns, march ? "" : ", rows or order",
      remedy));
}

/// Coefficients, numerics and what both bodies share.
Task begin(const std::string& name, const Settings& s, const Closure& closure,
           const FieldMap& map) {
  Task task;
  Problem& p = task.problem;
  p.name = name;
  p.weight = map.field("rho_g", number_of(s, "rho_g"));
  p.eta = map.field("eta", closure.eta);
  p.mu = map.field("mu", closure.mu);
  task.order = static_cast<int>(number_of(s, "order"));
  task.march.tolerance = number_of(s, "tolerance");
  task.march.most_steps = static_cast<long>(number_of(s, "steps"));
  return task;
}

Task wedge_task(const Settings& s) {
  const double phi = number_of(s, "phi_deg") * std::numbers::pi / 180, slope = 1 / std::tan(phi);
  const double depth = number_of(s, "h");
  const FieldMap map = read_field_map(s.at("map"));
  map.require_cover(wedge_name, slope * depth, depth);
  Task task = begin(wedge_name, s, heap_closure(s, phi), map);
  leave_open(task.problem, s, map, phi);
  task.slope = slope;
  const Characteristics c = characteristics(task.problem, 0, 0, 1);
  require_entering(task.problem, c, upwind_flux(c, 1, -slope), slope, 0, 0);
  const int columns = static_cast<int>(number_of(s, "columns"));
  const int rows = static_cast<int>(number_of(s, "rows"));
  require_memory(wedge_name, s, 2. * columns, "");
  if (columns < 2 && s.at("mesh") == "aligned")
    throw BadParameter(
        fmt::format("model {}: columns = {} does not fit the heap; allowed with mesh = aligned: at "
                    "least 2, one on either side of the characteristic from the apex",
                    wedge_name, columns));
  if (s.at("mesh") == "box") {
    task.mesh = box_mesh(slope * depth, depth, columns, rows);
    task.problem.weight = [inside = task.problem.weight, slope](double x, double y) {
      return std::abs(x) < slope * y ? inside(x, y) : 0;
    };
  } else {
    task.mesh = heap_mesh(slope, depth, columns, rows, s.at("mesh") == "aligned" ? c.downwind : 0);
  }
  task.figures = {{"c1", c.downwind}, {"c2", c.upwind}, {"half_width", slope * depth}};
  return task;
}

Task layer_task(const Settings& s) {
  const double depth = number_of(s, "h"), load = number_of(s, "F");
  const double width = number_or(s, "width", kLoadWidth * depth);
  const FieldMap map = read_field_map(s.at("map"));
  Task task = begin(layer_name, s, {number_of(s, "eta"), number_of(s, "mu")}, map);
  Problem& p = task.problem;
  p.mirrored = s.at("closure") == "mirrored";
  p.sides = s.at("sides") == "walls" ? Sides::walls : Sides::far;
  p.wall_friction = number_of(s, "wall_friction");
  const Characteristics c = characteristics(p, 0, 0, 1);
  if (p.sides == Sides::walls && !(c.eta > 0))
    throw BadParameter(fmt::format(
        "model {}: eta = {:.6g} has both characteristics on one side of the vertical; allowed "
        "between walls: above 0",
        layer_name, c.eta));
  const double reach = std::max(std::abs(c.downwind), std::abs(c.upwind));
  const double asked = depth * number_or(s, "half_width", reach + kRoom + width / (2 * depth));
  if (asked < width / 2)
    throw BadParameter(fmt::format(
        "model {}: half_width = {:.6g} depths does not fit the load; allowed: at least {:.6g}, "
        "half of width",
        layer_name, asked / depth, width / (2 * depth)));
  // The load ends on borders of columns.
  const double wanted = number_of(s, "columns") * (width / (2 * depth));
  const double under = std::max(1., std::round(wanted)), step = width / 2 / under;
  if (!(asked / step <= kMostColumns))
    throw BadParameter(fmt::format(
        "model {}: width = {:.6g} m asks for {:.3g} columns over half the layer's width of {:.6g} "
        "m; allowed: up to {:.0e} columns, {} or less half_width",
        layer_name, width, asked / step, asked, kMostColumns,
        wanted < 1 ? "a wider load" : "less width, fewer columns"));
  const int columns = static_cast<int>(std::max(under, std::ceil(asked / step - kOnSlope)));
  const double half_width = columns * step;
  require_memory(layer_name, s, 2. * columns, ", or half_width");
  task.mesh = box_mesh(half_width, depth, columns, static_cast<int>(number_of(s, "rows")));
  map.require_cover(layer_name, half_width, depth);
  p.surface = [load, width](double x, double) -> State {
    if (!(std::abs(x) < width / 2)) return State::Zero();
    return {load / width * (1 + std::cos(2 * std::numbers::pi * x / width)), 0};
  };
  p.beyond = [weight = p.weight](double x, double y) {
    // Simpson's rule: exact for a weight that is constant or changes evenly with depth.
    return State(y / 6 * (weight(x, 0) + 4 * weight(x, y / 2) + weight(x, y)), 0);
  };
  task.figures = {
      {"c1", c.downwind}, {"c2", p.mirrored ? -c.downwind : c.upwind}, {"half_width", half_width}};
  return task;
}

class MarchModel : public Model {
 public:
  explicit MarchModel(Task task) : task_(std::move(task)) {}
  Stresses stress(const Points& points) override {
    Eigen::MatrixXd below = points;
    below.col(1) *= -1;
    const MarchResult result = march(task_.problem, task_.mesh, below, task_.march);
    figures_ = result.figures;
    Stresses out(points.rows(), 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i)
      out.row(i) = in_project_axes(task_, result.states[i], points(i, 0), points(i, 1));
    return out;
  }
  std::map<std::string, double> figures() const override {
    auto all = figures_;
    all.insert(task_.figures.begin(), task_.figures.end());
    return all;
  }

 private:
  Task task_;
  std::map<std::string, double> figures_;
};

MakeModel made(const std::string& name) {
  return [name, by_elements = in_fe_library(name)](const Settings& s) -> std::unique_ptr<Model> {
    if (s.at("solver") == "dg") return by_elements(s);
    return std::make_unique<MarchModel>(make_task(name, s));
  };
}

/// Nothing beyond what make_task() refuses.
std::function<FirstMesh(const Settings&)> checked(const std::string& name) {
  return [name](const Settings& s) {
    make_task(name, s);
    return FirstMesh();
  };
}

std::vector<Parameter> with_numerics(std::vector<Parameter> all, int order, int columns, int rows,
                                     const std::string& columns_meaning,
                                     const std::string& left_open) {
  for (auto& p : std::vector<Parameter>{
           choice("solver",
                  "dg: discontinuous Galerkin finite elements; march: finite volumes marched down "
                  "by Runge-Kutta (ARKode)",
                  "numerics", {"dg", "march"}),
           only_with(
               whole_number("order", "dg: polynomial degree; the error falls like size^(order + 1)",
                            "numerics", order, 0, 8),
               "solver", {"dg"}),
           whole_number("columns", columns_meaning, "numerics", columns, 1, 100000),
           only_with(whole_number("rows", "dg: cells over the depth", "numerics", rows, 1, 100000),
                     "solver", {"dg"}),
           only_with(number("tolerance", "-", "march: relative error of the integration over depth",
                            "numerics", 1e-9, 1e-14, 0.1),
                     "solver", {"march"}),
           only_with(whole_number("steps", "march: most steps", "numerics", 1000000, 1, 1000000000),
                     "solver", {"march"}),
           text("map",
                "CSV file of fields on a regular grid, columns x,y and one or more of "
                "rho_g,eta,mu, which then replace these parameters" +
                    left_open,
                "measured fields")})
    all.push_back(std::move(p));
  return all;
}

}  // namespace

Task make_task(const std::string& name, const Settings& settings) {
  return name == wedge_name ? wedge_task(settings) : layer_task(settings);
}

Eigen::RowVector3d in_project_axes(const Task& task, const State& u, double x, double y) {
  const bool outside =
      task.slope > 0 && !(std::abs(x) <= -task.slope * y * (1 + kOnSlope) ||
                          (x == 0 && std::abs(y) <= kOnSlope * task.mesh.rows.back()));
  if (outside || !std::isfinite(u.sum()))
    return Eigen::RowVector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  const double depth = std::clamp(-y, 0., task.mesh.rows.back());
  const Characteristics c = characteristics(task.problem, x, depth, x < 0 ? -1 : 1);
  return {-c.sxx(u), -u[0], u[1]};
}

}  // namespace osl

namespace {

// Figures of finite elements and of marching.
std::vector<Figure> osl_figures() {
  return {{"c1", "-", "dx/d(depth) of the characteristic to the right"},
          {"c2", "-", "dx/d(depth) of the characteristic to the left"},
          {"half_width", "m", "half the width of the solved body at its base"},
          {"unknowns", "-", "unknowns of the last mesh"},
          {"cells", "-", "cells of the last mesh"},
          {"steps", "-", "by marching: steps in depth"},
          {"residual", "-", "largest residual of the linear equations over the load's"},
          {"base_force", "N", "vertical force on the base"},
          {"side_force", "N", "vertical force on the sides"},
          {"weight", "N", "weight of the body"},
          {"load", "N", "vertical load on the surface"},
          {"force_balance", "-",
           "what base_force + side_force differ from weight + load by, over the largest of them"},
          {"solve_s", "s", "wall time of solving"}};
}

std::string without_effect(const std::string& parameter, const Settings& s) {
  if (parameter != "rho_g" && parameter != "eta" && parameter != "mu") return {};
  const auto columns = osl::map_columns(s.at("map"));
  const bool given = std::find(columns.begin(), columns.end(), parameter) != columns.end();
  return given ? replaced_by("map", s) : std::string();
}

ModelInfo wedge() {
  return {
      osl::wedge_name,
      "heap with oriented stress linearity as a field problem: finite elements or marching",
      2,
      osl::with_numerics(
          {friction_angle(), weight(),
           number("h", "m", "height of the heap", "Roul 4.2", 1, kLeastScale, kMostScale),
           optional_number("eta", "-", "unset: as the yielding slope asks for, as of osl",
                           "Roul 4.22, 4.24", -kMostScale, kMostScale),
           optional_number("mu", "-", "unset: as the yielding slope asks for, as of osl",
                           "Roul 4.22, 4.24", -kMostScale, kMostScale),
           choice("mesh",
                  "aligned: along slopes, axis and the characteristic from the apex; rays: along "
                  "slopes and axis; box: rectangles, weightless beyond the slopes",
                  "numerics", {"aligned", "rays", "box"})},
          2, 16, 16, "columns on either side of the axis",
          "; of eta and mu the one that is left open is as the yielding slope asks for with the "
          "map's other one"),
      osl::made(osl::wedge_name),
      osl_figures(),
      without_effect,
      osl::checked(osl::wedge_name)};
}

ModelInfo layer() {
  return {
      osl::layer_name,
      "layer with oriented stress linearity as a field problem: finite elements or marching",
      2,
      osl::with_numerics(
          {number("F", "N", "load at the origin, down", "Roul 5.6", 1, 0, kMostScale),
           number("h", "m", "depth of the layer", "Roul 5.6", 1, kLeastScale, kMostScale),
           number("rho_g", "N/m3", "weight of a unit volume (N/m2 with an areal density)",
                  "force balance", 0, 0, kMostScale),
           number("eta", "-", "sigma_xx / sigma_yy without shear", "Roul 4.22", 0.5, -kMostScale,
                  kMostScale),
           number("mu", "-", "tilts the characteristics", "Roul 4.22", 0, -kMostScale, kMostScale),
           choice("closure", "uniform: mu everywhere as it is; mirrored: with the sign of x",
                  "Roul 4.22", {"uniform", "mirrored"}),
           optional_number("width", "m",
                           "the load is spread as 1 + cos over this width; unset: "
                           "h/10",
                           "stated load", kLeastScale, kMostScale),
           optional_number("half_width", "h",
                           "half the width of the domain, in depths; unset: what the load reaches",
                           "numerics", kAboveZero, 1000),
           choice("sides",
                  "far: the layer goes on; walls: rigid walls with wall_friction, which reflect",
                  "hyperbolic layer", {"far", "walls"}),
           only_with(number("wall_friction", "-", "|sigma_xy| / sigma_xx at walls, down; 0: smooth",
                            "Janssen", 0, 0, 100),
                     "sides", {"walls"})},
          3, 40, 40, "columns over a length of one depth", ""),
      osl::made(osl::layer_name),
      osl_figures(),
      without_effect,
      osl::checked(osl::layer_name)};
}

}  // namespace

std::vector<ModelInfo> osl_models() { return {wedge(), layer()}; }

}  // namespace grainfield::continuum
