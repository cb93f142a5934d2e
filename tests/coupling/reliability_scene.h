// Every command of the program with inputs that it takes.
#pragma once
#include <fmt/format.h>

#include "import_scene.h"
#include "reliability_cases.h"
#include "reliability_state.h"

namespace grainfield::coupling::testing {

enum class Writes { nothing, file, folder };

struct Command {
  std::string name;
  std::vector<std::string> words;  ///< without -o
  Writes writes = Writes::nothing;

  /// Of the file that it writes: a table, or HDF5.
  std::string ending() const {
    const std::string& command = words.front();
    if (command == "compare" || command == "fit" || command == "structure") return "";  // folders
    return command == "model" ? ".csv" : ".h5";
  }
  Start to(const std::string& output) const {
    Start start{words, {}, "", {}};
    if (!output.empty()) start.words.insert(start.words.end(), {"-o", output});
    return start;
  }
};

/// Inputs of all commands in a folder of their own.
class Workshop {
 public:
  Workshop() {
    layer_ = run("layer", small_layer("[output]\nreport = false\nvtu = false\n"));
    pile_ = run("pile", small_pile() + "[output]\nvtu = false\n");
    const dem::Snapshot packing = test::overlapping_layer(2);
    csv_ = {folder_.write("grains.csv", test::csv_grains(packing)),
            folder_.write("contacts.csv", test::csv_contacts(packing)),
            folder_.write("walls.csv", test::csv_walls(packing))};
    // One of the points lies outside: the command has a word to say on stderr.
    std::string points = "x,y\n0,1\n";
    for (int k = 0; k < 20000; ++k) points += fmt::format("{},-1\n", 1e-4 * k);
    points_ = folder_.write("points.csv", points);
  }

  const Folder& folder() const { return folder_; }
  std::string case_file() const { return folder_ / "layer.toml"; }
  std::string snapshot() const { return layer_ + "/snapshots.h5:/realization_000/loaded"; }
  std::string unloaded() const { return layer_ + "/snapshots.h5:/realization_000/unloaded"; }
  std::string fields() const { return layer_ + "/fields.h5"; }

  Command model() const {
    return {"model", {"model", "flamant", "--points", points_}, Writes::file};
  }
  /// `grid`: such as 9x5; larger ones take longer.
  Command average(const std::string& grid = "9x5") const {
    return {"average", {"average", snapshot(), "--grid", grid, "--threads", "1"}, Writes::file};
  }
  Command strain(const std::string& grid = "9x5") const {
    return {"strain", {"strain", unloaded(), snapshot(), "--grid", grid}, Writes::file};
  }
  Command import(const std::vector<std::string>& more = {}) const {
    Command out{"import", {"import", "--from", "csv"}, Writes::file};
    out.words.insert(out.words.end(), csv_.begin(), csv_.end());
    out.words.insert(out.words.end(), more.begin(), more.end());
    return out;
  }
  Command run_models() const {
    return {"run", {"run", folder_.write("models.toml", quick_models())}, Writes::folder};
  }
  Command compare() const {
    return {"compare", {"compare", fields(), "--model", "flamant"}, Writes::folder};
  }
  Command fit() const {
    return {"fit",
            {"fit", pile_ + "/snapshots.h5", "--model", "hydrostatic", "--set", "fit.bootstrap=20",
             "--threads", "1"},
            Writes::folder};
  }
  Command structure() const { return {"structure", {"structure", snapshot()}, Writes::folder}; }

  std::vector<Command> writing() const {
    return {model(), average(), strain(), import(), run_models(), compare(), fit(), structure()};
  }
  std::vector<Command> printing() const {
    return {{"check", {"check", case_file()}},
            {"keys", {"keys"}},
            {"cases", {"cases"}},
            {"info", {"info", fields()}},
            {"model", model().words},
            {"structure", structure().words}};
  }

 private:
  std::string run(const std::string& name, const std::string& text) {
    const Ending ending =
        finish({{"run", folder_.write(name + ".toml", text), "-o", folder_ / name}, {}, "", {}});
    if (ending.code != 0) throw std::runtime_error(ending.err);
    return folder_ / name;
  }

  // Without the solver that takes a second.
  static std::string quick_models() {
    std::string text = models_alone();
    text = text.substr(0, text.find("[model.march]"));
    const std::string slow = "march";
    text.replace(text.find(slow), slow.size(), "other");
    return text + "[model.other]\nname = \"osl_layer\"\neta = 0.6\nmu = 0\nwidth = 0.03\n";
  }

  Folder folder_;
  std::string layer_, pile_, points_;
  std::vector<std::string> csv_;
};

inline const Workshop& workshop() {
  static const Workshop one;
  return one;
}

/// What a command leaves at `output`: one file, with the description beside it, or a folder.
inline Contents made_by(const Command& command, const std::string& output) {
  if (command.writes == Writes::folder) return results_in(output);
  Contents out;
  if (!fs::exists(output)) return out;
  out["file"] = read_text(output);
  const std::string beside = fs::path(output).replace_extension(".xdmf");
  if (output.ends_with(".h5") && fs::exists(beside)) out["xdmf"] = read_text(beside);
  return out;
}

}  // namespace grainfield::coupling::testing
