"""Make `dtu10mw.yaml` (windIO 2) from the published HAWC2 model of the DTU 10 MW turbine.

    python tools/dtu10mw_from_hawc2.py HAWC2_FOLDER SURFACE.xyz OUTPUT.yaml

HAWC2_FOLDER holds DTU_10MW_RWT.htc and data/*.dat; SURFACE.xyz is the blade
surface DTU_10MW_RWT_blade3D_prebend.xyz (PLOT3D, binary). Both are published with
Bak et al., Description of the DTU 10 MW Reference Wind Turbine, DTU Wind Energy
Report-I-0092, 2013.

HAWC2 describes a blade about its half-chord line c2, x towards the leading edge and
y towards the suction side. galerna's reference axis is the prebent pitch axis, x
towards the suction side and y towards the trailing edge. With the half-chord line at
(x, y) in root axes and the section turned by theta about z, the distance from the
pitch axis back to the half chord is d = -x / cos(theta), and the prebend is
y + d sin(theta). A point (x, y) of a HAWC2 section is at (y, d - x) here, and
HAWC2's x axis stands at -90 degrees from ours.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

import numpy as np
from ruamel.yaml import YAML
from scipy.interpolate import PchipInterpolator

from galerna.turbine.cross_section import at_reference, inertia_matrix, stiffness_matrix

ST_COLUMNS = (
    *("r", "m", "x_cg", "y_cg", "ri_x", "ri_y", "x_sh", "y_sh", "E", "G"),
    *("I_x", "I_y", "I_p", "k_x", "k_y", "A", "pitch", "x_e", "y_e"),
)
GEAR_RATIO = 50.0
POINTS_A_SIDE = 60
TRAILING_EDGE_FACE = 8  # points of the surface mesh from the middle of the blunt edge to a corner
UPPER = [(i, j) for i in range(6) for j in range(i, 6)]


def read_st(path: Path) -> dict[str, np.ndarray]:
    """First sub-set of a HAWC2 structural file by column name."""
    block = path.read_text(errors="replace").split("$1", 1)[1].split("$2", 1)[0]
    rows = [line.split() for line in block.splitlines()[1:] if re.match(r"\s*\d", line)]
    return dict(zip(ST_COLUMNS, np.array(rows, dtype=float).T, strict=True))


def read_c2(htc: str, body: str) -> np.ndarray:
    """Half-chord line (n,4): x, y, z m and twist deg of a main body."""
    block = re.search(rf"name\s+{body}\s.*?begin c2_def(.*?)end c2_def", htc, re.S)
    assert block is not None, body
    return np.array(
        re.findall(r"(?m)^\s*sec\s+\d+\s+(\S+)\s+(\S+)\s+(\S+)\s+(\S+)", block[1]), float
    )


def read_ae(path: Path) -> np.ndarray:
    """Planform (n,3): radius m, chord m and relative thickness %."""
    rows = [line.split()[:3] for line in path.read_text().splitlines()[2:] if line.strip()]
    return np.array(rows, float)


def read_pc(path: Path) -> list[tuple[float, str, np.ndarray]]:
    """Polars by rising relative thickness: thickness %, title, (n,4) alpha deg, cl, cd, cm."""
    lines = path.read_text(errors="replace").splitlines()[2:]
    polars = []
    while lines:
        _, count, thickness, *title = lines[0].split()
        table = np.array([line.split() for line in lines[1 : int(count) + 1]], float)
        polars.append((float(thickness), " ".join(title), table))
        lines = [line for line in lines[int(count) + 1 :] if line.strip()]
    return polars


def read_surface(path: Path) -> np.ndarray:
    """Blade surface (span, around, 3) m of a one-block unformatted PLOT3D file."""
    raw = path.read_bytes()
    around, span, _ = np.frombuffer(raw, "<i4", 3, 16)
    points = np.frombuffer(raw, "<f8", 3 * around * span, 36)
    return np.moveaxis(points.reshape(3, span, around), 0, -1)


def section_shape(points: np.ndarray) -> np.ndarray:
    """A closed section (n,3) as (2 k - 1, 2) x/c, y/c: trailing edge, suction side, nose, back."""
    points = points[TRAILING_EDGE_FACE:-TRAILING_EDGE_FACE]
    edge = 0.5 * (points[0] + points[-1])
    nose = np.argmax(np.linalg.norm(points - edge, axis=1))
    chord = edge - points[nose]
    along = chord / np.linalg.norm(chord)
    normal = np.linalg.svd(points - points.mean(axis=0))[2][2]
    up = np.cross(along, normal)
    up *= np.sign(up[1])
    flat = (points - points[nose]) @ np.stack([along, up], axis=1) / np.linalg.norm(chord)
    x = 0.5 * (1 + np.cos(np.linspace(0, np.pi, POINTS_A_SIDE)))
    lower = np.interp(x, flat[: nose + 1, 0][::-1], flat[: nose + 1, 1][::-1])
    upper = np.interp(x, flat[nose:, 0], flat[nose:, 1])
    return np.stack(
        [np.concatenate([x, x[-2::-1]]), np.concatenate([upper, lower[-2::-1]])], axis=1
    )


def thickness_of(shape: np.ndarray) -> float:
    return float((shape[:POINTS_A_SIDE, 1] - shape[: POINTS_A_SIDE - 2 : -1, 1]).max())


def shape_at_thickness(surface: np.ndarray, thickness: float) -> np.ndarray:
    """The section of the blade with a relative thickness, between its neighbours along the span."""
    shapes = np.array([section_shape(row) for row in surface[20:180]])
    found = np.array([thickness_of(shape) for shape in shapes])
    if found.min() >= thickness:
        return shapes[np.argmin(found)]
    k = int(np.argmax(found < thickness))
    weight = (found[k - 1] - thickness) / (found[k - 1] - found[k])
    return (1 - weight) * shapes[k - 1] + weight * shapes[k]


def circle() -> np.ndarray:
    angle = np.linspace(0, 2 * np.pi, 2 * POINTS_A_SIDE - 1)
    return np.stack([0.5 * (1 + np.cos(angle)), 0.5 * np.sin(angle)], axis=1)


def arc(points: np.ndarray) -> np.ndarray:
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])


def pitch_axis(c2: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Axis (n,3) m in galerna's root axes, its fractions (n,), half chord behind it (n,) m."""
    twist = np.radians(c2[:, 3])
    behind = -c2[:, 0] / np.cos(twist)
    prebend = c2[:, 1] + behind * np.sin(twist)
    axis = np.stack([prebend, np.zeros(len(c2)), c2[:, 2]], axis=1)
    axis -= axis[0]
    length = arc(axis)
    return axis, length / length[-1], behind


