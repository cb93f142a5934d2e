#include "coupling/case/apply.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <type_traits>

#include "coupling/case/study.h"
#include "coupling/case/units.h"
#include "dem/shapes/registry.h"
#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

void check_range(const Key& key, const Assignment& a, double value) {
  const bool inside = std::isfinite(value) && key.least <= value && value <= key.most;
  const bool ok = inside || (key.or_zero && value == 0);
  if (!ok) reject(a, key.path(), fmt::format("found {:g}, allowed: {}", value, allowed(key)));
}

// Shapes of three dimensions, given to a study of grains in the plane; empty: the word is none.
std::string of_three_dimensions(const Key& key, const std::string& word) {
  if (!key.plane_shapes) return "";
  const auto words = dem::words_where<dem::AnyShape>([]<class Kind>() { return Kind::dim == 3; });
  if (std::find(words.begin(), words.end(), word) == words.end()) return "";
  return fmt::format("\"{}\" is a shape of 3D; the grains of this study are in 2D", word);
}

// The keys of numbers that continue a word's name, as unload_strain does unload; may be empty.
std::string numbers_of(const Key& key) {
  std::vector<std::string> out;
  for (const Key& other : keys()) {
    if (other.choices.empty() && other.path().starts_with(key.path() + "_")) {
      out.push_back(other.path());
    }
  }
  return fmt::format("{}", fmt::join(out, ", "));
}

// Names that begin alike over two thirds of the shorter one, as radius and radii do.
bool begin_alike(const std::string& a, const std::string& b) {
  const auto ends = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  return 3 * (ends.first - a.begin()) >= 2 * static_cast<long>(std::min(a.size(), b.size()));
}

void check_choice(const Key& key, const Assignment& a, const std::string& value,
                  const std::string& study) {
  const std::vector<std::string>& choices = choices_of(key, study);
  if (choices.empty() || std::find(choices.begin(), choices.end(), value) != choices.end()) return;
  const std::string all = allowed(key, study);
  if (const ModelTextCheck check = model_check_of(key, study)) {
    const ModelText text = check(value);
    if (text.is == ModelText::Is::model) return;
    if (text.is == ModelText::Is::refused) reject(a, key.path(), text.why);
  }
  if (const std::string why = of_three_dimensions(key, value); !why.empty()) {
    reject(a, key.path(), fmt::format("found \"{}\", allowed: {}; {}", value, all, why));
  }
  if (const std::string keys = numbers_of(key); !keys.empty() && parse_number(value)) {
    reject(a, key.path(),
           fmt::format("found \"{}\", allowed: {}; a number goes into {}", value, all, keys));
  }
  reject(a, key.path(),
         fmt::format("found \"{}\", allowed: {}; did you mean {}?", value, all,
                     continuum::nearest(value, choices)));
}

// A number with something behind it that is no unit, such as "4 mn" or "4mm".
void refuse_unknown_unit(const Key& key, const Assignment& a) {
  for (const Scalar& item : a.items) {
    const auto* text = std::get_if<std::string>(&item);
    if (text == nullptr || measured(key, a, *text)) continue;
    const std::size_t behind = text->find_first_not_of(" +-.0123456789");
    if (behind == std::string::npos ||
        std::ispunct(static_cast<unsigned char>((*text)[behind])) != 0) {
      continue;  // "20,40" is no number with a unit
    }
    std::string number = text->substr(0, behind);
    number.erase(number.find_last_not_of(' ') + 1);
    if (number.size() == text->size() || !parse_number(number)) continue;
    reject(a, key.path(),
           fmt::format("found \"{}\", expected a number {}", *text,
                       key.unit == "-"
                           ? "without unit"
                           : fmt::format("in {}, or with a unit ({})", key.unit, known_units())));
  }
}

void refuse_decimal_comma(const Key& key, const Assignment& a) {
  for (const Scalar& item : a.items) {
    const auto* text = std::get_if<std::string>(&item);
    const std::string right = text == nullptr ? "" : with_point(*text);
    if (right.empty()) continue;
    reject(a, key.path(),
           fmt::format("found \"{}\", allowed: a decimal point; write {}", *text, right));
  }
}

[[noreturn]] void wrong_type(const Key& key, const Assignment& a) {
  const std::string type = type_name(key);
  if (type == "number" || type == "list of numbers") refuse_unknown_unit(key, a);
  if (type == "number") refuse_decimal_comma(key, a);
  const char* article = type == "integer" ? "an" : "a";
  const char* example = type == "list of numbers" ? " [0.2, 0.4]"
                        : type == "list of words" ? " [\"one\", \"two\"]"
                        : type == "boolean"       ? " true or false"
                                                  : "";
  reject(a, key.path(),
         fmt::format("found {}, expected {} {}{}{}", describe(a), article, type,
                     *example != 0 ? ", written" : "", example));
}

