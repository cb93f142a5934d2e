#!/usr/bin/python3
"""Makes docs/reproduction.md, the sources' figures beside ours.

    docs/reproduction/page.py                  writes the page
    docs/reproduction/page.py --check          says whether the page is what it would write
    docs/reproduction/page.py --add RUN ...    takes finished runs in first: their summaries, profiles
                                               and pictures go to docs/reproduction/results/

The sources' figures are in figures/*.toml; how ours are read and judged is in rows.py. Ends with 0, with 1
where --check finds another page, with 2 where it cannot. Needs Python 3.11 and scipy.
"""
from __future__ import annotations

import argparse
import math
import pathlib
import re
import sys
import tomllib
from collections import Counter

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from record import record_run, write_file  # noqa: E402
from rows import FILES, NOT_RUN, TOO_WIDE, Row, all_rows, band, judged, read_toml, unanswered, with_unit  # noqa: E402
from scipy import stats  # noqa: E402
from summaries import NAN, Measured, Refused, Results, holm  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
PAGE = HERE.parent / "reproduction.md"
PREDICTION = "pile-predictions"
NO_COMMAND = "run before commands were stored: see the case's page"

INTRODUCTION = (
    "# Figures of the sources beside ours\n\n"
    "Does grainfield find what its three sources found? The first table counts the figures of each part. The "
    "tables after it put every figure beside ours.\n\n")

JUDGED = f"""
"Cannot tell" means that our spread is too wide, or that the result is compatible with both answers. "Without a
result" means not run or not measured; the row says which.

**How agreement is judged**

- **Errors** are standard errors over realizations. Intervals have a probability of 95 % by Student's t. Eight
  realizations give 2.4 standard errors, three give 4.3 and two give 12.7.
- **Numbers.** A number agrees when ours lies in the band, and differs when our whole interval lies outside. The band
  is the source's value with its reading error: 1° for angles, 0.01 for fractions, 25 % where the source says "about".
- **Spread too wide to tell**: ours lies outside the band and our interval reaches into it, or ours lies inside, our
  interval reaches out of it, and its half exceeds {100 * TOO_WIDE:.0f} % of the source's value. For the ratios of volume fraction and coordination, the effect that the source reports replaces the value
  (0.09, 0.08, 0.04). In a band without an end our whole interval must lie.
- **Tested rows.** Where the source says how many piles its number is the mean of, that mean has an error as well: the
  scatter of ours over the root of their number. A row differs when p < 0.05 for a miss of the band this large, of
  either sign (Student's t), corrected for all tested rows of this page (Holm). It agrees when p of this row alone is
  above 0.05 and our interval excludes what the row is to tell apart: no dip, the constant of the other source, or
  without such a value half of the number. Otherwise it is uninformative. The number of piles is that of ours that
  would see this difference with a probability of 80 % at the first step of Holm's correction.
- **Recorded strains.** Some strains are known only to the distance of the recorded states. A miss within half of
  this distance cannot tell.
- **Dips and peaks** are significant at 5 % over [all pours together](#dips-and-peaks-of-all-pours). A peak also
  counts as "no dip". The result "neither" is uninformative: it is compatible with a dip and with no dip. Every p
  of a difference of pressures on this page is two-sided. The key `dip.p_value` of a summary is one-sided: it is half
  of that for a dip, and one minus half of it for a peak. A p of a tail or of a fit asks only for a worse fit.
- **Fits.** A fit is beyond the errors when its χ²/dof exceeds the value that a true model exceeds in 1 of 100
  ensembles. The fits of the point source, of OSL and of the asymmetric piles used other weights: there it is
  1.35 of 1,000.
- **Fitted constants** have the larger of two errors, the fit's own and the bootstrap's over piles. The fit's own is
  the jackknife's; with the other weights it is the covariance's.
- **Ratios of two ensembles** have the error of the one minus the source's ratio times the other.
- **Peaks on the base of several layers.** Two peaks count where the pressure below the load is below the largest one
  beyond our interval, one peak where our interval excludes a dip by a quarter. Otherwise the spread is too wide.
- **"Hardly changes"** means by less than a tenth in our whole interval. "Changes" means by more than a tenth in our
  whole interval. Between them the spread is too wide to tell. "Negligible" means less than a tenth of the
  effect of μ, likewise.
- **Variants of Wellmann's packings** are compared packing by packing: the error is that of the mean difference or
  ratio over the packings that both have.
- **A sheared sample that collapses**, its mean stress below a tenth of its start, agrees with nothing.
- **Causes.** Some rows that differ end with the cause, or with what was tried in vain. Behind a change is what ours
  becomes by it alone.
- **The steeper flank** is the flank with the larger mean, on whichever side. The study's page says which side was
  meant.
- **Nothing was tuned to agree.** What counts as theirs in Roul's section 1.3 and figures 2.3, 2.4, 3.4, 3.5, 3.7, 3.8,
  3.19, 3.20, 3.25, 3.26, 3.29, 5.13 and 5.15 and, of N beside H and of H beside a row, in Liffman's 13 and 14 was
  written when our values were known. In 3.29 and 5.15 values of 24 to 26 % stand beside a limit of 25 %.

The script `docs/reproduction/page.py` makes this page. It reads the sources' figures from
`docs/reproduction/figures/` and ours from `docs/reproduction/results/`: `CASE.json` is the `summary.json` of
`grainfield run cases/CASE.toml`. `page.py --add RUN` takes in the summary, the profiles and the pictures of a
finished run.
"""

