"""The analysis of a study, from its tables: what `hapticgiant study report` prints.

    python code/analysis.py        in the folder of a study; needs numpy, scipy; for mixed models statsmodels

Reads code/plan.json (what was planned), participants.csv, trials.csv and answers.csv. This file and
inference.py beside it are all there is: HapticGiant is not needed.
"""

from __future__ import annotations

import csv
import json
import math
import pathlib
import sys

import numpy as np

if __package__:
    from hapticgiant.study import inference
else:
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
    import inference


OF_PLAN = {"people": str, "title": str, "conditions": list, "alpha": float, "correction": str, "outcomes": dict,
           "tests": list, "participants": int}
"""Keys of plan.json, and what each holds."""
COLUMNS = {"participants": ("participant", "complete", "excluded"),
           "trials": ("participant", "condition", "repetition", "excluded", "events_missing", "no_value"),
           "answers": ("participant", "condition", "form", "item", "kind", "value")}
"""Of the tables, those that are always read."""


class UnreadableError(ValueError):
    """A file of the study that cannot be read; the message says which."""


class Data:
    """Values of a study that count, by outcome."""

    def __init__(self, folder: pathlib.Path):
        self.plan = self._plan(folder / "code" / "plan.json")
        measures = tuple(outcome for outcome in self.plan["outcomes"] if "." not in outcome)
        self.participants, self.trials, self.answers = (
            self._table(folder / f"{name}.csv", columns + measures * (name == "trials")) for name, columns in COLUMNS.items())
        self.left_out = {row["participant"] for row in self.participants if row["excluded"]}
        self.withdrawn = self._withdrawn(folder / "withdrawn.json")
        """How many people have withdrawn: their data are deleted."""

    @staticmethod
    def _withdrawn(file):
        try:
            return len(json.loads(file.read_text(encoding="utf-8")))
        except FileNotFoundError:
            return 0
        except (ValueError, TypeError, RecursionError) as error:
            raise UnreadableError(f"{file}: is damaged: {error}") from None

    @staticmethod
    def _plan(file):
        try:
            plan = json.loads(file.read_text(encoding="utf-8"))
        except (ValueError, RecursionError) as error:
            raise UnreadableError(f"{file}: is damaged: {error}") from None
        for key, kind in OF_PLAN.items():
            if not isinstance(plan, dict) or not isinstance(plan.get(key), kind):
                raise UnreadableError(f"{file}: is damaged: '{key}' is missing, or is of another type")
        outcomes = list(plan["outcomes"])
        for test in plan["tests"]:
            if not isinstance(test, dict) or test.get("outcome") not in outcomes or test.get("test") not in inference.TESTS:
                raise UnreadableError(f"{file}: is damaged: no such test: {json.dumps(test)[:80]}")
        return plan

    @staticmethod
    def _table(file, columns):
        try:
            with open(file, newline="", encoding="utf-8") as lines:
                reader = csv.DictReader(lines, strict=True)
                rows, names = list(reader), reader.fieldnames or columns  # without rows there may be no names
        except (ValueError, csv.Error) as error:
            raise UnreadableError(f"{file}: is damaged: {error}") from None
        for number, row in enumerate([dict.fromkeys(names, ""), *rows]):
            if lost := [column for column in columns if row.get(column) is None]:
                raise UnreadableError(f"{file}: row {number} has no '{lost[0]}'")
        return rows

    @staticmethod
    def _number(outcome, cell):
        """The number in a cell; None: there is none, or one that nothing can be computed with."""
        try:
            value = float(cell) if cell else math.nan
        except ValueError:
            table = "answers.csv" if "." in outcome else "trials.csv"
            raise UnreadableError(f"{table}: {outcome}: expected a number, got '{cell[:40]}'") from None
        return value if abs(value) <= inference.LARGEST else None

    def values(self, outcome: str) -> tuple[list[float], list[str], list[str]]:
        """Values with their conditions and participants, without what is excluded."""
        if "." in outcome:
            form, item = outcome.split(".", 1)
            rows = [(row, row["value"]) for row in self.answers
                    if row["form"] == form and row["item"] == item and row["kind"] in ("answer", "score")]
        else:
            rows = [(row, row[outcome]) for row in self.trials if not row["excluded"]]
        rows = [(row, number) for row, value in rows if row["participant"] not in self.left_out
                and (number := self._number(outcome, value)) is not None]
        rank = {name: i for i, name in enumerate(self.plan["conditions"])}
        rows.sort(key=lambda each: rank.get(each[0]["condition"], -1))  # the order of study.yaml
        return ([value for _, value in rows], [row["condition"] for row, _ in rows],
                [row["participant"] for row, _ in rows])

    def counting(self) -> list[dict]:
        """Trials that are not left out."""
        return [row for row in self.trials if not row["excluded"] and row["participant"] not in self.left_out]

    def without(self, outcome: str) -> list[tuple[dict, str]]:
        """Trials that count, but have no value of this measure; why."""
        if "." in outcome:
            return []
        return [(row, self._why(outcome, row)) for row in self.counting() if self._number(outcome, row[outcome]) is None]

    @staticmethod
    def _why(outcome, row):
        reasons = dict(each.partition(": ")[::2] for each in row["no_value"].split("; "))
        return reasons.get(outcome) or row[outcome]

    def people(self, outcome: str) -> dict[str, np.ndarray]:
        """Means of people by condition; "" where it was asked once."""
        cells: dict[str, dict[str, list[float]]] = {}
        for value, condition, person in zip(*self.values(outcome)):
            cells.setdefault(condition, {}).setdefault(person, []).append(value)
        return {condition: np.array([np.mean(each) for each in people.values()])
                for condition, people in cells.items()}


