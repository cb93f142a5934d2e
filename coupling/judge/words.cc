#include "coupling/judge/words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>

namespace grainfield::coupling {
namespace {

// A model that misses by more than half of the signal describes nothing, even when others do worse.
constexpr double kMostMiss = 0.5;
// A position so far outside of [0, 1] is no share of a way: the data's part along the line that
// neither model has is as large as half the distance of the two.
constexpr double kMostBeyond = 0.5;
constexpr std::size_t kNamed = 3;  // models in a headline

// A family's name with a capital; names of models keep their letters.
std::string capital(std::string text) {
  if (text.starts_with("the ")) {
    text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  }
  return text;
}

std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (k > 0) out += k + 1 == names.size() ? " and " : ", ";
    out += names[k];
  }
  return out;
}

std::string percent(double share) { return fmt::format("{:.1f} %", 100 * share); }
std::string digits(double v) { return std::isfinite(v) ? fmt::format("{:.3g}", v) : "-"; }

const char* subject(const Judgement& j) { return j.measured ? "measurement" : "grains"; }
const char* verb(const Judgement& j, const char* one, const char* many) {
  return j.measured ? one : many;
}

std::string counted(int n, const std::string& noun) {
  return fmt::format("{} {}{}", n, noun, n == 1 ? "" : "s");
}

// "16 layers", "the errors of one field".
std::string basis(const Judgement& j) {
  if (j.errors_from == ErrorsFrom::data && j.realizations < 2) return "one field with errors";
  return counted(j.realizations, j.noun);
}

// The families that are judged, each by its nearest model; names of models where all are of one.
struct Group {
  std::string name;  // "the finite layer", "osl"
  const JudgedModel* nearest = nullptr;
  bool kept = false;       // one of it cannot be distinguished from the nearest
  bool richer = false;     // only models that contain the best are kept
  bool supported = false;  // one of it is
};

std::vector<Group> groups_of(const Judgement& j) {
  const auto family = [](const JudgedModel& m) { return m.family.empty() ? m.name : m.family; };
  const auto has_values = [](const JudgedModel& m) {
    return !std::isnan(m.score) || !std::isnan(m.rel_l2);
  };
  const bool any_values = std::any_of(j.models.begin(), j.models.end(), has_values);
  const auto competes = [&](const JudgedModel& m) {
    return !m.description && (has_values(m) || !any_values);
  };
  const bool any = std::any_of(j.models.begin(), j.models.end(), competes);
  bool several = false;
  for (const JudgedModel& m : j.models) several |= family(m) != family(j.models.front());
  std::vector<Group> out;
  for (const JudgedModel& m : j.models) {
    if (any && !competes(m)) continue;
    const std::string name = !several                                   ? m.label
                             : family(m).find(' ') == std::string::npos ? family(m)
                                                                        : "the " + family(m);
    auto at = std::find_if(out.begin(), out.end(), [&](const Group& g) { return g.name == name; });
    if (at == out.end()) at = out.insert(out.end(), Group{name, &m, false, true});
    if (m.distinguishable == Answer::yes) continue;
    at->kept = true;
    at->supported = at->supported || m.supported() == Answer::yes;
    const auto& special = m.special_cases;
    at->richer = at->richer && std::find(special.begin(), special.end(), j.best) != special.end();
  }
  return out;
}

std::string without_errors(const Judgement& j, const std::vector<Group>& groups) {
  const std::string why =
      j.equal               ? fmt::format("All {} are equal", counted(j.realizations, j.noun))
      : j.realizations == 1 ? fmt::format("One {}", j.measured ? "field without errors" : j.noun)
      : j.realizations == 2
          ? counted(2, j.noun)
          : fmt::format("A mean of {} without their values", counted(j.realizations, j.noun));
  const Group& first = groups.front();
  if (groups.size() == 1) {
    return fmt::format("{} cannot test a model: {} misses by {}.", why, first.name,
                       percent(first.nearest->rel_l2));
  }
  return fmt::format("{} cannot distinguish models: {} is nearest ({}), then {} ({}).", why,
                     first.name, percent(first.nearest->rel_l2), groups[1].name,
                     percent(groups[1].nearest->rel_l2));
}

// What cannot be distinguished from the nearest model, without models that contain the best one.
bool stands(const Group& g) { return g.kept && !g.richer; }

