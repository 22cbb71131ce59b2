"""Tests of one outcome between conditions, by scipy and statsmodels; no files, no names of people.

Every test gives an estimate with its interval, an effect size, and what its assumptions look like.
Which test is right is a matter of the design, not of the data: an assumption that looks bad is
said, and a test that does without it stands beside.
"""

from __future__ import annotations

import dataclasses
import functools
import itertools
import math
import warnings

import numpy as np
from scipy import stats


TESTS = ("paired_t", "wilcoxon", "friedman", "mixed", "welch_t", "mann_whitney", "anova", "kruskal")
LARGEST = 1e100
"""A value beyond this cannot be squared, and is none."""
MOST_EXACT = 49
"""Values of a sample for which p of ranks is exact."""
ZERO_VARIANCE = 1e-6
"""A variance below this share of all of them is 0."""
LEAST_REST = 1e-18
"""Variance of the rest, of values with deviation 1, below which it is rounding."""


@dataclasses.dataclass
class Comparison:
    """Two conditions: how far apart, how surely."""

    first: str
    second: str
    statistic: str
    value: float
    p: float
    estimate: float
    """Second minus first: difference of means, or the Hodges-Lehmann estimate."""
    low: float
    high: float
    effect: str
    size: float
    df: float | None = None
    p_adjusted: float | None = None
    counted: str = ""
    """How many values the test counts: people, pairs that differ, or both groups."""
    note: str = ""
    """What ranks leave out or share."""
    open_end: str = ""
    """"low" or "high": that end is 0, and 0 itself is not within the interval."""


@dataclasses.dataclass
class Result:
    """A test of one outcome."""

    test: str
    count: int
    """People."""
    statistic: str = ""
    value: float = math.nan
    df: tuple[float, ...] = ()
    p: float = math.nan
    effect: str = ""
    size: float = math.nan
    comparisons: list[Comparison] = dataclasses.field(default_factory=list)
    assumptions: list[str] = dataclasses.field(default_factory=list)
    notes: list[str] = dataclasses.field(default_factory=list)
    variances: dict[str, float] = dataclasses.field(default_factory=dict)


def adjusted(values, method: str) -> list[float]:
    """p values corrected for their number: holm, bonferroni or none.

    statsmodels has it, too, and collects garbage at each call: 0.2 s.
    """
    values = np.asarray(values, float)
    count = len(values)
    if method == "none" or count == 0:
        return values.tolist()
    if method == "bonferroni":
        return np.minimum(1, values * count).tolist()
    rising = np.argsort(values, kind="stable")
    steps = np.maximum.accumulate(values[rising] * (count - np.arange(count)))
    result = np.empty(count)
    result[rising] = np.minimum(1, steps)
    return result.tolist()


def normality(values, what: str, alpha: float) -> str:
    """What Shapiro and Wilk's test says, in words."""
    values = np.asarray(values, float)
    if len(values) < 3 or np.ptp(values) == 0:
        return f"{what}: too few different values to judge whether they are normal"
    value, p = stats.shapiro(values)
    words = "no sign against normal" if p >= alpha else "NOT normal"
    return f"{what}: {words} (Shapiro-Wilk W = {value:.3f}, {p_text(p)})"


def number(value: float) -> str:
    """Three digits behind the point; small ones as < 0.001."""
    return "< 0.001" if 0 <= value < 0.001 else f"{value:.3f}"


def p_text(p: float) -> str:
    """As p = 0.012, or p < 0.001."""
    return f"p {number(p)}" if p < 0.001 else f"p = {number(p)}"


def rounded(values, scale: float) -> np.ndarray:
    """To 12 digits of the scale: equal sums in another order are equal, so that ranks see their ties."""
    if not 0 < scale < math.inf:
        return np.asarray(values, float)
    return np.round(np.asarray(values, float), min(290, 11 - math.floor(math.log10(scale))))


def for_ranks(columns) -> list[np.ndarray]:
    """Columns rounded to 12 digits of the largest of all their values."""
    scale = max((float(np.max(np.abs(each))) for each in columns if len(each)), default=0.0)
    return [rounded(each, scale) for each in columns]


