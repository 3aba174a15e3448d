"""Blade-element momentum: a performance surface, and an unsteady rotor with every correction."""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from statistics import median

import numpy as np

from galerna import turbine as turbines
from galerna.aero.bem.model import BladeElementMomentum
from galerna.aero.bem.options import BemOptions
from galerna.aero.bem.steady import UniformWind
from galerna.aero.bem.surface import performance_surface
from galerna.kinematics import PrescribedMotion, PrescribedOperation
from galerna.signals import Signal
from galerna.simulation import Simulation
from galerna.turbine.model import Turbine
from galerna.units import DEG, RPM

from .framework import Benchmark, Figure

RATIOS, PITCHES = np.linspace(3.0, 12.0, 100), np.linspace(-5.0, 20.0, 100) * DEG
PEER_RATIOS, PEER_PITCHES = RATIOS[::25], PITCHES[::25]
TIME_STEP, DURATION, REPEATS = 0.02, 60.0, 3


def surface() -> Sequence[Figure]:
    """Seconds for 100 x 100 points of the NREL 5 MW on one core, after the compilation."""
    turbine = turbines.load("nrel5mw")
    performance_surface(turbine, RATIOS[:2], PITCHES[:2])
    seconds = median(
        _timed(lambda: performance_surface(turbine, RATIOS, PITCHES)) for _ in range(3)
    )
    peer = _ccblade_point(turbine)
    whole = None if peer is None else peer * len(RATIOS) * len(PITCHES)
    return (Figure("surface of 100 x 100 points", seconds, "s", 1.0, False, "CCBlade", whole),)


def unsteady() -> Sequence[Figure]:
    """Real-time factor of the rigid rotor with every correction, through the time loop."""
    turbine = turbines.load("nrel5mw")
    options = BemOptions(spanwise_filter="loads", rotational_augmentation="snel")
    model = BladeElementMomentum(turbine, UniformWind(np.array([12.0, 1.0, 0.5])), options=options)
    operation = PrescribedOperation(
        Signal.constant(12.1 * RPM), tuple(Signal.constant(3.8 * DEG) for _ in range(3))
    )
    structure = PrescribedMotion(turbine, operation, [model.stations])
    simulation = Simulation(structure, {"rotor": model}, TIME_STEP)
    simulation.run(1.0)
    simulation.record()
    factors = []
    for repeat in range(REPEATS):
        end = 1.0 + DURATION * (repeat + 1)
        seconds = _timed(lambda end=end: _march(simulation, end))
        factors.append(DURATION / seconds)
    figure = Figure(
        "real-time factor, 3 x 19 strips, 0.02 s step", median(factors), "x", 200.0, True
    )
    return (figure,)


def _march(simulation: Simulation, end: float) -> None:
    """Step and record, as a run does with an output at every step."""
    while simulation.time < end - 0.5 * TIME_STEP:
        simulation.advance()
        simulation.record()


def _timed(work: object) -> float:
    """Processor seconds of a call: those of a machine that does nothing else."""
    start = time.process_time()
    work()  # type: ignore[operator]
    return time.process_time() - start


def _ccblade_point(turbine: Turbine) -> float | None:
    """Seconds a point of CCBlade (WISDEM) takes on the same rotor; None where not installed."""
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    try:
        from wisdem.ccblade.ccblade import CCAirfoil, CCBlade
    except ImportError:
        return None
    shape = turbine.blade.shape
    radius = turbine.hub.radius + shape.span * turbine.blade.length
    inside = slice(1, -1)  # CCBlade wants its stations off the hub and the tip
    airfoils = [
        CCAirfoil(
            p.angle_of_attack / DEG,
            [p.reynolds],
            p.lift[:, None],
            p.drag[:, None],
            p.moment[:, None],
        )
        for p in (turbine.airfoils[name].polars[0] for name in shape.airfoil_names[inside])
    ]
    rotor = CCBlade(
        radius[inside],
        shape.chord[inside],
        shape.twist[inside] / DEG,
        airfoils,
        turbine.hub.radius,
        turbine.rotor_radius,
        turbine.number_of_blades,
        1.225,
        1.8e-5,
        nSector=1,
    )
    ratio, pitch = np.meshgrid(PEER_RATIOS, PEER_PITCHES)
    speed = ratio.ravel() * 10.0 / turbine.rotor_radius / RPM
    wind, angle = np.full(speed.size, 10.0), pitch.ravel() / DEG
    seconds = _timed(lambda: rotor.evaluate(wind, speed, angle, coefficients=True))
    return seconds / speed.size


BENCHMARKS = (
    Benchmark("bem_surface", "rotor", "Performance surface of the NREL 5 MW", surface),
    Benchmark("bem_unsteady", "rotor", "Unsteady rigid NREL 5 MW, every correction", unsteady),
)
