// Packings and fields for other programs and for the eye, through the real program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <pugixml.hpp>

#include "coupling/export/forms.h"
#include "coupling/store/field_io.h"
#include "dem/snapshot/snapshot.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::Output;
using testing::program;
using testing::read_text;
using ::testing::StartsWith;

const std::string kSamples = std::string(GRAINFIELD_CASES) + "/samples/";
const std::string kLayer = kSamples + "layer.h5", kHeaps = kSamples + "heaps.h5",
                  kBox = kSamples + "box.h5";

void exported(const std::string& arguments) {
  const Output output = program("export " + arguments);
  ASSERT_EQ(output.code, 0) << output.err;
}

std::string refusal(const std::string& arguments) {
  const Folder folder;
  const Output output = program("export " + arguments + " -o " + (folder / "out"));
  EXPECT_EQ(output.code, 2) << output.err;
  EXPECT_EQ(std::count(output.err.begin(), output.err.end(), '\n'), 1) << output.err;
  return output.err;
}

std::string first_of(const std::string& file) { return dem::list_snapshots(file).front(); }

// Tables of a packing, imported again, are the packing.
void expect_tables_come_back(const std::string& file) {
  const Folder folder;
  const std::string group = first_of(file);
  exported(file + ":" + group + " --to csv -o " + (folder / "csv"));
  std::string tables;
  for (const auto& entry : testing::fs::directory_iterator(folder / "csv")) {
    if (entry.path().extension() == ".csv") tables += " " + entry.path().string();
  }
  const dem::Snapshot before = dem::read_snapshot(file, group);
  const Output back = program("import --from csv --dim " + std::to_string(before.dim) + tables +
                              " -o " + (folder / "back.h5"));
  ASSERT_EQ(back.code, 0) << back.err;
  const dem::Snapshot after = dem::read_snapshot(folder / "back.h5", "packing");
  ASSERT_EQ(after.grains.size(), before.grains.size());
  ASSERT_EQ(after.contacts.size(), before.contacts.size());
  ASSERT_EQ(after.walls.size(), before.walls.size());
  for (std::size_t k = 0; k < before.grains.size(); ++k) {
    const dem::Grain &a = before.grains[k], &b = after.grains[k];
    EXPECT_EQ(a.id, b.id);
    EXPECT_LT((a.position - b.position).norm(), 1e-13 * a.radius);
    EXPECT_NEAR(a.radius, b.radius, 1e-13 * a.radius);  // of a polygon from its corners
    EXPECT_EQ(a.mass, b.mass);
    EXPECT_EQ(a.fixed, b.fixed);
    ASSERT_EQ(a.outline.size(), b.outline.size());
    for (std::size_t c = 0; c < a.outline.size(); ++c) {
      // The import sets outlines about their centroid anew.
      EXPECT_NEAR(a.outline[c][0], b.outline[c][0], 1e-13 * a.radius);
      EXPECT_NEAR(a.outline[c][1], b.outline[c][1], 1e-13 * a.radius);
    }
  }
  for (std::size_t k = 0; k < before.contacts.size(); ++k) {
    const dem::Contact &a = before.contacts[k], &b = after.contacts[k];
    EXPECT_EQ(a.i, b.i);
    EXPECT_EQ(a.j, b.j);
    EXPECT_EQ(a.force, b.force);
    EXPECT_EQ(a.point, b.point);
    EXPECT_LT((a.normal - b.normal).norm(), 1e-15);  // the import makes them unit vectors
  }
}

TEST(ExportForms, TablesAreWhatImportReads) {
  expect_tables_come_back(kLayer);
  expect_tables_come_back(kHeaps);
}

