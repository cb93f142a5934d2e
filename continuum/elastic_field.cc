#include "continuum/elastic_field.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "continuum/model.h"

namespace grainfield::continuum {
namespace {

/// A point this part of the nodes' distance beyond the grid is on its border.
constexpr double kBorder = 1e-6;

/// The moduli of a node; none where the map has no values.
std::optional<PlaneModuli> node(const osl::FieldMap& map, bool isotropic, Eigen::Index k) {
  PlaneModuli m;
  double young = 0, poisson = 0;
  if (isotropic) {
    young = map.values.at("young")[k];
    poisson = map.values.at("poisson")[k];
    if (std::isnan(young) || std::isnan(poisson)) return std::nullopt;
    m = plane_strain_moduli(young, poisson);
  } else {
    m = {map.values.at("E_x")[k], map.values.at("E_y")[k], map.values.at("nu_xy")[k],
         map.values.at("G")[k]};
    if (std::isnan(m.E_x + m.E_y + m.nu_xy + m.G)) return std::nullopt;
  }
  const double x = map.x0 + static_cast<double>(k % map.nx) * map.dx,
               y = map.y0 + static_cast<double>(k / map.nx) * map.dy;
  if (isotropic && !(young > 0 && poisson > -1 && poisson < 0.5))
    throw BadParameter(fmt::format(
        "{}: young = {:.6g}, poisson = {:.6g} at ({:.6g}, {:.6g}) is not elastic; allowed: young "
        "above 0, poisson between -1 and 0.5",
        map.file, young, poisson, x, y));
  if (!is_stable(m))
    throw BadParameter(fmt::format(
        "{}: E_x = {:.6g}, E_y = {:.6g}, nu_xy = {:.6g}, G = {:.6g} at ({:.6g}, {:.6g}) is not "
        "elastic; allowed: moduli above 0 and nu_xy^2 below E_x/E_y",
        map.file, m.E_x, m.E_y, m.nu_xy, m.G, x, y));
  return m;
}

/// The nearest node with a value.
Eigen::Index nearest_known(const osl::FieldMap& map,
                           const std::vector<std::optional<PlaneModuli>>& nodes, Eigen::Index k) {
  Eigen::Index best = -1;
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index j = 0; j < static_cast<Eigen::Index>(nodes.size()); ++j) {
    if (!nodes[static_cast<std::size_t>(j)]) continue;
    const double distance = std::hypot(static_cast<double>(j % map.nx - k % map.nx) * map.dx,
                                       static_cast<double>(j / map.nx - k / map.nx) * map.dy);
    if (distance < least) {
      least = distance;
      best = j;
    }
  }
  return best;
}

}  // namespace

Eigen::Matrix3d ElasticField::at(double x, double y) const {
  Eigen::Matrix3d c = Eigen::Matrix3d::Zero();
  c(0, 0) = map_.at("c11", x, y);
  c(1, 1) = map_.at("c22", x, y);
  c(0, 1) = c(1, 0) = map_.at("c12", x, y);
  c(2, 2) = map_.at("c66", x, y);
  return c;
}

PlaneModuli ElasticField::moduli(double x, double y) const {
  const Eigen::Matrix3d s = at(x, y).inverse();
  return {1 / s(0, 0), 1 / s(1, 1), -s(0, 1) / s(0, 0), 1 / s(2, 2)};
}

double ElasticField::require_cover(const std::string& model, const std::string& body,
                                   const Points& points, const std::string& remedy) const {
  const double right_end = map_.x0 + (map_.nx - 1) * map_.dx,
               top = map_.y0 + (map_.ny - 1) * map_.dy;
  const double slack_x = kBorder * map_.dx, slack_y = kBorder * map_.dy;
  std::array<double, 2> covered{}, all{};  // left and right of x = 0
  for (Eigen::Index n = 0; n < points.rows(); ++n) {
    const double x = points(n, 0), y = points(n, 1);
    const std::size_t side = x < 0 ? 0 : 1;
    all[side] += 1;
    if (x < map_.x0 - slack_x || x > right_end + slack_x || y < map_.y0 - slack_y ||
        y > top + slack_y)
      continue;
    const auto column = std::clamp(std::lround((x - map_.x0) / map_.dx), 0L, map_.nx - 1L),
               row = std::clamp(std::lround((y - map_.y0) / map_.dy), 0L, map_.ny - 1L);
    covered[side] += known_[static_cast<std::size_t>(column + map_.nx * row)];
  }
  for (const std::size_t side : {0, 1}) {
    if (covered[side] >= kLeastCover * all[side]) continue;
    throw BadParameter(fmt::format(
        "model {}: map = {} has constants for {:.3g} % of the {}'s {} half; allowed: {:g} % or "
        "more; {}",
        model, map_.file, 100 * covered[side] / all[side], body, side == 0 ? "left" : "right",
        100 * kLeastCover, remedy));
  }
  return (covered[0] + covered[1]) / (all[0] + all[1]);
}

ElasticField read_elastic_field(const std::string& file) {
  osl::FieldMap read = osl::read_field_map(
      file, {"young", "poisson", "young_error", "poisson_error", "E_x", "E_y", "nu_xy", "G"}, true);
  const auto has = [&](const char* name) { return read.values.count(name) != 0; };
  const bool isotropic = has("young") && has("poisson");
  const bool orthotropic = has("E_x") && has("E_y") && has("nu_xy") && has("G");
  if (isotropic == orthotropic)
    throw BadParameter(
        file +
        ": the header has neither or both of young,poisson and E_x,E_y,nu_xy,G; allowed: one");
  const Eigen::Index n = static_cast<Eigen::Index>(read.nx) * read.ny;
  std::vector<std::optional<PlaneModuli>> nodes;
  for (Eigen::Index k = 0; k < n; ++k) nodes.push_back(node(read, isotropic, k));
  ElasticField out;
  for (const auto& known : nodes) out.known_.push_back(known.has_value());
  out.map_ = read;
  out.map_.values.clear();
  for (const char* name : {"c11", "c22", "c12", "c66"}) out.map_.values[name].resize(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Index from =
        nodes[static_cast<std::size_t>(k)] ? k : nearest_known(read, nodes, k);
    if (from < 0)
      throw BadParameter(file + ": no node has elastic constants; allowed: one or more");
    const Eigen::Matrix3d c = stiffness(*nodes[static_cast<std::size_t>(from)]);
    out.map_.values["c11"][k] = c(0, 0);
    out.map_.values["c22"][k] = c(1, 1);
    out.map_.values["c12"][k] = c(0, 1);
    out.map_.values["c66"][k] = c(2, 2);
  }
  return out;
}

}  // namespace grainfield::continuum
