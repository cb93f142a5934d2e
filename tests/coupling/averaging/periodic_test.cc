// Periodic packings: images, averages across the boundary, imports, what ParaView sees.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <Eigen/LU>
#include <pugixml.hpp>
#include <sstream>

#include "coupling/averaging/average.h"
#include "coupling/import/import.h"
#include "coupling/store/vtu.h"
#include "coupling/strain/motion.h"
#include "coupling/structure/force_chains.h"
#include "dem/snapshot/displacements.h"
#include "tests/coupling/periodic_scene.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using dem::Vec3;
using testing::Folder;
using ::testing::HasSubstr;

// Points that fill the cell, one for each of n x n (x n) equal parts of it.
Eigen::MatrixXd points_in(const dem::Snapshot& s, int n) {
  const int count = s.dim == 2 ? n * n : n * n * n;
  Eigen::MatrixXd points(count, s.dim);
  for (int k = 0; k < count; ++k) {
    const int at[] = {k % n, k / n % n, k / (n * n)};
    Vec3 share = Vec3::Zero();
    for (int a = 0; a < s.dim; ++a) share[a] = (at[a] + 0.5) / n;
    points.row(k) = (s.cell.low + s.cell.edges * share).head(s.dim).transpose();
  }
  return points;
}

AverageOptions options_of(const std::string& method) {
  AverageOptions o;
  o.method = method;
  o.kernel = method == "coarse_graining" ? "lucy" : "circle";
  o.width = 0.02;
  o.least_grains = 0;
  return o;
}

TEST(Periodic, ImagesAreTheNearestOnes) {
  dem::Cell<3> cell;
  cell.periodic = {true, true, false};
  cell.edges << 2, 1.9, 0, 0, 1, 0, 0, 0, 0;
  dem::Random random(4);
  for (int k = 0; k < 1000; ++k) {
    const auto some = [&] { return 20 * random.uniform() - 10; };
    const Vec3 branch(some(), some(), some());
    const auto image = dem::nearest_image(cell, branch);
    EXPECT_EQ(image[2], 0);
    const double found = (branch + dem::shift_to(cell, image)).norm();
    for (int i = -20; i <= 20; ++i)
      for (int j = -12; j <= 12; ++j)
        EXPECT_LE(found, (branch + dem::shift_to(cell, {i, j, 0})).norm() + 1e-12);
    const Vec3 inside = dem::wrapped(cell, branch);
    const double y = inside.y(), x = (inside.x() - 1.9 * y) / 2;
    EXPECT_TRUE(x > -1e-12 && x < 1 + 1e-12 && y > -1e-12 && y < 1 + 1e-12) << x << " " << y;
    EXPECT_EQ(inside.z(), branch.z());
    EXPECT_EQ(dem::wrapped(cell, inside), inside);
  }
}

// Homogeneous stress: 1/V sum f (outer) l over all contacts, those across the boundary too.
TEST(Periodic, TheMeanStressIsTheSumOverAllBranches) {
  for (const int dim : {2, 3}) {
    const dem::Snapshot s = test::periodic_packing(dim, 7);
    EXPECT_GT(test::contacts_across(s), 10);
    const double volume =
        dim == 2 ? s.cell.edges.topLeftCorner<2, 2>().determinant() : s.cell.edges.determinant();
    const Eigen::Matrix3d expected = test::sum_of_branches(s) / volume;
    double mass = 0;
    for (const dem::Grain& g : s.grains) mass += g.mass;
    const Field field = average(s, points_in(s, dim == 2 ? 32 : 14), options_of("coarse_graining"));
    const auto mean = [&](const std::string& name) { return field.find(name)->value.mean(); };
    const double scale = expected.cwiseAbs().maxCoeff();
    for (int a = 0; a < dim; ++a)
      for (int b = 0; b < dim; ++b)
        EXPECT_NEAR(mean(fmt::format("sigma_{}{}", "xyz"[a], "xyz"[b])), expected(a, b),
                    1e-4 * scale)
            << dim << "D " << a << b;
    EXPECT_NEAR(mean("density"), mass / volume, 1e-4 * mass / volume);
  }
}

