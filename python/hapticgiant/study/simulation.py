"""A study with simulated people: every trial is really played, forms are answered by a model."""

from __future__ import annotations

import shlex

from hapticgiant.study import expressions, people, trials
from hapticgiant.study.description import Study
from hapticgiant.study.folder import RUNNING, Folder
from hapticgiant.study.planning import Step, plan, steps
from hapticgiant.sweep import engines
from hapticgiant.sweep.program import Program
from hapticgiant.sweep.progress import Progress

TRIES = 3  # of a trial that somebody has ended


def play(study: Study, folder: Folder, program: Program, count: int | None, jobs: int | None,
         keeps_recordings: bool) -> tuple[int, int, list[str]]:
    """Plays what the folder does not have; how many trials were played, were there, and faults."""
    trials.require_columns(study, trials.known_columns(program))
    folder.begin(program.version, True, people.MODEL)
    gone = folder.withdrawn()
    wanted, before = {}, 0
    for participant in plan(study, count):
        if participant.code in gone:
            continue
        every = [each for each in steps(study, participant) if each.kind == "trial"]
        for position, step in enumerate(every, 1):
            if folder.file_of(participant.code, step).exists():
                before += 1
            else:
                wanted[len(wanted)] = participant.code, step, position
    commands = {}
    for number, (code, step, _) in wanted.items():
        commands[number] = trials.command(study, program, step.condition, people.hand_of(study, code, step.condition),
                                          _seed(study, code, step), _work(folder, number))
    faults, played = [], 0
    progress, engine = Progress("trials", len(commands)), engines.Local(jobs)
    try:
        for last in [False] * (TRIES - 1) + [True]:
            ended = {}
            for number, outcome in engine.play(commands):
                if outcome.was_ended() and not last:
                    trials.discard(_work(folder, number))
                    ended[number] = commands[number]
                    continue
                progress.step()
                code, step, position = wanted[number]
                try:
                    measured = trials.measure(study, outcome)
                    _keep(study, folder, program, code, step, position, measured, keeps_recordings)
                    played += 1
                except (trials.TrialError, expressions.ExpressionError) as error:
                    faults.append(f"{code} {step.condition} {step.repetition}: {error}")
                finally:
                    trials.discard(_work(folder, number))
            commands = ended
            if not commands:
                break
    finally:
        progress.end()
        trials.discard(folder.path / RUNNING)
    for participant in plan(study, count):
        for step in steps(study, participant):
            if step.kind == "form" and participant.code not in gone:
                _answer(study, folder, participant.code, step)
    folder.tabulate()
    return played, before, faults


def _seed(study, code, step):
    return people.seed_of(study, code, step.condition, step.repetition)


def _work(folder, number):
    return folder.path / RUNNING / str(number)


def _keep(study, folder: Folder, program, code, step: Step, position, measured: trials.Measured, keeps):
    stem = folder.stem(code, step)
    recording = None
    if keeps:
        recording = stem.with_name(stem.name + "_recording.mcap")
        recording.parent.mkdir(parents=True, exist_ok=True)
        measured.recording.replace(recording)  # of a crash before the next line: replaced, the same bits of state
    hand = people.hand_of(study, code, step.condition)
    seed = _seed(study, code, step)
    folder.write(folder.file_of(code, step), trials.dump({
        "participant": code, "condition": step.condition, "repetition": step.repetition, "position": position,
        "simulated": True, **measured.facts(), "recording": recording.name if recording else None, "hand": hand, "seed": seed,
        "command": "hapticgiant " + shlex.join(trials.shown_command(study, program, step.condition, hand, seed)[1:])}))


def _answer(study, folder, code, step):
    file = folder.file_of(code, step)
    if file.exists():
        return
    answers, pairs = people.answers_of(study, code, step.form, step.condition)
    folder.write(file, trials.dump({"participant": code, "condition": step.condition, "form": step.form,
                                    "simulated": True, "answers": answers, "pairs": pairs}))


def try_conditions(study: Study, program: Program, work) -> dict[str, trials.Measured]:
    """One trial of each condition by the first simulated person. Raises TrialError, ExpressionError."""
    conditions = dict(enumerate(study.conditions))
    commands = {i: trials.command(study, program, name, people.hand_of(study, "P01", name), 1, work / name)
                for i, name in conditions.items()}
    found = {}
    for i, outcome in engines.Local().play(commands):
        found[conditions[i]] = trials.measure(study, outcome)
    return {name: found[name] for name in study.conditions}
