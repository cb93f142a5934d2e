#include "coupling/case/members.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <cctype>
#include <map>
#include <stdexcept>

namespace grainfield::coupling {
namespace {

constexpr const char* kVariant = "variant";

// Endings of the files that a run leaves beside its members' folders.
const std::vector<std::string>& endings() {
  static const std::vector<std::string> all{".csv", ".h5",  ".html", ".json", ".md",
                                            ".svg", ".tex", ".toml", ".vtu",  ".xdmf"};
  return all;
}

// Why a folder of this name, in small letters, cannot hold a member; "": it can.
std::string own_name(const std::string& name) {
  if (name == "checkpoint") return "the run keeps its state in a folder of that name";
  if (name.starts_with('.')) return "names that begin with a dot are the run's own";
  for (const std::string& ending : endings()) {
    if (name.ends_with(ending)) return fmt::format("files named *{} are the run's own", ending);
  }
  // Endings of keys: KEY.standard_error beside KEY is an error, not a member.
  for (const char* ending : {"least", "most", "standard_error"}) {
    if (name == ending) return "figures in summary.json end so";
  }
  return "";
}

// Folders of the members, told apart also where small and capital letters are one.
void check_names(const Draft& draft, const Assignment& where) {
  const SweepSetup& sweep = draft.value.sweep;
  std::map<std::string, std::string> taken;  // small letters of the name, value
  for (const std::string& value : sweep.values) {
    const std::string name = member_name(sweep.key, value);
    const auto refuse = [&](const std::string& why) {
      reject(where, "sweep.values",
             fmt::format("found \"{}\", whose folder would be \"{}\": {}; choose another {}", value,
                         name, why, sweep.key == kVariant ? "name" : "value"));
    };
    if (name.empty()) refuse("allowed: a name");
    if (name.size() > kLongestName) {
      refuse(fmt::format("{} characters, allowed: up to {}", name.size(), kLongestName));
    }
    const std::string small = boost::algorithm::to_lower_copy(name);
    if (const std::string why = own_name(small); !why.empty()) refuse(why);
    const auto [other, fresh] = taken.emplace(small, value);
    if (!fresh) refuse(fmt::format("that of \"{}\" as well", other->second));
  }
}

}  // namespace

std::string member_name(const std::string& key, const std::string& value) {
  std::string out = key == kVariant ? "" : key.substr(key.rfind('.') + 1) + "_";
  for (const char ch : value) {
    const auto c = static_cast<unsigned char>(ch);
    out += std::isalnum(c) != 0 || ch == '.' || ch == '-' || ch == '+' ? ch : '_';
  }
  return out;
}

Members::Members(const Draft& draft) : bare_(draft), sweep_(draft.value.sweep) {
  variants_.swap(bare_.value.variants);
  bare_.value.sweep = {};
  bare_.last.erase("sweep.key");
  bare_.last.erase("sweep.values");
  bare_.members = std::max<std::size_t>(1, sweep_.values.size());
}

Draft Members::of(const std::string& value) const {
  Draft one = bare_;
  if (sweep_.key == kVariant) {
    const auto named = std::find_if(variants_.begin(), variants_.end(),
                                    [&](const Variant& v) { return v.name == value; });
    // All others are told where a name is not there.
    one.value.variants = named != variants_.end() ? std::vector<Variant>{*named} : variants_;
  }
  apply(one, parse_override(sweep_.key + "=" + value));
  one.value.variants.clear();
  return one;
}

void check_sweep(const Draft& draft) {
  const SweepSetup& sweep = draft.value.sweep;
  const Assignment values = written(draft, "sweep.values");
  if (sweep.key.empty()) {
    if (!sweep.values.empty()) reject(values, "sweep.values", "needs sweep.key as well");
    return;
  }
  const Assignment where = written(draft, "sweep.key");
  if (sweep.key.compare(0, 6, "sweep.") == 0)
    reject(where, "sweep.key", "cannot be one of [sweep]");
  std::vector<std::string> names;
  if (sweep.key == kVariant) {
    for (const Variant& variant : draft.value.variants) names.push_back(variant.name);
  }
  if (sweep.values.empty()) {
    reject(where, "sweep.key",
           names.empty()
               ? std::string("needs sweep.values as well")
               : fmt::format("needs sweep.values as well, of: {}", fmt::join(names, ", ")));
  }
  check_names(draft, values);
  if (!names.empty()) {
    for (const std::string& name : sweep.values) {
      if (std::find(names.begin(), names.end(), name) != names.end()) continue;
      reject(values, "sweep.values",
             fmt::format("found \"{}\", allowed: {}; did you mean {}?", name,
                         fmt::join(names, ", "), continuum::nearest(name, names)));
    }
  }
  const bool known = find_key(sweep.key) != nullptr;
  const Members members(draft);
  const auto blame = [&](std::string what) {
    const std::string set = "--set: ";
    if (what.compare(0, set.size(), set) == 0) what = what.substr(set.size());
    reject(known ? values : where, known ? "sweep.values" : "sweep.key", what);
  };
  const auto attempt = [&](const auto& act) {
    MistakeList own;
    own.attempt(act);
    MistakeList blamed;
    for (const std::string& what : own.lines()) blamed.attempt([&] { blame(what); });
    blamed.require_none();
  };
  MistakeList mistakes;
  for (const auto& text : sweep.values) {
    mistakes.attempt([&] { attempt([&] { members.of(text); }); });
  }
  mistakes.require_none();
  for (const auto& text : sweep.values) {
    attempt([&] {
      Draft one = members.of(text);
      finish(one);
    });
  }
}

}  // namespace grainfield::coupling
