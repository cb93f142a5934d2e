#include "continuum/moduli_by_depth.h"

#include <fmt/format.h>

#include <algorithm>

#include "continuum/number_table.h"

namespace grainfield::continuum {
namespace {

const std::vector<std::string> kIsotropic{"depth", "E", "nu"};
const std::vector<std::string> kTransverse{"depth", "E_v", "E_h", "nu_h", "nu_v", "G_v"};
/// Places between two rows at which the energy is looked at: the constants are linear there, the
/// energy is not.
constexpr int kBetween = 8;
/// A table may end above the depth by this part of it.
constexpr double kShort = 1e-9;

std::string wrong_names(const std::vector<std::string>& names) {
  if (names == kIsotropic || names == kTransverse) return {};
  return "allowed: depth,E,nu or depth,E_v,E_h,nu_h,nu_v,G_v";
}

TransverseModuli moduli(const std::vector<double>& v, bool isotropic) {
  if (isotropic) return {v[0], v[0], v[1], v[1], v[0] / (2 * (1 + v[1]))};
  return {v[1], v[0], v[2], v[3], v[4]};
}

}  // namespace

TransverseModuli ModuliByDepth::between(std::size_t row, double share) const {
  std::vector<double> v = rows_[row];
  if (share > 0) {
    for (std::size_t c = 0; c < v.size(); ++c) v[c] += share * (rows_[row + 1][c] - v[c]);
  }
  return moduli(v, isotropic_);
}

TransverseModuli ModuliByDepth::at(double depth) const {
  const auto below = std::upper_bound(depths_.begin(), depths_.end(), depth);
  if (below == depths_.end()) return between(depths_.size() - 1, 0);
  if (below == depths_.begin()) return between(0, 0);
  const auto row = static_cast<std::size_t>(below - depths_.begin()) - 1;
  return between(row, (depth - depths_[row]) / (depths_[row + 1] - depths_[row]));
}

void ModuliByDepth::require_cover(double depth) const {
  if (depths_.back() >= depth * (1 - kShort)) return;
  refuse_line(file_, last_line_,
              fmt::format("depth = {:.6g} m is the last row; allowed: {:.6g} m or more, the depth "
                          "of the model",
                          depths_.back(), depth));
}

ModuliByDepth read_moduli_by_depth(const std::string& file) {
  const NumberTable table = read_number_table(file, wrong_names);
  if (table.rows.empty())
    refuse_line(file, table.last_line, "no row; allowed: one or more, the first at depth 0");
  ModuliByDepth out;
  out.file_ = file;
  out.last_line_ = table.rows.back().line;
  out.isotropic_ = table.names == kIsotropic;
  const char* allowed = out.isotropic_
                            ? "E above 0, nu above -1 and below 0.5"
                            : "moduli above 0, |nu_h| below 1, 2 nu_v^2 E_h/E_v below 1 - nu_h";
  for (const NumberRow& row : table.rows) {
    const double depth = row.values.front();
    if (out.depths_.empty() && depth != 0)
      refuse_line(file, row.line,
                  fmt::format("the first depth is {:.6g} m; allowed: 0, the surface", depth));
    if (!out.depths_.empty() && !(depth > out.depths_.back()))
      refuse_line(file, row.line,
                  fmt::format("depth = {:.6g} m follows {:.6g} m; allowed: depths that ascend",
                              depth, out.depths_.back()));
    out.depths_.push_back(depth);
    out.rows_.emplace_back(row.values.begin() + 1, row.values.end());
    const std::size_t last = out.rows_.size() - 1;
    if (!out.between(last, 0).is_stable())
      refuse_line(file, row.line,
                  fmt::format("these constants have no positive energy; allowed: {}", allowed));
    for (int k = 1; last > 0 && k < kBetween; ++k) {
      if (!out.between(last - 1, static_cast<double>(k) / kBetween).is_stable())
        refuse_line(file, row.line,
                    fmt::format("between this row and the one above the constants have no positive "
                                "energy; allowed: {}",
                                allowed));
    }
  }
  return out;
}

}  // namespace grainfield::continuum