std::vector<std::string> names_where(const std::vector<Group>& groups,
                                     const std::function<bool(const Group&)>& chosen) {
  std::vector<std::string> out;
  for (const Group& g : groups) {
    if (chosen(g)) out.push_back(g.name);
  }
  return out;
}

// "osl, bcc and fpa"; of many the first and how many more.
std::string listed(std::vector<std::string> names) {
  const std::size_t all = names.size();
  if (all > kNamed + 1) {
    names.resize(kNamed);
    names.push_back(fmt::format("{} more", all - kNamed));
  }
  return joined(names);
}

// The supported models and no other set of several; one that contains another supported one is left
// to the table.
std::string supported_headline(const Judgement& j, const std::vector<Group>& groups,
                               const std::string& tail) {
  auto supported = names_where(groups, [](const Group& g) { return stands(g) && g.supported; });
  if (supported.empty()) {
    supported = names_where(groups, [](const Group& g) { return g.supported; });
  }
  const auto rest = names_where(groups, [](const Group& g) { return !g.supported; });
  const auto worse = names_where(groups, [](const Group& g) { return !g.kept; });
  const std::string out =
      fmt::format("The {} {} {}", subject(j), verb(j, "supports", "support"), listed(supported));
  if (supported.size() > 1) {
    return fmt::format("{}, which cannot be distinguished {}{}.", out, tail,
                       rest.size() == 1 && worse == rest ? "; " + rest[0] + " is worse" : "");
  }
  if (worse.size() < rest.size()) {
    const std::size_t more = rest.size() - worse.size();
    return fmt::format("{} {}; {} more cannot be distinguished, but {} not agree.", out, tail, more,
                       more == 1 ? "does" : "do");
  }
  if (rest.empty()) return fmt::format("{} {}.", out, tail);
  return rest.size() == 1
             ? fmt::format("{}, not {} {}.", out, rest[0], tail)
             : fmt::format("{}, none of the other {} models {}.", out, rest.size(), tail);
}

std::string unsupported_headline(const Judgement& j, const std::vector<Group>& groups,
                                 const std::string& tail) {
  const auto kept = names_where(groups, stands);
  const auto worse = names_where(groups, [](const Group& g) { return !g.kept; });
  const bool all = kept.size() + worse.size() == groups.size();
  const std::string others = worse.size() == 1 ? worse[0]
                             : all             ? fmt::format("the other {} models", worse.size())
                                               : fmt::format("{} other models", worse.size());
  if (kept.size() == 1 && worse.empty()) {
    return fmt::format("{} does not agree with the {} {}.", capital(kept[0]), subject(j), tail);
  }
  if (kept.size() == 1) {
    return fmt::format("{} is nearer to the {} than {} {}.", capital(kept[0]), subject(j), others,
                       tail);
  }
  return fmt::format(
      "{} cannot be distinguished {}{}.", capital(listed(kept)), tail,
      worse.empty() ? "" : fmt::format("; {} {} worse", others, worse.size() == 1 ? "is" : "are"));
}

std::string models_headline(const Judgement& j) {
  const std::vector<Group> groups = groups_of(j);
  const JudgedModel& best = j.best_model();
  const JudgedModel& nearest = j.models.front();
  if (std::min(nearest.rel_l2, best.rel_l2) > kMostMiss && best.agrees() != Answer::yes) {
    return fmt::format("No model describes the {}: the nearest, {}, misses by {:.0f} % ({}).",
                       subject(j), nearest.label, 100 * nearest.rel_l2, basis(j));
  }
  if (nearest.distinguishable == Answer::unknown) return without_errors(j, groups);
  const std::string tail = fmt::format("({}, 95 %)", basis(j));
  if (groups.size() == 1) {
    return fmt::format("{} {} with the {} {}.", capital(groups.front().name),
                       best.agrees() == Answer::yes ? "agrees" : "does not agree", subject(j),
                       tail);
  }
  const bool supported =
      std::any_of(groups.begin(), groups.end(), [](const Group& g) { return g.supported; });
  return supported ? supported_headline(j, groups, tail) : unsupported_headline(j, groups, tail);
}

