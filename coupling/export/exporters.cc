#include "coupling/export/exporters.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>

#include "continuum/model.h"
#include "coupling/export/forms.h"
#include "coupling/report/drawing.h"
#include "coupling/report/style.h"
#include "coupling/result/field_file.h"
#include "coupling/store/atomic_file.h"
#include "coupling/store/vtu.h"
#include "coupling/structure/force_chains.h"

namespace grainfield::coupling {
namespace {

std::string file_of(const ExportTarget& to, const std::string& ending) {
  return to.folder.staging(to.stem + ending);
}

void packing_as_vtu(const dem::Snapshot& packing, const ExportTarget& to) {
  write_grains_vtu(file_of(to, "-grains.vtu"), packing);
  write_contacts_vtu(file_of(to, "-contacts.vtu"), packing);
  write_chains_vtu(file_of(to, "-chains.vtu"), packing,
                   chain_of_contacts(force_chains(packing), packing.contacts.size()));
  write_text_file(file_of(to, "-paraview.py"), paraview_of_packing(to.stem, packing));
}

void field_as_vtu(const Field& field, const ExportTarget& to) {
  write_text_file(file_of(to, ".vtu"), field_vtu(field));
  const std::string column = field.columns.empty() ? "" : drawn_column(field, to.column).name;
  write_text_file(file_of(to, "-paraview.py"), paraview_of_field(to.stem, field, column));
}

void packing_as_csv(const dem::Snapshot& packing, const ExportTarget& to) {
  const PackingTables tables = packing_tables(packing);
  write_text_file(file_of(to, "-grains.csv"), tables.grains);
  write_text_file(file_of(to, "-contacts.csv"), tables.contacts);
  if (!tables.walls.empty()) write_text_file(file_of(to, "-walls.csv"), tables.walls);
}

void field_as_csv(const Field& field, const ExportTarget& to) {
  write_text_file(file_of(to, ".csv"), field_csv(field));
}

void packing_as_html(const dem::Snapshot& packing, const ExportTarget& to) {
  const std::string title = to.note.empty() ? to.title : to.title + "; " + to.note;
  write_text_file(file_of(to, ".html"), packing_page(packing, title));
}

// The note in the lower right corner; the label's number is above those of the pictures.
void add_note(Picture& picture, const std::string& note) {
  if (note.empty()) return;
  picture.program = fmt::format(
                        "set label 1000 {} at screen 1, screen 0 right offset -1,0.6 noenhanced "
                        "font ',9' tc rgb '#a00000'\n",
                        style::quoted(note)) +
                    picture.program;
}

void write_picture(Picture picture, bool bitmap, const ExportTarget& to) {
  add_note(picture, to.note);
  const auto gnuplot = find_gnuplot();
  if (!gnuplot) throw std::invalid_argument("gnuplot not found: install gnuplot-nox");
  const Drawing drawing = draw_picture(*gnuplot, picture, bitmap);
  if (drawing.bytes.empty()) throw std::runtime_error("gnuplot failed: " + drawing.error);
  write_text_file(file_of(to, bitmap ? ".png" : ".svg"), drawing.bytes);
}

Picture picture_of(const dem::Snapshot& packing_, const ExportTarget& to) {
  return packing_.dim == 2 ? packing(to.title, packing_) : slice(to.title, packing_);
}

Picture picture_of(const Field& field, const ExportTarget& to) {
  return field_picture(to.title, field, to.column);
}

template <class Held, bool bitmap>
void as_picture(const Held& held, const ExportTarget& to) {
  write_picture(picture_of(held, to), bitmap, to);
}

}  // namespace

const std::vector<Exporter>& exporters() {
  static const std::vector<Exporter> all = {
      {"vtu",
       "grains, contacts, force chains or the field for ParaView, with a script that opens them",
       packing_as_vtu, field_as_vtu},
      {"csv", "tables; of a packing those that import reads", packing_as_csv, field_as_csv},
      {"html", "a page of the packing that zooms and shows a grain's numbers", packing_as_html,
       nullptr},
      {"svg",
       "a picture of the packing; of a field on a grid a map of --column, on lines its profiles",
       as_picture<dem::Snapshot, false>, as_picture<Field, false>},
      {"png", "the same as bitmap", as_picture<dem::Snapshot, true>, as_picture<Field, true>},
  };
  return all;
}

const Exporter& find_exporter(const std::string& name) {
  std::vector<std::string> names = {"lammps"};
  for (const Exporter& one : exporters()) {
    if (one.name == name) return one;
    names.push_back(one.name);
  }
  throw std::invalid_argument(fmt::format("--to: found \"{}\", allowed: {}; did you mean {}?", name,
                                          fmt::join(names, ", "), continuum::nearest(name, names)));
}

}  // namespace grainfield::coupling
