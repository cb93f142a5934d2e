"""A row of a table: a source's figure (figures/*.toml), ours, and whether both agree.

A row is a number or a word. A number has `range`, the source's value with its reading error, and
`key`, ours; `effect` is what a ratio's distance from 1 says in the source. A word comes from a number by
`limits`, or from a rule by name; `agrees` lists the words of ours that agree with the source's. A row that
has no result says in `gap` why: "not run", or "not measured" where no study has such a figure. A word
with `single` has no error over realizations, and decides nothing. `cause` says why a row differs, and
"{KEY@MEMBER}" in it becomes that number; a row that does not differ does not show it. Where a study has CAUSES, the
row adds what it becomes when one thing changes, or, without a cause, says "cause not found; tried: ...". A number
with `piles` is tested: that many piles of the source gave its value, so its mean has an error, too, which is taken by the scatter of ours; `alternative` is the
value that the row is to tell from it.
"""
from __future__ import annotations

import math
import pathlib
import re
import tomllib
from dataclasses import replace
from typing import Any, Callable

from scipy import stats

from summaries import NAN, Measured, Refused, Results, holm

FOLDER = pathlib.Path(__file__).resolve().parent / "figures"
#: In the order of the page.
FILES = ("roul-piles", "roul-fits", "roul-layers", "wellmann", "liffman")
NOT_RUN = "not run"
WIDE = "spread too wide to tell"
COARSE = "nearer than the recorded strains can tell"
#: What was changed alone in a study that differs, by study: where its results are (MEMBER_CHANGE), and the changes.
CAUSES = {"wellmann-box": ("wellmann-box-causes", {
    "densest": "densest packing", "dense": "denser packing", "loose": "looser packing", "smooth": "smooth walls",
    "pressed": "start at 10 kPa", "slow": "a tenth of the rate", "half_rate": "half the rate",
    "half_step": "half the step", "tight": "tighter rest"})}
#: Changes whose runs end at a strain of 0.04, and what their keys then name.
SHORT, WITHIN_SHORT = ("slow",), re.compile("at_0.0[24]|early|middle")
#: A sheared sample whose mean stress falls below this share of its start bears nothing: none of its figures agrees.
COLLAPSED = 0.1
TOO_WIDE = 0.5  #: share of the value, or of the effect, that half of our 95 % interval may take

Row = dict[str, Any]
Rule = Callable[[Row, Results], "str | Measured | None"]


def read_toml(name: str) -> dict[str, Any]:
    with open(FOLDER / f"{name}.toml", "rb") as file:
        try:
            return tomllib.load(file)
        except tomllib.TOMLDecodeError as error:
            raise Refused(f"{file.name}: {error}") from error


def all_rows() -> list[Row]:
    return [row for name in FILES for row in read_toml(name)["figure"]]


def places(row: Row) -> list[tuple[str, str]]:
    """What the row is of: its source with each figure, table, equation or section that it names."""
    source, kind, numbers = re.fullmatch(r"(\w+) ((?:fig|eq|sect)\. |table |suggestion |)(.+)", row["source"]).groups()
    return [(source, kind + number) for number in numbers.split(", ")]


def unanswered(results: Results) -> list[str]:
    """The sources' figures and tables with results (sources.toml) of which no row has one of ours."""
    answered = {place for row in all_rows() if judged(row, results)[1] for place in places(row)}
    return [f"{source} {figure}" for source, listed in read_toml("sources").items()
            for figure in listed["results"] if (source, figure) not in answered and figure not in listed["sentences"]]


# Numbers.


def _plain(row: Row, results: Results) -> Measured | None:
    found = results.number(row["study"], row["key"], row.get("member", ""))
    return replace(found, value=abs(found.value)) if found and row.get("size") else found


def _flank(steeper: bool) -> Rule:
    """The flank that is steeper, or flatter, in the mean, whichever side it is."""

    def of(row: Row, results: Results) -> Measured | None:
        sides = [results.number(row["study"], f"{row['key']}_{side}_deg") for side in ("left", "right")]
        if None in sides:
            return None
        return sides[0 if (sides[0].value > sides[1].value) == steeper else 1]

    return of