HEADER = ("| source | figure | theirs | counts as theirs | ours | agreement | realizations | study |\n"
          "|---|---|---|---|---|---|---|---|\n")


def number(results: Results, study: str, key: str, form: str) -> str:
    """A number of a summary; empty where there is none."""
    value = results.plain(study, key)
    return "" if value is None or math.isnan(value) else format(value, form)


def grains_of(results: Results, study: str) -> float | None:
    """Of a run, or of all members of a sweep where they have the same number."""
    own = results.plain(study, "dem.grains")
    if own is not None:
        return own
    of_members = {value for key, value in results.all[study].items() if key.startswith("dem.grains.least.")}
    return of_members.pop() if len(of_members) == 1 else None


def study_cell(results: Results, study: str) -> str:
    """`box-shear`, or of a quick run `box-shear` (quick, 200 grains)."""
    if " --quick" not in (results.text(study, "case.command") or ""):
        return f"`{study}`"
    grains = grains_of(results, study)
    return f"`{study}` (quick" + ("" if grains is None else f", {grains:.0f} grains") + ")"


def grain_seconds(results: Results, study: str) -> str:
    """What the grains took: CPU time where every start was counted."""
    cpu = number(results, study, "time.dem_cpu_s", ".0f")
    if cpu:
        return cpu + " CPU"
    wall = results.plain(study, "time.dem_s")
    if wall is None or math.isnan(wall):
        return ""
    return "taken up again, not counted" if wall < 1 else f"{wall:.0f} wall"


def figure_line(row: Row, results: Results) -> tuple[str, str]:
    """A line of a table, and its agreement."""
    ours, said = judged(row, results)
    study, lacking = row["study"], said == ""
    count = None if lacking else results.realizations(study, row.get("member", row.get("to", "")))
    realizations = "" if count is None or math.isnan(count) else f"{count:g}"
    cells = [row["source"], row["what"], with_unit(row["theirs"], row), band(row), ours, said, realizations,
             study_cell(results, study)]
    return "| " + " | ".join(cells) + " |\n", said


