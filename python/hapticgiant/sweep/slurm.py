"""A sweep as a job array of Slurm: one element per shard."""

from __future__ import annotations

import pathlib
import re
import shlex
import shutil
import subprocess
import sys

from hapticgiant.sweep.campaign import SweepError, folder_of
from hapticgiant.sweep.description import Sweep

RUNS_PER_SHARD = 50  # an element of an array takes Slurm a second
MOST_SHARDS = 1000  # Slurm's default: MaxArraySize 1001, and we count from 1


def most_shards() -> int:
    """What this Slurm takes."""
    try:
        said = subprocess.run(["scontrol", "show", "config"], capture_output=True, text=True)
    except OSError:
        return MOST_SHARDS
    found = re.search(r"^MaxArraySize\s*=\s*(\d+)", said.stdout, re.MULTILINE)
    return int(found.group(1)) - 1 if found else MOST_SHARDS


def write_script(sweep: Sweep, out: str | None, program: str, shards: int | None, cpus: int,
                 options: list[str]) -> pathlib.Path:
    """Writes slurm.sh into the folder of the sweep. Raises SweepError."""
    most = most_shards()
    if shards is None:
        shards = min(most, -(-len(sweep.runs) // RUNS_PER_SHARD))
    if not 1 <= shards <= min(most, len(sweep.runs)):
        raise SweepError(f"--shards: expected 1 to {min(most, len(sweep.runs))} (runs, and the "
                         f"MaxArraySize of this Slurm), got {shards}")
    folder = folder_of(sweep, out).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    command = [program, "sweep", str(sweep.file.resolve()), "--out", str(folder)]
    lines = ["#!/bin/sh", f"#SBATCH --job-name={shlex.quote(sweep.file.stem)}",
             f"#SBATCH --array=1-{shards}", f"#SBATCH --cpus-per-task={cpus}",
             f"#SBATCH --output={folder}/slurm-%a.txt",
             *(f"#SBATCH {option}" for option in options),
             f"export HAPTICGIANT_PYTHON={shlex.quote(sys.executable)}",
             f"exec {shlex.join(command)} --jobs {cpus} --shard $SLURM_ARRAY_TASK_ID/{shards}"]
    script = folder / "slurm.sh"
    script.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return script


def submit(script: pathlib.Path) -> str:
    """Hands the script to Slurm; the number of its job. Raises SweepError."""
    if shutil.which("sbatch") is None:
        raise SweepError(f"{script} is written, but there is no sbatch here: run `sbatch {script}` "
                         "on a machine of the cluster")
    done = subprocess.run(["sbatch", "--parsable", str(script)], capture_output=True, text=True)
    if done.returncode != 0:
        raise SweepError(f"sbatch {script}: {done.stderr.strip()}")
    return done.stdout.strip().split(";")[0]
