"""A windIO v2 document small enough to read at a glance; every test gets a copy of its own."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from galerna.turbine.windio.emit import to_yaml


def curve(*values: float) -> dict[str, list[float]]:
    """Values over equal steps from 0 to 1."""
    return {"grid": [i / (len(values) - 1) for i in range(len(values))], "values": list(values)}


def polar(slope: float = 0.1, reynolds: float = 1e6) -> dict[str, Any]:
    """A section that lifts over +-10 deg and drags everywhere."""
    grid = [-180.0, -90.0, -10.0, 10.0, 90.0, 180.0]
    lift = [0.0, 0.0, -10.0 * slope, 10.0 * slope, 0.0, 0.0]
    return {
        "re": reynolds,
        "cl": {"grid": grid, "values": lift},
        "cd": {"grid": grid, "values": [0.01, 1.5, 0.01, 0.01, 1.5, 0.01]},
        "cm": {"grid": [-180.0, 180.0], "values": [-0.1, -0.1]},
    }


def beam(edge: float = 4e9, flap: float = 1e9) -> dict[str, Any]:
    """Two equal sections: bending about x edgewise, the mass centre 0.2 m behind the axis."""
    stiffness = {"K11": 1e8, "K22": 1e8, "K33": 1e9, "K44": edge, "K55": flap, "K66": 1e8}
    inertia = {"mass": 100.0, "cm_x": 0.0, "cm_y": 0.2, "i_edge": 40.0, "i_flap": 10.0}
    return {
        "stiffness_matrix": {"grid": [0.0, 1.0]} | {k: [v, v] for k, v in stiffness.items()},
        "inertia_matrix": {"grid": [0.0, 1.0]} | {k: [v, v] for k, v in inertia.items()},
        "structural_damping": {"mu": [0.0] * 6},
    }


def document() -> dict[str, Any]:
    straight = {"x": curve(0.0, 0.0), "y": curve(0.0, 0.0)}
    massless = {"mass": 0.0, "location": [0.0] * 3, "inertia": [0.0] * 6}
    return {
        "windIO_version": "2.1",
        "name": "small",
        "assembly": {"number_of_blades": 3, "hub_height": 32.0, "rated_power": 1e5},
        "components": {
            "blade": {
                "reference_axis": straight | {"z": curve(0.0, 10.0)},
                "outer_shape": {
                    "chord": curve(1.0, 0.8, 0.5),
                    "twist": curve(10.0, 0.0),
                    "rthick": curve(1.0, 0.2),
                    "section_offset_y": curve(0.5, 0.2),
                    "airfoils": [
                        {"name": "round", "spanwise_position": 0.0},
                        {"name": "thin", "spanwise_position": 1.0},
                    ],
                },
                "structure": {"anchors": [], "layers": [], "elastic_properties": beam()},
            },
            "hub": {"diameter": 2.0, "cone_angle": 3.0, "cd": 0.5, "elastic_properties": massless},
            "drivetrain": {
                "outer_shape": {"uptilt": 5.0, "distance_tt_hub": 2.0, "overhang": 3.0},
                "gearbox": {"gear_ratio": 50.0},
                "generator": {"rpm_efficiency": {"grid": [1500.0], "values": [0.9]}},
                "elastic_properties": massless,
            },
            "tower": {
                "reference_axis": straight | {"z": curve(0.0, 30.0)},
                "outer_shape": {"outer_diameter": curve(3.0, 2.0), "cd": curve(0.6, 0.6)},
                "structure": {"elastic_properties": beam(1e9, 1e9)},
            },
        },
        "airfoils": [
            {"name": "round", "rthick": 1.0, "polars": [{"re_sets": [polar(slope=0.0)]}]},
            {"name": "thin", "rthick": 0.2, "polars": [{"re_sets": [polar()]}]},
        ],
        "control": {"rated_rotor_speed": 30.0, "max_pitch_rate": 8.0, "region2_k": 100.0},
    }


def write(folder: Path, data: dict[str, Any]) -> Path:
    path = folder / "small.yaml"
    path.write_text(to_yaml(data), encoding="utf-8")
    return path