TEST(ExportForms, ParaViewFilesAreWellFormedAndHaveEveryGrain) {
  const Folder folder;
  for (const std::string& file : {kHeaps, kBox}) {
    const std::string group = first_of(file), out = folder / "vtu";
    exported(file + ":" + group + " --to vtu -o " + out);
    const dem::Snapshot packing = dem::read_snapshot(file, group);
    int files = 0, scripts = 0;
    for (const auto& entry : testing::fs::directory_iterator(out)) {
      if (entry.path().extension() == ".py") {
        ++scripts;
        EXPECT_EQ(std::system(("/usr/bin/python3 -m py_compile " + entry.path().string()).c_str()),
                  0);
      }
      if (entry.path().extension() != ".vtu") continue;
      ++files;
      pugi::xml_document document;
      ASSERT_TRUE(document.load_file(entry.path().c_str())) << entry.path();
      const auto piece = document.child("VTKFile").child("UnstructuredGrid").child("Piece");
      if (entry.path().string().find("-grains") != std::string::npos) {
        EXPECT_EQ(piece.attribute("NumberOfCells").as_uint(), packing.grains.size());
      }
      if (entry.path().string().find("-contacts") != std::string::npos) {
        EXPECT_EQ(piece.attribute("NumberOfCells").as_uint(), packing.contacts.size());
      }
    }
    EXPECT_EQ(files, 3);
    EXPECT_EQ(scripts, 1);
  }
}

TEST(ExportForms, AFieldBecomesAGridATableAndAMap) {
  const Folder folder;
  const std::string field = folder / "f.h5";
  ASSERT_EQ(program("average " + kLayer + ":" + first_of(kLayer) + " --grid 9x5 -o " + field).code,
            0);
  for (const char* form : {"vtu", "csv", "svg", "png"}) {
    exported(field + " --to " + form + " -o " + (folder / form));
  }
  const std::string name = list_fields(field).front();
  pugi::xml_document document;
  ASSERT_TRUE(document.load_file((folder / "vtu/" + name + ".vtu").c_str()));
  const auto piece = document.child("VTKFile").child("UnstructuredGrid").child("Piece");
  EXPECT_EQ(piece.attribute("NumberOfPoints").as_int(), 45);
  EXPECT_EQ(piece.attribute("NumberOfCells").as_int(), 8 * 4);
  EXPECT_THAT(read_text(folder / "csv/" + name + ".csv"), HasSubstr("sigma_yy"));
  EXPECT_THAT(read_text(folder / "svg/" + name + ".svg"), HasSubstr("<svg"));
  EXPECT_THAT(read_text(folder / "png/" + name + ".png"), StartsWith("\x89PNG"));
  EXPECT_THAT(refusal(field + " --to svg --column sigma_yz"),
              HasSubstr("--column: found \"sigma_yz\", allowed: "));
  EXPECT_THAT(refusal(field + " --to html"), HasSubstr("holds fields"));
}

// Pressures and shears below a heap: no grid, but a line, with the errors that were told.
TEST(ExportForms, AMeasuredFieldBecomesProfilesWithBars) {
  const Folder folder;
  const std::string field = folder / "f.h5", options = " --height 0.08 --slope 30 --rho-g 15000 ";
  ASSERT_EQ(program("import-field " + kSamples + "measured.csv" + options + "-o " + field).code, 0);
  exported(field + " --to svg -o " + (folder / "svg"));
  const std::string both = read_text(folder / "svg/base.svg");
  for (const char* words : {"-sigma_yy (N/m)", "sigma_xy (N/m)", "x (m); bars: standard error",
                            "measured, y = -0.08 m"}) {
    EXPECT_THAT(both, HasSubstr(words));
  }
  exported(field + " --to svg --column sigma_xy -o " + (folder / "one"));
  EXPECT_THAT(read_text(folder / "one/base.svg"), ::testing::Not(HasSubstr("sigma_yy")));
  exported(field + " --to png -o " + (folder / "png"));
  EXPECT_THAT(read_text(folder / "png/base.png"), StartsWith("\x89PNG"));
  // One realization with errors of its own.
  exported(field + " --to csv -o " + (folder / "csv"));
  EXPECT_THAT(
      read_text(folder / "csv/base.csv"),
      HasSubstr("tension positive\nx (m),y (m),sigma_yy (N/m),sigma_yy_error (N/m),sigma_xy (N/m),"
                "sigma_xy_error (N/m)\n"));
}