// Where the boundary is makes no difference.
TEST(Periodic, FieldsDoNotSeeTheBoundary) {
  for (const int dim : {2, 3}) {
    const dem::Snapshot s = test::periodic_packing(dim, 8);
    const Vec3 by(0.018, 0.014, dim == 2 ? 0 : 0.011);
    const dem::Snapshot elsewhere = test::moved(s, by);
    Eigen::MatrixXd points = points_in(s, 4);
    Eigen::MatrixXd beyond = points.rowwise() + by.head(dim).transpose();
    for (const std::string method : {"coarse_graining", "particle_centre", "area_exact"}) {
      const Field a = average(s, points, options_of(method)),
                  b = average(elsewhere, beyond, options_of(method));
      for (const Column& column : a.columns) {
        const Eigen::VectorXd& other = b.find(column.name)->value;
        ASSERT_TRUE(column.value.allFinite()) << method << " " << column.name;
        EXPECT_LT((column.value - other).cwiseAbs().maxCoeff(),
                  1e-9 * std::max(1e-30, column.value.cwiseAbs().maxCoeff()))
            << dim << "D " << method << " " << column.name;
      }
    }
    // Strain: who crosses the boundary has moved as all others. Force chains: they cross it, too.
    const GrainMotion motion = grain_motion(s, elsewhere);
    for (Eigen::Index k = 0; k < motion.displacement.rows(); ++k)
      EXPECT_LT((motion.displacement.row(k) - by.head(dim).transpose()).norm(), 1e-12);
    EXPECT_LT((motion.branch - grain_motion(elsewhere, elsewhere).branch).norm(), 1e-10);
    EXPECT_EQ(force_chains(s, {}).chain_of, force_chains(elsewhere, {}).chain_of);
  }
}

// All move with the cell: x' = G x. Some grains leave it, and more than once.
TEST(Periodic, StrainOfACellThatFlowsIsAffine) {
  for (const int dim : {2, 3}) {
    dem::Snapshot before = test::periodic_packing(dim, 13);
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Identity();
    gradient(0, 1) = 2.5;
    gradient(1, 1) = 0.9;
    dem::Snapshot after = before;
    after.cell.edges = gradient * before.cell.edges;
    after.cell.low = gradient * before.cell.low;
    for (std::size_t g = 0; g < before.grains.size(); ++g) {
      before.grains[g].image[0] = static_cast<int>(g % 3) - 1;  // from earlier on
      dem::Grain& grain = after.grains[g];
      grain.image = before.grains[g].image;
      const int crossed = static_cast<int>(g % 5) - 2;
      grain.position = gradient * grain.position - dem::shift_to(after.cell, {crossed, 0, 0});
      grain.image[0] += crossed;
    }
    const GrainMotion motion = grain_motion(before, after);
    const Eigen::MatrixXd change = (gradient - Eigen::Matrix3d::Identity()).topLeftCorner(dim, dim);
    EXPECT_LT((motion.displacement - motion.position * change.transpose()).norm(), 1e-12);
    EXPECT_LT((motion.relative - motion.branch * change.transpose()).norm(), 1e-12);
  }
}

// Simple shear from a tilt of 0.49 to 0.51, which the engine keeps as -0.49: whole edges are
// exchanged, and the counts of images with them.
TEST(Periodic, ACellThatTurnsOverMovesNobody) {
  dem::Snapshot before, after;
  before.cell.periodic = after.cell.periodic = {true, true, false};
  before.cell.edges << 1, 0.49, 0, 0, 1, 0, 0, 0, 0;
  after.cell.edges << 1, -0.49, 0, 0, 1, 0, 0, 0, 0;
  EXPECT_EQ(dem::image_in(after.cell, before.cell, {0, 1, 0}), (std::array<int, 3>{1, 1, 0}));
  before.grains.resize(1);
  after.grains.resize(1);
  before.grains[0].image = {0, 1, 0};
  after.grains[0].position = {0.01, 0, 0};
  after.grains[0].image = {1, 1, 0};
  const Vec3 moved = dem::Displacements(before, after).of(0);
  EXPECT_NEAR(moved.x(), 0.01, 1e-12);  // the copy that was in the cell
  EXPECT_NEAR(moved.y(), 0, 1e-12);
}

TEST(Periodic, PointsFarAwayAreRefused) {
  const dem::Snapshot s = test::periodic_packing(2, 8);
  try {
    average(s, Eigen::MatrixXd::Constant(1, 2, 1e3), options_of("coarse_graining"));
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), HasSubstr("the points are too far from the periodic cell"));
  }
}