def describe(data: Data) -> list[dict]:
    """Means of people by outcome and condition: count, mean, deviation, quartiles, ends."""
    found = []
    for outcome in data.plan["outcomes"]:
        for condition, values in data.people(outcome).items():
            low, middle, high = np.percentile(values, (25, 50, 75))
            found.append({"outcome": outcome, "condition": condition or "once", "people": len(values),
                          "mean": values.mean(), "sd": values.std(ddof=1) if len(values) > 1 else math.nan,
                          "median": middle, "q1": low, "q3": high, "min": values.min(), "max": values.max()})
    return found


def tests(data: Data) -> list[tuple[str, inference.Result | str, float]]:
    """Each planned test: outcome, result or why there is none, p corrected for all planned tests."""
    plan, found = data.plan, []
    for test in plan["tests"]:
        values, conditions, people = data.values(test["outcome"])
        missing = [name for name in plan["conditions"] if name not in conditions]
        try:
            if missing:
                raise ValueError(f"no values in condition {', '.join(missing)}")
            found.append(inference.run(test["test"], values, conditions, people, plan["alpha"], plan["correction"]))
        except (ValueError, np.linalg.LinAlgError) as error:
            found.append(str(error))
    for test, each in zip(plan["tests"], found):
        if not isinstance(each, str) and (words := missing_words(data, test["outcome"])):
            each.notes.append(words)
    done = [each for each in found if not isinstance(each, str)]
    corrected = iter(inference.adjusted([each.p for each in done], plan["correction"]))
    return [(test["outcome"], each, math.nan if isinstance(each, str) else next(corrected))
            for test, each in zip(plan["tests"], found)]


def missing_words(data: Data, outcome: str) -> str:
    """How many trials of each condition have no value of a measure; empty: all have one."""
    missing = [row["condition"] for row, _ in data.without(outcome)]
    if not missing:
        return ""
    played = [row["condition"] for row in data.counting()]
    return "without a value: " + ", ".join(f"{missing.count(name)} of {played.count(name)} trials of {name}"
                                           for name in data.plan["conditions"]) + "; the others are compared"


def degrees(df) -> str:
    return ", ".join(f"{each:.1f}".removesuffix(".0") for each in df)


def test_rows(data: Data, found) -> list[list[str]]:
    """The table of planned tests."""
    rows = [["outcome", "test", "people", "statistic", "p", f"p, {data.plan['correction']}", "effect size"]]
    for outcome, each, corrected in found:
        if isinstance(each, str):
            rows.append([outcome, f"none: {each}", "", "", "", "", ""])
            continue
        df = f"({degrees(each.df)})" if each.df else ""
        rows.append([outcome, each.test, str(each.count), f"{each.statistic}{df} = {each.value:.3f}",
                     inference.number(each.p), inference.number(corrected), f"{each.effect} = {each.size:.2f}"])
    return rows


def pair_rows(data: Data, found) -> list[list[str]]:
    """The table of pairs of conditions."""
    percent = f"{100 * (1 - data.plan['alpha']):g} %"
    rows = [["outcome", "conditions", "count", "difference", f"{percent} interval", "statistic", "p",
             f"p, {data.plan['correction']}", "effect size"]]
    for outcome, each, _ in found:
        for pair in [] if isinstance(each, str) else each.comparisons:
            df = "" if pair.df is None else f"({degrees([pair.df])})"
            rows.append([outcome, f"{pair.second} - {pair.first}", pair.counted, f"{pair.estimate:.3g}",
                         interval(pair.low, pair.high, pair.open_end), f"{pair.statistic}{df} = {pair.value:.3f}",
                         inference.number(pair.p), inference.number(pair.p_adjusted), f"{pair.effect} = {pair.size:.2f}"])
    return rows