def _ratio(row: Row, results: Results) -> Measured | None:
    """a / b of independent ensembles: the second of a pair over the first.

    The error is that of a - rho b over b, at the rho of the source's range that is nearest to ours
    (Fieller). It is valid however uncertain b is, where propagation to first order is not.
    """
    pair = _pair(row, results)
    if pair is None:
        return None
    together = _together(row, results, "over")
    if together is not None:
        return together
    b, a = pair
    ratio = a.value / b.value
    rho = min(max(ratio, row["range"][0]), row["range"][1])
    away = a.less(b, rho)
    return replace(away, value=ratio, error=away.error / abs(b.value))


# Words, each "WORD: what supports it".


def _limits(row: Row, results: Results) -> str | None:
    """With one limit: up to it, above it. With two: below, within, above."""
    key = row["key"] + ("." + row["member"] if "member" in row else "")
    value = results.plain(row["study"], key)
    if value is None:
        return None
    if math.isnan(value):
        return row.get("nan", "undecided: no value")
    low, high = row["limits"][0], row["limits"][-1]
    place = (value > high) if len(row["limits"]) == 1 else (value >= low) + (value > high)
    return row["says"].format(word=row["words"][place], value=value, percent=100 * value)


def _peaks_at_every_depth(row: Row, results: Results) -> str | None:
    dot = f".{row['member']}" if "member" in row else ""
    depths = ("0.25", "0.5", "0.75")
    found = [results.plain(row["study"], f"response.depth_{depth}.peaks{dot}") for depth in depths]
    if None in found:
        return None
    word = "one peak at every depth" if set(found) == {1} else "not one peak at every depth"
    return f"{word}: {', '.join(f'{n:g}' for n in found)} at {', '.join(depths)} of it"


def _base_peaks(row: Row, results: Results) -> str | None:
    """As _limits; of several layers, two peaks where the pressure below the load is beyond their spread below the
    largest, and one where it is not below SHALLOW of it, else between."""
    said, ratio = _limits(row, results), results.number(row["study"], "response.centre_over_largest", row.get("member", ""))
    if said is None or ratio is None or not math.isfinite(ratio.error):
        return said
    peaks = results.plain(row["study"], row["key"] + (f".{row['member']}" if "member" in row else ""))
    told = f"below the load {ratio.value:.2f} ± {ratio.error:.2f} of the largest"
    sure = ratio.value + ratio.half < 1 if peaks > 1 else ratio.value - ratio.half > SHALLOW
    return f"{said}, {told}" if sure else f"between: {peaks:.0f}, {told}"


def _merging(row: Row, results: Results) -> str | None:
    """Whether there are several peaks at some depth, and below it one alone down to the base."""
    dot = f".{row['member']}" if "member" in row else ""
    found = {depth: results.plain(row["study"], f"{row['key']}.depth_{depth:g}.peaks{dot}") for depth in DEPTHS}
    found = {depth: peaks for depth, peaks in found.items() if peaks is not None}
    base = results.plain(row["study"], f"{row['key']}.peaks{dot}")
    if base is None or not found:
        return None
    several = [depth for depth, peaks in found.items() if peaks > 1]
    if not several:
        return "never two: one peak at every depth"
    if base > 1:
        return f"do not merge: {base:.0f} on the base"
    return f"merge: one peak below {max(several):g} of the depth"


def _dip_over_all(row: Row, results: Results) -> str | None:
    member = row.get("member", "")
    dip, centre = results.dip(row["study"], member), results.plain(row["study"], "dip.ratio" + (f".{member}" if member else ""))
    if dip is None:
        return None
    return (f"{dip.word}: shoulder - centre = {dip.difference.value:.3f} ± {dip.difference.error:.3f} ρgh, "
            f"p = {dip.p:.2g} if there were none ({dip.p_holm:.2g} over all pours)"
            + ("" if centre is None else f"; centre over largest {centre:.2f}"))


