#include "coupling/studies/lattice_pile/keys.h"
#include "coupling/studies/lattice_pile/page.h"

namespace grainfield::coupling {
namespace {

// A single column of disks pushes to neither side: nothing to divide by.
double largest_difference(const Eigen::VectorXd& found, const Eigen::VectorXd& of) {
  return (found - of).cwiseAbs().maxCoeff() / of.cwiseAbs().maxCoeff();
}

}  // namespace

const std::vector<RunFigure<LatticeFacts>>& lattice_rows() {
  using F = const LatticeFacts&;
  using Value = std::optional<FigureValue>;
  static const std::vector<RunFigure<LatticeFacts>> all{
      {"rows", "-", "rows of a lattice pile", [](F f) { return std::int64_t{f.rows}; }, "rows"},
      {"base_grains", "-", "disks in its lowest row",
       [](F f) { return std::int64_t{f.base_grains}; }},
      {"grain_weight", "N", "m g of a disk", [](F f) { return f.weight; }},
      {"softness", "-", "m g/(K d), linear law; m g/(E d), overlap-area law (Liffman 46)",
       [](F f) { return f.weight / f.stiffness; }},
      {"row_contacts", "-", "contacts between neighbours of a row that carry force", nullptr,
       "contacts in rows"},
      {"normal_max_error", "-",
       "largest difference of a base disk's N from the closed form of hard close-packed disks "
       "(Liffman 42 at 60 degrees) over the largest N",
       [](F f) { return largest_difference(f.grains.normal, f.lattice.normal); },
       "N: largest error"},
      {"horizontal_max_error", "-", "the same of H (Liffman 44 at 60 degrees)",
       [](F f) { return largest_difference(f.grains.horizontal, f.lattice.horizontal); },
       "H: largest error"},
      {"line_normal_max_difference", "-",
       "largest difference of N from the line model (Liffman 52-59) over its largest N",
       [](F f) { return largest_difference(f.grains.normal, f.lines.normal); }, "N: lines"},
      {"line_horizontal_max_difference", "-", "the same of H",
       [](F f) { return largest_difference(f.grains.horizontal, f.lines.horizontal); }, "H: lines"},
      {"normal_centre", "-",
       "mean N of the base disks within 1/20 of the base of its middle over the largest N",
       [](F f) { return centre_over_largest(f.profile); }},
      {"line_normal_centre", "-", "the same of the line model: below 1 is a dip",
       [](F f) { return centre_over_largest(f.line_profile); }},
      {"horizontal_slope", "-",
       "slope of H in the middle of the base over the line model's, each over its largest H; up to "
       "0.8 of the way to where the lines through the apex meet the base, where the model's H "
       "bends; to a quarter of the base at most, and over five disks or more",
       [](F f) -> Value {
         if (!f.pushes_sideways()) return std::nullopt;
         return middle_shear(f.profile).slope / middle_shear(f.line_profile).slope;
       }},
      {"horizontal_explained", "-",
       "share of the variance of H there that a straight line explains",
       [](F f) -> Value {
         if (!f.pushes_sideways()) return std::nullopt;
         return middle_shear(f.profile).explained;
       }},
      {"maximum_lines_level", "-",
       "share of the lines of maximum force (Liffman fig. 10, 16) that are horizontal"},
      {"minimum_lines_level", "-", "the same of the lines of minimum force"},
      {"normal_largest", "N", "largest N of the base disks",
       [](F f) { return f.grains.normal.maxCoeff(); }},
      {"horizontal_largest", "N", "largest H of the base disks",
       [](F f) { return f.grains.horizontal.cwiseAbs().maxCoeff(); }},
  };
  return all;
}

std::vector<SummaryKey> lattice_pile_figures() { return declared(lattice_rows(), "liffman."); }

}  // namespace grainfield::coupling
