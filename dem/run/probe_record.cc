#include "dem/run/probe_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "dem/shared/number.h"

namespace grainfield::dem {
namespace {

constexpr std::array kProbeWays{"forth", "back"};

std::string text_of_matrix(const Eigen::Matrix3d& m) {
  std::string out;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) out += fmt::format("{:.17g} ", m(a, b));
  }
  return out;
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

Eigen::Matrix3d matrix_of(const double* numbers) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(numbers);
}

}  // namespace

const std::vector<std::string>& probed_states() {
  static const std::vector<std::string> states{"prepared", "first"};
  return states;
}

void put_probes(const StateProbes& all, Attributes& attributes) {
  const std::string begin = "probe." + all.state + ".";
  if (!all.lacking.empty()) {
    std::erase_if(attributes, [&](const auto& entry) { return entry.first.starts_with(begin); });
    attributes[begin + "lacking"] = all.lacking;
    return;
  }
  attributes[begin + "before"] = text_of_matrix(all.stress);
  for (const Probe& probe : all.probes) {
    for (std::size_t way = 0; way < 2; ++way) {
      const ProbeOutcome& o = probe.outcomes[way];
      attributes[begin + probe.direction + "." + kProbeWays[way]] =
          text_of_matrix(o.gradient) + text_of_matrix(o.stress) +
          fmt::format("{:.17g} {:.17g} {:.17g}", o.gained, o.lost, o.sliding);
    }
  }
}

StateProbes probes_of(const Attributes& attributes, const std::string& state) {
  StateProbes out;
  out.state = state;
  const std::string begin = "probe." + state + ".";
  for (auto at = attributes.lower_bound(begin);
       at != attributes.end() && at->first.starts_with(begin); ++at) {
    const auto& [name, text] = *at;
    if (name == begin + "before") {
      out.stress = matrix_of(probe_numbers(name, text, 9).data());
      continue;
    }
    if (name == begin + "lacking") {
      out.lacking = text;
      continue;
    }
    const std::string direction = name.substr(begin.size(), 2);
    const bool back = name.ends_with(kProbeWays[1]);
    const auto numbers = probe_numbers(name, text, 21);
    if (out.probes.empty() || out.probes.back().direction != direction) {
      out.probes.push_back({direction, {}});
    }
    out.probes.back().outcomes[back ? 1 : 0] = {matrix_of(numbers.data()),
                                                matrix_of(numbers.data() + 9), numbers[18],
                                                numbers[19], numbers[20]};
  }
  return out;
}

}  // namespace grainfield::dem