def differences(first, second) -> np.ndarray:
    """Second minus first, rounded to 12 digits of the largest value of both."""
    a, b = np.asarray(first, float), np.asarray(second, float)
    return rounded(b - a, float(np.max(np.abs([a, b]), initial=0)))


def paired_t(first, second, alpha=0.05, names=("a", "b")) -> Comparison:
    """Student's t of differences; effect size d_z, the mean difference over its deviation."""
    difference = np.asarray(second, float) - np.asarray(first, float)
    mean, deviation = difference.mean(), difference.std(ddof=1)
    if deviation == 0:
        return Comparison(*names, "t", math.nan, 1.0 if mean == 0 else 0.0, mean, mean, mean, "d_z",
                          math.nan, len(difference) - 1, counted=str(len(difference)))
    test = stats.ttest_1samp(difference, 0)
    low, high = test.confidence_interval(1 - alpha)
    return Comparison(*names, "t", test.statistic, test.pvalue, mean, low, high, "d_z", mean / deviation, test.df,
                      counted=str(len(difference)))


def not_rejected(ends, p_of, p: float, estimate: float, alpha: float) -> tuple[float, float, str]:
    """The interval of shifts that a test by ranks does not reject, and which end is open: the test inverted, ties and all.

    ends: sorted shifts at which the ranks change; p_of(shift): p between them; p: of the shift 0. An end that no shift
    is rejected beyond is infinite. 0 is within the interval if and only if the test does not reject it: an end at a 0
    that is rejected is open ("low" or "high"; empty: none is), and so is one that is moved there since with ties p need
    not fall evenly.
    """
    limit = alpha * (1 - 1e-12)  # p of the limit itself is not rejected
    width = ends[-1] - ends[0] + abs(ends[0]) + 1
    edges = np.concatenate([[ends[0] - width], ends, [ends[-1] + width]])
    middle = int(np.searchsorted(edges, estimate))

    def last_kept(outer, inner):
        """The outermost gap of shifts that is not rejected."""
        if p_of((edges[outer] + edges[outer + 1]) / 2) >= limit:
            return outer
        while abs(outer - inner) > 1:
            probe = (outer + inner) // 2
            is_kept = p_of((edges[probe] + edges[probe + 1]) / 2) >= limit
            outer, inner = (outer, probe) if is_kept else (probe, inner)
        return inner

    first, last = last_kept(0, min(middle, len(edges) - 2)), last_kept(len(edges) - 2, max(middle - 1, 0))
    low = -math.inf if first == 0 else float(edges[first])
    high = math.inf if last == len(edges) - 2 else float(edges[last + 1])
    if p >= limit:
        return min(low, 0.0), max(high, 0.0), ""
    if not low <= 0 <= high:
        return low, high, ""
    return (0.0, high, "low") if estimate > 0 or low == 0 else (low, 0.0, "high")


def doubled_ranks(values) -> tuple[int, ...]:
    """Twice the ranks, rising: whole numbers, ties share one."""
    return tuple(np.sort(np.rint(2 * stats.rankdata(values)).astype(int)).tolist())


@functools.lru_cache(maxsize=64)
def signed_rank_counts(doubled: tuple[int, ...]) -> np.ndarray:
    """How many of the 2^n signs of the ranks give each sum of positive ones; ranks and sums are doubled.

    scipy counts them without ties only; with ties it lists all 2^n, and stops at 13.
    """
    ways = np.zeros(sum(doubled) + 1)
    ways[0] = 1
    for step in doubled:
        ways[step:] += ways[:-step].copy()
    return ways


def signed_rank_p(difference, is_exact: bool | None = None) -> float:
    """p of signed ranks, zeros left out: exact over all signs of the ranks up to 49 differences, with ties, too; above,
    and where is_exact is False, the normal approximation with correction of continuity."""
    kept = difference[difference != 0]
    if len(kept) == 0:
        return 1.0
    if is_exact is None:
        is_exact = len(kept) <= MOST_EXACT
    if not is_exact:
        return min(1.0, float(stats.wilcoxon(kept, correction=True, method="asymptotic").pvalue))
    ranks = stats.rankdata(abs(kept))
    share = np.cumsum(signed_rank_counts(doubled_ranks(abs(kept)))) / 2.0 ** len(kept)
    smaller = min(ranks[kept > 0].sum(), ranks[kept < 0].sum())
    return min(1.0, 2 * float(share[round(2 * smaller)]))


