// Tables and summary keys that all fits share.
#pragma once
#include <string>
#include <vector>

#include "coupling/fit/fit.h"
#include "coupling/judge/judgement.h"
#include "coupling/result/tables.h"

namespace grainfield::coupling {

/// The fit of that name; throws std::logic_error when there is none.
const Fit& fit_of(const std::vector<Fit>& fits, const std::string& name);

/// Six digits, or "nan".
std::string number(double value);
/// "0.35 ± 0.02", to two digits of the error; "0.35 (no error)".
std::string with_error(const FittedParameter& parameter);

const std::vector<std::string>& parameter_header();
/// One row per parameter of every fit, with its strongest correlation.
std::vector<std::vector<std::string>> parameter_rows(const std::vector<Fit>& fits);

/// "model | constant | value | unit | note" of every fitted constant, for terminals. Empty without
/// constants.
std::string constants_text(const std::vector<Fit>& fits);
/// What the columns of the constants say, for captions.
const std::string& constants_note();

/// One row per parameter of every fit: value, error and interval quoted, and every other error.
std::string parameters_csv(const std::vector<Fit>& fits);

/// fit.MODEL.PARAMETER, .error, .covariance_error, .bootstrap_error, .jackknife_error;
/// fit.MODEL.{chi2_per_dof,rel_l2,note}.
void add_parameters(Summary& summary, const std::vector<Fit>& fits);
/// fit.MODEL.{cv_behind,cv_behind_error,heights_behind,heights_behind_error,aic_behind,
/// distinguishable,agrees,supported}.
void add_ranking(Summary& summary, const Judgement& judgement);

}  // namespace grainfield::coupling
