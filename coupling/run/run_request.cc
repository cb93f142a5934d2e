#include "coupling/run/run_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <thread>
#include <variant>

#include "coupling/case/keys.h"
#include "coupling/case/shipped_cases.h"

namespace grainfield::coupling {
namespace {

// Share of the smaller radius; Roul's piles reach 0.04.
constexpr double kDeepOverlap = 0.1;
constexpr double kMostBetweenCheckpoints = 1e6;  // s; eleven days

// As a shell takes it: in single quotes where it holds more than plain characters.
std::string shell_word(const std::string& text) {
  const std::string plain = "_-+.,:=/@%";
  const bool quote = !std::all_of(text.begin(), text.end(), [&](unsigned char ch) {
    return std::isalnum(ch) != 0 || plain.find(static_cast<char>(ch)) != std::string::npos;
  });
  if (!quote && !text.empty()) return text;
  std::string out = "'";
  for (const char ch : text) out += ch == '\'' ? std::string("'\\''") : std::string(1, ch);
  return out + "'";
}

/// What decides the numbers, as it was typed: neither folder nor threads.
std::string command_of(const RunRequest& given) {
  std::string out = "grainfield run " + shell_word(given.file);
  if (given.quick) out += " --quick";
  for (const std::string& text : given.sets) out += " --set " + shell_word(text);
  return out;
}

}  // namespace

RunPlan plan_run(const RunRequest& given) {
  if (!(given.checkpoint_seconds >= 0 && given.checkpoint_seconds <= kMostBetweenCheckpoints)) {
    throw std::invalid_argument(fmt::format("--checkpoint-seconds: found {:g}, allowed: 0 to {:g}",
                                            given.checkpoint_seconds, kMostBetweenCheckpoints));
  }
  RunPlan plan;
  RunOptions& options = plan.options;
  options.case_file = find_case(given.file);
  plan.value = read_case(options.case_file, given.quick, given.sets);
  plan.value.command = command_of(given);
  options.folder = !given.folder.empty()
                       ? given.folder
                       : "results/" + plan.value.name + (given.quick ? "-quick" : "");
  while (options.folder.size() > 1 && options.folder.back() == '/') options.folder.pop_back();
  options.threads = given.threads;
  options.resume = given.resume;
  options.checkpoint_seconds = given.checkpoint_seconds;
  options.stop_after_steps = given.stop_after_steps;
  return plan;
}

int threads_for(int wanted, const Ranks& ranks) {
  // Ranks share a machine: without a wish each takes one thread.
  const int cores = ranks.size() > 1 ? 1 : static_cast<int>(std::thread::hardware_concurrency());
  return wanted > 0 ? wanted : std::max(1, cores);
}

std::string deep_overlap(const Case& value, const Summary& summary) {
  const auto at = summary.find("dem.max_overlap_ratio");
  const double* overlap = at == summary.end() ? nullptr : std::get_if<double>(&at->second);
  if (overlap == nullptr || *overlap <= kDeepOverlap) return "";
  const bool linear = value_text(*find_key("material.law"), value) == "\"linear\"";
  return fmt::format(
      "grains overlap by up to {:.0f} % of a radius, too soft for a contact law of small overlaps; "
      "raise material.{}",
      100 * *overlap, linear ? "normal_stiffness" : "young");
}

}  // namespace grainfield::coupling
