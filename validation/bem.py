"""Blade-element momentum theory: the rotors of the NREL 5 MW and the DTU 10 MW."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import cache

import numpy as np
from scipy.optimize import brentq
from xarray import Dataset

from galerna import turbine as turbines
from galerna.aero.bem.options import BemOptions
from galerna.aero.bem.steady import steady_rotor
from galerna.aero.sections import blade_sections
from galerna.contract import Array
from galerna.turbine.model import Turbine
from galerna.units import DEG, RPM

from .framework import Case, Check
from .minnema_pierce import corrected_loads
from .rotors import columns, like_the_avatar, straightened, table, turning

AERODYN = "OpenFAST v5.0.0, aerodyn_driver, BEM_Mod 2"
STEADY = "welib, NREL 5 MW steady table Rigid_ROSCO (OpenFAST)"
HAWCSTAB = "DTU 10 MW operational data (HAWCStab2)"
DISSERTATION = "dissertation 4.2.2, figures 4.22 and 4.24"

Loads = Callable[[Turbine, BemOptions, float, float, float], tuple[float, float]]

INTERIOR = (0.25, 0.90)  #: of the radius; the ends depend on the closure of high thrust
FORCE, INDUCTION, ANGLE, INTEGRAL = 0.01, 0.005, 0.1, 0.01
BELOW_RATED, PITCH, ABOVE_RATED = 0.015, 0.2, 0.02

#: AeroDyn's settings in the deck of the steady table
DECK = BemOptions(
    skewed_wake="pitt_peters",
    drag_in_axial_induction=False,
    drag_in_tangential_induction=False,
    angle_of_attack_point="aerodynamic_center",
)


#: HAWCStab2: axisymmetric, tip loss alone, the polynomial of Madsen et al.
HAWC_LIKE = BemOptions(
    quasi_steady=True, root_loss=False, tower_influence=False, high_thrust="madsen"
)


def openfast_spanwise() -> Iterator[Check]:
    """Spanwise loads of the straightened rotor at three wind speeds."""
    options = BemOptions(
        skewed_wake="none", angle_of_attack_point="aerodynamic_center", tower_influence=False
    )
    yield from _spanwise("clean", straightened(turbines.load("nrel5mw")), options, judged=True)


def openfast_full() -> Iterator[Check]:
    """The same rotor with tilt and cone; the other code's output is at one azimuth."""
    options = BemOptions(skewed_wake="none", tower_influence=False)
    yield from _spanwise("full", turbines.load("nrel5mw"), options, judged=False)


def _spanwise(
    geometry: str, turbine: Turbine, options: BemOptions, *, judged: bool
) -> Iterator[Check]:
    rows = [row for row in table("openfast_nrel5mw_bem.csv") if row["geometry"] == geometry]
    for wind in sorted({float(row["wind_speed_m_s"]) for row in rows}):
        of_wind = [row for row in rows if float(row["wind_speed_m_s"]) == wind]
        speed, pitch = float(of_wind[0]["rotor_speed_rpm"]), float(of_wind[0]["pitch_deg"])
        point = steady_rotor(turbine, wind, speed * RPM, pitch * DEG, options=options)
        yield from _compare_span(f"{wind:g} m/s", point, of_wind, judged)


def _compare_span(
    name: str, point: Dataset, rows: list[dict[str, str]], judged: bool
) -> Iterator[Check]:
    radius, *reference = columns(
        rows,
        "radius_m",
        "normal_force_n_m",
        "tangential_force_n_m",
        "axial_induction",
        "angle_of_attack_deg",
    )
    inside = (radius >= INTERIOR[0] * radius[-1]) & (radius <= INTERIOR[1] * radius[-1])
    ours = [point[key].values for key in ("normal_force", "tangential_force", "axial_induction")]
    ours.append(point["angle_of_attack"].values / DEG)
    quantities = (
        ("normal force, largest difference over its maximum", FORCE, ""),
        ("tangential force, largest difference over its maximum", FORCE, ""),
        ("axial induction, largest difference", INDUCTION, ""),
        ("angle of attack, largest difference", ANGLE, "deg"),
    )
    for k, (text, tolerance, unit) in enumerate(quantities):
        scale = np.abs(reference[k]).max() if k < 2 else 1.0
        largest = float(np.abs(ours[k] - reference[k])[inside].max() / scale)
        yield Check(f"{name}: {text}", largest, 0.0, AERODYN, tolerance if judged else None, unit)
    for text, arm, k, unit in (("thrust", 1.0, 0, "N"), ("torque", radius, 1, "N m")):
        value, wanted = (
            3.0 * np.trapezoid((arm * f)[inside], radius[inside]) for f in (ours[k], reference[k])
        )
        yield Check(
            f"{name}: {text} of the interior",
            float(value),
            float(wanted),
            AERODYN,
            INTEGRAL if judged else None,
            unit,
            relative=True,
        )


