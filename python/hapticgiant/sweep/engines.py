"""Engines: what plays commands somewhere and yields how each has ended, in any order."""

from __future__ import annotations

import contextlib
import os
import queue
import signal
import subprocess
import threading
from typing import Iterator

from hapticgiant.sweep.program import Outcome

WAKE_S = 0.2
LOST = -int(signal.SIGKILL)  # the code of a run whose worker was lost


def processors() -> int:
    """Those that this process may use."""
    return len(os.sched_getaffinity(0))


@contextlib.contextmanager
def undisturbed():
    """Here Ctrl-C is without effect, so that what has to be cleaned up is."""
    signals = (signal.SIGINT, signal.SIGTERM)
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = [signal.signal(number, signal.SIG_IGN) for number in signals]
    try:
        yield
    finally:
        for number, handler in zip(signals, before):
            signal.signal(number, handler if handler is not None else signal.SIG_DFL)


def _next(ended: queue.SimpleQueue):
    """The next item. A signal that comes just before a wait is seen only after it: none is long."""
    while True:
        with contextlib.suppress(queue.Empty):
            return ended.get(timeout=WAKE_S)


class Local:
    """Processes on this machine, `jobs` at a time."""

    def __init__(self, jobs: int | None = None):
        self.jobs = jobs or processors()

    def play(self, commands: dict[int, list[str]]) -> Iterator[tuple[int, Outcome]]:
        """Ends all processes when the caller stops asking."""
        lock, running, waiting = threading.Lock(), set(), iter(commands.items())
        ended, has_stopped = queue.SimpleQueue(), False

        def begin_one():
            with lock:
                number, words = next(waiting, (None, None))
                if has_stopped or number is None:
                    return None, None
                # a session of its own: Ctrl-C would end the run early, and as if all were well
                process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                           stderr=subprocess.PIPE, encoding="utf-8",
                                           errors="replace", start_new_session=True)
                running.add(process)
                return number, process

        def serve():
            try:
                while True:
                    number, process = begin_one()
                    if process is None:
                        return
                    out, err = process.communicate()
                    with lock:
                        running.discard(process)
                    ended.put((number, Outcome(process.returncode, out, err)))
            except Exception as error:  # no process could be started
                ended.put((None, error))

        threads = [threading.Thread(target=serve, daemon=True)
                   for _ in range(min(self.jobs, len(commands)))]
        try:
            for thread in threads:
                thread.start()
            for _ in commands:
                number, outcome = _next(ended)
                if number is None:
                    raise outcome
                yield number, outcome
        finally:
            with undisturbed():
                with lock:
                    has_stopped = True
                    for process in running:
                        if process.poll() is None:
                            os.killpg(process.pid, signal.SIGKILL)
                for thread in threads:
                    if thread.ident is not None:
                        thread.join()

    def close(self) -> None:
        pass


class Dask:
    """Workers of a Dask cluster. They need the program under the same path, and nothing of ours:
    what is sent to them is subprocess.run."""

    def __init__(self, scheduler: str = "", jobs: int | None = None):
        """scheduler: address; empty: workers on this machine. Raises ImportError, OSError."""
        import distributed

        self._as_completed = distributed.as_completed
        if scheduler:
            self._client = distributed.Client(scheduler)
        else:
            self._client = distributed.Client(n_workers=jobs or processors(), threads_per_worker=1,
                                              dashboard_address=None)

    def play(self, commands: dict[int, list[str]]) -> Iterator[tuple[int, Outcome]]:
        """Dask gives the runs of a lost worker to others."""
        numbers = {
            self._client.submit(subprocess.run, words, stdin=subprocess.DEVNULL,
                                capture_output=True, encoding="utf-8", errors="replace",
                                start_new_session=True, cwd=os.getcwd(), pure=False): number
            for number, words in commands.items()}
        for future in self._as_completed(list(numbers)):
            try:
                done = future.result()
                outcome = Outcome(done.returncode, done.stdout, done.stderr)
            except Exception as error:  # whatever a cluster may say
                outcome = Outcome(LOST, "", f"{type(error).__name__}: {error}")
            yield numbers.pop(future), outcome

    def close(self) -> None:
        self._client.close()
