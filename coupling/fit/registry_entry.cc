#include "coupling/fit/registry_entry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>

#include "continuum/closed/orthotropic_layer.h"
#include "continuum/open_model.h"
#include "continuum/settings.h"
#include "coupling/compare/compare.h"

namespace grainfield::coupling {
namespace {

using continuum::OrthotropicWaves;
using continuum::Settings;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const continuum::Parameter* find_parameter(const std::string& model, const std::string& name) {
  for (const continuum::Parameter& p : continuum::find_model(model).parameters) {
    if (p.name == name) return &p;
  }
  return nullptr;
}

VectorXd open_values(const RegistryEntry& entry, const VectorXd& constants) {
  return entry.values ? entry.values(constants) : constants;
}

// Lengths times this.
Settings stretched(Settings settings, const std::string& model, double factor) {
  for (auto& [name, text] : settings) {
    const continuum::Parameter* p = find_parameter(model, name);
    if (p != nullptr && p->unit == "m") {
      text = fmt::format("{}", factor * continuum::number_of(settings, name));
    }
  }
  return settings;
}

Settings settings_of(const RegistryEntry& entry, const VectorXd& constants) {
  Settings out = entry.fixed;
  const VectorXd values = open_values(entry, constants);
  for (std::size_t k = 0; k < entry.open.size(); ++k) {
    out[entry.open[k]] = fmt::format("{}", values[static_cast<Eigen::Index>(k)]);
  }
  return out;
}

std::vector<RegistryModel> in_registry(const RegistryEntry& entry) {
  std::vector<RegistryModel> out;
  out.push_back({entry.registry, [entry](const VectorXd& p, double h) {
                   return stretched(settings_of(entry, p), entry.registry, h);
                 }});
  for (const auto& [name, more] : entry.elements) {
    out.push_back({name, [entry, name = name, more = more](const VectorXd& p, double h) {
                     Settings all = settings_of(entry, p);
                     std::erase_if(all, [&](const auto& setting) {
                       return find_parameter(name, setting.first) == nullptr;
                     });
                     for (const auto& [key, text] : more) all[key] = text;
                     return stretched(std::move(all), name, h);
                   }});
  }
  return out;
}

MatrixXd seen_by(const LayerSight& sight, const continuum::OpenModel& open, const std::string& name,
                 const VectorXd& values) {
  const auto model = open.make(values);
  if (const auto waves = waves_of(name, open.at(values))) return sight.seen(*waves);
  return sight.seen([&](const MatrixXd& nodes) { return model->stress(nodes); },
                    family_of(name) == "half plane");
}

std::string kind_of(const RegistryEntry& entry) {
  const continuum::Parameter* base = find_parameter(entry.registry, "base");
  if (base == nullptr || base->choices.empty()) return entry.registry;
  const auto given = entry.fixed.find("base");
  return entry.registry + " " +
         (given == entry.fixed.end() ? base->choices.front() : given->second);
}

// What is the same for all constants is worked out once.
struct Kept {
  std::once_flag once;
  MatrixXd values;
};

// Outside of what the model can take there is no stress.
template <class Stress>
MatrixXd where_possible(const MatrixXd& points, Stress&& stress) {
  try {
    return stress();
  } catch (const continuum::BadParameter&) {
  } catch (const ComputationFailed&) {
  }
  return no_stress(points);
}

}  // namespace

Settings in_units_of(double h, const std::string& model, Settings settings) {
  return stretched(std::move(settings), model, 1 / h);
}

std::optional<OrthotropicWaves> waves_of(const std::string& name, const Settings& s) {
  if (name == "layer") {
    const double nu = continuum::number_of(s, "nu");
    return OrthotropicWaves({1, 1}, nu / (1 - nu), s.at("base") == "rough");
  }
  if (name != "orthotropic_layer") return std::nullopt;
  return OrthotropicWaves(continuum::orthotropy(name, s), continuum::number_of(s, "nu_xy"),
                          s.at("base") == "rough");
}

MatrixXd no_stress(const MatrixXd& points) {
  return MatrixXd::Constant(points.rows(), 3, std::numeric_limits<double>::quiet_NaN());
}

FitModel model_of_entry(const RegistryEntry& entry, const RunFacts& facts,
                        std::shared_ptr<const LayerSight> sight) {
  FitModel out{entry.name,   entry.label,       entry.parameters,
               entry.starts, entry.description, entry.absent};
  out.unbalanced = entry.unbalanced;
  if (facts.force > 0) out.equations = entry.registry == "osl_layer" ? "hyperbolic" : "elliptic";
  if (entry.description) return out;
  out.kind = kind_of(entry);
  out.in_registry = in_registry(entry);
  try {
    const continuum::OpenModel open(
        entry.registry, filled_settings({entry.name, entry.registry, entry.fixed}, facts),
        entry.open);
    if (entry.open.empty()) open.make(VectorXd(0));
    out.stress = [entry, open, sight, kept = std::make_shared<Kept>()](const MatrixXd& points,
                                                                       const VectorXd& constants) {
      const VectorXd values = open_values(entry, constants);
      return where_possible(points, [&]() -> MatrixXd {
        if (sight == nullptr) return open.make(values)->stress(points);
        const auto seen = [&] { return seen_by(*sight, open, entry.registry, values); };
        if (!entry.open.empty()) return sight->places().pick(seen(), points);
        std::call_once(kept->once, [&] { kept->values = seen(); });
        return sight->places().pick(kept->values, points);
      });
    };
  } catch (const continuum::BadParameter& e) {
    if (out.absent.empty()) out.absent = e.what();
  }
  if (!out.absent.empty()) {
    out.stress = [](const MatrixXd& points, const VectorXd&) { return no_stress(points); };
  }
  return out;
}

}  // namespace grainfield::coupling
