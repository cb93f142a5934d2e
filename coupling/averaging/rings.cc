#include "coupling/averaging/rings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "coupling/averaging/quantities.h"

namespace grainfield::coupling {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;

// Places that are averaged together.
constexpr Index kPlaces = 1 << 18;

Index directions_of(double radius, const AverageOptions& options) {
  const double spacing = options.width / (options.method == "coarse_graining" ? 3 : 5);
  return std::max<Index>(8, static_cast<Index>(std::ceil(2 * std::numbers::pi * radius / spacing)));
}

// Components of one quantity: columns [first, last) of a field.
struct Group {
  std::size_t first, last;
  Rank rank;
};

std::vector<Group> groups_of(const Layout& layout) {
  std::vector<Group> out;
  for (std::size_t c = 0; c < layout.components().size(); ++c) {
    const auto& component = layout.components()[c];
    if (c == 0 || layout.components()[c - 1].quantity != component.quantity)
      out.push_back({c, c, component.quantity->rank});
    out.back().last = c + 1;
  }
  return out;
}

// One point's values from axes x, y, z to those of `turn` (its rows).
void turn_values(const Layout& layout, const std::vector<Group>& groups, const Matrix3d& turn,
                 std::vector<double>& values) {
  const auto& components = layout.components();
  for (const Group& group : groups) {
    if (group.rank == Rank::scalar) continue;
    Matrix3d tensor = Matrix3d::Zero();
    for (std::size_t c = group.first; c < group.last; ++c) {
      const int a = components[c].a, b = components[c].b;
      tensor(a, b) = values[c];
      if (group.rank == Rank::symmetric) tensor(b, a) = values[c];
      if (group.rank == Rank::antisymmetric) tensor(b, a) = -values[c];
    }
    // The first column holds a vector's components.
    tensor = group.rank == Rank::vector ? Matrix3d(turn * tensor)
                                        : Matrix3d(turn * tensor * turn.transpose());
    for (std::size_t c = group.first; c < group.last; ++c)
      values[c] = tensor(components[c].a, components[c].b);
  }
}

// The mean of one ring.
struct Mean {
  std::vector<double> sum;
  std::vector<Index> count;
};

}  // namespace

Field average_on_rings(const FieldAt& at, const Eigen::Vector2d& axis, const MatrixXd& rings,
                       const AverageOptions& given, Gaps* gaps) {
  if (rings.cols() != 2)
    throw std::invalid_argument(
        fmt::format("rings have {} coordinates; radius and height are needed", rings.cols()));
  if (rings.rows() > 0 && !(rings.col(0).minCoeff() >= 0))
    throw std::invalid_argument(
        fmt::format("a ring's radius is {:g} m; it must be 0 or more", rings.col(0).minCoeff()));
  const Layout layout(3, given.quantities);
  const std::vector<Group> groups = groups_of(layout);
  const std::size_t columns = layout.components().size();
  AverageOptions options = given;
  options.least_grains = 0;
  if (!options.quantities.empty()) options.quantities.emplace_back("grains");
  Field out;
  out.points = rings;
  for (const auto& c : layout.components())
    out.add(column_name(*c.quantity, 3, c.a, c.b, "rtz"), c.unit);
  Gaps found;
  found.points = rings.rows();
  found.least_grains = given.least_grains;
  for (Index start = 0, end = 0; start < rings.rows(); start = end) {
    std::vector<Index> first{0};
    while (end < rings.rows() && (end == start || first.back() < kPlaces)) {
      first.push_back(first.back() + directions_of(rings(end, 0), options));
      ++end;
    }
    MatrixXd places(first.back(), 3);
    const auto angle = [&](Index ring, Index place) {
      const Index n = first[static_cast<std::size_t>(ring - start) + 1] -
                      first[static_cast<std::size_t>(ring - start)];
      return 2 * std::numbers::pi * static_cast<double>(place) / static_cast<double>(n);
    };
    const auto each = [&](auto&& act) {
      for (Index ring = start; ring < end; ++ring) {
        const Index from = first[static_cast<std::size_t>(ring - start)],
                    to = first[static_cast<std::size_t>(ring - start) + 1];
        for (Index p = from; p < to; ++p) act(ring, p, angle(ring, p - from));
      }
    };
    each([&](Index ring, Index p, double theta) {
      places.row(p) << axis.x() + rings(ring, 0) * std::cos(theta),
          axis.y() + rings(ring, 0) * std::sin(theta), rings(ring, 1);
    });
    const Field field = at(places, options);
    if (start == 0) out.attributes = field.attributes;
    const Eigen::VectorXd& grains = field.find("grains")->value;
    std::vector<double> values(columns);
    std::vector<Mean> means(static_cast<std::size_t>(end - start),
                            {std::vector<double>(columns, 0), std::vector<Index>(columns, 0)});
    std::vector<double> counted(static_cast<std::size_t>(end - start), 0);
    each([&](Index ring, Index p, double theta) {
      const auto k = static_cast<std::size_t>(ring - start);
      for (std::size_t c = 0; c < columns; ++c) values[c] = field.columns[c].value[p];
      Matrix3d turn;
      turn << std::cos(theta), std::sin(theta), 0, -std::sin(theta), std::cos(theta), 0, 0, 0, 1;
      turn_values(layout, groups, turn, values);
      for (std::size_t c = 0; c < columns; ++c) {
        if (std::isnan(values[c])) continue;
        means[k].sum[c] += values[c];
        ++means[k].count[c];
      }
      counted[k] += grains[p];
    });
    for (Index ring = start; ring < end; ++ring) {
      const auto k = static_cast<std::size_t>(ring - start);
      const double count = counted[k] / static_cast<double>(first[k + 1] - first[k]);
      const bool few = count < given.least_grains;
      bool some = false;
      for (std::size_t c = 0; c < columns; ++c) {
        const bool counts = layout.components()[c].column == "grains";
        if (means[k].count[c] == 0 || (few && !counts)) continue;
        out.columns[c].value[ring] = means[k].sum[c] / static_cast<double>(means[k].count[c]);
        some = some || !counts;
      }
      if (few)
        found.few_grains.emplace(ring, count);
      else if (!some)
        found.outside.emplace(ring, 1);
    }
  }
  if (gaps) gaps->add(found);
  return out;
}

}  // namespace grainfield::coupling
