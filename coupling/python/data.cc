// Packings, fields and summaries as arrays.
#include <fmt/format.h>

#include <atomic>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "coupling/import/import.h"
#include "coupling/import/packing_warnings.h"
#include "coupling/python/bindings.h"
#include "coupling/result/field_file.h"
#include "coupling/result/tables.h"
#include "coupling/run/summary_keys.h"
#include "coupling/store/atomic_file.h"
#include "coupling/store/field_io.h"
#include "dem/snapshot/columns.h"
#include "dem/snapshot/images.h"

namespace grainfield::python {
namespace {

using coupling::Field;
using dem::Snapshot;

// Vectors that lie in the plane in 2D; others have three components in both dimensions.
bool is_planar(const std::string& name) {
  for (const char* other : {"angular_velocity", "moments", "torque", "axes"})
    if (name == other) return false;
  return true;
}

template <class T>
struct Parts {
  using Number = T;
  static constexpr py::ssize_t count = 0;
};
template <>
struct Parts<dem::Vec3> {
  using Number = double;
  static constexpr py::ssize_t count = 3;
};
template <class T, std::size_t n>
struct Parts<std::array<T, n>> {
  using Number = T;
  static constexpr py::ssize_t count = n;
};

// A member of all rows: an array in place, of texts a list.
template <class Row, class T>
py::object member_of(const std::vector<Row>& rows, T Row::*member, const std::string& name, int dim,
                     const py::handle& owner) {
  using Number = typename Parts<T>::Number;
  const auto count = static_cast<py::ssize_t>(rows.size());
  const auto* first =
      rows.empty() ? nullptr : reinterpret_cast<const Number*>(&(rows.front().*member));
  std::vector<py::ssize_t> shape{count}, strides{static_cast<py::ssize_t>(sizeof(Row))};
  if constexpr (Parts<T>::count > 0) {
    const bool flat = std::is_same_v<T, dem::Vec3> && dim == 2 && is_planar(name);
    shape.push_back(flat ? 2 : Parts<T>::count);
    strides.push_back(sizeof(Number));
  }
  return view<Number>(first, shape, strides, owner);
}
template <class Row>
py::object member_of(const std::vector<Row>& rows, std::string Row::*member, const std::string&,
                     int, const py::handle&) {
  py::list out;
  for (const Row& row : rows) out.append(row.*member);
  return out;
}

template <class Row>
py::object column_of(const std::vector<Row>& rows, const std::vector<dem::Column<Row>>& columns,
                     const std::string& name, int dim, const py::handle& owner) {
  for (const auto& column : columns) {
    if (name != column.name) continue;
    return std::visit([&](auto member) { return member_of(rows, member, name, dim, owner); },
                      column.member);
  }
  throw py::key_error(name);
}

py::object column(const py::object& self, const std::string& table, const std::string& name) {
  const Snapshot& s = *self.cast<const Packing&>().state;
  if (table == "grains") return column_of(s.grains, dem::grain_columns(s.dim), name, s.dim, self);
  if (table == "contacts") return column_of(s.contacts, dem::contact_columns(), name, s.dim, self);
  return column_of(s.walls, dem::wall_columns(), name, s.dim, self);
}

template <class Row>
void add_units(py::dict& out, const std::vector<dem::Column<Row>>& columns) {
  for (const auto& column : columns) out[column.name] = column.unit;
}
py::dict units(const Packing& self, const std::string& table) {
  py::dict out;
  if (table == "grains") add_units(out, dem::grain_columns(self.state->dim));
  if (table == "contacts") add_units(out, dem::contact_columns());
  if (table == "walls") add_units(out, dem::wall_columns());
  return out;
}

// From centroid to centroid (of a pair across a boundary to the image that touches), of contacts
// with walls from the centroid to the contact point.
py::array branches(const Packing& self) {
  const Snapshot& s = *self.state;
  py::array_t<double> out({static_cast<py::ssize_t>(s.contacts.size()), py::ssize_t{s.dim}});
  auto to = out.mutable_unchecked<2>();
  for (std::size_t k = 0; k < s.contacts.size(); ++k) {
    const dem::Contact& c = s.contacts[k];
    const dem::Vec3 end = c.j < 0 ? c.point : dem::second_place(s, c);
    const dem::Vec3 branch = end - s.grains[static_cast<std::size_t>(c.i)].position;
    for (int a = 0; a < s.dim; ++a) to(static_cast<py::ssize_t>(k), a) = branch[a];
  }
  return out;
}

std::vector<std::vector<std::array<double, 2>>> outlines(const Packing& self) {
  std::vector<std::vector<std::array<double, 2>>> out;
  for (const dem::Grain& g : self.state->grains) {
    auto& corners = out.emplace_back();
    for (const auto& corner : g.outline) corners.push_back({corner[0], corner[1]});
  }
  return out;
}

std::vector<double> components(const dem::Vec3& v, int dim) { return {v.data(), v.data() + dim}; }

py::dict about(const Packing& self) {
  const Snapshot& s = *self.state;
  py::dict out, cell;
  out["dim"] = s.dim;
  out["time"] = s.time;
  out["gravity"] = components(s.gravity, s.dim);
  out["loaded_grain"] = s.loaded_grain;
  out["applied_force"] = components(s.applied_force, s.dim);
  out["also_loaded"] = s.also_loaded;
  out["attributes"] = s.attributes;
  py::dict tables;
  for (const auto& [name, table] : s.tables) {
    py::dict columns;
    for (const dem::NumberColumn& c : table) {
      columns[c.name.c_str()] =
          py::array_t<double>(static_cast<py::ssize_t>(c.values.size()), c.values.data());
    }
    tables[name.c_str()] = columns;
  }
  out["tables"] = tables;
  std::vector<std::string> names;
  for (const dem::Wall& wall : s.walls) names.push_back(wall.name);
  out["walls"] = names;
  std::vector<bool> periodic;
  std::vector<std::vector<double>> edges, flow;
  for (int a = 0; a < s.dim; ++a) {
    periodic.push_back(s.cell.periodic[static_cast<std::size_t>(a)]);
    edges.push_back(components(s.cell.edges.col(a), s.dim));
    flow.push_back(components(s.cell.velocity_gradient.row(a).transpose(), s.dim));
  }
  cell["periodic"] = periodic;
  cell["low"] = components(s.cell.low, s.dim);
  cell["edges"] = edges;
  cell["velocity_gradient"] = flow;
  out["cell"] = cell;
  return out;
}

// Options of the program as arguments: "--flip-forces" is flip_forces, "--wall" is walls.
std::string in_words_of_python(const std::string& text) {
  std::string out;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const bool option = text.compare(k, 2, "--") == 0 && k + 2 < text.size() &&
                        std::islower(static_cast<unsigned char>(text[k + 2])) != 0 &&
                        (k == 0 || text[k - 1] == ' ' || text[k - 1] == '(');
    if (!option) {
      out += text[k];
      continue;
    }
    const std::size_t start = out.size();
    for (k += 2; k < text.size() && (text[k] == '-' || std::isalpha(text[k]) != 0); ++k)
      out += text[k] == '-' ? '_' : text[k];
    --k;
    if (out.compare(start, std::string::npos, "wall") == 0) out += "s";
  }
  return out;
}

py::dict checked(const Packing& self) {
  const coupling::PackingCheck check = coupling::check_packing(*self.state);
  std::vector<std::string> warnings;
  const auto add = [&](const std::string& text) {
    if (!text.empty()) warnings.push_back(in_words_of_python(text));
  };
  add(coupling::strange_units(*self.state));
  const std::string tension = coupling::tension_in(check);
  add(tension);
  if (tension.empty())
    for (const std::string& text : coupling::warnings_of(check)) add(text);
  py::dict out;
  out["unbalanced_force_ratio"] = check.unbalanced_force_ratio;
  out["support_ratio"] = check.support_ratio;
  out["warnings"] = warnings;
  return out;
}

void write_packings(const std::string& file, const std::vector<std::string>& groups,
                    const std::vector<Packing>& packings, bool add) {
  const Released released(true);
  coupling::AtomicFile out(file);
  std::vector<std::string> there;
  if (add && std::filesystem::exists(file)) {
    there = dem::list_snapshots(file);  // an HDF5 file of ours, or a clear refusal
    out.write_with([&](const std::string& beside) { std::filesystem::copy_file(file, beside); });
  }
  for (std::size_t k = 0; k < packings.size(); ++k) {
    if (groups[k].empty())
      throw std::invalid_argument(fmt::format(
          "{}: the group after \":\" is empty; name one, or leave the colon out", file));
    const std::string group = groups[k].front() == '/' ? groups[k] : "/" + groups[k];
    if (std::find(there.begin(), there.end(), group) != there.end())
      throw std::invalid_argument(
          fmt::format("{}: holds a snapshot {} already; name another group", file, group));
    there.push_back(group);
    out.write_with(
        [&](const std::string& beside) { dem::write_snapshot(beside, group, *packings[k].state); });
  }
  out.commit();
}

coupling::ArrayTable table_of(const std::string& name, const py::dict& columns) {
  coupling::ArrayTable out{name, {}};
  for (const auto& [key, value] : columns) {
    coupling::ArrayColumn column;
    if (py::isinstance<py::list>(value)) {
      column.words = value.cast<std::vector<std::string>>();
    } else if (py::isinstance<py::array_t<std::int64_t>>(value)) {
      const auto whole = value.cast<py::array_t<std::int64_t, py::array::c_style>>();
      if (whole.ndim() != 1)
        throw std::invalid_argument(fmt::format("{}.{}: found an array of {} axes, allowed: (n,)",
                                                name, key.cast<std::string>(), whole.ndim()));
      column.whole.assign(whole.data(), whole.data() + whole.size());
    } else {
      const Eigen::VectorXd numbers = vector_of(value, name + "." + key.cast<std::string>());
      column.numbers.assign(numbers.data(), numbers.data() + numbers.size());
    }
    out.columns.emplace_back(key.cast<std::string>(), std::move(column));
  }
  return out;
}

Packing packing_of(const py::dict& grains, const py::dict& contacts, const py::dict& walls,
                   const py::dict& options) {
  coupling::ImportOptions o;
  o.dim = options["dim"].cast<int>();
  if (!options["gravity"].is_none()) {
    const auto g = options["gravity"].cast<std::vector<double>>();
    if (g.size() != static_cast<std::size_t>(o.dim))
      throw std::invalid_argument(
          fmt::format("gravity: found {} numbers, allowed: {}", g.size(), o.dim));
    o.gravity = dem::Vec3(g[0], g[1], o.dim == 3 ? g[2] : 0);
  }
  o.density = options["density"].cast<double>();
  if (!options["friction"].is_none()) o.friction = options["friction"].cast<double>();
  for (const auto& text : options["walls"].cast<std::vector<std::string>>())
    o.walls.push_back(coupling::parse_wall(text));
  for (const auto& text : options["periodic"].cast<std::vector<std::string>>())
    o.periodic.push_back(coupling::parse_periodic(text));
  if (const py::object flip = options["flip_forces"]; py::isinstance<py::str>(flip)) {
    const auto which = flip.cast<std::string>();
    o.flip_pairs = which == "pairs";
    o.flip_walls = which == "walls";
    if (!o.flip_pairs && !o.flip_walls)
      throw std::invalid_argument(fmt::format(
          "flip_forces: found \"{}\", allowed: False, True, \"pairs\", \"walls\"", which));
  } else {
    o.flip_forces = flip.cast<bool>();
  }
  if (!options["load"].is_none()) {
    const auto [id, force] = options["load"].cast<std::pair<std::int64_t, std::vector<double>>>();
    if (force.size() != static_cast<std::size_t>(o.dim))
      throw std::invalid_argument(
          fmt::format("load: found {} numbers, allowed: {}", force.size(), o.dim));
    o.loaded_grain = id;
    o.applied_force = dem::Vec3(force[0], force[1], o.dim == 3 ? force[2] : 0);
  }
  const coupling::ArrayTable of_grains = table_of("grains", grains),
                             of_contacts = table_of("contacts", contacts),
                             of_walls = table_of("walls", walls);
  const double time = options["time"].cast<double>();
  if (!std::isfinite(time))
    throw std::invalid_argument(fmt::format("time: found {}, allowed: a finite number", time));
  const Released released(false);
  try {
    coupling::ImportedSnapshot made = coupling::import_arrays(o, of_grains, of_contacts, of_walls);
    made.snapshot.time = time;
    Packing out{std::make_shared<const Snapshot>(std::move(made.snapshot)), {}};
    for (const std::string& text : made.warnings) out.doubts.push_back(in_words_of_python(text));
    return out;
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(in_words_of_python(e.what()));
  }
}

const coupling::Column& column_in(const HeldField& self, const std::string& name) {
  const coupling::Column* column = self.field->find(name);
  if (column == nullptr) throw py::key_error(name);
  return *column;
}

HeldField field_of(const py::array& points, const std::vector<py::tuple>& columns,
                   const std::array<int, 3>& shape, int realizations,
                   const coupling::Attributes& attributes) {
  Field field;
  field.points = matrix_of(points, "points");
  field.nx = shape[0];
  field.ny = shape[1];
  field.nz = shape[2];
  const Eigen::Index cells = Eigen::Index{field.nx} * field.ny * std::max(field.nz, 1);
  if (field.nx > 0 && cells != field.points.rows())
    throw std::invalid_argument(
        fmt::format("shape: found {} places for {} points", cells, field.points.rows()));
  field.realizations = realizations;
  field.attributes = attributes;
  coupling::type_attributes(field.attributes);
  for (const py::tuple& given : columns) {
    const auto name = given[0].cast<std::string>();
    coupling::Column& column = field.add(name, given[1].cast<std::string>());
    const auto of_points = [&](Eigen::Index rows) {
      if (rows != field.points.rows())
        throw std::invalid_argument(
            fmt::format("{}: found {} values for {} points", name, rows, field.points.rows()));
    };
    column.value = vector_of(given[2], name);
    of_points(column.value.size());
    if (!given[3].is_none()) {
      column.error = vector_of(given[3], name + " (error)");
      of_points(column.error.size());
      for (Eigen::Index k = 0; k < column.error.size(); ++k)
        if (column.error[k] < 0)
          throw std::invalid_argument(
              fmt::format("{}: found the error {:g} at point {}, allowed: "
                          "0 and above",
                          name, column.error[k], k));
    }
    if (!given[4].is_none()) {
      column.samples = matrix_of(given[4], name + " (samples)");
      of_points(column.samples.rows());
    }
  }
  return held(std::move(field));
}

void add_packing(py::module_& module) {
  py::class_<Packing>(module, "Packing")
      .def_readonly("doubts", &Packing::doubts)
      .def("column", [](const py::object& self, const std::string& table,
                        const std::string& name) { return column(self, table, name); })
      .def("units", units)
      .def("branches", branches)
      .def("outlines", outlines)
      .def("about", about)
      .def("checked", checked)
      .def("counts", [](const Packing& p) {
        return std::array<std::size_t, 3>{p.state->grains.size(), p.state->contacts.size(),
                                          p.state->walls.size()};
      });
  module.def("packing", packing_of);
  module.def("read_packing", [](const std::string& file, const std::string& group) {
    const Released released(true);
    return Packing{std::make_shared<const Snapshot>(dem::read_snapshot(file, group))};
  });
  module.def("list_packings", [](const std::string& file) {
    const Released released(true);
    return dem::list_snapshots(file);
  });
  module.def("write_packings", write_packings);
}

void add_field(py::module_& module) {
  py::class_<HeldField>(module, "Field")
      .def(py::init(&field_of))
      .def("points",
           [](const py::object& self) {
             return view(self.cast<const HeldField&>().field->points, self);
           })
      .def("shape",
           [](const HeldField& f) {
             return std::array<int, 3>{f.field->nx, f.field->ny, f.field->nz};
           })
      .def("realizations", [](const HeldField& f) { return f.field->realizations; })
      .def("attributes", [](const HeldField& f) { return f.field->attributes; })
      .def("is_over_height", [](const HeldField& f) { return f.field->is_over_height(); })
      .def("units",
           [](const HeldField& f) {
             py::dict out;
             for (const auto& column : f.field->columns) out[py::str(column.name)] = column.unit;
             return out;
           })
      .def("value",
           [](const py::object& self, const std::string& name) {
             return view(column_in(self.cast<const HeldField&>(), name).value, self);
           })
      .def("error",
           [](const py::object& self, const std::string& name) -> py::object {
             const auto& error = column_in(self.cast<const HeldField&>(), name).error;
             if (error.size() == 0) return py::none();
             return view(error, self);
           })
      .def("samples", [](const py::object& self, const std::string& name) -> py::object {
        const auto& samples = column_in(self.cast<const HeldField&>(), name).samples;
        if (samples.size() == 0) return py::none();
        return view(samples, self);
      });
  module.def("read_field", [](const std::string& file, const std::string& name) {
    const Released released(true);
    return held(coupling::read_field(file, name));
  });
  module.def("list_fields", [](const std::string& file) {
    const Released released(true);
    return coupling::list_fields(file);
  });
  module.def("write_fields", [](const std::string& file,
                                const std::vector<std::pair<std::string, HeldField>>& fields) {
    const Released released(true);
    coupling::NamedFields named;
    for (const auto& [name, field] : fields) named.emplace_back(name, *field.field);
    coupling::write_field_file(file, named);
  });
}

std::mutex& file_access() {
  static std::mutex one;
  return one;
}
std::atomic<bool>& running() {
  static std::atomic<bool> flag = false;
  return flag;
}

void add_summary(py::module_& module) {
  module.def("read_summary", coupling::read_summary);
  module.def("write_summary", [](const std::string& file, const coupling::Summary& summary) {
    coupling::write_summary(file, summary);
  });
  module.def("summary_unit", [](const std::string& key) -> py::object {
    const auto* known = coupling::find_summary_key(key);
    return known == nullptr ? py::object(py::none()) : py::object(py::str(known->unit));
  });
}

}  // namespace