def wilcoxon(first, second, alpha=0.05, names=("a", "b"), is_exact: bool | None = None) -> Comparison:
    """Wilcoxon's signed ranks; p by signed_rank_p, zeros left out, as R's wilcox.test does.

    Estimate: Hodges and Lehmann; interval: the test inverted; both of the pairs that differ. Effect size: matched-pairs
    rank-biserial correlation (Kerby, 2014).
    """
    difference = differences(first, second)
    kept = difference[difference != 0]
    count, counted = len(kept), f"{np.count_nonzero(difference)} of {len(difference)}"
    effect = "matched-pairs rank-biserial"
    if count == 0:
        return Comparison(*names, "V", 0.0, 1.0, 0.0, -math.inf, math.inf, effect, 0.0, counted=counted,
                          note="no pair differs")
    ranks = stats.rankdata(abs(kept))
    v = ranks[kept > 0].sum()
    total = count * (count + 1) / 2
    above, other = np.triu_indices(count)
    walsh = rounded((kept[above] + kept[other]) / 2, float(np.max(abs(kept))))
    estimate, p = float(np.median(walsh)), signed_rank_p(kept, is_exact)
    low, high, open_end = not_rejected(np.unique(walsh), lambda shift: signed_rank_p(kept - shift, is_exact), p, estimate, alpha)
    notes = []
    if count < len(difference):
        notes.append(f"{len(difference) - count} of {len(difference)} pairs do not differ and are left out: {count} count")
    if tied := shared(ranks):
        notes.append(f"{tied} of {count} differences share a rank")
    return Comparison(*names, "V", v, p, estimate, low, high, effect, (2 * v - total) / total, counted=counted,
                      note="; ".join(notes), open_end=open_end)


def shared(ranks) -> int:
    """How many of the ranks are those of ties."""
    _, counts = np.unique(ranks, return_counts=True)
    return int(counts[counts > 1].sum())


def welch_t(first, second, alpha=0.05, names=("a", "b")) -> Comparison:
    """Welch's t of two groups; effect size Hedges' g."""
    a, b = np.asarray(first, float), np.asarray(second, float)
    if np.ptp(a) == 0 and np.ptp(b) == 0:
        mean = b[0] - a[0]
        return Comparison(*names, "t", math.nan, 1.0 if mean == 0 else 0.0, mean, mean, mean, "Hedges' g", math.nan,
                          counted=both(a, b))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # one group alone may be constant
        test = stats.ttest_ind(b, a, equal_var=False)
    low, high = test.confidence_interval(1 - alpha)
    pooled = math.sqrt(((len(a) - 1) * a.var(ddof=1) + (len(b) - 1) * b.var(ddof=1)) / (len(a) + len(b) - 2))
    small = 1 - 3 / (4 * (len(a) + len(b)) - 9)
    mean = b.mean() - a.mean()
    return Comparison(*names, "t", test.statistic, test.pvalue, mean, low, high, "Hedges' g",
                      small * mean / pooled if pooled > 0 else math.nan, test.df, counted=both(a, b))


def both(first, second) -> str:
    """How many values two groups have."""
    return f"{len(first)} + {len(second)}"


@functools.lru_cache(maxsize=64)
def rank_sum_counts(doubled: tuple[int, ...], count: int) -> np.ndarray:
    """How many choices of `count` of the ranks give each sum; ranks and sums are doubled. scipy counts them without ties
    only."""
    ways = np.zeros((count + 1, sum(doubled) + 1))
    ways[0, 0] = 1
    for step in doubled:
        ways[1:, step:] += ways[:-1, :-step].copy()
    return ways[count]


