"""windIO v2 out: a Turbine as a windIO file, and beside it the companion for the rest."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from galerna.turbine.model import Airfoil, Array, Blade, Control, Polar, Tower, Turbine
from galerna.turbine.windio import elastic, floating_out
from galerna.turbine.windio.companion import PROPERTIES, companion_path
from galerna.turbine.windio.emit import to_yaml
from galerna.turbine.windio.schema import validate_document
from galerna.turbine.windio.yamlfile import Document
from galerna.units import DEG, RPM

_VERSION = "2.1"
_LARGEST_PITCH = 90.0  #: deg, that windIO allows; controllers round a quarter turn up


def write(turbine: Turbine, path: str | Path) -> None:
    """Write a turbine as a windIO v2 file and NAME.companion.yaml beside it.

    Section matrices are turned to the aerodynamic twist, as windIO wants them; a turbine
    that states no cut-out wind speed gets windIO's default.
    Raises InputError, and writes nothing, if windIO's schema cannot hold the turbine.
    """
    path = Path(path)
    document, companion = _document(turbine), _companion(turbine, path.parent)
    validate_document(Document(path, document))
    path.write_text(to_yaml(document), encoding="utf-8")
    companion_path(path).write_text(to_yaml(companion), encoding="utf-8")


def _document(turbine: Turbine) -> dict[str, Any]:
    return {
        "windIO_version": _VERSION,
        "name": turbine.name,
        "comments": turbine.description,
        "assembly": _assembly(turbine),
        "components": {
            "blade": _blade(turbine.blade, turbine.airfoils),
            "hub": _hub(turbine),
            "drivetrain": _drivetrain(turbine),
            "yaw": {"elastic_properties": _rigid_body(turbine.nacelle.yaw_bearing_mass)},
            "tower": _tower(turbine.tower),
        }
        | _floating(turbine),
        "airfoils": [_airfoil(airfoil) for airfoil in turbine.airfoils.values()],
        "control": _control(turbine.control, turbine.drivetrain.gear_ratio),
    }


def _floating(turbine: Turbine) -> dict[str, Any]:
    if turbine.platform is None:
        return {}
    return floating_out.components(turbine.platform, turbine.tower.axis[0])


def _assembly(turbine: Turbine) -> dict[str, Any]:
    control = turbine.control
    document: dict[str, Any] = {
        "drivetrain": "geared" if turbine.drivetrain.gear_ratio > 1.0 else "direct_drive",
        "rotor_orientation": "Upwind",
        "number_of_blades": turbine.number_of_blades,
        "rotor_diameter": 2.0 * turbine.rotor_radius,
        "hub_height": turbine.hub_height,
        "rated_power": control.rated_power,
        "cut_in_wind_speed": control.cut_in_wind_speed,
    }
    if np.isfinite(control.cut_out_wind_speed):
        document["cut_out_wind_speed"] = control.cut_out_wind_speed
    return document


def _curve(grid: Array, values: Array) -> dict[str, Any]:
    return {"grid": grid.tolist(), "values": values.tolist()}


def _axis(span: Array, axis: Array) -> dict[str, Any]:
    return {name: _curve(span, axis[:, i]) for i, name in enumerate("xyz")}


def _blade(blade: Blade, airfoils: dict[str, Airfoil]) -> dict[str, Any]:
    shape = blade.shape
    placed = [
        {
            "name": name,
            "spanwise_position": float(position),
            "configuration": [airfoils[name].polars[0].configuration],
            "weight": [1.0],
        }
        for position, name in zip(shape.airfoil_span, shape.airfoil_names, strict=True)
    ]
    document: dict[str, Any] = {
        "reference_axis": _axis(blade.axis_span, blade.axis),
        "outer_shape": {
            "chord": _curve(shape.span, shape.chord),
            "twist": _curve(shape.span, shape.twist / DEG),
            "rthick": _curve(shape.span, shape.relative_thickness),
            "section_offset_y": _curve(shape.span, shape.leading_edge_offset),
            "section_offset_x": _curve(shape.span, shape.normal_offset),
            "airfoils": placed,
        },
    }
    if blade.structure is not None:
        twist = np.interp(blade.structure.span, shape.span, shape.twist)
        sections = elastic.elastic_properties(blade.structure, twist)
        document["structure"] = {"anchors": [], "layers": [], "elastic_properties": sections}
    return document


def _airfoil(airfoil: Airfoil) -> dict[str, Any]:
    re_sets = [_polar(polar) for polar in airfoil.polars]
    if airfoil.unsteady.origin == "published":
        re_sets[-1] |= _unsteady(airfoil)
    document: dict[str, Any] = {
        "name": airfoil.name,
        "rthick": airfoil.relative_thickness,
        "aerodynamic_center": airfoil.aerodynamic_center,
        "polars": [{"configuration": airfoil.polars[0].configuration, "re_sets": re_sets}],
    }
    if airfoil.coordinates is not None:
        x, y = airfoil.coordinates.T
        document["coordinates"] = {"x": x.tolist(), "y": y.tolist()}
    return document


def _polar(polar: Polar) -> dict[str, Any]:
    angle = np.clip(polar.angle_of_attack / DEG, -180.0, 180.0)
    return {
        "re": polar.reynolds,
        "cl": _curve(angle, polar.lift),
        "cd": _curve(angle, polar.drag),
        "cm": _curve(angle, polar.moment),
    }


def _unsteady(airfoil: Airfoil) -> dict[str, float]:
    p = airfoil.unsteady
    return {
        "aoa0": p.zero_lift_angle / DEG,
        "aoa1": p.separation_angles[0] / DEG,
        "aoa2": p.separation_angles[1] / DEG,
        "c_nalpha": p.normal_force_slope,
        "cn1": p.critical_normal_force[0],
        "cn2": p.critical_normal_force[1],
        "cd0": p.zero_lift_drag,
        "cm0": p.zero_lift_moment,
        "T_p": p.pressure_lag,
        "T_f0": p.separation_lag,
        "T_V0": p.vortex_decay,
        "T_VL": p.vortex_travel,
        "A1": p.indicial_amplitudes[0],
        "A2": p.indicial_amplitudes[1],
        "b1": p.indicial_exponents[0],
        "b2": p.indicial_exponents[1],
        "St_sh": p.strouhal,
    }


def _rigid_body(
    mass: float,
    location: tuple[float, float, float] = (0.0, 0.0, 0.0),
    inertia: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> dict[str, Any]:
    return {"mass": mass, "inertia": [*inertia, 0.0, 0.0, 0.0], "location": list(location)}


def _hub(turbine: Turbine) -> dict[str, Any]:
    hub = turbine.hub
    body = _rigid_body(hub.mass, (hub.center_of_mass, 0.0, 0.0), (hub.inertia, 0.0, 0.0))
    return {
        "diameter": 2.0 * hub.radius,
        "cone_angle": hub.cone / DEG,
        "cd": 0.0,
        "elastic_properties": body,
    }


def _drivetrain(turbine: Turbine) -> dict[str, Any]:
    nacelle, drivetrain = turbine.nacelle, turbine.drivetrain
    x, y, z = nacelle.center_of_mass
    yaw_inertia = nacelle.yaw_inertia - nacelle.mass * (x * x + y * y)
    rated_rpm = turbine.control.rated_rotor_speed / RPM * drivetrain.gear_ratio
    return {
        "outer_shape": {
            "uptilt": nacelle.tilt / DEG,
            "distance_tt_hub": nacelle.shaft_height + nacelle.overhang * np.sin(nacelle.tilt),
            "overhang": nacelle.overhang * np.cos(nacelle.tilt),
        },
        "gearbox": {
            "gear_ratio": drivetrain.gear_ratio,
            "efficiency": drivetrain.gearbox_efficiency,
        },
        "generator": {
            "rpm_efficiency": {
                "grid": [0.0, rated_rpm],
                "values": [drivetrain.generator_efficiency] * 2,
            },
            "elastic_properties": _rigid_body(
                0.0, inertia=(drivetrain.generator_inertia, 0.0, 0.0)
            ),
        },
        "elastic_properties": _rigid_body(nacelle.mass, (x, y, z), (0.0, 0.0, yaw_inertia)),
    }


def _tower(tower: Tower) -> dict[str, Any]:
    document: dict[str, Any] = {
        "reference_axis": _axis(tower.axis_span, tower.axis),
        "outer_shape": {
            "outer_diameter": _curve(tower.axis_span, tower.diameter),
            "cd": _curve(tower.axis_span, tower.drag_coefficient),
        },
    }
    if tower.structure is not None:
        beam = elastic.elastic_properties(tower.structure, np.zeros_like(tower.structure.span))
        if tower.extra_masses:
            heights, masses = np.array(tower.extra_masses).T
            grid = np.interp(heights, tower.axis[:, 2], tower.axis_span)
            beam["point_mass"] = {"grid": grid.tolist(), "mass": masses.tolist()}
        document["structure"] = {"elastic_properties": beam}
    return document


def _control(control: Control, gear_ratio: float) -> dict[str, Any]:
    found = {
        "min_rotor_speed": control.minimum_rotor_speed / RPM,
        "rated_rotor_speed": control.rated_rotor_speed / RPM,
        "rated_power": control.rated_power,
        "max_gen_torque": control.maximum_torque,
        "max_torque_rate": control.maximum_torque_rate,
        "fine_pitch": control.fine_pitch / DEG,
        "optimal_tsr": control.optimal_tip_speed_ratio,
        "max_pitch_limit": min(control.maximum_pitch / DEG, _LARGEST_PITCH),
        "max_pitch_rate": control.maximum_pitch_rate / DEG,
        "lpf_frequency": control.speed_filter_frequency,
    }
    if control.optimal_mode_gain is not None:
        found["region2_k"] = control.optimal_mode_gain * (gear_ratio * RPM) ** 2
    document: dict[str, Any] = {
        key: value for key, value in found.items() if value is not None and np.isfinite(value)
    }
    if control.pitch_schedule is not None:
        pitch, proportional, integral = control.pitch_schedule.T
        to_rotor = gear_ratio * RPM / DEG
        angle = (pitch / DEG).tolist()
        document["pitch_kp"] = {"pitch_angle": angle, "kp": (proportional * to_rotor).tolist()}
        document["pitch_ki"] = {"pitch_angle": angle, "ki": (integral * to_rotor).tolist()}
    if control.minimum_pitch_table is not None:
        speed, pitch = control.minimum_pitch_table.T
        table = {"wind_speed": speed.tolist(), "min_pitch": (pitch / DEG).tolist()}
        document["min_pitch_table"] = table
    return document


def _companion(turbine: Turbine, folder: Path) -> dict[str, Any]:
    parts = {
        "blade": turbine.blade.structure,
        "tower": turbine.tower.structure,
        "hub": turbine.hub,
        "nacelle": turbine.nacelle,
        "drivetrain": turbine.drivetrain,
        "control": turbine.control,
        "platform": turbine.platform,
    }
    document: dict[str, Any] = {"sources": turbine.sources}
    if turbine.published:
        document["published"] = [asdict(published) for published in turbine.published]
    for name, part in parts.items():
        values = {key: getattr(part, key, None) for key in PROPERTIES[name]}
        given = {key: value for key, value in values.items() if value is not None}
        given.pop("additional_damping", None)  # a matrix, that floating_out turns into a row
        if any(np.any(value) for value in given.values()):
            document[name] = given
    if turbine.platform is not None:
        beside = floating_out.companion(turbine.platform, folder)
        document["platform"] |= beside.pop("platform")
        document |= beside
    return document
