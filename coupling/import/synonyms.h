// What other programs call our columns.
#pragma once
#include <string>
#include <vector>

namespace grainfield::coupling {

/// A name without what does not tell columns apart: in lower case, without signs and blanks, up to
/// a unit in brackets. "Pos-X (mm)" -> "posx".
std::string plain_column_name(const std::string& name);

/// Plain names that other programs have for ours: `sure` are those that mean nothing else beside
/// our other columns, so that the import takes them, `likely` those that it only suggests, and
/// `components` those that it takes where they are written as a vector's, "v[0]" or "v:0".
struct Synonyms {
  std::vector<std::string> sure, likely, components = {};
};
const Synonyms& synonyms_of(const std::string& ours);

/// The column of `columns` that likely means ours; empty: none.
std::string same_meaning(const std::string& ours, const std::vector<std::string>& columns);

/// A plain name of one of the numbered components of a vector, counted from 0: where `all` has
/// velocity1 and velocity2 and no velocity0, velocity1 is velocity0. Empty: of half a vector. Names
/// of the two bodies of a contact count from 1: beside id0, id1 is id2.
std::string counted_from_zero(const std::string& plain, const std::vector<std::string>& all);

/// Whether it is, plainly written, one of our names or a sure synonym of one.
bool is_known_name(const std::string& name);

}  // namespace grainfield::coupling