def rank_sum_p(first, second, is_exact: bool | None = None) -> float:
    """p of Mann and Whitney's U: exact over all choices of the ranks where both groups have up to 49 values, with ties,
    too; above, and where is_exact is False, the normal approximation with correction of continuity."""
    pooled = np.concatenate([first, second])
    if np.ptp(pooled) == 0:
        return 1.0
    if is_exact is None:
        is_exact = max(len(first), len(second)) <= MOST_EXACT
    if not is_exact or len(np.unique(pooled)) == len(pooled):
        method = "exact" if is_exact else "asymptotic"
        return float(stats.mannwhitneyu(second, first, method=method, use_continuity=True).pvalue)
    ranks = stats.rankdata(pooled)
    ways = rank_sum_counts(doubled_ranks(pooled), len(first))
    at = round(2 * ranks[:len(first)].sum())
    return min(1.0, 2 * float(min(ways[:at + 1].sum(), ways[at:].sum()) / ways.sum()))


def mann_whitney(first, second, alpha=0.05, names=("a", "b"), is_exact: bool | None = None) -> Comparison:
    """Mann and Whitney's U of the second group, as R's wilcox.test; p by rank_sum_p.

    Estimate: Hodges and Lehmann; interval: the test inverted; effect size: rank-biserial correlation, which is Cliff's
    delta.
    """
    a, b = for_ranks([first, second])
    pooled = np.concatenate([a, b])
    u = stats.mannwhitneyu(b, a, method="asymptotic").statistic if np.ptp(pooled) > 0 else len(a) * len(b) / 2
    gaps = rounded((b[:, None] - a[None, :]).ravel(), float(np.max(abs(pooled))))
    estimate, p = float(np.median(gaps)), rank_sum_p(a, b, is_exact)
    low, high, open_end = not_rejected(np.unique(gaps), lambda shift: rank_sum_p(a, b - shift, is_exact), p, estimate, alpha)
    tied = shared(stats.rankdata(pooled))
    return Comparison(*names, "U", u, p, estimate, low, high, "rank-biserial (Cliff's delta)", 2 * u / len(gaps) - 1,
                      counted=both(a, b), note=f"{tied} of {len(pooled)} values share a rank" if tied else "", open_end=open_end)


def least_p(test: str, sizes: list[int]) -> float:
    """The smallest p that a test by ranks of two conditions can give; 0 for the others."""
    if test == "wilcoxon":
        return min(1.0, 2 / 2 ** sizes[0])
    return min(1.0, 2 / math.comb(sum(sizes), sizes[0])) if test == "mann_whitney" else 0.0


def every_pair(groups: dict[str, np.ndarray], compare, alpha, correction, **options) -> list[Comparison]:
    """All pairs of conditions, corrected for their number."""
    found = [compare(groups[a], groups[b], alpha, (a, b), **options) for a, b in itertools.combinations(groups, 2)]
    for each, p in zip(found, adjusted([each.p for each in found], correction)):
        each.p_adjusted = p
    return found


def friedman(groups: dict[str, np.ndarray], alpha=0.05, correction="holm", is_exact: bool | None = None) -> Result:
    """Friedman's test over people (rows), post-hoc Wilcoxon of all pairs; effect size Kendall's W."""
    columns = for_ranks(groups.values())
    count = len(columns[0])
    if all(np.ptp(row) == 0 for row in np.array(columns).T):
        value, p = 0.0, 1.0
    else:
        value, p = stats.friedmanchisquare(*columns)
    return Result("friedman", count, "chi2", value, (len(columns) - 1,), p, "Kendall's W",
                  value / (count * (len(columns) - 1)), every_pair(groups, wilcoxon, alpha, correction, is_exact=is_exact))


def repeated_anova(table: np.ndarray) -> tuple[float, tuple[float, float], float]:
    """F, its degrees of freedom and p of conditions (columns) within people (rows).

    A power analysis does it some thousand times; statsmodels' AnovaRM takes 10 ms for each.
    """
    rows, columns = table.shape
    mean = table.mean()
    between = rows * ((table.mean(axis=0) - mean) ** 2).sum() / (columns - 1)
    rest = table - table.mean(axis=0) - table.mean(axis=1, keepdims=True) + mean
    df = columns - 1, (rows - 1) * (columns - 1)
    error = (rest ** 2).sum() / df[1]
    f = between / error if error > 0 else math.nan
    return f, df, float(stats.f.sf(f, *df))


