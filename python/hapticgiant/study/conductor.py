"""`hapticgiant study run` without its pages: whose turn it is, which step, the trial that is played, and what may be done.

Everything happens in one thread (asyncio); what takes long (measuring a recording, tables) has a thread of its own, so
that a stop never waits for it.
"""

from __future__ import annotations

import asyncio
import contextlib
import dataclasses
import math
import pathlib
import time

from hapticgiant.study import expressions, markers, people, questionnaires, trials
from hapticgiant.study.description import Study
from hapticgiant.study.folder import RUNNING, Folder, FolderError
from hapticgiant.study.planning import Step, plan
from hapticgiant.study.session import PLAYED, Session
from hapticgiant.study.trial_run import TrialRun, played_at_once
from hapticgiant.sweep.program import Program

AT_ONCE = ("stop", "end", "abort")
LONGEST_NOTE = 2000  # characters


@dataclasses.dataclass(frozen=True)
class Hand:
    """Who moves the handle: mouse (simulated device), device (a person at it), script (rehearsal)."""

    kind: str
    options: dict = dataclasses.field(default_factory=dict)
    """Of a request, for a device: docs/reference/run_protocol.md."""

    @property
    def model(self) -> str:
        """What a report says of it."""
        return {"mouse": "A simulated device was moved with the mouse.", "device": "A device was held by its handle.",
                "script": "Rehearsal: a scripted hand has played the trials; forms were answered by whoever was there."}[self.kind]

    @property
    def is_real(self) -> bool:
        """Whether it is a person's."""
        return self.kind != "script"


class Refused(RuntimeError):
    """A command that is not possible now; the message says why."""


MOUSE = "scenario.person=mouse"  # and not the user, who is without the task's events


def expected_events(study: Study, program: Program, hand: Hand) -> dict[str, list[str]]:
    """The events that each condition's task has, by a run of some cycles on the simulated device. Raises TrialError."""
    found = {}
    for condition in study.conditions:
        request = study.request(condition)
        if hand.is_real and "user" in request:
            raise trials.TrialError(f"condition {condition}: 'user' is a simulated person's; leave it out, or --rehearse")
        if hand.kind == "mouse":
            request.setdefault("set", []).append(MOUSE)
        request |= {"fast": True, "viewer": False, "recording": False, "flight_recorder": "off", "duration": 0.01}
        _, summary, why = played_at_once(program.file, request)
        if summary is None:
            raise trials.TrialError(f"condition {condition}: {why}")
        found[condition] = [*(event["name"] for event in summary["events"]), *summary["missing_events"]]
    return found


