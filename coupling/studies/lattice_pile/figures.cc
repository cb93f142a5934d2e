#include "coupling/studies/lattice_pile/keys.h"

namespace grainfield::coupling {

std::vector<SummaryKey> lattice_pile_figures() {
  return {
      {"liffman.rows", "-", "rows of a lattice pile", "rows"},
      {"liffman.base_grains", "-", "disks in its lowest row"},
      {"liffman.grain_weight", "N", "m g of a disk"},
      {"liffman.softness", "-", "m g/(K d), linear law; m g/(E d), overlap-area law (Liffman 46)"},
      {"liffman.row_contacts", "-", "contacts between neighbours of a row that carry force",
       "contacts in rows"},
      {"liffman.normal_max_error", "-",
       "largest difference of a base disk's N from the closed form of hard close-packed disks "
       "(Liffman 42 at 60 degrees) over the largest N",
       "N: largest error"},
      {"liffman.horizontal_max_error", "-", "the same of H (Liffman 44 at 60 degrees)",
       "H: largest error"},
      {"liffman.line_normal_max_difference", "-",
       "largest difference of N from the line model (Liffman 52-59) over its largest N",
       "N: lines"},
      {"liffman.line_horizontal_max_difference", "-", "the same of H", "H: lines"},
      {"liffman.normal_centre", "-",
       "mean N of the base disks within 1/20 of the base of its middle over the largest N"},
      {"liffman.line_normal_centre", "-", "the same of the line model: below 1 is a dip"},
      {"liffman.horizontal_slope", "-",
       "slope of H in the middle of the base over the line model's, each over its largest H; up to "
       "0.8 of the way to where the lines through the apex meet the base, where the model's H "
       "bends; to a quarter of the base at most, and over five disks or more"},
      {"liffman.horizontal_explained", "-",
       "share of the variance of H there that a straight line explains"},
      {"liffman.maximum_lines_level", "-",
       "share of the lines of maximum force (Liffman fig. 10, 16) that are horizontal"},
      {"liffman.minimum_lines_level", "-", "the same of the lines of minimum force"},
      {"liffman.normal_largest", "N", "largest N of the base disks"},
      {"liffman.horizontal_largest", "N", "largest H of the base disks"},
  };
}

}  // namespace grainfield::coupling