def interval(low: float, high: float, open_end: str = "") -> str:
    """Both ends of an interval; a test by ranks of few people may have none. An open end is not within."""
    low, high = ("no end" if math.isinf(each) else f"{each + 0.0:.3g}" for each in (low, high))
    if low == high == "no end":
        return "none"
    return f"{'above ' if open_end == 'low' else ''}{low} to {'below ' if open_end == 'high' else ''}{high}"


def assumption_rows(found) -> list[list[str]]:
    """What was found of assumptions, and notes."""
    rows = [["outcome", "what was found"]]
    for outcome, each, _ in found:
        if not isinstance(each, str):
            rows += [[outcome, text] for text in each.assumptions + each.notes]
            rows += [[outcome, f"{pair.second} - {pair.first}: {pair.note}"] for pair in each.comparisons if pair.note]
            if each.variances:
                rows.append([outcome, "deviations: " + ", ".join(f"{name} {math.sqrt(max(0, value)):.3g}"
                                                                 for name, value in each.variances.items())])
    return rows


def description_rows(data: Data) -> list[list[str]]:
    """The descriptive table."""
    rows = [["outcome", "condition", "people", "mean", "sd", "median", "quartiles", "range"]]
    for each in describe(data):
        rows.append([each["outcome"], each["condition"], str(each["people"]), f"{each['mean']:.3g}",
                     f"{each['sd']:.3g}", f"{each['median']:.3g}", f"{each['q1']:.3g} to {each['q3']:.3g}",
                     f"{each['min']:.3g} to {each['max']:.3g}"])
    return rows


def participant_rows(data: Data) -> list[list[str]]:
    """How many people were planned, have begun, and count."""
    incomplete = sum(row["complete"] != "yes" for row in data.participants)
    return [["participants", "number"], ["planned", str(data.plan["participants"])],
            ["have begun", str(len(data.participants) + data.withdrawn)],
            ["have withdrawn; their data are deleted", str(data.withdrawn)],
            ["are left out by a criterion", str(len(data.left_out))],
            ["count", str(len(data.participants) - len(data.left_out))],
            ["have not done every trial and form, whether they count or not", str(incomplete)]]


def trial_rows(data: Data) -> list[list[str]]:
    """How many trials of each condition were played, count, and lack events or values."""
    rows = [["condition", "played", "left out", "count", "of these with events missing", "of these without a value"]]
    count = data.counting()
    measures = [outcome for outcome in data.plan["outcomes"] if "." not in outcome]
    for name in data.plan["conditions"]:
        played = sum(row["condition"] == name for row in data.trials)
        ours = [row for row in count if row["condition"] == name]
        lost = {outcome: sum(row["condition"] == name for row, _ in data.without(outcome)) for outcome in measures}
        rows.append([name, str(played), str(played - len(ours)), str(len(ours)), str(sum(bool(row["events_missing"]) for row in ours)),
                     ", ".join(f"{outcome} {number}" for outcome, number in lost.items() if number) or "0"])
    return rows


def exclusion_rows(data: Data) -> list[list[str]]:
    """What is left out, and why."""
    rows = [["participant", "trial", "why"]]
    rows += [[row["participant"], "all", row["excluded"]] for row in data.participants if row["excluded"]]
    rows += [[row["participant"], f"{row['condition']} {row['repetition']}", row["excluded"]
              + (f" (missing: {row['events_missing']})" if row["events_missing"] else "")]
             for row in data.trials if row["excluded"]]
    for outcome in data.plan["outcomes"]:  # a mean of the others would hide them
        rows += [[row["participant"], f"{row['condition']} {row['repetition']}", f"{outcome} has no value{why and ': ' + why}"]
                 for row, why in data.without(outcome)]
    return rows if len(rows) > 1 else [*rows, ["-", "-", "nothing is left out"]]


def main() -> None:
    try:
        data = Data(pathlib.Path(__file__).resolve().parents[1])
        found = tests(data)
        tables = (("tests", test_rows(data, found)), ("pairs", pair_rows(data, found)),
                  ("assumptions and notes", assumption_rows(found)), ("means of people", description_rows(data)),
                  ("participants", participant_rows(data)), ("trials", trial_rows(data)), ("left out", exclusion_rows(data)))
    except (OSError, UnreadableError) as error:
        sys.exit(str(error))
    print(data.plan["people"])
    for title, rows in tables:
        print(f"\n{title}")
        csv.writer(sys.stdout, lineterminator="\n").writerows(rows)


if __name__ == "__main__":
    main()