def nrel_steady_curve() -> Iterator[Check]:
    """Thrust and power below rated, pitch and thrust above, as the deck's AeroDyn has them."""
    yield from steady_curve(_deck_loads, judged=True)


def nrel_steady_curve_of_galerna() -> Iterator[Check]:
    """The same with galerna's own sections, whose steady limit is the polar."""
    yield from steady_curve(_mean_loads, judged=False)


def steady_curve(loads: Loads, *, judged: bool) -> Iterator[Check]:
    """The same by any way to a mean thrust and torque."""
    turbine = turbines.load("nrel5mw")
    below, pitch_error, above = (BELOW_RATED, PITCH, ABOVE_RATED) if judged else (None,) * 3
    for row in table("nrel5mw_steady.csv"):
        if row["table"] != "rigid_rosco":
            continue
        wind, speed, pitch, thrust, torque = _operation(row)
        power, at = torque * speed * RPM, f"{wind:g} m/s"
        if pitch < 0.1:
            ours = loads(turbine, DECK, wind, speed, pitch)
            yield Check(f"{at}: thrust", ours[0], thrust, STEADY, below, "N", relative=True)
            value = ours[1] * speed * RPM
            yield Check(f"{at}: power", value, power, STEADY, below, "W", relative=True)
        else:
            angle = _trimmed(loads, turbine, DECK, wind, speed, pitch, torque)
            yield Check(f"{at}: pitch at its power", angle, pitch, STEADY, pitch_error, "deg")
            value = loads(turbine, DECK, wind, speed, angle)[0]
            yield Check(f"{at}: thrust", value, thrust, STEADY, above, "N", relative=True)


def nrel_other_tables() -> Iterator[Check]:
    """Where the published tables of the same turbine disagree with each other; not judged."""
    rows = table("nrel5mw_steady.csv")
    reference = {row["wind_speed_m_s"]: row for row in rows if row["table"] == "rigid_rosco"}
    for row in rows:
        wind = row["wind_speed_m_s"]
        if row["table"] == "rigid_rosco" or wind not in ("8", "8.0", "11", "11.0", "18", "18.0"):
            continue
        base = reference[f"{float(wind):g}"]
        for key, unit in (("thrust_kn", "kN"), ("rotor_speed_rpm", "rpm"), ("pitch_deg", "deg")):
            quantity = f"{float(wind):g} m/s, table {row['table']}: {key.rsplit('_', 1)[0]}"
            yield Check(quantity, float(row[key]), float(base[key]), STEADY, None, unit)


def dtu_steady_curve() -> Iterator[Check]:
    """Power and thrust of the DTU 10 MW at its published speed and pitch."""
    built = _untilted(turbines.load("dtu10mw"))
    turbine = straightened(built)
    for row in table("dtu10mw_steady.csv"):
        wind, speed, pitch, rigid, power, thrust = (
            float(row[key])
            for key in (
                "wind_speed_m_s",
                "rotor_speed_rpm",
                "pitch_deg",
                "rigid_pitch_deg",
                "power_kw",
                "thrust_kn",
            )
        )
        at = f"{wind:g} m/s"
        if wind <= 11.0:
            ours = _mean_loads(turbine, HAWC_LIKE, wind, speed, pitch)
            value = ours[1] * speed * RPM / 1e3
            yield Check(f"{at}: power", value, power, HAWCSTAB, 0.03, "kW", relative=True)
            yield Check(f"{at}: thrust", ours[0] / 1e3, thrust, HAWCSTAB, 0.03, "kN", relative=True)
            thrust_built, torque_built = _mean_loads(built, HAWC_LIKE, wind, speed, pitch)
            for name, value, wanted, unit in (
                ("power", torque_built * speed * RPM / 1e3, power, "kW"),
                ("thrust", thrust_built / 1e3, thrust, "kN"),
            ):
                quantity = f"{at}, with cone and prebend: {name}"
                yield Check(quantity, value, wanted, HAWCSTAB, None, unit, relative=True)
        elif wind % 2.0 == 0.0 or wind == 25.0:
            torque = power * 1e3 / (speed * RPM)
            angle = _trimmed(_mean_loads, turbine, HAWC_LIKE, wind, speed, rigid, torque)
            yield Check(f"{at}: pitch at its power", angle, rigid, HAWCSTAB, 0.5, "deg")
            value = _mean_loads(turbine, HAWC_LIKE, wind, speed, angle)[0] / 1e3
            yield Check(f"{at}: thrust", value, thrust, HAWCSTAB, 0.04, "kN", relative=True)