// As LAMMPS writes it; with `outside` some grains are an edge or two from the box.
std::string dump_of(const dem::Snapshot& s, const std::string& header, bool outside) {
  std::string out = fmt::format(
      "ITEM: TIMESTEP\n5\nITEM: NUMBER OF ATOMS\n{}\n{}\nITEM: ATOMS id x y z radius mass vx vy vz "
      "omegax omegay omegaz quatw quati quatj quatk\n",
      s.grains.size(), header);
  for (const dem::Grain& g : s.grains) {
    Vec3 at = g.position;
    if (outside && g.id % 7 == 0) at += dem::shift_to(s.cell, {1, -2, 0});
    out += fmt::format("{} {} {} {} {} {} {} {} {} 1 2 3 0.5 0.5 -0.5 0.5\n", g.id, at.x(), at.y(),
                       at.z(), g.radius, g.mass, g.velocity.x(), g.velocity.y(), g.velocity.z());
  }
  return out;
}

std::string pairs_of(const dem::Snapshot& s) {
  std::string out = fmt::format(
      "ITEM: TIMESTEP\n5\nITEM: NUMBER OF ENTRIES\n{}\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\n"
      "ITEM: ENTRIES patom1 patom2 fx fy fz p1 p2 p3\n",
      s.contacts.size());
  for (const dem::Contact& c : s.contacts) {
    const Vec3 normal = -c.normal_force * c.normal, across = c.force - normal;
    // Every other pair the other way round.
    const double sign = (c.i + c.j) % 2 == 0 ? 1 : -1;
    out += fmt::format("{} {} {} {} {} {} {} {}\n", sign > 0 ? c.i : c.j, sign > 0 ? c.j : c.i,
                       sign * normal.x(), sign * normal.y(), sign * normal.z(), sign * across.x(),
                       sign * across.y(), sign * across.z());
  }
  return out;
}

// The box around a tilted cell of periodic_packing, in LAMMPS' words.
std::string tilted_bounds(const dem::Snapshot& s) {
  const double xy = s.cell.edges(0, 1), yz = s.cell.edges(1, 2);
  const Vec3 low = s.cell.low, high = low + Vec3(s.cell.edges.diagonal());
  return fmt::format("ITEM: BOX BOUNDS xy xz yz pp pp {}\n{} {} {}\n{} {} 0\n{} {} {}",
                     s.dim == 3 && s.cell.periodic[2] ? "pp"
                     : s.dim == 2                     ? "pp"
                                                      : "ff",
                     low.x() + std::min(0.0, xy), high.x() + std::max(0.0, xy), xy,
                     low.y() + std::min(0.0, yz), high.y() + std::max(0.0, yz), low.z(),
                     s.dim == 2 ? 0.01 : high.z(), yz);
}

ImportedSnapshot import_from(const Folder& folder, const std::string& format,
                             const std::string& grains, const std::string& contacts,
                             const std::function<void(ImportOptions&)>& more = {}) {
  ImportOptions options;
  options.format = format;
  options.gravity = Vec3(0, 0, 0);
  options.files = {folder.write("g", grains), folder.write("c", contacts)};
  if (more) more(options);
  ImportedSnapshot out;
  import_snapshots(options, [&](ImportedSnapshot&& imported) { out = std::move(imported); });
  return out;
}

void expect_same_contacts(const dem::Snapshot& ours, const dem::Snapshot& imported) {
  ASSERT_EQ(ours.contacts.size(), imported.contacts.size());
  for (std::size_t k = 0; k < ours.contacts.size(); ++k) {
    const dem::Contact &a = ours.contacts[k], &b = imported.contacts[k];
    ASSERT_EQ(a.i, b.i);
    ASSERT_EQ(a.j, b.j);
    EXPECT_EQ(a.image, b.image) << k;
    EXPECT_LT((a.normal - b.normal).norm(), 1e-12);
    EXPECT_LT((a.point - b.point).norm(), 1e-14);
    EXPECT_LT((a.force - b.force).norm(), 1e-14);
  }
}

