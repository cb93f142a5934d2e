#include "coupling/studies/hard_disks/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/judge/words.h"
#include "coupling/result/csv.h"
#include "dem/collisions/gas.h"

namespace grainfield::coupling {
namespace {

constexpr int kSmooth = 121;  // points of a line that is known everywhere

const char* theory_name(const dem::HardParticlesSetup& s) {
  return s.is_3d() ? "Carnahan and Starling" : "Henderson";
}

const char* fraction_name(const dem::HardParticlesSetup& s) {
  return s.is_3d() ? "volume fraction" : "area fraction";
}

double haff(double time) { return 1 / ((1 + time) * (1 + time)); }

bool has_haff(const GasResults& r) { return r.setup.kind == "cooling" && r.setup.friction == 0; }

template <class Value>
Eigen::VectorXd each(std::size_t count, const Value& value) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(count));
  for (std::size_t k = 0; k < count; ++k) out[static_cast<Eigen::Index>(k)] = value(k);
  return out;
}

Series grains_of(const Eigen::VectorXd& x, const Eigen::VectorXd& y, const Eigen::VectorXd& error) {
  Series out{"grains", x, y, error, true};
  out.points = true;
  return out;
}

std::vector<Chart> pressure_charts(const GasResults& results) {
  std::vector<GasState> states = results.states;
  std::sort(states.begin(), states.end(),
            [](const GasState& a, const GasState& b) { return a.fraction < b.fraction; });
  const std::size_t n = states.size();
  const Eigen::VectorXd x = each(n, [&](std::size_t k) { return states[k].fraction; });
  const double most = x.maxCoeff();
  const Eigen::VectorXd fine =
      Eigen::VectorXd::LinSpaced(kSmooth, n > 1 ? std::min(0.02, x.minCoeff()) : 0, most);
  const char* name = theory_name(results.setup);
  Chart pressure{"Pressure", fraction_name(results.setup), "p V / (n k T)", "", {}, false};
  Frame frame;
  frame.series.push_back(
      grains_of(x, each(n, [&](std::size_t k) { return states[k].compressibility.mean; }),
                each(n, [&](std::size_t k) { return states[k].compressibility.error; })));
  frame.series.push_back({name,
                          fine,
                          fine.unaryExpr([&](double f) { return gas_theory(results.setup, f); }),
                          {},
                          false});
  pressure.frames.push_back(std::move(frame));

  Chart rest{
      "Pressure and collisions over theory",
      fraction_name(results.setup),
      "over theory",
      fmt::format("Enskog's rate with the pair distribution at contact that follows from {}'s "
                  "Z. Virial series: ten coefficients, continued.",
                  name),
      {},
      false};
  const auto over = [&](const std::string& title, const Eigen::VectorXd& y,
                        const Eigen::VectorXd& error) {
    Frame one;
    one.title = title;
    one.series.push_back(grains_of(x, y, error));
    one.series.push_back({name, x, Eigen::VectorXd::Ones(x.size()), {}, false});
    one.series.push_back({"virial series",
                          x,
                          each(n,
                               [&](std::size_t k) {
                                 const double z = states[k].theory, v = states[k].series;
                                 return rest.frames.empty() ? v / z : (v - 1) / (z - 1);
                               }),
                          {},
                          false});
    rest.frames.push_back(std::move(one));
  };
  over(fmt::format("p V / (n k T) over {}'s", name),
       each(n, [&](std::size_t k) { return states[k].compressibility.mean / states[k].theory; }),
       each(n, [&](std::size_t k) { return states[k].compressibility.error / states[k].theory; }));
  over("collisions per second over Enskog's",
       each(n, [&](std::size_t k) { return states[k].rate_over_enskog.mean; }),
       each(n, [&](std::size_t k) { return states[k].rate_over_enskog.error; }));
  return {pressure, rest};
}

std::vector<Chart> cooling_charts(const GasResults& results) {
  Chart chart{"Cooling",
              "time / Haff's time",
              "sqrt(T(0) / T)",
              "Haff's law is the straight line 1 + t/tau; nothing is fitted.",
              {},
              false};
  Chart over{"Temperature over Haff's",
             "collisions a grain",
             "T over Haff's law",
             "Grains that stay mixed keep near 1; clusters let them collide less often.",
             {},
             false};
  for (const GasState& s : results.states) {
    const std::size_t n = s.time.size();
    const Eigen::VectorXd x = each(n, [&](std::size_t k) { return s.time[k]; });
    const Eigen::VectorXd mean = each(n, [&](std::size_t k) { return s.temperature[k].mean; });
    const Eigen::VectorXd error = each(n, [&](std::size_t k) { return s.temperature[k].error; });
    const Eigen::VectorXd root = mean.array().rsqrt();
    Frame frame, ratio;
    frame.title = ratio.title = fmt::format("{} {:g}", fraction_name(results.setup), s.fraction);
    frame.series.push_back(grains_of(x, root, 0.5 * error.cwiseQuotient(mean).cwiseProduct(root)));
    if (has_haff(results)) {
      frame.series.push_back({"Haff", x, x.array() + 1, {}, false});
      const Eigen::VectorXd law = x.unaryExpr([](double t) { return haff(t); });
      const Eigen::VectorXd met = each(n, [&](std::size_t k) { return s.collisions[k]; });
      ratio.series.push_back(grains_of(met, mean.cwiseQuotient(law), error.cwiseQuotient(law)));
      over.frames.push_back(std::move(ratio));
    }
    chart.frames.push_back(std::move(frame));
  }
  if (over.frames.empty()) return {chart};
  return {over, chart};
}

