"""One solution of a rotor's vortex lattice in SHARPy, run by SHARPy's own interpreter.

``python sharpy_rotor.py CASE.npz CORES`` reads ``corners`` (b,m+1,n+1,3) m of the blades,
``wake`` (b,K+1,n+1,3) m, ``speed`` rad/s about the x axis, ``wind`` m/s along it and ``dt`` s. The
last line it prints is JSON: CPU seconds of the ``steady`` solution and of one evaluation with a
``prescribed`` and a ``free`` wake, and the mean ``circulation`` m2/s of the trailing edges.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
from sharpy.aero.utils import uvlmlib
from sharpy.solvers.staticuvlm import StaticUvlm
from sharpy.solvers.stepuvlm import StepUvlm
from sharpy.utils.datastructures import AeroTimeStepInfo

PRESCRIBED, FREE = 2, 3  # SHARPy's convection schemes


def flow(case: dict[str, np.ndarray]) -> AeroTimeStepInfo:
    """The blades and their wakes, turning in a uniform wind."""
    corners, wake = case["corners"], case["wake"]
    shapes = (np.array([np.array(x.shape[1:3]) - 1] * len(x)) for x in (corners, wake))
    step = AeroTimeStepInfo(*shapes)
    turn = np.array([float(case["speed"]), 0.0, 0.0])
    for blade in range(len(corners)):
        step.zeta[blade][:] = np.moveaxis(corners[blade], -1, 0)
        step.zeta_dot[blade][:] = np.moveaxis(np.cross(turn, corners[blade]), -1, 0)
        step.zeta_star[blade][:] = np.moveaxis(wake[blade], -1, 0)
        step.u_ext[blade][0] = step.u_ext_star[blade][0] = float(case["wind"])
    return step


def cpu_seconds(function: Callable[..., object], *arguments: object, **options: object) -> float:
    start = time.process_time()
    function(*arguments, **options)
    return time.process_time() - start


def main(path: str, cores: int) -> None:
    case = dict(np.load(path))
    step, dt = flow(case), float(case["dt"])
    steady = StaticUvlm.settings_default | {
        "num_cores": cores,
        "rho": 1.225,
        "rbm_vel_g": np.zeros(6),
        "centre_rot_g": np.zeros(3),
    }
    answer = {"steady": cpu_seconds(uvlmlib.vlm_solver, step, steady)}
    answer["circulation"] = float(np.mean([gamma[-1] for gamma in step.gamma]))
    frame = SimpleNamespace(for_vel=np.zeros(6), cga=lambda: np.eye(3))
    for name, scheme in (("prescribed", PRESCRIBED), ("free", FREE)):
        options = StepUvlm.settings_default | {
            "num_cores": cores, "rho": 1.225, "dt": dt, "convection_scheme": scheme,
            "centre_rot": np.zeros(3),
        }  # fmt: skip
        answer[name] = cpu_seconds(uvlmlib.uvlm_solver, 1, step.copy(), frame, options, dt=dt)
    print(json.dumps(answer))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
