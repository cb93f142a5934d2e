#include "coupling/studies/boussinesq_limit/responses.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "coupling/averaging/average.h"
#include "coupling/averaging/base.h"
#include "coupling/averaging/base_space.h"
#include "coupling/averaging/ensemble.h"
#include "coupling/averaging/rings.h"
#include "dem/quasistatic/linear_range.h"
#include "dem/quasistatic/small_loads.h"
#include "dem/snapshot/contact_changes.h"
#include "dem/snapshot/images.h"

namespace grainfield::coupling {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kRingShare = 1.0 / 3;  // of the kernel's width: distance of places on a ring

constexpr double kHundredth = 0.01;

// Seen from above, by the nearest image.
Eigen::Vector2d way_above(const dem::Snapshot& s, const dem::Vec3& from, const dem::Vec3& to) {
  dem::Vec3 way = to - from;
  way[s.dim - 1] = 0;
  if (s.cell.is_periodic()) way += dem::shift_to(s.cell, dem::nearest_image(s.cell, way));
  return s.dim == 2 ? Eigen::Vector2d(way.x(), 0) : Eigen::Vector2d(way.x(), way.y());
}

// Free grains that no higher grain covers and that touch two others or more.
std::vector<std::size_t> surface_grains(const dem::Snapshot& s, const LayerFrame& frame) {
  const int up = s.dim - 1;
  const double diameter = mean_diameter(s);
  std::vector<int> contacts(s.grains.size(), 0);
  for (const dem::Contact& c : s.contacts) {
    ++contacts[static_cast<std::size_t>(c.i)];
    if (c.j >= 0) ++contacts[static_cast<std::size_t>(c.j)];
  }
  std::vector<std::size_t> high, out;
  for (std::size_t k = 0; k < s.grains.size(); ++k) {
    const dem::Grain& g = s.grains[k];
    if (!g.fixed && g.position[up] > frame.surface - 3 * diameter) high.push_back(k);
  }
  for (const std::size_t k : high) {
    const dem::Grain& g = s.grains[k];
    if (contacts[k] < 2) continue;
    const bool covered = std::any_of(high.begin(), high.end(), [&](std::size_t other) {
      const dem::Grain& o = s.grains[other];
      return o.position[up] > g.position[up] &&
             way_above(s, g.position, o.position).norm() < 0.5 * (o.radius + g.radius);
    });
    if (!covered) out.push_back(k);
  }
  return out;
}

// Adds fields one by one, for their mean without errors.
class Mean {
 public:
  void add(const Field& field) { all_.add(field); }
  Field without_errors() const {
    Field out = all_.mean();
    out.realizations = 1;
    for (Column& column : out.columns) {
      column.error.resize(0);
      column.samples.resize(0, 0);
    }
    return out;
  }

 private:
  Ensemble all_;
};

LinearEnd median_of(const std::vector<LinearEnd>& ends) {
  const auto of = [&](double LinearEnd::*member) {
    std::vector<double> all;
    for (const LinearEnd& e : ends) all.push_back(e.*member);
    std::ranges::sort(all);
    const std::size_t n = all.size();
    return n == 0 ? kUnknown : n % 2 == 1 ? all[n / 2] : 0.5 * (all[n / 2 - 1] + all[n / 2]);
  };
  return {of(&LinearEnd::opening), of(&LinearEnd::sliding), of(&LinearEnd::first),
          of(&LinearEnd::hundredth)};
}

// The means of values by the nearest of places that ascend evenly, nan where there is none.
class ByPlace {
 public:
  explicit ByPlace(const Eigen::VectorXd& places)
      : places_(places),
        sum_(Eigen::VectorXd::Zero(places.size())),
        count_(Eigen::VectorXd::Zero(places.size())) {}
  void add(double at, double value) {
    const double spacing = places_.size() > 1 ? places_[1] - places_[0] : 1;
    const auto k = static_cast<Eigen::Index>(std::lround((at - places_[0]) / spacing));
    if (k < 0 || k >= places_.size()) return;
    sum_[k] += value;
    count_[k] += 1;
  }
  Eigen::VectorXd mean() const {
    return (count_.array() > 0).select(sum_.cwiseQuotient(count_).array(), kUnknown).matrix();
  }

