"""Files of YAML that describe runs: values as words, keys with their places, faults with file, line,
column and the nearest name. Sweeps and user studies are read by it.
"""

from __future__ import annotations

import functools
import json
import os
import pathlib

from hapticgiant.command_line import nearest

OPTIONS = {"scenario": "", "device": "--device", "twin": "--twin", "user": "--user",
           "simulation": "--simulation", "plant": "--plant", "sensors": "--sensors",
           "hand": "--hand", "seed": "--seed", "law": "--law", "rate_Hz": "--rate-hz",
           "step_s": "--step", "duration_s": "--duration"}
"""Options of `hapticgiant run` that a sweep or a study may give, and how the command line calls them."""
RETIRED = {"bounds": "device.rendering.bounds", "gantry": "device.rendering.gantry",
           "braking": "device.rendering.braking", "passivity": "device.passivity.reaction"}
"""Options of earlier versions, and the key that takes their place."""
FILES = ("scenario", "device", "twin", "user", "simulation")  # options that may name a file
PARTS = ("scenario", "device", "simulation", "twin", "script")  # before the dot of a key
MOST = 1_000_000  # of anything that is counted
LARGEST = 1e100  # of numbers: a larger one cannot be squared


class InputError(ValueError):
    """A fault of a file; the message has file, line and column."""


def value_of(words: str):
    """The number, truth value or text that these words of YAML stand for."""
    if words in ("true", "false"):
        return words == "true"
    for kind in (int, float):
        try:
            return kind(words)
        except ValueError:
            continue
    return words


def arguments_of(options: dict[str, str], folder: pathlib.Path) -> list[str]:
    """The words after `hapticgiant run` for options and keys; files are looked for in the folder."""
    def file_or_name(key, value):
        return _file_beside(folder, value) if key in FILES else value

    words = [file_or_name("scenario", options.get("scenario", "door"))]
    for key, value in options.items():
        if key == "scenario":
            continue
        if key in OPTIONS:
            words += [OPTIONS[key], file_or_name(key, value)]
        else:
            words += ["--set", f"{key}={value}"]
    return words


NUMBERS = ("seed", "rate_Hz", "step_s", "duration_s")  # options


def request_of(options: dict[str, str], folder: pathlib.Path) -> dict:
    """The same as a request of `hapticgiant run --request`: docs/reference/run_protocol.md."""
    request = {"scenario": _file_beside(folder, options.get("scenario", "door"))}
    for key, value in options.items():
        if key in NUMBERS:
            number = value_of(value)
            is_whole = isinstance(number, float) and number.is_integer()
            request[_key_of(key)] = int(number) if is_whole else number
        elif key in OPTIONS:
            request[_key_of(key)] = _file_beside(folder, value) if key in FILES else value
        else:
            request.setdefault("set", []).append(f"{key}={value}")
    return request


def _key_of(option):
    return OPTIONS[option].removeprefix("--").replace("-", "_") or option


@functools.cache
def _file_beside(folder, name):
    beside = folder / name
    return str(beside.resolve()) if beside.is_file() else name


class Placed:
    """What was read from a file and knows where its keys stand."""

    file: pathlib.Path
    places: dict[str, str]

    def place(self, key: str) -> str:
        """Where a key stands; else the first one in it, else the longest one around it."""
        places = {known.replace('"', ""): place for known, place in self.places.items()}
        key = key.replace('"', "")  # a name with a dot stands in quotes
        if key in places:
            return places[key]
        inside = [known for known in places if known.startswith((key + ".", key + "["))]
        around = [known for known in places if key.startswith((known + ".", known + "["))]
        nearest = inside or sorted(around, key=len)[-1:]
        return places[nearest[0]] if nearest else str(self.file)


class Reader:
    """One file of YAML, read node by node."""

    def __init__(self, file: str | os.PathLike):
        self.file = pathlib.Path(file)
        self.places = {}
        """Where a key of a run stands: "door.yaml:7:3"."""

    def root(self):
        """The node of the whole file. Raises InputError."""
        import yaml

        try:
            text = self.file.read_text(encoding="utf-8")
            root = yaml.compose(text, Loader=yaml.SafeLoader)
        except (OSError, UnicodeDecodeError) as error:
            raise InputError(f"{self.file}: cannot be read: {error}") from None
        except RecursionError:
            raise InputError(f"{self.file}: not valid YAML: nested too deeply") from None
        except yaml.YAMLError as error:
            mark = getattr(error, "problem_mark", None)
            place = f"{self.file}:{mark.line + 1}:{mark.column + 1}" if mark else str(self.file)
            raise InputError(f"{place}: not valid YAML: {getattr(error, 'problem', error)}") from None
        self.nodes = yaml.nodes
        if root is None:
            raise InputError(f"{self.file}: expected a map of keys, got nothing")
        return root

    def fault(self, node, item, what):
        mark = node.start_mark
        place = f"{self.file}:{mark.line + 1}:{mark.column + 1}: "
        raise InputError(place + (f"{item}: " if item else "") + what)

    def words(self, node):
        """A value in one line, as it can stand behind --set KEY=."""
        if isinstance(node, self.nodes.ScalarNode):
            return node.value
        if isinstance(node, self.nodes.SequenceNode):
            return f"[{', '.join(map(self.inner_words, node.value))}]"
        pairs = (f"{self.inner_words(k)}: {self.inner_words(v)}" for k, v in node.value)
        return "{" + ", ".join(pairs) + "}"

    def inner_words(self, node):
        is_quoted = isinstance(node, self.nodes.ScalarNode) and node.style is not None
        return json.dumps(node.value) if is_quoted else self.words(node)

    def map(self, node, item, known=None):
        if not isinstance(node, self.nodes.MappingNode):
            self.fault(node, item, "expected a map of keys")
        result = {}
        for key, value in node.value:
            name = self.words(key)
            if name in result:
                self.fault(key, name, "given twice")
            if known and name not in known:
                self.fault(key, name, f"unknown key, did you mean '{nearest(name, known)}'?")
            result[name] = value
        return result

    def keys(self, node):
        """A map whose keys are options or keys of files."""
        if node is None:
            return {}
        result = self.map(node, "")
        for key, _ in node.value:
            name = self.words(key)
            self.places[name] = f"{self.file}:{key.start_mark.line + 1}:{key.start_mark.column + 1}"
            part = name.partition(".")[0]
            if "." in name and part not in PARTS:
                self.fault(key, name, f"no such part, did you mean '{nearest(part, PARTS)}'? "
                                      f"They are {', '.join(PARTS)}")
            if "." not in name and name not in OPTIONS:
                if name in RETIRED:
                    self.fault(key, name, f"is no option any more: use {RETIRED[name]}")
                self.fault(key, name, f"no such option, did you mean '{nearest(name, OPTIONS)}'? "
                                      f"They are {', '.join(OPTIONS)}")
        for key, value in result.items():
            for one in value.value if isinstance(value, self.nodes.SequenceNode) else [value]:
                words = self.words(one)
                if key in OPTIONS and words.startswith("-") and isinstance(value_of(words), str):
                    self.fault(one, key, f"expected a value, got the option '{words}'")
        return result

    def number(self, node, item):
        value = value_of(self.words(node))
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) <= LARGEST:
            self.fault(node, item, f"expected a number, got '{self.words(node)}'")
        return value

    def count(self, node, item):
        value = self.number(node, item)
        if not isinstance(value, int) or not 1 <= value <= MOST:
            self.fault(node, item, f"expected a whole number from 1 to {MOST}, got '{value}'")
        return value
