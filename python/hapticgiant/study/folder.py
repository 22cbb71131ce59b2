"""The folder of a study.

    study.yaml                     as it was when the study began
    dataset_description.json       who has made it, and whether people are simulated
    README.md .bidsignore          what the folder is; what BIDS does not know of it
    WHAT_IS_STORED.md              for participants and ethics boards
    sub-P01/sub-P01_task-door_run-1_trial.json    measures, events, hashes of one trial
    sub-P01/sub-P01_task-door_run-1_recording.mcap
    sub-P01/sub-P01_task-door_form-tlx_answers.json
    sub-P01/sub-P01_note-1.json    a remark of the operator
    sub-P01/aside/                 trials that were put aside and played again, and why
    sub-P01/sub-P01_task-door_run-1_markers.csv         markers of other instruments, see markers.py
    sub-P01/sub-P01_run-1_markers.csv                   those between trials
    trials.csv answers.csv participants.csv, .parquet   tidy tables, made of the files above
    data_dictionary.csv            every column of the tables
    hashes.sha256                  of all files: sha256sum -c hashes.sha256

The files of sub-* are what was measured. Each is written once, whole, when its step ends: a study
that is killed loses the step that is running. Tables are made of them anew whenever asked for.
"""

from __future__ import annotations

import contextlib
import csv
import errno
import fcntl
import io
import json
import os
import pathlib
import re
import shutil
import stat
import sys
import threading

from hapticgiant.study import markers, questionnaires, trials
from hapticgiant.study.description import Study, load_study
from hapticgiant.study.planning import Participant, Step, plan, steps
from hapticgiant.sweep.reader import InputError, nearest

FORMAT = 1
DESCRIPTION = "dataset_description.json"
TABLES = ("participants", "trials", "answers")
RUNNING = ".running"
WITH_FILES = ("trial", "form")  # kinds of steps that leave a file
LOCK = ".lock"
ASIDE = "aside"
TRIAL = "_trial.json"
OF_STUDY = {"Study": str, "Simulated": bool, "Model": str, "GeneratedBy": list}  # keys of files, and what each holds
OF_TRIAL = {"position": int, "condition": str, "repetition": int, "measures": dict, "exit_code": int, "state_hash": str,
            "recording_sha256": str, "recording": str | None}
OF_TRIAL_SINCE = {"missing_events": list, "no_value": dict}  # keys that trials of older versions lack
OF_FORM = {"condition": str, "form": str, "answers": dict, "pairs": dict}
OF_NOTE = {"step": int, "text": str}
LARGEST = 1 << 53  # of whole numbers
NOTE = re.compile(r"sub-\w+_note-([0-9]+)\.json")
PARTIAL = re.compile(r"\..+\.[0-9]+")  # a file that is being written, see _put()
WITHDRAWN = "withdrawn.json"
STUDY = "study.yaml"
REPORTS = ("report.html", "report.tex", "report.json", "figures")
BIDS = "1.10.0"
BIDS_IGNORE = ("*.csv", "*.parquet", "*.mcap", "*_trial.json", "*_answers.json", "WHAT_IS_STORED.md", WITHDRAWN, STUDY,
               "hashes.sha256", "report.*", "figures/")
README = """\
# {title}

A user study, made with HapticGiant {version}. {people}

`participants.csv`, `trials.csv` and `answers.csv` have a row per person, trial and answer; `data_dictionary.csv` says
what each column is. They are made of the files in `sub-*`. `study.yaml` is the study as it was when it began,
`WHAT_IS_STORED.md` is for participants and ethics boards. `sha256sum -c hashes.sha256` checks that all is as it was;
`python code/analysis.py` computes the tests of the report again.

Names and `dataset_description.json` are those of BIDS, tables are CSV instead of TSV. What BIDS does not know is listed
in `.bidsignore`; authors, licence and ethics approvals are missing in `dataset_description.json`: add them before the
data are published.
"""
STORED = """\
# What is stored

- A code for each participant ({codes}). No name, address, age, picture or voice is asked for or stored. Who
  has which code is on no file of this folder.
- Of each trial: condition, repetition, measures, names and times of events ({trial}).{recording}
- Of each questionnaire: the answers, among them free texts as they were typed. A free text can tell who
  somebody is: read them before the data are published.{markers}
- Remarks of the operator (sub-*/*_note-*.json), and of trials that were put aside the reason (sub-*/aside/): texts as they
  were typed, without names if the operator keeps to it. The language in which forms were answered.
- Times of day are not stored in tables; recordings have the date in their metadata.

`hapticgiant study forget CODE` deletes everything of one participant: files, rows of tables, and the reports; `study
report` makes those anew. The code stays in {withdrawn}, so that nobody gets it again.
"""


