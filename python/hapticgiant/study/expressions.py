"""Measures as expressions over recorded columns: a small part of Python's syntax, safely evaluated.

    max(norm(robot.w_h[0], robot.w_h[1], robot.w_h[2]))

There are numbers, columns, + - * / ** %, comparisons, and, or, not, and the functions below; nothing
else of Python can be written, so that a study of somebody else can be opened without trust.
"""

from __future__ import annotations

import ast
import fnmatch
import operator

import numpy as np
import scipy.integrate

from hapticgiant.sweep.reader import nearest

LONGEST = 1000  # characters of an expression
DEEPEST = 50


class ExpressionError(ValueError):
    """An expression that cannot be read or evaluated."""


SHIPPED = {
    "time_s": ("last_event() - first_event()", "s",
               "time from the first to the last event of the scenario; none where an event is missing"),
    "duration_s": ("duration()", "s", "time that the handle could be felt"),
    "path_length_m": ("path_length(handle.p[0], handle.p[1], handle.p[2])", "m",
                      "length of the path of the handle"),
    "peak_force_N": ("max(norm(robot.w_h[0], robot.w_h[1], robot.w_h[2]))", "N",
                     "largest force between hand and handle"),
    "mean_force_N": ("mean(norm(robot.w_h[0], robot.w_h[1], robot.w_h[2]))", "N",
                     "mean force between hand and handle"),
    "checkpoints": ("events('checkpoint *')", "", "checkpoints that were reached"),
    "missing_events": ("summary('missing_events')", "", "events of the scenario that have not come"),
    "limit_contacts": ("spells(felt_limit >= 0, 0.1)", "",
                       "how often a limit was felt; less than 0.1 s apart it is the same contact"),
}
"""Measures that need no expression: expression, unit, meaning."""

def _known(function):
    """The same of numbers, and no number where one of them is none: a comparison would be false, a power 1."""
    return lambda *x: np.where(np.any([np.isnan(each) for each in np.broadcast_arrays(*x)], axis=0), np.nan, function(*x))


def _and(a, b):
    return np.where((a == 0) | (b == 0), 0, np.where(np.isnan(a) | np.isnan(b), np.nan, 1))


def _or(a, b):
    return 1 - _and(1 - np.sign(np.abs(a)), 1 - np.sign(np.abs(b)))


FUNCTIONS = {
    "abs": np.abs, "sqrt": np.sqrt, "exp": np.exp, "log": np.log, "sin": np.sin, "cos": np.cos,
    "max": np.max, "min": np.min, "mean": np.mean, "median": np.median, "sum": np.sum,
    "std": lambda x: np.std(x, ddof=1), "rms": lambda x: np.sqrt(np.mean(np.square(x))),
    "first": lambda x: np.atleast_1d(x)[0], "last": lambda x: np.atleast_1d(x)[-1],
    "count": lambda x: np.nan if np.isnan(x).any() else np.count_nonzero(x),
    "norm": lambda *x: np.sqrt(sum(np.square(each) for each in x)),
    "path_length": lambda *x: np.sum(np.sqrt(sum(np.square(np.diff(each)) for each in x))),
}
OF_A_TRIAL = {"event": 1, "events": 1, "first_event": 0, "last_event": 0, "duration": 0,
              "integral": 1, "derivative": 1, "spells": 2, "summary": 1}
"""Functions that need the trial, and how many arguments they take."""
OF_SEVERAL = ("norm", "path_length")
"""Functions of one argument or more; every other one of FUNCTIONS takes one."""
OPERATORS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul,
             ast.Div: np.divide, ast.Mod: np.mod, ast.Pow: _known(np.float_power),
             ast.UAdd: operator.pos, ast.USub: operator.neg, ast.Not: _known(np.logical_not),
             ast.Lt: _known(operator.lt), ast.LtE: _known(operator.le), ast.Gt: _known(operator.gt),
             ast.GtE: _known(operator.ge), ast.Eq: _known(operator.eq), ast.NotEq: _known(operator.ne),
             ast.And: _and, ast.Or: _or}


def parse(text: str) -> ast.expr:
    """The tree of an expression. Raises ExpressionError for what is not allowed."""
    if len(text) > LONGEST:
        raise ExpressionError(f"expected at most {LONGEST} characters")
    try:
        tree = ast.parse(text, mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise ExpressionError(f"not an expression: {getattr(error, 'msg', error)}") from None
    _check(tree, 0)
    return tree


def _check(node, depth):
    if depth > DEEPEST:
        raise ExpressionError("nested too deeply")
    inner = []
    if isinstance(node, ast.Constant):
        if isinstance(node.value, bool) or not isinstance(node.value, (int, float)):
            raise ExpressionError(f"{ast.unparse(node)} is not a number")
    elif isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
        inner = [node.left, node.right]
    elif isinstance(node, ast.UnaryOp) and type(node.op) in OPERATORS:
        inner = [node.operand]
    elif isinstance(node, ast.BoolOp):
        inner = node.values
    elif isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in OPERATORS:
        inner = [node.left, *node.comparators]
    elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
        known = [*FUNCTIONS, *OF_A_TRIAL]
        name = node.func.id
        if name not in known:
            raise ExpressionError(f"no such function as '{name}', did you mean '{nearest(name, known)}'?")
        wanted = OF_A_TRIAL.get(name, None if name in OF_SEVERAL else 1)
        if wanted is not None and len(node.args) != wanted or not node.args and wanted is None:
            raise ExpressionError(f"{name}: expected {wanted if wanted is not None else 'some'} "
                                  f"argument{'' if wanted == 1 else 's'}, got {len(node.args)}")
        if name in ("event", "events", "summary"):
            if not (isinstance(node.args[0], ast.Constant) and isinstance(node.args[0].value, str)):
                raise ExpressionError(f"{name}: expected a text in quotes")
        else:
            inner = node.args
    elif _column(node) is None:
        raise ExpressionError(f"'{ast.unparse(node)}' cannot be used here")
    for each in inner:
        _check(each, depth + 1)


def _column(node):
    """The name of the column that this names; None for anything else."""
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.Attribute):
        inner = _column(node.value)
        return inner and f"{inner}.{node.attr}"
    if isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Constant) \
            and isinstance(node.slice.value, int) and not isinstance(node.value, ast.Subscript):
        inner = _column(node.value)
        return inner and f"{inner}[{node.slice.value}]"
    return None


