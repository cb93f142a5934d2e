// A pile that stands already, brought to rest under each changed gravity.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "coupling/studies/pile/gravity_changes.h"
#include "coupling/studies/pile/pile_figures.h"
#include "coupling/studies/pile/simulation.h"
#include "dem/grains/grain_family.h"
#include "dem/quasistatic/contact_network.h"
#include "dem/run/common.h"
#include "dem/run/fingerprint.h"
#include "dem/run/run.h"
#include "dem/snapshot/added_forces_mark.h"

namespace grainfield::dem {
namespace {

// Under its own law a pile's unbalanced force is what its rest left, and small beside this; with a
// modulus off by a few percent it is above.
constexpr double kBalanced = 1e-4;
constexpr double kSame = 1e-9;  // relative: numbers that went through a file

bool same(double a, double b) { return std::fabs(a - b) <= kSame * std::max(a, b); }

class PileChangeRun final : public ArchivedRun {
 public:
  PileChangeRun(const PileSetup& setup, const std::string& file, const std::string& group,
                int threads)
      : setup_(setup), where_(fmt::format("{}:{}", file, group)) {
    const std::vector<std::string> groups = list_snapshots(file);
    pile_ = read_snapshot(file, fmt::format("{}/pile", group));
    refuse_added_forces(pile_, where_ + "/pile");
    check();
    settings_ = settings(threads);
    changes_.emplace(setup_.change, setup_.rest, settings_, smaller_step(setup_.motion),
                     fmt::format(" of {}", where_));
    changes_->start_from(pile_);
    for (std::size_t k = 0; k < setup_.change.gravity.size(); ++k) {
      const std::string path = fmt::format("{}/gravity_{:g}", group, setup_.change.gravity[k]);
      if (std::find(groups.begin(), groups.end(), path) != groups.end()) {
        changes_->set_known(k, read_snapshot(file, path));
      }
    }
    if (!done()) check_balance();
  }

  void advance(long steps) override {
    std::function<bool(double)> watch;
    if (watch_) {
      watch = [this](double share) {
        Progress now = progress();
        now.fraction = share;
        return watch_(now);
      };
    }
    changes_->advance(steps, watch);
  }

  bool done() const override { return changes_->done(); }

  Progress progress() const override {
    Progress p;
    p.phase = changes_->phase();
    p.fraction = changes_->fraction();
    p.grains = p.awake = free_grains();
    if (const Engine* engine = changes_->engine()) {
      const Diagnostics d = engine->measure();
      p.simulated_time = engine->time();
      p.steps = engine->steps();
      p.kinetic_energy = d.kinetic_energy;
      p.unbalanced_force_ratio = d.unbalanced_force_ratio;
    }
    return p;
  }

  RunResult result() const override {
    RunResult out;
    if (!done()) return out;
    out.snapshots.emplace_back("pile", pile_);
    out.figures["dem.grains"] = free_grains();
    out.figures["dem.contacts"] = static_cast<double>(pile_.contacts.size());
    double diameters = 0;
    for (const Grain& g : pile_.grains) diameters += g.fixed ? 0 : 2 * g.radius;
    add_heap_figures(pile_, diameters / free_grains(), out.figures);
    changes_->add_to(out);
    return out;
  }

 private:
  void visit(Archive& archive) override { changes_->visit(archive); }

  int free_grains() const {
    return static_cast<int>(std::count_if(pile_.grains.begin(), pile_.grains.end(),
                                          [](const Grain& g) { return !g.fixed; }));
  }

  // Settings of the material, with the time step that these grains bear.
  EngineSettings settings(int threads) const {
    std::vector<ShapedGrain> grains;
    bool polygons = false;
    for (const Grain& g : pile_.grains) {
      grains.push_back({g.outline, g.radius, g.volume, g.angle});
      polygons |= !g.outline.empty();
    }
    const auto shape = pile_.attributes.find("shape");
    const bool irregular = shape != pile_.attributes.end() &&
                           (shape->second == "rand1" || shape->second == "irregular");
    EngineSettings out =
        engine_settings(setup_.material, setup_.motion,
                        extremes_of(grains, setup_.material.density), threads, irregular);
    check_background_damping(setup_.rest, out.time_step);
    out.shape = polygons ? ShapeKind::polygon : ShapeKind::disk;
    return out;
  }

  void require(const char* key, double asked, double found) const {
    if (same(asked, found)) return;
    throw std::invalid_argument(
        fmt::format("{}: found {:g}, the pile {} has {:g}", key, asked, where_, found));
  }

  // Every number of the material that a snapshot knows.
  void check() const {
    if (pile_.dim != 2) {
      throw std::invalid_argument(fmt::format("{}/pile: is 3D; a 2D pile is needed", where_));
    }
    if (free_grains() == 0) {
      throw std::invalid_argument(fmt::format("{}/pile: has no free grain", where_));
    }
    const MaterialSetup& m = setup_.material;
    require("material.gravity", m.gravity, pile_.gravity.norm());
    for (const Grain& g : pile_.grains) {
      if (g.fixed) continue;
      require("material.density", m.density, g.mass / g.volume);
      break;
    }
    for (const Contact& c : pile_.contacts) {
      if (c.j < 0) continue;
      require("material.friction", m.friction, c.friction);
      break;
    }
    const auto law = pile_.attributes.find("law");
    if (law != pile_.attributes.end() && law->second != m.law) {
      throw std::invalid_argument(fmt::format("material.law: found \"{}\", the pile {} has \"{}\"",
                                              m.law, where_, law->second));
    }
  }

  // The forces that the law gives at these places carry the weight, or the law is another one.
  void check_balance() const {
    const auto network = make_contact_network(pile_, settings_);
    network->set_load(pile_.gravity);
    const double ratio = network->balance().ratio;
    const double allowed = std::max(kBalanced, 10 * setup_.rest.unbalanced_force_ratio);
    if (!(ratio <= allowed)) {
      throw std::invalid_argument(fmt::format(
          "material: the pile {} does not rest with this stiffness (mean resultant over mean "
          "contact force {:.2g}, allowed: {:g}); give the [material] it was poured with",
          where_, ratio, allowed));
    }
  }

  std::string fingerprint() const override {
    return fmt::format("pile change {} {} {}", where_, fingerprint_of(setup_), settings_.time_step);
  }

  PileSetup setup_;
  std::string where_;
  EngineSettings settings_;
  Snapshot pile_;
  std::optional<GravityChanges> changes_;
};

}  // namespace

std::unique_ptr<Run> make_pile_change_run(const PileSetup& setup, const std::string& file,
                                          const std::string& group, int threads) {
  return std::make_unique<PileChangeRun>(setup, file, group, threads);
}

}  // namespace grainfield::dem
