"""Command line of `hapticgiant study`; docs/start/user_studies.md.

Exit codes: 0 as it should be, 1 something would ruin the study or a trial has no result, 2 bad input,
130 ended by Ctrl-C.
"""

from __future__ import annotations

import argparse
import importlib.util
import os
import pathlib
import signal
import sys
import tempfile

if not __package__:
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
    import as_folder  # noqa: F401

SHIPPED = pathlib.Path(__file__).resolve().parent / "door_and_path.yaml"
NEEDED = {"yaml": "pyyaml", "numpy": "numpy", "scipy": "scipy"}
FOR_MIXED = {"statsmodels": "statsmodels"}
NEEDED_BY = {"report": {"matplotlib": "matplotlib", "jinja2": "jinja2"}, "run": {"aiohttp": "aiohttp", "mcap": "mcap"},
             "simulate": {"mcap": "mcap"}, "check": {"mcap": "mcap"}}


def parser():
    from hapticgiant.command_line import Parser, whole_number

    main = Parser(prog="hapticgiant study", description="User studies (docs/start/user_studies.md).")
    commands = main.add_subparsers(dest="command", required=True, metavar="COMMAND")

    def add(name, what):
        command = commands.add_parser(name, help=what, description=what)
        command.add_argument("study", help="study.yaml")
        return command

    add("new", "Writes a study of two conditions that is complete, as a file to be changed.")
    check = add("check", "Finds what would ruin a study, plays a trial of each condition, and simulates its tests.")
    check.add_argument("--no-trials", action="store_true", help="play nothing")
    registration = add("preregistration", "Writes the text of a pre-registration (Markdown).")
    for each in (check, registration):
        each.add_argument("--simulations", type=whole_number(1), default=500, help="simulated studies per figure")
    plan = add("plan", "Prints the order of each participant.")
    plan.add_argument("--participant", metavar="CODE", help="every step of this one")
    add_run(add)
    simulate = add("simulate", "Plays a study with simulated people; the same command again continues.")
    simulate.add_argument("--participants", type=whole_number(1), metavar="N", help="only the first N of the plan")
    simulate.add_argument("--jobs", type=whole_number(1), help="trials at a time; default: one per processor")
    simulate.add_argument("--keep-recordings", action="store_true", help="keep the recording of each trial (27 MB for 14 s)")
    report = add("report", "Writes report.html, report.tex and the analysis script into the folder of the study.")
    forget = commands.add_parser("forget", help="Deletes everything of one participant.",
                                 description="Deletes everything of one participant.")
    forget.add_argument("code", metavar="CODE")
    forget.add_argument("study", help="study.yaml")
    for each in (simulate, report, forget):
        each.add_argument("-o", "--out", help="folder of the study; default: NAME.study beside study.yaml")
    return main


def add_run(add):
    command = add("run", "The pages of operator and participant: plays the study with people; again it continues.")
    command.add_argument("-o", "--out", help="folder of the study; default: NAME.study beside study.yaml")
    command.add_argument("--rehearse", action="store_true",
                         help="the scripted hand plays the trials, and the folder (NAME.rehearsal) says so")
    command.add_argument("--bind", type=address, default="127.0.0.1", metavar="ADDRESS",
                         help="IPv4 address of this machine that the pages are served at")
    command.add_argument("--port", type=port, default=0, help="of the pages; default: any free one")
    command.add_argument("--no-browser", action="store_true", help="print the links only")
    device = command.add_argument_group("a machine, as of hapticgiant run; without one a simulated device is moved with the mouse")
    device.add_argument("--device-address", metavar="HOST:PORT")
    for name, what in (("--machine", "FILE"), ("--key-file", "FILE"), ("--posture-confirmed", "NAMES"), ("--despite", "NAMES")):
        device.add_argument(name, metavar=what)
    device.add_argument("--without-start-test", action="store_true")
    device.add_argument("--without-move-to-start", action="store_true",
                        help="somebody else brings the device to the start of each trial")
    return command


def address(text):
    import ipaddress

    try:
        found = ipaddress.IPv4Address(text)
    except ValueError:
        found = None
    if found is None or found.is_unspecified:
        raise argparse.ArgumentTypeError(f"expected an IPv4 address of this machine, as 192.168.1.20, got '{text}'")
    return text


def port(text):
    if not (text.isdigit() and int(text) <= 65535):
        raise argparse.ArgumentTypeError(f"expected a whole number from 0 to 65535, got '{text}'")
    return int(text)


def hand_of(arguments):
    """Who moves the handle, from the options of `study run`."""
    from hapticgiant.study.conductor import Hand
    from hapticgiant.sweep.reader import InputError

    given = {name: value for name in ("machine", "key_file", "posture_confirmed", "despite", "without_start_test",
                                      "without_move_to_start") if (value := getattr(arguments, name))}
    if arguments.device_address is None:
        if given:
            raise InputError(f"--{next(iter(given)).replace('_', '-')}: needs --device-address")
        return Hand("script" if arguments.rehearse else "mouse")
    if arguments.rehearse:
        raise InputError("--rehearse: is with the simulated device, leave out --device-address")
    for name in ("posture_confirmed", "despite"):
        if name in given:
            given[name] = given[name].split(",")
    moves = not given.pop("without_move_to_start", False)
    return Hand("device", {"device_address": arguments.device_address, "move_to_start": moves, **given})


