"""`hapticgiant sweep` on a Dask cluster and on Slurm, both real, beside the same sweep without them.

    engines_test.py PROGRAM

Dask: a scheduler and three workers, one of which is killed while runs are played. Slurm: one node
on this machine, with munged, slurmctld and slurmd started here; needs root and Debian's slurm-wlm.
Installs what it needs into build/sweep_venv (250 MB); `make sweep-engines`, none of `make test`. What
cannot be set up is skipped, by name; with neither the exit code is 77.
"""

import contextlib
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
VENV = ROOT / "build" / "sweep_venv"
PYTHON = VENV / "bin" / "python"
SKIPPED = 77
RUNS = 30
TABLE = f"""\
fixed: {{scenario: door, duration_s: 2}}
parameters:
  seed: {{from: 1, to: {RUNS // 3}, count: {RUNS // 3}}}
  hand: [relaxed, normal, stiff]
"""


def install():
    """Whether the environment is there."""
    wanted = (ROOT / "tools/requirements-sweep.txt").read_text()
    done = VENV / "installed.txt"
    if done.exists() and done.read_text() == wanted:
        return True
    for command in ([sys.executable, "-m", "venv", VENV],
                    [PYTHON, "-m", "pip", "install", "--quiet", "--requirement",
                     ROOT / "tools/requirements-sweep.txt"]):
        if subprocess.run(command).returncode != 0:
            return False
    done.write_text(wanted)
    return True


def sweep(*words, **options):
    return subprocess.run([PROGRAM, "sweep", *map(str, words)], capture_output=True, text=True,
                          env={**os.environ, "HAPTICGIANT_PYTHON": str(PYTHON)}, timeout=600,
                          **options)


def wait_for(what, seconds=180):
    deadline = time.monotonic() + seconds
    while not what():
        if time.monotonic() > deadline:
            raise TimeoutError(what)
        time.sleep(0.05)


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


class Engines(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="hg_sweep_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        cls.file = cls.folder / "sweep.yaml"
        cls.file.write_text(TABLE)
        done = sweep(cls.file, "--out", cls.folder / "local")
        assert done.returncode == 0, done.stdout + done.stderr
        cls.local = (cls.folder / "local/results.parquet").read_bytes()

    def hashes(self, out):
        records = [json.loads(line) for file in out.glob("manifest*.jsonl")
                   for line in file.read_text().splitlines()]
        return {record["run"]: record["state_hash"] for record in records}

    def is_the_same(self, out):
        self.assertEqual(self.hashes(out), self.hashes(self.folder / "local"))
        self.assertEqual(len(self.hashes(out)), RUNS)
        self.assertEqual((out / "results.parquet").read_bytes(), self.local)

    @contextlib.contextmanager
    def cluster(self, workers):
        address = f"tcp://127.0.0.1:{free_port()}"
        # the dask of a cluster need not have anything of ours
        start = [PYTHON, "-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port",
                 address.rpartition(":")[2], "--dashboard-address", f"127.0.0.1:{free_port()}"]
        work = [PYTHON, "-m", "distributed.cli.dask_worker", address, "--nthreads", "1",
                "--no-nanny", "--local-directory", self.folder / "dask"]
        with contextlib.ExitStack() as stack:
            processes = []
            for command in [start] + [work] * workers:
                process = subprocess.Popen(list(map(str, command)), stdout=subprocess.DEVNULL,
                                           stderr=subprocess.DEVNULL, cwd="/")
                stack.callback(process.wait)
                stack.callback(process.kill)
                processes.append(process)
            yield address, processes[1:]

    def test_dask_with_a_worker_that_is_killed(self):
        out = self.folder / "dask_out"
        with self.cluster(3) as (address, workers):
            process = subprocess.Popen(
                [PROGRAM, "sweep", self.file, "--out", out, "--engine", "dask", "--scheduler",
                 address], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                env={**os.environ, "HAPTICGIANT_PYTHON": str(PYTHON)})
            manifest = out / "manifest.jsonl"
            self.addCleanup(process.kill)
            wait_for(lambda: process.poll() is not None
                     or manifest.exists() and manifest.stat().st_size > 0)
            workers[0].send_signal(signal.SIGKILL)
            said = "\n".join(process.communicate(timeout=600))
        self.assertEqual(process.returncode, 0, said)
        self.is_the_same(out)

    def test_dask_on_this_machine(self):
        out = self.folder / "dask_here"
        done = sweep(self.file, "--out", out, "--engine", "dask", "--jobs", 2)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.is_the_same(out)

    def test_a_scheduler_that_does_not_answer_is_named(self):
        done = sweep(self.file, "--out", self.folder / "none", "--engine", "dask", "--scheduler",
                     f"tcp://127.0.0.1:{free_port()}")
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertIn("--scheduler tcp://127.0.0.1", done.stderr)

    @contextlib.contextmanager
    def slurm(self):
        """A node of Slurm; its configuration in the environment that it yields."""
        missing = [name for name in ("munged", "slurmctld", "slurmd", "sbatch")
                   if shutil.which(name, path=os.environ["PATH"] + ":/usr/sbin") is None]
        if missing or os.geteuid() != 0:
            self.skipTest(f"Slurm: needs root and slurm-wlm, {', '.join(missing)} missing")
        folder = self.folder / "slurm"
        folder.mkdir()
        folder.chmod(0o755)
        self.folder.chmod(0o755)
        key = folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        host, processors = socket.gethostname().split(".")[0], os.cpu_count()
        configuration = folder / "slurm.conf"
        configuration.write_text(f"""\
ClusterName=one
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={free_port()}
SlurmdPort={free_port()}
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
NodeName={host} NodeAddr=127.0.0.1 CPUs={processors} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
""")
        environment = {**os.environ, "SLURM_CONF": str(configuration),
                       "PATH": os.environ["PATH"] + ":/usr/sbin",
                       "HAPTICGIANT_PYTHON": str(PYTHON)}
        with contextlib.ExitStack() as stack:
            def start(*words):
                process = subprocess.Popen(words, env=environment, stdout=subprocess.DEVNULL,
                                           stderr=subprocess.DEVNULL)
                stack.callback(process.wait)
                stack.callback(process.terminate)

            # munged first: slurmctld asks it
            start("munged", "--foreground", "--force", f"--key-file={key}",
                  f"--socket={folder}/munge.socket", f"--pid-file={folder}/munge.pid",
                  f"--log-file={folder}/munge.log", f"--seed-file={folder}/munge.seed")
            wait_for((folder / "munge.socket").exists)
            start("slurmctld", "-D")
            start("slurmd", "-D")
            wait_for(lambda: b"idle" in subprocess.run(
                ["sinfo", "--noheader"], env=environment, capture_output=True).stdout)
            yield environment

    def test_slurm_as_a_job_array(self):
        out = self.folder / "slurm_out"
        with self.slurm() as environment:
            done = subprocess.run([PROGRAM, "sweep", "submit", self.file, "--out", out, "--shards",
                                   "5", "--sbatch=--time=00:10:00"], env=environment,
                                  capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            wait_for(lambda: not subprocess.run(["squeue", "--noheader"], env=environment,
                                                capture_output=True).stdout, 300)
        said = "".join(file.read_text() for file in out.glob("slurm-*.txt"))
        self.assertEqual(len(list(out.glob("manifest.*of5.jsonl"))), 5, said)
        done = sweep("merge", self.file, "--out", out)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr + said)
        self.is_the_same(out)


if __name__ == "__main__":
    if not install():
        print("skipped: Dask and pyarrow could not be installed into build/sweep_venv")
        sys.exit(SKIPPED)
    unittest.main(verbosity=2)
