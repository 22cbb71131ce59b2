"""One trial of a person in real time: `hapticgiant run` as a child process, and what it tells while it runs.

The run's own page server has the direct way to the control loop; stops from the operator's page go there without this
program. The child ends by itself when this program dies.
"""

from __future__ import annotations

import asyncio
import contextlib
import ctypes
import dataclasses
import json
import math
import os
import pathlib
import re
import signal

import aiohttp

LINK = re.compile(r"(http://\S+)/#token=([0-9a-f]+)")
PROTOCOL = "hapticgiant"
PATIENCE_S = 30  # of a run that was asked to end, before it is killed
RETRY_S = 0.3  # until the connection to a run is tried again
LARGEST_MESSAGE = 1 << 20  # bytes
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


def _end_with(parent):
    """In the child, before it becomes the program: SIGTERM when the parent dies, and no Ctrl-C of the terminal."""
    os.setsid()
    ctypes.CDLL(None).prctl(SET_DEATH_SIGNAL, signal.SIGTERM, 0, 0, 0)
    if os.getppid() != parent:
        os._exit(1)


class TrialRun:
    """A run from its start to its end."""

    def __init__(self, command: list[str], expected: list[str], pause_s: float | None, changed, has_way: bool = False):
        """command: without --summary. expected: names of the task's events. pause_s: how long after the last of them the
        run ends; None: it does not end by them. changed(): called when more than a number has changed. has_way: the
        device first moves to the start."""
        self.shown = Shown()
        self._command = command
        self._missing = set(expected)
        self._pause_s = pause_s
        self._changed = changed
        self._first_run = 2 if has_way else 1  # by the number of its frames; before it is the way
        self._process: asyncio.subprocess.Process | None = None
        self._socket: aiohttp.ClientWebSocketResponse | None = None
        self._found_link = asyncio.Event()
        self._said: list[str] = []
        self._id = 0
        self.is_ending = False
        self.ended_by = "time"
        """What has ended it: events, operator, or time (also of a script that has played)."""

    async def play(self, summary: pathlib.Path) -> tuple[int, dict | None, str]:
        """Plays it; exit code (minus the signal), the summary if it was written, and what standard error said."""
        parent = os.getpid()
        self._process = await asyncio.create_subprocess_exec(
            *self._command, "--summary", str(summary), stdin=asyncio.subprocess.DEVNULL,
            stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE, preexec_fn=lambda: _end_with(parent))
        if self.is_ending:  # somebody was faster
            self._send_end()
        readers = [asyncio.create_task(self._read(self._process.stdout, self._take_line)),
                   asyncio.create_task(self._read(self._process.stderr, self._said.append))]
        watcher = asyncio.create_task(self._watch())
        try:
            code = await self._process.wait()
            await asyncio.gather(*readers)
        finally:
            watcher.cancel()
            for reader in readers:
                reader.cancel()
            with contextlib.suppress(ProcessLookupError):
                self._process.kill()
        try:
            found = json.loads(summary.read_text(encoding="utf-8"))
        except (OSError, ValueError):
            found = None
        return code, found, "".join(self._said).strip()

    async def _read(self, stream, take):
        while line := await stream.readline():
            take(line.decode(errors="replace"))

    def _take_line(self, line):
        if not self.shown.link and (match := LINK.search(line)):
            self.shown.link = match[0]
            self._found_link.set()
            self._changed()

    async def _watch(self):
        """Follows the frames of the run; ends it after the last expected event."""
        await self._found_link.wait()
        address, token = LINK.match(self.shown.link).groups()
        async with aiohttp.ClientSession() as session:
            while self._process.returncode is None:
                with contextlib.suppress(aiohttp.ClientError):
                    async with session.ws_connect(f"{address}/ws", origin=address, max_msg_size=LARGEST_MESSAGE,
                                                  protocols=(PROTOCOL, f"token.{token}")) as socket:
                        self._socket = socket
                        async for message in socket:
                            if message.type == aiohttp.WSMsgType.TEXT:
                                self._take(json.loads(message.data))
                self._socket = None
                await asyncio.sleep(RETRY_S)

    def _take(self, message):
        shown = self.shown
        if message["type"] == "frame":
            before = shown.mode, shown.fault, shown.is_on_its_way
            shown.is_on_its_way = message["run"] < self._first_run
            shown.mode, shown.time_s = message["mode"], message["time_s"]
            shown.fault = message["fault"]
            force = [x for x in message["force_N"] if x is not None]
            shown.force_N = math.hypot(*force) if len(force) == 3 else 0.0
            shown.is_held = shown.mode == "running" and not shown.is_on_its_way
            if shown.mode == "running":
                shown.wanted = ""
            if before != (shown.mode, shown.fault, shown.is_on_its_way):
                self._changed()
        elif message["type"] == "event" and message["run"] < self._first_run:
            if message["name"] == "start":
                shown.wanted = message["text"]
                self._changed()
        elif message["type"] == "event" and message["name"] in self._missing:
            self._missing.discard(message["name"])
            shown.events.append({"time_s": message["time_s"], "name": message["name"]})
            if not self._missing and self._pause_s is not None:
                asyncio.get_running_loop().call_later(self._pause_s, self.end, "events")
            self._changed()

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
        """Presses the emergency stop by this program's own connection; False: there is none."""
        socket = self._socket
        if socket is None:
            return False
        self._id += 1
        with contextlib.suppress(ConnectionError, aiohttp.ClientError):
            await socket.send_json({"type": "command", "id": self._id, "command": "emergency_stop", "name": "", "value": 0})
            return True
        return False
