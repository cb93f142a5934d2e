#include "coupling/studies/sample/state_table.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "coupling/run/realization_file.h"
#include "coupling/statistics/spread.h"

namespace grainfield::coupling {
namespace {

// Of a CSV; a nan has no sign.
std::string value_cell(double value) {
  return std::isnan(value) ? "nan" : fmt::format("{:.9g}", value);
}

Spread spread_at(const Eigen::MatrixXd& values, Eigen::Index state) {
  std::vector<double> row;
  for (Eigen::Index r = 0; r < values.cols(); ++r) row.push_back(values(state, r));
  return spread_of(row);
}

}  // namespace

StateTable::StateTable(const std::vector<std::string>& files) {
  for (std::size_t r = 0; r < files.size(); ++r) {
    const Realization one = read_realization(files[r]);
    const dem::Snapshot& first = one.snapshots.front().second;
    if (r == 0) {
      dim_ = first.dim;
      periodic_ = first.cell.is_periodic();
      columns_ = state_columns(dim_);
      values_.assign(columns_.size(),
                     Eigen::MatrixXd(static_cast<Eigen::Index>(one.snapshots.size()),
                                     static_cast<Eigen::Index>(files.size())));
    }
    if (static_cast<Eigen::Index>(one.snapshots.size()) != states() || first.dim != dim_) {
      throw std::invalid_argument(fmt::format("{}: found {} states in {}D, expected {} in {}D",
                                              files[r], one.snapshots.size(), first.dim, states(),
                                              dim_));
    }
    for (std::size_t k = 0; k < one.snapshots.size(); ++k) {
      const StateFacts facts = state_facts(one.snapshots[k].second, first);
      for (std::size_t c = 0; c < columns_.size(); ++c) {
        values_[c](static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(r)) =
            columns_[c].of(facts);
      }
    }
  }
}

const Eigen::MatrixXd& StateTable::of(const std::string& name) const {
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    if (columns_[c].name == name) return values_[c];
  }
  throw std::logic_error("a state has no column " + name);
}

Eigen::VectorXd StateTable::mean(const std::string& name) const {
  return of(name).rowwise().mean();
}

Eigen::VectorXd StateTable::error(const std::string& name) const {
  const Eigen::MatrixXd& values = of(name);
  Eigen::VectorXd out(values.rows());
  for (Eigen::Index k = 0; k < out.size(); ++k) out[k] = spread_at(values, k).standard_error;
  return out;
}

std::string StateTable::comments(const std::string& rows) const {
  std::string out = fmt::format("# {}; realizations: {}\n", rows, realizations());
  for (const StateColumn& column : columns_) {
    const std::string& unit = column.unit(dim_);
    out += fmt::format("# {}{}: {}\n", column.name, unit == "1" ? "" : " (" + unit + ")",
                       column.meaning);
  }
  return out;
}

std::string StateTable::csv() const {
  std::string out = comments(
      "the recorded states: of each column the mean over realizations and its standard error");
  const auto heading = [&](const StateColumn& column) {
    const std::string& unit = column.unit(dim_);
    return unit == "1" || unit == "deg" ? column.name : column.name + "_" + unit;
  };
  out += "state";
  for (const StateColumn& c : columns_) {
    out += fmt::format(",{0},{0}_error", heading(c));
  }
  out += "\n";
  for (Eigen::Index k = 0; k < states(); ++k) {
    out += std::to_string(k);
    for (const Eigen::MatrixXd& values : values_) {
      const Spread spread = spread_at(values, k);
      out += fmt::format(",{},{}", value_cell(spread.mean), value_cell(spread.standard_error));
    }
    out += "\n";
  }
  return out;
}

std::string StateTable::csv_of_realizations() const {
  std::string out = comments("the recorded states of every realization");
  out += "realization,state";
  for (const StateColumn& c : columns_) {
    const std::string& unit = c.unit(dim_);
    out += fmt::format(",{}", unit == "1" || unit == "deg" ? c.name : c.name + "_" + unit);
  }
  out += "\n";
  for (Eigen::Index r = 0; r < realizations(); ++r) {
    for (Eigen::Index k = 0; k < states(); ++k) {
      out += fmt::format("{},{}", r, k);
      for (const Eigen::MatrixXd& values : values_)
        out += fmt::format(",{}", value_cell(values(k, r)));
      out += "\n";
    }
  }
  return out;
}

}  // namespace grainfield::coupling
