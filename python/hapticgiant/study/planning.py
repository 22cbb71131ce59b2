"""Before the study: the order of each participant, what would ruin the study, power, and the text of
the pre-registration.
"""

from __future__ import annotations

import dataclasses

import numpy as np
from scipy import stats

from hapticgiant.study import inference, people
from hapticgiant.study.description import Study
from hapticgiant.study.order import imbalance, orders, rows_of

GOOD_POWER = 0.8
SIMULATIONS = 500


@dataclasses.dataclass(frozen=True)
class Step:
    """One thing that a participant does. `study run` and `study simulate` go through the same."""

    kind: str
    """instruction, practice, trial, form or break."""
    condition: str = ""
    repetition: int = 0
    form: str = ""
    text: str = ""
    """Which instruction."""


@dataclasses.dataclass(frozen=True)
class Participant:
    """A code and the conditions in their order; nothing else is known of a person."""

    code: str
    conditions: tuple[str, ...]


def plan(study: Study, count: int | None = None) -> list[Participant]:
    """The participants; the first `count` of them. The same seed gives the same plan."""
    names = list(study.conditions)
    digits = max(2, len(str(study.design.participants)))
    found = [Participant(f"P{i:0{digits}}", tuple(names[entry] for entry in row))
             for i, row in enumerate(orders(study.design, len(names)), 1)]
    return found[:count]


def steps(study: Study, participant: Participant) -> list[Step]:
    """Everything that a participant does, in order."""
    found = [Step("instruction", text="start")] if "start" in study.instructions else []
    every, _ = study.breaks
    for done, condition in enumerate(participant.conditions):
        if every and done and done % every == 0:
            found.append(Step("break", text="break"))
        if condition in study.instructions:
            found.append(Step("instruction", condition, text=condition))
        found += [Step("practice", condition, i) for i in range(1, study.design.practice + 1)]
        found += [Step("trial", condition, i) for i in range(1, study.design.repetitions + 1)]
        found += [Step("form", condition, form=name) for name, form in study.forms.items()
                  if form.after == "condition"]
    own = participant.conditions[0] if study.design.kind == "between" else ""
    found += [Step("form", own, form=name) for name, form in study.forms.items() if form.after == "end"]
    if "end" in study.instructions:
        found.append(Step("instruction", text="end"))
    return found


def problems_of(study: Study) -> list[str]:
    """What would ruin the study and can be seen without playing it."""
    found = []
    names = list(study.conditions)
    rows = orders(study.design, len(names))
    seen = {entry for row in rows for entry in row}
    for i, name in enumerate(names):
        if i not in seen:
            found.append(f"condition {name} never occurs: {study.design.participants} participants, "
                         f"{len(names)} conditions between them, order {study.design.order}")
    block = rows_of(study.design, len(names))
    by_place, follows = imbalance(rows, len(names))
    if study.design.order != "random" and study.design.participants % block:
        low = study.design.participants // block * block
        found.append(f"the order is not balanced: {study.design.order} of {len(names)} conditions is "
                     f"balanced after each {block} participants, take {' or '.join(str(n) for n in (low, low + block) if n)}"
                     f" instead of {study.design.participants}")
    elif by_place > (1 if study.design.order == "random" else 0):
        found.append(f"the order is not balanced: of the same place, one condition has {by_place} more "
                     "participants than another; block_random or williams balances it")
    by_options = {}
    for name, condition in study.conditions.items():
        other = by_options.setdefault(tuple(sorted(condition.options.items())), name)
        if other != name:
            found.append(f"conditions {other} and {name} are the same")
    count = study.design.participants
    sizes = [count] if study.design.kind == "within" else [sum(row[0] == i for row in rows) for i in range(len(names))]
    for test in study.tests:
        least = inference.least_p(test.test, sizes)
        if least > study.alpha:
            kind = "signed ranks" if test.test == "wilcoxon" else "ranks"
            found.append(f"{test.outcome}: {kind} of {count} people cannot give p below {least:g}")
    found += _missing_languages(study)
    return found


def _missing_languages(study):
    texts = {f"instructions.{name}": text for name, text in study.instructions.items()}
    for name, form in study.forms.items():
        if form.kind == "own":
            texts |= {f"questionnaires.{name}.{item}": known.text for item, known in form.items.items()}
    languages = sorted({language for text in texts.values() for language in text})
    return [f"{name} has no text in '{language}', others have" for name, text in texts.items()
            for language in languages if language not in text]


def notes_of(study: Study) -> list[str]:
    """What is worth knowing and no fault."""
    names = list(study.conditions)
    found = []
    _, follows = imbalance(orders(study.design, len(names)), len(names))
    if study.design.kind == "within" and follows > 1:
        found.append(f"one condition follows another {follows} times more often than it follows a third: "
                     "carry-over is not balanced; williams balances it")
    if not study.tests:
        found.append("no test is planned: analysis.tests")
    if not study.exclusions:
        found.append("no exclusion criterion is planned")
    return found


@dataclasses.dataclass
class Power:
    """How often a planned test would find what simulation.expected says."""

    outcome: str
    test: str
    by_count: dict[int, tuple[float, float, float]]
    """People: share of simulated studies with p < alpha, and its 95 % interval."""
    false_alarms: tuple[float, float, float] | None = None
    """The same share where the conditions do not differ."""