def _pair(row: Row, results: Results) -> tuple[Measured, Measured] | None:
    """Two numbers: of the studies `over` and `study`, of the members `from` and `to`, or of these keys
    (of the row's member, if it has one)."""
    study = row["study"]
    if "over" in row:
        a, b = (results.number(one, row["key"], row.get("member", "")) for one in (row["over"], study))
    elif "key" in row:
        a, b = (results.number(study, row["key"], row[end]) for end in ("from", "to"))
    else:
        a, b = (results.number(study, row[end], row.get("member", "")) for end in ("from", "to"))
    return None if a is None or b is None else (a, b)


def _together(row: Row, results: Results, word: str) -> Measured | None:
    """The mean difference ("less") or ratio ("over") of a pair over the packings that both have, where collect.py has
    made it: most of the scatter of packings is common to both."""
    if "from" not in row:
        return None
    pair, member = f"{row['to']}_{word}_{row['from']}", row.get("member", "")
    found = results.number(row["study"], *((row["key"], pair) if "key" in row else (pair, member)))
    return found if found is not None and math.isfinite(found.error) else None


def _change(row: Row, results: Results) -> tuple[Measured, float] | None:
    """The second of a pair less the first, and the value of the first.

    Samples of one seed share their first state where only the friction differs; where their differences were not
    collected the error is that of independent ones, which is no less.
    """
    pair = _pair(row, results)
    if pair is None:
        return None
    return _together(row, results, "less") or pair[1].less(pair[0]), pair[0].value


def _rises(row: Row, results: Results) -> str | None:
    change = _change(row, results)
    if change is None:
        return None
    by, _ = change
    word = "rises" if by.value > by.half else "falls" if by.value < -by.half else "undecided"
    return f"{word}: {by.value:+.3f} ± {by.error:.3f}"


def _smallness(by: Measured, most: float, words: tuple[str, str]) -> str:
    """The first word where a change is at most MOST, the second where it is more, "between" if undecided."""
    if abs(by.value) + by.half <= most:
        return words[0]
    return words[1] if abs(by.value) - by.half > most else "between"


def _hardly_changes(row: Row, results: Results) -> str | None:
    change = _change(row, results)
    if change is None:
        return None
    by, base = change
    if not math.isfinite(by.error):
        return f"undecided: {by.value:+.3f}, {100 * by.value / base:+.0f} %"
    word = _smallness(by, row["within"] * abs(base), ("hardly changes", "changes"))
    return (f"{word}: {by.value:+.3f} ± {by.error:.3f}, "
            f"{100 * by.value / base:+.0f} ± {100 * by.error / abs(base):.0f} %")


def _negligible(row: Row, results: Results) -> str | None:
    """A change beside that between the members `beside`, whose value counts as known."""
    change, other = _change(row, results), _change(row | dict(zip(("from", "to"), row["beside"])), results)
    if change is None or other is None:
        return None
    (by, _), (whole, _) = change, other
    share = 100 / abs(whole.value)
    if not math.isfinite(by.error):
        return f"undecided: {by.value:+.3f}, {share * by.value:+.0f} %"
    word = _smallness(by, row["within"] * abs(whole.value), ("negligible", "counts"))
    return (f"{word}: {by.value:+.3f} ± {by.error:.3f} beside {whole.value:+.3f}, "
            f"{share * by.value:+.0f} ± {share * by.error:.0f} %")


def _contraction(row: Row, results: Results) -> str | None:
    """By the mean over samples at its least value and by what it regains from there."""
    down, up = (results.number(row["study"], f"{row['key']}.{name}", row["member"])
                for name in ("contraction", "dilation"))
    if down is None or up is None:
        return None
    falls, rises = down.value > down.half, up.value > up.half
    word = ", then ".join(["contraction"] * falls + ["dilation"] * rises) or "neither"
    if math.isnan(down.error):
        return f"undecided: trace/3 falls by {down.value:.5f}, then rises by {up.value:.5f}"
    then = f"then rises by {up.value:.5f} ± {up.error:.5f}"
    if up.value == 0 and up.error == 0:
        then = "least at the end"
    return f"{word}: trace/3 falls by {down.value:.5f} ± {down.error:.5f}, {then}"


