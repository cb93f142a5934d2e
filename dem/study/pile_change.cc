// A pile that stands already, brought to rest under each changed gravity.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "dem/quasistatic/contact_network.h"
#include "dem/quasistatic/quasistatic.h"
#include "dem/study/common.h"
#include "dem/study/pile_figures.h"
#include "dem/study/run.h"

namespace grainfield::dem {
namespace {

// Under its own law a pile's unbalanced force is what its rest left, and small beside this; with a
// modulus off by a few percent it is above.
constexpr double kBalanced = 1e-4;
constexpr double kSame = 1e-9;  // relative: numbers that went through a file

bool same(double a, double b) { return std::fabs(a - b) <= kSame * std::max(a, b); }

class PileChangeRun final : public Run {
 public:
  PileChangeRun(const PileSetup& setup, const std::string& file, const std::string& group,
                int threads)
      : setup_(setup), where_(fmt::format("{}:{}", file, group)) {
    const std::vector<std::string> groups = list_snapshots(file);
    pile_ = read_snapshot(file, fmt::format("{}/pile", group));
    check();
    settings_.law = law();
    settings_.friction = setup_.material.friction;
    settings_.threads = threads;
    for (const double g : setup_.change.gravity) {
      const std::string name = change_name(g), path = fmt::format("{}/{}", group, name);
      if (std::find(groups.begin(), groups.end(), path) == groups.end()) {
        changed_.emplace_back();
      } else {
        changed_.emplace_back(read_snapshot(file, path));
      }
      ratio_.push_back(std::nan(""));
    }
    if (!done()) check_balance();
  }

  void advance(long) override {
    for (std::size_t k = 0; k < changed_.size(); ++k) {
      if (changed_[k]) continue;
      solve(k);
      return;
    }
  }

  bool done() const override { return solved() == changed_.size(); }

  Progress progress() const override {
    Progress p;
    const std::size_t at = solved();
    p.phase = done() ? "done" : change_name(setup_.change.gravity[at]);
    p.fraction =
        changed_.empty() ? 1 : static_cast<double>(at) / static_cast<double>(changed_.size());
    p.grains = p.awake = free_grains();
    return p;
  }

  void save(const std::string& file) const override {
    ImageWriter w;
    NamedSnapshots snapshots;
    std::vector<int> there;
    for (std::size_t k = 0; k < changed_.size(); ++k) {
      there.push_back(changed_[k] ? 1 : 0);
      if (changed_[k]) snapshots.emplace_back(change_name(setup_.change.gravity[k]), *changed_[k]);
    }
    w.put(there);
    w.put(ratio_);
    write_checkpoint(file, fingerprint(), w, snapshots);
  }

  void restore(const std::string& file) override {
    const std::string bytes = read_checkpoint(file, fingerprint());
    ImageReader r(bytes);
    std::vector<int> there;
    r.get(there);
    r.get(ratio_);
    r.finish();
    r.require(there.size() == changed_.size() && ratio_.size() == changed_.size());
    for (std::size_t k = 0; k < changed_.size(); ++k) {
      if (there[k] != 0) {
        changed_[k] =
            read_snapshot(file, fmt::format("/{}", change_name(setup_.change.gravity[k])));
      }
    }
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
    for (std::size_t k = 0; k < changed_.size(); ++k) {
      const std::string name = change_name(setup_.change.gravity[k]);
      out.snapshots.emplace_back(name, *changed_[k]);
      add_change_figures(pile_, *changed_[k], name, out.figures);
      if (!std::isnan(ratio_[k])) {
        out.figures[fmt::format("change.{}.unbalanced_force_ratio", name)] = ratio_[k];
      }
    }
    return out;
  }

 private:
  static std::string change_name(double gravity) { return fmt::format("gravity_{:g}", gravity); }

  std::size_t solved() const {
    return static_cast<std::size_t>(
        std::count_if(changed_.begin(), changed_.end(), [](const auto& s) { return !!s; }));
  }

  int free_grains() const {
    return static_cast<int>(std::count_if(pile_.grains.begin(), pile_.grains.end(),
                                          [](const Grain& g) { return !g.fixed; }));
  }

  decltype(EngineSettings::law) law() const {
    const MaterialSetup& m = setup_.material;
    if (m.law == "linear") {
      return LinearLaw{m.normal_stiffness, m.tangential_stiffness, m.normal_damping,
                       m.tangential_damping};
    }
    return OverlapAreaLaw{m.young, m.damping};
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
    if (setup_.change.method != "newton" && !setup_.change.gravity.empty()) {
      throw std::invalid_argument(
          fmt::format("change.method: found \"{}\", allowed for piles from files: newton",
                      setup_.change.method));
    }
  }

  // The forces that the law gives at these places carry the weight, or the law is another one.
  void check_balance() const {
    ContactNetwork network(pile_, settings_);
    network.set_load(pile_.gravity, -1, Vec3(0, 0, 0), -1, Vec3(0, 0, 0));
    const double ratio = network.balance().ratio;
    const double allowed = std::max(kBalanced, 10 * setup_.rest.unbalanced_force_ratio);
    if (!(ratio <= allowed)) {
      throw std::invalid_argument(fmt::format(
          "material: the pile {} does not rest with this stiffness (mean resultant over mean "
          "contact force {:.2g}, allowed: {:g}); give the [material] it was poured with",
          where_, ratio, allowed));
    }
  }

  void solve(std::size_t k) {
    const double gravity = setup_.change.gravity[k];
    QuasistaticSettings settings;
    settings.unbalanced_force_ratio = setup_.change.unbalanced_force_ratio;
    if (watch_) {
      const Progress before = progress();
      settings.go_on = [this, before](double share) {
        Progress now = before;
        now.fraction += share / static_cast<double>(changed_.size());
        return watch_(now);
      };
    }
    try {
      QuasistaticResult r = relax(pile_, settings_, Vec3(0, -gravity, 0), AppliedForce{}, settings);
      r.state.attributes = pile_.attributes;
      r.state.attributes["state"] = change_name(gravity);
      ratio_[k] = r.unbalanced_force_ratio;
      changed_[k] = std::move(r.state);
    } catch (const RelaxationStopped&) {
      return;
    } catch (const ComputationFailed& failure) {
      throw ComputationFailed(
          fmt::format("change.gravity = {:g} of {}: {}; or leave this gravity out", gravity, where_,
                      failure.what()));
    }
  }

  std::string fingerprint() const {
    return fmt::format("pile change {} | {} | {} {} | {}", where_,
                       fmt::join(setup_.change.gravity, " "), setup_.change.method,
                       setup_.change.unbalanced_force_ratio, describe(setup_.material));
  }

  PileSetup setup_;
  std::string where_;
  EngineSettings settings_;
  Snapshot pile_;
  std::vector<std::optional<Snapshot>> changed_;  // one per change.gravity, in its order
  std::vector<double> ratio_;                     // nan: taken from the file
};

}  // namespace

std::unique_ptr<Run> make_pile_change_run(const PileSetup& setup, const std::string& file,
                                          const std::string& group, int threads) {
  return std::make_unique<PileChangeRun>(setup, file, group, threads);
}

}  // namespace grainfield::dem