std::string shown(const GasValue& v) { return with_error(v.mean, v.error); }

}  // namespace

double gas_theory(const dem::HardParticlesSetup& s, double fraction) {
  return s.is_3d() ? dem::gas_compressibility<3>(fraction) : dem::gas_compressibility<2>(fraction);
}

double gas_series(const dem::HardParticlesSetup& s, double fraction) {
  return s.is_3d() ? dem::gas_virial_series<3>(fraction) : dem::gas_virial_series<2>(fraction);
}

std::vector<Chart> gas_charts(const GasResults& results) {
  return results.setup.kind == "pressure" ? pressure_charts(results) : cooling_charts(results);
}

Table gas_table(const GasResults& results) {
  Table out;
  if (results.setup.kind == "pressure") {
    out.title = "Pressure and collisions";
    out.header = {fraction_name(results.setup),        "Z",
                  theory_name(results.setup),          "difference",
                  "difference from the virial series", "collisions per second over Enskog's"};
    const auto over = [](const GasValue& z, double theory) {
      return fmt::format("{:+.2f} ± {:.2f} %", 100 * (z.mean / theory - 1), 100 * z.error / theory);
    };
    for (const GasState& s : results.states) {
      out.rows.push_back({fmt::format("{:g}", s.fraction), shown(s.compressibility),
                          fmt::format("{:.5g}", s.theory), over(s.compressibility, s.theory),
                          over(s.compressibility, s.series), shown(s.rate_over_enskog)});
    }
    return out;
  }
  out.title = "Temperature at the end";
  out.header = {fraction_name(results.setup),
                "time over Haff's",
                "collisions a grain",
                "T / T_0",
                "Haff",
                "T of spins / T_0"};
  for (const GasState& s : results.states) {
    out.rows.push_back({fmt::format("{:g}", s.fraction), fmt::format("{:.4g}", s.time.back()),
                        fmt::format("{:.4g}", s.collisions.back()), shown(s.temperature.back()),
                        has_haff(results) ? fmt::format("{:.4g}", haff(s.time.back())) : "-",
                        shown(s.spin_temperature.back())});
  }
  return out;
}

std::string gas_csv(const GasResults& results) {
  Csv out;
  if (results.setup.kind == "pressure") {
    out.row("fraction", "compressibility", "compressibility_error", "theory", "virial_series",
            "collision_rate_over_enskog", "collision_rate_error");
    for (const GasState& s : results.states) {
      out.row(s.fraction, s.compressibility.mean, s.compressibility.error, s.theory, s.series,
              s.rate_over_enskog.mean, s.rate_over_enskog.error);
    }
    return out.text();
  }
  out.row("fraction", "time_over_haff", "collisions_per_grain", "temperature", "temperature_error",
          "haff", "spin_temperature", "spin_temperature_error");
  for (const GasState& s : results.states) {
    for (std::size_t k = 0; k < s.time.size(); ++k) {
      out.row(s.fraction, s.time[k], s.collisions[k], s.temperature[k].mean, s.temperature[k].error,
              has_haff(results) ? haff(s.time[k]) : kNan, s.spin_temperature[k].mean,
              s.spin_temperature[k].error);
    }
  }
  return out.text();
}

double gas_largest_difference(const GasResults& results) {
  double out = 0;
  for (const GasState& s : results.states) {
    if (results.setup.kind == "pressure") {
      out = std::max(out, std::fabs(s.compressibility.mean / s.theory - 1));
    } else if (has_haff(results)) {
      for (std::size_t k = 0; k < s.time.size(); ++k) {
        out = std::max(out, std::fabs(s.temperature[k].mean / haff(s.time[k]) - 1));
      }
    }
  }
  return out;
}

std::string gas_sentence(const GasResults& results) {
  const double most = 100 * gas_largest_difference(results);
  if (results.setup.kind == "pressure") {
    return fmt::format(
        "The pressure differs from {}'s by at most {:.2g} %, {}.", theory_name(results.setup), most,
        results.states.size() == 1
            ? fmt::format("{} {:g}", fraction_name(results.setup), results.states.front().fraction)
            : fmt::format("at {} {}s", results.states.size(), fraction_name(results.setup)));
  }
  const GasState& last = results.states.back();
  if (!has_haff(results)) {
    return fmt::format("After {:.4g} collisions a grain {:.3g} of the temperature is left.",
                       last.collisions.back(), last.temperature.back().mean);
  }
  return fmt::format(
      "While Haff's law cools the gas to {:.3g} of its temperature, the grains differ from it by "
      "{:.2g} % at most.",
      results.setup.cool_to, most);
}

std::string gas_subtitle(const dem::HardParticlesSetup& s) {
  const std::string what = s.kind == "pressure" ? "without loss"
                                                : fmt::format("restitution {:g}, friction {:g}",
                                                              s.restitution, s.friction);
  return fmt::format("{} hard {}s in a periodic box, {}", s.grains, s.shape, what);
}

}  // namespace grainfield::coupling