def serve(study, arguments):
    import asyncio

    from hapticgiant.study import markers, planning, trials
    from hapticgiant.study.conductor import Conductor, expected_events
    from hapticgiant.study.folder import Folder
    from hapticgiant.study.server import Server
    from hapticgiant.sweep.program import find_program
    from hapticgiant.sweep.reader import InputError

    pages = pathlib.Path(os.environ.get("HAPTICGIANT_PAGE", ""))
    if not (pages / "study" / "operator.html").is_file():
        raise InputError("the page is not built: cd viewer && npm ci && npm run build")
    markers.require(study)
    hand, program = hand_of(arguments), find_program()
    trials.require_columns(study, trials.known_columns(program))
    events = expected_events(study, program, hand)
    for problem in planning.problems_of(study):
        print(f"PROBLEM: {problem}; hapticgiant study check {arguments.study}")
    folder = Folder(study, arguments.out or (study.file.with_suffix(".rehearsal") if arguments.rehearse else None))
    folder.begin(program.version, not hand.is_real, hand.model)

    async def until_it_ends():
        server = Server(pages, arguments.bind, arguments.port)
        await server.open()
        server.conductor = Conductor(study, folder, program, hand, events, server.origins(), server.changed)
        for name in ("operator", "participant"):
            print(f"{name:12}{server.link(name)}", flush=True)
        if arguments.bind != "127.0.0.1":
            print(f"            WARNING: listening at {arguments.bind}: whoever reaches it and has a link can use it; "
                  "it is not encrypted")
        print(f"folder      {folder.path}\nend         Ctrl-C", flush=True)
        if not arguments.no_browser:
            show(server.link("operator"))
        await server.run()

    asyncio.run(until_it_ends())
    print("\nended; the same command continues")
    return 0