Released::Released(bool files) {
  if (!files) return;
  files_ = std::unique_lock(file_access());
  if (running())
    throw std::runtime_error(
        "files of HDF5 are not read or written while a run goes on in this process; wait for its "
        "end");
}

OneRun::OneRun() {
  const py::gil_scoped_release released;
  const std::lock_guard lock(file_access());
  if (running())
    throw std::runtime_error("run: another run is going on in this process; wait for its end");
  running() = true;
}
OneRun::~OneRun() { running() = false; }

py::array view(const Eigen::VectorXd& values, const py::handle& owner) {
  return view<double>(values.data(), {values.size()}, {sizeof(double)}, owner);
}
py::array view(const Eigen::MatrixXd& values, const py::handle& owner) {
  constexpr py::ssize_t one = sizeof(double);
  return view<double>(values.data(), {values.rows(), values.cols()}, {one, one * values.rows()},
                      owner);
}

Eigen::MatrixXd matrix_of(const py::handle& array, const std::string& what) {
  const auto numbers =
      py::array_t<double, py::array::f_style | py::array::forcecast>::ensure(array);
  if (!numbers) throw std::invalid_argument(what + ": expected an array of numbers");
  if (numbers.ndim() != 2)
    throw std::invalid_argument(
        fmt::format("{}: found an array with {} axes, expected 2", what, numbers.ndim()));
  return Eigen::Map<const Eigen::MatrixXd>(numbers.data(), numbers.shape(0), numbers.shape(1));
}

