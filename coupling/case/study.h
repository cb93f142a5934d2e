// What a study is to the rest of the program: its keys, what it simulates, how it is analysed. Each
// stands in a folder of its own (coupling/studies) and is known here by its name alone.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coupling/case/case.h"
#include "coupling/result/figure.h"
#include "dem/laws/material_setup.h"
#include "dem/motion/motion_setup.h"
#include "dem/run/outlook.h"
#include "dem/run/run.h"
#include "dem/run/setup.h"

namespace grainfield::coupling {

class SectionKeys;
struct StudyResult;

/// Whether the simulated grains depend on a section's keys.
enum class KeyRole { grains, analysis };

/// A section of a case file with all its keys; studies that share it name the same one.
struct KeySection {
  const char* name;
  KeyRole role;
  void (*declare)(SectionKeys);
  const char* former = nullptr;  ///< its name in older case files, refused with the new one
};

/// Another need (keys.h) of a key that studies share.
struct OwnNeed {
  std::string path, key;            ///< of the key; of what it needs
  std::vector<std::string> values;  ///< one of these
};

/// The words that a key takes in one of the studies that share it.
struct OwnWords {
  std::string path;
  std::vector<std::string> choices;
  std::string meaning;             ///< goes on where the key's ends; may be empty
  ModelTextCheck check = nullptr;  ///< of other words: models with settings
};

/// Where a case names models besides compare.models, which is empty then unless somebody sets it:
/// both are refused.
struct ModelsElsewhere {
  std::string key;                       ///< its path; empty: nowhere
  bool (*named)(const Case&) = nullptr;  ///< whether it names any
};

/// Averaged values that an analysis holds at a time, for each realization.
struct AveragedValues {
  std::vector<std::pair<std::string, double>> keys;  ///< those that multiply it, with their numbers
  double times = 1;                                  ///< besides
};

/// What takes the time of a run in which grains may sleep.
struct LongestPart {
  std::string name;    ///< "pouring"; empty: none
  std::string remark;  ///< on its cost: "; ..."; may be empty
};

/// A name by which case files of earlier versions call a study.
struct FormerName {
  std::string name;
  std::vector<std::string> keys;  ///< what it meant besides, unless set: "fit.models=[\"osl\"]"
  /// Sections that had other names, too: former, present.
  std::vector<std::pair<std::string, std::string>> sections = {};
};

struct Study {
  std::string name;     ///< the word of the case key `study`
  std::string meaning;  ///< for people, one line
  std::vector<FormerName> former;
  /// Sections of a case file that mean something to it, in the order of its files, besides
  /// [compare] [output] [sweep] and, with grains, [ensemble].
  std::vector<KeySection> sections;
  /// Keys of these sections that do not, by path.
  std::vector<std::string> without;
  /// Needs of keys that it shares with others.
  std::vector<OwnNeed> needs;
  /// Words of keys that other studies give other words.
  std::vector<OwnWords> words;
  /// Lists of the figures that it leaves besides those of every run, shared ones too.
  std::vector<std::function<std::vector<SummaryKey>()>> figures;
  /// Parameters of models that the run fills in where the user does not set them.
  std::vector<std::string> fills;
  /// Whether compare.models may be empty.
  bool models_optional = false;
  ModelsElsewhere models_elsewhere;
  /// Whether it varies the models' settings, and sees itself which of them have no effect.
  bool varies_models = false;
  /// Where its setup holds what [material], [motion] and [rest] say; null: without these keys.
  dem::MaterialSetup& (*material)(Case&) = nullptr;
  /// The nominal radius of its grains, m, by which a restitution becomes a dashpot; set where
  /// material is.
  double (*grain_radius)(const Case&) = nullptr;
  dem::MotionSetup& (*motion)(Case&) = nullptr;
  dem::RestSetup& (*rest)(Case&) = nullptr;
  /// The realization of grains of this number, from 0; null: a study without grains. Throws
  /// std::invalid_argument beginning with the key that does not hold.
  std::unique_ptr<dem::Run> (*make_run)(const Case&, std::int64_t number, int threads) = nullptr;
  /// What a realization will take, from the case alone; set where make_run is. Throws what make_run
  /// would for any of the realizations; draws at most so many grains (dem/run/outlook.h).
  dem::Outlook (*foresee)(const Case&, std::int64_t draws) = nullptr;
  /// What the case names and the run leaves out, one line for a warning, empty: nothing; null:
  /// nothing ever. After foresee.
  std::string (*left_unused)(const Case&) = nullptr;
  /// For people, of a run as foreseen; null: nothing to say of any.
  LongestPart (*longest_part)(const Case&, const dem::Outlook&) = nullptr;
  /// What it averages; null: nothing of any size.
  std::vector<AveragedValues> (*averaged)(const Case&) = nullptr;
  /// The number of dimensions of a case's grains, 2 or 3, and the key that decides it; null: 2.
  int (*dimension)(const Case&) = nullptr;
  std::string dimension_key;
  /// What only the study knows of its keys and models; null: nothing. Throws std::invalid_argument
  /// beginning with the key that does not hold.
  void (*check)(const Case&) = nullptr;
  /// Everything the study leaves, from the files of its realizations in order (none without
  /// grains). The bits do not depend on threads.
  std::function<StudyResult(const Case&, const std::vector<std::string>& realizations, int threads)>
      analyse;

  bool has_grains() const { return make_run != nullptr; }
};

/// In the order of the documentation: those that ship, then those that were added.
const std::vector<Study>& studies();
/// The study of that name, or null.
const Study* find_study(const std::string& name);
/// The case's study; throws std::logic_error when the case was not validated.
const Study& study_of(const Case& value);

/// Adds a study of another program, before anybody asks for studies: when that program's static
/// objects are made. Throws std::logic_error later, and where one of that name is there.
///
///     const bool kAdded = add_study(my_study);
bool add_study(Study (*make)());

/// The studies that ship. Declared here and defined above, in coupling/studies/list.cc: so no room
/// below needs to include a study, and the linker takes every one of them out of the library.
std::vector<Study> shipped_studies();

/// The sections of all studies, each once: in every study's own order.
const std::vector<KeySection>& study_sections();

}  // namespace grainfield::coupling
