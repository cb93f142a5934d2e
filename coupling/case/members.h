// The members of a sweep: their names, and what they may be.
#pragma once
#include <string>
#include <vector>

#include "coupling/case/apply.h"

namespace grainfield::coupling {

/// Longest name of a model, a variant or a sweep's member, and of any part of a key.
inline constexpr std::size_t kLongestName = 100;

/// The member's folder and its ending of keys in summary.json: "friction_0.3"; of a variant its
/// name.
std::string member_name(const std::string& key, const std::string& value);

/// The members of a draft's sweep as they would be read.
class Members {
 public:
  explicit Members(const Draft& draft);
  /// The member of this value, not finished. Throws std::invalid_argument for what apply() refuses.
  Draft of(const std::string& value) const;

 private:
  Draft bare_;  // without sweep and variants
  SweepSetup sweep_;
  std::vector<Variant> variants_;
};

/// Throws std::invalid_argument "ORIGIN: KEY: ..." for a sweep without key or values, for members
/// that could not be run, and for folders that two members would share or that the run itself
/// needs.
void check_sweep(const Draft& draft);

}  // namespace grainfield::coupling
