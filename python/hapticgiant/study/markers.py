"""Markers of the Lab Streaming Layer around a study: what the study does goes out as a stream, what other
instruments send is kept beside the trials. docs/start/lab_streaming_layer.md.

Needs pylsl, which is imported only when one of the classes is made.
"""

from __future__ import annotations

import csv
import ctypes
import dataclasses
import inspect
import io
import json
import math
import os
import pathlib
import threading
import time

from hapticgiant import samples
from hapticgiant.study.description import ALL_STREAMS, OWN_STREAMS, Study

STUDY_STREAM = "HapticGiantStudy"
COLUMNS = {
    "stream": ("", "name of the stream"),
    "lsl_time_s": ("s", "time stamp of the sender, in its own clock; empty: it had none, or the row tells of a loss"),
    "clock_offset_s": ("s", "local clock of LSL of the study's computer minus that of the sender, the last known when "
                            "the marker came; empty: not measured"),
    "offset_error_s": ("s", "round trip of that measurement: the offset is wrong by at most this"),
    "run_time_s": ("s", "time of the trial's recording, by its lab clock; below 0: before the run began; "
                        "empty: there was no run or no clock"),
    "value": ("", "the text or number; of several channels a list")}
MOST_WAITING = 20_000  # markers of a stream that nobody has taken yet
MOST_STREAMS = 64
MOST_CHANNELS = 64
MOST_LETTERS = 1000  # of a value
CHUNK, MOST_CHUNKS = 1024, 16  # markers fetched at once from a stream before the next one has its turn
BUFFER = 600  # of LSL, in hundreds of markers
POLL_S, LOOK_S, MEASURE_S = 0.02, 0.5, 2.0
UNSEEN_S = 3.0  # a stream that has not answered for so long counts as away
GONE_S = 10.0  # and is looked for anew from then on
FAREWELL_S = 0.5  # for what readers have not fetched yet
_configured = False


class MarkerError(RuntimeError):
    """The Lab Streaming Layer cannot be used; the message says why."""


def load():
    """The package pylsl. Raises MarkerError."""
    global _configured
    try:
        import pylsl
    except (ImportError, OSError, RuntimeError) as error:
        raise MarkerError(f"lab_streaming: needs pylsl: pip install pylsl ({str(error).splitlines()[0]})") from None
    if "as_numpy" not in inspect.signature(pylsl.StreamInlet).parameters:
        raise MarkerError("lab_streaming: needs pylsl 1.18 or newer: pip install --upgrade pylsl")
    own = ("lsl_api.cfg", os.path.expanduser("~/lsl_api/lsl_api.cfg"), "/etc/lsl_api/lsl_api.cfg")
    if not _configured and "LSLAPICFG" not in os.environ and not any(map(os.path.exists, own)):
        pylsl.set_config_content("[log]\nlevel = -3\n")  # a sender that goes away is no error: state() tells
    _configured = True
    return pylsl


def require(study: Study) -> None:
    """Raises MarkerError where a study needs the Lab Streaming Layer and this Python has none."""
    if study.lab_streaming.outlets or study.lab_streaming.markers:
        load()


class StudyStream:
    """The stream HapticGiantStudy: what the study does, as text, with the time at which it did so."""

    def __init__(self, source: str):
        """source: the same for programs that continue a study, so that readers go on. Raises MarkerError."""
        pylsl = load()
        info = pylsl.StreamInfo(STUDY_STREAM, "Markers", 1, pylsl.IRREGULAR_RATE, pylsl.cf_string,
                                f"{STUDY_STREAM}_{source}")
        try:
            self._outlet = pylsl.StreamOutlet(info)
        except RuntimeError as error:
            raise MarkerError(f"lab_streaming: no stream can be opened: {error}") from None

    def mark(self, text: str) -> None:
        """Sends a text; never waits for a reader. After close() it does nothing."""
        if self._outlet is not None:
            self._outlet.push_sample([text])

    def close(self) -> None:
        """Closes the stream; where somebody reads, after half a second, in which the last texts are fetched."""
        if self._outlet is not None and self._outlet.have_consumers():
            time.sleep(FAREWELL_S)
        self._outlet = None


