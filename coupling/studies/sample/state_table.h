// The recorded states of all realizations, column by column.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "coupling/result/csv.h"
#include "coupling/studies/sample/state_columns.h"

namespace grainfield::coupling {

class StateTable {
 public:
  /// From the files of finished realizations, in order. Throws std::invalid_argument naming a file
  /// that is broken or holds other states than the first one.
  explicit StateTable(const std::vector<std::string>& files);

  int dim() const { return dim_; }
  Eigen::Index states() const { return values_.front().rows(); }
  Eigen::Index realizations() const { return values_.front().cols(); }
  const std::vector<StateColumn>& columns() const { return columns_; }
  bool is_periodic() const { return periodic_; }

  /// states x realizations. Throws std::logic_error for an unknown name.
  const Eigen::MatrixXd& of(const std::string& name) const;
  Eigen::VectorXd mean(const std::string& name) const;
  /// Standard error of the mean; nan with one realization.
  Eigen::VectorXd error(const std::string& name) const;

  /// A row per state: of each column the mean over realizations and its standard error; header
  /// names carry units, comment lines (#) before say what each column is.
  std::string csv() const;
  /// A row per realization and state, likewise.
  std::string csv_of_realizations() const;

 private:
  // What the rows are and what each column is, as comments.
  void begin(Csv& out, const std::string& rows) const;
  // The column's name with its unit.
  std::string heading(const StateColumn& column) const;

  int dim_ = 2;
  bool periodic_ = false;
  std::vector<StateColumn> columns_;
  std::vector<Eigen::MatrixXd> values_;  // by column
};

}  // namespace grainfield::coupling
