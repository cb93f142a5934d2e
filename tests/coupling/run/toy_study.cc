// A study of another program in one page: what it grows, what it observes, with what it compares
// that, and what it tells. No file of the toolkit names it; toy_study_test.cc runs it.
#include <cmath>

#include "coupling/case/declare.h"
#include "coupling/observe/declaration.h"
#include "coupling/observe/seen_models.h"
#include "coupling/run/ensemble.h"
#include "coupling/run/grain_keys.h"
#include "coupling/studies/lattice_pile/simulation.h"
#include "dem/grains/lattice_pile.h"
#include "dem/snapshot/contact_changes.h"

namespace grainfield::coupling {
namespace {

// Close-packed disks: what does the base carry?
struct StackSetup {
  StackSetup() { pile.lattice.base_grains = 4; }
  dem::LatticePileSetup pile;
  double tolerance = 1e-3;
};

void declare_stack_keys(SectionKeys s) {
  s.number("width", "-", GRAINFIELD_MEMBER(StackSetup, pile.lattice.base_grains), {3, 100},
           "disks in the lowest row");
  s.number("tolerance", "-", GRAINFIELD_MEMBER(StackSetup, tolerance), {1e-9, 1},
           "carried means: the base force is the weight within this share");
}

double base_force_over_weight(const Realization& one) {
  const dem::Snapshot& pile = one["pile"];
  double mass = 0;
  for (const dem::Grain& grain : pile.grains) mass += grain.mass;
  return dem::base_force(pile).y() / (mass * pile.gravity.norm());
}

// The forces of the lowest row, the first disks, on the floor, over their spacing d.
Observations base_pressure(const Case& value, const std::vector<std::string>& files, int) {
  const dem::LatticeSetup& lattice = value.get<StackSetup>().pile.lattice;
  const int n = lattice.base_grains;
  const double d = dem::lattice_spacing(lattice), h = 0.5 * n * d * std::sqrt(3);
  Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(files.size()));
  double weight = 0;
  for (Eigen::Index r = 0; r < forces.cols(); ++r) {
    const dem::Snapshot pile = read_realization(files[static_cast<std::size_t>(r)])["pile"];
    weight = pile.grains.front().mass * pile.gravity.norm();
    for (const dem::Contact& c : pile.contacts) {
      if (c.j < 0) forces(c.i, r) += c.force.y();
    }
  }
  const double rho_g = weight / (d * dem::lattice_rise(lattice)), end = 0.5 * (n - 1) * d;
  Observations out;
  out.realizations = static_cast<int>(files.size());
  out.scale = scale_of_heaps(h, rho_g * h, "of the lattice");
  out.told.height = h;
  out.told.numbers = {{"rho_g", rho_g}, {"left_deg", 60}, {"right_deg", 60}};
  out.lines = {pressure_line("base", h, Eigen::VectorXd::LinSpaced(n, -end, end), forces / d)};
  return out;
}

Study stack_study() {
  Study out;
  out.name = "toy-stack";
  out.meaning = "close-packed disks and their weight";
  // What grows.
  out.sections = {kMaterialKeys, {"stack", KeyRole::grains, declare_stack_keys}};
  out.material = [](Case& c) -> dem::MaterialSetup& { return c.get<StackSetup>().pile.material; };
  out.fills = {"rho_g", "left_deg", "right_deg"};
  out.models_optional = true;
  out.make_run = [](const Case& value, std::int64_t number, int threads) {
    return dem::make_lattice_pile_run(value.get<StackSetup>().pile, realization_seed(value, number),
                                      threads);
  };
  out.foresee = [](const Case& value, std::int64_t) {
    return dem::foresee_lattice_pile(value.get<StackSetup>().pile);
  };
  // What is observed, compared and told.
  const std::string ratio = "stack.base_force_over_weight";
  declare(out, {.observed = {{ratio, "-", "vertical force on the base over the weight",
                              base_force_over_weight, "base force / weight"}},
                .compared = base_pressure,
                .found = {{"stack.carried", "text", "yes | no",
                           [ratio](const StudyResult& r) -> std::optional<FigureValue> {
                             const double off = std::get<double>(r.summary.at(ratio)) - 1;
                             const double most = r.value.get<StackSetup>().tolerance;
                             return std::fabs(off) < most ? "yes" : "no";
                           }}},
                .told = [ratio](const StudyResult& r) {
                  return "The base carries " + shown_with_error(r.summary, ratio) +
                         " of the weight.";
                }});
  return out;
}

const bool kAdded = add_study(stack_study);

}  // namespace
}  // namespace grainfield::coupling