def dtu_rotor_speeds() -> Iterator[Check]:
    """Power and thrust of the DTU 10 MW over the rotor speed at 8 m/s, by a later HAWCStab2."""
    turbine = _untilted(turbines.load("dtu10mw"))
    for row in table("dtu10mw_hawcstab2.csv"):
        wind, speed, power, thrust = (
            float(row[key])
            for key in ("wind_speed_m_s", "rotor_speed_rpm", "power_kw", "thrust_kn")
        )
        ours = _mean_loads(turbine, HAWC_LIKE, wind, speed, 0.0)
        at, value = f"{speed:.2f} rpm", ours[1] * speed * RPM / 1e3
        source = "HAWCStab2, lacbox test data"
        yield Check(f"{at}: power", value, power, source, 0.03, "kW", relative=True)
        yield Check(f"{at}: thrust", ours[0] / 1e3, thrust, source, 0.03, "kN", relative=True)


def yawed_rotor() -> Iterator[Check]:
    """Where a yawed rotor's blade is loaded most and least, with and without a skewed wake."""
    turbine, wind, speed, pitch = like_the_avatar()
    near = 30.0
    for skewed in ("none", "pitt_peters", "vortex_cylinder"):
        options = BemOptions(skewed_wake=skewed, tower_influence=False)
        turn = turning(turbine, options, wind, speed, pitch, yaw_deg=30.0, turns=8)
        outer, inner = (_over_turn(turn, x * turbine.rotor_radius) for x in (0.75, 0.45))
        most, least = (180.0, 0.0) if skewed == "none" else (270.0, 90.0)
        for text, place, wanted in (("largest", np.argmax, most), ("smallest", np.argmin, least)):
            azimuth = float(turn["azimuth_deg"][place(outer["normal_force"])])
            value = wanted + (azimuth - wanted + 180.0) % 360.0 - 180.0
            quantity = f"skewed wake {skewed}: azimuth of the {text} normal force at 0.75R"
            yield Check(quantity, value, wanted, DISSERTATION, near, "deg")
        azimuth = float(turn["azimuth_deg"][np.argmax(inner["angle_of_attack"])])
        value = (azimuth + 180.0) % 360.0 - 180.0
        quantity = f"skewed wake {skewed}: azimuth of the largest angle of attack at 0.45R"
        yield Check(quantity, value, 0.0, DISSERTATION, near, "deg")


def yaw_losses() -> Iterator[Check]:
    """Mean thrust and power lost at 30 deg of yaw error; the dissertation's rotor is another."""
    turbine, wind, speed, pitch = like_the_avatar()
    source = "dissertation table 4.4, AVATAR rotor, BEM skew"
    options = BemOptions(skewed_wake="pitt_peters", tower_influence=False)
    means = []
    for yaw in (0.0, 30.0):
        turn = turning(turbine, options, wind, speed, pitch, yaw_deg=yaw, turns=8)
        means.append([float(turn[key].mean()) for key in ("rotor_thrust", "rotor_power")])
    for k, (name, wanted) in enumerate((("thrust", -0.20), ("power", -0.35))):
        yield Check(f"change of {name}", means[1][k] / means[0][k] - 1.0, wanted, source)


def _untilted(turbine: Turbine) -> Turbine:
    return replace(turbine, nacelle=replace(turbine.nacelle, tilt=0.0))


def _over_turn(turn: dict[str, Array], radius: float) -> dict[str, Array]:
    """Blade 1 at one radius over the azimuth."""
    return {
        name: np.array([np.interp(radius, turn["radius"], row) for row in turn[name][:, 0]])
        for name in ("normal_force", "angle_of_attack")
    }


def _operation(row: dict[str, str]) -> tuple[float, float, float, float, float]:
    keys = ("wind_speed_m_s", "rotor_speed_rpm", "pitch_deg", "thrust_kn", "torque_knm")
    wind, speed, pitch, thrust, torque = (float(row[key]) for key in keys)
    return wind, speed, pitch, thrust * 1e3, torque * 1e3


@cache
def _mean_loads(
    turbine: Turbine, options: BemOptions, wind: float, speed: float, pitch: float
) -> tuple[float, float]:
    """Mean thrust N and torque N m over a turn."""
    turn = turning(turbine, options, wind, speed, pitch)
    return float(turn["rotor_thrust"].mean()), float(turn["rotor_torque"].mean())


@cache
def _deck_loads(
    turbine: Turbine, options: BemOptions, wind: float, speed: float, pitch: float
) -> tuple[float, float]:
    """The same with the steady section forces of AeroDyn's unsteady model."""
    turn = turning(turbine, options, wind, speed, pitch)
    thrust, torque = corrected_loads(blade_sections(turbine), turn, turn["radius"])
    return thrust * float(turn["rotor_thrust"].mean()), torque * float(turn["rotor_torque"].mean())