def dips(results: Results) -> str:
    """All ensembles' dips, also those that the sources do not have."""
    found = results.dips()
    if not found:
        return ""
    out = (
        "\n## Dips and peaks of all pours\n\n"
        "The difference is the mean base pressure beside the apex minus that under it, over ρ g h of each pile. "
        "If there were no dip or peak, a difference this large, of either sign, would occur by chance with "
        "probability p (Student's t over realizations). The next column corrects p for all "
        f"{len(found)} pours of this table (Holm); the last one decides. Those of `pours` are measured by "
        "`docs/reproduction/pours.py` in stored states.\n\n"
        "| study | realizations | shoulder − centre (ρgh) | p | p (Holm) | at 5 % |\n"
        "|---|---|---|---|---|---|\n")
    for dip in found:
        name = f"`{dip.study}`" + (f", `{dip.member}`" if dip.member else "")
        count = dip.difference.freedom + 1
        out += (f"| {name} | {count:g} |" if math.isfinite(count) else f"| {name} |  |")
        out += (f" {dip.difference.value:.3f} ± {dip.difference.error:.3f} "
                f"| {dip.p:.2g} | {dip.p_holm:.2g} | {dip.word} |\n")
    return out


def verdicts(results: Results, studies: list[str]) -> str:
    """What the studies themselves conclude."""
    lines = ""
    kept = {fit["name"] for fit in tomllib.loads((HERE / "states/fits.toml").read_text())["fit"]}
    for study in studies:
        sentence = results.text(study, "verdict.sentence")
        if sentence and study.startswith("fit-"):  # dips have a table of their own
            judge = ("" if study in kept else
                     f" (states lost, judge of version {results.text(study, 'version')})")
            models = re.sub(r"^The heaps have .*? of ensembles\. ", "", sentence)
            lines += f"- `{study}`{judge}: {models}\n"
    if not lines:
        return ""
    return (
        "\n## Which theory the grains support\n\n"
        "`docs/reproduction/states/judge.py PROGRAM` judges the ensembles anew whose states are kept. The other "
        "verdicts are by the judge of their version: where no model agrees, \"supported\" meant the nearest of the "
        "models asked.\n\n"
        + lines +
        "\nLayers under a point load: [verdict over all packings](cases/point-load-verdict.md); lattice "
        "piles: [Liffman](cases/liffman-lattice.md).\n")


#: Models of predict.py, in words.
PREDICTED = {"layers": "`fe_mohr_coulomb_wedge`, measured map, in layers along the slopes",
             "at_once": "the same, gravity on the whole heap", "even": "the same, one measured ν and no map",
             "core": "`fe_cantelaube_core`, β̂ fitted above the base", "zero": "`cantelaube`, branch zero",
             "minus": "`cantelaube`, branch minus", "plus": "`cantelaube`, branch plus", "bcc": "`bcc`", "fpa": "`fpa`"}


def predictions(results: Results) -> str:
    """What models say of heaps by their own constants, beside what was measured afterwards."""
    every = results.all.get(PREDICTION, {})
    names = [key.removesuffix(".realizations") for key in every if key.endswith(".realizations")]
    rows = [(name, model) for name in names for model in PREDICTED if f"{name}.{model}.dip_miss" in every]
    if not rows:
        return ""
    p_values = {}
    for name, model in rows:
        for figure in ("dip", "axis_ratio"):
            miss = predicted(results, name, f"{model}.{figure}_miss", f"{model}.{figure}.piles")
            p_values[name, model, figure] = float(2 * stats.t.sf(abs(miss.value) / miss.error, miss.freedom))
    p_values = {key: p for key, p in p_values.items() if math.isfinite(p)}
    corrected = dict(zip(p_values, holm(list(p_values.values()))))

    def cell(name: str, model: str, figure: str) -> str:
        told = predicted(results, name, f"{model}.{figure}", f"{model}.{figure}.piles")
        if not math.isfinite(told.value):
            return "no equilibrium found"
        p = corrected[name, model, figure]
        return f"{told.value:.3f} ± {told.error:.3f}, " + ("differs" if p < 0.05 else "within") + f" (p = {p:.2g})"

    out = (
        "\n## What continuum models predict of heaps\n\n"
        "`docs/reproduction/predict.py` gives each heap's own slopes, E, ν and β̂ to the models, none of which sees "
        "the pressure on the base. A prediction is committed before it is compared. A model differs where its mean "
        "miss, heap by heap, has p < 0.05 (Student's t, two-sided, Holm over the table).\n\n"
        "| heaps | model | shoulder − centre (ρgh) | σxx/σyy on the axis | heaps that have an answer |\n"
        "|---|---|---|---|---|\n")
    for name in names:
        own = [predicted(results, name, f"measured.{figure}", "realizations") for figure in ("dip", "axis_ratio")]
        out += f"| {name} | measured | " + " | ".join(f"**{one.value:.3f} ± {one.error:.3f}**" for one in own)
        out += f" | {every[f'{name}.realizations']:g} |\n"
        for model in (model for of, model in rows if of == name):
            out += (f"| {name} | {PREDICTED[model]} | {cell(name, model, 'dip')} | {cell(name, model, 'axis_ratio')} "
                    f"| {every[f'{name}.{model}.dip.piles']:g} |\n")
    return out


