// Every key of a case file, declared once. Validation, `grainfield keys`, docs/keys.md, the
// written-out case.toml and the filled structs come from this list.
#pragma once
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "coupling/case/case.h"

namespace grainfield::coupling {

/// Where a key's value lives. The default is what a fresh Case holds there.
using Binding = std::variant<double& (*)(Case&), std::int64_t& (*)(Case&), int& (*)(Case&),
                             bool& (*)(Case&), std::string& (*)(Case&),
                             std::vector<double>& (*)(Case&), std::vector<std::string>& (*)(Case&)>;

/// Most entries of any list.
inline constexpr std::size_t kMostEntries = 1000;

/// What gives a key its effect: another one that is (of a list: holds) one of these values.
struct Need {
  std::string key;                  ///< its path
  std::vector<std::string> values;  ///< as TOML, words bare; of a list empty: any
};

struct Key {
  std::string section;  ///< empty: top level
  std::string name;
  std::string unit;  ///< "-" for pure numbers and words
  Binding where;
  double least = 0, most = 0;        ///< numbers: inclusive range
  std::vector<std::string> choices;  ///< words: those allowed, of all studies; empty: any text
  std::string meaning;               ///< with what raising it does
  std::string source;                ///< of the default, e.g. "Roul table 5.1"; may be empty
  bool or_zero = false;              ///< 0 is allowed besides
  bool may_be_empty = false;         ///< lists: without any value
  bool may_repeat = false;           ///< lists: a value more than once
  std::vector<Need> needs;           ///< all of them, of the keys that the study has

  bool plane_shapes = false;  ///< its words are shapes of grains in the plane

  std::string follows;    ///< what the default follows: "2/7 of normal_stiffness"; empty: nothing
  bool remarked = false;  ///< written-out cases have it as a remark: another key says the same

  bool space = false;                    ///< only in three dimensions
  std::vector<std::string> plane_words;  ///< of the choices, those of two dimensions only
  std::vector<std::string> space_words;  ///< ... and of three

  std::string path() const { return section.empty() ? name : section + "." + name; }
};

const std::vector<Key>& keys();
const Key* find_key(const std::string& path);
/// Sections in order, without the top level.
std::vector<std::string> sections();
/// Whether a section, or a key of it, means something to a study (coupling/case/study.h).
bool section_applies(const std::string& section, const std::string& study);
bool key_applies(const Key& key, const std::string& study);
/// Whether what the case chooses elsewhere leaves a key without effect (source.height of a line
/// source). Not when the run varies that choice.
bool is_without_effect(const Key& key, const Case& value);
/// The first need that leaves it so; null where none does.
const Need* unmet_need(const Key& key, const Case& value);
/// "source.kind = point", "3D"; empty for a key that depends on no other. A need of some of the
/// key's studies alone says of which: "pair.kind = collision (study pair)".
std::string condition(const Key& key);
/// What is said of a key without effect: "has no effect, only with source.kind = point (now
/// "line")".
std::string without_effect_text(const Key& key, const Case& value);

/// The number of dimensions of the case's grains (coupling/case/study.h).
int dimension_of(const Case& value);
/// Whether that can be three for some case of the study.
bool may_be_in_space(const std::string& study);

/// "number", "integer", "boolean", "word", "text", "list of numbers", "list of words".
std::string type_name(const Key& key);
/// What a list may hold: "one or more, each once"; empty for other keys.
std::string entries_allowed(const Key& key);
/// "0 to 2", "0, or 1e-06 to 1000", "smooth | rough", "any finite number". Of a key whose studies
/// have words of their own those of this one; of all where it has none.
std::string allowed(const Key& key, const std::string& study = "");
/// The words that a key takes in a study, none where it takes any text.
const std::vector<std::string>& choices_of(const Key& key, const std::string& study);
/// OwnWords::check of the key in a study; null: it has no words besides its choices.
ModelTextCheck model_check_of(const Key& key, const std::string& study);
/// The value of a key in a case, as TOML.
std::string value_text(const Key& key, const Case& value);

/// The text in double quotes, as TOML.
std::string toml_text(const std::string& text);
/// Whether the text is made of letters, digits, "_" and "-": what TOML takes without quotes, and
/// what names files, fields and keys of summary.json.
bool plain_name(const std::string& text);

/// What `grainfield keys` prints: all (""), those of a study, by its name, with its defaults,
/// one section ("fit"), one key ("fit.heights"), or those with a part of that name ("frict",
/// "pair."). Throws std::invalid_argument with the nearest name for an unknown one.
std::string keys_text(const std::string& name);
/// docs/keys.md.
std::string keys_markdown();

}  // namespace grainfield::coupling