def _fit_quality(row: Row, results: Results) -> str | None:
    """Beyond the errors where chi2/dof exceeds what a true model's does by chance in 1 of 100."""
    found = [results.plain(row["study"], f"{row['key']}.{name}")
             for name in ("chi2_per_dof", "chi2_chance", "rel_l2")]
    if None in found or math.isnan(found[0]):
        return None
    chi2, most, rel = found
    return (f"{'beyond' if chi2 > most else 'within'} the errors: χ²/dof {chi2:.2f} "
            f"(chance: up to {most:.2f}), relative L2 {100 * rel:.1f} %")


def _branch(row: Row, results: Results) -> str | None:
    name = results.text(row["study"], f"{row['key']}.branch")
    angle = results.number(row["study"], f"{row['key']}.beta_hat_deg")
    return None if name is None or angle is None else f"{name}: nearest to β̂ = {angle.value:.1f}°"


def _kink(row: Row, results: Results) -> str | None:
    """Kink of the free core: a dip or a peak beyond two errors."""
    size, ray = (results.number(row["study"], f"{row['key']}.{name}") for name in ("kink", "ray_deg"))
    if size is None or ray is None or math.isnan(size.error):
        return None
    word = "dip" if size.value < 0 else "peak"
    if abs(size.value) <= size.half:
        word = "neither"
    return (f"{word}: kink {size.value:.2f} ± {size.error:.2f} ρg "
            f"on the ray at {ray.value:.0f}° from the vertical")


def _convergence(row: Row, results: Results) -> str | None:
    """Whether more disks bring a force nearer to the line model: by half of the difference, or hardly at all."""
    few, many = (results.plain(row["study"], f"{row['key']}.{row[end]}") for end in ("from", "to"))
    if few is None or many is None:
        return None
    word = "does not converge" if many > 0.8 * few else "neither" if many > 0.5 * few else "converges"
    return (f"{word}: differs by {100 * few:.2g} % "
            f"with 360 disks, by {100 * many:.2g} % with 5,490")


def _turning_soft(row: Row, results: Results) -> str | None:
    """Whether a rain of hard disks comes to rest as soft ones: nine tenths, the others lie loose."""
    rests, share, hard = (results.plain(row["study"], f"{row['key']}.{name}")
                          for name in ("at_rest", "soft_share", "to_hard"))
    if None in (rests, share, hard):
        return None
    return (f"{'turn soft' if rests == 1 and share > 0.9 else 'do not rest'}: {100 * share:.3g} % at rest; "
            f"{hard:.0f} times one turned hard again on the way")


def _held(row: Row, results: Results) -> str | None:
    """Whether a pile that settles ends within 1 % of the closed forms, and when it was there."""
    n, h, until, time = (results.plain(row["study"], f"{row['key']}.{name}.{row['member']}")
                         for name in ("normal_max_error", "horizontal_max_error", "within_until", "time"))
    since = results.plain(row["study"], f"{row['key']}.within_from.{row['member']}")
    if None in (n, h, until, since, time):
        return None
    when = "never within 1 %" if math.isnan(until) else f"first within 1 % at {since:.0f}, last at {until:.0f}"
    return (f"{'within' if max(n, h) <= 0.01 else 'beyond'} 1 %: N {100 * n:.3g} %, H {100 * h:.3g} % "
            f"after {time:.0f} sqrt(d/g); {when}")


def _static_friction(row: Row, results: Results) -> str | None:
    """What viscous friction alone, without the ground's wells, does with a pile."""
    rests, speed = (results.plain(row["study"], f"{row['key']}.{name}.{row['member']}")
                    for name in ("at_rest", "spread_speed"))
    if rests is None or speed is None:
        return None
    return (f"{'needed' if rests == 0 else 'not needed'}: without it the base goes apart "
            f"at {speed:.2g} sqrt(g d)")


