"""What commands the OC3 turbine in 5.3 of the dissertation: nothing, two sets of gains, ROSCO."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from galerna.contract import Array
from galerna.control.interface import Demands, Measurements
from galerna.control.torque import torque_curve
from galerna.turbine import load
from galerna.turbine.model import Turbine
from galerna.units import DEG

from .machine import rosco_input

TURBINE = "nrel5mw_oc3"
#: Table 5.1 of the dissertation: gains for the open sea of the redesign over the reference's
REDESIGN = (0.004849 / 0.006276, 0.0006927 / 0.0008965)
RAISED = (1.65, 1.65)  #: the same the other way, by as much as ``afloat_reasons`` finds
FACTORS = {"redesign": REDESIGN, "raised": RAISED}  #: on proportional and integral gain
NATURAL_FREQUENCY, DAMPING_RATIO = 0.20, 0.7  #: rad/s; NREL/TP-500-47535, section 6

#: What a case's ``control`` is, by name
Control = dict[str, Any]


class OpenLoop:
    """Holds the pitch it finds and the rated torque, whatever the speed is."""

    def __init__(self, turbine: Turbine) -> None:
        curve = torque_curve(turbine.control, turbine.drivetrain, "constant_torque")
        self._torque = curve.rated_torque
        self._pitch: Array | None = None

    def demands(self, measured: Measurements) -> Demands:
        """The first pitch, and the rated torque."""
        if self._pitch is None:
            self._pitch = measured.pitch.copy()
        return Demands(self._pitch, self._torque)


@contextmanager
def controller(name: str) -> Iterator[Control]:
    """The control block of a case; its files last as long as the context."""
    with TemporaryDirectory(prefix="galerna-") as folder:
        yield _block(name, Path(folder))


def _block(name: str, folder: Path) -> Control:
    if name == "open loop":
        return {"model": "python", "object": f"{__name__}:OpenLoop"}
    if name == "ROSCO on land":
        return {"model": "discon", "input_file": str(rosco_input())}
    if name == "ROSCO detuned":
        return {"model": "discon", "input_file": str(detuned_rosco(folder))}
    baseline: Control = {"model": "baseline", "above_rated": "constant_torque"}
    if name in FACTORS:
        baseline["gains"] = str(scaled_gains(folder, *FACTORS[name]))
    return baseline


def schedule() -> Array:
    """The detuned gains of NREL/TP-500-47535: rows (n,3) of pitch rad, proportional, integral."""
    rows = load(TURBINE).control.pitch_schedule
    assert rows is not None
    return rows


def scaled_gains(folder: Path, on_proportional: float, on_integral: float) -> Path:
    """A file of gains: the schedule of the reference times a factor on each."""
    pitch, proportional, integral = schedule().T
    turbine = load(TURBINE)
    content = {
        "galerna_gains": 1,
        "turbine": turbine.name,
        "above_rated": "constant_torque",
        "natural_frequency_rad_s": NATURAL_FREQUENCY,  # of the reference
        "damping_ratio": DAMPING_RATIO,
        "optimal_mode_gain_N_m_s2": turbine.control.optimal_mode_gain,
        "pitch_schedule": {
            "pitch_deg": (pitch / DEG).tolist(),
            "proportional_s": (on_proportional * proportional).tolist(),
            "integral": (on_integral * integral).tolist(),
        },
    }
    path = folder / "gains.yaml"
    path.write_text(json.dumps(content))
    return path


def detuned_rosco(folder: Path) -> Path:
    """ROSCO's input for land with the gains of NREL/TP-500-47535 and constant torque."""
    source = rosco_input()
    shutil.copytree(source.parent, folder, dirs_exist_ok=True)
    rows = schedule()
    zero = np.zeros(len(rows))
    values: dict[str, Array | float] = {
        "VS_ConstPower": 0,
        "PC_GS_n": len(rows),
        "PC_GS_angles": rows[:, 0],
        "PC_GS_KP": -rows[:, 1],
        "PC_GS_KI": -rows[:, 2],
        "PC_GS_KD": zero,
        "PC_GS_TF": zero,
    }
    path = folder / "DISCON_OC3.IN"
    path.write_text("".join(_with(line, values) for line in source.open()))
    return path


def _with(line: str, values: dict[str, Array | float]) -> str:
    """A line of ROSCO's input with the value that it is to have; others as they are."""
    _, mark, rest = line.partition("!")
    name = rest.split()[0] if rest.split() else ""
    if not mark or name not in values or line.startswith("!"):
        return line
    numbers = " ".join(f"{number:.8g}" for number in np.atleast_1d(values[name]))
    return f"{numbers} ! {name}\n"