@dataclasses.dataclass
class Fit:
    """A mixed model: variances over that of the rest, means of conditions and their covariance, variance of the rest,
    and for the look at assumptions the whitened residuals and the offsets of people."""

    ratios: list[float]
    converged: bool
    means: np.ndarray
    covariance: np.ndarray
    rest: float
    errors: np.ndarray
    offsets: list[float]


def variance_ratios(values, x, group, repeats: bool) -> tuple[list[float], bool]:
    """Variances of people, and where trials repeat of people x condition, over that of the rest; whether they converged.

    By the REML of statsmodels. Values have mean 0 and deviation 1; x (values x conditions) is 1 where a value is of a
    condition. Powell's method, since the default one ends before a variance of 0 and calls that converged. Raises
    ValueError where nothing is left beside people and conditions.
    """
    from statsmodels.regression.mixed_linear_model import MixedLM, VCSpec

    options = {}
    if repeats:
        people = [x[group == each] for each in range(group.max() + 1)]
        names = [[str(i) for i in range(x.shape[1])]] * len(people)
        options = {"exog_re": np.ones(len(values)), "exog_vc": VCSpec(["condition"], [names], [people])}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of a variance of 0, which is a result
        methods = [("powell", {"xtol": 1e-8, "ftol": 1e-12})] + [("lbfgs", {})] * repeats
        for method, tolerances in methods:
            try:
                fit = MixedLM(values, x, groups=group, **options).fit(reml=True, method=method, **tolerances)
                break
            except np.linalg.LinAlgError:  # a step went to where the rest is 0
                fit = None
    if fit is None or fit.scale < LEAST_REST:
        raise ValueError("does not vary beside people and conditions: a mixed model has no fit")
    found = [float(np.squeeze(fit.cov_re)), *map(float, fit.vcomp)]
    least = ZERO_VARIANCE * (fit.scale + sum(found))
    return [each / float(fit.scale) if each > least else 0.0 for each in found], fit.converged


def fitted(values, x, group, repeats: bool) -> Fit:
    """The mixed model of values, as variance_ratios has them.

    Means and their covariance are the generalised least squares of the variances. Those of statsmodels 0.15 come from
    the curvature in means and variances together: where a variance is 0, F of the published cases is off by a tenth.
    """
    ratios, converged = variance_ratios(values, x, group, repeats)
    kinds = x.shape[1]
    left, right, blocks = np.zeros((kinds, kinds)), np.zeros(kinds), []
    for person in range(group.max() + 1):
        rows = np.flatnonzero(group == person)
        spread = np.eye(len(rows)) + ratios[0] + (ratios[1] * x[rows] @ x[rows].T if repeats else 0)
        weighed = np.linalg.solve(spread, x[rows])
        left += weighed.T @ x[rows]
        right += weighed.T @ values[rows]
        blocks.append((rows, spread))
    means = np.linalg.solve(left, right)
    rests = values - x @ means
    errors = np.empty(len(values))
    for rows, spread in blocks:
        errors[rows] = np.linalg.solve(spread, rests[rows])
    rest = max(float(rests @ errors), 1e-300) / (len(values) - kinds)
    return Fit(ratios, converged, means, np.linalg.inv(left) * rest, rest, errors,
               [ratios[0] * errors[rows].sum() for rows, _ in blocks])


