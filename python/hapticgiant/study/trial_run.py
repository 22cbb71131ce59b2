"""A run as a child process: one request, one stream of JSON lines (docs/reference/run_protocol.md).

The run's own page server has the direct way to the control loop; stops from the operator's page go there without this
program. The child ends by itself when this program dies.
"""

from __future__ import annotations

import asyncio
import contextlib
import ctypes
import dataclasses
import json
import os
import signal
import subprocess
import tempfile

import aiohttp

PROTOCOL = "hapticgiant"  # of the run's page
PATIENCE_S = 30  # of a run that was asked to end, before it is killed
STOP_S = 2.0  # until the run's page takes an emergency stop
LONGEST_LINE = 4 << 20  # bytes; a summary has all events
MODES = ("off", "ready", "armed", "running", "stopping", "fault")
SET_DEATH_SIGNAL = 1  # PR_SET_PDEATHSIG of prctl(2)


@dataclasses.dataclass
class Shown:
    """What a run shows of itself."""

    link: str = ""
    """Of its page; empty: not there yet."""
    mode: str = "off"
    time_s: float = 0.0
    force_N: float = 0.0
    fault: str = ""
    is_held: bool = False
    is_on_its_way: bool = False
    """The device moves to the start by itself."""
    wanted: str = ""
    """What it waits for before."""
    events: list[dict] = dataclasses.field(default_factory=list)


class Reports:
    """What the lines of a run have said."""

    def __init__(self):
        self.shown = Shown()
        self.summary: dict | None = None
        self.problems: list[str] = []

    def take(self, report: dict) -> bool:
        """Takes a line; whether more than a number has changed."""
        shown = self.shown
        before = dataclasses.replace(shown, time_s=0.0, force_N=0.0)
        match next(iter(report), ""):
            case "link":
                shown.link = report["link"]
            case "phase":
                shown.is_on_its_way = report["phase"] == "moving"
                shown.wanted = report.get("wanted") or ""
                if report["phase"] in MODES:
                    shown.mode = report["phase"]
            case "status":
                status = report["status"]
                shown.time_s, shown.mode, shown.fault = status["time_s"], status["mode"], status["fault"]
                shown.force_N = status["force_N"] or 0.0
            case "fault":
                shown.fault = report["fault"]
            case "summary":
                self.summary = report["summary"]
            case "refused" | "problem" as kind:
                self.problems.append(report[kind])
        shown.is_held = shown.mode == "running" and not shown.is_on_its_way
        return before != dataclasses.replace(shown, time_s=0.0, force_N=0.0)


def report_in(line: str | bytes) -> dict:
    """The report of a line; empty for one that a kill has cut."""
    try:
        return json.loads(line)
    except ValueError:
        return {}


def command_of(program: str, reports: int) -> list[str]:
    """The command that takes its request from standard input and reports to this descriptor."""
    return [program, "run", "--request", "-", "--report-to", str(reports)]


def played_at_once(program: str, request: dict) -> tuple[int, dict | None, str]:
    """Plays a run to its end: exit code (minus the signal), its summary, and why there is none."""
    found = Reports()
    end, child_end = os.pipe()
    with open(end, encoding="utf-8", errors="replace") as lines, tempfile.TemporaryFile("w+", errors="replace") as errors:
        process = subprocess.Popen(command_of(program, child_end), stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
                                   stderr=errors, text=True, pass_fds=(child_end,), start_new_session=True)
        os.close(child_end)
        with contextlib.suppress(BrokenPipeError):
            process.stdin.write(json.dumps(request))
            process.stdin.close()
        for line in lines:
            if report := report_in(line):
                found.take(report)
        code = process.wait()
        errors.seek(0)
        said = errors.read()
    return code, found.summary, "\n".join(found.problems) or said.strip() or f"the run ended with {code} and no summary"


def _end_with(parent):
    """In the child, before it becomes the program: SIGTERM when the parent dies, and no Ctrl-C of the terminal."""
    os.setsid()
    ctypes.CDLL(None).prctl(SET_DEATH_SIGNAL, signal.SIGTERM, 0, 0, 0)
    if os.getppid() != parent:
        os._exit(1)


