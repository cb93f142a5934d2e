#define CSV_IO_NO_THREAD
#include "coupling/app/points_csv.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

// The optimizer warns of the package's deliberate cutting of long file names in its own messages.
#pragma GCC diagnostic push
#ifndef __clang__  // which has no such warning
#pragma GCC diagnostic ignored "-Wstringop-truncation"
#endif
#include <libfccp/csv.h>
#pragma GCC diagnostic pop

#include "coupling/base/printable.h"
#include "coupling/base/read_input.h"
#include "coupling/import/format.h"
#include "coupling/result/csv.h"
#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

// The package's own reading of floats rounds carelessly: it gives text, the standard library
// numbers.
template <unsigned dim>
using Reader = io::CSVReader<dim, io::trim_chars<' ', '\t'>, io::no_quote_escape<','>,
                             io::throw_on_overflow, io::single_and_empty_line_comment<'#'>>;

double number(const char* text, const char* column, const std::string& file, unsigned line) {
  const std::optional<double> value = parse_number(text);
  if (!value || !std::isfinite(*value)) {
    throw std::invalid_argument(
        fmt::format("{}:{}: column {}: found \"{}\", expected a number", file, line, column, text));
  }
  return *value;
}

// What a column of lengths is times: in m, or as it is where no unit or h stands behind its name.
double factor_of(const Heading& heading, const std::string& file) {
  if (heading.unit.empty() || heading.unit == "h" || heading.unit == "m") return 1;
  for (const auto& [unit, factor] : {std::pair{"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}})
    if (heading.unit == unit) return factor;
  throw std::invalid_argument(
      fmt::format("{}:1: column {}: found the unit \"{}\", allowed: m, cm, mm, um, h", file,
                  heading.name, heading.unit));
}

// Takes the units out of the header, "x (mm)": those of these columns are returned as factors.
template <unsigned dim>
std::array<double, dim> take_units(std::string& content, const std::string& file,
                                   const std::array<const char*, dim>& names) {
  std::array<double, dim> factors;
  factors.fill(1);
  std::size_t begin = 0;
  while (begin < content.size() && (content[begin] == '#' || content[begin] == '\n'))
    begin = std::min(content.find('\n', begin), content.size() - 1) + 1;
  const std::size_t end = std::min(content.find('\n', begin), content.size());
  const std::string line = content.substr(begin, end - begin);
  if (line.find('(') == std::string::npos) return factors;
  std::string plain;
  int index = 0;
  for (std::size_t from = 0; from <= line.size();) {
    const std::size_t to = std::min(line.find(',', from), line.size());
    const Heading heading = heading_of(line.substr(from, to - from), index++);
    plain += (index > 1 ? "," : "") + heading.name;
    for (unsigned k = 0; k < dim; ++k)
      if (heading.name == names[k]) factors[k] = factor_of(heading, file);
    from = to + 1;
  }
  content.replace(begin, end - begin, plain);
  return factors;
}

// For messages.
std::string first_line(const std::string& content) {
  constexpr std::size_t most = 80;
  return one_line(content.substr(0, content.find_first_of("\r\n")), most);
}

// The named columns.
template <unsigned dim>
Eigen::MatrixXd read(const std::string& file, const std::array<const char*, dim>& names) {
  std::string content = read_input(file, "a CSV file");
  const std::string header = fmt::format("{}", fmt::join(names, ","));
  const std::array<double, dim> factors = take_units<dim>(content, file, names);
  std::vector<double> values;
  unsigned line = 0;
  try {
    Reader<dim> in(file, content.data(), content.data() + content.size());
    std::array<const char*, dim> texts{};
    std::apply([&](auto... name) { in.read_header(io::ignore_extra_column, name...); }, names);
    const auto next = [&] {
      line = in.get_file_line() + 1;
      return std::apply([&](auto&... text) { return in.read_row(text...); }, texts);
    };
    while (next())
      for (unsigned k = 0; k < dim; ++k)
        values.push_back(factors[k] * number(texts[k], names[k], file, in.get_file_line()));
  } catch (const io::error::missing_column_in_header& e) {
    throw std::invalid_argument(
        fmt::format("{}:1: no column \"{}\", expected the header {}; found: {}", file,
                    e.column_name, header, first_line(content)));
  } catch (const io::error::header_missing&) {
    throw std::invalid_argument(fmt::format("{}: is empty, expected the header {}", file, header));
  } catch (const io::error::too_few_columns&) {
    throw std::invalid_argument(fmt::format("{}:{}: too few columns", file, line));
  } catch (const io::error::too_many_columns&) {
    throw std::invalid_argument(fmt::format("{}:{}: too many columns", file, line));
  } catch (const io::error::base& e) {
    throw std::invalid_argument(fmt::format("{}: {}", file, e.what()));
  }
  if (values.empty()) throw std::invalid_argument(file + ": holds no points");
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, dim, Eigen::RowMajor>>(
      values.data(), static_cast<Eigen::Index>(values.size() / dim), dim);
}

}  // namespace

Eigen::MatrixXd read_points_csv(const std::string& file, int dim) {
  return dim == 2 ? read<2>(file, {"x", "y"}) : read<3>(file, {"x", "y", "z"});
}

Eigen::MatrixXd read_rings_csv(const std::string& file) { return read<2>(file, {"r", "z"}); }

std::string stresses_csv(const Eigen::MatrixXd& points, const Eigen::MatrixXd& stresses,
                         const std::vector<continuum::Quantity>& quantities, bool cylindrical) {
  std::vector<std::string> names =
      points.cols() == 2 ? std::vector<std::string>{"x", "y", "sigma_xx", "sigma_yy", "sigma_xy"}
      : cylindrical
          ? std::vector<std::string>{"x",        "y",        "z",        "sigma_rr", "sigma_tt",
                                     "sigma_zz", "sigma_tz", "sigma_rz", "sigma_rt"}
          : std::vector<std::string>{"x",        "y",        "z",        "sigma_xx", "sigma_yy",
                                     "sigma_zz", "sigma_yz", "sigma_xz", "sigma_xy"};
  std::vector<const continuum::Quantity*> beside;
  for (const auto& quantity : quantities) {
    if (std::find(names.begin(), names.end(), quantity.name) == names.end()) {
      beside.push_back(&quantity);
    }
  }
  for (const auto* quantity : beside) names.push_back(quantity->name);
  Csv out(Csv::kAllDigits);
  out.row(names);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    for (Eigen::Index c = 0; c < points.cols(); ++c) out.add(points(i, c));
    for (Eigen::Index c = 0; c < stresses.cols(); ++c) out.add(stresses(i, c));
    for (const auto* quantity : beside) out.add(quantity->values[i]);
    out.end_row();
  }
  return out.text();
}

}  // namespace grainfield::coupling