def predicted(results: Results, name: str, key: str, count: str) -> Measured:
    """A number of results/pile-predictions.json."""
    value, error, piles = (results.plain(PREDICTION, f"{name}.{of}") for of in (key, f"{key}.standard_error", count))
    return Measured(value, NAN if error is None else error, piles - 1)


def profiles_and_maps(results: Results, studies: list[str]) -> str:
    """Links to the profiles and the pictures themselves, of the studies that have them."""
    out = ""
    for study in studies:
        links = pictures = ""
        for file in results.beside(study):
            path = f"reproduction/results/{file}"
            if file.endswith(".md"):
                links += f" ([profiles as tables]({path}))"
            elif file.endswith((".svg", ".png")):
                pictures += f"![{file[len(study) + 1 : file.rindex('.')]}]({path})\n"
        if pictures:
            out += f"`{study}`{links}:\n\n{pictures}\n"
    if not out:
        return ""
    return ("\n## Base pressure and volume fraction\n\n"
            "To be compared with Roul's figures 3.9 to 3.13. They show means over the piles with standard errors. "
            "The pressure is in units of each pile's own ρ g h.\n\n" + out)


def how_run(results: Results, studies: list[str]) -> str:
    out = (
        "\n## How they were run\n\n"
        "Grain-steps count every grain, asleep or not. Roul's interval between grains was 0.1 s, his time step "
        "2e-6 s. A sleeping grain may hide a part of its load, by its limit:\n\n"
        "- Nothing, because every grain is awake: `pile-line-source`, `pile-asymmetric-line`. With sleep the levels of "
        "the former miss [1 % of the weight above](sleeping.md), and an eighth by the defaults before version 868ed2cb.\n"
        "- About 20 %, an older default: `pile-point-source`, `pile-elliptic`, `pile-asymmetric-point`, and the "
        "piles of `pile-fields-line` (but for figure 3.4, which has those of `pile-line-source`).\n"
        "- 5 %, set in the case: `liffman-dropped`.\n\n"
        "With the older default small piles came out denser than with all grains awake: by 0.3 % from a line "
        "source, by 1 % from a funnel at 0.1 s. Without a reach of waking they were denser still ([what sleeping "
        "changes](cases/pile-rest-detection.md)).\n\n"
        "| study | grains | realizations | interval (s) | reach of waking | time step (s) | steps | "
        "grain-steps | time of the grains (s) | base force / weight | version | command |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|\n")
    for study in studies:
        if not results.has(study):
            out += f"| `{study}` | {NOT_RUN} |" + " |" * 10 + "\n"
            continue
        command = results.text(study, "case.command")
        cells = [number(results, study, key, form) for key, form in (
            ("dem.grains", ".0f"), ("ensemble.realizations", "g"), ("source.interval", "g"),
            ("sleep.wake_reach", "g"), ("dem.time_step", ".3g"), ("dem.steps", ".4g"),
            ("dem.grain_steps", ".3g"))]
        cells += [grain_seconds(results, study), number(results, study, "base.weight_ratio", ".6f"),
                  results.text(study, "version") or "",
                  "`" + command.replace("|", "\\|") + "`" if command else NO_COMMAND]
        out += f"| `{study}` | " + " | ".join(cells) + " |\n"
    return out


