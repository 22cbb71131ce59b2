"""HapticGiant: limits, solver, models and the control cycle, from Python.

SI units. Chains: p = gantry, m = manipulator, a = twin. Frames: B = base, H = handle. Arrays that
come out are read-only copies.
"""

from hapticgiant import haptic_giant, hqp, limits, model
from hapticgiant._core import (
    Bounds,
    ChangeStatus,
    CommandFrame,
    Cycle,
    CycleRecord,
    FaultCode,
    HandTarget,
    Law,
    LimitCause,
    LimitState,
    Mode,
    ModeRequest,
    OperatorFrame,
    Parameter,
    ParameterChange,
    Pose,
    Refusal,
    Scenario,
    SensorFrame,
    Session,
    SetupError,
    SimulatedDevice,
    SolverStatus,
    TareStatus,
    next_request,
)
from hapticgiant.recording import read_recording
from hapticgiant.scenario import MODELS, load_scenario, run

__all__ = [
    "MODELS",
    "Bounds",
    "ChangeStatus",
    "CommandFrame",
    "Cycle",
    "CycleRecord",
    "FaultCode",
    "HandTarget",
    "Law",
    "LimitCause",
    "LimitState",
    "Mode",
    "ModeRequest",
    "OperatorFrame",
    "Parameter",
    "ParameterChange",
    "Pose",
    "Refusal",
    "Scenario",
    "SensorFrame",
    "Session",
    "SetupError",
    "SimulatedDevice",
    "SolverStatus",
    "TareStatus",
    "haptic_giant",
    "hqp",
    "limits",
    "load_scenario",
    "model",
    "next_request",
    "read_recording",
    "run",
]
