
#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/studies/implicit_settling/keys.h"

namespace grainfield::coupling {
namespace {

double largest_error(const Eigen::VectorXd& found, const Eigen::VectorXd& of) {
  return (found - of).cwiseAbs().maxCoeff() / of.cwiseAbs().maxCoeff();
}

// The source's tolerance of its figures 8 and 9.
constexpr double kWithin = 0.01;

// sqrt(d/g), of the first or the last record with N and H within kWithin; nan: of none.
double time_within(const RecordedColumns& columns, bool last) {
  const std::vector<double>&time = columns.at("time"), &n = columns.at("normal_error"),
        &h = columns.at("horizontal_error");
  double out = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 0; k < time.size(); ++k) {
    if (std::max(n[k], h[k]) > kWithin) continue;
    out = time[k];
    if (!last) break;
  }
  return out;
}

}  // namespace

const std::vector<RunFigure<SettlingFacts>>& settling_rows() {
  using F = const SettlingFacts&;
  static const std::vector<RunFigure<SettlingFacts>> all{
      {"at_rest", "-", "1: the pile is at rest; 0: it still moves after max_time", nullptr,
       "at rest"},
      {"time", "-", "simulated, in sqrt(d/g)"},
      {"normal_max_error", "-",
       "largest difference of a base disk's N from the closed form (Liffman 42) over the largest "
       "N",
       [](F f) { return largest_error(f.normal, f.hard_normal); }, "N: largest error"},
      {"horizontal_max_error", "-", "the same of H (Liffman 44)",
       [](F f) { return largest_error(f.horizontal, f.hard_horizontal); }, "H: largest error"},
      {"within_from", "sqrt(d/g)",
       "first record in which N and H of every base disk are within 1 % of the closed forms; nan: "
       "none",
       [](F f) { return time_within(f.columns, false); }},
      {"within_until", "sqrt(d/g)", "the last one",
       [](F f) { return time_within(f.columns, true); }},
      {"row_contacts", "-", "contacts between neighbours of a row at the end"},
      {"iterations", "-", "of Newton's method, mean of all solves", nullptr, "iterations a solve"},
      {"most_iterations", "-", "of one solve"},
      {"halved", "-", "steps or parts of steps that were halved", nullptr, "halved"},
      {"balance_error", "m g d",
       "largest change of kinetic, potential and elastic energy with all losses", nullptr,
       "balance / (m g d)"},
      {"lost_normal", "m g d", "energy that dashpots along the normal took",
       [](F f) { return f.columns.at("lost_normal").back(); }},
      {"lost_tangential", "m g d", "energy that friction took",
       [](F f) { return f.columns.at("lost_tangential").back(); }},
      {"lost_well", "m g d", "energy that the wells took",
       [](F f) { return f.columns.at("lost_well").back(); }},
      {"lost_scheme", "m g d", "energy that settling.scheme = \"bdf2\" took by itself",
       [](F f) { return f.columns.at("lost_scheme").back(); }},
      {"spread", "d", "by how much the outermost base disks have parted", nullptr, "spread / d"},
      {"spread_speed", "sqrt(g d)",
       "how fast they part in the last tenth of the records; 0 at rest", nullptr,
       "its speed / sqrt(g d)"},
  };
  return all;
}

std::vector<SummaryKey> settling_figures() { return declared(settling_rows(), "settling."); }

}  // namespace grainfield::coupling
