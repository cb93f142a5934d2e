// One process and two ranks: the same answer for everybody.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "continuum/fe_models.h"
#include "continuum/model.h"

using namespace grainfield::continuum;

namespace {

constexpr char kFolder[] = "GRAINFIELD_RANKS_TEST_FOLDER";  // set for the ranks that a test starts

Points base() {
  Points points(9, 2);
  for (int i = 0; i < 9; ++i) points.row(i) << 0.25 * i - 1, -1;
  return points;
}

Stresses solve(Ranks ranks) {
  solve_on(ranks);
  const auto model = make_model("fe_elastic_layer", {{"base", "rough"}});
  solve_on(Ranks::all);  // a model keeps the choice it was made with
  return model->stress(base());
}

void write(const std::string& file, const Stresses& stresses) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(stresses.data()),
             static_cast<std::streamsize>(sizeof(double)) * stresses.size());
}

Stresses read(const std::string& file) {
  Stresses stresses(base().rows(), 3);
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(stresses.data()),
          static_cast<std::streamsize>(sizeof(double)) * stresses.size());
  EXPECT_TRUE(in.good()) << file;
  return stresses;
}

}  // namespace

TEST(FeRanks, EveryRankGetsTheCompleteResult) {
  if (const char* folder = std::getenv(kFolder)) {
    const std::string rank = std::getenv("OMPI_COMM_WORLD_RANK");
    write(std::string(folder) + "/all" + rank, solve(Ranks::all));
    write(std::string(folder) + "/own" + rank, solve(Ranks::own));
    return;
  }
  const Stresses alone = solve(Ranks::all);
  const auto folder =
      std::filesystem::temp_directory_path() / ("grainfield_ranks_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  // A clean environment: this process is itself an MPI job, whose variables must not reach mpirun.
  const char* path = std::getenv("PATH");
  const std::string command =
      "env -i PATH='" + std::string(path ? path : "/usr/bin:/bin") + "' HOME=/tmp " + kFolder +
      "=" + folder.string() +
      " ASAN_OPTIONS=detect_leaks=0 mpirun --allow-run-as-root --oversubscribe " + "-np 2 " +
      std::filesystem::read_symlink("/proc/self/exe").string() + " fe_ranks_test > " +
      (folder / "log").string() + " 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0) << std::ifstream(folder / "log").rdbuf();
  // The ranks share the mesh, whose adaptive refinement then differs a little: within tolerance.
  EXPECT_EQ(read(folder / "all0"), read(folder / "all1"));
  EXPECT_LT((read(folder / "all0") - alone).cwiseAbs().maxCoeff(), 5e-4);
  EXPECT_EQ(read(folder / "own0"), alone);
  EXPECT_EQ(read(folder / "own1"), alone);
  std::filesystem::remove_all(folder);
}
