"""Simulated people: how their hands differ and how they answer. A stated model, nothing more.

Hand: each KEY of simulation.hand is drawn once per person and condition from a normal distribution,
not below a tenth of its mean; a person who is above the mean in one condition is so in all.
Answers and measures: mean of the condition + offset of the person + deviation of the answer, both
normal (simulation.expected: between, within). Half of the variance between people is common to all
items of a form. Answers are rounded to the scale and cut at its ends; items without an expectation
are drawn around the middle of the scale. Winners of the TLX's pairs are drawn with odds by rating.
"""

from __future__ import annotations

import hashlib
import math

import numpy as np

from hapticgiant.study import questionnaires
from hapticgiant.study.description import Expected, Study

MODEL = ("Hands: parameters of simulation.hand, normal, drawn once per person. Answers: mean of the condition + "
         "offset of the person + deviation, normal, from simulation.expected, rounded and cut to the scale.")


def dice_of(study: Study, *what) -> np.random.Generator:
    """Random numbers that depend on the study's seed and on this, not on what was drawn before."""
    words = "/".join(map(str, (study.simulation_seed, *what)))
    return np.random.default_rng(list(hashlib.sha256(words.encode()).digest()))


def seed_of(study: Study, *what) -> int:
    """A seed for `hapticgiant run`."""
    return int(dice_of(study, "run", *what).integers(1, 2 ** 31))


def hand_of(study: Study, code: str, condition: str) -> dict[str, str]:
    """The parameters of this person's hand, as words."""
    found = {}
    for i, (key, (mean, deviation)) in enumerate(study.conditions[condition].hand.items()):
        offset = dice_of(study, "hand", code, i).standard_normal()
        value = mean + deviation * offset
        found[key] = f"{max(value, 0.1 * mean) if mean > 0 else value:.6g}"
    return found


def _expected_item(study, form, name):
    item = study.forms[form].items[name]
    known = study.expected.get(f"{form}.{name}")
    if known:
        return known
    middle, width = (item.low + item.high) / 2, item.high - item.low
    return Expected({each: middle for each in study.conditions}, 0.15 * width, 0.1 * width)


def answers_of(study: Study, code: str, form_name: str, condition: str) -> tuple[dict, dict]:
    """Answers by item, and winners of pairs; '' for free texts."""
    offsets = dice_of(study, "person", code, form_name).standard_normal((1 + len(study.forms[form_name].items), 1))
    answers, pairs = _fill(study, form_name, condition, offsets, dice_of(study, "answers", code, form_name, condition))
    found = {name: "" for name in study.forms[form_name].items}
    found |= {name: int(each[0]) if each[0].is_integer() else float(each[0]) for name, each in answers.items()}
    return found, {pair: str(each[0]) for pair, each in pairs.items()}


def _fill(study, form_name, condition, offsets, dice, differs=True):
    """Answers of people, a column of offsets each: common to the form, then of each item."""
    form, answers = study.forms[form_name], {}
    count = offsets.shape[1]
    for i, (name, item) in enumerate(form.items.items(), 1):
        if item.kind == "text":
            continue
        known = _expected_item(study, form_name, name)
        mean = known.means[condition] if condition and differs else np.mean(list(known.means.values()))
        value = mean + known.between * math.sqrt(0.5) * (offsets[0] + offsets[i]) \
            + known.within * dice.standard_normal(count)
        most = math.floor((item.high - item.low) / item.step + 1e-9)
        answers[name] = item.low + item.step * np.clip(np.round((value - item.low) / item.step), 0, most)
    pairs = {}
    for first, second in form.pairs:
        odds = (answers[first] + 5) / (answers[first] + answers[second] + 10)
        pairs[f"{first}/{second}"] = np.where(dice.random(count) < odds, first, second)
    return answers, pairs


def is_expected(study: Study, outcome: str) -> bool:
    """Whether simulation.expected says enough to simulate this outcome."""
    form = study.forms.get(outcome.partition(".")[0])
    if outcome in study.expected or form is None:
        return outcome in study.expected
    return any(f"{outcome.partition('.')[0]}.{item}" in study.expected for item in form.items)


def draw(study: Study, outcome: str, count: int, dice: np.random.Generator, differs: bool) -> list[np.ndarray]:
    """Means of `count` simulated people by condition; differs: as expected, or all conditions alike."""
    is_within = study.design.kind == "within"
    names = list(study.conditions)
    sizes = [count] * len(names) if is_within else [len(range(i, count, len(names))) for i in range(len(names))]
    form = outcome.partition(".")[0]
    if outcome in study.expected and form not in study.forms:
        known = study.expected[outcome]
        mean = float(np.mean(list(known.means.values())))
        offset = dice.standard_normal(count) * known.between
        within = known.within / math.sqrt(study.design.repetitions)
        return [(known.means[name] if differs else mean)
                + (offset if is_within else known.between * dice.standard_normal(size))
                + within * dice.standard_normal(size) for name, size in zip(names, sizes)]
    offsets = dice.standard_normal((1 + len(study.forms[form].items), count))
    found = []
    for i, name in enumerate(names):
        own = offsets if is_within else offsets[:, i::len(names)]
        answers, pairs = _fill(study, form, name, own, dice, differs)
        found.append(questionnaires.scores_of(study.forms[form], answers, pairs)[outcome.partition(".")[2]])
    return found
