"""What the moving machine shows: channels by part, with OpenFAST's names.

A load is what the outer part puts on the inner one: the blade on the hub, the rotor on the
shaft, the nacelle on the tower, the tower on its foundation. Axes: coned ones stand with z
along the pitch axis to the tip and x downwind and do not pitch; the blade's own pitch with it.
The tower's are the global ones, carried by its foot. Source of the names: Jonkman and Buhl,
FAST User's Guide, NREL/EL-500-38230 (2005), and ElastoDyn's list of outputs.
"""

from __future__ import annotations

from galerna.contract import Channel
from galerna.units import DEG

PER_BLADE = ("blade",)
ALONG_BLADE = ("blade", "blade_station")
ALONG_TOWER = ("tower_station",)
KILO = 1e-3


def force(name: str, text: str, openfast: str, dims: tuple[str, ...] = ()) -> Channel:
    """A force N, in OpenFAST kN."""
    return Channel(name, "N", text, dims, openfast, "kN", KILO)


def moment(name: str, text: str, openfast: str, dims: tuple[str, ...] = ()) -> Channel:
    """A moment N m, in OpenFAST kN-m."""
    return Channel(name, "N m", text, dims, openfast, "kN-m", KILO)


def length(name: str, text: str, openfast: str, dims: tuple[str, ...] = ()) -> Channel:
    """A displacement m."""
    return Channel(name, "m", text, dims, openfast, "m")


def angle(
    name: str, text: str, openfast: str, dims: tuple[str, ...] = (), sign: float = 1.0
) -> Channel:
    """An angle rad, in OpenFAST deg; ``sign`` -1 where OpenFAST counts it the other way."""
    return Channel(name, "rad", text, dims, openfast, "deg", sign / DEG)


def acceleration(name: str, text: str, openfast: str, dims: tuple[str, ...] = ()) -> Channel:
    """An acceleration m/s2."""
    return Channel(name, "m/s2", text, dims, openfast, "m/s^2")


def spin(name: str, text: str, openfast: str, order: int = 1) -> Channel:
    """An angular velocity rad/s, or of ``order`` 2 an acceleration rad/s2, in OpenFAST by deg."""
    per = {1: ("rad/s", "deg/s"), 2: ("rad/s2", "deg/s^2")}[order]
    return Channel(name, per[0], text, (), openfast, per[1], 1.0 / DEG)


