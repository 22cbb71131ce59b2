"""Engines: what plays commands somewhere and yields how each has ended, in any order."""

from __future__ import annotations

import concurrent.futures
import os
import signal
import subprocess
import threading
from typing import Iterator

from hapticgiant.sweep.program import Outcome

LOST = -int(signal.SIGKILL)  # the code of a run whose worker was lost


def processors() -> int:
    """Those that this process may use."""
    return len(os.sched_getaffinity(0))


class Local:
    """Processes on this machine, `jobs` at a time."""

    def __init__(self, jobs: int | None = None):
        self.jobs = jobs or processors()

    def play(self, commands: dict[int, list[str]]) -> Iterator[tuple[int, Outcome]]:
        """Ends all processes when the caller stops asking."""
        lock, running = threading.Lock(), set()
        has_ended = False

        def one(number, words):
            with lock:
                if has_ended:
                    return number, Outcome(LOST, "", "")
                # a session of its own: Ctrl-C would end the run early, and as if all were well
                process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                           stderr=subprocess.PIPE, text=True, errors="replace",
                                           start_new_session=True)
                running.add(process)
            out, err = process.communicate()
            with lock:
                running.discard(process)
            return number, Outcome(process.returncode, out, err)

        pool = concurrent.futures.ThreadPoolExecutor(self.jobs)
        try:
            futures = [pool.submit(one, *item) for item in commands.items()]
            for future in concurrent.futures.as_completed(futures):
                yield future.result()
        finally:
            with lock:
                has_ended = True
                for process in running:
                    process.kill()
            pool.shutdown(cancel_futures=True)

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
                                capture_output=True, text=True, errors="replace",
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
