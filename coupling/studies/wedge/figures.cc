#include "coupling/studies/wedge/analysis.h"
#include "coupling/studies/wedge/keys.h"

namespace grainfield::coupling {
namespace {

using Value = std::optional<FigureValue>;

bool has_nearest(const WedgeFacts& f) { return f.member.heap && !f.member.nearest.empty(); }

// The value of a member that is there.
template <class T>
Value of_shape(const WedgeFacts& f, const T& value) {
  return f.member.failed.empty() ? Value(value) : std::nullopt;
}

}  // namespace

const std::vector<RunFigure<WedgeFacts>>& wedge_member_rows() {
  using F = const WedgeFacts&;
  static const std::vector<RunFigure<WedgeFacts>> all{
      {"base_shape", "text", "pressure on the heap's base: dip, plateau, peak",
       [](F f) { return of_shape(f, f.member.shape.word); }},
      {"base_axis", "-",
       "mean pressure on the base within 5 % of its half width from the axis, over rho g h; where "
       "the pressure has a kink there, not its value at x = 0 (Cantelaube's minus branch at 28 "
       "deg: 0.31, at x = 0 0.22)",
       [](F f) { return of_shape(f, f.member.shape.axis / f.unit); }},
      {"base_largest", "-", "largest pressure on the base over rho g h",
       [](F f) { return of_shape(f, f.member.shape.largest / f.unit); }},
      {"base_largest_at", "-", "its distance from the axis over h",
       [](F f) { return of_shape(f, f.member.shape.largest_at / f.height); }},
      {"dip_ratio", "-", "base_axis over base_largest",
       [](F f) { return of_shape(f, f.member.shape.dip_ratio); }},
      {"nearest", "text", "label of the closed wedge nearest to the heap's base pressure",
       [](F f) { return has_nearest(f) ? of_shape(f, f.member.nearest) : std::nullopt; }},
      {"nearest_rel_l2", "-", "its relative L2 distance from it",
       [](F f) { return has_nearest(f) ? of_shape(f, f.member.nearest_rel_l2) : std::nullopt; }},
      {"failed", "text", "why there is no such heap",
       [](F f) { return f.member.failed.empty() ? std::nullopt : Value(f.member.failed); }},
  };
  return all;
}

const std::vector<RunFigure<WedgeCounts>>& wedge_rows() {
  using C = const WedgeCounts&;
  static const std::vector<RunFigure<WedgeCounts>> all{
      {"heaps", "-", "heaps that were tried", [](C c) { return c.heaps; }},
      {"equilibria", "-", "of these, heaps with an equilibrium", [](C c) { return c.equilibria; }},
      {"dips", "-", "of these, with a dip", [](C c) { return c.of("dip"); }},
      {"plateaus", "-", "with a plateau", [](C c) { return c.of("plateau"); }},
      {"peaks", "-", "with a peak", [](C c) { return c.of("peak"); }},
  };
  return all;
}

std::vector<SummaryKey> wedge_figures() {
  std::vector<SummaryKey> out = declared(wedge_member_rows(), "wedge.*.");
  for (SummaryKey& key : declared(wedge_rows(), "wedge.")) out.push_back(std::move(key));
  return out;
}

}  // namespace grainfield::coupling
