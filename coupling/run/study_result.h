// What a study leaves, before it is written: the same for every kind of study.
#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "coupling/case/case.h"
#include "coupling/compare/compare.h"
#include "coupling/report/report.h"
#include "coupling/result/tables.h"
#include "coupling/run/realization_file.h"
#include "coupling/store/field_io.h"

namespace grainfield::coupling {

/// A column of a sweep's table.
struct OverviewColumn {
  std::string heading, key;  ///< of the summary
  std::string error_key;     ///< of its standard error; empty: KEY.standard_error

  std::string error() const { return error_key.empty() ? key + ".standard_error" : error_key; }
};

/// A curve of a member in a sweep's report, beside those of the others.
struct MemberCurve {
  std::string title, x_label;  ///< title: the quantity with its unit
  Series series;               ///< without a label
};

/// A model's stress on the map's points.
struct ModelMap {
  std::string label;
  Eigen::VectorXd sigma_yy;  ///< N/m, tension positive, on map's points
};

struct StudyResult {
  Case value;
  Comparison comparison;
  Summary summary;
  std::string constants;  ///< those of fits with their errors, a table for terminals
  NamedFields fields;
  std::vector<std::pair<std::string, std::string>> texts;  ///< further files: name, content
  Field base_unloaded, map;                                ///< for the report; may be empty
  std::vector<ModelMap> model_maps;                        ///< on map's points
  std::vector<std::string> warnings;      ///< what to mind, a line each: see add_warnings
  std::vector<std::string> realizations;  ///< files of the grains, in order; may be empty
  /// Builds report.html from this result and its first realization (null without grains). Empty:
  /// a page with the sentence and the figures.
  std::function<Report(const StudyResult&, const Realization*)> page;
  /// Columns of a sweep's table besides those of figures with a heading; may be empty.
  std::vector<OverviewColumn> overview;
  /// Frames of this member in a sweep's report, grains and models. Empty: one curve in the frames
  /// that all members share.
  std::vector<Frame> sweep_frames;
  std::string sweep_x, sweep_y;  ///< labels of these frames' axes
  /// A frame each, with a curve for every member; empty: the profiles of the comparison.
  std::vector<MemberCurve> member_curves;
  /// Curves that a sweep's report draws into common frames, before those above. May be empty.
  std::vector<Chart> sweep_charts;
  /// This member's own pictures and tables in a sweep's report, given its name; may be empty.
  std::function<std::vector<Section>(const std::string&)> sweep_sections, sweep_tables;
};

/// The case's title; its name where it has none.
std::string title_of(const Case& value);
/// The figures of the grains and of the study in the order of their declarations, with meaning and
/// unit, for a table of the report. `families`: also those declared with a '*', which other tables
/// of a page may show.
ReportRows figure_rows(const StudyResult& result, bool families = false);
/// Columns of a sweep's table: StudyResult::overview, then every figure of the members that is
/// declared with a heading.
std::vector<OverviewColumn> overview_of(const std::vector<StudyResult>& members);
/// A figure as pages show it: with_error() of judge/words.h of KEY and of `error_key`, by default
/// KEY.standard_error; a text or a number without error as it is; "" without the figure.
std::string shown_with_error(const Summary& summary, const std::string& key,
                             std::string error_key = "");
/// Case, seed, version and models, likewise.
ReportRows origin_rows(const StudyResult& result);

/// FNV-1a of a text, 16 hexadecimal digits.
std::string hash_text(const std::string& text);
/// What every study begins with: the case, its realizations, the keys of add_identity.
StudyResult begin_result(const Case& value, const std::vector<std::string>& realizations);
/// Keys that every study has: case, version, ensemble.
void add_identity(Summary& summary, const Case& value);
/// Keys that follow from the comparison, and the models' figures.
void add_comparison(Summary& summary, const Comparison& comparison, std::size_t main);

/// Puts the warnings into the summary; they stand in the report too, and the run tells them.
void add_warnings(StudyResult& result);

/// Means of the realizations' figures and, of two or more, KEY.least, .most, .standard_error.
void add_figures(Summary& summary, const std::map<std::string, std::vector<double>>& figures);

/// Writes summary.json, profiles.*, fields.h5 + .xdmf (where there are any), snapshots.h5,
/// states/*.vtu, report.html and case.toml into a folder that exists. Returns what the report lacks
/// (ReportResult::complaint).
std::string write_study(const std::string& folder, const StudyResult& result);

}  // namespace grainfield::coupling