BLADE_ROOT = (
    force("blade_root_out_of_plane_shear", "out-of-plane blade-root force (x, coned axes)",
          "RootFxc{blade}", PER_BLADE),
    force("blade_root_in_plane_shear", "in-plane blade-root force (y, coned axes)",
          "RootFyc{blade}", PER_BLADE),
    force("blade_root_axial_force", "blade-root force along the pitch axis", "RootFzc{blade}",
          PER_BLADE),
    moment("blade_root_in_plane_moment", "in-plane blade-root moment (x, coned axes)",
           "RootMxc{blade}", PER_BLADE),
    moment("blade_root_out_of_plane_moment",
           "out-of-plane blade-root moment (y, coned axes)", "RootMyc{blade}",
           PER_BLADE),
    moment("blade_root_torsion_moment", "blade-root moment about the pitch axis", "RootMzc{blade}",
           PER_BLADE),
)  # fmt: skip
BLADE_ROOT_PITCHING = (
    force("blade_root_flapwise_shear", "flapwise blade-root force (x, pitching axes)",
          "RootFxb{blade}", PER_BLADE),
    force("blade_root_edgewise_shear", "edgewise blade-root force (y, pitching axes)",
          "RootFyb{blade}", PER_BLADE),
    moment("blade_root_edgewise_moment", "edgewise blade-root moment (x, pitching axes)",
           "RootMxb{blade}", PER_BLADE),
    moment("blade_root_flapwise_moment", "flapwise blade-root moment (y, pitching axes)",
           "RootMyb{blade}", PER_BLADE),
)  # fmt: skip
BLADE_TIP = (
    length("tip_out_of_plane_displacement", "out-of-plane tip displacement (x, coned axes)",
           "OoPDefl{blade}", PER_BLADE),
    length("tip_in_plane_displacement", "in-plane tip displacement (y, coned axes)",
           "IPDefl{blade}", PER_BLADE),
    length("tip_axial_displacement", "tip displacement along the pitch axis", "TipDzc{blade}",
           PER_BLADE),
    length("tip_flapwise_displacement", "flapwise tip displacement (x, pitching axes)",
           "TipDxb{blade}", PER_BLADE),
    length("tip_edgewise_displacement", "edgewise tip displacement (y, pitching axes)",
           "TipDyb{blade}", PER_BLADE),
    angle("tip_twist", "elastic twist of the tip, towards feather", "TwstDefl{blade}", PER_BLADE,
          sign=-1.0),
    acceleration("tip_flapwise_acceleration", "tip acceleration along x, section axes",
                 "TipALxb{blade}", PER_BLADE),
    acceleration("tip_edgewise_acceleration", "tip acceleration along y, section axes",
                 "TipALyb{blade}", PER_BLADE),
    length("tip_yaw_axis_distance",
           "from the tip to the yaw axis; above the yaw bearing, to the bearing",
           "TipClrnc{blade}", PER_BLADE),
    length("tip_tower_clearance", "from the tip to the tower's surface", "", PER_BLADE),
)  # fmt: skip
BLADE_SECTION_DISPLACEMENTS = (
    length("blade_flapwise_displacement", "blade displacement along x, pitching axes",
           "Spn{node}TDxb{blade}", ALONG_BLADE),
    length("blade_edgewise_displacement", "blade displacement along y, pitching axes",
           "Spn{node}TDyb{blade}", ALONG_BLADE),
    length("blade_axial_displacement", "blade displacement along the pitch axis",
           "Spn{node}TDzb{blade}", ALONG_BLADE),
    angle("blade_twist", "elastic twist of the blade, towards feather",
          "Spn{node}RDzb{blade}", ALONG_BLADE, sign=-1.0),
)  # fmt: skip
BLADE_SECTION_LOADS = (
    force("blade_flapwise_shear", "blade force along x, section axes", "Spn{node}FLxb{blade}",
          ALONG_BLADE),
    force("blade_edgewise_shear", "blade force along y, section axes", "Spn{node}FLyb{blade}",
          ALONG_BLADE),
    force("blade_axial_force", "blade force along the span", "Spn{node}FLzb{blade}",
          ALONG_BLADE),
    moment("blade_edgewise_moment", "blade moment about x, section axes",
           "Spn{node}MLxb{blade}", ALONG_BLADE),
    moment("blade_flapwise_moment", "blade moment about y, section axes",
           "Spn{node}MLyb{blade}", ALONG_BLADE),
    moment("blade_torsion_moment", "blade moment about the span", "Spn{node}MLzb{blade}",
           ALONG_BLADE),
)  # fmt: skip
SHAFT = (
    force("shaft_thrust", "thrust of the rotor on the shaft, weight and inertia included",
          "RotThrust"),
    force("shaft_rotating_shear_y", "force on the shaft along y of the hub", "LSShftFya"),
    force("shaft_rotating_shear_z", "force on the shaft along z of the hub, towards blade 1",
          "LSShftFza"),
    moment("shaft_torque", "torque in the low-speed shaft", "RotTorq"),
    moment("shaft_rotating_moment_y", "moment on the shaft's tip about y of the hub", "LSSTipMya"),
    moment("shaft_rotating_moment_z", "moment on the shaft's tip about z of the hub", "LSSTipMza"),
    force("shaft_shear_y", "force on the shaft, horizontal", "LSShftFys"),
    force("shaft_shear_z", "force on the shaft, upwards across it", "LSShftFzs"),
    moment("shaft_moment_y", "tilting moment on the shaft's tip", "LSSTipMys"),
    moment("shaft_moment_z", "yawing moment on the shaft's tip", "LSSTipMzs"),
    Channel("shaft_power", "W", "power through the low-speed shaft", (), "RotPwr", "kW", KILO),
)  # fmt: skip
NACELLE = (
    acceleration("nacelle_acceleration_x", "acceleration above the yaw axis, along the shaft",
                 "NcIMUTAxs"),
    acceleration("nacelle_acceleration_y", "acceleration above the yaw axis, sideways",
                 "NcIMUTAys"),
    acceleration("nacelle_acceleration_z", "acceleration above the yaw axis, upwards across it",
                 "NcIMUTAzs"),
)  # fmt: skip
YAW_BEARING = (
    force("yaw_bearing_fore_aft_shear", "yaw-bearing force along x of the tower's top",
          "YawBrFxp"),
    force("yaw_bearing_side_side_shear", "yaw-bearing force along y of the tower's top",
          "YawBrFyp"),
    force("yaw_bearing_axial_force", "yaw-bearing force along the yaw axis", "YawBrFzp"),
    moment("yaw_bearing_side_side_moment", "yaw-bearing moment about x of the tower's top",
           "YawBrMxp"),
    moment("yaw_bearing_fore_aft_moment", "yaw-bearing moment about y of the tower's top",
           "YawBrMyp"),
    moment("yaw_bearing_yaw_moment", "yaw-bearing moment about the yaw axis", "YawBrMzp"),
    force("yaw_bearing_force_x", "yaw-bearing force along x of the nacelle", "YawBrFxn"),
    force("yaw_bearing_force_y", "yaw-bearing force along y of the nacelle", "YawBrFyn"),
    moment("yaw_bearing_roll_moment", "yaw-bearing moment about x of the nacelle", "YawBrMxn"),
    moment("yaw_bearing_tilt_moment", "yaw-bearing moment about y of the nacelle", "YawBrMyn"),
)  # fmt: skip
TOWER_TOP = (
    length("tower_top_fore_aft_displacement", "fore-aft tower-top displacement (x)", "TTDspFA"),
    length("tower_top_side_side_displacement", "side-side tower-top displacement (y)", "TTDspSS"),
    length("tower_top_axial_displacement", "tower-top displacement along z", "TTDspAx"),
    angle("tower_top_roll", "tower-top rotation about x", "TTDspRoll"),
    angle("tower_top_pitch", "tower-top rotation about y", "TTDspPtch"),
    angle("tower_top_twist", "tower-top rotation about z", "TTDspTwst"),
    acceleration("tower_top_fore_aft_acceleration", "fore-aft tower-top acceleration", "YawBrTAxp"),
    acceleration("tower_top_side_side_acceleration", "side-side tower-top acceleration",
                 "YawBrTAyp"),
    acceleration("tower_top_vertical_acceleration", "vertical tower-top acceleration", "YawBrTAzp"),
)  # fmt: skip
TOWER_BASE = (
    force("tower_base_fore_aft_shear", "fore-aft tower-base force (x)", "TwrBsFxt"),
    force("tower_base_side_side_shear", "side-side tower-base force (y)", "TwrBsFyt"),
    force("tower_base_axial_force", "tower-base force along z", "TwrBsFzt"),
    moment("tower_base_side_side_moment", "side-side tower-base moment (x)", "TwrBsMxt"),
    moment("tower_base_fore_aft_moment", "fore-aft tower-base moment (y)", "TwrBsMyt"),
    moment("tower_base_torsion_moment", "tower-base moment about z", "TwrBsMzt"),
)
TOWER_SECTION_LOADS = (
    force("tower_fore_aft_shear", "fore-aft tower force (x)", "TwHt{node}FLxt", ALONG_TOWER),
    force("tower_side_side_shear", "side-side tower force (y)", "TwHt{node}FLyt", ALONG_TOWER),
    force("tower_axial_force", "tower force along z", "TwHt{node}FLzt", ALONG_TOWER),
    moment("tower_side_side_moment", "side-side tower moment (x)", "TwHt{node}MLxt", ALONG_TOWER),
    moment("tower_fore_aft_moment", "fore-aft tower moment (y)", "TwHt{node}MLyt", ALONG_TOWER),
    moment("tower_torsion_moment", "tower moment about z", "TwHt{node}MLzt", ALONG_TOWER),
)
TOWER_SECTION_DISPLACEMENTS = (
    length(
        "tower_fore_aft_displacement",
        "fore-aft tower displacement (x)",
        "TwHt{node}TDxt",
        ALONG_TOWER,
    ),
    length(
        "tower_side_side_displacement",
        "side-side tower displacement (y)",
        "TwHt{node}TDyt",
        ALONG_TOWER,
    ),
    length("tower_axial_displacement", "tower displacement along z", "TwHt{node}TDzt", ALONG_TOWER),
)
BASE = (
    length("platform_surge", "platform surge: displacement of the base along x", "PtfmSurge"),
    length("platform_sway", "platform sway: displacement of the base along y", "PtfmSway"),
    length("platform_heave", "platform heave: displacement of the base along z", "PtfmHeave"),
    angle(
        "platform_roll",
        "platform roll: rotation of the base about x, the last of the turns",
        "PtfmRoll",
    ),
    angle("platform_pitch", "platform pitch: rotation of the base about y", "PtfmPitch"),
    angle(
        "platform_yaw",
        "platform yaw: rotation of the base about z, the first of the turns",
        "PtfmYaw",
    ),
)
BASE_RATES = (
    Channel("platform_velocity_x", "m/s", "velocity of the base along x", (), "PtfmTVxi", "m/s"),
    Channel("platform_velocity_y", "m/s", "velocity of the base along y", (), "PtfmTVyi", "m/s"),
    Channel("platform_velocity_z", "m/s", "velocity of the base along z", (), "PtfmTVzi", "m/s"),
    spin("platform_spin_x", "angular velocity of the base about x", "PtfmRVxi"),
    spin("platform_spin_y", "angular velocity of the base about y", "PtfmRVyi"),
    spin("platform_spin_z", "angular velocity of the base about z", "PtfmRVzi"),
    acceleration("platform_acceleration_x", "acceleration of the base along x", "PtfmTAxi"),
    acceleration("platform_acceleration_y", "acceleration of the base along y", "PtfmTAyi"),
    acceleration("platform_acceleration_z", "acceleration of the base along z", "PtfmTAzi"),
    spin("platform_spin_rate_x", "angular acceleration of the base about x", "PtfmRAxi", 2),
    spin("platform_spin_rate_y", "angular acceleration of the base about y", "PtfmRAyi", 2),
    spin("platform_spin_rate_z", "angular acceleration of the base about z", "PtfmRAzi", 2),
)
