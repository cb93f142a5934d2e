// The study of elastic-plastic heaps in its parts: which heaps (analysis_members.cc), their
// pages (analysis_report.cc), their figures and files (study.cc). Internal to the study.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "continuum/model.h"
#include "coupling/averaging/average.h"
#include "coupling/models/evaluate_model.h"
#include "coupling/result/figure.h"
#include "coupling/run/study_result.h"
#include "coupling/specimen/base_shape.h"
#include "coupling/specimen/slip_lines.h"
#include "coupling/studies/wedge/page.h"
#include "coupling/studies/wedge/setup.h"

namespace grainfield::coupling {

/// Points of the pictures across and down the heap.
inline constexpr int kWedgeColumns = 141, kWedgeRows = 61;
/// Pictures of more heaps than this would hide each other.
inline constexpr std::size_t kMostWedgeMaps = 6;

/// A heap or a closed form, evaluated.
struct WedgeMember {
  ModelChoice choice;
  std::string history, dilation, base;  ///< as varied by the study; else empty
  bool heap = false;
  std::string failed;                      ///< why it is not there
  std::vector<Eigen::VectorXd> pressures;  ///< one per depth, N/m
  Eigen::MatrixXd map;                     ///< stress
  std::vector<continuum::Quantity> quantities;
  continuum::MeshField mesh;
  std::vector<Eigen::MatrixXd> slip;
  std::map<std::string, double> figures;
  double seconds = 0;
  BaseShape shape;
  std::string nearest;
  double nearest_rel_l2 = std::numeric_limits<double>::quiet_NaN();
};

/// All the models of a case on the same horizontal lines through the heap, and points. Where
/// [wedge] lists histories, dilations or bases, every finite-element heap of the case is solved for
/// all their combinations, and one without equilibrium is an entry of the table; else it fails the
/// study.
class WedgeAnalysis {
 public:
  /// Finds the combinations that the case asks for. Throws std::invalid_argument naming the key,
  /// also for fewer than two models or no finite-element heap.
  explicit WedgeAnalysis(const Case& value);
  /// Evaluates, compares, writes down. Throws ComputationFailed where no heap has an equilibrium.
  StudyResult run();

 private:
  // Which heaps, evaluated (analysis_members.cc).
  std::size_t first_heap() const;
  void find_members();
  /// Takes from the combinations of a heap what they leave without effect, as `layers` from one
  /// that is laid at once. Throws BadParameter for a setting without effect in all of them.
  void drop_without_effect(const ModelChoice& choice, std::size_t begin);
  void evaluate(WedgeMember& member) const;
  void find_slip_lines(WedgeMember& member, const PlaneStress& stress) const;
  void find_nearest(WedgeMember& member) const;

  // Figures and files (study.cc).
  void compare_with(const WedgeMember& reference, StudyResult& out) const;
  void summarize(StudyResult& out) const;
  void add_files(StudyResult& out) const;

  // Pages (analysis_report.cc).
  Table table() const;
  Frame frame(std::size_t depth, const std::string& title,
              const std::vector<const WedgeMember*>& heaps) const;
  WedgeReport report(const StudyResult& result) const;
  void add_maps(const WedgeMember& m, WedgeReport& in) const;
  std::string continuum_setting(const WedgeMember& m, const std::string& name) const;

  const Case& value_;
  const WedgeSetup& setup_;
  RunFacts facts_;
  double height_ = 1, left_ = 1, right_ = 1;
  std::vector<double> depths_;  ///< the last one is the base
  std::vector<Eigen::MatrixXd> lines_;
  Eigen::MatrixXd grid_;
  bool mapped_ = false;  ///< combinations are studied; heaps without equilibrium are entries
  std::vector<WedgeMember> members_;
};

struct WedgeFacts {
  const WedgeMember& member;
  double unit = 1;    ///< rho g h, N/m
  double height = 1;  ///< m
};
/// "wedge.LABEL." comes before their keys.
const std::vector<RunFigure<WedgeFacts>>& wedge_member_rows();

/// Counts over all heaps of a case.
struct WedgeCounts {
  std::int64_t heaps = 0, equilibria = 0;
  std::map<std::string, std::int64_t> words = {};  ///< by the shape of the base's pressure

  std::int64_t of(const std::string& word) const {
    const auto at = words.find(word);
    return at == words.end() ? 0 : at->second;
  }
};
const std::vector<RunFigure<WedgeCounts>>& wedge_rows();

}  // namespace grainfield::coupling