double number(const Key& key, const Assignment& a, const Scalar& scalar) {
  constexpr std::int64_t most_exact = 9007199254740992;  // beyond, a double skips whole numbers
  double value = 0;
  if (const auto* i = std::get_if<std::int64_t>(&scalar)) {
    value = static_cast<double>(*i);
    if (*i > most_exact || *i < -most_exact) {
      reject(a, key.path(), fmt::format("found {}, allowed: {}", *i, allowed(key)));
    }
  } else if (const auto* d = std::get_if<double>(&scalar)) {
    value = *d;
  } else {
    const auto* text = std::get_if<std::string>(&scalar);
    const std::optional<double> with_unit =
        text != nullptr ? measured(key, a, *text) : std::nullopt;
    if (!with_unit) wrong_type(key, a);
    value = *with_unit;
  }
  check_range(key, a, value);
  return value;
}

std::string word(const Key& key, const Assignment& a, const Scalar& scalar,
                 const std::string& study) {
  // A sweep's values are of its key's type; on the command line words need no quotes.
  const bool any = key.path() == "sweep.values" || a.from_command_line();
  if (!any && !std::holds_alternative<std::string>(scalar)) wrong_type(key, a);
  const std::string value = scalar_text(scalar);
  check_choice(key, a, value, study);
  return value;
}

void set(const Key& key, const Assignment& a, Case& value) {
  std::visit(
      [&](auto where) {
        auto& held = where(value);
        using T = std::decay_t<decltype(held)>;
        if constexpr (std::is_same_v<T, std::vector<double>>) {
          if (a.items.empty() && !key.may_be_empty)
            reject(a, key.path(), "found an empty list, expected numbers");
          held.clear();
          for (const auto& item : a.items) held.push_back(number(key, a, item));
        } else if constexpr (std::is_same_v<T, std::vector<std::string>>) {
          held.clear();
          for (const auto& item : a.items) held.push_back(word(key, a, item, value.study));
        } else {
          if (a.list) wrong_type(key, a);
          const Scalar& item = a.items.front();
          if constexpr (std::is_same_v<T, std::string>) {
            held = a.from_command_line() && key.choices.empty() &&
                           !std::holds_alternative<std::string>(item)
                       ? a.text
                       : word(key, a, item, value.study);
          } else if constexpr (std::is_same_v<T, bool>) {
            if (!std::holds_alternative<bool>(item)) wrong_type(key, a);
            held = std::get<bool>(item);
          } else if constexpr (std::is_same_v<T, double>) {
            held = number(key, a, item);
          } else {
            if (!std::holds_alternative<std::int64_t>(item)) wrong_type(key, a);
            held = static_cast<T>(number(key, a, item));
          }
        }
      },
      key.where);
}

[[noreturn]] void unknown(const Assignment& a, const std::string& study) {
  const std::string section = a.path.substr(0, a.path.find('.'));
  if (section == "units" || section == "unit") {
    reject(a, section,
           "unknown: numbers are in SI units, and a value in another carries it, as in radius = "
           "\"3.6 mm\"");
  }
  for (const KeySection& known : study_sections()) {
    if (known.former == nullptr || section != known.former) continue;
    reject(a, section, fmt::format("found the section's former name, now: {}", known.name));
  }
  const auto with_keys = sections();
  auto names = with_keys;
  names.insert(names.end(), {"model", "variant", "quick"});
  const bool sectioned = a.table || section.size() < a.path.size();
  if (sectioned && std::find(names.begin(), names.end(), section) == names.end()) {
    reject(a, section, "unknown section; did you mean " + continuum::nearest(section, names) + "?");
  }
  if (!a.table && std::find(with_keys.begin(), with_keys.end(), a.path) != with_keys.end()) {
    reject(a, a.path,
           fmt::format("found {}, expected a section [{}] (its keys: grainfield keys {})",
                       describe(a), a.path, a.path));
  }
  // SECTION.NAME may be SECTION_NAME elsewhere; a name of this section that begins alike is
  // nearest, then one that exists in another section, then any of this one.
  const std::string name = a.path.substr(a.path.rfind('.') + 1);
  std::vector<std::string> here, everywhere;
  std::string near, joined;
  for (const Key& key : keys()) {
    everywhere.push_back(key.path());
    if (sectioned && key.section == section) here.push_back(key.path());
    if (key.name == name &&
        (near.empty() || (!key_applies(*find_key(near), study) && key_applies(key, study)))) {
      near = key.path();
    }
    if (sectioned && key.name == section + "_" + name) joined = key.path();
  }
  if (!joined.empty()) near = joined;
  if (std::any_of(here.begin(), here.end(), [&](const std::string& path) {
        return begin_alike(path.substr(section.size() + 1), name);
      })) {
    near.clear();
  }
  if (near.empty()) near = continuum::nearest(a.path, here.empty() ? everywhere : here);
  reject(a, a.path, "unknown key; did you mean " + near + "?");
}

