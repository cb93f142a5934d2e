#!/usr/bin/env python3
"""Is a build slower than another? Scenes of dem_benchmark by both, interleaved, each round in the
other order: the ratio of speeds new/old, median and 95 % lower bound (one-sided, Student's t of the
logarithms). Exit code 1 when the bound of a scene is below the least ratio.

    tests/benchmarks/against_before.py OLD/dem_benchmark NEW/dem_benchmark disks_10k hertz_spheres_10k

GRAINFIELD_LANES chooses the width. Needs a machine that does nothing else.
"""
import argparse
import csv
import math
import os
import statistics
import subprocess
import sys
import tempfile

STUDENT = {5: 2.132, 7: 1.943, 9: 1.860, 11: 1.812, 13: 1.782, 15: 1.761, 21: 1.725}


def speed(program, scene, seconds):
    command = [program, f"--benchmark_filter=^{scene}/1/", f"--benchmark_min_time={seconds}",
               "--benchmark_format=csv"]
    out = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    lines = out[out.index("name,"):].splitlines()
    return float(next(csv.DictReader(lines))["grain_steps"])


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--rounds", type=int, default=11, choices=sorted(STUDENT))
    parser.add_argument("--seconds", type=float, default=3, help="least time of a measurement")
    parser.add_argument("--least", type=float, default=0.97, help="least ratio")
    options = parser.parse_args()
    slower = False
    with tempfile.TemporaryDirectory() as work:
        # Spheres are settled once, by the old program, and read by every measurement.
        os.environ.setdefault("GRAINFIELD_SPHERES", os.path.join(work, "spheres.h5"))
        for scene in options.scenes:
            speed(options.old, scene, 0.01)
            ratios, speeds = [], {options.old: [], options.new: []}
            for turn in range(options.rounds):
                pair = [options.old, options.new]
                for program in pair if turn % 2 == 0 else reversed(pair):
                    speeds[program].append(speed(program, scene, options.seconds))
                ratios.append(speeds[options.new][-1] / speeds[options.old][-1])
            logs = [math.log(r) for r in ratios]
            error = statistics.stdev(logs) / math.sqrt(options.rounds)
            bound = math.exp(statistics.mean(logs) - STUDENT[options.rounds] * error)
            slower |= bound < options.least
            old, new = (statistics.median(speeds[p]) / 1e6 for p in (options.old, options.new))
            print(f"{scene}: old {old:.2f}, new {new:.2f} million grain-steps/s, ratio "
                  f"{statistics.median(ratios):.4f} (median of {options.rounds}, "
                  f"{min(ratios):.4f} to {max(ratios):.4f}), 95 % lower bound {bound:.4f}",
                  flush=True)
    return 1 if slower else 0


if __name__ == "__main__":
    sys.exit(main())