def words_of(code: str, step, what: str) -> str:
    """What StudyStream says of a planning.Step, as "P01 trial door 1 begin"; without a step, of the session."""
    if step is None:
        return f"{code} session {what}"
    text = step.text if step.text != step.kind else ""
    words = [code, step.kind, step.form, step.condition or text]
    return " ".join([*filter(None, words), *([str(step.repetition)] if step.repetition else []), what])


@dataclasses.dataclass
class Marker:
    """One marker as it came. Its offset can become known later than itself: it is filled in then."""

    stream: str
    lsl_time_s: float
    """In the clock of the sender; NaN: it had none."""
    value: str
    clock_offset_s: float = math.nan
    """To be added, so that the time is that of the local clock of LSL on this computer."""
    offset_error_s: float = math.nan


class _Source:
    """A stream that is read."""

    def __init__(self, pylsl, info):
        # LSL finds a sender again that begins anew under the same source; until then nothing comes
        self.inlet = pylsl.StreamInlet(info, max_buflen=BUFFER, recover=True)
        self.name = info.name()
        self.seen_s = self.measured_s = -math.inf
        self.offset, self.pending = (math.nan, math.nan), []

    def measure(self, lib):
        """Takes note of the offset that LSL measures in the background; of none while there is none."""
        remote, error, code = ctypes.c_double(), ctypes.c_double(), ctypes.c_int()
        lib.lsl_time_correction_ex.restype = ctypes.c_double
        offset = lib.lsl_time_correction_ex(self.inlet.obj, ctypes.byref(remote), ctypes.byref(error),
                                            ctypes.c_double(0.0), ctypes.byref(code))
        self.offset = (math.nan, math.nan) if code.value else (offset, error.value)
        if not code.value:
            for marker in self.pending:
                marker.clock_offset_s, marker.offset_error_s = self.offset
            self.pending = []


class Markers:
    """Collects markers of other instruments in a thread of its own; none of its functions waits for them."""

    def __init__(self, names):
        """names: of streams; "all": every stream of the type Markers but our own. Raises MarkerError."""
        self.problem = ""
        """Why nothing is collected any more; empty: all is well."""
        self._names = tuple(names)
        self._pylsl = load()
        from pylsl.lib import lib

        self._lib = lib
        self._lock = threading.Lock()  # guards the next four
        self._waiting: list[Marker] = []
        self._count = {name: 0 for name in self._names if name != ALL_STREAMS}
        self._kept, self._dropped, self._connected = {}, {}, set()
        self._end = threading.Event()
        self._thread = threading.Thread(target=self._run, name="markers", daemon=True)
        self._thread.start()

    def take(self) -> list[Marker]:
        """What has come since the last call, in the order in which it came. What did not fit is told by a marker
        without a time."""
        with self._lock:
            found, self._waiting, self._kept = self._waiting, [], {}
            lost, self._dropped = self._dropped, {}
        return found + [Marker(name, math.nan, f"{count} markers dropped") for name, count in lost.items()]

    def state(self) -> list[dict]:
        """For the operator's page: name, is_connected, count of what has come."""
        with self._lock:
            return [{"name": name, "is_connected": name in self._connected, "count": count}
                    for name, count in self._count.items()]

    def close(self) -> None:
        """Ends the thread. A sender that hangs is not waited for."""
        self._end.set()
        self._thread.join(2.0)

    def _run(self):
        try:
            resolver = self._pylsl.ContinuousResolver(forget_after=UNSEEN_S)
            sources, looked_s = {}, -math.inf
            while not self._end.wait(POLL_S):
                now_s = time.monotonic()
                if now_s >= looked_s + LOOK_S:
                    looked_s = now_s
                    self._look(resolver.results(), sources, now_s)
                for key in list(sources):
                    try:
                        self._fetch(sources[key], now_s)
                    except RuntimeError:  # lost, and without a source by which it could be found again
                        del sources[key]
        except Exception as error:  # the study goes on without markers, and says so
            self.problem = f"lab_streaming: {type(error).__name__}: {error}"
            with self._lock:
                self._connected = set()

    def _look(self, infos, sources, now_s):
        for info in infos:
            if not self._is_wanted(info):
                continue
            key = (info.name(), info.source_id() or info.uid(), info.hostname())
            if key not in sources and len(sources) < MOST_STREAMS:
                try:
                    sources[key] = _Source(self._pylsl, info)
                except RuntimeError:
                    continue
            if key in sources:
                sources[key].seen_s = now_s
        for key in [key for key, source in sources.items() if now_s > source.seen_s + GONE_S]:
            del sources[key]
        with self._lock:
            self._connected = {each.name for each in sources.values() if now_s <= each.seen_s + LOOK_S}
            for name in self._connected:
                if name in self._count or len(self._count) < 2 * MOST_STREAMS:
                    self._count.setdefault(name, 0)

    def _is_wanted(self, info):
        if info.nominal_srate() != self._pylsl.IRREGULAR_RATE or info.channel_count() > MOST_CHANNELS:
            return False  # a signal
        if info.name() in OWN_STREAMS:
            return False
        return info.name() in self._names or (ALL_STREAMS in self._names and info.type() == "Markers")

    def _fetch(self, source, now_s):
        is_known = not math.isnan(source.offset[0])
        if now_s >= source.measured_s + (MEASURE_S if is_known else 0.0):
            source.measured_s = now_s
            source.measure(self._lib)
        for _ in range(MOST_CHUNKS):
            values, stamps = source.inlet.pull_chunk(timeout=0.0, max_samples=CHUNK, as_numpy=True)
            if len(stamps):
                self._keep(source, values, stamps)
            if len(stamps) < CHUNK:
                break

    def _keep(self, source, values, stamps):
        name = source.name
        with self._lock:
            self._count[name] = self._count.get(name, 0) + len(stamps)
            kept = self._kept.get(name, 0)
            room = max(0, MOST_WAITING - kept)
            if len(stamps) > room:
                self._dropped[name] = self._dropped.get(name, 0) + len(stamps) - room
            found = [Marker(name, float(stamp), _text(row), *source.offset)
                     for row, stamp in zip(values[:room], stamps[:room])]
            self._kept[name] = kept + len(found)
            self._waiting += found
            if math.isnan(source.offset[0]):
                source.pending = (source.pending + found)[-MOST_WAITING:]