// A value as TOML.
std::string value_of(const Assignment& a) {
  std::string out;
  for (const Scalar& item : a.items) {
    out += (out.empty() ? "" : ", ");
    const auto* word = std::get_if<std::string>(&item);
    out += word != nullptr ? toml_text(*word) : scalar_text(item);
  }
  return a.list ? "[" + out + "]" : out;
}

Variant& variant_named(Draft& draft, const std::string& name) {
  auto& variants = draft.value.variants;
  const auto at = std::find_if(variants.begin(), variants.end(),
                               [&](const Variant& v) { return v.name == name; });
  return at != variants.end() ? *at : *variants.insert(variants.end(), {name, {}});
}

// [variant.NAME.SECTION]: kept until a sweep takes it, but checked at once. An empty [variant.NAME]
// is the case as it is.
void keep_for_variant(Draft& draft, const Assignment& a) {
  const std::string rest = a.path.substr(std::string_view("variant.").size());
  const std::size_t dot = rest.find('.');
  const std::string name = rest.substr(0, dot);
  if (a.table) {
    variant_named(draft, name);
    return;
  }
  if (dot == std::string::npos) {
    reject(a, a.path, "found a value, expected a table [variant.NAME] of keys");
  }
  Assignment inner = a;
  inner.path = rest.substr(dot + 1);
  if (inner.path.compare(0, 8, "variant.") == 0 || inner.path.compare(0, 6, "sweep.") == 0 ||
      inner.path == "study") {
    reject(a, a.path, "cannot be part of a variant");
  }
  Draft scratch;
  scratch.value.study = draft.value.study;
  apply(scratch, inner);
  std::vector<std::string>& kept = variant_named(draft, name).keys;
  const std::string start = inner.path + "=";
  kept.erase(std::remove_if(kept.begin(), kept.end(),
                            [&](const std::string& k) { return k.rfind(start, 0) == 0; }),
             kept.end());
  kept.push_back(start + value_of(inner));
}

// A sweep's member: the keys of the named variant.
void take_variant(Draft& draft, const Assignment& a) {
  const std::string name = a.items.size() == 1 ? scalar_text(a.items.front()) : a.text;
  const std::vector<Variant> variants = draft.value.variants;
  std::vector<std::string> names;
  for (const Variant& v : variants) {
    names.push_back(v.name);
    if (v.name != name) continue;
    for (const std::string& key : v.keys) apply(draft, parse_override(key));
    draft.value.variants.clear();
    return;
  }
  reject(a, "variant",
         names.empty() ? "no [variant.NAME] in this case"
                       : fmt::format("found \"{}\"; did you mean {}?", name,
                                     continuum::nearest(name, names)));
}

}  // namespace

void reject(const Assignment& a, const std::string& key, const std::string& what) {
  throw std::invalid_argument(fmt::format("{}: {}: {}", a.origin, key, what));
}

void apply(Draft& draft, const Assignment& a) {
  constexpr std::string_view model = "model.";
  if (a.path.compare(0, model.size(), model) == 0) {
    const std::string rest = a.path.substr(model.size());
    const std::size_t dot = rest.find('.');
    if (dot == std::string::npos) {
      if (!a.table) reject(a, a.path, "found a value, expected a table [model.LABEL]");
      draft.models[rest];
      return;
    }
    const std::string parameter = rest.substr(dot + 1);
    if (a.other || a.list || a.table || parameter.find('.') != std::string::npos) {
      reject(a, a.path, fmt::format("found {}, expected a number or a word", describe(a)));
    }
    draft.models[rest.substr(0, dot)].insert_or_assign(parameter, a);
    return;
  }
  if (a.path.compare(0, 8, "variant.") == 0) return keep_for_variant(draft, a);
  if (a.path == "variant" && !a.table) return take_variant(draft, a);
  const Key* key = find_key(a.path);
  if (key == nullptr) {
    const auto names = sections();
    if (a.table &&
        (a.path == "model" || std::find(names.begin(), names.end(), a.path) != names.end())) {
      return;
    }
    unknown(a, draft.value.study);
  }
  if (a.table || a.other) wrong_type(*key, a);
  set(*key, a, draft.value);
  draft.last.insert_or_assign(a.path, a);
  draft.value.given.insert(a.path);
}

}  // namespace grainfield::coupling
