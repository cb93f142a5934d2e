// A team of threads: all take part; those that cannot be started are an error and no end of the
// program.
#include "dem/engine/thread_team.h"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

namespace grainfield::dem {
namespace {

TEST(ThreadTeam, MoreThreadsThanCanBeStarted) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer takes more address space for a thread than is left here";
#endif
  const pid_t child = fork();
  if (child == 0) {
    // Room for a few stacks of 8 MB beyond what is taken.
    std::FILE* in = std::fopen("/proc/self/statm", "r");
    double pages = 0;
    if (in == nullptr || std::fscanf(in, "%lf", &pages) != 1) _exit(2);
    const auto room =
        static_cast<rlim_t>(pages * static_cast<double>(sysconf(_SC_PAGESIZE)) + 40e6);
    const rlimit limit{room, room};
    if (setrlimit(RLIMIT_AS, &limit) != 0) _exit(2);
    try {
      const ThreadTeam team(1000);
    } catch (const std::runtime_error& e) {
      const std::string what = e.what();
      _exit(what.starts_with("--threads: only ") && what.find(" of 1000 threads") < 30 ? 0 : 3);
    }
    _exit(4);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

TEST(ThreadTeam, AllTakePart) {
  ThreadTeam team(3);
  std::atomic<int> sum = 0;
  team.run([&](int rank) {
    sum += 1 << rank;
    team.barrier();
    if (sum != 7) sum = -100;
  });
  EXPECT_EQ(sum, 7);
}

TEST(ThreadTeam, OneHandsOutPartsOfItsTask) {
  for (const int size : {1, 2, 5}) {
    ThreadTeam team(size);
    std::vector<int> done(static_cast<std::size_t>(size), 0);
    int by_hand = 0;
    team.together([&](int rank) { ++done[rank]; });  // outside of work
    team.run([&](int rank) {
      for (int step = 0; step < 40; ++step) {
        const int before = step * (step - 1) / 2;  // parts of all steps so far
        team.alone(rank, [&] {
          ++by_hand;
          for (int part = 0; part < step; ++part) {
            team.together([&](int one) {
              ++done[one];
              team.barrier();
              if (*std::min_element(done.begin(), done.end()) != 2 + before + part) {
                by_hand = -1000;
              }
              team.barrier();
            });
          }
        });
      }
    });
    EXPECT_EQ(by_hand, 40);
    EXPECT_THAT(done, testing::Each(1 + 39 * 40 / 2));
  }
}

TEST(ThreadTeam, WhatAPartThrowsArrivesAndTheTeamGoesOn) {
  for (const int size : {1, 3}) {
    ThreadTeam team(size);
    const auto fail = [&](int rank) {
      if (rank == size - 1) throw std::bad_alloc();
    };
    EXPECT_THROW(team.together(fail), std::bad_alloc);
    int caught = 0;
    team.run([&](int rank) {
      team.alone(rank, [&] {
        try {
          team.together(fail);
        } catch (const std::bad_alloc&) {
          ++caught;
        }
      });
    });
    EXPECT_EQ(caught, 1);
    std::atomic<int> done = 0;
    team.together([&](int) { ++done; });
    EXPECT_EQ(done, size);
  }
}

}  // namespace
}  // namespace grainfield::dem