def show(link):
    """Opens the page where there is a display and a terminal."""
    import webbrowser

    if sys.stdout.isatty() and (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        webbrowser.open(link)


def missing(needed):
    return [package for module, package in needed.items() if importlib.util.find_spec(module) is None]


def write_new(name):
    """Writes the shipped study under a name of its own."""
    from hapticgiant.sweep.reader import InputError

    file = pathlib.Path(name)
    if file.suffix not in (".yaml", ".yml"):
        raise InputError(f"{file}: expected a name that ends in .yaml, as {file.name}.yaml")
    try:
        with open(file, "x", encoding="utf-8") as out:
            out.write(SHIPPED.read_text(encoding="utf-8"))
    except FileExistsError:
        raise InputError(f"{file}: is there already; take another name") from None
    print(f"written     {file}\nnext        hapticgiant study check {file}")
    return 0


def show_plan(study, code):
    from hapticgiant.study import planning
    from hapticgiant.sweep.reader import InputError, nearest

    found = planning.plan(study)
    if code is None:
        for each in found:
            print(f"{each.code}  {'  '.join(each.conditions)}")
        return 0
    one = next((each for each in found if each.code == code), None)
    if one is None:
        raise InputError(f"--participant {code}: no such code, did you mean '{nearest(code, [p.code for p in found])}'?")
    for number, step in enumerate(planning.steps(study, one), 1):
        what = step.form or step.text or f"{step.condition} {step.repetition}"
        about = f" about {step.condition}" if step.kind == "form" and step.condition else ""
        print(f"{number:3}  {step.kind:11}  {what}{about}")
    return 0


def check(study, arguments):
    from hapticgiant.study import markers, planning, simulation, trials
    from hapticgiant.sweep.campaign import explained
    from hapticgiant.sweep.program import find_program

    problems, notes = planning.problems_of(study), planning.notes_of(study)
    try:
        markers.require(study)
    except markers.MarkerError as error:
        problems.append(str(error))
    design = study.design
    print(f"{study.title}: {design.participants} participants, {len(study.conditions)} conditions {design.kind} "
          f"people, {design.repetitions} trials of each, order {design.order}")
    program = find_program()
    trials.require_columns(study, trials.known_columns(program))
    if not arguments.no_trials:
        with tempfile.TemporaryDirectory(prefix="hapticgiant_study_") as work:
            try:
                measured = simulation.try_conditions(study, program, pathlib.Path(work))
            except trials.TrialError as error:
                print(explained(str(error), study), file=sys.stderr)
                return 2
        print("\na trial of each condition, by the first simulated person:")
        for name in study.measures:
            unit = study.measures[name].unit
            values = "".join(f"{one.measures[name]:12.4g}" for one in measured.values())
            print(f"  {name:24}{values}  {unit}")
            problems += [f"measure {name} has no value in condition {condition}: {one.no_value[name]}"
                         for condition, one in measured.items() if name in one.no_value]
        for condition, one in measured.items():
            if one.exit_code:
                what = f", {trials.missing_text(one.missing)}" if one.missing else ""
                problems.append(f"a trial of {condition} ends with exit code {one.exit_code}{what}")
            if why := trials.excluded(study, one.measures, one.exit_code):
                problems.append(f"a trial of {condition} would be left out: {why}")
        print(f"  {'':24}{''.join(f'{condition:>12}' for condition in measured)}")
    found = planning.power(study, simulations=arguments.simulations)
    if found:
        print(f"\npower: share of {arguments.simulations} simulated studies with p < {study.alpha:g} [95 % interval]")
    for one in found:
        counts = "   ".join(f"{count}: {share:.2f}" for count, (share, _, _) in one.by_count.items())
        share, low, high = one.by_count[design.participants]
        print(f"  {one.outcome}, {one.test}: {share:.2f} [{low:.2f}, {high:.2f}]; by people {counts}; "
              f"without an effect {one.false_alarms[0]:.3f}")
        if high < planning.GOOD_POWER:
            enough = [count for count, each in one.by_count.items() if each[0] >= planning.GOOD_POWER]
            problems.append(f"too few people for {one.outcome}: power {share:.2f}, "
                            + (f"with {enough[0]} it is {one.by_count[enough[0]][0]:.2f}" if enough
                               else f"and not {planning.GOOD_POWER} with {max(one.by_count)} either"))
    notes += [f"power for {test.outcome} is not known: simulation.expected.{test.outcome} is missing"
              for test in study.tests if test.outcome not in {one.outcome for one in found}]
    for each in notes:
        print(f"\nnote: {each}")
    for each in problems:
        print(f"\nPROBLEM: {each}")
    print(f"\n{len(problems)} problems" if len(problems) != 1 else "\n1 problem")
    return 1 if problems else 0


def run(arguments):
    from hapticgiant.study import description, planning, simulation
    from hapticgiant.study.folder import Folder
    from hapticgiant.sweep.campaign import explained
    from hapticgiant.sweep.program import find_program
    from hapticgiant.sweep.reader import InputError

    if arguments.command == "forget":
        folder = Folder.as_it_was(arguments.study, arguments.out)
        count = folder.forget(arguments.code)
        for note in folder.notes:
            print(f"note: {note}")
        if folder.notes:
            print(f"{arguments.code}: {count} files deleted, and reports of before")
            return 0
        print(f"{arguments.code}: {count} files deleted, tables made anew; reports of before are deleted: "
              f"hapticgiant study report {arguments.study}")
        return 0
    if arguments.command == "new":
        return write_new(arguments.study)
    study = description.load_study(arguments.study)
    if arguments.command == "plan":
        return show_plan(study, arguments.participant)
    if arguments.command == "check":
        return check(study, arguments)
    if arguments.command == "preregistration":
        print(planning.preregistration(study, planning.power(study, [study.design.participants], arguments.simulations)),
              end="")
        return 0
    if arguments.command == "run":
        return serve(study, arguments)
    folder = Folder(study, arguments.out)
    if arguments.command == "report":
        from hapticgiant.study import report

        if any(test.test == "mixed" for test in study.tests) and missing(FOR_MIXED):
            raise InputError(f"test 'mixed': {sys.executable} needs statsmodels: pip install 'hapticgiant[study]'")
        for file in report.write(folder):
            print(f"  written    {file}")
        return 0
    played, before, faults = simulation.play(study, folder, find_program(), arguments.participants, arguments.jobs,
                                             arguments.keep_recordings)
    print(f"{played + before} trials of simulated people{f', {before} of them from before' if before else ''}"
          f"{f', {len(faults)} without a result' if faults else ''}")
    print(f"  folder     {folder.path}")
    for fault in faults[:5]:
        print(explained(fault, study), file=sys.stderr)
    return 1 if faults else 0


def main(words):
    arguments = parser().parse_args(words)
    needed = NEEDED | NEEDED_BY.get(arguments.command, {})
    if packages := missing(needed):
        print(f"study: {sys.executable} needs {', '.join(packages)}: pip install 'hapticgiant[study]'", file=sys.stderr)
        return 2
    from hapticgiant.command_line import INTERRUPTED, exit_code_of
    from hapticgiant.study.expressions import ExpressionError
    from hapticgiant.study.folder import FolderError
    from hapticgiant.study.markers import MarkerError
    from hapticgiant.study.trials import TrialError
    from hapticgiant.sweep.reader import InputError

    def interrupt(*_):
        raise KeyboardInterrupt

    signal.signal(signal.SIGTERM, interrupt)
    os.umask(os.umask(0o077) | 0o077)  # what people did is for this user alone
    try:
        return exit_code_of("study", lambda: run(arguments),
                            (InputError, FolderError, ExpressionError, TrialError, MarkerError))
    except KeyboardInterrupt:
        print("\nended; what has been played is kept, and the same command continues", file=sys.stderr)
        return INTERRUPTED


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
