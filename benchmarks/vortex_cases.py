"""Rotors and wakes whose cost is measured."""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
from functools import cache
from pathlib import Path

import numpy as np

from galerna import turbine as turbines
from galerna.aero.vortex.ages import revolution_ages
from galerna.aero.vortex.blades import blade_lattice
from galerna.aero.vortex.rotor_axis import RotorAxis
from galerna.aero.vortex.sheet import Sheet
from galerna.aero.vortex.surface import Surface
from galerna.aero.vortex.wake import helical_wake
from galerna.contract import Array
from galerna.turbine.geometry import blade_frames
from galerna.units import RPM

WIND = 11.4  # m/s, along the shaft
SPEED = 12.1 * RPM
AXIS = RotorAxis(np.zeros(3), np.array([1.0, 0.0, 0.0]), SPEED)


class Rotor:
    """The NREL 5 MW rotor without tilt and precone at 12.1 rpm in 11.4 m/s."""

    def __init__(self, chordwise: int, spanwise: int) -> None:
        turbine = turbines.load("nrel5mw")
        blade = blade_lattice(turbine, chordwise=chordwise, spanwise=spanwise)
        position, rotation = blade_frames(turbine.blade, blade.span)
        position = position + np.array([0.0, 0.0, turbine.hub.radius])
        self.corners = blade.place(position, rotation)
        self.blades = turbine.number_of_blades

    def surfaces(self, azimuth: float) -> list[Surface]:
        """The blades where the first stands at the azimuth, rad."""
        turns = azimuth + 2.0 * np.pi * np.arange(self.blades) / self.blades
        return [
            Surface.turning(self.corners @ rotation(turn).T, SPEED * AXIS.direction, AXIS.origin)
            for turn in turns
        ]


def rotation(azimuth: float) -> Array:
    """About the shaft."""
    c, s = np.cos(azimuth), np.sin(azimuth)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def helical_sheets(panels: int, spanwise: int = 20, core_radius: float = 0.3) -> list[Sheet]:
    """A rotor's wake of about so many panels in three sheets, uneven as one in turbulence is."""
    rows = round(panels / spanwise / 3)
    rng = np.random.default_rng(rows)
    angle, radius = np.meshgrid(
        np.radians(5.0) * np.arange(rows + 1), np.linspace(5.0, 63.0, spanwise + 1), indexing="ij"
    )
    sheets = []
    for turn in 2.0 * np.pi * np.arange(3) / 3:
        azimuth = angle + turn
        x = np.stack(
            [WIND / SPEED * angle, -radius * np.sin(azimuth), radius * np.cos(azimuth)], axis=-1
        )
        strength = 25.0 + rng.normal(scale=2.0, size=(rows, spanwise))
        sheets.append(Sheet(x + rng.normal(scale=0.1, size=x.shape), strength, core_radius))
    return sheets


@cache
def sharpy_seconds(chordwise: int, spanwise: int, revolutions: float, step_deg: float) -> dict:
    """CPU seconds of SHARPy's solutions of the same rotor, see ``sharpy_rotor``; {} without it.

    ``GALERNA_SHARPY`` names the Python interpreter that has SHARPy (PyPI ``ic-sharpy``).
    """
    interpreter = os.environ.get("GALERNA_SHARPY")
    if not interpreter:
        return {}
    surfaces = Rotor(chordwise, spanwise).surfaces(0.0)
    ages = revolution_ages(SPEED, revolutions, step_deg)
    edges = [s.lattice.corners[-1] for s in surfaces]
    wake = helical_wake(ages, edges, AXIS, np.array([WIND, 0.0, 0.0]))
    script = Path(__file__).with_name("sharpy_rotor.py")
    with tempfile.TemporaryDirectory() as folder:
        case = Path(folder) / "case.npz"
        corners = np.stack([s.lattice.corners for s in surfaces])
        np.savez(case, corners=corners, wake=np.stack(wake.vertices), speed=SPEED, wind=WIND,
                 dt=ages[1])  # fmt: skip
        command = [interpreter, str(script), str(case), str(os.cpu_count())]
        run = subprocess.run(command, capture_output=True, text=True, cwd=folder, check=False)
    if run.returncode:
        print(f"SHARPy did not run: {run.stderr.strip().splitlines()[-1:]}")
        return {}
    return json.loads(run.stdout.splitlines()[-1])