def names_of(tree: ast.expr) -> list[str]:
    """The columns that an expression reads."""
    found, rest = [], [tree]
    while rest:
        node = rest.pop()
        name = _column(node)
        if name is not None:
            found.append(name)
        elif isinstance(node, ast.Call):
            rest += node.args
        else:
            rest += list(ast.iter_child_nodes(node))
    return sorted(set(found))


def functions_of(tree: ast.expr) -> list[str]:
    """The functions that an expression calls."""
    return sorted({node.func.id for node in ast.walk(tree) if isinstance(node, ast.Call)})


def is_true(text: str, values: dict[str, float]) -> bool:
    """Whether an expression over plain numbers is true; a result that is no number is not."""
    value = evaluate(parse(text), Trial({name: np.float64(each) for name, each in values.items()}))
    return bool(value) and value == value


class Trial:
    """What an expression can ask: columns by name, events, those of the task that are missing, the summary of the run."""

    def __init__(self, columns: dict[str, np.ndarray], events=(), summary=None, missing=()):
        self.columns, self.events, self.summary, self.missing = columns, list(events), summary or {}, list(missing)

    def call(self, name, args):
        if name in ("event", "events"):
            times = [time for time, event in self.events if fnmatch.fnmatchcase(event, args[0])]
            return len(times) if name == "events" else times[0] if times else np.nan
        if name == "first_event":
            return self.events[0][0] if self.events else np.nan
        if name == "last_event":  # of the task: one that came before it is not its end
            return self.events[-1][0] if self.events and not self.missing else np.nan
        if name == "summary":
            return float(self.summary[args[0]]) if args[0] in self.summary else np.nan
        time = self.columns["time_s"]
        if name == "duration":
            return time[-1] - time[0] if len(time) else np.nan
        if name == "spells":  # of truth, joined over gaps shorter than the second argument, s
            if np.isnan(args[0]).any():
                return np.nan
            at = time[np.broadcast_to(np.asarray(args[0], bool), time.shape)]
            return np.count_nonzero(np.diff(at) > args[1]) + (1 if len(at) else 0)
        values = np.broadcast_to(np.asarray(args[0], float), time.shape)  # a truth value is 0 or 1
        return scipy.integrate.trapezoid(values, time) if name == "integral" else np.gradient(values, time)


def why_no_number(tree: ast.expr, trial: Trial) -> str:
    """Why an expression gives no number in this trial: the first event that it needs and that has not happened."""
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call):
            continue
        if node.func.id == "last_event" and trial.missing:
            return f"event '{trial.missing[0]}' is missing"
        if node.func.id in ("first_event", "last_event") and not trial.events:
            return f"event '{trial.missing[0]}' is missing" if trial.missing else "there was no event"
        if node.func.id == "event" and not trial.call("events", [node.args[0].value]):
            return f"event '{node.args[0].value}' is missing"
    return "its expression gives no number"


def evaluate(tree: ast.expr, trial: Trial) -> float:
    """The number that an expression gives. Raises ExpressionError, also for what is no number."""
    with np.errstate(all="ignore"):
        try:
            value = _value(tree, trial)
        except (ValueError, TypeError, IndexError, ZeroDivisionError, OverflowError) as error:
            raise ExpressionError(f"{ast.unparse(tree)}: {error}") from None
    if np.ndim(value) != 0:
        raise ExpressionError(f"{ast.unparse(tree)} has a value per sample; take its max, mean, "
                              "rms, last ...")
    return float(value)


def _value(node, trial):
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str) else float(node.value)
    if isinstance(node, ast.BinOp):
        return OPERATORS[type(node.op)](_value(node.left, trial), _value(node.right, trial))
    if isinstance(node, ast.UnaryOp):
        return OPERATORS[type(node.op)](_value(node.operand, trial))
    if isinstance(node, ast.Compare):
        return OPERATORS[type(node.ops[0])](_value(node.left, trial), _value(node.comparators[0], trial))
    if isinstance(node, ast.BoolOp):
        values = [_value(each, trial) for each in node.values]
        result = values[0]
        for each in values[1:]:
            result = OPERATORS[type(node.op)](result, each)
        return result
    if isinstance(node, ast.Call):
        args = [_value(each, trial) for each in node.args]
        function = FUNCTIONS.get(node.func.id)
        return function(*args) if function else trial.call(node.func.id, args)
    name = _column(node)
    if name not in trial.columns:
        raise ExpressionError(f"no column is called '{name}', did you mean "
                              f"'{nearest(name, trial.columns)}'?")
    return trial.columns[name]