def _text(row) -> str:
    words = [_word(each) for each in row]
    return words[0] if len(words) == 1 else json.dumps(words, ensure_ascii=False)[:MOST_LETTERS]


def _word(value) -> str:
    if not isinstance(value, bytes):
        return str(value).removesuffix(".0")
    text = value[:4 * MOST_LETTERS].decode("utf-8", "backslashreplace")[:MOST_LETTERS]
    return text if text.isprintable() else "".join(
        each if each.isprintable() else each.encode("unicode_escape").decode() for each in text)


def run_time(lab_clock: list[samples.LabClock], clock_s: float) -> float:
    """The run time at which the local clock of LSL was this, s; NaN without a clock. The first offset counts from the
    beginning, another one from its time on; while run time stood still it is that time."""
    last_s = math.inf
    for place, (since_s, offset_s) in reversed(list(enumerate(lab_clock))):
        time_s = clock_s - offset_s
        if place == 0 or time_s >= since_s:
            return min(time_s, last_s)
        last_s = since_s
    return math.nan


def table(markers: list[Marker], lab_clock: list[samples.LabClock] = ()) -> str:
    """Markers as CSV with the columns of COLUMNS."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(COLUMNS)
    for each in markers:
        at_s = run_time(lab_clock, each.lsl_time_s + each.clock_offset_s)
        numbers = (each.lsl_time_s, each.clock_offset_s, each.offset_error_s, at_s)
        writer.writerow([each.stream, *(f"{x:.6f}" if math.isfinite(x) else "" for x in numbers), each.value])
    return out.getvalue()


def write(folder, code: str, step, markers: list[Marker],
          lab_clock: list[samples.LabClock] = ()) -> pathlib.Path:
    """Writes the markers of a trial beside its other files; its file. step: a planning.Step; None: of the time between
    steps, in the next file sub-CODE_run-N_markers.csv that is not there yet. Raises FolderError."""
    if step is not None:
        stem = folder.stem(code, step)
        file = stem.with_name(stem.name + "_markers.csv")
    else:
        number, own = 1, folder.path / f"sub-{code}"
        while (file := own / f"sub-{code}_run-{number}_markers.csv").exists():
            number += 1
    folder.write(file, table(markers, lab_clock))
    return file