class Conductor:
    """One study that is being run."""

    def __init__(self, study: Study, folder: Folder, program: Program, hand: Hand, events: dict[str, list[str]],
                 origins: list[str], changed):
        """events: of each condition's task. origins: of the pages that show a run in themselves. changed(): called
        whenever there is something new to show. Raises MarkerError."""
        self.study, self.folder, self.program, self.hand = study, folder, program, hand
        self._events, self._origins, self._changed = events, origins, changed
        lab = study.lab_streaming
        self._stream = markers.StudyStream(study.digest()) if lab.outlets else None
        self._markers = markers.Markers(lab.markers) if lab.markers else None
        self._plan = plan(study)
        self._order = asyncio.Lock()  # one command after another, but for those that end something
        self._gone = folder.withdrawn()  # nobody can withdraw while the folder is in use
        self._progress = {each.code: folder.progress(each) for each in self._plan}
        self._session: Session | None = None
        self._run: TrialRun | None = None
        self._phase = "ready"  # of a trial
        self._task: asyncio.Task | None = None
        self._is_closing = False
        self._abort_why: str | None = None
        self._problem: str | None = None
        self._last: dict | None = None
        self._rest_until = 0.0
        self.languages = study.languages
        self.language = self.languages[0]
        self.participant_pages = 0

    # what is shown

    def phase(self) -> str:
        if self._session is None:
            return "closed"
        step = self._session.step
        if step is None:
            return "complete"
        return self._phase if step.kind in PLAYED or self._task else "participant"

    def can(self) -> list[str]:
        """The operator's commands that are possible now."""
        phase, session = self.phase(), self._session
        found = []
        if self._is_closing:
            return ["stop"] if self._run is not None else []
        if phase == "closed":
            found.append("begin")
        if session is None:
            return found
        if self._task is None:
            found.append("leave")
            if session.last_played() is not None:
                found.append("repeat")
        if phase in ("ready", "failed"):
            found.append("start")
        if phase in ("moving", "starting", "running"):
            found += ["abort"]
        if phase == "running":
            found.append("end")
        if self._run is not None:
            found.append("stop")
        if phase == "participant" and session.step.kind != "form":
            found.append("go_on")
        return [*found, "note"]

    def operator_state(self, participant_link: str) -> dict:
        session = self._session
        notes, damage = self._notes()
        known = []
        for each in self._plan:
            done, count = self._progress[each.code]
            status = "withdrawn" if each.code in self._gone else "planned" if not done else "begun" if done < count else "complete"
            known.append({"code": each.code, "conditions": list(each.conditions), "status": status, "done": done, "of": count})
        return {
            "kind": "state", "title": self.study.title, "people": "real" if self.hand.is_real else "simulated",
            "hand": self.hand.kind, "participants": known, "next": self._next(),
            "participant": session.code if session else None,
            "participant_page": {"link": participant_link, "is_connected": self.participant_pages > 0,
                                 "language": self.language},
            "steps": [{**dataclasses.asdict(step), "is_done": session.is_done(i)} for i, step in enumerate(session.steps)]
            if session else [],
            "position": session.position if session else None, "phase": self.phase(),
            "problem": self._problem or self._wanted() or (self._markers.problem if self._markers else None) or damage,
            "run": self.run_state(), "last": self._last,
            "notes": notes, "markers": self._markers.state() if self._markers else [], "can": self.can()}

    def _notes(self):
        """The operator's remarks, and what is wrong with their files."""
        try:
            remarks = self.folder.remarks(self._session.code) if self._session else []
        except (FolderError, OSError) as error:
            return [], str(error)
        return [{"step": note["step"], "text": note["text"]} for note in remarks], None

    def _wanted(self):
        """What the device waits for before it moves to the start."""
        return self._run.shown.wanted if self._run is not None and self._phase == "moving" else ""

    def run_state(self) -> dict | None:
        """The run that is going on; None: there is none."""
        if self._run is None or self._session.step is None:
            return None
        shown = self._run.shown
        return {"link": shown.link, "mode": shown.mode, "is_held": shown.is_held, "time_s": shown.time_s,
                "force_N": shown.force_N, "fault": shown.fault or None, "events": shown.events,
                "expected_events": self._events[self._session.step.condition]}

    def participant_state(self) -> dict:
        session = self._session
        state = {"kind": "state", "title": self.study.title, "code": session.code if session else None,
                 "draft": f"{self.study.digest()} {self.hand.kind}", "languages": self.languages,
                 "language": self.language, "position": None, "progress": 0.0, "screen": "waiting"}
        if session is None:
            return state
        step, position = session.step, session.position
        if step is None:
            return {**state, "position": len(session.steps), "progress": 1.0, "screen": "end"}
        state |= {"position": position, "progress": position / len(session.steps)}
        if step.kind == "instruction":
            return {**state, "screen": "instruction", "markdown": self._words(self.study.instructions[step.text])}
        if step.kind == "break":
            words = self._words(self.study.instructions.get("break", {}))
            return {**state, "screen": "break", "markdown": words, "rest_s": max(0.0, self._rest_until - time.monotonic())}
        if step.kind == "form":
            return {**state, "screen": "form", "form": self._form(step)}
        if self._phase != "running":
            return state
        is_practice = step.kind == "practice"
        link = self._run.shown.link if self._run is not None and self.hand.kind == "mouse" else ""
        return {**state, "screen": "trial", "link": link or None, "is_practice": is_practice,
                "task": self._words(self.study.instructions.get(step.condition, {}))}

    def _words(self, texts):
        return texts.get(self.language) or texts.get("en") or next(iter(texts.values()), "")

    def _form(self, step: Step):
        form = self.study.forms[step.form]
        about = self._words(self.study.instructions.get(step.condition, {})) if form.after == "condition" else ""
        return {"name": step.form, "kind": form.kind, "about": about, "pairs": [list(pair) for pair in form.pairs], "items": [
            {"name": name, "kind": item.kind, "text": self._words(item.text), "low": item.low, "high": item.high,
             "step": item.step, "ends": [self._words(end) for end in item.ends]} for name, item in form.items.items()]}

    def _next(self) -> str | None:
        """Who is next: an interrupted one first, then the first that is planned."""
        planned = None
        for each in self._plan:
            if each.code in self._gone:
                continue
            done, count = self._progress[each.code]
            if 0 < done < count:
                return each.code
            if not done and planned is None:
                planned = each.code
        return planned

    # what is asked

    async def operator(self, command: str, words: dict) -> None:
        """A command of the operator's page. Raises Refused."""
        if command not in ("begin", "leave", "start", "end", "abort", "repeat", "go_on", "note", "stop"):
            raise Refused(f"no such command: {command!r}")
        if command in AT_ONCE:
            await self._obey(command, words)
            return
        async with self._order:
            await self._obey(command, words)

    async def _obey(self, command, words):
        if command not in self.can():
            raise Refused(f"{command} is not possible now")
        if "position" in words and command != "go_on" and words["position"] != self._session.position:
            raise Refused(f"{command} was asked for another step")
        try:
            await getattr(self, f"_{command}")(words)
        finally:
            self._changed()

    async def participant(self, command: str, words: dict) -> None:
        """A command of the participant's page. Raises Refused."""
        async with self._order:
            try:
                await self._take(command, words)
            finally:
                self._changed()

    async def _take(self, command, words):
        if self._is_closing:
            raise Refused("the study is being closed")
        if command == "language":
            if words.get("language") not in self.languages:
                raise Refused(f"no such language: {words.get('language')!r}; there are {', '.join(self.languages)}")
            self.language = words["language"]
        elif command == "go_on":
            await self._go_on(words, is_participant=True)
        elif command == "answers":
            await self._answer(words)
        else:
            raise Refused(f"no such command: {command!r}")

    async def _begin(self, words):
        code = words.get("code")
        participant = next((each for each in self._plan if each.code == code), None)
        if participant is None:
            raise Refused(f"no participant is called {code!r}")
        if code in self._gone:
            raise Refused(f"{code} was withdrawn; a code is not given again")
        self._session = Session(self.study, self.folder, participant)
        self._last = self._problem = None
        self._enter()
        self._mark(f"{code} begin")

    async def _leave(self, _):
        self._keep_markers()
        self._mark(f"{self._session.code} leave")
        self._session = None
        self._problem = None
        self.language = self.languages[0]
        await asyncio.to_thread(self.folder.tabulate)

    async def _start(self, _):
        if self.hand.kind == "mouse" and not self.participant_pages:
            raise Refused("the participant's page is not open, on which the handle is dragged")
        self._phase, self._problem, self._abort_why = "starting", None, None
        position = self._session.position
        step = self._session.steps[position]
        self._run = TrialRun(self.program.file, self._request(step), self._events[step.condition], self.study.pause_s,
                             self._run_changed)
        self._task = asyncio.create_task(self._play(self._run, position))

    async def _end(self, _):
        self._run.end()

    async def _abort(self, words):
        self._abort_why = self._text(words, "why")
        self._run.end()

    async def _repeat(self, words):
        position = self._session.last_played()
        why = self._text(words, "why")
        await asyncio.to_thread(self._session.put_aside, position, why)
        self._mark_step(position, "put aside")
        self._last = None
        self._enter()

    async def _go_on(self, words, is_participant=False):
        step = self._session.step if self._session else None
        if step is None or words.get("position") != self._session.position:
            return  # of a page that shows what was before
        if step.kind not in ("instruction", "break"):
            raise Refused(f"a {step.kind} cannot be passed")
        if is_participant and step.kind == "break" and time.monotonic() < self._rest_until:
            raise Refused("the break is not over")
        self._session.pass_by(self._session.position)
        self._enter()

    async def _note(self, words):
        position = len(self._session.steps) if self._session.position is None else self._session.position
        await asyncio.to_thread(self.folder.note, self._session.code, self._text(words, "text"), position)

    async def _stop(self, _):
        if not await self._run.emergency_stop() and not self._run.is_ending:  # it has not begun, or its page is gone
            self._abort_why = "stopped by the operator"
            self._run.end()

    async def _answer(self, words):
        step = self._session.step if self._session else None
        if step is None or words.get("position") != self._session.position or step.kind != "form":
            raise Refused("this form has been answered already")
        answers, pairs = words.get("answers"), words.get("pairs", {})
        if not isinstance(answers, dict) or not isinstance(pairs, dict):
            raise Refused("expected answers and pairs by their names")
        if problem := questionnaires.problem_of(self.study.forms[step.form], answers, pairs):
            raise Refused(problem)
        answers = {name: "\n".join(value.splitlines()) if isinstance(value, str) else value for name, value in answers.items()}
        position = self._session.position
        await asyncio.to_thread(self.folder.write, self.folder.file_of(self._session.code, step), trials.dump({
            "participant": self._session.code, "condition": step.condition, "form": step.form,
            "simulated": not self.hand.is_real, "language": self.language, "answers": answers, "pairs": pairs}))
        self._mark_step(position, "end")
        self._enter()

    @staticmethod
    def _text(words, key):
        text = words.get(key)
        if not isinstance(text, str) or not text.strip() or len(text) > LONGEST_NOTE:
            raise Refused(f"{key}: expected a text of 1 to {LONGEST_NOTE} characters")
        return text.strip()

    # what happens

    def _enter(self):
        """The present step begins."""
        step = self._session.step
        self._progress[self._session.code] = self.folder.progress(self._session.participant)
        self._phase = "ready"
        if step is None:
            self._mark(f"{self._session.code} complete")
        elif step.kind == "break":
            self._rest_until = time.monotonic() + 60 * self.study.breaks[1]
        if step is not None and step.kind not in PLAYED:
            self._mark_step(self._session.position, "begin")

    def _mark(self, text):
        if self._stream:
            self._stream.mark(text)

    def _mark_step(self, position, what):
        """As P01 trial door 1 begin."""
        self._mark(markers.words_of(self._session.code, self._session.steps[position], what))

    def _work(self) -> pathlib.Path:
        """The folder of the trial that is played."""
        return (self.folder.path / RUNNING / "trial").absolute()

    def _request(self, step: Step) -> dict:
        request = self.study.request(step.condition)
        if self.hand.kind != "device":
            request["seed"] = people.seed_of(self.study, self._session.code, step.condition, step.repetition)
        if self.hand.kind == "mouse":
            request.setdefault("set", []).append(MOUSE)
        if self.hand.is_real:
            request["duration"] = self.study.longest_s
        if self._origins:
            request["embedded_in"] = list(self._origins)
        if self.study.lab_streaming.outlets:
            request["lsl"] = True
        return request | self.hand.options | {"browser": False, "recordings": str(self._work()), "flight_recorder": "off"}

    async def _play(self, run, position):
        session, step = self._session, self._session.steps[position]
        work, summary = self._work(), None
        try:
            trials.discard(work)
            work.mkdir(parents=True)
            self._keep_markers()
            self._mark_step(position, "begin")
            code, summary, said = await run.play()
            self._mark_step(position, "end")
            self._run = None
            if self._abort_why is not None:
                await asyncio.to_thread(self._put_aside, step, summary, self._abort_why)
                self._mark_step(position, "put aside")
                self._phase = "ready"
                return
            if summary is None:
                raise trials.TrialError(said or f"the run ended with {code} and no summary")
            if step.kind == "practice":
                session.pass_by(position)
            else:
                self._phase = "measuring"
                self._changed()
                await asyncio.to_thread(self._measure, session, step, position, code, summary, run.ended_by)
            self._enter()
        except Exception as error:  # whatever it is, the study goes on and the operator is told
            is_known = isinstance(error, (trials.TrialError, expressions.ExpressionError, FolderError, OSError))
            self._phase, self._problem = "failed", str(error) if is_known else f"{type(error).__name__}: {error}"
            await asyncio.to_thread(self._put_aside, step, summary, self._problem)
            self._mark_step(position, "put aside")
        finally:
            self._run = self._task = None
            self._abort_why = None
            trials.discard(work.parent)
            self._changed()

    def _run_changed(self):
        shown = self._run.shown if self._run else None
        if shown is None:
            return
        self._phase = ("ending" if self._run.is_ending else "moving" if shown.is_on_its_way
                       else "running" if shown.link and shown.mode != "off" else "starting")
        self._changed()

    def _keep_markers(self):
        """Writes what other instruments have sent since the last trial."""
        if self._markers and (found := self._markers.take()):
            markers.write(self.folder, self._session.code, None, found)

    def _put_aside(self, step, summary, why):
        """Keeps the recording of a trial that does not count."""
        if step.kind != "trial":
            return
        recording = pathlib.Path(summary["recording"]) if summary and summary["recording"] else None
        with contextlib.suppress(OSError, FolderError):  # of a full disk, which has been told
            if recording is not None and recording.is_file():
                self.folder.keep(recording, self._session.code, step, "recording.mcap")
            self.folder.put_aside(self._session.code, step, why)

    def _measure(self, session, step, position, exit_code, summary, ended_by):
        found = trials.measured(self.study, summary, exit_code_of(summary, exit_code))
        recording = self.folder.keep(found.recording, session.code, step, "recording.mcap")
        if self._markers:
            markers.write(self.folder, session.code, step, self._markers.take(), found.lab_clock)
        self.folder.write(self.folder.file_of(session.code, step), trials.dump({
            "participant": session.code, "condition": step.condition, "repetition": step.repetition,
            "position": session.place(position), "simulated": not self.hand.is_real, "hand": self.hand.kind,
            "ended_by": ended_by, **found.facts(), "recording": recording.name}))
        self._last = {
            "condition": step.condition, "repetition": step.repetition, "exit_code": found.exit_code,
            "excluded": trials.excluded(self.study, found.measures, found.exit_code), "missing_events": found.missing,
            "measures": {name: {"value": value if math.isfinite(value) else None, "unit": self.study.measures[name].unit,
                                "why": found.no_value.get(name, "")} for name, value in found.measures.items()}}

    async def close(self) -> None:
        """Ends what goes on; the trial that is played does not count."""
        self._is_closing = True
        if self._task is not None and self._run is not None and not self._run.is_ending:
            self._abort_why = "the study was closed"
            self._run.end()
        if self._task is not None:
            await asyncio.gather(self._task, return_exceptions=True)
        async with self._order:
            try:
                if self._session is not None:
                    self._keep_markers()
            finally:
                for each in (self._markers, self._stream):
                    if each is not None:
                        await asyncio.to_thread(each.close)
                await asyncio.to_thread(self.folder.tabulate)


def exit_code_of(summary: dict, code: int) -> int:
    """The exit code that a run would have had if nobody had ended it: docs/reference/runtime.md."""
    if code == 0 and (summary["missing_events"] or not summary["limits_held"] or summary["shaking"]["duration_s"] > 0):
        return 1
    return code