def mixed(values, conditions, people, alpha=0.05, correction="holm") -> Result:
    """Mixed model by REML: condition fixed; people, and people x condition where trials repeat, random.

    Tests use the degrees of freedom (people - 1)(conditions - 1), which are exact for balanced data
    and stand in for Satterthwaite's otherwise. Effect size d: the difference over the deviation of a
    single value. Raises ValueError for one person, and for values that do not vary within conditions or
    beside people and conditions.
    """
    values = np.asarray(values, float)
    names = list(dict.fromkeys(conditions))
    code = np.array([names.index(each) for each in conditions])
    persons = list(dict.fromkeys(people))
    group = np.array([persons.index(each) for each in people])
    if len(persons) < 2:
        raise ValueError("fewer than two people have values")
    require_spread([values[code == i] for i in range(len(names))])
    result = Result("mixed", len(persons))
    _, first, cell = np.unique(group * len(names) + code, return_index=True, return_inverse=True)
    repeats = len(first) < len(values)
    if repeats and np.array_equal(values, values[first][cell]):
        result.notes.append("trials of a person and condition do not differ: they count once")
        values, code, group, repeats = values[first], code[first], group[first], False
    middle, scale = values.mean(), values.std(ddof=1)
    fit = fitted((values - middle) / scale, np.eye(len(names))[code], group, repeats)
    if not fit.converged:
        result.notes.append("the fit of the mixed model has not converged")
    means, covariance = fit.means * scale, fit.covariance * scale ** 2
    rest = float(fit.rest * scale ** 2)
    result.variances = {name: ratio * rest for name, ratio in zip(("person", "person x condition"), fit.ratios)}
    result.variances["rest"] = rest
    deviation = math.sqrt(sum(result.variances.values()))
    df = len(names) - 1, (len(persons) - 1) * (len(names) - 1)
    contrast = np.hstack([-np.ones((len(names) - 1, 1)), np.eye(len(names) - 1)])
    gap = contrast @ means
    wald = gap @ np.linalg.solve(contrast @ covariance @ contrast.T, gap)
    result.statistic, result.value, result.df = "F", wald / df[0], df
    result.p = float(stats.f.sf(result.value, *df))
    for i, j in itertools.combinations(range(len(names)), 2):
        estimate = means[j] - means[i]
        error = math.sqrt(covariance[i, i] + covariance[j, j] - 2 * covariance[i, j])
        half = stats.t.ppf(1 - alpha / 2, df[1]) * error
        result.comparisons.append(Comparison(
            names[i], names[j], "t", estimate / error, 2 * stats.t.sf(abs(estimate / error), df[1]), estimate,
            estimate - half, estimate + half, "d", estimate / deviation, df[1], counted=str(len(persons))))
    for each, p in zip(result.comparisons, adjusted([c.p for c in result.comparisons], correction)):
        each.p_adjusted = p
    result.effect, result.size = "partial eta2", result.value * df[0] / (result.value * df[0] + df[1])
    result.assumptions.append(normality(fit.errors, "residuals", alpha))
    result.assumptions.append(normality(fit.offsets, "offsets of people", alpha))
    if result.variances["person"] == 0:
        result.notes.append("people do not differ in their mean (variance 0)")
    return result


def require_spread(columns) -> None:
    """Raises ValueError where no column has two different values: there is nothing to compare a difference with."""
    if all(np.ptp(each) == 0 for each in for_ranks(columns)):
        raise ValueError("does not vary within conditions")


def between(groups: dict[str, np.ndarray], test: str, alpha=0.05, correction="holm") -> Result:
    """Independent groups: anova or kruskal with corrected pairs (Welch's t, Mann-Whitney)."""
    columns = [np.asarray(each, float) for each in groups.values()]
    count, kinds = sum(map(len, columns)), len(columns)
    if test == "anova":
        value, p = stats.f_oneway(*columns)
        df = kinds - 1, count - kinds
        result = Result(test, count, "F", value, df, p, "eta2", value * df[0] / (value * df[0] + df[1]),
                        every_pair(groups, welch_t, alpha, correction))
        result.assumptions = [normality(np.concatenate([c - c.mean() for c in columns]), "residuals", alpha),
                              equal_spread(columns, alpha)]
        return result
    ranked = for_ranks(columns)
    value, p = stats.kruskal(*ranked) if np.ptp(np.concatenate(ranked)) > 0 else (0.0, 1.0)
    return Result(test, count, "H", value, (kinds - 1,), p, "epsilon2", value / (count - 1),
                  every_pair(groups, mann_whitney, alpha, correction))


def equal_spread(columns, alpha) -> str:
    """What Levene's test (about the median) says, in words."""
    if all(np.ptp(each) == 0 for each in for_ranks([abs(each - np.median(each)) for each in columns])):
        return "groups: too few different values to judge their spread"
    value, p = stats.levene(*columns, center="median")
    words = "no sign against equal spread" if p >= alpha else "spread DIFFERS"
    return f"groups: {words} (Levene W = {value:.3f}, {p_text(p)})"