TEST(Periodic, DumpsTellTheirCellAndContactsFindTheirImages) {
  for (const int dim : {2, 3}) {
    const Folder folder;
    const dem::Snapshot ours = test::periodic_packing(dim, 9);
    const dem::Snapshot in =
        import_from(folder, "lammps", dump_of(ours, tilted_bounds(ours), dim == 3), pairs_of(ours),
                    [&](ImportOptions& o) {
                      o.columns = {"sx,sy,sz=p1,p2,p3"};
                      if (dim == 2) o.columns.clear();
                    })
            .snapshot;
    EXPECT_EQ(in.dim, dim);
    EXPECT_EQ(in.cell.periodic, ours.cell.periodic);
    EXPECT_LT((in.cell.low - ours.cell.low).norm(), 1e-15);
    EXPECT_LT((in.cell.edges - ours.cell.edges).norm(), 1e-15);
    for (std::size_t g = 0; g < ours.grains.size(); ++g)
      EXPECT_LT((in.grains[g].position - ours.grains[g].position).norm(), 1e-14);
    expect_same_contacts(ours, in);
    const Eigen::Matrix3d sum = test::sum_of_branches(ours);
    EXPECT_LT((check_packing(in).pairs - sum).norm(), 1e-12 * sum.norm());
    if (dim == 2) continue;
    EXPECT_EQ(in.grains[3].angular_velocity, Vec3(1, 2, 3));
    EXPECT_EQ(in.grains[3].orientation, (std::array<double, 4>{0.5, 0.5, -0.5, 0.5}));
    for (std::size_t k = 0; k < ours.contacts.size(); ++k)
      EXPECT_LT((in.contacts[k].spring_vector - ours.contacts[k].spring_vector).norm(), 1e-14);
    // A snapshot of it is one that is read.
    dem::write_snapshot(folder / "s.h5", "/s", in);
    expect_same_contacts(ours, dem::read_snapshot(folder / "s.h5", "/s"));
    const testing::Output info = testing::program("info " + (folder / "s.h5"));
    EXPECT_THAT(info.out, HasSubstr("3D, 125 grains"));
    EXPECT_THAT(info.out,
                HasSubstr("periodic along x, y, z; edges (0.05, 0, 0) and (0.015, 0.05, 0)"
                          " and (0, -0.01, 0.05) m from (0.02, -0.01, 0.005)"));
  }
}

TEST(Periodic, OtherBoxesAndFormats) {
  const Folder folder;
  // Edges in full (newer versions of LAMMPS), and walls along z.
  const dem::Snapshot ours = test::periodic_packing(3, 10, false);
  const auto& edges = ours.cell.edges;
  const auto line = [&](int a) {
    return fmt::format("{} {} {} {}", edges(0, a), edges(1, a), edges(2, a), ours.cell.low[a]);
  };
  const std::string bounds =
      fmt::format("ITEM: BOX BOUNDS abc origin pp pp ff\n{}\n{}\n{}", line(0), line(1), line(2));
  const dem::Snapshot in =
      import_from(folder, "lammps", dump_of(ours, bounds, false), pairs_of(ours)).snapshot;
  EXPECT_EQ(in.cell.periodic, ours.cell.periodic);
  expect_same_contacts(ours, in);
  EXPECT_TRUE(std::isnan(in.contacts[0].spring_vector.x()));
  // A box along the axes, told by the user.
  dem::Snapshot plain = test::periodic_packing(3, 11);
  plain.cell.edges = Eigen::Matrix3d(plain.cell.edges.diagonal().asDiagonal());
  std::string csv = "id,x,y,z,radius,mass,material\n", contacts = "i,j,fx,fy,fz\n";
  for (const dem::Grain& g : plain.grains)
    csv += fmt::format("{},{},{},{},{},{},{}\n", g.id, g.position.x(), g.position.y(),
                       g.position.z(), g.radius, g.mass, g.id % 2 == 0 ? "glass" : "steel");
  dem::Contact c;
  c.i = 0;
  c.j = 4;
  c.image = {-1, 0, 0};
  csv += "";
  contacts += "0,4,1,0.5,0\n";
  const auto periodic = [](const std::vector<std::string>& axes, bool leave_out = false) {
    return [=](ImportOptions& o) {
      for (const std::string& axis : axes) o.periodic.push_back(parse_periodic(axis));
      o.leave_out_distant = leave_out;
    };
  };
  const dem::Snapshot told =
      import_from(folder, "csv", csv, contacts, periodic({"x=0.02:0.07", "z=0:0.055"})).snapshot;
  EXPECT_EQ(told.cell.periodic, (std::array<bool, 3>{true, false, true}));
  ASSERT_EQ(told.contacts.size(), 1U);
  EXPECT_EQ(told.contacts[0].image, c.image);
  EXPECT_LT(told.contacts[0].normal.x(), -0.8);
  EXPECT_EQ(told.grains[3].material, "steel");
  const auto refusal = [&](const auto& more) -> std::string {
    try {
      import_from(folder, "csv", csv, contacts, more);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "nothing is refused";
  };
  EXPECT_THAT(refusal(periodic({})), HasSubstr("--periodic AXIS=LOW:HIGH says where"));
  EXPECT_EQ(import_from(folder, "csv", csv, contacts, periodic({}, true)).left_out, 1);
  EXPECT_THAT(refusal(periodic({"x=1:0"})),
              HasSubstr("--periodic: found \"x=1:0\", expected AXIS=LOW:HIGH with LOW below HIGH"));
  EXPECT_THAT(refusal([](ImportOptions& o) { o.columns = {"qw,qx,qy,qz=1,1,0,0"}; }),
              HasSubstr("grain 0: found a quaternion of length 1.41421, allowed: 1"));
  try {
    import_from(folder, "lammps",
                dump_of(plain, "ITEM: BOX BOUNDS pp pp pp\n0 1\n0 one\n0 1", false),
                pairs_of(plain));
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), HasSubstr(":7: found \"0 one\", expected 2 finite numbers of the box"));
  }
}