class TrialRun:
    """A run from its start to its end."""

    def __init__(self, program: str, request: dict, expected: list[str], pause_s: float | None, changed):
        """expected: names of the task's events. pause_s: how long after the last of them the run ends; None: it does not
        end by them. changed(): called when more than a number has changed."""
        self._reports = Reports()
        self._program, self._request = program, request
        self._missing = set(expected)
        self._pause_s = pause_s
        self._changed = changed
        self._process: asyncio.subprocess.Process | None = None
        self._pages = contextlib.AsyncExitStack()
        self._connecting = asyncio.Lock()
        self._socket: aiohttp.ClientWebSocketResponse | None = None
        self._tasks: list[asyncio.Task] = []
        self._said: list[str] = []
        self.is_ending = False
        self.ended_by = "time"
        """What has ended it: events, operator, or time (also of a script that has played)."""

    @property
    def shown(self) -> Shown:
        return self._reports.shown

    async def play(self) -> tuple[int, dict | None, str]:
        """Plays it; exit code (minus the signal), the summary if there is one, and what it could not do."""
        end, child_end = os.pipe()
        parent = os.getpid()
        lines = asyncio.StreamReader(limit=LONGEST_LINE)
        transport, _ = await asyncio.get_running_loop().connect_read_pipe(
            lambda: asyncio.StreamReaderProtocol(lines), os.fdopen(end, "rb"))
        try:
            self._process = await asyncio.create_subprocess_exec(
                *command_of(self._program, child_end), stdin=asyncio.subprocess.PIPE, stdout=asyncio.subprocess.DEVNULL,
                stderr=asyncio.subprocess.PIPE, pass_fds=(child_end,), preexec_fn=lambda: _end_with(parent))
        finally:
            os.close(child_end)
            if self._process is None:
                transport.close()
        if self.is_ending:  # ended before it has begun
            self._send_end()
        readers = [asyncio.create_task(each) for each in (self._send_request(), self._read_reports(lines), self._read_errors())]
        try:
            code = await self._process.wait()
            await asyncio.gather(*readers)
        finally:
            for task in (*readers, *self._tasks):
                task.cancel()
            transport.close()
            await self._pages.aclose()
            with contextlib.suppress(ProcessLookupError):
                self._process.kill()
        return code, self._reports.summary, "\n".join(self._reports.problems) or "".join(self._said).strip()

    async def _send_request(self):
        with contextlib.suppress(BrokenPipeError, ConnectionResetError):
            self._process.stdin.write(json.dumps(self._request).encode())
            await self._process.stdin.drain()
        self._process.stdin.close()

    async def _read_errors(self):
        while line := await self._process.stderr.readline():
            self._said.append(line.decode(errors="replace"))

    async def _read_reports(self, lines):
        while line := await lines.readline():
            if not (report := report_in(line)):
                continue
            has_changed = self._reports.take(report)
            if "link" in report:
                self._tasks.append(asyncio.create_task(self._open_page()))
            has_changed |= "event" in report and self._take_event(report)
            if has_changed:
                self._changed()

    def _take_event(self, event):
        """An event of the task; the run ends after the last one that is expected. On the way to the start there is none."""
        if self.shown.is_on_its_way or event["event"] not in self._missing:
            return False
        self._missing.discard(event["event"])
        self.shown.events.append({"time_s": event["time_s"], "name": event["event"]})
        if not self._missing and self._pause_s is not None:
            asyncio.get_running_loop().call_later(self._pause_s, self.end, "events")
        return True

    def end(self, by: str = "operator") -> None:
        """Ends the run as Ctrl-C does: the device stops, recording and summary are completed. Killed if it does not end.
        One that has not begun ends when it does."""
        if self.is_ending or self._process is not None and self._process.returncode is not None:
            return
        self.is_ending, self.ended_by = True, by
        if self._process is not None:
            self._send_end()
        self._changed()

    def _send_end(self):
        with contextlib.suppress(ProcessLookupError):
            self._process.send_signal(signal.SIGINT)
        asyncio.get_running_loop().call_later(PATIENCE_S, self._kill)

    def _kill(self):
        if self._process.returncode is None:
            self._process.kill()

    async def emergency_stop(self) -> bool:
        """Presses the emergency stop at the run's page; False: it has none yet, or does not take it."""
        if not self.shown.link:
            return False
        with contextlib.suppress(OSError, asyncio.TimeoutError, aiohttp.ClientError):
            await asyncio.wait_for(self._press(), STOP_S)
            return True
        return False

    async def _press(self):
        socket = await self._connected()
        await socket.send_json({"type": "command", "id": 1, "command": "emergency_stop", "name": "", "value": 0})

    async def _open_page(self):
        """Opens the connection that a stop takes before it is needed."""
        with contextlib.suppress(OSError, aiohttp.ClientError):
            await self._connected()

    async def _connected(self):
        async with self._connecting:
            if self._socket is None or self._socket.closed:
                address, _, token = self.shown.link.partition("/#token=")
                client = await self._pages.enter_async_context(aiohttp.ClientSession())
                self._socket = await client.ws_connect(f"{address}/ws", origin=address,
                                                       protocols=(PROTOCOL, f"token.{token}"))
                self._tasks.append(asyncio.create_task(_drain(self._socket)))
        return self._socket


async def _drain(socket):
    async for _ in socket:
        pass