MARKERS = """
- Markers (sub-*/*_markers.csv) of these streams of other instruments, with their times: {names}. What they say is
  up to those who send them: read them, too."""


class FolderError(RuntimeError):
    """A folder that cannot be used; the message says what to do."""


class Folder:
    """The folder of one study."""

    def __init__(self, study: Study | None, path: str | os.PathLike | None = None):
        """study: None where it cannot be read; then only forget() works."""
        self.study = study
        self.path = pathlib.Path(path) if path is not None else study.file.with_suffix(".study")
        self.notes: list[str] = []
        """What forget() could not do as usual."""
        self._lock = None
        self._inner, self._depth, self._tables = threading.RLock(), 0, None

    @classmethod
    def as_it_was(cls, file: str | os.PathLike, path: str | os.PathLike | None) -> Folder:
        """The folder with the study as it was when it began, whatever has become of the file since; without the study
        where that cannot be read any more. Raises InputError where there is no folder either."""
        path = pathlib.Path(path) if path is not None else pathlib.Path(file).with_suffix(".study")
        own = path / STUDY
        try:
            return cls(load_study(own if own.exists() else file), path)
        except InputError as error:
            if not any(path.glob("sub-*")) and not (path / DESCRIPTION).exists():
                raise
            found = cls(None, path)
            found.notes.append(f"the study cannot be read: {error}")
            return found

    def exists(self) -> bool:
        return (self.path / DESCRIPTION).exists()

    def description(self) -> dict:
        try:
            found = _read(self.path / DESCRIPTION, OF_STUDY)
        except FileNotFoundError:
            raise FolderError(f"{self.path}: holds no study; hapticgiant study simulate makes one") from None
        if not all(isinstance(each, dict) and isinstance(each.get("Version"), str) for each in found["GeneratedBy"] or [0]):
            raise FolderError(f"{self.path / DESCRIPTION}: is damaged: 'GeneratedBy' has no version")
        return found

    def begin(self, version: str, is_simulated: bool, model: str = "") -> None:
        """Makes the folder, or checks that it is of this study; only one process may write there."""
        self.path.mkdir(mode=0o700, parents=True, exist_ok=True)
        is_ours = self.exists() or (self.path / LOCK).exists()  # also one whose begin was interrupted
        if not is_ours and any(not each.name.startswith(".") for each in self.path.iterdir()):
            raise FolderError(f"{self.path}: is no study and not empty: take another --out")
        self._take()
        description = {
            "Name": self.study.title, "BIDSVersion": BIDS, "DatasetType": "raw", "HapticGiantFormat": FORMAT,
            "Study": self.study.digest(), "Simulated": is_simulated, "Model": model,
            "GeneratedBy": [{"Name": "HapticGiant", "Version": version}]}
        if self.exists():
            self.require(description)
        else:
            self.replace(self.path / STUDY, self.study.file.read_bytes())
            people = "Its people are simulated." if is_simulated else "Its people took part in person."
            self.replace(self.path / "README.md",
                         README.format(title=self.study.title, version=version, people=people))
            self.replace(self.path / ".bidsignore", "".join(f"{each}\n" for each in BIDS_IGNORE))
            self.write(self.path / DESCRIPTION, trials.dump(description))
        _remove(self.path / RUNNING)  # what a crash has left

    def _open_lock(self, name):
        """A file to lock, for this user alone. A folder from elsewhere may have a link or a pipe under this name: its target
        is neither emptied nor waited for."""
        file = self.path / name
        try:
            descriptor = os.open(file, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC, 0o600)
        except OSError as error:
            if error.errno not in (errno.ELOOP, errno.ENXIO, errno.EISDIR):
                raise
        else:
            if stat.S_ISREG(os.fstat(descriptor).st_mode):
                return os.fdopen(descriptor, "r+", encoding="utf-8")
            os.close(descriptor)
        raise FolderError(f"{file}: expected a file that only this program makes; remove it")

    def _take(self):
        self._lock = self._open_lock(LOCK)
        try:
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            self._lock.close()
            raise FolderError(f"{self.path}: another program is writing there") from None

    @contextlib.contextmanager
    def writing_tables(self):
        """Within it nobody else writes tables or reports, or forgets somebody. It waits for whoever does so, and may be
        entered again by its own thread."""
        with self._inner:
            if self._depth == 0:
                self._tables = self._open_lock(".tables")
                fcntl.flock(self._tables, fcntl.LOCK_EX)
            self._depth += 1
            try:
                yield
            finally:
                self._depth -= 1
                if self._depth == 0:
                    self._tables.close()

    def require(self, wanted: dict) -> None:
        """Raises FolderError where the folder is of another study or of other people."""
        there = self.description()
        if there["Study"] != wanted["Study"]:
            raise FolderError(f"{self.path}: holds another study, or study.yaml has changed since it began: take "
                              f"another --out, or {self.path / 'study.yaml'}, which is as it was")
        if there["Simulated"] != wanted["Simulated"]:
            kinds = {True: "simulated", False: "real"}
            raise FolderError(f"{self.path}: its people are {kinds[there['Simulated']]}, and {kinds[wanted['Simulated']]} "
                              "ones cannot be mixed with them: take another --out")
        if there["Model"] != wanted["Model"]:
            raise FolderError(f"{self.path}: was begun differently ({there['Model']}), which cannot be mixed with this: take "
                              "another --out")

    def write(self, file: pathlib.Path, text: str | bytes) -> None:
        """Writes a file whole or not at all, and never one that is there."""
        self._put(file, text)

    def replace(self, file: pathlib.Path, text: str | bytes) -> None:
        """The same for what is made of other files."""
        self._put(file, text, replaces=True)

    def _put(self, file, text, replaces=False):
        self._require_inside(file)
        file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        partial = file.with_name(f".{file.name}.{os.getpid()}")
        data = text.encode() if isinstance(text, str) else text
        try:
            partial.unlink(missing_ok=True)
            with open(partial, "xb", opener=lambda name, flags: os.open(name, flags, 0o600)) as out:
                out.write(data)
                out.flush()
                os.fsync(out.fileno())
        except OSError:
            partial.unlink(missing_ok=True)
            raise
        if replaces:
            os.replace(partial, file)
        else:
            try:
                os.link(partial, file)
            except FileExistsError:
                raise FolderError(f"{file}: is there already, and nothing is written twice") from None
            finally:
                partial.unlink()
        _flush(file.parent)

    def _require_inside(self, file):
        """Raises FolderError where a link leads out of the folder."""
        for folder in file.parents:
            if folder == self.path:
                return
            if folder.is_symlink():
                raise FolderError(f"{folder}: is a link, and what it leads to is not of the study; remove it")

    def stem(self, code: str, step: Step) -> pathlib.Path:
        """The beginning of the names of a step's files."""
        task = f"_task-{step.condition}" if step.condition else ""
        tail = f"_form-{step.form}" if step.kind == "form" else f"_run-{step.repetition}"
        return self.path / f"sub-{code}" / f"sub-{code}{task}{tail}"

    def file_of(self, code: str, step: Step) -> pathlib.Path:
        stem = self.stem(code, step)
        return stem.with_name(stem.name + ("_answers.json" if step.kind == "form" else TRIAL))

    def put_aside(self, code: str, step: Step, why: str) -> None:
        """Moves the files of a trial aside, with the reason. The trial's own file goes first: without it the trial is not done."""
        stem = self.stem(code, step)
        folder = stem.parent / ASIDE
        self._require_inside(folder / stem.name)
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        number = 1
        while any(folder.glob(f"{stem.name}_aside-{number}_*")):
            number += 1
        begin = folder / f"{stem.name}_aside-{number}"
        for file in sorted(stem.parent.glob(f"{stem.name}_*"), key=lambda each: not each.name.endswith(TRIAL)):
            os.replace(file, f"{begin}{file.name.removeprefix(stem.name)}")
        self.write(begin.with_name(f"{begin.name}_why.json"), trials.dump({
            "participant": code, "condition": step.condition, "repetition": step.repetition, "why": why}))

    def keep(self, file: pathlib.Path, code: str, step: Step, tail: str) -> pathlib.Path:
        """Moves a file of a trial that has ended to where it stays; its new place."""
        stem = self.stem(code, step)
        target = stem.with_name(f"{stem.name}_{tail}")
        self._require_inside(target)
        target.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        _flush(file)
        os.replace(file, target)
        _flush(target.parent)
        return target

    def tidy(self, participant: Participant) -> None:
        """Puts aside what a crash has left of a trial that has no file of its own."""
        code = participant.code
        for step in steps(self.study, participant):
            stem = self.stem(code, step)
            if step.kind == "trial" and not self.file_of(code, step).exists() and any(stem.parent.glob(f"{stem.name}_*")):
                self.put_aside(code, step, "the program ended before the trial was measured")

    def note(self, code: str, text: str, step: int) -> None:
        """Keeps a remark of the operator."""
        self.write(self.path / f"sub-{code}" / f"sub-{code}_note-{len(self.remarks(code)) + 1}.json",
                   trials.dump({"participant": code, "step": step, "text": text}))

    def remarks(self, code: str) -> list[dict]:
        """The remarks of the operator, in their order."""
        files = {int(found[1]): file for file in (self.path / f"sub-{code}").glob("*_note-*.json")
                 if (found := NOTE.fullmatch(file.name))}
        return [_read(files[number], OF_NOTE) for number in sorted(files)]

    def withdrawn(self) -> list[str]:
        try:
            found = _read(self.path / WITHDRAWN)
        except FileNotFoundError:
            return []
        if not all(isinstance(code, str) for code in found):
            raise FolderError(f"{self.path / WITHDRAWN}: is damaged: expected codes of participants")
        return found

    def participants(self) -> list[Participant]:
        """Those that have files and have not withdrawn, in the order of the plan."""
        gone = self.withdrawn()
        return [each for each in plan(self.study) if each.code not in gone and (self.path / f"sub-{each.code}").is_dir()]

    def progress(self, participant: Participant) -> tuple[int, int]:
        """How many trials and forms of a participant are there, and how many there are to be."""
        files = [self.file_of(participant.code, step) for step in steps(self.study, participant)
                 if step.kind in WITH_FILES]
        return sum(file.exists() for file in files), len(files)

    def forget(self, code: str) -> int:
        """Deletes everything of one participant; how many files. Again it finishes what a crash has left. Where study or
        folder are damaged, tables are not made anew but lose the rows of the participant, and `notes` say so."""
        codes = sorted(each.name.removeprefix("sub-") for each in self.path.glob("sub-*") if each.is_dir())
        if not codes and not self.exists():
            raise FolderError(f"{self.path}: holds no study; hapticgiant study simulate makes one")
        self._take()
        with self._lock:
            return self._forget(code, codes)

    def _forget(self, code, codes):
        if code not in codes and code not in self.withdrawn():
            near = f", did you mean '{nearest(code, codes)}'?" if codes else ""
            raise FolderError(f"{self.path}: has no participant '{code}'{near}")
        with self.writing_tables():
            folder = self.path / f"sub-{code}"
            count = sum(1 for file in folder.rglob("*") if file.is_file())
            # first the note: a crash in between must not let somebody play under this code again
            self.replace(self.path / WITHDRAWN, trials.dump(sorted({*self.withdrawn(), code})))
            _remove(folder)
            _remove(self.path / RUNNING)  # trials and files of a program that was killed
            for file in list(self.path.rglob(".*")):
                if PARTIAL.fullmatch(file.name):
                    file.unlink(missing_ok=True)
            for name in REPORTS:
                _remove(self.path / name)
            for name in TABLES:
                (self.path / f"{name}.parquet").unlink(missing_ok=True)
            lost = [note for name in TABLES if (note := self._filter(self.path / f"{name}.csv", code))]
            if not self._is_tabulated_anew():
                self.notes += [*lost, "tables are not made anew: they are those of before without the participant, as "
                               "CSV only"]
                self.hash()
        return count

    def _filter(self, file, code):
        """Takes the rows of a participant out of a table. Deletes one that cannot be read; returns a note of that."""
        if not file.exists():
            return ""
        try:
            with open(file, encoding="utf-8", newline="") as lines:
                head, *rows = csv.reader(lines, strict=True)
            if not head and not rows:  # a table without rows has no columns either
                return ""
            place = head.index("participant")
            self.replace(file, _rows_text([head, *(row for row in rows if row[place] != code)]))
        except (ValueError, IndexError, csv.Error) as error:
            file.unlink()
            return f"{file.name} is deleted, since it cannot be read: {error}"
        return ""

    def _is_tabulated_anew(self):
        try:
            if self.study is not None:
                self.require({**self.description(), "Study": self.study.digest()})
                self.tabulate()
                return True
        except (FolderError, ValueError, KeyError, TypeError) as error:  # whatever somebody has done to the files
            self.notes.append(f"{type(error).__name__}: {error}" if not isinstance(error, FolderError) else str(error))
        return False

    def rows(self) -> dict[str, list[dict]]:
        """The tables, made of the files of the participants."""
        study, found = self.study, {name: [] for name in TABLES}
        for participant in self.participants():
            folder, code, out = self.path / f"sub-{participant.code}", participant.code, 0
            played = sorted((self._trial(file) for file in folder.glob(f"*{TRIAL}")),
                            key=lambda each: each["position"])
            for each in played:
                why = trials.excluded(study, each["measures"], each["exit_code"])
                out += bool(why)
                found["trials"].append({
                    "participant": code, "position": each["position"], "condition": each["condition"],
                    "repetition": each["repetition"], "ended_by": each.get("ended_by", "time"), "excluded": why,
                    "events_missing": "; ".join(each["missing_events"]),
                    "no_value": "; ".join(f"{name}: {reason}" for name, reason in each["no_value"].items()),
                    **each["measures"], "exit_code": each["exit_code"], "state_hash": each["state_hash"],
                    "recording_sha256": each["recording_sha256"], "recording": each["recording"] or ""})
            why = self._participant_excluded(len(played), out)
            done, count = self.progress(participant)
            found["participants"].append({
                "participant": code, "order": " ".join(participant.conditions), "trials": len(played),
                "complete": "yes" if done == count else "no",
                "excluded_trials": out, "put_aside": len({file.name.rpartition("_")[0] for file in (folder / ASIDE).glob("*")}), "excluded": why})
            for file in sorted(folder.glob("*_answers.json")):
                each = self._form(file)
                common = {"participant": code, "condition": each["condition"], "form": each["form"]}
                for kind, values in (("answer", each["answers"]), ("pair", each["pairs"]),
                                     ("score", questionnaires.scores_of(study.forms[each["form"]], each["answers"],
                                                                        each["pairs"]))):
                    if kind == "score" and study.forms[each["form"]].kind == "own":
                        continue
                    for item, value in values.items():
                        if kind == "score" and item in each["answers"]:
                            continue
                        is_number = isinstance(value, (int, float))
                        found["answers"].append({**common, "kind": kind, "item": item,
                                                 "value": float(value) if is_number else None,
                                                 "text": "" if is_number else value})
        return found

    def _trial(self, file):
        """A trial of this study. Raises FolderError."""
        found = _read(file, OF_TRIAL)
        measures = found["measures"]
        if found["condition"] not in self.study.conditions or measures.keys() != self.study.measures.keys():
            raise FolderError(f"{file}: is damaged: the study has other conditions or measures")
        for key, kind in OF_TRIAL_SINCE.items():
            each = found.setdefault(key, kind())
            if not isinstance(each, kind) or not all(isinstance(word, str) for word in [*each, *(
                    each.values() if kind is dict else [])]):
                raise FolderError(f"{file}: is damaged: '{key}' cannot be {json.dumps(each)[:40]}")
        for name, value in measures.items():  # null: has no value
            if value is not None and not (type(value) in (int, float) and abs(value) <= sys.float_info.max):
                raise FolderError(f"{file}: is damaged: '{name}' cannot be {json.dumps(value)[:40]}")
        return found

    def _form(self, file):
        """A filled form of this study. Raises FolderError."""
        found = _read(file, OF_FORM)
        form = self.study.forms.get(found["form"])
        if form is None or found["condition"] not in ("", *self.study.conditions):
            raise FolderError(f"{file}: is damaged: the study has other conditions or forms")
        if problem := questionnaires.problem_of(form, found["answers"], found["pairs"]):
            raise FolderError(f"{file}: is damaged: {problem[:200]}")
        return found

    def _participant_excluded(self, count, excluded_trials):
        from hapticgiant.study import expressions

        known = {"trials": count, "excluded_trials": excluded_trials}
        return next((each.why for each in self.study.exclusions if each.kind == "participant"
                     and expressions.is_true(each.expression, known)), "")

    def tabulate(self) -> list[pathlib.Path]:
        """Writes tables, data dictionary, what is stored, and hashes. Parquet where pyarrow is installed. It waits for
        another program that does so, or that writes a report."""
        with self.writing_tables():
            return self._tabulate()

    def _tabulate(self):
        from hapticgiant.sweep.table import columns_of

        files, rows = [], self.rows()
        for name in TABLES:
            columns = columns_of(rows[name])
            file = self.path / f"{name}.csv"
            self.replace(file, _csv(columns))
            files.append(file)
            try:
                import pyarrow
                import pyarrow.parquet
            except ImportError:
                continue
            sink = pyarrow.BufferOutputStream()
            pyarrow.parquet.write_table(pyarrow.table({key: pyarrow.array(each) for key, each in columns.items()}), sink)
            self.replace(file.with_suffix(".parquet"), sink.getvalue().to_pybytes())
            files.append(file.with_suffix(".parquet"))
        self.replace(self.path / "data_dictionary.csv", self._dictionary())
        has_recordings = any(self.path.glob("sub-*/**/*.mcap"))
        self.replace(self.path / "WHAT_IS_STORED.md", STORED.format(
            codes=f"{plan(self.study)[0].code} ...", trial="sub-*/*_trial.json", withdrawn=WITHDRAWN,
            recording="\n- Recordings (sub-*/*_recording.mcap): what the device has measured and done in each cycle."
            if has_recordings else " Recordings are not kept.",
            markers=MARKERS.format(names=", ".join(names)) if (names := self.study.lab_streaming.markers) else ""))
        self.hash()
        return files

    def _dictionary(self):
        lines = [("table", "column", "unit", "meaning")]
        lines += [("participants", *each) for each in (
            ("participant", "", "code"), ("order", "", "conditions in the order of the plan"),
            ("trials", "", "trials that were played, without practice"),
            ("complete", "", "yes: every trial was played and every form filled"),
            ("excluded_trials", "", "of these left out by a criterion"),
            ("put_aside", "", "trials that were put aside, by the operator or because they had no result, and played again; not in trials"),
            ("excluded", "", "why all of the participant is left out; empty: counts"))]
        lines += [("trials", *each) for each in (
            ("participant", "", "code"), ("position", "", "place of the trial in the participant's plan, from 1"),
            ("condition", "", "as in study.yaml"), ("repetition", "", "from 1"),
            ("ended_by", "", "events: all of the task have happened; operator; time: the longest one, or the script's"),
            ("excluded", "", "why the trial is left out; empty: counts"),
            ("events_missing", "", "events of the task that have not happened"),
            ("no_value", "", "measures without a number, and why"),
            *((m.name, m.unit, f"{m.what}: {m.expression}") for m in self.study.measures.values()),
            ("exit_code", "", "of hapticgiant run: 0 as expected, 1 an event is missing or a limit was exceeded, 3 fault"),
            ("state_hash", "", "of the last cycle; the same run has the same"),
            ("recording_sha256", "", "of the recording that was measured"),
            ("recording", "", "its file; empty: not kept"))]
        lines += [("answers", *each) for each in (
            ("participant", "", "code"), ("condition", "", "empty: asked once, at the end"),
            ("form", "", "as in study.yaml"), ("kind", "", "answer, pair (winner of two TLX scales) or score"),
            ("item", "", "see below"), ("value", "", "number"), ("text", "", "free text, or the winner of a pair"))]
        if self.study.lab_streaming.markers:
            lines += [("sub-*/*_markers", name, *about) for name, about in markers.COLUMNS.items()]
        for name, form in self.study.forms.items():
            for item, each in form.items.items():
                scale = "" if each.kind == "text" else f"; {each.low:g} to {each.high:g} by {each.step:g}"
                lines.append((f"answers {name}", item, "", each.text.get("en", item) + scale))
            lines += [(f"answers {name}", score, "", what) for score, what in form.scores.items()
                      if score not in form.items]
        return _rows_text(lines)

    def hash(self) -> None:
        """Writes hashes.sha256 of every file, in the form that sha256sum reads."""
        known = {}  # of recordings, which are large and never change
        for file in self.path.glob(f"sub-*/**/*{TRIAL}"):
            try:
                trial = _read(file, OF_TRIAL)
            except FolderError:  # damaged; it has a hash all the same
                continue
            if trial["recording"]:
                known[file.with_name(file.name.removesuffix(TRIAL) + "_recording.mcap")] = trial["recording_sha256"]
        lines = []
        for file in sorted(self.path.rglob("*")):
            inner = file.relative_to(self.path)
            if not file.is_file() or any(part.startswith(".") for part in inner.parts) or inner.name == "hashes.sha256":
                continue
            lines.append(f"{known.get(file) or trials.digest_of(file)}  {inner}\n")
        self.replace(self.path / "hashes.sha256", "".join(lines))