std::string position_line(const Judgement& j) {
  const Position& p = j.position;
  if (std::isnan(p.value)) return "";
  std::string out = fmt::format(
      "On the line from {} (0) to {} (1) the {} {} at {}.", p.from, p.to, subject(j),
      verb(j, "is", "are"),
      std::isfinite(p.error) ? with_error(p.value, p.error) : fmt::format("{:.2f}", p.value));
  if (p.value < -kMostBeyond || p.value > 1 + kMostBeyond) {
    out += fmt::format(
        " They differ less from each other than the {} from either: the number only gives the side "
        "(beyond both).",
        subject(j));
  }
  return out;
}

// "realizations", "layers"; of a single field others like it.
std::string many(const Judgement& j) {
  return j.errors_from == ErrorsFrom::data && j.realizations < 2 ? "fields like this one"
                                                                 : j.noun + "s";
}

std::string range_of(const Power& p) {
  if (std::isinf(p.most)) return fmt::format("{:.0f} or more", std::ceil(p.least));
  return fmt::format("{:.0f} to {:.0f}", std::ceil(p.least), std::ceil(p.most));
}

std::string difference_of(const Power& p) { return with_error(1e3 * p.difference, 1e3 * p.error); }

// Why no number is the largest.
std::string no_limit(const Judgement& j, const JudgedModel& rival) {
  Power p = rival.power;
  const bool ahead = p.difference < 0;
  p.difference = std::fabs(p.difference);
  return fmt::format("There is no upper limit, because {} is behind {} by {}, which may be 0.",
                     ahead ? j.best : rival.name, ahead ? rival.name : j.best, difference_of(p));
}

std::string power_line(const Judgement& j) {
  const JudgedModel* rival = j.find(j.rival);
  if (rival == nullptr || std::isnan(rival->power.realizations)) return "";
  const Power& p = rival->power;
  if (p.same) {
    return fmt::format(
        "No number of {} would distinguish {} and {}: they are the same stress here.", many(j),
        j.best, j.rival);
  }
  if (rival->distinguishable == Answer::yes) return "";
  const std::string what =
      fmt::format("To distinguish {} and {} at 95 % with a power of 80 % takes", j.best, j.rival);
  if (std::isinf(p.least)) {
    return fmt::format("{} and {} are equally far from the {}: no number of {} is foreseen.",
                       j.best, j.rival, subject(j), many(j));
  }
  if (std::isinf(p.realizations)) {
    return fmt::format("{} {} {}. {}", what, range_of(p), many(j), no_limit(j, *rival));
  }
  return fmt::format("{} about {:.0f} {} ({} in {:.0f} of 100 ensembles).{}{}", what,
                     std::ceil(p.realizations), many(j), range_of(p), 100 * kForesight,
                     std::isinf(p.most) ? " " : "", std::isinf(p.most) ? no_limit(j, *rival) : "");
}

// What the judgement says at other kernel widths: a line for each kind of answer.
std::vector<std::string> width_lines(const Judgement& j) {
  std::vector<std::string> same, none, out;
  for (const AtWidth& at : j.widths) {
    const std::string width = fmt::format("{:g}", at.diameters);
    if (!at.why.empty()) {
      none.push_back(width);
    } else if (at.best == j.best && at.distinguishable == j.distinguishable &&
               at.agrees == j.best_model().agrees()) {
      same.push_back(width);
    } else {
      out.push_back(
          fmt::format("At a kernel width of {} diameters the best model is {}, distinguishable: "
                      "{}, agrees: {}.",
                      width, at.best, text_of(at.distinguishable), text_of(at.agrees)));
    }
  }
  if (!none.empty()) {
    out.push_back(fmt::format("Kernel widths of {} diameters leave too few values.", joined(none)));
  }
  if (!same.empty()) {
    out.push_back(
        fmt::format("The verdict is the same at kernel widths of {} diameters.", joined(same)));
  }
  return out;
}

// "the description cantelaube", "2 descriptions".
std::string described(const std::vector<std::string>& names) {
  return names.size() == 1 ? "the description " + names.front()
                           : fmt::format("{} descriptions", names.size());
}

std::string equations_line(const Judgement& j) {
  if (j.equations.empty()) return "";
  if (j.equations == "not distinguishable") {
    return "Elliptic and hyperbolic equations cannot be distinguished.";
  }
  return fmt::format("The response is {}.", j.equations);
}

}  // namespace