def _spread(row: Row, results: Results) -> str | None:
    """Standard deviation of one realization beside the mean."""
    found = results.number(row["study"], row["key"])
    count = results.realizations(row["study"])
    if found is None or count is None:
        return None
    share = found.error * math.sqrt(count) / abs(found.value)
    return f"{'large' if share > 1 else 'small'}: a single one scatters by {share:.1f} of the mean"


def _deeper(row: Row, results: Results) -> str | None:
    """Whether the second of a pair of shares of the depth is larger than the first."""
    pair = _pair(row, results)
    if pair is None:
        return None
    first, second = (one.value for one in pair)
    return f"{'deeper' if second > first else 'not deeper'}: to {first:g} and to {second:g} of the depth"


def _grains_needed(row: Row, results: Results) -> str | None:
    """The size that an RVE needs by all heaps, and how far it moves without one of them."""
    low, high = row["sizes"]
    found = [results.plain(row["study"], f"{row['key']}{part}.{row['member']}") for part in ("", ".least", ".most")]
    if None in found:
        return None
    places = {"fewer" if one < low else "more" if one > high else "within" for one in found}
    return (f"{places.pop() if len(places) == 1 else 'between'}: {found[0]:.0f} grains, "
            f"{found[1]:.0f} to {found[2]:.0f} without one heap")


def _growth(row: Row, results: Results) -> str | None:
    """Power of the depth with which the width grows, as load over largest response, between two depths."""
    dot = f".{row['member']}" if "member" in row else ""
    top, low = (results.plain(row["study"], f"response.depth_{depth}.peak{dot}") for depth in ("0.25", "0.75"))
    if top is None or low is None:
        return None
    power = math.log(top / low) / math.log(3)
    return f"{'linear' if 0.75 <= power <= 1.25 else 'not linear'}: as the depth to the {power:.2f}"


def _nearer(row: Row, results: Results) -> str | None:
    """Whether N is nearer to the line model than H, by the largest differences."""
    n, h = (results.plain(row["study"], f"{row['key']}.line_{one}_max_difference.{row['member']}")
            for one in ("normal", "horizontal"))
    if n is None or h is None:
        return None
    return f"{'N is nearer' if n < h else 'N is not nearer'}: off by {100 * n:.2g} %, H by {100 * h:.2g} %"


def _dip_inside(row: Row, results: Results) -> str | None:
    """At which levels there is a dip beyond the errors of all levels (Bonferroni)."""
    found = {level: results.number(row["study"], f"levels.{level}.dip", row["member"]) for level in row["levels"]}
    if None in found.values():
        return None
    sure = [level for level, one in found.items()
            if len(found) * stats.t.sf(one.value / one.error, one.freedom) < 0.025]
    least, most = min(found), max(found)
    word = "neither" if not sure else "up to a height" if least in sure and most not in sure else "elsewhere"
    return f"{word}: shoulder - centre " + ", ".join(f"{one.value:.2f} ± {one.error:.2f}" for one in found.values())


def _apart(row: Row, results: Results) -> str | None:
    """Whether two axes are apart: by more than `least` degrees, or surely by less than `within`."""
    found = results.number(row["study"], row["key"], row.get("member", ""))
    if found is None:
        return None
    size = abs(found.value)
    word = ("not collinear" if size - found.half > row["least"] else
            "collinear" if size + found.half <= row["within"] else "between")
    return f"{word}: {found.value:+.1f} ± {found.error:.1f}°"


RULES: dict[str, Rule] = {
    "steeper flank": _flank(True),
    "flatter flank": _flank(False),
    "ratio": _ratio,
    "dip over all pours": _dip_over_all,
    "dip inside": _dip_inside,
    "apart": _apart,
    "peaks at every depth": _peaks_at_every_depth,
    "rises": _rises,
    "hardly changes": _hardly_changes,
    "negligible": _negligible,
    "contraction": _contraction,
    "fit quality": _fit_quality,
    "branch": _branch,
    "kink": _kink,
    "convergence": _convergence,
    "turning soft": _turning_soft,
    "static friction": _static_friction,
    "held": _held,
    "spread": _spread,
    "deeper": _deeper,
    "merging": _merging,
    "grains needed": _grains_needed,
    "growth": _growth,
    "nearer": _nearer,
}


