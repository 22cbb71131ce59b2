"""Command line of `hapticgiant sweep`; docs/start/sweep.md.

Exit codes: 0 every run has a result, 1 some have none or are not the same again, 2 bad input,
130 ended by Ctrl-C.
"""

from __future__ import annotations

import signal
import sys
import time

ENDED = 130  # exit code after Ctrl-C


AT_ONCE_S = 1.0  # signals that follow each other are one
interrupted_at = -AT_ONCE_S


def interrupt(*_):
    global interrupted_at
    now = time.monotonic()
    if now - interrupted_at >= AT_ONCE_S:  # a second one would end what cleans up after the first
        interrupted_at = now
        raise KeyboardInterrupt


def end(code):
    """Ends without a word on what Ctrl-C interrupts from now on."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    if code == ENDED:
        print("\nended; what has been played is kept, and the same command continues",
              file=sys.stderr)
    sys.exit(code)


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, interrupt)
    signal.signal(signal.SIGINT, lambda *_: end(ENDED))  # until main() begins

import argparse  # noqa: E402
import ctypes  # noqa: E402
import importlib.util  # noqa: E402
import os  # noqa: E402
import pathlib  # noqa: E402

if not __package__:
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
    import as_folder  # noqa: F401

SHOWN = 5  # commands of a kind that are printed
COMMANDS = ("submit", "merge", "check", "show")


def shard(text):
    index, _, count = text.partition("/")
    if not (index.isdigit() and count.isdigit() and 1 <= int(index) <= int(count)):
        raise argparse.ArgumentTypeError(f"expected I/N with I from 1 to N, got '{text}'")
    return int(index), int(count)


def parsers():
    from hapticgiant.command_line import Parser, whole_number

    positive = whole_number(1)

    main = Parser(
        prog="hapticgiant sweep",
        description="Many runs over a table of parameters (docs/start/sweep.md). The same command "
                    "again continues where a sweep has ended.",
        epilog="hapticgiant sweep submit|merge|check|show SWEEP --help: a job array of Slurm, the "
               "table of all shards, runs played again, what would be played")
    main.add_argument("sweep", help="sweep.yaml")
    submit = Parser(prog="hapticgiant sweep submit",
                    description="Writes the script of a job array, and hands it to Slurm.")
    merge = Parser(prog="hapticgiant sweep merge",
                   description="Makes one table of all shards that are there.")
    check = Parser(
        prog="hapticgiant sweep check",
        description="Plays runs again and compares their exit codes, hashes and measures.")
    show = Parser(prog="hapticgiant sweep show",
                  description="Prints the commands of the runs, plays nothing.")
    for other in (submit, merge, check, show):
        other.add_argument("sweep", help="sweep.yaml")
    for each in (main, submit, merge, check):
        each.add_argument("-o", "--out", help="folder of the sweep; default: NAME.sweep beside NAME.yaml")
    for each in (main, check):
        each.add_argument("--jobs", type=positive,
                          help="processes at a time; default: one per processor")
        each.add_argument("--engine", choices=("local", "dask"), default="local")
        each.add_argument("--scheduler", default="",
                          help="address of a Dask scheduler; default: workers on this machine")
    main.add_argument("--quiet", action="store_true",
                      help="say only which runs have no result; end with the process that started "
                           "this: for commands that play their runs so")
    main.add_argument("--shard", type=shard, metavar="I/N", help="only each N-th run, from the I-th on")
    for each in (main, submit):
        each.add_argument("--again", action="store_true", help="forget the runs that the folder has")
    submit.add_argument("--shards", type=positive, help="elements of the array; default: one per 50 runs")
    submit.add_argument("--cpus", type=positive, default=1, help="processors, and jobs, of an element")
    submit.add_argument("--sbatch", action="append", default=[], metavar="OPTION",
                        help="an option for Slurm, as --sbatch=--time=01:00:00; may be given several times")
    submit.add_argument("--dry-run", action="store_true", help="write the script only")
    check.add_argument("--count", type=positive, default=10, help="how many runs")
    check.add_argument("--all", action="store_true", help="all of them")
    show.add_argument("--run", type=positive, help="only this one")
    return {"": main, "submit": submit, "merge": merge, "check": check, "show": show}


def runs(count):
    return f"{count} run" if count == 1 else f"{count} runs"


def tell_commands(title, found, result):
    if not found:
        return
    print(f"\n{title}")
    for run in found[:SHOWN]:
        error = (result.records.get(run.number) or {}).get("error", "")
        print(f"  run {run.number}: {result.command(run)}")
        for line in error.splitlines()[:3]:
            print(f"    {line}")
    if len(found) > SHOWN:
        print(f"  and {len(found) - SHOWN} more; all are in {result.folder / 'repeat.sh'}")


def tell(result, is_quiet=False):
    """Prints what came of a sweep; its exit code."""
    if is_quiet:
        tell_commands("without a result:", result.without_result(), result)
        return 1 if result.without_result() else 0
    lost, fault, unexpected = result.without_result(), result.with_code(3), result.with_code(1)
    continued = f", {result.repeated} of them from before" if result.repeated else ""
    print(f"{runs(len(result.runs))} of '{result.sweep.title}'{continued}: "
          f"{len(result.with_code(0))} as expected, {len(unexpected)} not as expected, "
          f"{len(fault)} stopped by a fault, {len(lost)} without a result")
    named = sorted(lost + fault + unexpected, key=lambda run: run.number)
    if result.shard is None:
        lines = "".join(f"{result.command(run)}  # run {run.number}\n" for run in named)
        (result.folder / "repeat.sh").write_text(lines, encoding="utf-8")
        print(f"  result     {result.file}")
    tell_commands("without a result:", lost, result)
    tell_commands("stopped by a fault:", fault, result)
    tell_commands("an event is missing or a limit was exceeded:", unexpected, result)
    return 1 if lost else 0


def end_with_parent():
    """Ctrl-C reaches a whole group of processes; what kills only the parent would leave us."""
    pr_set_pdeathsig = 1
    ctypes.CDLL(None).prctl(pr_set_pdeathsig, signal.SIGTERM)


def run(command, arguments):
    """Does what a subcommand says, "": plays the runs; the exit code. Raises InputError, SweepError."""
    from hapticgiant.sweep import campaign, description, slurm

    described = description.load_sweep(arguments.sweep)
    if command == "show":
        program = campaign.find_program()
        for run in described.runs:
            if arguments.run in (None, run.number):
                print(campaign.Result(described, pathlib.Path(), {}, program).command(run))
        return 0
    if command == "merge":
        return tell(campaign.merge(described, arguments.out))
    if command == "check":
        found = campaign.check(described, arguments.out, jobs=arguments.jobs,
                               count=None if arguments.all else arguments.count,
                               engine=arguments.engine, scheduler=arguments.scheduler)
        print(f"{runs(len(found.played))} played again: "
              f"{len(found.played) - len(found.differing)} the same, {len(found.differing)} not")
        for run, what in found.differing:
            print(f"  run {run.number}: {what}\n    {found.result.command(run)}")
        return 1 if found.differing or not found.played else 0
    if command == "submit":
        if arguments.again:
            campaign.forget(campaign.Folder(campaign.folder_of(described, arguments.out)))
        campaign.begin(described, arguments.out)
        script = slurm.write_script(described, arguments.out, campaign.find_program().file,
                                    arguments.shards, arguments.cpus, arguments.sbatch)
        print(f"  script     {script}")
        if not arguments.dry_run:
            print(f"  job        {slurm.submit(script)}; when it is done:")
            out = f" --out {arguments.out}" if arguments.out else ""
            print(f"  hapticgiant sweep merge {arguments.sweep}{out}")
        return 0
    if arguments.quiet:
        end_with_parent()
    return tell(campaign.run(described, arguments.out, jobs=arguments.jobs,
                             shard=arguments.shard, engine=arguments.engine,
                             scheduler=arguments.scheduler, again=arguments.again,
                             table=not arguments.quiet),
                arguments.quiet)


def main(words):
    has_yaml = importlib.util.find_spec("yaml") is not None
    if words == ["--check"]:  # who asks says what is missing
        return 0 if has_yaml else 2
    if not has_yaml:
        print(f"sweep: {sys.executable} needs PyYAML: tools/setup.sh build, or pip install "
              "'hapticgiant[sweep]'", file=sys.stderr)
        return 2
    from hapticgiant.command_line import exit_code_of
    from hapticgiant.sweep import campaign, reader

    command = words[0] if words and words[0] in COMMANDS else ""
    known = parsers()
    is_word = len(words) > 1 and not any(word.startswith("-") for word in words[:2])
    if not command and is_word and not pathlib.Path(words[0]).exists():
        known[""].wrong(words[0], "subcommand", COMMANDS)
    arguments = known[command].parse_args(words[1:] if command else words)

    return exit_code_of("sweep", lambda: run(command, arguments), (reader.InputError, campaign.SweepError))


if __name__ == "__main__":
    try:
        signal.signal(signal.SIGINT, interrupt)
        exit_code = main(sys.argv[1:])
    except KeyboardInterrupt:
        exit_code = ENDED
    end(exit_code)