std::vector<double> numbers(const pugi::xml_document& d, const std::string& name) {
  std::istringstream in(
      d.select_node(fmt::format("//DataArray[@Name='{}']", name).c_str()).node().text().get());
  std::vector<double> out;
  for (double v; in >> v;) out.push_back(v);
  return out;
}

TEST(Periodic, SpheresForParaView) {
  const Folder folder;
  dem::Snapshot s = test::periodic_packing(3, 12);
  for (dem::Grain& g : s.grains) g.orientation = {0.5, 0.5, 0.5, 0.5};
  dem::Snapshot later = test::moved(s, Vec3(0.03, 0, 0));
  // By a right angle about z.
  const double h = std::sqrt(0.5);
  for (dem::Grain& g : later.grains) g.orientation = {0, 0, h, h};
  write_grains_vtu(folder / "g.vtu", later, &s);
  write_contacts_vtu(folder / "c.vtu", later);
  write_chains_vtu(folder / "n.vtu", later, std::vector<int>(s.contacts.size(), 0));
  const std::size_t n = s.grains.size(), contacts = s.contacts.size();
  pugi::xml_document d;
  ASSERT_TRUE(d.load_file((folder / "g.vtu").c_str()));
  EXPECT_EQ(d.select_node("//Piece").node().attribute("NumberOfPoints").as_uint(), n);
  EXPECT_THAT(numbers(d, "types"), ::testing::Each(1));  // vertices
  EXPECT_TRUE(d.select_node("//PointData/DataArray[@Name='radius']"));
  EXPECT_FALSE(d.select_node("//CellData/DataArray"));
  EXPECT_EQ(numbers(d, "radius").size(), n);
  const auto turns = numbers(d, "rotation"), moves = numbers(d, "displacement"),
             stress = numbers(d, "stress"), q = numbers(d, "orientation");
  ASSERT_EQ(q.size(), 4 * n);
  EXPECT_NEAR(q[2], h, 1e-8);
  ASSERT_EQ(turns.size(), 3 * n);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t g = 0; g < n; ++g) {
    EXPECT_LT((Vec3(&turns[3 * g]) - Vec3(0, 0, M_PI / 2)).norm(), 1e-8);
    // Who has left the cell has come back in: the shortest way, 0.03 less an edge of 0.05.
    EXPECT_LT((Vec3(&moves[3 * g]) - Vec3(-0.02, 0, 0)).norm(), 1e-8);
    for (int a = 0; a < 9; ++a) sum(a / 3, a % 3) += stress[9 * g + a] * s.grains[g].volume;
  }
  EXPECT_LT((sum - test::sum_of_branches(s)).norm(), 1e-6 * sum.norm());
  for (const char* file : {"c.vtu", "n.vtu"}) {
    ASSERT_TRUE(d.load_file((folder / file).c_str()));
    EXPECT_EQ(d.select_node("//Piece").node().attribute("NumberOfCells").as_uint(), contacts);
    std::istringstream in(d.select_node("//Points/DataArray").node().text().get());
    double v[6];
    for (std::size_t k = 0; k < contacts; ++k) {
      for (double& x : v) in >> x;
      EXPECT_LT((Vec3(v + 3) - Vec3(v)).norm(), 0.013);  // none through the whole cell
    }
  }
  EXPECT_EQ(numbers(d, "tube_radius").size(), 2 * contacts);
  EXPECT_TRUE(d.select_node("//PointData/DataArray[@Name='tube_radius']"));
}

}  // namespace
}  // namespace grainfield::coupling