def rule_of(row: Row) -> Rule:
    if "rule" in row:
        return RULES[row["rule"]]
    if "limits" in row:
        return _base_peaks if row["key"] == "response.peaks" else _limits
    return _plain if "key" in row else lambda *_: None  # a gap that no study has a figure for


# What the row says.

#: When the words of a rule are said.
RULE_BANDS = {
    "dip over all pours": "at 5 %, Holm",
    "dip inside": "at 5 % over these levels",
    "apart": "more than 1° beyond our 95 % interval",
    "peaks at every depth": "at a quarter, half and three quarters",
    "rises": "beyond our 95 % interval",
    "contraction": "each beyond our 95 % interval",
    "fit quality": "by the chance level of χ²/dof",
    "branch": "the nearest of three",
    "kink": "beyond our 95 % interval",
    "convergence": "the difference falls by more than half, or by less than a fifth",
    "turning soft": "all at rest, 90 % of them soft",
    "static friction": "no rest without it",
    "held": "N and H at the end",
    "spread": "above the mean",
    "merging": "one peak from some depth down to the base",
    "deeper": "at one of the depths of 0.1 to 0.9 more",
    "growth": "power of 0.75 to 1.25",
    "nearer": "by the largest difference",
}


def _interval(low: float, high: float, percent: bool) -> str:
    low, high = (100 * limit if percent else limit for limit in (low, high))
    text = f"{low:g}" if low == high else f"{low:g} to {high:g}"
    if math.isinf(low):
        text = f"at most {high:g}"
    elif math.isinf(high):
        text = f"above {low:g}"
    return text + (" %" if percent else "")


def band(row: Row) -> str:
    """What of ours counts as the source's: the range, or the words with their limits or their rule."""
    if "band" in row:
        return row["band"]
    if "range" in row:
        return with_unit(_interval(*row["range"], percent=False), row)
    if "agrees" not in row:
        return ""
    words = " or ".join(row["agrees"])
    if len(set(row.get("limits", "ab"))) == 1 and len(row["words"]) == 3:
        return words  # a count
    if "limits" in row:
        ends = [-math.inf, *row["limits"], math.inf]
        percent = "{percent" in row["says"]
        spans = [_interval(ends[k], ends[k + 1], percent)
                 for k, word in enumerate(row["words"]) if word in row["agrees"]]
        return f"{words} ({' or '.join(spans)})"
    of = " of that from μ" if row["rule"] == "negligible" else ""
    rule = RULE_BANDS.get(row["rule"]) or f"by at most {100 * row['within']:g} %{of}"
    return f"{words} ({rule})"


def with_unit(text: str, row: Row) -> str:
    return f"{text} {row['unit']}" if "unit" in row else text


def number_text(found: Measured, row: Row) -> str:
    """Ours with its error; an error that is not 0 is not shown as 0."""
    digits = 1 if row.get("unit") == "deg" else 3
    if math.isnan(found.error):
        return with_unit(f"{found.value:.{digits}f}", row)
    while digits < 6 and 0 < found.error < 0.5 * 10**-digits:
        digits += 1
    return with_unit(f"{found.value:.{digits}f} ± {found.error:.{digits}f}", row)


def agreement(found: Measured, row: Row) -> str:
    """Agrees when ours lies in the source's range, differs when no value of our 95 % interval does.

    It says nothing with one realization, between the two, where the miss is within `resolution` (half
    the distance of the recorded states), or where the interval ends outside the range and half of it
    exceeds TOO_WIDE of the source's value (of the effect that a ratio reports; where the range has no end, always).
    """
    if math.isnan(found.error):
        return "no error, no statement"
    low, high = row["range"]
    miss = max(0.0, low - found.value, found.value - high)
    if 0 < miss <= row.get("resolution", 0):
        return COARSE
    if miss > found.half:
        return f"differs by {with_unit(f'{miss:.2g}', row)} ({miss / found.error:.1f} standard errors)"
    stake = row.get("effect", 0 if math.isinf(low) or math.isinf(high) else abs((low + high) / 2))
    inside = "effect" not in row and low <= found.value - found.half and found.value + found.half <= high
    return "agrees" if inside or miss == 0 and found.half <= TOO_WIDE * stake else WIDE


