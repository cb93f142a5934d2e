// Elastic constants that change with the depth below a level surface, from a table.
#pragma once
#include <string>
#include <vector>

#include "continuum/closed/transverse.h"

namespace grainfield::continuum {

class ModuliByDepth {
 public:
  /// Linear between the rows, constant below the last one. An isotropic table has G_v of E and nu.
  TransverseModuli at(double depth) const;
  /// Throws BadParameter naming the last row where it ends above `depth`.
  void require_cover(double depth) const;

 private:
  friend ModuliByDepth read_moduli_by_depth(const std::string& file);
  TransverseModuli between(std::size_t row, double share) const;

  std::string file_;
  int last_line_ = 0;
  bool isotropic_ = false;
  std::vector<double> depths_;             // m, ascending from 0
  std::vector<std::vector<double>> rows_;  // E, nu, or E_v, E_h, nu_h, nu_v, G_v
};

/// CSV with the header depth,E,nu or depth,E_v,E_h,nu_h,nu_v,G_v (m; Pa, in the plane N/m). Throws
/// BadParameter "FILE:LINE: ..." for another header, a first depth that is not 0, depths that do
/// not ascend, and constants without a positive energy, at a row or between two.
ModuliByDepth read_moduli_by_depth(const std::string& file);

}  // namespace grainfield::continuum
