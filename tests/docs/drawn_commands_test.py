"""Draws commands of the documents by a seed and plays them: those that docs_test.py does not run.

    drawn_commands_test.py PROGRAM [--seed N | --today] [--count 20] [--list]

Documents are README.md, docs/**/*.md and models/README.md; commands are lines of their blocks that begin with
`hapticgiant`, and what stands so between backticks. Drawn are those that this computer can play: without a machine, a
cluster, another program, or a word that stands for another (FILE, HOST). Each is played in a folder of its own that has
the files which the documents speak of: examples under the names of my_*, a recording, links to models/ and examples/.

A command must end with exit code 0, or with N where its line ends with `# exit N`. One that still runs after LONGEST_S
has been understood and gets SIGINT: within ENDING_S it must end so, or as one that was interrupted. The same seed and
documents draw the same commands, every day; with --today the seed is the date, as 20261130.
"""

import argparse
import contextlib
import dataclasses
import datetime
import os
import pathlib
import random
import re
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SEED = 1
LONGEST_S = 5
ENDING_S = 120
INTERRUPTED = (130, -signal.SIGINT)
VERDICTS = ("commission", "start-test")  # of which an interrupted one is not passed: 1
PREPARING_S = 300
BLOCK = re.compile(r"^```(\S*)[^\n]*\n(.*?)^```$", re.MULTILINE | re.DOTALL)
INDENTED = re.compile(r"^    (\S.*)$", re.MULTILINE)
INLINE = re.compile(r"`((?:build/release/)?hapticgiant [^`]+)`")
COMMAND = re.compile(r"^(?:build/release/)?hapticgiant (.+)$")
ELSEWHERE = re.compile(
    r"--device-address|\bbus\b"  # machines, or a second terminal
    r"|\bsubmit\b|--engine|\bmerge\b|\bbridge\b|\brender\b|--lsl"  # clusters, other programs
    r"|--docs\b|--request\b|study (?:report|forget)")  # what writes into the documents, or needs what was done before
STANDS_FOR = re.compile(r"(?<![\w'\"])(?!USB|[A-Z0-9]{1,2}\b)[A-Z][A-Z_]{2,}\b|\.\.\.|[\[\]<>|;&$*]")
FILE = re.compile(r"^[\w./-]+\.(?:yaml|yml|urdf|mcap|hqp|csv|json|svg|png|npz)$")
LEFT_OUT = r"is required|required \w+ missing"
MADE_BY = ("--out", "-o", "--json", "--svg", "--picture", "--map", "--markdown", "--recordings", "--report")


@dataclasses.dataclass(frozen=True)
class Documented:
    """A command that a document shows."""

    page: str
    text: str
    exit_code: int
    is_mention: bool = False
    """Stands in a sentence, where what it needs may be left out."""


def lines_of(text):
    """Logical lines, without the comments behind them: (line, exit code that its comment says)."""
    for line in text.replace("\\\n", " ").splitlines():
        command, _, comment = line.partition(" #")
        command = re.split(r" {3,}", command.strip())[0]  # words beside it
        code = re.search(r"exit (\d+)", comment)
        yield command, int(code[1]) if code else 0


def commands_of(page):
    """The commands of a document that docs_test.py leaves out."""
    text, name, found = page.read_text(encoding="utf-8"), str(page.relative_to(ROOT)), []
    is_run_there = name.startswith("docs/")
    blocks = [body for kind, body in BLOCK.findall(text) if not (kind == "sh" and is_run_there)]
    rest = BLOCK.sub("", text)
    for line, code in lines_of("\n".join([*blocks, *INDENTED.findall(rest)])):
        if COMMAND.match(line):
            found.append(Documented(name, line, code))
    found += [Documented(name, " ".join(words.split()), 0, True) for words in INLINE.findall(INDENTED.sub("", rest))]
    return found


def words_of(command):
    return shlex.split(COMMAND.match(command.text)[1])


def is_playable(command, folder):
    """Whether this computer can play it: nothing that stands for something else, and every file that it reads is there."""
    if ELSEWHERE.search(command.text) or STANDS_FOR.search(command.text):
        return False
    try:
        words = words_of(command)
    except ValueError:  # a quote that is open
        return False
    for before, word in zip(["", *words], words):
        if FILE.match(word) and before not in MADE_BY and not (folder / word).exists():
            return False
    return len(words) > 1 or words[0] in ("run", "doctor", "commission", "start-test")


def every_command(folder):
    """All commands that can be played, once each."""
    pages = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")), ROOT / "models" / "README.md"]
    known = {}
    for page in pages:
        for command in commands_of(page):
            if is_playable(command, folder):
                known.setdefault(" ".join(words_of(command)), command)
    return list(known.values())


