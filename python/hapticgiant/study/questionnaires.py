"""Questionnaires: NASA TLX, SUS and own items; what they ask and how answers become scores."""

from __future__ import annotations

import dataclasses
import itertools

from hapticgiant.command_line import nearest

KINDS = ("nasa_tlx", "sus", "own")
MOMENTS = ("condition", "end")
ITEM_KINDS = ("likert", "slider", "text")
LONGEST_TEXT = 10000


@dataclasses.dataclass(frozen=True)
class Item:
    """One question: answered by a whole number of a Likert scale, a number on a slider, or a text."""

    kind: str
    text: dict[str, str]
    """By language."""
    low: float = 0
    high: float = 100
    step: float = 1
    ends: tuple[dict[str, str], dict[str, str]] = ({}, {})
    """What stands at the ends of the scale."""


@dataclasses.dataclass(frozen=True)
class Form:
    """A questionnaire."""

    kind: str
    after: str
    items: dict[str, Item]
    scores: dict[str, str]
    """What is computed from the answers, or is one: name and meaning."""
    pairs: tuple[tuple[str, str], ...] = ()
    """Of the weighted TLX: the 15 pairs, each answered by the item that mattered more."""


# The German texts of both are translations of this project and of no publication: `wording` takes others.
# Hart and Staveland, Development of NASA-TLX, 1988: six scales of 21 marks, 0 to 100 in steps of 5.
TLX = {
    "mental": ({"en": "Mental demand: how mentally demanding was the task?",
                "de": "Geistige Anforderung: Wie geistig anstrengend war die Aufgabe?"},
               ("very low", "very high"), ("sehr gering", "sehr hoch")),
    "physical": ({"en": "Physical demand: how physically demanding was the task?",
                  "de": "Körperliche Anforderung: Wie körperlich anstrengend war die Aufgabe?"},
                 ("very low", "very high"), ("sehr gering", "sehr hoch")),
    "temporal": ({"en": "Temporal demand: how hurried or rushed was the pace of the task?",
                  "de": "Zeitliche Anforderung: Wie gehetzt war das Tempo der Aufgabe?"},
                 ("very low", "very high"), ("sehr gering", "sehr hoch")),
    "performance": ({"en": "Performance: how successful were you in what you were asked to do?",
                     "de": "Leistung: Wie erfolgreich haben Sie die Aufgabe erledigt?"},
                    ("perfect", "failure"), ("perfekt", "misslungen")),
    "effort": ({"en": "Effort: how hard did you have to work for your performance?",
                "de": "Anstrengung: Wie sehr mussten Sie sich für Ihre Leistung anstrengen?"},
               ("very low", "very high"), ("sehr gering", "sehr hoch")),
    "frustration": ({"en": "Frustration: how insecure, discouraged, irritated or annoyed were you?",
                     "de": "Frustration: Wie unsicher, entmutigt, gereizt oder verärgert waren Sie?"},
                    ("very low", "very high"), ("sehr gering", "sehr hoch")),
}
# Brooke, SUS: a quick and dirty usability scale, 1996; odd items agree, even ones disagree.
SUS = (
    ("I think that I would like to use this system frequently.",
     "Ich kann mir gut vorstellen, dieses System häufig zu nutzen."),
    ("I found the system unnecessarily complex.", "Ich finde das System unnötig komplex."),
    ("I thought the system was easy to use.", "Ich finde, das System ist einfach zu benutzen."),
    ("I think that I would need the support of a technical person to be able to use this system.",
     "Ich glaube, ich bräuchte die Hilfe einer Fachperson, um dieses System zu benutzen."),
    ("I found the various functions in this system were well integrated.",
     "Ich finde, die Funktionen des Systems sind gut aufeinander abgestimmt."),
    ("I thought there was too much inconsistency in this system.",
     "Ich finde, das System ist zu uneinheitlich."),
    ("I would imagine that most people would learn to use this system very quickly.",
     "Ich glaube, dass die meisten Menschen dieses System sehr schnell erlernen."),
    ("I found the system very cumbersome to use.", "Ich finde das System sehr umständlich."),
    ("I felt very confident using the system.", "Ich habe mich beim Benutzen des Systems sehr sicher gefühlt."),
    ("I needed to learn a lot of things before I could get going with this system.",
     "Ich musste viel lernen, bevor ich mit dem System umgehen konnte."),
)
AGREEMENT = ({"en": "strongly disagree", "de": "stimme gar nicht zu"},
             {"en": "strongly agree", "de": "stimme völlig zu"})


def tlx_items() -> dict[str, Item]:
    return {name: Item("slider", text, 0, 100, 5, tuple({"en": en, "de": de} for en, de in zip(*ends)))
            for name, (text, *ends) in TLX.items()}


def sus_items() -> dict[str, Item]:
    return {f"item_{i:02}": Item("likert", {"en": en, "de": de}, 1, 5, 1, AGREEMENT)
            for i, (en, de) in enumerate(SUS, 1)}