 private:
  Eigen::VectorXd places_, sum_, count_;
};

}  // namespace

std::vector<LoadPlace> load_places(const dem::Snapshot& layer, const LayerFrame& frame,
                                   std::int64_t places, std::int64_t grains, double span) {
  const std::vector<std::size_t> surface = surface_grains(layer, frame);
  std::vector<dem::Vec3> wanted;
  const int up = layer.dim - 1;
  if (layer.dim == 2) {
    const double width = span * frame.width(), from = 0.5 * (frame.left + frame.right - width);
    for (std::int64_t k = 0; k < places; ++k) {
      const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(places);
      wanted.emplace_back(from + share * width, frame.surface, 0);
    }
  } else {
    const auto side = static_cast<std::int64_t>(std::llround(std::ceil(std::sqrt(places))));
    for (std::int64_t k = 0; k < side * side; ++k) {
      const auto at = [&](std::int64_t n, double low, double high) {
        return low + (static_cast<double>(n) + 0.5) / static_cast<double>(side) * (high - low);
      };
      wanted.emplace_back(at(k % side, frame.left, frame.right),
                          at(k / side, frame.front, frame.back), frame.surface);
    }
  }
  const auto many = std::min(static_cast<std::size_t>(grains), surface.size());
  std::set<std::vector<std::int64_t>> known;
  std::vector<LoadPlace> out;
  for (const dem::Vec3& place : wanted) {
    std::vector<std::size_t> near = surface;
    std::ranges::sort(near, {}, [&](std::size_t k) {
      return way_above(layer, place, layer.grains[k].position).norm();
    });
    LoadPlace one;
    Eigen::Vector2d sum(0, 0);
    for (std::size_t k = 0; k < many; ++k) {
      const dem::Grain& g = layer.grains[near[k]];
      one.grains.push_back(g.id);
      sum += way_above(layer, place, g.position) / static_cast<double>(many);
      one.depth += (frame.surface - g.position[up]) / static_cast<double>(many);
    }
    one.x = place.x() + sum.x();
    one.y = up == 2 ? place.y() + sum.y() : 0;
    std::ranges::sort(one.grains);
    if (many > 0 && known.insert(one.grains).second) out.push_back(one);
  }
  return out;
}

double mean_weight(const dem::Snapshot& s) {
  double mass = 0;
  int free = 0;
  for (const dem::Grain& g : s.grains) {
    if (g.fixed) continue;
    mass += g.mass;
    ++free;
  }
  return mass / free * s.gravity.norm();
}

double reach_of(const std::vector<LoadPlace>& places, const LayerFrame& frame, int dim) {
  if (dim == 3) return 0.5 * std::min(frame.right - frame.left, frame.back - frame.front);
  double out = std::numeric_limits<double>::infinity();
  for (const LoadPlace& p : places) out = std::min({out, p.x - frame.left, frame.right - p.x});
  return out;
}

