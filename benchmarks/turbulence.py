"""Turbulence boxes: seconds and memory, beside the generators that install from PyPI.

Every generator runs in a process of its own with one thread, so the peak of its
memory, imports included, is its own, and its processor time is the wall time of a
machine that does nothing else.
"""

from __future__ import annotations

import math
import os
import subprocess
import sys
from collections.abc import Sequence

from .framework import Benchmark, Figure

#: The box of the dissertation's table 5.4, 8192 x 32 x 32, by each generator. A first call
#: on a small box takes the compilation and imports out of the time, where there are any.
MANN = {
    "galerna": """
from galerna.inflow.mann import mann_box
def make(shape, period):
    return mann_box(shape, spacing, length_scale=29.4, shear_parameter=3.9, alpha_epsilon=0.33,
                    mean_speed=18.0, hub_height=90.0, seed=7, lateral_period=period)
""",
    "hipersim": """
from hipersim.mann_turbulence import MannTurbulenceField
def make(shape, period):
    return MannTurbulenceField.generate(
        alphaepsilon=0.33, L=29.4, Gamma=3.9, Nxyz=shape, dxyz=spacing, seed=7,
        HighFreqComp=1, double_xyz=(False, period > 1, period > 1))
""",
    "mannrs": """
from mannrs import Stencil
def make(shape, period):
    (nx, ny, nz), (dx, dy, dz) = shape, spacing
    return Stencil(L=29.4, gamma=3.9, Lx=nx * dx, Ly=ny * dy, Lz=nz * dz, Nx=nx, Ny=ny, Nz=nz,
                   aperiodic_x=False, aperiodic_y=period > 1, aperiodic_z=period > 1,
                   ).build(parallel=False).turbulence(0.33, 7, parallel=False)
""",
}
#: VmHWM, not the peak that getrusage reports: that one is handed down by the parent process.
MEASURE = """
import re, time
spacing = (1.5381, 4.6875, 4.6875)
{make}
make((64, 8, 8), {period})
start = time.process_time()
box = make((8192, 32, 32), {period})
elapsed = time.process_time() - start
peak = re.search(r"VmHWM:\\s+(\\d+) kB", open("/proc/self/status").read())
print("measured", elapsed, int(peak[1]) * 1024 / 1e9)
"""
#: u, v and w by galerna, then u alone by Veers' Cholesky factors, from 20 of its frequencies.
KAIMAL = """
import time
import numpy as np
from galerna.inflow.kaimal import kaimal_box
from galerna.inflow.spectra import kaimal_coherence_decay
def make(planes):
    return kaimal_box((planes, 32, 32), (0.6, 4.6875, 4.6875), mean_speed=12.0, hub_height=90.0,
                      seed=1, turbulence_class="B")
make(64)
start = time.process_time()
make(12000)
elapsed = time.process_time() - start

side = np.arange(32) * 4.6875
points = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
distance = np.linalg.norm(points[:, None] - points[None], axis=2)
frequencies = np.arange(1, 6000) / 600.0
rng = np.random.default_rng(1)
start = time.process_time()
for rate in kaimal_coherence_decay(frequencies[::300], 12.0, 90.0):
    np.linalg.cholesky(np.exp(-rate * distance)) @ np.exp(2j * np.pi * rng.random(len(points)))
print("measured", elapsed, (time.process_time() - start) * len(frequencies) / 20)
"""
ONE_THREAD = {
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "NUMBA_NUM_THREADS": "1",
    "RAYON_NUM_THREADS": "1",
}


def alone(script: str) -> tuple[float, float] | None:
    """The two figures that a script prints in its own process; None where it cannot run."""
    run = subprocess.run(
        [sys.executable, "-c", script],
        capture_output=True,
        text=True,
        timeout=300,
        env=os.environ | ONE_THREAD,
        check=False,
    )
    for line in run.stdout.splitlines():
        if line.startswith("measured"):
            _, first, second = line.split()
            return float(first), float(second)
    if "ModuleNotFoundError" in run.stderr and "galerna" not in run.stderr.splitlines()[-1]:
        return None
    raise RuntimeError(run.stderr)


def mann() -> Sequence[Figure]:
    """The box of table 5.4, with opposite sides unlike (period 2, the default) and alike (1)."""
    figures = []
    for period in (2.0, 1.0):
        found = {
            name: alone(MEASURE.format(make=make, period=period)) for name, make in MANN.items()
        }
        elapsed, memory = found.pop("galerna") or (math.nan, math.nan)
        kind = f"8192 x 32 x 32 x 3, lateral period {period:g}"
        for peer, theirs in found.items():
            time, size = theirs or (None, None)
            figures += [
                Figure(f"processor time, {kind}", elapsed, "s", 10.0, peer=peer, peer_value=time),
                Figure(f"peak memory, {kind}", memory, "GB", 1.0, peer=peer, peer_value=size),
            ]
    return figures


def kaimal() -> Sequence[Figure]:
    """A box of 600 s at 0.05 s and 32 x 32 points, TurbSim's usual size."""
    elapsed, cholesky = alone(KAIMAL) or (math.nan, math.nan)
    return [
        Figure(
            "processor time, 12000 x 32 x 32 x 3",
            elapsed,
            "s",
            peer="Cholesky factors in NumPy, u alone, extrapolated from 20 of 5999 frequencies",
            peer_value=cholesky,
        )
    ]


BENCHMARKS = (
    Benchmark("mann-box", "rotor", "Mann box of the dissertation's table 5.4", mann),
    Benchmark("kaimal-box", "rotor", "Kaimal box with IEC coherence, ten minutes", kaimal),
)
