"""Many runs over a table of parameters, on this machine, on Dask or on Slurm.

A sweep is a YAML file (docs/start/sweep.md). Each of its runs is one `hapticgiant run --fast` in a
process of its own, so that a run has the same bits wherever it is played, a crash costs one run,
and the command that repeats a run is the one that has made it.

    from hapticgiant import sweep

    result = sweep.run("sweep.yaml", jobs=2)
    print(result.file, [row["force.mean_N"] for row in result.rows])
"""

from hapticgiant.sweep.campaign import Result, SweepError, check, merge, run
from hapticgiant.sweep.description import Sweep, load_sweep
from hapticgiant.sweep.reader import InputError

__all__ = ["InputError", "Result", "Sweep", "SweepError", "check", "load_sweep", "merge", "run"]
