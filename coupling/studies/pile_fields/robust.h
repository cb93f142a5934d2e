// Medians over realizations: one pile in which grains rearranged does not spoil them.
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "coupling/result/figure.h"
#include "coupling/result/tables.h"
#include "coupling/statistics/bootstrap.h"

namespace grainfield::coupling {

/// Median of the numbers that are not nan; nan without any.
double median_of(std::vector<double> numbers);
/// 1.4826 times the median distance from the median: the standard deviation of normal numbers. nan
/// are left out; nan below two numbers.
double robust_deviation(const std::vector<double>& numbers);

/// A median with its bootstrap over realizations.
struct RobustMean {
  double median = std::numeric_limits<double>::quiet_NaN();
  double error = std::numeric_limits<double>::quiet_NaN();  ///< half the width of the middle 68 %
                                                            ///< of the draws
  double low = std::numeric_limits<double>::quiet_NaN();    ///< ends of the 95 % interval
  double high = std::numeric_limits<double>::quiet_NaN();
  int count = 0;  ///< numbers that are not nan
};

/// One number per realization; nan: that one has none. With one number error and ends are nan.
/// `resamples`: draws of the percentile bootstrap.
RobustMean robust_mean(const std::vector<double>& numbers, int resamples);

/// A figure of the piles: its value is the median of what `of` gives, a number for each.
template <class Facts>
using MedianFigure = Figure<Facts, std::vector<double>>;

/// KEY: the median; of two or more numbers also KEY.standard_error (of the median), KEY.least,
/// KEY.most.
void add_median(Summary& summary, const std::string& key, const std::vector<double>& numbers,
                int resamples);
/// The same of all rows.
template <class Facts>
void add_medians(const std::vector<MedianFigure<Facts>>& rows, const Facts& facts, int resamples,
                 Summary& summary, const std::string& prefix = "") {
  for (const MedianFigure<Facts>& row : rows) {
    if (const auto numbers = row.of(facts)) {
      add_median(summary, prefix + row.key, *numbers, resamples);
    }
  }
}

}  // namespace grainfield::coupling