def misprints() -> str:
    out = ("\n## Misprints and inconsistencies of the sources\n\n"
           "They were found when the field equations were derived again. The program uses the last column.\n\n"
           "| where | printed | correct |\n|---|---|---|\n")
    for one in read_toml("misprints")["misprint"]:
        out += f"| {one['where']} | {one['printed']} | {one['correct']} |\n"
    return out


def kind(said: str) -> str:
    """Agreement in a word: agrees, differs, silent (no statement) or open (no result)."""
    if not said:
        return "open"
    word = said.partition(";")[0].split()[0]
    return word if word in ("agrees", "differs") else "silent"


def tables(results: Results) -> str:
    """How many rows agree, then the rows of each part."""
    counts = ("| part | figures | agree | differ | cannot tell | without a result |\n"
              "|---|---|---|---|---|---|\n")
    total, out = Counter(), ""
    for name in FILES:
        part = read_toml(name)
        lines, said = zip(*(figure_line(row, results) for row in part["figure"]))
        count = Counter(map(kind, said))
        total += count
        out += f"\n## {part['title']}\n\n{HEADER}" + "".join(lines)
        counts += count_line(f"[{part['title']}](#{anchor(part['title'])})", count)
    return counts + count_line("all", total) + missing(results) + JUDGED + out


def missing(results: Results) -> str:
    """Which figures of the sources have no result, and why some cannot."""
    lacking, why = unanswered(results), [(source, figure, sentence) for source, listed in read_toml("sources").items()
                                         for figure, sentence in listed["sentences"].items()]
    out = f"\nFigures without a result: {', '.join(lacking)}.\n" if lacking else "\nEvery figure has a row with a result.\n"
    return out + "".join(f"{source} {figure}: {sentence}\n" for source, figure, sentence in why)


def anchor(title: str) -> str:
    """Of a heading, as GitHub makes it."""
    return re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-")


def count_line(part: str, count: Counter[str]) -> str:
    cells = [sum(count.values()), *(count[word] for word in ("agrees", "differs", "silent", "open"))]
    return f"| {part} | " + " | ".join(map(str, cells)) + " |\n"


def page(results: Results) -> str:
    """The page: every figure of the sources beside ours, and how each study was run."""
    studies = list(dict.fromkeys(row["study"] for row in all_rows()))
    return (INTRODUCTION + tables(results) + dips(results) + verdicts(results, studies) + predictions(results)
            + profiles_and_maps(results, studies) + how_run(results, studies) + misprints())


def main(words: list[str] | None = None) -> int:
    options = argparse.ArgumentParser(description="Makes docs/reproduction.md, the sources' figures beside ours.")
    options.add_argument("--add", type=pathlib.Path, action="append", default=[], metavar="RUN",
                         help="folder of a finished run, taken in first; may be given several times")
    options.add_argument("--check", action="store_true", help="write nothing: compare the page")
    options.add_argument("--results", type=pathlib.Path, default=HERE / "results", metavar="DIR",
                         help="the summaries; default: docs/reproduction/results")
    options.add_argument("-o", "--output", type=pathlib.Path, default=PAGE, metavar="FILE",
                         help="the page; default: docs/reproduction.md")
    given = options.parse_args(words)
    try:
        for run in given.add:
            for file in record_run(run, given.results):
                print(file)
        made = page(Results(given.results)).encode()
        if given.check:
            same = given.output.exists() and given.output.read_bytes() == made
            print(f"{given.output}: " + ("up to date" if same else "differs; docs/reproduction/page.py writes it"))
            return 0 if same else 1
        write_file(given.output, made)
        print(given.output)
        return 0
    except (Refused, OSError) as error:
        print(f"page.py: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
