#include "dem/snapshot/displacements.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "dem/snapshot/cell_places.h"
#include "dem/snapshot/images.h"

namespace grainfield::dem {
namespace {

using Image = std::array<int, 3>;

// Share of an edge: beyond a half another image is nearer.
constexpr double kFar = 1.0 / 3;
// Least share of the largest one of the pivots of a fit: below, no contact says anything.
constexpr double kRank = 1e-9;
// Edges that the sides may have slid past each other.
constexpr double kMost = kMostImages;

enum class Told { counted, not_carried_back, untold, unknown };

struct ToldImages {
  Told told = Told::unknown;
  std::array<bool, 3> axes{};  // of which the images are counted
};

bool some_image(const Snapshot& s) {
  return std::any_of(s.grains.begin(), s.grains.end(), [](const Grain& g) {
    return g.image != Image{0, 0, 0};
  });
}

// Unknown: no grain has crossed a side in a state of ours, or nobody has counted.
ToldImages told_images_of(const Snapshot& s) {
  const auto text = s.attributes.find("images");
  if (text == s.attributes.end()) {
    // An import that wrote no word of images had none.
    if (s.attributes.count("imported_from") != 0) return {Told::untold, {}};
    if (some_image(s)) return {Told::counted, {true, true, true}};
    return {Told::unknown, {true, true, true}};
  }
  if (text->second == "counted") return {Told::counted, {true, true, true}};
  if (text->second == "not carried back") return {Told::not_carried_back, {}};
  constexpr std::string_view along = "counted along ";
  if (!text->second.starts_with(along)) return {Told::untold, {}};
  ToldImages out{Told::counted, {}};
  for (const char axis : text->second.substr(along.size()))
    if (axis >= 'x' && axis <= 'z') out.axes[static_cast<std::size_t>(axis - 'x')] = true;
  return out;
}

Image times(const Eigen::Matrix3i& exchange, const Image& image) {
  const Eigen::Vector3i out = exchange * Eigen::Vector3i(image[0], image[1], image[2]);
  return {out[0], out[1], out[2]};
}

Image difference(const Image& a, const Image& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Image sum(const Image& a, const Image& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

Vec3 unwrapped(const Snapshot& s, std::size_t grain) {
  return s.grains[grain].position + shift_to(s.cell, s.grains[grain].image);
}

}  // namespace

Displacements::Displacements(const Snapshot& before, const Snapshot& after)
    : before_(&before),
      after_(&after),
      nearest_(after.cell),
      across_(Eigen::Matrix3d::Identity()),
      exchange_(edges_exchanged(after.cell, before.cell)) {
  if (!after.cell.is_periodic()) return;
  settle_axes();
  settle_exchange();
}

void Displacements::settle_axes() {
  const ToldImages a = told_images_of(*before_), b = told_images_of(*after_);
  const std::array<bool, 3>& periodic = after_->cell.periodic;
  std::vector<std::string> lacking;
  // Where nothing says otherwise the shortest way is as good as the images, which are all 0.
  bool tell = false;
  if (a.told == Told::unknown && b.told == Told::unknown) {
    counted_ = {};
  } else {
    const auto from_places = [](const ToldImages& s) { return s.told == Told::not_carried_back; };
    const auto complete = [&](const ToldImages& s) {
      bool out = true;
      for (std::size_t k = 0; k < 3; ++k) out = out && (!periodic[k] || s.axes[k]);
      return out || from_places(s);
    };
    bool places = from_places(a) || from_places(b);
    if (places && !(complete(a) && complete(b))) {
      places = places_fit();
      if (places)
        images_ =
            "images are counted from the places of both states, though only one of them has grains "
            "far out of the periodic cell";
    }
    for (std::size_t k = 0; k < 3; ++k) counted_[k] = places || (a.axes[k] && b.axes[k]);
    tell = true;
  }
  // An edge that has become the sum of several has all their images.
  for (int k = 0; k < 3; ++k)
    for (int other = 0; other < 3; ++other)
      if (exchange_(k, other) != 0 && periodic[static_cast<std::size_t>(other)] &&
          !counted_[static_cast<std::size_t>(other)])
        counted_[static_cast<std::size_t>(k)] = false;
  Cell<3> known = after_->cell;
  for (std::size_t k = 0; k < 3; ++k) {
    known.periodic[k] = periodic[k] && counted_[k];
    nearest_.periodic[k] = periodic[k] && !counted_[k];
    if (nearest_.periodic[k]) lacking.emplace_back(1, "xyz"[k]);
  }
  counts_some_ = known.is_periodic();
  if (counts_some_) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 axis = Vec3::Unit(k);
      across_.col(k) = axis - known.edges * along_edges(known, axis);
    }
    nearest_.edges = across_ * nearest_.edges;
  }
  if (!tell || lacking.empty()) return;
  bool one = false;  // of the two states has images along such an axis
  for (std::size_t k = 0; k < 3; ++k)
    one = one || (nearest_.periodic[k] && (a.axes[k] || b.axes[k]));
  const std::string along = counts_some_ ? fmt::format(" along {}", fmt::join(lacking, ", ")) : "";
  images_ = fmt::format(
      "{} has no images{}: displacements{} are the shortest ways across the periodic cell",
      one ? "one of the two states" : "each of the two states", along, along);
}

Vec3 Displacements::by_images(std::size_t grain) const {
  const Grain &a = before_->grains[grain], &b = after_->grains[grain];
  return b.position - a.position +
         shift_to(after_->cell, difference(b.image, times(exchange_, a.image)));
}

// Where one of two states has places far out of the cell and the other has not, either both were
// never carried back (YADE), or one was: then some neighbours are an edge apart in it.
bool Displacements::places_fit() const {
  const Cell<3>& cell = after_->cell;
  std::vector<Image> off(before_->grains.size());  // shortest way to that by images, edges
  bool equal = true;
  for (std::size_t g = 0; g < off.size(); ++g) {
    off[g] = nearest_image(cell, by_images(g));
    equal = equal && off[g] == off.front();
  }
  if (equal) return true;
  long long by_images_nearer = 0, by_shortest_nearer = 0;
  for (const Contact& c : before_->contacts) {
    if (c.j < 0) continue;
    const auto i = static_cast<std::size_t>(c.i), j = static_cast<std::size_t>(c.j);
    if (off[i] == off[j]) continue;
    const Vec3 counted = by_images(j) - by_images(i) + of_image(c.image);
    const Vec3 shortest = counted + shift_to(cell, difference(off[j], off[i]));
    ++(counted.squaredNorm() < shortest.squaredNorm() ? by_images_nearer : by_shortest_nearer);
  }
  return by_images_nearer > by_shortest_nearer;
}

// The edges after the change are known up to whole edges: a cell that is sheared by 1.1 looks like
// one that is sheared by 0.1. The grains say which, where their images are counted: of a contact
// across the sides, both grains are known in space before and after. With X_j - X_i of the grains'
// places in space, F is that of the least sum of |d_after - F d_before|^2 over contacts, and the
// edges after the change are those nearest to F (edges before). Contacts across the sides have an
// edge for d and decide.
void Displacements::settle_exchange() {
  const Cell<3>& cell = after_->cell;
  for (std::size_t k = 0; k < 3; ++k)
    if (cell.periodic[k] && !(counted_[k] && before_->cell.periodic[k])) return;
  const Eigen::Index dim = before_->dim;
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero(), mixed = Eigen::Matrix3d::Zero();
  std::array<bool, 3> crossed{};
  for (const Contact& c : before_->contacts) {
    if (c.j < 0) continue;
    const auto i = static_cast<std::size_t>(c.i), j = static_cast<std::size_t>(c.j);
    const Image m = sum(c.image, difference(before_->grains[i].image, before_->grains[j].image));
    for (std::size_t k = 0; k < 3; ++k) crossed[k] = crossed[k] || m[k] != 0;
    const Vec3 d = unwrapped(*before_, j) - unwrapped(*before_, i);
    square += d * d.transpose();
    mixed += (unwrapped(*after_, j) - unwrapped(*after_, i)) * d.transpose();
  }
  Eigen::FullPivLU<Eigen::MatrixXd> lu;
  lu.setThreshold(kRank);
  lu.compute(Eigen::MatrixXd(square.topLeftCorner(dim, dim)));
  if (!lu.isInvertible()) return;
  Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
  f.topLeftCorner(dim, dim) =
      lu.solve(Eigen::MatrixXd(mixed.topLeftCorner(dim, dim).transpose())).transpose();
  Eigen::Matrix3i found = exchange_;
  double off = 0;
  for (int a = 0; a < 3; ++a) {
    if (!crossed[static_cast<std::size_t>(a)]) continue;
    const Vec3 turns = along_edges(cell, f * before_->cell.edges.col(a));
    for (int b = 0; b < 3; ++b) {
      if (!cell.periodic[static_cast<std::size_t>(b)]) continue;
      found(b, a) = static_cast<int>(std::round(std::clamp(turns[b], -kMost, kMost)));
      off = std::max(off, std::fabs(turns[b] - found(b, a)));
    }
  }
  slid_ = off > kFar || std::abs(found.determinant()) != 1;
  if (!slid_) exchange_ = found;
}

Vec3 Displacements::of(std::size_t grain) const {
  const Grain &a = before_->grains[grain], &b = after_->grains[grain];
  const Vec3 moved = b.position - a.position;
  if (!after_->cell.is_periodic()) return moved;
  Image crossed = difference(b.image, times(exchange_, a.image));
  for (std::size_t k = 0; k < 3; ++k)
    if (!counted_[k]) crossed[k] = 0;
  const Vec3 way = moved + shift_to(after_->cell, crossed);
  if (!nearest_.is_periodic()) return way;
  return way + shift_to(after_->cell, nearest_image(nearest_, across_counted(way)));
}

Image Displacements::image_after(const Image& image) const { return times(exchange_, image); }

Vec3 Displacements::of_image(const Image& image) const {
  if (!before_->cell.is_periodic()) return Vec3::Zero();
  return shift_to(after_->cell, image_after(image)) - shift_to(before_->cell, image);
}

std::string Displacements::doubt() const {
  if (slid_)
    return "the contacts do not say how many edges the sides of the cell have slid past each "
           "other; compare states that are nearer to each other";
  if (!nearest_.is_periodic()) return "";
  long long far = 0;
  for (std::size_t g = 0; g < before_->grains.size(); ++g) {
    const Vec3 turns = along_edges(nearest_, across_counted(of(g)));
    far += std::any_of(turns.begin(), turns.end(), [&](double t) { return std::fabs(t) > kFar; });
  }
  if (far == 0) return "";
  return fmt::format(
      "{} of {} grains have moved by more than a third of the periodic cell and images are not "
      "counted in both states: the shortest way may be that of an image; import both with "
      "unwrapped places (xu yu zu) or image flags (ix iy iz), or compare states that are nearer "
      "to each other",
      far, before_->grains.size());
}

}  // namespace grainfield::dem