def _read(file, keys=None):
    """What a file of the study holds: an object with these keys, of these types, or without keys a list. Raises FolderError
    where it is damaged."""
    def refuse(word):
        raise ValueError(f"{word} is no number of JSON")

    try:
        found = json.loads(file.read_text(encoding="utf-8"), parse_constant=refuse)
    except (ValueError, RecursionError) as error:
        raise FolderError(f"{file}: is damaged: {error}") from None
    if not isinstance(found, list if keys is None else dict):
        raise FolderError(f"{file}: is damaged: expected {'a list' if keys is None else 'an object'}")
    for key, kind in (keys or {}).items():
        if key not in found:
            raise FolderError(f"{file}: is damaged: '{key}' is missing")
        value = found[key]
        is_right = isinstance(value, kind) and (kind is not int or type(value) is int and abs(value) < LARGEST)
        if not is_right:
            raise FolderError(f"{file}: is damaged: '{key}' cannot be {json.dumps(value)[:40]}")
    return found


def _remove(path):
    """Deletes a file, a link or a folder, if it is there. What a link leads to stays."""
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)


def _flush(path):
    """Waits until a file, or the names in a folder, are on the disk: of a power cut that comes now."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _csv(columns):
    return _rows_text([list(columns), *zip(*columns.values())])


def _rows_text(rows):
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerows(rows)
    return out.getvalue()
