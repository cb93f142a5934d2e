// A whole force beside columns of its parts: they are compared, and where nothing tells which of
// them the force is, the user is asked.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "coupling/import/assemble_contacts.h"
#include "coupling/import/synonyms.h"
#include "coupling/import/untaken.h"
#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

using dem::Vec3;

// Between a force's part and what a column says of its size: what three digits leave.
constexpr double kSameSize = 1e-2;

// The tangential share of a force that lies along its normal: what few digits leave.
constexpr double kAlong = 1e-3;

// Cosine of the angle between the parts of a force, normal and tangential: few digits leave less.
constexpr double kOblique = 0.1;
constexpr double kNoPart = 1e-6;  // of the other part: rounding, whose direction is any

// "T_x" and "T_y", "c_p[4]" and "c_p[5]": names that differ in one letter, the next axis or number.
bool follows(const std::string& name, const std::string& next) {
  if (name.size() != next.size()) return false;
  const auto [at, other] = std::mismatch(name.begin(), name.end(), next.begin());
  return at != name.end() && std::equal(at + 1, name.end(), other + 1) && *other == *at + 1 &&
         std::string_view("xyXY012345678").find(*at) != std::string_view::npos;
}

// Plain names of a vector's components beside fx, fy, fz: "fxt", "ft1", "shearx", LAMMPS' "p1".
bool is_tangential_component(const std::string& plain) {
  const auto is_axis = [](char c) {
    return std::string_view("xyz123").find(c) != std::string::npos;
  };
  if (plain.size() < 2) return false;
  const bool last = is_axis(plain.back());
  if (plain.size() == 2) return plain[0] == 'p' && plain[1] >= '1' && plain[1] <= '3';
  if (plain.size() == 3 && plain[0] == 'f')
    return (is_axis(plain[1]) && (plain[2] == 't' || plain[2] == 's')) ||
           (last && (plain[1] == 't' || plain[1] == 's'));
  return last &&
         (plain.find("tang") != std::string::npos || plain.find("shear") != std::string::npos);
}

// "c_p[3]" and three -> "c_p[4]", "c_p[5]", "c_p[6]" where all of them are among `names`.
std::vector<std::string> names_behind(const std::string& name,
                                      const std::vector<std::string>& names, int count) {
  const std::size_t open = name.rfind('[');
  if (open == std::string::npos || name.back() != ']') return {};
  const auto number = parse_integer(name.substr(open + 1, name.size() - open - 2));
  if (!number) return {};
  std::vector<std::string> out;
  for (long long k = *number + 1; k <= *number + count; ++k) {
    out.push_back(fmt::format("{}[{}]", name.substr(0, open), k));
    if (std::find(names.begin(), names.end(), out.back()) == names.end()) return {};
  }
  return out;
}

}  // namespace