def two_conditions(test: str, groups: dict[str, np.ndarray], alpha: float, count: int) -> Result:
    """A test of two conditions by its name, of means of so many people."""
    compare = {"paired_t": paired_t, "wilcoxon": wilcoxon, "welch_t": welch_t,
               "mann_whitney": mann_whitney}[test]
    one = compare(*groups.values(), alpha, tuple(groups))
    one.p_adjusted = one.p
    result = Result(test, count, one.statistic, one.value, () if one.df is None else (one.df,), one.p,
                    one.effect, one.size, [one])
    a, b = groups.values()
    if test == "paired_t":
        result.assumptions = [normality(b - a, "differences", alpha)]
        rank = wilcoxon(a, b, alpha)
        result.notes.append(f"without normality: Wilcoxon V = {rank.value:g}, {p_text(rank.p)}")
    if test == "welch_t":
        result.assumptions = [normality(each, name, alpha) for name, each in groups.items()]
        rank = mann_whitney(a, b, alpha)
        result.notes.append(f"without normality: Mann-Whitney U = {rank.value:g}, {p_text(rank.p)}")
    if test == "wilcoxon":
        gaps = differences(a, b)
        skew = float(stats.skew(gaps)) if np.ptp(gaps) > 0 else 0.0
        result.assumptions = [f"differences: skewness {skew:.2f}; signed ranks assume that they are "
                              "symmetric about their middle"]
    pairs = int(np.count_nonzero(differences(a, b))) if test == "wilcoxon" else 0
    least = least_p(test, [pairs] if pairs else list(map(len, groups.values())))
    if least > alpha:
        who = f"{pairs} pairs that differ" if 0 < pairs < count else f"{count} people"
        result.notes.append(f"with {who} no p below {least:g} can come out, and no interval of {100 * (1 - alpha):g} % "
                            "has both ends")
    return result


def run(test: str, values, conditions, people, alpha=0.05, correction="holm") -> Result:
    """The test by its name, of values with their conditions and people.

    Tests other than the mixed model take the mean of a person's trials of a condition. Within
    people, those without a value in every condition are left out, which is noted.
    """
    values, conditions, people = list(map(float, values)), list(conditions), list(people)
    if wrong := [value for value in values if not abs(value) <= LARGEST]:
        raise ValueError(f"{wrong[0]:g} is among the values")
    names = list(dict.fromkeys(conditions))
    cells: dict[tuple[str, str], list[float]] = {}
    for value, condition, person in zip(values, conditions, people):
        cells.setdefault((person, condition), []).append(value)
    persons = list(dict.fromkeys(people))
    is_within = test in ("paired_t", "wilcoxon", "friedman", "mixed")
    complete = [p for p in persons if all((p, c) in cells for c in names)] if is_within else persons
    if test == "mixed":
        result = mixed(values, conditions, people, alpha, correction)
        table = np.array([[np.mean(cells[p, c]) for c in names] for p in complete])
        if len(names) > 2 and len(complete) > 2:
            chi = friedman(dict(zip(names, table.T)), alpha, correction)
            result.notes.append(f"without normality: Friedman chi2 = {chi.value:.3f}, {p_text(chi.p)}")
        elif len(complete) > 2:
            rank = wilcoxon(*table.T, alpha, names)
            result.notes.append(f"without normality: Wilcoxon V = {rank.value:g}, {p_text(rank.p)}")
        return result
    groups = {c: np.array([np.mean(cells[p, c]) for p in complete if (p, c) in cells]) for c in names}
    if min(map(len, groups.values())) < 2:
        raise ValueError("fewer than two people have values in every condition")
    if test in ("welch_t", "anova"):
        require_spread(list(groups.values()))
    if test == "friedman":
        result = friedman(groups, alpha, correction)
    elif test in ("anova", "kruskal"):
        result = between(groups, test, alpha, correction)
    else:
        result = two_conditions(test, groups, alpha, len(complete) if is_within else sum(map(len, groups.values())))
    if len(cells) < len(values):
        result.notes.append("a person's trials of a condition are averaged")
    if left := len(persons) - len(complete):
        result.notes.append(f"{left} people without values in every condition are left out")
    return result
