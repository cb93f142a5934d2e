#include "coupling/result/profile_columns.h"

#include <fmt/format.h>

#include <cmath>

namespace grainfield::coupling {
namespace {

void add_rows(const Profile& p, ProfileColumns& out) {
  for (Eigen::Index k = 0; k < p.x.size(); ++k) {
    out.profile.push_back(p.name);
    out.columns[0].values.push_back(p.depth);
    out.columns[1].values.push_back(p.x[k]);
    out.columns[2].values.push_back(p.mean[k]);
    out.columns[3].values.push_back(p.error.size() ? p.error[k] : std::nan(""));
  }
}

// The three columns of a model along one profile.
void add_model(const Profile& p, const Eigen::VectorXd& model, ProfileColumn* out) {
  for (Eigen::Index k = 0; k < p.x.size(); ++k) {
    const double difference = p.mean[k] - model[k];
    const double error = p.error.size() ? p.error[k] : std::nan("");
    out[0].values.push_back(model[k]);
    out[1].values.push_back(difference);
    out[2].values.push_back(difference / error);
  }
}

}  // namespace

std::string scale_note(const Comparison& c) {
  return c.scale.load > 0 ? fmt::format("{}, realizations: {}", c.scale.note, c.realizations)
                          : c.scale.note;
}

ProfileColumns profile_columns(const Comparison& c) {
  ProfileColumns out;
  out.notes = {scale_note(c), c.profiles.front().quantity + ": compression positive; x from the " +
                                  c.scale.x_from};
  const std::string unit = c.profiles.front().unit;
  out.columns = {
      {"depth", "m", {}}, {"x", "m", {}}, {c.column(), unit, {}}, {"standard_error", unit, {}}};
  for (const ModelProfiles& m : c.models) {
    out.columns.push_back({m.key, unit, {}});
    out.columns.push_back({m.key + "_difference", unit, {}});
    out.columns.push_back({m.key + "_difference_over_error", "1", {}});
  }
  for (std::size_t k = 0; k < c.profiles.size(); ++k) {
    add_rows(c.profiles[k], out);
    for (std::size_t m = 0; m < c.models.size(); ++m) {
      add_model(c.profiles[k], c.models[m].values[k], &out.columns[4 + 3 * m]);
    }
  }
  for (const Profile& p : c.beside) add_rows(p, out);
  for (ProfileColumn& column : out.columns) column.values.resize(out.profile.size(), std::nan(""));
  return out;
}

}  // namespace grainfield::coupling