std::string as_sentence(std::string text) {
  const std::string first = text.substr(0, text.find(' '));
  if (first.find_first_of("./_") == std::string::npos) {
    text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  }
  return text + (text.back() == '?' ? "" : ".");
}

std::vector<std::string> headlines(const Judgement& j) {
  std::vector<std::string> out = j.findings;
  if (!j.models.empty()) out.push_back(models_headline(j));
  return out;
}

std::string agreement_line(const Judgement& j) {
  if (j.models.empty()) return "";
  // Where the best model does not agree, another one may be supported.
  const JudgedModel* reference = &j.best_model();
  for (const JudgedModel& m : j.models) {
    if (reference->agrees() == Answer::no && m.supported() == Answer::yes) reference = &m;
  }
  const JudgedModel& best = *reference;
  if (best.agrees() == Answer::unknown) {
    return j.errors_from == ErrorsFrom::realizations
               ? fmt::format("{} do not show whether a model agrees.",
                             capital(counted(j.realizations, j.noun)))
               : std::string("Without errors it is unknown whether a model agrees.");
  }
  // A description does not compete, and is counted apart.
  std::vector<std::string> descriptions;
  long agreeing = 0;
  for (const JudgedModel& m : j.models) {
    if (m.agrees() != Answer::yes) continue;
    if (m.description) {
      descriptions.push_back(m.label);
    } else {
      ++agreeing;
    }
  }
  const std::string level =
      fmt::format("a true model exceeds {} in 1 of 100 ensembles", digits(best.chance));
  if (best.agrees() == Answer::yes) {
    const auto supported = std::count_if(j.models.begin(), j.models.end(), [](const auto& m) {
      return m.supported() == Answer::yes;
    });
    const std::string own = fmt::format("misfit {}, and {}", digits(best.misfit), level);
    if (agreeing + static_cast<long>(descriptions.size()) == 1) {
      return fmt::format("{}{} agrees within the errors: {}.",
                         best.description ? "The description " : "", best.label, own);
    }
    std::vector<std::string> who;
    if (agreeing > 0) {
      who.push_back(agreeing == 1 ? best.label : fmt::format("{} of the models", agreeing));
    }
    if (!descriptions.empty()) who.push_back(described(descriptions));
    return fmt::format("{} agree within the errors{}: {} has {}.", joined(who),
                       agreeing == supported ? "" : fmt::format(", {} supported", supported),
                       best.label, own);
  }
  if (agreeing == 0) {
    return fmt::format("No model agrees within the errors{}: the misfit of {} is {}, and {}.",
                       descriptions.empty() ? "" : ", only " + described(descriptions), best.label,
                       digits(best.misfit), level);
  }
  return fmt::format("{} does not agree within the errors: its misfit is {}, and {}.", best.label,
                     digits(best.misfit), level);
}

std::string sentence(const Judgement& j) {
  std::vector<std::string> lines = headlines(j);
  if (std::string line = agreement_line(j); !line.empty()) lines.push_back(std::move(line));
  return fmt::format("{}", fmt::join(lines, " "));
}

std::vector<std::string> note_lines(const Judgement& j) {
  std::vector<std::string> out;
  for (std::string line : {equations_line(j), position_line(j), power_line(j)}) {
    if (!line.empty()) out.push_back(std::move(line));
  }
  for (std::string& line : width_lines(j)) out.push_back(std::move(line));
  out.insert(out.end(), j.notes.begin(), j.notes.end());
  return out;
}

JudgementTable power_table(const Judgement& j) {
  JudgementTable out;
  out.header = {"model", "difference", many(j) + " needed",
                fmt::format("in {:.0f} of 100 ensembles", 100 * kForesight), "distinguishable now"};
  out.note = fmt::format(
      "Difference: how much worse than {} the model predicts unseen realizations, in thousandths "
      "of the squared signal. If it may be 0 within its error, there is no upper limit.",
      j.best_model().label);
  for (const JudgedModel& m : j.models) {
    if (m.name == j.best) continue;
    const Power& p = m.power;
    const std::string number = p.same                       ? "none: the same stress here"
                               : std::isnan(p.realizations) ? "unknown"
                               : std::isinf(p.least)        ? "none is foreseen"
                               : std::isinf(p.realizations)
                                   ? "no upper limit"
                                   : fmt::format("{:.0f}", std::ceil(p.realizations));
    const bool shown = !p.same && std::isfinite(p.least);
    out.rows.push_back(
        {m.label, difference_of(p), number, shown ? range_of(p) : "-", text_of(m.distinguishable)});
  }
  return out;
}

