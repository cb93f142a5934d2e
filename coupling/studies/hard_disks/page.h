// Pictures, tables and words of gases of hard grains.
#pragma once
#include <string>
#include <vector>

#include "coupling/report/picture.h"
#include "coupling/report/report.h"
#include "coupling/result/figure.h"
#include "coupling/studies/hard_disks/simulation.h"

namespace grainfield::coupling {

/// Compressibility at a fraction: Henderson's, or Carnahan and Starling's.
double gas_theory(const dem::HardParticlesSetup& setup, double fraction);
/// And the virial series.
double gas_series(const dem::HardParticlesSetup& setup, double fraction);

/// Mean over the realizations with its standard error (nan: one realization alone).
struct GasValue {
  double mean = 0, error = 0;
};

/// A gas of one fraction.
struct GasState {
  double fraction = 0;
  GasValue compressibility, rate_over_enskog;  ///< pressure
  double theory = 0, series = 0;               ///< Henderson's or Carnahan and Starling's; virial
  /// Cooling: time over Haff's, and at each the temperature and that of spins over the first.
  std::vector<double> time, collisions;
  std::vector<GasValue> temperature, spin_temperature;
};

struct GasResults {
  dem::HardParticlesSetup setup;
  std::vector<GasState> states;
};

/// Pressure against the fraction, or temperature against time.
std::vector<Chart> gas_charts(const GasResults& results);
Table gas_table(const GasResults& results);
/// profiles.csv: the same numbers.
std::string gas_csv(const GasResults& results);
/// The answer in a sentence.
std::string gas_sentence(const GasResults& results);
std::string gas_subtitle(const dem::HardParticlesSetup& setup);

/// Largest |value over theory - 1| of all fractions (and times); 0 where there is no theory.
double gas_largest_difference(const GasResults& results);

/// All fractions and realizations of a run.
struct GasFacts {
  const GasResults& results;
  const FigureSamples& figures;  ///< "gas.FRACTION.*", as the simulations left them
};
const std::vector<RunFigure<GasFacts>>& gas_rows();

}  // namespace grainfield::coupling