void Assembly::find_parts_beside(const ForeignTable& table, const TableColumns& columns,
                                 ContactColumns& c) {
  const int dim = out_.snapshot.dim;
  const auto theirs = [&](const ForeignColumn& column) {
    return column.index < 0 ? column.name
                            : (*table.columns)[static_cast<std::size_t>(column.index)];
  };
  const bool chosen = names_.chose("fx");
  if (!chosen && columns.has("ftx")) {
    if (!columns.has("fnx"))
      columns.missing(
          "fnx",
          "beside ftx, fx may be the whole force (--column fx,fy,fz=fx,fy,fz) or its normal "
          "part (--column fnx,fny,fnz=fx,fy,fz)",
          "beside ftx, fx may be the whole force or its normal part: leave one out");
    c.told_normal = need_triple(columns, "fn", dim);
    c.told_tangential = need_triple(columns, "ft", dim);
  }
  std::vector<std::string> parts;
  for (const std::string& name : columns.untaken()) {
    const std::string plain = plain_untaken_name(table, name);
    const auto is_of = [&](const char* ours) {
      const Synonyms& known = synonyms_of(ours);
      return plain == ours ||
             std::find(known.likely.begin(), known.likely.end(), plain) != known.likely.end();
    };
    if (!c.told_fn && is_of("fn")) {
      c.told_fn = columns.need_theirs(name, "fn");
    } else if (!c.told_ft && is_of("ft")) {
      c.told_ft = columns.need_theirs(name, "ft");
    } else if (is_tangential_component(plain)) {
      parts.push_back(name);
    }
  }
  // LAMMPS' pair/local: the normal part, and behind it the tangential one.
  if (chosen && format_.name == "lammps") {
    const std::string last = theirs(c.force.z ? c.force.z : c.force.y);
    const std::vector<std::string> behind =
        names_behind(last, columns.untaken(), c.force.z ? 3 : 2);
    if (!behind.empty())
      out_.warnings.push_back(fmt::format(
          "{}:{}: {} to {} are taken as the whole force: of compute pair/local fx fy fz they are "
          "its "
          "normal part, and p1 p2 p3 (here {}?) its tangential one: --column fnx,fny,fnz=... and "
          "--column ftx,fty,ftz=... add both",
          table.file, table.header_line, theirs(c.force.x), last, grouped_names(behind)));
  }
  if (chosen || parts.size() < 2) return;
  const std::string whole = fmt::format("{},{}{}", theirs(c.force.x), theirs(c.force.y),
                                        c.force.z ? "," + theirs(c.force.z) : std::string());
  const bool three = parts.size() >= 3;
  if (three) parts.resize(3);
  const std::string n = three && c.force.z ? "fnx,fny,fnz" : "fnx,fny",
                    t = three ? "ftx,fty,ftz" : "ftx,fty";
  throw std::invalid_argument(fmt::format(
      "{}:{}: beside {} the columns {} may be the tangential part of the force: --column '{}={}' "
      "--column '{}={}' adds them, --column '{}={}' takes {} as the whole force",
      table.file, table.header_line, theirs(c.force.x), fmt::join(parts, " "), n, whole, t,
      fmt::join(parts, ","), c.force.z ? "fx,fy,fz" : "fx,fy", whole, theirs(c.force.x)));
}

void Assembly::VectorBeside::add(const ForeignRow& row, const Vec3& force) {
  Vec3 vector = Vec3::Zero();
  for (std::size_t k = 0; k < columns.size(); ++k)
    vector[static_cast<Eigen::Index>(k)] =
        parse_number(std::string(row.text(columns[k]))).value_or(0);
  const double length = vector.norm();
  if (!(length > 0) || force.isZero(0)) return;
  ++rows;
  unit += std::abs(length - 1) < kSameSize;
  across += std::abs(vector.dot(force)) <= kSameSize * length * force.norm();
}

void Assembly::find_vectors_beside(const ForeignTable& table, const TableColumns& columns,
                                   const ContactColumns& c) {
  beside_.clear();
  tally_.bearing = tally_.along = 0;
  if (!table.any_names || !c.force || c.told_normal) return;
  const std::vector<std::string> names = columns.untaken();
  const std::size_t dim = c.force.z ? 3 : 2;
  for (std::size_t k = 0; k + dim <= names.size(); ++k) {
    bool vector = plain_untaken_name(table, names[k]).find("torque") == std::string::npos;
    for (std::size_t d = 1; d < dim; ++d)
      vector = vector && follows(names[k + d - 1], names[k + d]);
    if (!vector) continue;
    VectorBeside one;
    for (std::size_t d = 0; d < dim; ++d) {
      one.names.push_back(names[k + d]);
      one.columns.push_back(columns.peek_theirs(names[k + d]));
    }
    beside_.push_back(std::move(one));
    k += dim - 1;
  }
  // A spring is a part of the force.
  if (c.springs)
    beside_.push_back({{c.springs.x.name, c.springs.y.name, c.springs.z.name},
                       {c.springs.x, c.springs.y, c.springs.z}});
}