MeanResponse mean_response(const dem::Snapshot& rest, const dem::Materials& materials,
                           const LayerFrame& layer, const std::vector<LoadPlace>& places,
                           double force, const std::vector<double>& depths, double depth,
                           const SettlementPlaces& settled_at,
                           const std::vector<SeenThrough>& through) {
  const Eigen::VectorXd& x = settled_at.surface;
  const int dim = rest.dim, up = dim - 1;
  dem::SmallLoads loads(rest, materials);
  const std::vector<std::size_t> surface = surface_grains(rest, layer);
  MeanResponse out;
  std::vector<std::vector<Mean>> sums(through.size(), std::vector<Mean>(depths.size() + 1));
  ByPlace settled(x);
  ByPlace below(settled_at.axis);
  std::vector<LinearEnd> ends;
  for (const LoadPlace& place : places) {
    const dem::Vec3 each = -force / static_cast<double>(place.grains.size()) * dem::Vec3::Unit(up);
    const dem::SmallResponse r = loads.response(place.grains, each);
    const dem::LinearRange range = dem::linear_range(loads.start(), r.change);
    ends.push_back({force * range.opens, force * range.slides, force * range.changed(0),
                    force * range.changed(kHundredth)});
    LayerFrame frame = layer;
    frame.load_x = place.x;
    frame.load_y = place.y;
    for (std::size_t t = 0; t < through.size(); ++t) {
      AverageOptions options = through[t].options;
      options.quantities = {"sigma", "grains"};
      const FieldAt change = [&](const Eigen::MatrixXd& points, const AverageOptions& o) {
        return average(r.change, points, o);
      };
      for (std::size_t d = 0; d <= depths.size(); ++d) {
        const bool base = d == depths.size();
        const double y = base ? -depth : -depths[d];
        Eigen::MatrixXd at = Eigen::MatrixXd::Zero(x.size(), dim);
        at.col(0) = x;
        at.col(up).setConstant(y);
        Field field;
        if (dim == 2) {
          field = base ? base_profile(r.change, x.array() + place.x, *through[t].kernel)
                       : change(frame.to_packing(at), options);
        } else if (!base) {
          Eigen::MatrixXd rings(x.size(), 2);
          rings << x, Eigen::VectorXd::Constant(x.size(), frame.surface + y);
          field = average_on_rings(change, {place.x, place.y}, rings, options);
        } else {
          const RingPlaces rings =
              ring_places({place.x, place.y}, x, kRingShare * through[t].kernel->range() / 2);
          const Field all = base_stress(r.change, rings.places, *through[t].kernel);
          field.add("sigma_zz", "N/m2").value = ring_means(rings, all.find("sigma_zz")->value);
        }
        field.points = at;
        field.nx = field.ny = field.nz = 0;
        sums[t][d].add(field);
      }
    }
    const dem::Vec3 middle = dim == 2 ? dem::Vec3(place.x, layer.surface, 0)
                                      : dem::Vec3(place.x, place.y, layer.surface);
    for (std::size_t k = 0; k < rest.grains.size(); ++k) {
      const dem::Grain& g = rest.grains[k];
      const Eigen::Vector2d aside = way_above(rest, middle, g.position);
      if (dem::is_loaded(r.change, g.id))
        out.settlement -= r.moved[k][up] / static_cast<double>(place.grains.size());
      else if (!g.fixed && aside.norm() < settled_at.aside)
        below.add(layer.surface - g.position[up], -r.moved[k][up]);
    }
    for (const std::size_t k : surface) {
      const Eigen::Vector2d aside = way_above(rest, middle, rest.grains[k].position);
      if (!dem::is_loaded(r.change, rest.grains[k].id))
        settled.add(dim == 2 ? aside.x() : aside.norm(), -r.moved[k][up]);
    }
    dem::Vec3 carried(0, 0, 0);
    for (const dem::Contact& c : r.change.contacts) {
      const bool first = rest.grains[static_cast<std::size_t>(c.i)].fixed;
      const bool second = c.j < 0 || rest.grains[static_cast<std::size_t>(c.j)].fixed;
      if (first != second) carried += second ? c.force : dem::Vec3(-c.force);
    }
    out.out_of_balance = std::max(out.out_of_balance, std::fabs(carried[up] / force - 1));
    out.base_share += dem::base_force(r.change)[up] / force;
    ++out.places;
  }
  const auto count = static_cast<double>(std::max(out.places, 1));
  out.settlement /= count;
  out.base_share /= count;
  out.settled = {settled.mean(), below.mean()};
  out.end = median_of(ends);
  for (const std::vector<Mean>& one : sums) {
    std::vector<Field>& lines = out.lines.emplace_back();
    if (out.places == 0) continue;
    for (const Mean& mean : one) lines.push_back(mean.without_errors());
  }
  return out;
}

}  // namespace grainfield::coupling