POWER, MOST_PILES = 0.8, 10_000
SHALLOW = 0.75  # of the largest pressure: where a dip between two peaks would be seen
DEPTHS = (0.1, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.7, 0.75, 0.8, 0.9)  # of a layer, at which peaks are counted


def off_band(found: Measured, row: Row) -> tuple[float, float, float]:
    """How far ours lies outside the band, the error of this with the source's own, and the two-sided p of as much.

    One scatter for both: the variance of a mean of n piles less one of m is s^2 (1/n + 1/m), known with n - 1 degrees
    of freedom.
    """
    low, high = row["range"]
    miss = max(0.0, low - found.value, found.value - high)
    error = found.error * math.sqrt(1 + (found.freedom + 1) / row["piles"])
    return miss, error, float(2 * stats.t.sf(miss / error, found.freedom)) if error > 0 else NAN


def stake_of(row: Row) -> float:
    """What a tested row is to see: the distance of `alternative`, or TOO_WIDE of the source's value."""
    middle = sum(row["range"]) / 2
    return abs(row["alternative"] - middle) if "alternative" in row else TOO_WIDE * abs(middle)


def piles_to_inform(found: Measured, row: Row, effect: float, level: float) -> int | None:
    """How many piles of ours would see `effect` at `level`, two-sided, with a probability of POWER; none does where the
    source has too few."""
    square = found.error**2 * (found.freedom + 1)

    def sees(n: int) -> bool:
        quantiles = stats.t.ppf(1 - level / 2, n - 1) + stats.t.ppf(POWER, n - 1)
        return quantiles * math.sqrt(square * (1 / n + 1 / row["piles"])) <= effect

    if not sees(MOST_PILES):
        return None
    low, high = 1, MOST_PILES  # too few, enough
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if sees(middle) else (middle, high)
    return high


def tested(results: Results) -> list[tuple[Row, Measured]]:
    """The rows of all tables that are tested, with ours, where it has an error over counted piles."""
    found = [(row, rule_of(row)(row, results)) for row in all_rows() if "piles" in row]
    return [(row, one) for row, one in found
            if isinstance(one, Measured) and math.isfinite(one.error) and math.isfinite(one.freedom)]


def of_test(found: Measured, row: Row, results: Results) -> str:
    """Differs at 5 % over all tested rows (Holm). Agrees where a miss as large is no rarity by itself and the interval
    excludes the alternative, or, without one, is no wider to a side than the stake."""
    if not (math.isfinite(found.error) and math.isfinite(found.freedom)):
        return "no error, no statement"
    every = tested(results)
    corrected = holm([off_band(one, of)[2] for of, one in every])
    p = next((p for (of, _), p in zip(every, corrected) if of["what"] == row["what"]), off_band(found, row)[2])
    miss, error, alone = off_band(found, row)
    half = float(stats.t.ppf(0.975, found.freedom)) * error
    if p < 0.05:
        return (f"differs by {with_unit(f'{miss:.2g}', row)} ({miss / error:.1f} standard errors of both, "
                f"p = {p:.2g} over all tested rows)")
    informs = abs(row["alternative"] - found.value) > half if "alternative" in row else half <= stake_of(row)
    if alone >= 0.05 and informs:
        return "agrees"
    # What is off by itself is to be seen as far as it is, else the stake; at the first step of Holm's correction.
    effect = miss if alone < 0.05 else stake_of(row)
    piles, by_itself = (piles_to_inform(found, row, effect, level) for level in (0.05 / max(len(every), 1), 0.05))
    if piles:
        enough = f"{piles} piles would inform" if piles > found.freedom + 1 else "between both"
    elif by_itself and by_itself > found.freedom + 1:
        enough = f"{by_itself} piles would inform by itself, none over all tested rows (the source has {row['piles']})"
    else:
        enough = f"no number of piles of ours would inform beside the source's {row['piles']}"
    return "uninformative: " + (f"p = {alone:.2g} by itself, {p:.2g} over all tested rows; " if alone < 0.05 else "") + enough