def read_form(reader, name, node) -> Form:
    """The form of a node of study.yaml. Raises InputError."""
    item = f"questionnaires.{name}"
    parts = reader.map(node, item, ("kind", "after", "weighted", "items", "wording"))
    kind = reader.choice(parts, "kind", item, KINDS, "own")
    after = reader.choice(parts, "after", item, MOMENTS, "condition")
    if "weighted" in parts and kind != "nasa_tlx":
        reader.fault(parts["weighted"], item, "only the nasa_tlx is weighted")
    if kind != "own":
        if "items" in parts:
            reader.fault(parts["items"], item, f"the items of the {kind} are fixed: 'wording' changes their texts")
    elif "wording" in parts:
        reader.fault(parts["wording"], item, "own items have their texts: 'wording' is for nasa_tlx and sus")
    if kind == "nasa_tlx":
        items = _reworded(reader, tlx_items(), parts.get("wording"), f"{item}.wording")
        scores = {"raw": "raw TLX, mean of the six scales, 0 to 100"}
        is_weighted = reader.choice(parts, "weighted", item, ("true", "false"), "false") == "true"
        if is_weighted:
            scores["weighted"] = "weighted TLX: each scale counts as often as it won its 15 pairs"
        scores |= {each: f"TLX scale {each}, 0 to 100" for each in items}
        return Form(kind, after, items, scores,
                    tuple(itertools.combinations(items, 2)) if is_weighted else ())
    if kind == "sus":
        items = _reworded(reader, sus_items(), parts.get("wording"), f"{item}.wording")
        return Form(kind, after, items, {"score": "SUS score, 0 to 100"})
    items = {}
    for each, value in reader.names(parts.get("items"), f"{item}.items"):
        items[each] = _item(reader, value, f"{item}.{each}")
    if not items:
        reader.fault(node, item, "expected items")
    return Form(kind, after, items, {each: known.text.get("en", each) for each, known in items.items()
                                     if known.kind != "text"})


def _reworded(reader, items, node, item):
    """The items with the texts of the laboratory, in the languages that it gives."""
    for name, value in reader.names(node, item):
        if name not in items:
            reader.fault(value, f"{item}.{name}", f"no such item, did you mean '{nearest(name, items)}'?")
        parts = reader.map(value, f"{item}.{name}", ("text", "ends"))
        known, ends = items[name], _ends(reader, parts, f"{item}.{name}")
        text = reader.texts(parts["text"], f"{item}.{name}.text") if "text" in parts else {}
        items[name] = dataclasses.replace(known, text=known.text | text, ends=tuple(
            old | new for old, new in zip(known.ends, ends or ({}, {}))))
    return items


def _ends(reader, parts, item):
    ends = [reader.texts(end, f"{item}.ends") for end in reader.sequence(parts.get("ends"), f"{item}.ends")]
    if ends and len(ends) != 2:
        reader.fault(parts["ends"], item, "expected two ends")
    return ends


def _item(reader, node, item):
    parts = reader.map(node, item, ("kind", "text", "points", "from", "to", "step", "ends"))
    kind = reader.choice(parts, "kind", item, ITEM_KINDS)
    if kind is None or "text" not in parts:
        reader.fault(node, item, f"expected 'text' and 'kind': {', '.join(ITEM_KINDS)}")
    text = reader.texts(parts["text"], f"{item}.text")
    if kind == "text":
        return Item(kind, text)
    ends = _ends(reader, parts, item)
    low, high, step = 1, 7, 1
    if kind == "likert" and "points" in parts:
        high = reader.count(parts["points"], f"{item}.points")
    if kind == "slider":
        low, high, step = (reader.number(parts[key], f"{item}.{key}") if key in parts else default
                           for key, default in (("from", 0), ("to", 100), ("step", 1)))
    if not low < high or not 0 < step <= high - low:
        reader.fault(node, item, f"expected a scale that rises in steps, got {low} to {high} by {step}")
    return Item(kind, text, low, high, step, tuple(ends) or ({}, {}))


def problem_of(form: Form, answers: dict, pairs: dict) -> str | None:
    """What is wrong with a filled form; None: nothing."""
    for name, item in form.items.items():
        if name not in answers:
            return f"{name} has no answer"
        value = answers[name]
        if item.kind == "text":
            if not isinstance(value, str) or len(value) > LONGEST_TEXT:
                return f"{name}: expected a text of at most {LONGEST_TEXT} characters"
            continue
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not item.low <= value <= item.high:
            return f"{name}: expected a number from {item.low:g} to {item.high:g}, got {value!r}"
        steps = (value - item.low) / item.step
        if abs(steps - round(steps)) > 1e-9:
            return f"{name}: expected steps of {item.step:g} from {item.low:g}, got {value!r}"
    for pair in form.pairs:
        if pairs.get("/".join(pair)) not in pair:
            return f"the pair {' or '.join(pair)} has no answer"
    unknown = [*(set(answers) - set(form.items)), *(set(pairs) - {"/".join(pair) for pair in form.pairs})]
    return f"{unknown[0]}: no such item" if unknown else None


def scores_of(form: Form, answers: dict, pairs: dict | None = None) -> dict[str, float]:
    """Scores of filled forms: of one, or of many with an array for each answer.

    answers: by item. pairs: of the weighted TLX the winner by "first/second".
    """
    if form.kind == "sus":
        return {"score": 2.5 * sum((answers[name] - 1) if i % 2 == 0 else (5 - answers[name])
                                   for i, name in enumerate(form.items))}
    scores = {name: answers[name] for name, item in form.items.items() if item.kind != "text"}
    if form.kind == "nasa_tlx":
        raw = sum(scores.values()) / len(scores)
        if form.pairs:
            wins = {name: sum(winner == name for winner in pairs.values()) for name in scores}
            scores = {"weighted": sum(scores[name] * wins[name] for name in scores) / len(form.pairs)} | scores
        scores = {"raw": raw} | scores
    return scores