def section_matrices(
    st: dict[str, np.ndarray], behind: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness and inertia (n,6,6) at the pitch axis in galerna's section axes.

    HAWC2's radii of inertia are about the elastic centre and, like the shear factors,
    in the principal bending axes (HAWC2 manual, main body structure).
    """

    def here(x: str, y: str) -> np.ndarray:
        return np.stack([st[y], behind - st[x]], axis=1)

    elastic, shear, mass = here("x_e", "y_e"), here("x_sh", "y_sh"), here("x_cg", "y_cg")
    angle = np.radians(st["pitch"]) - np.pi / 2
    stiffness = stiffness_matrix(
        st["E"] * st["A"],
        (st["E"] * st["I_x"], st["E"] * st["I_y"]),
        (st["k_x"] * st["G"] * st["A"], st["k_y"] * st["G"] * st["A"]),
        st["G"] * st["I_p"],
        elastic,
        shear,
        angle,
    )
    c, s = np.cos(angle), np.sin(angle)
    offset = mass - elastic
    turned = np.stack(
        [c * offset[:, 0] + s * offset[:, 1], c * offset[:, 1] - s * offset[:, 0]], axis=1
    )
    moments = st["m"][:, None] * np.stack([st["ri_x"], st["ri_y"]], axis=1) ** 2
    inertia = at_reference(inertia_matrix(st["m"], turned, moments), elastic, angle)
    return stiffness, inertia


def beam(
    grid: np.ndarray, stiffness: np.ndarray, inertia: np.ndarray, damping: list[float]
) -> dict:
    """windIO's elastic properties; the order of its rows and columns is BeamDyn's."""
    mass = inertia[:, 0, 0]
    return {
        "stiffness_matrix": {
            "grid": grid,
            **{f"K{i + 1}{j + 1}": stiffness[:, i, j] for i, j in UPPER},
        },
        "inertia_matrix": {
            "grid": grid,
            "mass": mass,
            "cm_x": inertia[:, 1, 5] / mass,
            "cm_y": -inertia[:, 0, 5] / mass,
            "i_edge": inertia[:, 3, 3],
            "i_flap": inertia[:, 4, 4],
            "i_plr": inertia[:, 5, 5],
            "i_cp": -inertia[:, 3, 4],
        },
        "structural_damping": {"mu": damping},
    }


def on_grid(grid: np.ndarray, values: np.ndarray) -> dict:
    return {"grid": grid, "values": values}


def blade(folder: Path, htc: str, polars: list) -> dict:
    axis, axis_grid, behind = pitch_axis(c2 := read_c2(htc, "blade1"))
    ae = read_ae(folder / "data/DTU_10MW_RWT_ae.dat")
    ae_grid = ae[:, 0] / ae[-1, 0]
    grid = np.unique(np.round(np.concatenate([axis_grid, ae_grid]), 6))
    chord, thickness = (np.interp(grid, ae_grid, ae[:, k]) for k in (1, 2))
    half_chord_behind = PchipInterpolator(axis_grid, behind)(grid)
    st = read_st(folder / "data/DTU_10MW_RWT_Blade_st.dat")
    st_grid = st["r"] / st["r"][-1]
    stiffness, inertia = section_matrices(st, np.interp(st_grid, grid, half_chord_behind))
    return {
        "reference_axis": {k: on_grid(axis_grid, axis[:, i]) for i, k in enumerate("xyz")},
        "outer_shape": {
            "chord": on_grid(grid, chord),
            "twist": on_grid(grid, -PchipInterpolator(axis_grid, c2[:, 3])(grid)),
            "section_offset_y": on_grid(grid, 0.5 * chord - half_chord_behind),
            "rthick": on_grid(grid, thickness / 100),
            "airfoils": airfoil_places(grid, thickness, polars),
        },
        "structure": {
            "anchors": [],
            "layers": [],
            "elastic_properties": beam(  # of damping_posdef, the second factor is the flapwise one:
                st_grid,  # only so are both bending modes damped as the htc file says, by 3 %
                stiffness,
                inertia,
                [0.0, 0.0, 0.0, 1.53e-3, 2.55e-3, 3.3e-4],
            ),
        },
    }


def airfoil_places(grid: np.ndarray, thickness: np.ndarray, polars: list) -> list[dict]:
    """Where the blade has just the relative thickness of each airfoil, and both ends."""
    last_cylinder = grid[thickness >= 100][-1]
    places = [(0.0, 100.0), (last_cylinder, 100.0)]
    for value in sorted((p[0] for p in polars if p[0] < 100), reverse=True):
        last_above = int(np.argmax(thickness <= value + 1e-9)) - 1
        between = slice(last_above, last_above + 2)
        places.append((float(np.interp(-value, -thickness[between], grid[between])), value))
    places.append((1.0, polars[0][0]))
    return [
        {"name": airfoil_name(value), "spanwise_position": place, "configuration": ["default"]}
        | {"weight": [1.0]}
        for place, value in places
    ]


def airfoil_name(thickness: float) -> str:
    return "cylinder" if thickness >= 100 else f"FFA-W3-{thickness * 10:.0f}"


def airfoils(polars: list, surface: np.ndarray) -> list[dict]:
    out = []
    for thickness, title, table in polars:
        shape = circle() if thickness >= 100 else shape_at_thickness(surface, thickness / 100)
        reynolds = re.search(r"Re=(\d+)x10\^6", title)
        angle = table[:, 0]
        out.append(
            {
                "name": airfoil_name(thickness),
                "description": title,
                "coordinates": {"x": np.clip(shape[:, 0], 0, 1), "y": shape[:, 1]},
                "rthick": thickness / 100,
                "aerodynamic_center": 0.5 if thickness >= 100 else 0.25,
                "polars": [
                    {
                        "configuration": "default",
                        "re_sets": [
                            {
                                "re": float(reynolds[1]) * 1e6 if reynolds else 6e6,
                                **{
                                    name: on_grid(angle, table[:, k])
                                    for k, name in enumerate(("cl", "cd", "cm"), 1)
                                },
                            }
                        ],
                    }
                ],
            }
        )
    return out


def tower(folder: Path, htc: str) -> dict:
    st = read_st(folder / "data/DTU_10MW_RWT_Tower_st.dat")
    height = -read_c2(htc, "tower")[-1, 2]
    grid = st["r"] / st["r"][-1]
    stiffness, inertia = section_matrices(st, np.zeros(len(grid)))
    ends = np.array([0.0, 1.0])
    return {
        "reference_axis": {
            "x": on_grid(ends, 0 * ends),
            "y": on_grid(ends, 0 * ends),
            "z": on_grid(ends, height * ends),
        },
        "outer_shape": {
            "outer_diameter": on_grid(ends, np.array([8.3, 5.5])),
            "cd": on_grid(ends, np.array([0.6, 0.6])),
        },
        "structure": {
            "elastic_properties": beam(
                grid, stiffness, inertia, [0.0, 0.0, 0.0, 4.12e-3, 4.12e-3, 4.5e-4]
            )
        },
    }


def drivetrain() -> dict:
    """From the htc file: 7.1 m shaft tilted by 5 deg, 2.75 m over the tower top."""
    tilt, shaft, over = np.radians(5.0), 7.1, 2.75
    stiffness = 8.08e10 * 0.2036 / shaft
    return {
        "outer_shape": {
            "uptilt": 5.0,
            "distance_tt_hub": over + shaft * np.sin(tilt),
            "overhang": shaft * np.cos(tilt),
            "cd": 0.8,
        },
        "gearbox": {
            "gear_ratio": GEAR_RATIO,
            "efficiency": 1.0,
            "elastic_properties": {
                "torsional_stiffness": stiffness,
                "torsional_damping": 3.983e-3 * stiffness,
            },
        },
        "generator": {
            "rpm_efficiency": on_grid(np.array([300.0, 480.0]), np.array([0.94, 0.94])),
            "elastic_properties": {
                "mass": 0.0,
                "inertia": [3.751e6 / GEAR_RATIO**2, 0.0, 0.0, 0.0, 0.0, 0.0],
                "location": [0.0, 0.0, 0.0],
            },
        },
        "elastic_properties": {
            "mass": 446.04e3,
            "inertia": [4.106e5, 4.106e6, 4.106e6, 0.0, 0.0, 0.0],
            "location": [2.687, 0.0, over - 0.30061],
        },
    }


def control() -> dict:
    """Constants of the published controller, at the low-speed shaft (DTU_10MW_RWT htc files)."""
    pitch = np.arange(0.0, 27.0, 2.0)
    schedule = 1 / (1 + pitch / 198.32888 + pitch**2 / 693.22213)
    deg_per_rpm = 6.0  # of one rad per rad/s
    wind = np.array([4.0, 5.0, 6.0, 7.0, 11.0])
    return {
        "min_rotor_speed": 6.0,
        "rated_rotor_speed": 9.6,
        "rated_power": 10.0e6,
        "max_gen_torque": 15.6e6 / GEAR_RATIO,
        "fine_pitch": 0.0,
        "optimal_tsr": 7.5,
        "min_pitch_table": {
            "wind_speed": wind,
            "min_pitch": np.array([2.75123, 1.96647, 0.89562, 0.0, 0.0]),
        },
        "min_pitch_limit": 0.0,
        "max_pitch_limit": 90.0,
        "max_pitch_rate": 10.0,
        "lpf_frequency": 2 * np.pi * 0.2,
        "lpf_damping": 0.7,
        "region2_k": 0.100131e8 / GEAR_RATIO * (np.pi / 30) ** 2,
        "pitch_kp": {"pitch_angle": pitch, "kp": 0.524485 * deg_per_rpm * schedule},
        "pitch_ki": {"pitch_angle": pitch, "ki": 0.141233 * deg_per_rpm * schedule},
        "constant_power": 1,
    }


def windio(folder: Path, surface_file: Path) -> dict:
    htc = (folder / "DTU_10MW_RWT.htc").read_text(errors="replace")
    polars = read_pc(folder / "data/DTU_10MW_RWT_pc.dat")
    shape = drivetrain()["outer_shape"]
    return {
        "windIO_version": "2.1",
        "name": "DTU 10 MW RWT",
        "comments": "DTU 10 MW reference wind turbine, Bak et al., DTU Wind Energy Report-I-0092, "
        "2013. The reference axis is the prebent pitch axis; section matrices are in BeamDyn's "
        "axes (x suction side, y trailing edge). Made by tools/dtu10mw_from_hawc2.py.",
        "assembly": {
            "turbine_class": "I",
            "turbulence_class": "A",
            "drivetrain": "geared",
            "rotor_orientation": "Upwind",
            "number_of_blades": 3,
            "hub_height": 115.63 + shape["distance_tt_hub"],
            "rotor_diameter": 178.3,
            "rated_power": 10.0e6,
            "cut_in_wind_speed": 4.0,
            "cut_out_wind_speed": 25.0,
        },
        "components": {
            "blade": blade(folder, htc, polars),
            "hub": {
                "diameter": 5.6,
                "cone_angle": 2.5,
                "cd": 0.0,
                "elastic_properties": {
                    "mass": 105.52e3,
                    "inertia": [325.7e3, 0.0, 0.0, 0.0, 0.0, 0.0],
                    "location": [0.0, 0.0, 0.0],
                },
            },
            "drivetrain": drivetrain(),
            "tower": tower(folder, htc),
        },
        "airfoils": airfoils(polars, read_surface(surface_file)),
        "control": control(),
    }


def plain(value: object) -> object:
    """The same tree of plain numbers, seven digits, for YAML."""
    if isinstance(value, dict):
        return {k: plain(v) for k, v in value.items()}
    if isinstance(value, list | np.ndarray):
        return [plain(v) for v in value]
    if isinstance(value, float | np.floating):
        return float(f"{value:.7g}") + 0.0
    return value


def main() -> None:
    folder, surface, output = map(Path, sys.argv[1:])
    yaml = YAML()
    yaml.default_flow_style = None
    yaml.width = 100
    with output.open("w") as file:
        yaml.dump(plain(windio(folder, surface)), file)


if __name__ == "__main__":
    main()
