#include "coupling/case/document.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "coupling/base/read_input.h"
#include "coupling/case/units.h"

namespace grainfield::coupling {
namespace {

// A check answers within ten.
constexpr double kSecondsOfAPipe = 8;

bool read_scalar(const toml::node& node, Scalar& out) {
  if (const auto* b = node.as_boolean())
    out = b->get();
  else if (const auto* i = node.as_integer())
    out = i->get();
  else if (const auto* f = node.as_floating_point())
    out = f->get();
  else if (const auto* s = node.as_string())
    out = s->get();
  else
    return false;
  return true;
}

void read_value(const toml::node& node, Assignment& out) {
  Scalar scalar;
  if (const auto* array = node.as_array()) {
    out.list = true;
    for (const auto& item : *array) {
      if (read_scalar(item, scalar)) {
        out.items.push_back(scalar);
      } else {
        out.other = true;
      }
    }
  } else if (read_scalar(node, scalar)) {
    out.items = {scalar};
  } else {
    out.other = true;
  }
}

void check_texts(const Assignment& a) {
  for (const Scalar& item : a.items) {
    const auto* text = std::get_if<std::string>(&item);
    if (text == nullptr || text->size() <= kMostCharacters) continue;
    throw std::invalid_argument(
        fmt::format("{}: {}: found a text of {} characters, allowed: up to {}", a.origin, a.path,
                    text->size(), kMostCharacters));
  }
}

using Placed = std::pair<unsigned, Assignment>;  // line, assignment

void flatten(const toml::table& table, const std::string& prefix, const std::string& file,
             std::vector<Placed>& out) {
  for (const auto& [name, node] : table) {
    Assignment a;
    a.path = prefix + std::string(name.str());
    // The key's line, not that of a value that may start further down.
    const unsigned line = name.source().begin.line;
    a.origin = fmt::format("{}:{}", file, line);
    if (name.str().find('.') != std::string_view::npos) {
      throw std::invalid_argument(
          fmt::format("{}: \"{}\": a name in quotes cannot hold a dot", a.origin, name.str()));
    }
    if (const auto* inner = node.as_table()) {
      if (!inner->empty()) {
        flatten(*inner, a.path + ".", file, out);
        continue;
      }
      a.table = true;
    } else {
      read_value(node, a);
      check_texts(a);
    }
    out.emplace_back(line, std::move(a));
  }
}

std::string first_line(std::string_view text) {
  return std::string(text.substr(0, text.find('\n')));
}

std::string trimmed(std::string_view s) {
  const auto first = s.find_first_not_of(" \t\r"), last = s.find_last_not_of(" \t\r");
  return first == std::string_view::npos ? "" : std::string(s.substr(first, last - first + 1));
}

// The mistake of "friction = 0,5" in words, for line number `line` from 1; empty for any other
// line.
std::string decimal_comma(std::string_view text, unsigned line) {
  for (; line > 1; --line) text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  text = text.substr(0, text.find('\n'));
  text = text.substr(0, text.find('#'));
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return "";
  const std::string key = trimmed(text.substr(0, equals)), value = trimmed(text.substr(equals + 1));
  const std::string right = with_point(value);
  if (right.empty()) return "";
  return fmt::format("{}: found {}, allowed: a decimal point; write {} = {}", key, value, key,
                     right);
}

// Walks over TOML outside of comments and strings. Keys are told from values only as far as it
// needs: a number has few dots.
class Nesting {
 public:
  explicit Nesting(std::string_view text) : text_(text) {}

  /// What is too much, or "".
  std::string find() {
    for (at_ = 0; at_ < text_.size(); ++at_) {
      const char ch = text_[at_];
      if (ch == '\n') ++line_;
      if (ch == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size()) - 1;
      } else if (ch == '"' || ch == '\'') {
        skip_string(ch);
      } else if (ch == '.') {
        ++parts_;
      } else if (ch == '[' || ch == '{') {
        ++levels_;
        parts_ = 1;
      } else if (ch == ']' || ch == '}') {
        levels_ -= levels_ > 0 ? 1 : 0;
        parts_ = 1;
      } else if (ch == '\n' || ch == '=' || ch == ',') {
        parts_ = 1;
        values_ += ch == '\n' ? 0 : 1;
      }
      if (parts_ > kMostParts) return fmt::format("a key of more than {} parts", kMostParts);
      if (values_ > kMostValues) return fmt::format("more than {} values", kMostValues);
      if (levels_ > kMostLevels) {
        return fmt::format("lists or tables of more than {} levels", kMostLevels);
      }
    }
    return "";
  }
  unsigned line() const { return line_; }

 private:
  // To its last quote, or to the end of the line where it has none.
  void skip_string(char quote) {
    const std::string three(3, quote);
    if (text_.substr(at_, 3) == three) {
      const std::size_t begin = at_ + 3;
      std::size_t end = text_.find(three, begin);
      while (quote == '"' && end != std::string_view::npos && escaped(end, begin)) {
        end = text_.find(three, end + 1);
      }
      end = end == std::string_view::npos ? text_.size() : end + 2;
      line_ += static_cast<unsigned>(std::count(
          text_.begin() + static_cast<std::ptrdiff_t>(at_),
          text_.begin() + static_cast<std::ptrdiff_t>(std::min(end, text_.size())), '\n'));
      at_ = end;
      return;
    }
    for (std::size_t k = at_ + 1; k < text_.size() && text_[k] != '\n'; ++k) {
      at_ = k;
      if (text_[k] == quote) return;
      if (text_[k] == '\\' && quote == '"' && k + 1 < text_.size() && text_[k + 1] != '\n') ++k;
    }
  }
  bool escaped(std::size_t at, std::size_t begin) const {
    std::size_t slashes = 0;
    while (at > begin + slashes && text_[at - slashes - 1] == '\\') ++slashes;
    return slashes % 2 == 1;
  }

