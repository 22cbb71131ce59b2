"""User studies: planned, checked, simulated and reported from a study.yaml (docs/start/user_studies.md).

    from hapticgiant import study

    described = study.load_study("study.yaml")
    for participant in study.plan(described):
        print(participant.code, participant.conditions)
"""

from hapticgiant.study.description import Study, load_study
from hapticgiant.study.planning import plan, steps
from hapticgiant.sweep.reader import InputError

__all__ = ["Study", "InputError", "load_study", "plan", "steps"]
