#include "coupling/output/tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "coupling/output/atomic_file.h"
#include "coupling/output/profile_columns.h"
#include "coupling/output/text_table.h"
#include "dem/snapshot/number.h"

namespace grainfield::coupling {
namespace {

double error_at(const Profile& p, Eigen::Index k) {
  return p.error.size() ? p.error[k] : std::nan("");
}

// Indices of at most `rows` evenly chosen points, from the first to the last that has a value.
std::vector<Eigen::Index> chosen(const Eigen::VectorXd& values, int rows) {
  Eigen::Index first = 0, end = values.size();
  while (first < end && std::isnan(values[first])) ++first;
  while (end > first && std::isnan(values[end - 1])) --end;
  std::vector<Eigen::Index> all;
  const Eigen::Index n = std::min<Eigen::Index>(end - first, std::max(rows, 2));
  for (Eigen::Index k = 0; k < n; ++k) {
    all.push_back(first + (n == 1 ? 0 : k * (end - first - 1) / (n - 1)));
  }
  return all;
}

// Of a CSV; a nan has no sign.
std::string number(double value) {
  return std::isnan(value) ? "nan" : fmt::format("{:.9g}", value);
}

std::string cell(double value) { return std::isfinite(value) ? fmt::format("{:.4f}", value) : "-"; }

constexpr std::size_t kModelsAcross = 2;      // side by side in a table of LaTeX
constexpr const char* kModelWidth = "3.6cm";  // of a model's three columns

// The models that tables for reading show, and the labels of those that they leave out.
struct Shown {
  std::vector<std::size_t> models;  // indices
  std::string note;                 // empty: none is left out
};

Shown shown_models(const Comparison& c) {
  const std::vector<std::size_t> order = ranked(c);
  Shown out;
  std::vector<std::string> aside;
  for (std::size_t m = 0; m < order.size(); ++m) {
    if (m < kModelsShown)
      out.models.push_back(order[m]);
    else
      aside.push_back(c.models[order[m]].label);
  }
  if (!aside.empty())
    out.note = fmt::format("Of {} models the {} that rank first; in profiles.csv also: {}.",
                           order.size(), kModelsShown, fmt::join(aside, "; "));
  return out;
}

struct Style {
  std::string begin, separator, end;  // of a row
};

// Header and rows of one profile with the models `shown`, normalised by its scale.
std::vector<std::vector<std::string>> normalised(
    const Comparison& c, const std::vector<std::size_t>& shown, std::size_t k, int rows,
    const std::function<std::string(std::string)>& math) {
  const Profile& p = c.profiles[k];
  const double unit = c.unit();
  std::vector<std::vector<std::string>> table(1);
  table[0] = {math(fmt::format("x/{}", c.scale.length)), c.column(), "standard error"};
  for (std::size_t m : shown) {
    table[0].push_back(c.models[m].label);
    table[0].push_back("difference");
    table[0].push_back("difference/error");
  }
  for (Eigen::Index i : chosen(p.mean, rows)) {
    std::vector<std::string> row{cell(p.x[i] / c.depth), cell(p.mean[i] / unit),
                                 cell(error_at(p, i) / unit)};
    for (std::size_t m : shown) {
      const double value = c.models[m].values[k][i], difference = p.mean[i] - value;
      row.push_back(cell(value / unit));
      row.push_back(cell(difference / unit));
      row.push_back(cell(difference / error_at(p, i)));
    }
    table.push_back(std::move(row));
  }
  return table;
}

std::string join(const std::vector<std::string>& cells, const Style& style) {
  std::string line = style.begin;
  for (std::size_t k = 0; k < cells.size(); ++k) line += (k ? style.separator : "") + cells[k];
  return line + style.end + "\n";
}

// The name of a unit inside $...$.
std::string math_latex(const std::string& text) {
  const std::size_t at = text.find("rho");
  if (at == std::string::npos) return text;
  return fmt::format("{}\\{}", text.substr(0, at), text.substr(at));
}

std::string quote_csv(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

std::string profiles_csv(const Comparison& c) {
  const ProfileColumns table = profile_columns(c);
  std::string text;
  for (const std::string& note : table.notes) text += "# " + note + "\n";
  text += "profile";
  for (const ProfileColumn& column : table.columns) {
    text += "," + quote_csv(column.unit == "1" ? column.name : column.name + "_" + column.unit);
  }
  text += "\n";
  for (std::size_t k = 0; k < table.profile.size(); ++k) {
    text += quote_csv(table.profile[k]);
    for (const ProfileColumn& column : table.columns) text += "," + number(column.values[k]);
    text += "\n";
  }
  return text;
}

std::string profiles_markdown(const Comparison& c, int rows) {
  const Shown shown = shown_models(c);
  std::string text = "# Profiles\n\n" + scale_note(c) + "\n";
  if (!shown.note.empty()) text += "\n" + shown.note + "\n";
  for (std::size_t k = 0; k < c.profiles.size(); ++k) {
    text += fmt::format("\n## {}\n\n{} in units of {}\n\n", c.profiles[k].name,
                        c.profiles[k].quantity, c.scale.stress);
    const auto table = normalised(c, shown.models, k, rows, [](std::string s) { return s; });
    const Style style{"| ", " | ", " |"};
    text += join(table[0], style);
    text += join(std::vector<std::string>(table[0].size(), "---:"), style);
    for (std::size_t r = 1; r < table.size(); ++r) text += join(table[r], style);
  }
  return text;
}

std::string profiles_latex(const Comparison& c, int rows) {
  const Shown shown = shown_models(c);
  std::string text = "% " + scale_note(c) + "\n";
  if (!shown.note.empty()) text += "% " + shown.note + "\n";
  const Style style{"  ", " & ", " \\\\"};
  for (std::size_t k = 0; k < c.profiles.size(); ++k) {
    const auto table =
        normalised(c, shown.models, k, rows, [](std::string s) { return "$" + s + "$"; });
    // A few models per table: more are wider than a page.
    for (std::size_t from = 0; from == 0 || from < shown.models.size(); from += kModelsAcross) {
      const std::size_t to = std::min(from + kModelsAcross, shown.models.size());
      std::vector<std::string> models{"", "", ""};
      std::vector<std::string> heads{table[0][0], c.column(), "error"};
      for (std::size_t m = from; m < to; ++m) {
        models.push_back(fmt::format("\\multicolumn{{3}}{{p{{{}}}}}{{\\centering {}}}", kModelWidth,
                                     escape_latex(c.models[shown.models[m]].label)));
        heads.insert(heads.end(), {"model", "diff.", "diff./error"});
      }
      text += fmt::format(
          "\\begin{{table}}\n\\footnotesize\\setlength{{\\tabcolsep}}{{4pt}}\n\\caption{{{}: {} in "
          "units "
          "of ${}${}}}\n\\begin{{tabular}}{{{}}}\n\\hline\n",
          escape_latex(c.profiles[k].name), escape_latex(c.profiles[k].quantity),
          math_latex(c.scale.stress), from > 0 ? ", continued" : "",
          std::string(3 + 3 * (to - from), 'r'));
      if (to > from) text += join(models, style);
      text += join(heads, style) + "\\hline\n";
      for (std::size_t r = 1; r < table.size(); ++r) {
        std::vector<std::string> row(table[r].begin(), table[r].begin() + 3);
        const auto first = table[r].begin() + 3;
        row.insert(row.end(), first + static_cast<std::ptrdiff_t>(3 * from),
                   first + static_cast<std::ptrdiff_t>(3 * to));
        text += join(row, style);
      }
      text += "\\hline\n\\end{tabular}\n\\end{table}\n";
    }
  }
  return text;
}

void write_profiles(const std::string& folder, const Comparison& c) {
  const std::filesystem::path at(folder);
  write_text_file((at / "profiles.csv").string(), profiles_csv(c));
  write_text_file((at / "profiles.md").string(), profiles_markdown(c));
  write_text_file((at / "profiles.tex").string(), profiles_latex(c));
}

void write_summary(const std::string& file, const Summary& summary) {
  nlohmann::json json = nlohmann::json::object();
  for (const auto& [key, value] : summary) {
    if (const auto* number = std::get_if<double>(&value)) {
      if (std::isnan(*number))
        json[key] = "nan";
      else if (std::isinf(*number))
        json[key] = *number > 0 ? "inf" : "-inf";
      else
        json[key] = *number;
    } else if (const auto* count = std::get_if<std::int64_t>(&value)) {
      json[key] = *count;
    } else {
      json[key] = std::get<std::string>(value);
    }
  }
  write_text_file(file, json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

Summary read_summary(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    throw std::invalid_argument(fmt::format("{}: no such file or not readable", file));
  }
  const nlohmann::json json = nlohmann::json::parse(read_text_file(file), nullptr, false);
  if (!json.is_object())
    throw std::invalid_argument(fmt::format("{}: not a JSON object (broken or truncated)", file));
  Summary summary;
  for (const auto& [key, value] : json.items()) {
    if (value.is_number_integer())
      summary[key] = value.get<std::int64_t>();
    else if (value.is_number())
      summary[key] = value.get<double>();
    else if (value == "nan" || value == "inf" || value == "-inf")
      summary[key] = dem::parse_number(value.get<std::string>()).value();
    else if (value.is_string())
      summary[key] = value.get<std::string>();
    else
      throw std::invalid_argument(fmt::format("{}: \"{}\" is {}; allowed are numbers and strings",
                                              file, key, value.type_name()));
  }
  return summary;
}

}  // namespace grainfield::coupling
