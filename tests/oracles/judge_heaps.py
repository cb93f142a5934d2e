# For pour_lammps.sh, in its folder: do constants and verdict of all heaps hold without each of them,
# and are grains in flight named? Usage: judge_heaps.py HEAPS
import json
import math
import re
import sys

SHOWN = ["osl_yield.mu", "osl.mu", "cantelaube.b1"]
# Fits without a heap begin from their own starts, and lie on places of their own: the mean height is
# another without it. Their jackknife's error is therefore not the quoted one to the digit.
LEAST_SHARE = 0.9
APART = 0.015  # m, three mean diameters: a grain with no other that near, from middle to middle, is in flight
NEAR_FLOOR = 0.02  # m: grains below may roll on the floor

failures = []


def check(holds, text):
    if not holds:
        failures.append(text)


class Fit:
    def __init__(self, name):
        with open(f"{name}.code") as file:
            self.code = int(file.read())
        with open(f"{name}.said") as file:
            self.said = file.read()
        self.summary = {}
        if self.code == 0:
            with open(f"{name}/summary.json") as file:
                self.summary = json.load(file)
        self.sentence = self.summary.get("verdict.sentence", "")
        self.doubts = self.summary.get("verdict.doubts", "")
        self.kept = [key.split(".")[1] for key, value in self.summary.items()
                     if key.startswith("fit.") and key.endswith(".distinguishable") and value != "yes"]
        alone = self.summary.get("verdict.distinguishable") == "yes"
        self.alone = self.summary["verdict.best_model"] if alone else ""

    def constants(self):
        """MODEL.CONSTANT of every constant that is fitted."""
        derived = {"K", "tau_deg", "flank_balance_x", "flank_balance_y"}
        shares = {"chi2_per_dof", "chi2_chance", "rel_l2", "aic_behind", "cv_behind", "cv_behind_error",
                  "heights_behind", "heights_behind_error"}
        found = [re.fullmatch(r"fit\.(\w+\.(\w+))", key) for key in self.summary]
        return [m.group(1) for m in found if m and m.group(2) not in derived | shares
                and not isinstance(self.summary[m.group(0)], str) and m.group(1) != "osl_yield.eta"]

    def value(self, constant):
        return self.summary[f"fit.{constant}"]

    def error(self, constant):
        error = self.summary.get(f"fit.{constant}.error")
        return math.nan if error is None else error

    def verdict(self):
        if self.code != 0:
            return "refused"
        return f"{self.alone} alone" if self.alone else "not distinguishable: " + ", ".join(self.kept)


def judge_constants(whole, without):
    print(f"{'constant':36} {'value':>9} {'error':>9} {'of fits without one':>20}")
    for constant in whole.constants():
        model, name = constant.split(".")
        value, error = whole.value(constant), whole.error(constant)
        others = [fit.value(constant) for fit in without]
        mean = sum(others) / len(others)
        jackknife = math.sqrt((len(others) - 1) / len(others) * sum((x - mean) ** 2 for x in others))
        print(f"{constant:36} {value:9.3g} {error:9.3g} {jackknife:20.3g}")
        if model not in whole.kept:
            continue
        if math.isnan(error):
            check(name in whole.summary[f"fit.{model}.note"], f"{constant} has no error, and no note says why")
        else:
            check(error >= LEAST_SHARE * jackknife,
                  f"{constant}: error {error:.3g}, fits without one heap make it {jackknife:.3g}")
        turned = [k + 1 for k, x in enumerate(others) if x * value < 0]
        said = re.search(rf"The sign of {model} hangs on single realizations: [^.]*\b{name} is ", whole.doubts)
        check(not turned or said, f"{constant} = {value:.3g} has another sign without {turned}, and the verdict is silent")


def judge_verdicts(whole, without):
    for k, fit in enumerate(without, 1):
        check(not fit.alone or fit.alone in whole.kept,
              f"without heap {k} {fit.alone} is supported alone, which all heaps together do not support")
        check(not whole.alone or whole.alone in fit.kept,
              f"all heaps support {whole.alone} alone, those without {k} do not support it")


def in_flight(file):
    """Grains of a LAMMPS dump that no other is near: at least these are in flight."""
    with open(file) as text:
        lines = text.read().split("\n")
    at = max(k for k, line in enumerate(lines) if line.startswith("ITEM: ATOMS"))
    names = lines[at].split()[2:]
    rows = [dict(zip(names, line.split())) for line in lines[at + 1:] if line]
    places = [(float(row["x"]), float(row["y"])) for row in rows]
    cells = {}
    for k, (x, y) in enumerate(places):
        cells.setdefault((int(x // APART), int(y // APART)), []).append(k)
    alone = []
    for k, (x, y) in enumerate(places):
        if y < NEAR_FLOOR:
            continue
        column, row = int(x // APART), int(y // APART)
        around = [other for i in (-1, 0, 1) for j in (-1, 0, 1) for other in cells.get((column + i, row + j), [])]
        if all(other == k or math.hypot(places[other][0] - x, places[other][1] - y) > APART for other in around):
            alone.append(int(rows[k]["id"]))
    return alone


def judge_flying(flying, whole, heaps):
    seen = 0
    for seed in range(4001, 4001 + heaps):
        alone = in_flight(f"flying_{seed}.grains")
        seen += len(alone)
        named = re.search(rf"flying_{seed}.h5:/pile: (\d+) grains? in flight[^\n]*id \d+ at x = ", flying.said)
        print(f"flying_{seed}: {len(alone)} grains far from all others; named in flight: "
              f"{named.group(1) if named else 'none'}")
        if flying.code == 0:
            check(not alone or (named and int(named.group(1)) >= len(alone)),
                  f"flying_{seed}: grains {alone} are in flight, and fit does not name them")
    check(seen >= 3 * heaps, f"{seen} grains are far from all others, three a heap are expected")
    check(flying.code in (0, 2), f"fit of flying heaps ended with {flying.code}")
    if flying.code == 0:
        slope, rest = flying.summary["fit.slope_deg"], whole.summary["fit.slope_deg"]
        check(abs(slope - rest) < 5, f"slope {slope:.3g} with grains in flight, {rest:.3g} at rest")


heaps = int(sys.argv[1])
whole = Fit("all")
without = [Fit(f"without_{k}") for k in range(1, heaps + 1)]
flying = Fit("flying")
for name, fit in [("all", whole)] + [(f"without_{k}", f) for k, f in enumerate(without, 1)]:
    if fit.code != 0:
        sys.exit(f"fit of {name} ended with {fit.code}:\n{fit.said}")
judge_constants(whole, without)
judge_verdicts(whole, without)
judge_flying(flying, whole, heaps)
print("\n| heaps | verdict | " + " | ".join(SHOWN) + " |\n|---|---|" + "---|" * len(SHOWN))
for name, fit in [("all", whole)] + [(f"without {k}", f) for k, f in enumerate(without, 1)] + [("in flight", flying)]:
    cells = [f"{fit.value(c):+.2f} ± {fit.error(c):.2f}" if fit.code == 0 else "-" for c in SHOWN]
    print(f"| {name} | {fit.verdict()} | " + " | ".join(cells) + " |")
print(f"\nall: {whole.sentence}\nin flight: {flying.said}")
if failures:
    sys.exit("\n".join(failures))
