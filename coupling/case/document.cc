#include "coupling/case/document.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace grainfield::coupling {
namespace {

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
    }
    out.emplace_back(line, std::move(a));
  }
}

std::string first_line(std::string_view text) {
  return std::string(text.substr(0, text.find('\n')));
}

}  // namespace

std::vector<Assignment> read_document(const std::string& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    throw std::invalid_argument(file + ": no such file");
  }
  if (std::filesystem::is_directory(status)) {
    throw std::invalid_argument(file + ": is a folder, expected a case file");
  }
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) {
    if (!in || in.bad() || std::filesystem::file_size(file, error) > 0) {
      throw std::invalid_argument(
          fmt::format("{}: cannot be read: {}", file, std::strerror(errno)));
    }
  }
  toml::table table;
  try {
    table = toml::parse(text.str(), file);
  } catch (const toml::parse_error& e) {
    throw std::invalid_argument(fmt::format("{}:{}: not valid TOML: {}", file,
                                            e.source().begin.line, first_line(e.description())));
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

Assignment parse_override(const std::string& text) {
  const std::size_t at = text.find('=');
  const auto trimmed = [](std::string s) {
    const auto first = s.find_first_not_of(" \t"), last = s.find_last_not_of(" \t");
    return first == std::string::npos ? std::string() : s.substr(first, last - first + 1);
  };
  Assignment out;
  out.origin = "--set";
  if (at == std::string::npos) {
    throw std::invalid_argument(fmt::format("--set: found \"{}\", expected key.path=value", text));
  }
  out.path = trimmed(text.substr(0, at));
  out.text = trimmed(text.substr(at + 1));
  if (out.path.empty() || out.text.empty()) {
    throw std::invalid_argument(fmt::format("--set: found \"{}\", expected key.path=value", text));
  }
  try {
    const toml::table table = toml::parse("value = " + out.text);
    read_value(*table.get("value"), out);
  } catch (const toml::parse_error&) {
    out.items = {out.text};
  }
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
