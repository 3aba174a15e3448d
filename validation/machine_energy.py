"""The account of energy of the flexible NREL 5 MW in turbulence: does the wind's work add up."""

from __future__ import annotations

from functools import cache
from typing import Any

from galerna.case import load
from galerna.machine import build_machine

from .framework import Case, Check

DURATION = 30.0  #: s
SOURCE = "conservation of energy; every share is computed on its own (coupling/energy.py)"
CLOSING = 1e-3  #: of the wind's work


@cache
def account(time_step: float, rho_inf: float = 0.9, base: bool = False) -> dict[str, float]:
    """The energies J after DURATION s in the same wind, whatever the step.

    With ``base`` the tower's foot pitches by 3 deg at 0.1 Hz.
    """
    case: dict[str, Any] = {
        "galerna": 1,
        "turbine": "nrel5mw",
        "duration_s": DURATION,
        "time_step_s": time_step,
        "inflow": {
            "wind_speed_m_s": 12.0,
            "shear": {"kind": "power_law", "exponent": 0.14},
            "turbulence": {"kind": "mann", "turbulence_class": "B"},
        },
        "structure": {"rho_inf": rho_inf},
        "control": "baseline",
        "outputs": {"energy": True},
    }
    if base:
        swing = {"amplitude": 3.0, "frequency_hz": 0.1, "ramp_s": 5.0}
        case["base_motion"] = {"pitch_deg": swing}
    simulation = build_machine(load(case)).simulation
    for _ in range(round(DURATION / time_step)):
        simulation.advance()
    record = simulation.record()
    names = [channel.name for channel in simulation.channels]
    return {name: float(record[name]) for name in names if name.startswith("energy_")}


def energy() -> list[Check]:
    usual, coarse = account(0.02), account(0.04)
    work = usual["energy_wind"]
    shares = [
        Check(f"{name} over the wind's work", 100.0 * usual[f"energy_{name}"] / work, 0.0,
              SOURCE, unit="%")
        for name in ("electrical", "losses", "damping", "numerical", "kinetic", "elastic",
                     "potential", "pitch_drives")
    ]  # fmt: skip
    moved = account(0.02, base=True)
    ratio = abs(coarse["energy_defect"] / usual["energy_defect"])
    return [
        *shares,
        Check("what does not add up, over the wind's work", 100.0 * usual["energy_defect"] / work,
              0.0, SOURCE, 100.0 * CLOSING, "%"),
        Check("the same at twice the step", 100.0 * coarse["energy_defect"] / work, 0.0, SOURCE,
              100.0 * CLOSING, "%"),
        Check("what does not add up on a foot that pitches by 3 deg",
              100.0 * moved["energy_defect"] / moved["energy_wind"], 0.0, SOURCE,
              100.0 * CLOSING, "%"),
        Check("work of what moves that foot over the wind's",
              100.0 * moved["energy_base_motion"] / moved["energy_wind"], 0.0, SOURCE, unit="%"),
        Check("defect at 0.04 s over that at 0.02 s", ratio, 4.0,
              "an error of second order in the step", 1.0),
        Check("numerical dissipation at rho_inf 0.5 over that at 0.9",
              account(0.02, 0.5)["energy_numerical"] / usual["energy_numerical"], 1.0,
              "more for a smaller spectral radius"),
    ]  # fmt: skip


CASES = (
    Case(
        name="energy-of-the-machine",
        group="machine",
        title="Energy: the wind's work against grid, losses, damping, dissipation and storage",
        run=energy,
        seconds=60.0,
        story="Flexible NREL 5 MW with its controller in Mann turbulence at 12 m/s, 30 s. Work is "
        "that of the mean of a force at both ends of a step along the increment of the scheme. "
        "The numerical dissipation is the scheme's own, from its auxiliary accelerations, not "
        "what remains; what remains is the error of taking forces that turn by their means, and "
        "falls with the square of the step.",
    ),
)