def power(study: Study, counts: list[int] | None = None, simulations: int = SIMULATIONS) -> list[Power]:
    """Power of each planned test with an expectation, by simulated studies."""
    planned = study.design.participants
    counts = counts or sorted({max(4, planned // 2), planned, planned * 2})
    found = []
    for i, test in enumerate(study.tests):
        if not people.is_expected(study, test.outcome):
            continue
        one = Power(test.outcome, test.test, {})
        for count in counts:
            dice = np.random.default_rng([study.simulation_seed, i, count])
            one.by_count[count] = _share(study, test, count, simulations, dice, True)
        dice = np.random.default_rng([study.simulation_seed, i, 0])
        one.false_alarms = _share(study, test, planned, simulations, dice, False)
        found.append(one)
    return found


def _share(study, test, count, simulations, dice, differs):
    hits = sum(_p_value(test.test, people.draw(study, test.outcome, count, dice, differs)) < study.alpha
               for _ in range(simulations))
    interval = stats.binomtest(hits, simulations).proportion_ci(method="exact")
    return hits / simulations, interval.low, interval.high


def _p_value(test, groups):
    """The p value of the whole test, of means of people by condition; as the report computes it. 1 where there is none."""
    if min(map(len, groups)) < 2:
        return 1.0
    if test in ("friedman", "kruskal") and np.ptp(np.concatenate(groups)) == 0:
        return 1.0
    if test == "wilcoxon":
        return inference.signed_rank_p(inference.differences(*groups))
    if test in ("paired_t", "welch_t", "mann_whitney"):
        return getattr(inference, test)(*groups).p
    if test == "mixed":  # for balanced data the same
        return inference.repeated_anova(np.array(groups).T)[2]
    if test == "friedman":
        return stats.friedmanchisquare(*inference.for_ranks(groups)).pvalue
    return stats.f_oneway(*groups).pvalue if test == "anova" else stats.kruskal(*inference.for_ranks(groups)).pvalue


DESCRIBED = {
    "paired_t": "paired t test of people's means", "wilcoxon": "Wilcoxon's signed ranks of people's means",
    "friedman": "Friedman's test of people's means, then Wilcoxon's signed ranks of all pairs",
    "mixed": "linear mixed model by REML: condition fixed, people (and people x condition, where trials repeat) "
             "random; F with (people - 1)(conditions - 1) degrees of freedom",
    "welch_t": "Welch's t test", "mann_whitney": "Mann-Whitney U test",
    "anova": "one-way analysis of variance, then Welch's t tests of all pairs",
    "kruskal": "Kruskal-Wallis test, then Mann-Whitney U tests of all pairs"}


def preregistration(study: Study, found: list[Power]) -> str:
    """Markdown in the order of the usual forms: hypotheses, design, sample, measures, analysis."""
    design = study.design
    lines = [f"# Pre-registration: {study.title}", "",
             f"Generated by `hapticgiant study preregistration` from {study.file.name} "
             f"(sha256 {study.digest()}...).", "", "## Hypotheses", ""]
    lines += [f"- {test.outcome} ({study.outcomes[test.outcome]}) differs between {', '.join(study.conditions)}."
              for test in study.tests] or ["- none is tested."]
    kind = "Every participant plays all conditions" if design.kind == "within" else "Every participant plays one condition"
    lines += ["", "## Design", "",
              f"{kind}; order: {design.order}, seed {design.seed}. {design.repetitions} trials of a condition after "
              f"{design.practice} of practice.", ""]
    for name, condition in study.conditions.items():
        options = {**study.fixed, **condition.options}
        lines.append(f"- {name}: {', '.join(f'{key} = {value}' for key, value in options.items())}")
    lines += ["", "## Sample", "", f"{design.participants} participants; no data are looked at before all have taken part."]
    for one in found:
        share, low, high = one.by_count[design.participants]
        expected = study.expected.get(one.outcome)
        means = ", ".join(f"{name} {value:g}" for name, value in expected.means.items()) if expected else "by its items"
        lines.append(f"- {one.outcome}, {one.test}: power {share:.2f} [{low:.2f}, {high:.2f}] by simulation "
                     f"(expected: {means}).")
    lines += ["", "## Measures", ""]
    lines += [f"- {measure.name}{f' ({measure.unit})' if measure.unit else ''}: {measure.what}. `{measure.expression}`"
              for measure in study.measures.values()]
    for name, form in study.forms.items():
        lines.append(f"- {name}: {form.kind}, after each condition" if form.after == "condition"
                     else f"- {name}: {form.kind}, at the end")
    lines += ["", "## Exclusion", ""]
    lines += [f"- {each.kind}: {each.why} (`{each.expression}`)." for each in study.exclusions] or ["- none."]
    lines += ["", "## Analysis", "",
              f"alpha = {study.alpha:g}; pairs of conditions are corrected by {study.correction}, and so are, beside the "
              "plain p value, all planned tests together. Assumptions are reported and do not change the test.", ""]
    lines += [f"- {test.outcome}: {DESCRIBED[test.test]}." for test in study.tests]
    return "\n".join(lines) + "\n"
