// Fields with wrong bytes: each is noticed, or changes nothing.
#include <gmock/gmock.h>

#include "coupling/store/field_io.h"
#include "dem/checkpoint/checkpoint.h"
#include "tests/damaged_files.h"

namespace grainfield::coupling {
namespace {

using grainfield::testing::Damage;
using grainfield::testing::flip_bytes;
using grainfield::testing::TestFolder;
using ::testing::HasSubstr;

Field sample() {
  Field field;
  field.points = Eigen::MatrixXd::Random(12, 2);
  field.nx = 4;
  field.ny = 3;
  field.realizations = 3;
  field.attributes = {
      {"method", "coarse_graining"}, {"h", 0.3}, {"left_deg", std::vector<double>{25, 26, 27}}};
  for (const char* name : {"sigma_xx", "sigma_yy"}) {
    Column& column = field.add(name, "N/m");
    column.value = Eigen::VectorXd::Random(12);
    column.error = Eigen::VectorXd::Random(12).cwiseAbs();
    column.samples = Eigen::MatrixXd::Random(12, 3);
  }
  field.add("density", "1").value[3] = 2;
  return field;
}

std::string bits_of(const std::string& file) {
  dem::CheckpointWriter w;
  const auto put = [&](const auto& matrix) {
    w.put(static_cast<long>(matrix.rows()));
    for (Eigen::Index k = 0; k < matrix.size(); ++k) w.put(matrix(k));
  };
  for (const std::string& name : list_fields(file)) {
    const Field field = read_field(file, name);
    w.put(name);
    put(Eigen::MatrixXd(field.points).reshaped());
    for (const int n : {field.nx, field.ny, field.realizations}) w.put(n);
    for (const auto& [key, value] : field.attributes) {
      w.put(key);
      w.put(attribute_text(value));
    }
    for (const Column& column : field.columns) {
      w.put(column.name);
      w.put(column.unit);
      put(column.value);
      put(column.error);
      put(Eigen::MatrixXd(column.samples).reshaped());
    }
  }
  return w.bytes();
}

TEST(DamagedField, AWrongByteIsNoticedOrChangesNothing) {
  const TestFolder folder;
  write_fields(folder / "f.h5", {{"map", sample()}, {"profile", sample()}});
  Damage found;
  flip_bytes(folder / "f.h5", folder, 509, true, bits_of, found);
  EXPECT_GT(found.copies, 200);
  EXPECT_GT(found.refused, found.copies / 4);
}

// What no computation leaves, and no model or fit could use.
TEST(DamagedField, NumbersThatCannotBeAreRefused) {
  const TestFolder folder;
  const auto refused = [&](const auto& change, const std::string& what) {
    Field field = sample();
    change(field);
    write_fields(folder / "f.h5", {{"map", field}});
    try {
      read_field(folder / "f.h5", "map");
      ADD_FAILURE() << what;
    } catch (const std::invalid_argument& e) {
      EXPECT_EQ(e.what(), folder / "f.h5" + ":/map: " + what);
    }
  };
  refused([](Field& f) { f.points(3, 1) = NAN; },
          "points: found nan, allowed: up to 1e100 in size");
  refused([](Field& f) { f.columns[0].value[2] = 1e300; },
          "value/sigma_xx: found 1e+300, allowed: up to 1e100 in size, or nan");
  refused([](Field& f) { f.columns[1].error[2] = -1; },
          "error/sigma_yy: found -1, allowed: 0 to 1e100, or nan");
  refused([](Field& f) { f.columns[1].samples(2, 1) = -INFINITY; },
          "samples/sigma_yy: found -inf, allowed: up to 1e100 in size, or nan");
}

TEST(DamagedField, OneWithoutChecksumsDoesNotEndTheProgram) {
  const TestFolder folder;
  write_fields(folder / "f.h5", {{"map", sample()}});
  const std::string plain = folder / "plain.h5";
  grainfield::testing::copy_plainly(folder / "f.h5", plain);
  EXPECT_TRUE(bits_of(plain) == bits_of(folder / "f.h5"));
  Damage found;
  flip_bytes(plain, folder, 83, false, bits_of, found);
  EXPECT_GT(found.copies, 200);
  EXPECT_GT(found.refused, 20);
}

// What would divide by zero, or take the memory of a column many times over.
TEST(DamagedField, NumbersThatCannotBeAreNamed) {
  const TestFolder folder;
  const auto said = [&](const char* attribute, const auto& value) -> std::string {
    const std::string file = folder / "f.h5";
    write_fields(file, {{"map", sample()}});
    {
      const dem::hdf5::Handle out = dem::hdf5::open_for_adding(file);
      const dem::hdf5::Handle map = dem::hdf5::open_group(out, "map");
      H5Adelete(map, attribute);
      dem::hdf5::write_attribute(map, attribute, value);
    }
    try {
      read_field(file, "map");
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "nothing";
  };
  EXPECT_THAT(said("realizations", 0.0), HasSubstr("\"realizations\" is 0; allowed are 1 and"));
  EXPECT_THAT(said("nx", -4.0), HasSubstr("\"nx\" is -4; allowed are 0 and above"));
  EXPECT_THAT(said("ny", 1e12), HasSubstr("\"ny\" is 1000000000000"));
  EXPECT_THAT(said("dim", 0.5), HasSubstr("'dim' is 0.5; it must be a whole number"));
  EXPECT_THAT(said("dim", std::nan("")), HasSubstr("'dim' is nan; it must be a whole number"));
  EXPECT_THAT(said("columns", std::string("density,density")),
              HasSubstr("column \"density\" is named twice"));
}

}  // namespace
}  // namespace grainfield::coupling
