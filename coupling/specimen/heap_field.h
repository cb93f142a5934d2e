// What a field in the heaps' frame says of its heaps.
#pragma once
#include <stdexcept>
#include <string>
#include <vector>

#include "coupling/base/field.h"
#include "coupling/specimen/pile_frame.h"
#include "dem/shared/refuse.h"

namespace grainfield::coupling {

/// What to do with a cone, which fits do not take.
inline constexpr const char* kCompareCones =
    "of a cone: `grainfield average FILE.h5 --frame heap -o FIELD.h5`, then `grainfield compare "
    "FIELD.h5 --model cone_osl,cone_fpa,cone_bcc`";

/// One number per realization; of a field without single values one mean each.
struct HeapFieldFacts {
  std::vector<double> height;               ///< h, m
  std::vector<double> pressure;             ///< rho g h, N/m: what to divide values by
  std::vector<double> left_deg, right_deg;  ///< slopes, of cones repose_deg both; nan: not known

  double mean_height() const;
  double mean_pressure() const;
};

/// Height, pressure and slopes of every heap, as attributes.
void say_heaps(const std::vector<PileFrame>& heaps, Field& field);

/// `count`: realizations whose values are used; 1: the mean. Throws std::invalid_argument beginning
/// with `where` for another frame, missing attributes or numbers that do not fit.
HeapFieldFacts heap_field_facts(const Field& field, std::size_t count, const std::string& where);

/// The same field in m and N/m of the mean heap: every realization scaled by its own rho g h where
/// there are single values of the stresses.
Field in_mean_heap(Field field, const std::string& where);

/// Throws std::invalid_argument beginning with `where` when the mean of sigma_yy over the field is
/// tension (positive): the forces of the packings have the wrong sign. Without that column:
/// nothing.
void require_compression(const Field& field, const std::string& where);

/// The attribute that is a text, or a number; throws std::invalid_argument beginning with `where`
/// where it is missing or of another kind.
std::string field_word(const Field& field, const std::string& name, const std::string& where);
double field_number(const Field& field, const std::string& name, const std::string& where);

}  // namespace grainfield::coupling