def prepare(program, folder):
    """Makes what the documents take as there."""
    for name in ("models", "examples", "bench"):
        (folder / name).symlink_to(ROOT / name)
    for file in (ROOT / "models" / "examples").glob("*"):
        shutil.copy(file, folder)
    for name in ("arm", "gate"):
        shutil.copy(folder / f"{name}.urdf", folder / f"my_{name}.urdf")
    for words in (["new", "device", "my_arm.urdf"], ["new", "twin", "my_gate.urdf", "--device", "my_arm_device.yaml"],
                  ["new", "device", "arm.urdf"], ["new", "twin", "gate.urdf", "--device", "arm_device.yaml"],
                  ["study", "new", "my_study.yaml"], ["study", "new", "door_and_path.yaml"],
                  ["run", "door", "--fast", "--no-viewer", "--duration", "2", "--recordings", "recordings"]):
        done = subprocess.run([program, *words], cwd=folder, capture_output=True, text=True, timeout=PREPARING_S)
        if done.returncode not in ((0, 1) if words[0] == "run" else (0,)):  # two seconds do not open the door
            sys.exit(f"{' '.join(words)}: exit {done.returncode}\n{done.stdout}{done.stderr}")
    for name, source in (("my_device", "my_arm_device"), ("my_twin", "my_gate_twin"), ("my_arm", "my_arm_device")):
        shutil.copy(folder / f"{source}.yaml", folder / f"{name}.yaml")
    latest = (folder / "recordings" / "latest.mcap").resolve()
    for name in ("one.mcap", "two.mcap"):
        shutil.copy(latest, folder / name)


def free_port():
    with contextlib.closing(socket.socket()) as found:
        found.bind(("127.0.0.1", 0))
        return str(found.getsockname()[1])


def end_of(process, exit_code, interrupted):
    """Its exit code, None where it does not end; and those that are right for it, (exit_code,) if it ends uninterrupted."""
    try:
        return process.wait(LONGEST_S), (exit_code,)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGINT)
    wanted = tuple(dict.fromkeys((0, exit_code, *interrupted)))
    try:
        return process.wait(ENDING_S), wanted
    except subprocess.TimeoutExpired:
        return None, wanted


def play(program, command, folder):
    """What is wrong with a command; empty: nothing."""
    words = [re.sub(r"^(127\.0\.0\.1:)?(4810|8080)$", lambda found: (found[1] or "") + free_port(), word)
             for word in words_of(command)]
    if words[0] == "new" and words[1] in ("device", "twin"):
        words.append("--force")  # the prepared folder has their files
    environment = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    with tempfile.TemporaryFile("w+", errors="replace") as said:
        process = subprocess.Popen([program, *words], cwd=folder, stdin=subprocess.DEVNULL, stdout=said, stderr=said,
                                   env=environment, start_new_session=True)
        try:
            interrupted = (*INTERRUPTED, 1) if words[0] in VERDICTS else INTERRUPTED
            code, wanted = end_of(process, command.exit_code, interrupted)
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        said.seek(0)
        text = said.read()
    if code in wanted or code is not None and command.is_mention and re.search(LEFT_OUT, text):
        return ""
    end = f"still ran {ENDING_S} s after SIGINT" if code is None else f"exit {code}"
    return f"{command.page}: {command.text}\n  {end}, expected {' or '.join(map(str, wanted))}\n{text[-1500:]}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", type=lambda name: str(pathlib.Path(name).resolve()))
    seed = parser.add_mutually_exclusive_group()
    seed.add_argument("--seed", type=int, default=SEED)
    seed.add_argument("--today", dest="seed", action="store_const", const=int(datetime.date.today().strftime("%Y%m%d")),
                      help="the date as seed")
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--list", action="store_true", help="print all that can be drawn, and play nothing")
    words = parser.parse_args()
    signal.signal(signal.SIGINT, signal.default_int_handler)  # in the background it is ignored, by commands, too
    faults = []
    with tempfile.TemporaryDirectory() as before:
        prepared = pathlib.Path(before)
        prepare(words.program, prepared)
        known = every_command(prepared)
        if words.list:
            print("\n".join(f"{command.page}: {command.text}" for command in known))
            return 0
        drawn = random.Random(words.seed).sample(known, min(words.count, len(known)))
        print(f"seed {words.seed}: {len(drawn)} of {len(known)} commands", flush=True)
        for command in drawn:
            print(f"  {command.page}: {command.text}", flush=True)
            with tempfile.TemporaryDirectory() as own:
                shutil.copytree(prepared, own, symlinks=True, dirs_exist_ok=True)
                if fault := play(words.program, command, pathlib.Path(own)):
                    faults.append(fault)
    for fault in faults:
        print(fault, file=sys.stderr)
    print(f"{len(faults)} were wrong; again: --seed {words.seed}")
    return 1 if faults or not drawn else 0


if __name__ == "__main__":
    sys.exit(main())