SILENT = {
    "undecided": "too few realizations to tell",
    "between": WIDE,
    "neither": "uninformative",  # what is not there beyond the spread says nothing of a dip, nor of none
}


def note_of(row: Row, results: Results) -> str:
    """What a reader must know of ours: "; ..." behind the agreement, or nothing."""
    if "note" not in row:
        return ""
    note = row["note"]
    value = results.plain(row["study"], f"{note['key']}.{row['member']}")
    return "; " + note["says"].format(value=value) if value is not None and value > note["above"] else ""


def members_of(row: Row) -> list[str]:
    """The members of a sweep that a row reads."""
    return [row[end] for end in ("member", "from", "to") if end in row and not (end != "member" and "member" in row)]


def tried_of(row: Row, results: Results) -> list[str]:
    """What ours becomes by each change of CAUSES that has run: "denser packing 0.80 ± 0.01"."""
    if row["study"] not in CAUSES:
        return []
    study, changes = CAUSES[row["study"]]
    out = []
    for change, words in changes.items():
        if change in SHORT and not WITHIN_SHORT.search(row.get("key", "")):
            continue
        ends = {end: f"{row[end]}_{change}" for end in ("member", "from", "to") if row.get(end) in members_of(row)}
        found = rule_of(row)({**row, **ends, "study": study}, results)
        if isinstance(found, Measured):
            out.append(f"{words} {number_text(found, row)}")
        elif found is not None:  # a word, or the percents alone of an undecided one
            word, _, why = found.partition(": ")
            out.append(f"{words} {why.rpartition(', ')[2] if word in SILENT and '%' in why else why}")
    return out


def filled(cause: str, row: Row, results: Results) -> str:
    """A cause with its numbers."""

    def number(name: re.Match[str]) -> str:
        found = results.number(row["study"], name[1], name[2])
        return "not run" if found is None else number_text(found, {})

    return re.sub(r"\{([\w.]+)@(\w+)\}", number, cause)


def cause_of(row: Row, said: str, results: Results) -> str:
    """Why ours differs, and what was tried: "; ..." behind the agreement, or nothing."""
    if not said.startswith("differs"):
        return ""
    parts, tried = [filled(row["cause"], row, results)] if "cause" in row else [], tried_of(row, results)
    if tried:
        before = "" if "tried: " in "".join(parts) else "tried: " if parts else "cause not found; tried: "
        parts.append(before + ", ".join(tried))
    elif not parts and row["study"] in CAUSES:
        parts.append("cause not found; tried: nothing yet")
    return "".join(f"; {part}" for part in parts)


def borne(row: Row, said: str, results: Results) -> str:
    """The agreement, unless the sample has collapsed."""
    shares = [results.plain(row["study"], f"sample.pressure_ratio.{member}") for member in members_of(row)
              if member.startswith("shear_")]
    least = min((share for share in shares if share is not None), default=1.0)
    if not said.startswith("agrees") or least >= COLLAPSED:
        return said
    return f"collapsed, agrees with nothing: the mean stress falls to {least:.2g} of its start"


def judged(row: Row, results: Results) -> tuple[str, str]:
    """Ours and the agreement; where there is no result, why, and nothing."""
    found = rule_of(row)(row, results)
    if found is None:
        return row.get("gap", NOT_RUN) if results.has(row["study"]) else NOT_RUN, ""
    if isinstance(found, Measured):
        said = borne(row, of_test(found, row, results) if "piles" in row else agreement(found, row), results)
        return number_text(found, row), said + cause_of(row, said, results) + note_of(row, results)
    if row.get("single"):
        return found, "no error, no statement"
    word = found.partition(":")[0]
    said = borne(row, SILENT.get(word, "agrees" if word in row["agrees"] else "differs"), results)
    return found, said + cause_of(row, said, results) + note_of(row, results)
