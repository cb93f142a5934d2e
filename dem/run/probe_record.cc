#include "dem/run/probe_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "dem/shared/number.h"

namespace grainfield::dem {
namespace {

constexpr std::string_view kAxes = "xyz";

// The columns of a table, each without values, in the order of row_of().
NumberTable empty_table() {
  NumberTable out{{"along", "1", {}}, {"across", "1", {}}, {"way", "1", {}}};
  for (const auto& [name, unit] :
       {std::pair{"before", "Pa"}, {"gradient", "1"}, {"stress", "Pa"}}) {
    for (const char a : kAxes) {
      for (const char b : kAxes) out.push_back({fmt::format("{}_{}{}", name, a, b), unit, {}});
    }
  }
  for (const char* name : {"gained", "lost", "sliding"}) out.push_back({name, "1", {}});
  return out;
}

std::vector<double> row_of(const StateProbes& all, const Probe& probe, std::size_t way) {
  const ProbeOutcome& o = probe.outcomes[way];
  std::vector<double> out;
  for (const char axis : probe.direction) {
    out.push_back(static_cast<double>(kAxes.find(axis) + 1));
  }
  out.push_back(way == 0 ? 1 : -1);
  for (const Eigen::Matrix3d* m : {&all.stress, &o.gradient, &o.stress}) {
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) out.push_back((*m)(a, b));
    }
  }
  out.insert(out.end(), {o.gained, o.lost, o.sliding});
  return out;
}

Eigen::Matrix3d matrix_of(const double* numbers) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(numbers);
}

// A matrix, another one, and three shares.
ProbeOutcome outcome_of(const double* numbers) {
  return {matrix_of(numbers), matrix_of(numbers + 9), numbers[18], numbers[19], numbers[20]};
}

void read_row(const std::vector<double>& row, const std::string& name, StateProbes& out) {
  std::string direction;
  for (const double axis : {row[0], row[1]}) {
    if (axis != 1 && axis != 2 && axis != 3) {
      throw std::invalid_argument(
          fmt::format("table \"{}\": found axis {:g}, allowed: 1, 2, 3", name, axis));
    }
    direction += kAxes[static_cast<std::size_t>(axis) - 1];
  }
  out.stress = matrix_of(&row[3]);
  add_outcome(out, direction, row[2] > 0 ? 0 : 1, outcome_of(&row[12]));
}

void read_table(const NumberTable& table, const std::string& name, StateProbes& out) {
  const NumberTable wanted = empty_table();
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    if (k < table.size() && table[k].name == wanted[k].name) continue;
    throw std::invalid_argument(
        fmt::format("table \"{}\": column {} is missing", name, wanted[k].name));
  }
  for (std::size_t r = 0; r < table.front().values.size(); ++r) {
    std::vector<double> row;
    for (const NumberColumn& column : table) row.push_back(column.values[r]);
    read_row(row, name, out);
  }
}

// The numbers of an attribute, exactly so many.
std::vector<double> probe_numbers(const std::string& name, const std::string& text,
                                  std::size_t wanted) {
  std::vector<double> out;
  std::istringstream in(text);
  for (std::string word; in >> word;) {
    const auto number = parse_number(word);
    if (!number) break;
    out.push_back(*number);
  }
  if (out.size() != wanted) {
    throw std::invalid_argument(
        fmt::format("attribute \"{}\": found {} numbers, allowed: {}", name, out.size(), wanted));
  }
  return out;
}

// As version 0.9.0 wrote them.
void read_attributes(const std::map<std::string, std::string>& attributes, const std::string& begin,
                     StateProbes& out) {
  for (auto at = attributes.lower_bound(begin);
       at != attributes.end() && at->first.starts_with(begin); ++at) {
    const auto& [name, text] = *at;
    if (name == begin + "before") {
      out.stress = matrix_of(probe_numbers(name, text, 9).data());
    } else if (name != begin + "lacking") {
      add_outcome(out, name.substr(begin.size(), 2), name.ends_with("back") ? 1 : 0,
                  outcome_of(probe_numbers(name, text, 21).data()));
    }
  }
}

std::string attributes_of(const std::string& state) { return "probe." + state + "."; }

}  // namespace

const std::vector<std::string>& probed_states() {
  static const std::vector<std::string> states{"prepared", "first"};
  return states;
}

void add_outcome(StateProbes& all, const std::string& direction, int number,
                 const ProbeOutcome& outcome) {
  auto at = std::find_if(all.probes.begin(), all.probes.end(),
                         [&](const Probe& p) { return p.direction == direction; });
  if (at == all.probes.end()) at = all.probes.insert(at, Probe{direction, {}});
  at->outcomes[static_cast<std::size_t>(number % 2)] = outcome;
}

void put_probes(const StateProbes& all, Snapshot& snapshot) {
  const std::string name = "probes_" + all.state;
  if (!all.lacking.empty()) {
    snapshot.tables.erase(name);
    snapshot.attributes[attributes_of(all.state) + "lacking"] = all.lacking;
    return;
  }
  NumberTable table = empty_table();
  for (const Probe& probe : all.probes) {
    for (std::size_t way = 0; way < 2; ++way) {
      const std::vector<double> row = row_of(all, probe, way);
      for (std::size_t k = 0; k < row.size(); ++k) table[k].values.push_back(row[k]);
    }
  }
  snapshot.tables[name] = std::move(table);
}

StateProbes probes_of(const Snapshot& snapshot, const std::string& state) {
  StateProbes out;
  out.state = state;
  const std::string begin = attributes_of(state);
  const auto lacking = snapshot.attributes.find(begin + "lacking");
  if (lacking != snapshot.attributes.end()) {
    out.lacking = lacking->second;
    return out;
  }
  const auto table = snapshot.tables.find("probes_" + state);
  if (table != snapshot.tables.end()) {
    read_table(table->second, table->first, out);
  } else {
    read_attributes(snapshot.attributes, begin, out);
  }
  return out;
}

}  // namespace grainfield::dem
