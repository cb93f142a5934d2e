// A study as the user describes it in a TOML file, with every default filled in.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "continuum/model.h"
#include "dem/study/pair.h"
#include "dem/study/sample_setup.h"
#include "dem/study/setup.h"

namespace grainfield::coupling {

struct EnsembleSetup {
  std::int64_t realizations = 4;
  std::int64_t seed = 1;
};

struct AverageSetup {
  std::vector<std::string> methods = {"coarse_graining", "particle_centre"};
  std::string kernel = "lucy";
  double width = 0;  ///< m; 0 = width_diameters mean diameters
  double width_diameters = 1;
  std::string rve_shape = "circle";
  double rve_radius = 0;  ///< m; 0 = rve_diameters mean diameters
  double rve_diameters = 2.5;
  std::vector<double> depths = {0.25, 0.5, 0.75};  ///< of the layer height
  std::int64_t points = 121;                       ///< per profile
  double half_width = 0;  ///< m either side of the load; 0 = the whole layer
  std::int64_t map_columns = 81;
  std::int64_t map_rows = 31;
};

/// What is looked at in a heap. Heights are shares of its height, abscissas shares of its half
/// base.
struct HeapSetup {
  std::vector<double> heights = {0.1, 0.25, 0.5};  ///< horizontal cuts above the base
  double centre = 0.1;                             ///< dip: |x| of the window under the apex
  double shoulder_from = 0.15, shoulder_to = 0.4;  ///< dip: |x| of the windows beside it
};

/// Finished piles to start from instead of pouring.
struct GrainFiles {
  std::vector<std::string> files;  ///< empty: the piles are poured
};

/// What is averaged over piles and how (coupling/fields).
struct FieldsSetup {
  std::vector<std::string> topics = {"rve_size", "strain_measures", "elastic", "fabric", "forces"};
  double rve_diameters = 6;  ///< radius of the RVE, mean diameters
  std::vector<double> sizes = {1, 1.5, 2, 2.5, 3,  4,
                               5, 6,   7, 8,   10, 12};  ///< of rve_size, likewise
  double tolerance = 0.1;                                ///< of rve_size
  std::string measure = "cambou";                        ///< strain of elastic, fabric and forces
  std::int64_t columns = 61, rows = 25;                  ///< of the maps
  std::vector<double> heights = {0.15, 0.3, 0.5};
  std::int64_t resamples = 1000;
};

/// What is fitted to piles (coupling/fit).
struct FitSetup {
  std::vector<std::string> models = {"hydrostatic",
                                     "cantelaube_minus",
                                     "cantelaube_zero",
                                     "cantelaube_plus",
                                     "cantelaube_continuous",
                                     "cantelaube",
                                     "osl_yield",
                                     "osl",
                                     "fpa",
                                     "bcc"};
  std::vector<std::string> finite_elements;  ///< solved with the constants, beside the fits
  std::vector<std::string> components = {"sigma_xx", "sigma_yy", "sigma_xy"};
  std::vector<double> heights = {0.1, 0.25, 0.4};
  std::vector<double> leave_out;  ///< numbers of realizations, from 1
  double width_diameters = 2;
  double left_deg = 0, right_deg = 0;  ///< slopes of the flanks; 0: measured
  double friction_deg = 0;             ///< of the two-sided models; 0: the steeper slope
  double huber = 0;
  std::int64_t bootstrap = 200;
};

/// What is fitted to loaded layers (coupling/fit/layer_*).
struct VerdictSetup {
  std::vector<std::string> models = {"flamant",
                                     "layer_smooth",
                                     "layer_rough",
                                     "orthotropic_half_plane",
                                     "orthotropic_layer_smooth",
                                     "orthotropic_layer_rough",
                                     "osl_layer_absorbing",
                                     "osl_layer_reflecting"};
  std::vector<std::string> finite_elements = {"fe_elastic_layer", "fe_orthotropic_layer"};
  std::vector<std::string> components = {"sigma_xx", "sigma_yy", "sigma_xy"};
  bool base = true;
  std::vector<double> coverage;  ///< sizes of draws: fit/coverage.h; empty: not done
  std::int64_t coverage_draws = 100;
  std::int64_t bootstrap = 100;
};

/// Points and load of the studies without grains.
struct ElasticSetup {
  double force = 1;      ///< N (2D: N per metre of depth into the page)
  double height = 0.15;  ///< m; elastic-layer
  std::int64_t dim = 2;
  std::string base = "smooth";                     ///< elastic-layer
  std::vector<double> depths = {0.05, 0.1, 0.15};  ///< m
  double half_width = 0.3;                         ///< m
  std::int64_t points = 61;
  double r = 1, t = 1;  ///< orthotropic-layer: anisotropy
};

/// Heap of the study wedge.
struct WedgeSetup {
  double phi_deg = 28, left_deg = 28, right_deg = 28;  ///< friction angle, slopes
  double rho_g = 1;                                    ///< N/m^3 (2D: N/m^2)
  double height = 1;                                   ///< m
  std::vector<double> depths = {0.5, 0.75, 1};         ///< of the height; the base is always seen
  std::int64_t points = 121;
  std::vector<std::string> histories;  ///< all combinations of what is listed
  std::vector<double> dilations_deg;
  std::vector<std::string> bases;  ///< rough, smooth, or the friction angle of a frictional one
};

struct OutputSetup {
  bool snapshots = true;
  bool vtu = true;
  bool fields = true;
  bool report = true;
};

struct SweepSetup {
  std::string key;                  ///< empty: no sweep
  std::vector<std::string> values;  ///< as TOML text
};

/// A named set of keys that differ from the rest of the case: [variant.NAME.SECTION].
struct Variant {
  std::string name;
  std::vector<std::string> keys;  ///< "packing.kind=\"layered\"", as on the command line
};

/// A model of the comparison: its label in tables and keys, the registry's name, and the settings
/// the user gave (F, h and dim are added from the run where the model has them).
struct ModelChoice {
  std::string label;
  std::string name;
  continuum::Settings settings;
};

/// How models = [...] and [model.LABEL] were written, before they are put together.
struct CompareSetup {
  std::vector<std::string> models = {"flamant", "layer", "fe_elastic_layer"};
  std::vector<std::string> of_heaps;  ///< the same for studies that do without models
};

struct Case {
  std::string name;     ///< of the file, without folder and ".toml"
  std::string command;  ///< that asked for the run, for the record; may be empty
  std::string title;
  std::string study = "point-load";
  EnsembleSetup ensemble;
  dem::PointLoadSetup layer;
  dem::PileSetup pile;
  dem::LatticePileSetup lattice_pile;
  dem::SampleSetup sample;
  dem::PairSetup pair;
  AverageSetup average;
  HeapSetup heap;
  GrainFiles grains;
  FieldsSetup fields;
  FitSetup fit;
  VerdictSetup verdict;
  ElasticSetup elastic;
  WedgeSetup wedge;
  CompareSetup compare;
  OutputSetup output;
  SweepSetup sweep;
  std::vector<Variant> variants;    ///< members of a sweep whose key is "variant"
  std::vector<ModelChoice> models;  ///< in the order of compare.models
  /// Keys that were written but have no effect with what the case chooses elsewhere, a line each:
  /// "FILE:LINE: KEY: ...".
  std::vector<std::string> idle;
};

/// One member of a sweep: the value as folder and key suffix ("friction_0.3") and its case.
struct SweepCase {
  std::string suffix;  ///< empty: the case has no sweep
  Case value;
};

/// An override from the command line: "key.path=value".
using Overrides = std::vector<std::string>;

/// Reads and validates a case file. With `quick`, the tables under [quick] override the rest.
/// Throws std::invalid_argument, one line "FILE:LINE: KEY: ..." (overrides: "--set: KEY: ...").
Case read_case(const std::string& file, bool quick, const Overrides& overrides);
/// The cases of its sweep in order, or the case itself.
std::vector<SweepCase> sweep_cases(const Case& value);
/// The whole case as TOML: every key of its study with unit and meaning as a comment. Reading it
/// back gives the same case.
std::string write_case(const Case& value);
/// Those keys, one a line, that the simulated grains depend on: a run that differs in others only
/// (averaging, models, outputs, the number of realizations) can use the same grains.
std::string grain_keys_text(const Case& value);
/// Whether the run fills this parameter of a model in where the user does not set it.
bool filled_by_run(const std::string& parameter, const std::string& study);
/// Only the title of a case file; throws as read_case when it is not TOML.
std::string case_title(const std::string& file);

}  // namespace grainfield::coupling