  std::string_view text_;
  std::size_t at_ = 0, parts_ = 1, levels_ = 0, values_ = 0;
  unsigned line_ = 1;
};

}  // namespace

void check_nesting(std::string_view text, const std::string& origin, bool lines) {
  Nesting nesting(text);
  const std::string what = nesting.find();
  if (what.empty()) return;
  throw std::invalid_argument(lines ? fmt::format("{}:{}: {}", origin, nesting.line(), what)
                                    : fmt::format("{}: {}", origin, what));
}

std::vector<Assignment> read_document(const std::string& file) {
  const std::string text = read_input(file, "a case file", {kMostBytes, kSecondsOfAPipe});
  if (text.size() > kMostBytes) {
    throw std::invalid_argument(fmt::format("{}: is larger than {} MB, expected a case file", file,
                                            kMostBytes / 1'000'000));
  }
  check_nesting(text, file, true);
  toml::table table;
  try {
    table = toml::parse(text, file);
  } catch (const toml::parse_error& e) {
    const unsigned line = e.source().begin.line;
    const std::string comma = decimal_comma(text, line);
    throw std::invalid_argument(
        fmt::format("{}:{}: {}", file, line,
                    comma.empty() ? "not valid TOML: " + first_line(e.description()) : comma));
  }
  std::vector<Placed> placed;
  flatten(table, "", file, placed);
  std::stable_sort(placed.begin(), placed.end(),
                   [](const Placed& a, const Placed& b) { return a.first < b.first; });
  std::vector<Assignment> out;
  out.reserve(placed.size());
  for (auto& [line, assignment] : placed) out.push_back(std::move(assignment));
  return out;
}

std::vector<Assignment> parse_overrides(const std::vector<std::string>& texts) {
  std::vector<Assignment> out;
  std::map<std::string, std::string> seen;
  for (const std::string& text : texts) {
    out.push_back(parse_override(text));
    const auto [before, first] = seen.emplace(out.back().path, out.back().text);
    if (!first) {
      throw std::invalid_argument(fmt::format("--set: {} is given twice, {} and {}; leave one out",
                                              out.back().path, before->second, out.back().text));
    }
  }
  return out;
}

Assignment parse_override(const std::string& text) {
  const std::size_t at = text.find('=');
  Assignment out;
  out.origin = "--set";
  if (at == std::string::npos) {
    throw std::invalid_argument(fmt::format("--set: found \"{}\", expected key.path=value", text));
  }
  out.path = trimmed(text.substr(0, at));
  out.text = trimmed(text.substr(at + 1));
  check_nesting(text, out.origin, false);
  if (!out.path.empty() && out.text.empty()) {
    throw std::invalid_argument(
        fmt::format("--set: {}: found no value, expected {}=VALUE (a text may be empty: {}='\"\"')",
                    out.path, out.path, out.path));
  }
  if (out.path.empty()) {
    throw std::invalid_argument(fmt::format("--set: found \"{}\", expected key.path=value", text));
  }
  try {
    const toml::table table = toml::parse("value = " + out.text);
    if (table.size() != 1) {
      throw std::invalid_argument(fmt::format(
          "--set: {}: found another line behind its value, expected one key for each --set",
          out.path));
    }
    read_value(*table.get("value"), out);
  } catch (const toml::parse_error&) {
    out.items = {out.text};
  }
  check_texts(out);
  return out;
}

std::string scalar_text(const Scalar& scalar) {
  if (const auto* b = std::get_if<bool>(&scalar)) return *b ? "true" : "false";
  if (const auto* i = std::get_if<std::int64_t>(&scalar)) return std::to_string(*i);
  if (const auto* d = std::get_if<double>(&scalar)) return fmt::format("{}", *d);
  return std::get<std::string>(scalar);
}

std::string describe(const Assignment& a) {
  if (a.table) return "an empty table";
  if (a.other) return a.list ? "a list of lists or tables" : "a date or time";
  if (a.list) {
    std::string out = "a list [";
    for (std::size_t i = 0; i < a.items.size() && i < 4; ++i) {
      out += (i > 0 ? ", " : "") + scalar_text(a.items[i]);
    }
    return out + (a.items.size() > 4 ? ", ...]" : "]");
  }
  const Scalar& s = a.items.front();
  if (std::holds_alternative<std::string>(s)) {
    return fmt::format("\"{}\" (text)", std::get<std::string>(s));
  }
  const char* kind = std::holds_alternative<bool>(s)     ? "boolean"
                     : std::holds_alternative<double>(s) ? "number"
                                                         : "integer";
  return fmt::format("{} ({})", scalar_text(s), kind);
}

}  // namespace grainfield::coupling