def _trimmed(
    loads: Loads,
    turbine: Turbine,
    options: BemOptions,
    wind: float,
    speed: float,
    near: float,
    torque: float,
) -> float:
    """The pitch in deg near ``near`` that gives a torque in N m."""

    def excess(pitch: float) -> float:
        return loads(turbine, options, wind, speed, pitch)[1] / torque - 1.0

    return float(brentq(excess, near - 3.0, near + 3.0, xtol=1e-3))


def _listed(checks: Iterator[Check]) -> Sequence[Check]:
    return tuple(checks)


CASES = (
    Case(
        "bem-openfast-spanwise",
        "rotor",
        "NREL 5 MW, straight rigid blades: spanwise loads against AeroDyn",
        lambda: _listed(openfast_spanwise()),
        2.0,
        "Between 25 and 90 % of the radius. Outside, the two codes close high thrust differently, "
        "and AeroDyn's first and last node sit on the hub and the tip.",
    ),
    Case(
        "bem-openfast-full",
        "rotor",
        "NREL 5 MW with tilt and cone: spanwise loads against AeroDyn",
        lambda: _listed(openfast_full()),
        2.0,
        "Shown, not judged: AeroDyn's figures are at one azimuth, galerna's are means over it.",
    ),
    Case(
        "bem-nrel5mw-steady",
        "rotor",
        "NREL 5 MW, steady operation from 5 to 25 m/s",
        lambda: _listed(nrel_steady_curve()),
        60.0,
        "The deck's settings: Pitt and Peters' skew, no drag in the induction, dynamic inflow, "
        "potential flow about the tower, angle of attack at the aerodynamic centre, and the "
        "steady section forces of its Beddoes-Leishman model (Minnema and Pierce), which lie "
        "below the polars. Below rated at the table's speed and pitch; above, the pitch is "
        "trimmed to the table's aerodynamic power. What remains in the thrust, where it fails "
        "too, is AeroDyn's node at the tip: with its load (bem-nrel5mw-steady-tip-node) the two "
        "agree within 0.1 % at every wind speed.",
    ),
    Case(
        "bem-nrel5mw-steady-polars",
        "rotor",
        "NREL 5 MW, steady operation, with the polars as published",
        lambda: _listed(nrel_steady_curve_of_galerna()),
        60.0,
        "Shown, not judged: galerna's own sections against the same table. What differs is the "
        "steady limit of the table's unsteady section model; see bem-nrel5mw-steady.",
    ),
    Case(
        "bem-nrel5mw-tables",
        "rotor",
        "NREL 5 MW: where its published steady tables disagree",
        lambda: _listed(nrel_other_tables()),
        0.1,
        "Reference and value are both of the literature: rigid or flexible structure, ROSCO or "
        "DISCON control, and an older table.",
    ),
    Case(
        "bem-dtu10mw-steady",
        "rotor",
        "DTU 10 MW, steady power and thrust",
        lambda: _listed(dtu_steady_curve()),
        40.0,
        "As in HAWCStab2: tip loss alone, the thrust polynomial of Madsen et al., quasi-steady. "
        "The table does not say whether cone, prebend and deformation are in it. A rigid rotor "
        "with straight blades agrees and is judged, above rated against the pitch published for "
        "just that rotor; a rigid one with cone and prebend does not, and is shown. That the "
        "table's rotor is straight, or straightened by its loads, is inferred. 3 % below rated; "
        "above, 0.5 deg of pitch at its power and 4 % of thrust, for polars blended by other "
        "rules.",
    ),
    Case(
        "bem-dtu10mw-rotor-speeds",
        "rotor",
        "DTU 10 MW at 8 m/s over the rotor speed",
        lambda: _listed(dtu_rotor_speeds()),
        2.0,
        "With cone and prebend; settings as in bem-dtu10mw-steady.",
    ),
    Case(
        "bem-yaw-azimuths",
        "rotor",
        "Yaw error 30 deg: where loads are largest and smallest",
        lambda: _listed(yawed_rotor()),
        10.0,
        "The DTU 10 MW stands in for the AVATAR rotor: straight, without tilt and cone, at its "
        "tip-speed ratio of 9.26, and pitched to its thrust coefficient of 0.66. "
        "Near means 30 deg of azimuth. The dissertation's own skewed wake misses the angle of "
        "attack at 0.45R.",
    ),
    Case(
        "bem-yaw-losses",
        "rotor",
        "Yaw error 30 deg: mean thrust and power",
        lambda: _listed(yaw_losses()),
        5.0,
        "Shown, not judged: the reference is another rotor, the AVATAR; the DTU 10 MW stands in "
        "for it as in bem-yaw-azimuths.",
    ),
)