TEST(ExportForms, AFieldThatIsNoPictureIsLeftOut) {
  const Folder folder;
  const std::string file = folder / "f.h5";
  const auto scattered = [](int dim) {
    Field field;
    field.points = Eigen::MatrixXd::Zero(30, dim);
    for (int k = 0; k < 30; ++k) {
      for (int a = 0; a < dim; ++a) field.points(k, a) = std::fmod(0.618 * (k + 1) * (a + 1), 1.0);
    }
    field.add("sigma_yy", "N/m").value = Eigen::VectorXd::Ones(30);
    return field;
  };
  Field line = scattered(2);
  line.points.col(1).setConstant(-0.5);
  write_fields(file, {{"line", line}, {"clouds", scattered(2)}, {"space", scattered(3)}});
  const Output some = program("export " + file + " --to svg -o " + (folder / "svg"));
  EXPECT_EQ(some.code, 0) << some.err;
  EXPECT_THAT(some.out, HasSubstr("line of "));
  EXPECT_TRUE(testing::fs::exists(folder / "svg/line.svg"));
  EXPECT_FALSE(testing::fs::exists(folder / "svg/clouds.svg"));
  EXPECT_EQ(std::count(some.err.begin(), some.err.end(), '\n'), 2) << some.err;
  EXPECT_THAT(some.err, HasSubstr("left out: f.h5, clouds: 30 points on 30 lines along x, drawn "
                                  "are a grid in the plane, as a map, and up to 8 lines"));
  EXPECT_THAT(refusal(file + ":clouds --to svg"), HasSubstr("30 points on 30 lines along x"));
  EXPECT_THAT(refusal(file + " --to svg --column none"),
              HasSubstr("--column: found \"none\", allowed: sigma_yy"));
}

