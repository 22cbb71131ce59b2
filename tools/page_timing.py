#!/usr/bin/env python3
"""What pages cost: cycle times with four pages and with none, and the server's processor time;
and how many frames a second reach a page.

Usage, in the source folder, with the page built: page_timing.py PROGRAM [SECONDS] [--live]

One run of the door at rest, so that all cycles have the same work; every SECONDS (default 10) four
pages come or go, and in the end one page is there alone. Cycle times are those of the recording,
every cycle counts. With --live, clients of the live interface instead of pages, each subscribed to
everything.
"""

import json
import pathlib
import re
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "tests/command_line"))
from web_socket import Page  # noqa: E402

PHASES = (0, 4, 4, 0, 0, 4, 4, 0, 0, 4, 4, 0, 1)
LIVE_PHASES = (0, 1, 4, 0, 4, 1, 0, 1, 4, 0, 4, 1)
SETTLE_S = 1.0  # after pages have come or gone


class LiveClient:
    """Subscribed to all channels of the live interface; takes what comes and counts its bytes."""

    def __init__(self, link):
        host, token = re.match(r"http://([^/]+)/#token=(\w+)", link).groups()
        name, _, port = host.rpartition(":")
        self.socket = socket.create_connection((name, int(port)), timeout=30)
        self.socket.sendall((f"GET /live?token={token} HTTP/1.1\r\nHost: {host}\r\nConnection: Upgrade\r\n"
                             "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                             "Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n"
                             "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n").encode())
        head = b""
        while b"\r\n\r\n" not in head:
            head += self.socket.recv(4096)
        assert head.startswith(b"HTTP/1.1 101"), head
        subscriptions = [{"id": channel, "channelId": channel} for channel in range(1, 12)]
        text = json.dumps({"op": "subscribe", "subscriptions": subscriptions}).encode()
        mask = bytes(4)
        self.socket.sendall(bytes((0x81, 0x80 | 126)) + struct.pack(">H", len(text)) + mask + text)
        self.frames = 0  # bytes of them

    def listen(self):
        try:
            while chunk := self.socket.recv(65536):
                self.frames += len(chunk)
        except OSError:
            pass


def listen(page):
    """Takes everything that comes, until the page is closed; counts frames."""
    def count(_):
        page.frames += 1
        return False

    try:
        while True:
            page.next("frame", count)
    except (OSError, EOFError, ValueError, TimeoutError):
        pass


def processor_s(task):
    """Processor time so far of a folder of a process or thread in /proc."""
    fields = (task / "stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / 100


def server_s(process):
    """Processor time of the server's thread so far."""
    for task in pathlib.Path(f"/proc/{process.pid}/task").iterdir():
        if (task / "comm").read_text().strip() == "page server":
            return processor_s(task)
    raise RuntimeError("there is no thread of the page server")


def quantile(times, share):
    return times[min(len(times) - 1, int(share * len(times)))]


class Timing:
    """Cycle times of one run of the door at rest, by the number of visitors (pages, clients, bridges)."""

    def __init__(self):
        self.phases = []  # visitors, sorted cycle times in us
        self.server = {}  # share of a core of the server's thread in each phase, by visitors

    def times(self, count):
        return sorted(time for visitors, times in self.phases if visitors == count for time in times)

    def single(self, count, share):
        """This quantile of each phase."""
        return [quantile(times, share) for visitors, times in self.phases if visitors == count]

    def print_table(self, name):
        print(f"{name}  cycles  median us  99 % us  99.9 % us  server thread, % of a core")
        for count, shares in self.server.items():
            values = self.times(count)
            print(f"{count:{len(name)}}  {len(values):6}  {quantile(values, .5):9.2f}  "
                  f"{quantile(values, .99):7.1f}  {quantile(values, .999):9.1f}  "
                  f"{100 * sum(shares) / len(shares):8.2f}")

    def ratio(self, count, share):
        return quantile(self.times(count), share) / quantile(self.times(0), share)


def measure(program, counts, seconds, settle_s, visit):
    """The Timing of a run. `visit(link, count)` brings that many visitors for a phase of `seconds`, after
    `settle_s`, and is a generator: it continues when the phase begins, when it ends (with its length in s),
    and then takes them away."""
    folder = pathlib.Path(tempfile.mkdtemp())
    run = subprocess.Popen([program, "run", "door", "--user", "mouse", "--no-browser", "--recordings", folder,
                            "--duration", "100000"], stdout=subprocess.PIPE, text=True)
    timing, spans = Timing(), []
    try:
        while not (link := re.search(r"http://\S+", run.stdout.readline())):
            pass
        clock = Page(link[0])
        clock.next("frame", lambda frame: frame["mode"] == "running")
        offset = time.monotonic() - clock.next("frame")["time_s"]
        clock.close()
        for count in counts:
            visitors = visit(link[0], count)
            next(visitors)
            time.sleep(settle_s)
            next(visitors)
            begin, spent = time.monotonic(), server_s(run)
            time.sleep(seconds)
            end = time.monotonic()
            spans.append((count, begin - offset, end - offset))
            timing.server.setdefault(count, []).append((server_s(run) - spent) / (end - begin))
            visitors.send(end - begin)
            visitors.close()
    finally:
        if run.poll() is None:
            run.send_signal(signal.SIGINT)
        run.communicate()

    from mcap_ros2.reader import read_ros2_messages
    phases = [[] for _ in spans]
    for message in read_ros2_messages(folder / "latest.mcap", topics=["/hapticgiant/sample"]):
        for phase, (_, begin, end) in zip(phases, spans):
            if begin <= message.ros_msg.record.time_s < end:
                phase.append(message.ros_msg.cycle_time_us)
    shutil.rmtree(folder)
    timing.phases = [(count, sorted(phase)) for phase, (count, _, _) in zip(phases, spans)]
    return timing


def main():
    is_live = "--live" in sys.argv
    program, seconds = ([*(word for word in sys.argv[1:] if word != "--live"), "10"])[:2]
    rates = []

    def visit(link, count):
        pages = [(LiveClient if is_live else Page)(link) for _ in range(count)]
        for page in pages:
            page.frames = 0
            target = page.listen if is_live else lambda page=page: listen(page)
            threading.Thread(target=target, daemon=True).start()
        yield
        seen = sum(page.frames for page in pages)
        length_s = yield
        if pages:
            rates.append((sum(page.frames for page in pages) - seen) / count / length_s)
        for page in pages:
            page.socket.shutdown(2)
        yield

    timing = measure(program, LIVE_PHASES if is_live else PHASES, float(seconds), SETTLE_S, visit)
    timing.print_table("count")
    if is_live:
        print(f"kB per second and client: {1e-3 * min(rates):.0f} .. {1e-3 * max(rates):.0f}")
    else:
        print(f"frames per second and page: {min(rates):.1f} .. {max(rates):.1f}")
    alone = timing.single(0, .5)
    print(f"median of single phases with none: {min(alone):.2f} .. {max(alone):.2f} us")
    for name, share in (("median", .5), ("99 %", .99), ("99.9 %", .999)):
        print(f"four / none, {name}: {timing.ratio(4, share):.3f}")


if __name__ == "__main__":
    main()
