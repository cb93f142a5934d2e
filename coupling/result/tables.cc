#include "coupling/result/tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "coupling/judge/words.h"
#include "coupling/result/csv.h"
#include "coupling/result/profile_columns.h"
#include "coupling/result/text_table.h"
#include "coupling/store/atomic_file.h"
#include "dem/shared/number.h"

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

constexpr double kSameField = 1e-3;  // of the largest value: fields nearer than this are one

bool same_field(const ModelProfiles& a, const ModelProfiles& b) {
  double off = 0, largest = 0;
  for (std::size_t k = 0; k < a.values.size(); ++k) {
    for (Eigen::Index i = 0; i < a.values[k].size(); ++i) {
      const double one = a.values[k][i], other = b.values[k][i];
      if (!std::isfinite(one) || !std::isfinite(other)) continue;
      off = std::max(off, std::fabs(one - other));
      largest = std::max({largest, std::fabs(one), std::fabs(other)});
    }
  }
  return largest > 0 && off < kSameField * largest;
}

// The columns of models that tables for reading show, and what they leave out.
struct Shown {
  std::vector<std::size_t> models;  // indices
  std::vector<std::string> labels;  // one for each: all models of that field
  std::string note;                 // empty: none is left out
};

// The nearest fields, and of the other families the nearest one.
Shown shown_models(const Comparison& c) {
  Shown all;
  for (const std::size_t m : ranked(c)) {
    const auto same = std::find_if(all.models.begin(), all.models.end(), [&](std::size_t other) {
      return same_field(c.models[m], c.models[other]);
    });
    if (same == all.models.end()) {
      all.models.push_back(m);
      all.labels.push_back(c.models[m].label);
    } else {
      all.labels[static_cast<std::size_t>(same - all.models.begin())] += "; " + c.models[m].label;
    }
  }
  Shown out;
  std::vector<std::string> aside;
  bool other = false;  // a model of another family than the first is shown
  for (std::size_t k = 0; k < all.models.size(); ++k) {
    const bool differs = c.models[all.models[k]].family != c.models[all.models.front()].family;
    if (k < kModelsShown || (differs && !other)) {
      out.models.push_back(all.models[k]);
      out.labels.push_back(all.labels[k]);
      other = other || differs;
    } else {
      aside.push_back(all.labels[k]);
    }
  }
  if (!aside.empty()) {
    out.note = fmt::format(
        "Of {} fields the {} that rank first{}; in profiles.csv also: {}.", all.models.size(),
        kModelsShown, out.models.size() > kModelsShown ? " and the best of another family" : "",
        fmt::join(aside, "; "));
  }
  return out;
}

// A model's value to the digits of the grains' beside it, and its distance from them in errors.
std::string model_cell(double grains, double error, double model) {
  if (!std::isfinite(model)) return "-";
  if (!(error > 0)) return fmt::format("{:.4g}", model);
  return fmt::format("{} ({:+.1f})", to_digits_of(model, error), (grains - model) / error);
}

}  // namespace

std::string profiles_csv(const Comparison& c) {
  const ProfileColumns table = profile_columns(c);
  Csv out;
  for (const std::string& note : table.notes) out.comment(note);
  out.add("profile");
  for (const ProfileColumn& column : table.columns) out.add(csv_heading(column.name, column.unit));
  out.end_row();
  for (std::size_t k = 0; k < table.profile.size(); ++k) {
    out.add(table.profile[k]);
    for (const ProfileColumn& column : table.columns) out.add(column.values[k]);
    out.end_row();
  }
  return out.text();
}

std::vector<Table> profile_tables(const Comparison& c, int rows) {
  const Shown shown = shown_models(c);
  const double unit = c.scale.unit;
  std::vector<Table> out;
  for (std::size_t k = 0; k < c.profiles.size(); ++k) {
    const Profile& p = c.profiles[k];
    Table table{p.name,
                fmt::format("{} in units of {}", p.quantity, c.scale.stress),
                {"x/h", c.column()},
                {}};
    table.header.insert(table.header.end(), shown.labels.begin(), shown.labels.end());
    for (const Eigen::Index i : chosen(p.mean, rows)) {
      const double grains = p.mean[i] / unit, error = error_at(p, i) / unit;
      std::vector<std::string> row{fmt::format("{:.3f}", p.x[i] / c.scale.h),
                                   with_error(grains, error)};
      for (const std::size_t m : shown.models) {
        row.push_back(model_cell(grains, error, c.models[m].values[k][i] / unit));
      }
      table.rows.push_back(std::move(row));
    }
    out.push_back(std::move(table));
  }
  return out;
}

std::string profiles_note(const Comparison& c) {
  std::string out = scale_note(c) + ".";
  if (!c.models.empty()) {
    out += fmt::format(
        " In brackets behind a model's value: ({} - model) / standard error. Models whose fields "
        "differ by less than {:g} % of the largest value share a column.",
        c.column(), 100 * kSameField);
  }
  const std::string aside = shown_models(c).note;
  return aside.empty() ? out : out + " " + aside;
}

std::string profiles_markdown(const Comparison& c, int rows) {
  std::string text = "# Profiles\n\n" + profiles_note(c) + "\n";
  for (const Table& table : profile_tables(c, rows)) {
    text += fmt::format("\n## {}\n\n{}\n\n{}", table.title, table.caption,
                        markdown_table(table.header, table.rows));
  }
  return text;
}

std::string profiles_latex(const Comparison& c, int rows) {
  std::string text = "% " + profiles_note(c) + "\n";
  for (const Table& table : profile_tables(c, rows)) {
    text += fmt::format("\\begin{{table}}\n\\footnotesize\n\\caption{{{}: {}}}\n{}\\end{{table}}\n",
                        escape_latex(table.title), escape_latex(table.caption),
                        latex_table(table.header, table.rows));
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
      if (std::isfinite(*number))
        json[key] = *number;
      else
        json[key] = nullptr;
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
    else if (value.is_null())
      summary[key] = kNan;
    else if (value == "nan" || value == "inf" || value == "-inf")  // files of version 0.9
      summary[key] = parse_number(value.get<std::string>()).value();
    else if (value.is_string())
      summary[key] = value.get<std::string>();
    else
      throw std::invalid_argument(fmt::format("{}: \"{}\" is {}; allowed are numbers and strings",
                                              file, key, value.type_name()));
  }
  return summary;
}

}  // namespace grainfield::coupling
