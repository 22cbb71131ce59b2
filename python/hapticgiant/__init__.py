"""HapticGiant: limits, solver, models and the control cycle, from Python.

SI units. Chains: p = gantry, m = manipulator, a = twin. Frames: B = base, H = handle. Arrays that
come out are read-only copies.
"""

try:
    import numpy  # noqa: F401
except ModuleNotFoundError:
    raise ModuleNotFoundError("import hapticgiant needs numpy: pip install 'hapticgiant[arrays]'", name="numpy") from None

from hapticgiant import haptic_giant, hqp, limits, model
from hapticgiant._core import (
    Bounds,
    ChangeStatus,
    CommandFrame,
    Cycle,
    CycleRecord,
    FaultCode,
    Gantry,
    HandTarget,
    Law,
    LimitCause,
    LimitState,
    Mode,
    ModeRequest,
    OperatorFrame,
    Parameter,
    ParameterChange,
    Person,
    Pose,
    Refusal,
    Scenario,
    SensorFrame,
    Session,
    SetupError,
    SimulatedDevice,
    SolverStatus,
    Stop,
    TareStatus,
    TwinParameter,
    next_request,
    start_posture,
    twin_parameters,
)
from hapticgiant.play import Outcome, RunInterrupted, play
from hapticgiant.recording import Recording, read_recording
from hapticgiant.scenario import MODELS, load_scenario, run

__all__ = [
    "MODELS",
    "Bounds",
    "ChangeStatus",
    "CommandFrame",
    "Cycle",
    "CycleRecord",
    "FaultCode",
    "Gantry",
    "HandTarget",
    "Law",
    "LimitCause",
    "LimitState",
    "Mode",
    "ModeRequest",
    "OperatorFrame",
    "Outcome",
    "Parameter",
    "ParameterChange",
    "Person",
    "Pose",
    "Recording",
    "Refusal",
    "RunInterrupted",
    "Scenario",
    "SensorFrame",
    "Session",
    "SetupError",
    "SimulatedDevice",
    "SolverStatus",
    "Stop",
    "TareStatus",
    "TwinParameter",
    "haptic_giant",
    "hqp",
    "limits",
    "load_scenario",
    "model",
    "next_request",
    "play",
    "read_recording",
    "run",
    "start_posture",
    "twin_parameters",
]
