#include "coupling/studies/sample/state_table.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "coupling/result/csv.h"
#include "coupling/run/realization_file.h"
#include "coupling/statistics/spread.h"

namespace grainfield::coupling {
namespace {

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

void StateTable::begin(Csv& out, const std::string& rows) const {
  out.comment(fmt::format("{}; realizations: {}", rows, realizations()));
  for (const StateColumn& column : columns_) {
    const std::string& unit = column.unit(dim_);
    out.comment(
        fmt::format("{}{}: {}", column.name, unit == "1" ? "" : " (" + unit + ")", column.meaning));
  }
}

std::string StateTable::heading(const StateColumn& column) const {
  const std::string& unit = column.unit(dim_);
  return unit == "deg" ? column.name : csv_heading(column.name, unit);  // their names say deg
}

std::string StateTable::csv() const {
  Csv out;
  begin(out,
        "the recorded states: of each column the mean over realizations and its standard error");
  out.add("state");
  for (const StateColumn& c : columns_) out.add(heading(c)).add(heading(c) + "_error");
  out.end_row();
  for (Eigen::Index k = 0; k < states(); ++k) {
    out.add(k);
    for (const Eigen::MatrixXd& values : values_) {
      const Spread spread = spread_at(values, k);
      out.add(spread.mean).add(spread.standard_error);
    }
    out.end_row();
  }
  return out.text();
}

std::string StateTable::csv_of_realizations() const {
  Csv out;
  begin(out, "the recorded states of every realization");
  out.add("realization").add("state");
  for (const StateColumn& c : columns_) out.add(heading(c));
  out.end_row();
  for (Eigen::Index r = 0; r < realizations(); ++r) {
    for (Eigen::Index k = 0; k < states(); ++k) {
      out.add(r).add(k);
      for (const Eigen::MatrixXd& values : values_) out.add(values(k, r));
      out.end_row();
    }
  }
  return out.text();
}

}  // namespace grainfield::coupling