TEST(ExportForms, ThePageHoldsEveryGrainAndTheMeanStressOfTheAveraging) {
  const dem::Snapshot packing = dem::read_snapshot(kLayer, first_of(kLayer));
  const std::string page = packing_page(packing, "a </script> \"title\"");
  EXPECT_THAT(page, HasSubstr(R"(textContent = "a <\/script> \"title\"";)"));
  const std::size_t first = page.find("const grains = ["), last = page.find("const contacts = [");
  ASSERT_NE(first, std::string::npos);
  const std::string rows = page.substr(first, last - first);
  EXPECT_EQ(static_cast<std::size_t>(std::count(rows.begin(), rows.end(), '\n')),
            packing.grains.size());
  // The mean over the grains' volumes of the mean stress is the packing's: sum F x / dim.
  const GrainNumbers numbers = grain_numbers(packing);
  double all = 0, expected = 0;
  for (std::size_t k = 0; k < packing.grains.size(); ++k) {
    all += numbers.mean_stress[k] * packing.grains[k].volume;
  }
  for (const dem::Contact& c : packing.contacts) {
    const dem::Vec3& from = packing.grains[static_cast<std::size_t>(c.i)].position;
    const dem::Vec3 to =
        c.j >= 0 ? packing.grains[static_cast<std::size_t>(c.j)].position : c.point;
    expected += c.force.dot(from - to) / packing.dim;
  }
  EXPECT_NEAR(all, expected, 1e-9 * std::abs(expected));
  EXPECT_GT(all, 0);
}

TEST(ExportForms, PicturesOfPackings) {
  const Folder folder;
  exported(kHeaps + ":" + first_of(kHeaps) + " --to svg -o " + (folder / "svg"));
  exported(kBox + ":" + first_of(kBox) + " --to png -o " + (folder / "png"));
  const Output page =
      program("export " + kBox + ":" + first_of(kBox) + " --to html -o " + (folder / "html"));
  EXPECT_THAT(page.out, HasSubstr("\n1 file: "));
  EXPECT_THAT(page.out, HasSubstr(".html\n"));
  const Output many = program("export " + kLayer + " --to csv -o " + (folder / "csv"));
  EXPECT_THAT(many.out, HasSubstr(" files: "));
  EXPECT_THAT(many.out, HasSubstr(", ...\n"));
  for (const char* form : {"svg", "png", "html"}) {
    int files = 0;
    for (const auto& entry : testing::fs::directory_iterator(folder / form)) {
      files += entry.path().extension() == std::string(".") + form;
    }
    EXPECT_EQ(files, 1) << form;
  }
}

// An imported packing has no case: its grains, walls and gravity are written, and LAMMPS asks for
// the law.
TEST(ExportForms, ADeckWithoutACaseAsksForTheLaw) {
  const Folder folder;
  for (const std::string& packing :
       {kLayer + ":" + first_of(kLayer), kBox + ":" + first_of(kBox)}) {
    const bool flat = packing.starts_with(kLayer);
    const Output done = program("export " + packing + " --to lammps -o " + (folder / "deck"));
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_THAT(done.err, HasSubstr("note: the packing does not tell its law"));
    const std::string data = read_text(folder / "deck/packing.data"),
                      input = read_text(folder / "deck/in.lammps");
    EXPECT_THAT(data, HasSubstr(" atoms\n2 atom types\n"));
    EXPECT_THAT(input, HasSubstr("pair_style granular\npair_coeff * * ${law}\n"));
    EXPECT_THAT(input, HasSubstr("timestep ${step}\n"));
    EXPECT_THAT(input, HasSubstr("-var law \"hooke K_N GAMMA_N ...\" -var step SECONDS"));
    EXPECT_EQ(input.find("dimension 2\n") != input.npos, flat);
    EXPECT_EQ(input.find("fix plane all enforce2d") != input.npos, flat);
  }
}

// Ids that LAMMPS can have are kept; others are numbered, and a line says so.
TEST(ExportForms, ADeckKeepsIds) {
  const Folder folder;
  for (const auto& [first, told, note] :
       {std::tuple{"7", "7 1 ", ""},
        {"0", "1 1 ", "note: ids are one more than the packing's"},
        {"4294967296", "2 1 ", "note: ids are numbers from 1"}}) {
    const std::string csv = folder.write("g.csv", std::string("id,x,y,radius,density\n") + first +
                                                      ",0,0,0.005,2500\n3,1,0,0.005,2500\n");
    ASSERT_EQ(
        program("import --from csv --without-contacts " + csv + " -o " + (folder / "g.h5")).code,
        0);
    const Output done =
        program("export " + (folder / "g.h5") + " --to lammps -o " + (folder / "deck"));
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_THAT(read_text(folder / "deck/packing.data"), HasSubstr(std::string("\n") + told))
        << first;
    if (*note == 0)
      EXPECT_THAT(done.err, ::testing::Not(HasSubstr("note: ids")));
    else
      EXPECT_THAT(done.err, HasSubstr(note));
  }
}

// A folder keeps the results of one command: what goes is named, what is the user's stays.
TEST(ExportForms, SaysWhatOfAnEarlierCommandIsGone) {
  const Folder folder;
  const std::string one = kLayer + ":" + first_of(kLayer) + " -o " + (folder / "out") + " --to ";
  exported(one + "svg");
  std::string picture;
  for (const auto& entry : testing::fs::directory_iterator(folder / "out")) {
    if (entry.path().extension() == ".svg") picture = entry.path().filename();
  }
  ASSERT_NE(picture, "");
  folder.write("out/mine.svg", "mine");
  const Output same = program("export " + one + "svg");
  EXPECT_EQ(same.err, "");
  const Output other = program("export " + one + "csv");
  EXPECT_EQ(other.code, 0);
  EXPECT_EQ(other.err, "grainfield: " + (folder / "out") +
                           ": a result of an earlier command is gone: " + picture + "\n");
  EXPECT_FALSE(testing::fs::exists(folder / "out/" + picture));
  EXPECT_EQ(read_text(folder / "out/mine.svg"), "mine");
}

TEST(ExportForms, WhatIsNoFormOrNoNameIsSaid) {
  EXPECT_THAT(
      refusal(kLayer + " --to vtk"),
      HasSubstr(
          "--to: found \"vtk\", allowed: lammps, vtu, csv, html, svg, png; did you mean vtu"));
  for (const std::string option : {"--quick", "--copies 2 2", "--set material.young=1"}) {
    EXPECT_THAT(refusal(kLayer + " --to csv " + option),
                HasSubstr(option.substr(0, option.find(' ')) +
                          ": found with --to csv, allowed: with --to lammps alone"));
  }
  EXPECT_THAT(refusal(kLayer + ":nothing --to csv"), HasSubstr("found no \"nothing\", allowed: /"));
  EXPECT_THAT(refusal(kLayer + " " + kLayer + " --to csv"),
              HasSubstr("found 2 files, expected one"));
  EXPECT_THAT(refusal(kLayer + " --to lammps --quick"),
              HasSubstr("--set, --quick: found without a case, allowed: with CASE.toml before"));
}

}  // namespace
}  // namespace grainfield::coupling