void Assembly::tell_vectors_beside(const ForeignTable& table, const ContactColumns& c) {
  if (tally_.bearing == 0 || tally_.along < tally_.bearing) return;
  for (const VectorBeside& one : beside_) {
    if (one.rows == 0 || one.across < one.rows || one.unit == one.rows) continue;
    const std::string all = fmt::format("{}", fmt::join(one.names, ","));
    out_.warnings.push_back(fmt::format(
        "{}:{}: all forces between grains lie along the normals, and {} across them: are {} the "
        "normal part alone (--column fnx,fny,fnz=... --column ftx,fty,ftz={})?",
        table.file, table.header_line, all, c.force.x.name + " ...", all));
  }
}

void Assembly::check_sizes(const ContactRow& row) {
  const dem::Contact& c = row.contact;
  if (c.j >= 0 && !c.force.isZero(0)) {
    ++tally_.bearing;
    tally_.along += std::abs(c.tangential_force) <= kAlong * c.force.norm();
  }
  // Where a mesh is imported as a flat wall the directions are others.
  if (c.j < 0 || (!row.told_fn && !row.told_ft)) return;
  ++tally_.sized;
  const double size = c.force.norm();
  const auto off = [&](const std::optional<double>& told, double found) {
    return told && std::abs(std::abs(*told) - std::abs(found)) >
                       kSameSize * std::max(size, std::abs(*told));
  };
  if (row.told_ft) {
    tally_.tangential += std::abs(c.tangential_force);
    tally_.told_tangential += std::abs(*row.told_ft);
  }
  if (!off(row.told_fn, c.normal_force) && !off(row.told_ft, c.tangential_force)) return;
  if (tally_.off_size++ > 0) return;
  tally_.first_off_size = fmt::format(
      "{}: the force has the normal part {:g} N and the tangential part {:g} N, the row says {} "
      "and "
      "{}",
      row.source.where(), std::abs(c.normal_force), std::abs(c.tangential_force),
      row.told_fn ? fmt::format("{:g} N", *row.told_fn) : "nothing",
      row.told_ft ? fmt::format("{:g} N", *row.told_ft) : "nothing");
}

void Assembly::tell_sizes() {
  if (tally_.off_size == 0) return;
  const std::string found =
      fmt::format("{} of {} forces contradict the columns of their parts (the first: {})",
                  tally_.off_size, tally_.sized, tally_.first_off_size);
  if (tally_.tangential <= kSameSize * tally_.told_tangential)
    throw std::invalid_argument(fmt::format(
        "{}: fx, fy, fz seem to be the normal part alone; allowed: the whole force, its parts "
        "(--column fnx,fny,fnz=... and ftx,fty,ftz=...), or sizes with directions (fn, ft, tx "
        "...); "
        "--column fx=... takes it as it is",
        found));
  out_.warnings.push_back(found + ": fx, fy, fz are taken as the whole force");
}

void Assembly::check_parts(const ContactColumns& columns, const ForeignRow& row) {
  const Vec3 whole = columns.force.of(row),
             sum = columns.told_normal.of(row) + columns.told_tangential.of(row);
  if ((whole - sum).norm() <= kSameSize * std::max(whole.norm(), sum.norm())) return;
  row.refuse(
      fmt::format("found the force ({:g}, {:g}, {:g}) N in fx, fy, fz and ({:g}, {:g}, {:g}) N in "
                  "the sum of fnx "
                  "... and ftx ..., allowed: those that agree; --column fx,fy,fz=... or --column "
                  "fnx,fny,fnz=... says which count",
                  whole.x(), whole.y(), whole.z(), sum.x(), sum.y(), sum.z()));
}

void Assembly::count_parts(const ContactColumns& columns, const ForeignRow& row) {
  if (columns.normal_part) {
    const Vec3 fn = columns.normal_part.of(row), ft = columns.tangential_part.of(row);
    const double size = fn.norm() * ft.norm();
    const bool both = ft.norm() > kNoPart * fn.norm() && fn.norm() > kNoPart * ft.norm();
    tally_.parts += both;
    tally_.oblique += both && std::abs(fn.dot(ft)) > kOblique * size;
  }
  if (columns.fn && columns.tangential_part) {
    const double fn = row.number(columns.fn);
    tally_.fn_above += fn > 0;
    tally_.fn_below += fn < 0;
  }
}

}  // namespace grainfield::coupling