JudgementTable table_of(const Judgement& j) {
  JudgementTable out;
  if (j.models.empty()) return out;
  const auto any = [&](auto&& has) { return std::any_of(j.models.begin(), j.models.end(), has); };
  struct Column {
    std::string head, meaning;
    bool shown;
    std::function<std::string(const JudgedModel&)> cell;
  };
  // The meanings are those of docs/glossary.md, word by word.
  const std::vector<Column> columns{
      {"model", "", true, [](const auto& m) { return m.label; }},
      {"equations", "", any([](const auto& m) { return !m.equations.empty(); }),
       [](const auto& m) { return m.equations; }},
      {"free", "number of fitted constants", any([](const auto& m) { return m.free > 0; }),
       [](const auto& m) { return fmt::format("{}", m.free); }},
      {"misfit",
       "squared difference from the model, divided by the value expected for a true model",
       any([](const auto& m) { return std::isfinite(m.misfit); }),
       [](const auto& m) { return digits(m.misfit); }},
      {"chance", "threshold that a true model's misfit exceeds in 1 of 100 ensembles",
       any([](const auto& m) { return std::isfinite(m.chance); }),
       [](const auto& m) { return digits(m.chance); }},
      {"relative L2", "root of the squared difference, divided by the root of the squared signal",
       true, [](const auto& m) { return std::isfinite(m.rel_l2) ? percent(m.rel_l2) : "-"; }},
      {"behind",
       "how much worse than the nearest the model predicts unseen realizations, in thousandths of "
       "the squared signal",
       any([](const auto& m) { return std::isfinite(m.behind_error); }),
       [](const auto& m) {
         return m.nearest ? std::string("nearest")
                          : with_error(1e3 * m.behind, 1e3 * m.behind_error);
       }},
      {"behind, heights", "the same for unseen heights",
       any([](const auto& m) { return std::isfinite(m.heights_behind); }),
       [](const auto& m) {
         return m.nearest ? std::string("nearest")
                          : with_error(1e3 * m.heights_behind, 1e3 * m.heights_error);
       }},
      {"distinguishable",
       "the model predicts worse than the nearest, by more than the errors explain (95 %)",
       any([](const auto& m) { return m.distinguishable != Answer::unknown; }),
       [](const auto& m) { return m.nearest ? "-" : text_of(m.distinguishable); }},
      {"behind, Akaike",
       "chi2 plus twice the number of fitted constants, less that of the nearest; above 10 the "
       "model is behind",
       any([](const auto& m) { return std::isfinite(m.aic_behind); }),
       [](const auto& m) {
         return std::isfinite(m.aic_behind) ? fmt::format("{:.1f}", m.aic_behind) : "-";
       }},
      {"agrees", "the misfit is below chance",
       any([](const auto& m) { return m.agrees() != Answer::unknown; }),
       [](const auto& m) { return text_of(m.agrees()); }},
      {"supported", "the model agrees, and cannot be distinguished from the nearest", true,
       [](const auto& m) {
         return m.description ? "no: a description" : std::string(text_of(m.supported()));
       }}};
  for (const Column& c : columns) {
    if (!c.shown) continue;
    out.header.push_back(c.head);
    std::string& meaning = out.meanings.emplace_back(c.meaning);
    if (meaning.empty()) continue;
    meaning = fmt::format("{}: {}.", c.head, c.meaning);
    meaning[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(meaning[0])));
    out.note += (out.note.empty() ? "" : " ") + meaning;
  }
  if (any([](const auto& m) { return m.description; })) {
    out.note += " Description: the model need not be in equilibrium, and is never supported.";
  }
  for (const JudgedModel& m : j.models) {
    auto& row = out.rows.emplace_back();
    for (const Column& c : columns) {
      if (c.shown) row.push_back(c.cell(m));
    }
  }
  return out;
}

}  // namespace grainfield::coupling