Eigen::VectorXd vector_of(const py::handle& array, const std::string& what) {
  const auto numbers =
      py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(array);
  if (!numbers) throw std::invalid_argument(what + ": expected an array of numbers");
  if (numbers.ndim() != 1)
    throw std::invalid_argument(
        fmt::format("{}: found an array with {} axes, expected 1", what, numbers.ndim()));
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), numbers.shape(0));
}

py::array array_of(const Eigen::VectorXd& values) {
  return py::array_t<double>(values.size(), values.data());
}

HeldField held(coupling::Field field) {
  return {std::make_shared<const coupling::Field>(std::move(field))};
}

bool in_files(const std::vector<Source>& sources) {
  return std::any_of(sources.begin(), sources.end(), [](const Source& source) {
    return std::holds_alternative<std::string>(source);
  });
}

std::vector<coupling::SnapshotName> names_of(const std::vector<Source>& sources) {
  std::vector<coupling::SnapshotName> out;
  for (const Source& source : sources) {
    if (const auto* packing = std::get_if<Packing>(&source)) {
      out.push_back({"packing", std::to_string(out.size()), packing->state});
    } else {
      for (auto& name : coupling::parse_snapshot_names({std::get<std::string>(source)}))
        out.push_back(std::move(name));
    }
  }
  return out;
}

void add_data(py::module_& module) {
  add_packing(module);
  add_field(module);
  add_summary(module);
}

}  // namespace grainfield::python
