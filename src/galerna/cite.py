"""The publications behind the models and the data that a case uses."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from galerna.cite_water import references_of_water
from galerna.publication import Reference

if TYPE_CHECKING:
    from galerna.aero.bem.options import BemOptions
    from galerna.aero.vortex.options import VortexLatticeOptions
    from galerna.case import Case


_NING = Reference(
    "Ning2014",
    "S. A. Ning",
    2014,
    "A simple solution method for the blade element momentum equations with guaranteed convergence",
    "Wind Energy 17(9), 1327-1345",
    "10.1002/we.1636",
)
_PRANDTL = Reference(
    "Prandtl1919",
    "L. Prandtl, A. Betz",
    1919,
    "Schraubenpropeller mit geringstem Energieverlust",
    "Nachrichten der Gesellschaft der Wissenschaften zu Göttingen, 193-217",
)
_BUHL = Reference(
    "Buhl2005",
    "M. L. Buhl",
    2005,
    "A new empirical relationship between thrust coefficient and induction factor for the "
    "turbulent windmill state",
    "NREL/TP-500-36834",
    "10.2172/15016819",
    "techreport",
)
_HANSEN = Reference(
    "Hansen2015",
    "M. O. L. Hansen",
    2015,
    "Aerodynamics of Wind Turbines, third edition",
    "Routledge",
    kind="book",
)
_WILSON = Reference(
    "WilsonWalker1984",
    "R. E. Wilson, S. N. Walker",
    1984,
    "Performance analysis for propeller type wind turbines",
    "Oregon State University",
    kind="techreport",
)
_PITT_PETERS = Reference(
    "PittPeters1981",
    "D. M. Pitt, D. A. Peters",
    1981,
    "Theoretical prediction of dynamic-inflow derivatives",
    "Vertica 5(1), 21-34",
)
_SKEWED_CYLINDER = Reference(
    "BranlardGaunaa2016",
    "E. Branlard, M. Gaunaa",
    2016,
    "Cylindrical vortex wake model: skewed cylinder, application to yawed or tilted rotors",
    "Wind Energy 19(2), 345-358",
)
_OYE = Reference(
    "SnelSchepers1995",
    "H. Snel, J. G. Schepers",
    1995,
    "Joint investigation of dynamic inflow effects and implementation of an engineering method",
    "ECN-C--95-107",
    kind="techreport",
)
_BEDDOES_LEISHMAN = Reference(
    "HansenGaunaaMadsen2004",
    "M. H. Hansen, M. Gaunaa, H. A. Madsen",
    2004,
    "A Beddoes-Leishman type dynamic stall model in state-space and indicial formulations",
    "Risø-R-1354(EN)",
    kind="techreport",
)
_SNEL = Reference(
    "SnelHouwinkBosschers1994",
    "H. Snel, R. Houwink, J. Bosschers",
    1994,
    "Sectional prediction of lift coefficients on rotating wind turbine blades in stall",
    "ECN-C--93-052",
    kind="techreport",
)
_DU_SELIG = Reference(
    "DuSelig1998",
    "Z. Du, M. S. Selig",
    1998,
    "A 3-D stall-delay model for horizontal axis wind turbine performance prediction",
    "1998 ASME Wind Energy Symposium, AIAA-98-0021",
    "10.2514/6.1998-21",
    "techreport",
)
_POWLES = Reference(
    "Powles1983",
    "S. R. J. Powles",
    1983,
    "The effects of tower shadow on the dynamics of a horizontal-axis wind turbine",
    "Wind Engineering 7(1), 26-42",
)
_MANN_TENSOR = Reference(
    "Mann1994",
    "J. Mann",
    1994,
    "The spatial structure of neutral atmospheric surface-layer turbulence",
    "Journal of Fluid Mechanics 273, 141-168",
    "10.1017/S0022112094001886",
)
_MANN_BOX = Reference(
    "Mann1998",
    "J. Mann",
    1998,
    "Wind field simulation",
    "Probabilistic Engineering Mechanics 13(4), 269-282",
    "10.1016/S0266-8920(97)00036-2",
)
_FILTER = Reference(
    "MunozSimon2020",
    "A. Muñoz-Simón, A. Wynn, R. Palacios",
    2020,
    "Unsteady and three-dimensional aerodynamic effects on wind turbine rotor loads",
    "AIAA SciTech Forum",
    "10.2514/6.2020-0991",
)
_JONES = Reference(
    "Jones1940",
    "R. T. Jones",
    1940,
    "The unsteady lift of a wing of finite aspect ratio",
    "NACA Report 681",
    kind="techreport",
)
_MADSEN = Reference(
    "Madsen2020",
    "H. A. Madsen, T. J. Larsen, G. R. Pirrung, A. Li, F. Zahle",
    2020,
    "Implementation of the blade element momentum model on a polar grid and its aeroelastic "
    "load impact",
    "Wind Energy Science 5, 1-27",
    "10.5194/wes-5-1-2020",
)
_VEERS = Reference(
    "Veers1988",
    "P. S. Veers",
    1988,
    "Three-dimensional wind simulation",
    "Sandia National Laboratories, SAND88-0152",
    kind="techreport",
)
_IEC = Reference(
    "IEC61400-1",
    "International Electrotechnical Commission",
    2019,
    "Wind energy generation systems, part 1: design requirements",
    "IEC 61400-1, edition 4",
    kind="techreport",
)
_KATZ_PLOTKIN = Reference(
    "KatzPlotkin2001",
    "J. Katz, A. Plotkin",
    2001,
    "Low-Speed Aerodynamics, second edition",
    "Cambridge University Press",
    "10.1017/CBO9780511810329",
    "book",
)
_SIMPSON = Reference(
    "Simpson2013",
    "R. J. S. Simpson, R. Palacios, J. Murua",
    2013,
    "Induced-drag calculations in the unsteady vortex lattice method",
    "AIAA Journal 51(7), 1775-1779",
    "10.2514/1.J052136",
)
_VATISTAS = Reference(
    "Vatistas1991",
    "G. H. Vatistas, V. Kozel, W. C. Mih",
    1991,
    "A simpler model for concentrated vortices",
    "Experiments in Fluids 11, 73-76",
    "10.1007/BF00198434",
)
_BHAGWAT = Reference(
    "BhagwatLeishman2002",
    "M. J. Bhagwat, J. G. Leishman",
    2002,
    "Generalized viscous vortex model for application to free-vortex wake and aeroacoustic "
    "calculations",
    "American Helicopter Society 58th Annual Forum, Montreal",
    kind="techreport",
)
_GREENGARD = Reference(
    "GreengardRokhlin1987",
    "L. Greengard, V. Rokhlin",
    1987,
    "A fast algorithm for particle simulations",
    "Journal of Computational Physics 73(2), 325-348",
    "10.1016/0021-9991(87)90140-9",
)
_MUKHERJEE = Reference(
    "MukherjeeGopalarathnam2006",
    "R. Mukherjee, A. Gopalarathnam",
    2006,
    "Poststall prediction of multiple-lifting-surface configurations using a decambering approach",
    "Journal of Aircraft 43(3), 660-668",
    "10.2514/1.15149",
)
_NREL5MW = Reference(
    "Jonkman2009",
    "J. Jonkman, S. Butterfield, W. Musial, G. Scott",
    2009,
    "Definition of a 5-MW reference wind turbine for offshore system development",
    "NREL/TP-500-38060",
    "10.2172/947422",
    "techreport",
)
_OC3 = Reference(
    "Jonkman2010",
    "J. Jonkman",
    2010,
    "Definition of the floating system for phase IV of OC3",
    "NREL/TP-500-47535",
    "10.2172/979456",
    "techreport",
)
_DTU10MW = Reference(
    "Bak2013",
    "C. Bak, F. Zahle, R. Bitsche, T. Kim, A. Yde, L. C. Henriksen, M. H. Hansen, "
    "J. P. A. A. Blasques, M. Gaunaa, A. Natarajan",
    2013,
    "The DTU 10-MW reference wind turbine",
    "Danish Wind Power Research 2013, DTU Wind Energy",
    kind="techreport",
)
_IEA15MW = Reference(
    "Gaertner2020",
    "E. Gaertner, J. Rinker, L. Sethuraman, F. Zahle, B. Anderson, G. Barter, N. Abbas, F. Meng, "
    "P. Bortolotti, W. Skrzypinski, G. Scott, R. Feil, H. Bredmose, K. Dykes, M. Shields, "
    "C. Allen, A. Viselli",
    2020,
    "Definition of the IEA Wind 15-megawatt offshore reference wind turbine",
    "NREL/TP-5000-75698",
    "10.2172/1603478",
    "techreport",
)
_VOLTURNUS = Reference(
    "Allen2020",
    "C. Allen, A. Viselli, H. Dagher, A. Goupee, E. Gaertner, N. Abbas, M. Hall, G. Barter",
    2020,
    "Definition of the UMaine VolturnUS-S reference platform developed for the IEA Wind "
    "15-megawatt offshore reference wind turbine",
    "NREL/TP-5000-76773",
    "10.2172/1660012",
    "techreport",
)

TURBINES = {
    "nrel5mw": (_NREL5MW,),
    "nrel5mw_oc3": (_NREL5MW, _OC3),
    "dtu10mw": (_DTU10MW,),
    "iea15mw": (_IEA15MW,),
    "iea15mw_volturnus": (_IEA15MW, _VOLTURNUS),
}

#: per aerodynamic model and option of it: what each of its values rests on
AERODYNAMICS: dict[str, dict[str, dict[object, tuple[Reference, ...]]]] = {
    "bem": {
        "model": {"bem": (_NING,)},
        "tip_loss": {True: (_PRANDTL,)},
        "root_loss": {True: (_PRANDTL,)},
        "high_thrust": {
            "buhl": (_BUHL,),
            "glauert": (_HANSEN,),
            "wilson_walker": (_WILSON,),
            "madsen": (_MADSEN,),
        },
        "skewed_wake": {"pitt_peters": (_PITT_PETERS,), "vortex_cylinder": (_SKEWED_CYLINDER,)},
        "dynamic_inflow": {"oye": (_OYE,)},
        "unsteady_airfoil": {"beddoes_leishman": (_BEDDOES_LEISHMAN,)},
        "indicial_response": {"jones": (_JONES,)},
        "spanwise_filter": {"loads": (_FILTER,), "feedback": (_FILTER,)},
        "tower_influence": {True: (_POWLES,)},
        "rotational_augmentation": {"snel": (_SNEL,), "du_selig": (_DU_SELIG,)},
    },
    "vortex_lattice": {
        "model": {
            "vortex_lattice": (_KATZ_PLOTKIN, _SIMPSON, _FILTER, _VATISTAS, _BHAGWAT, _GREENGARD)
        },
        "decambering": {True: (_MUKHERJEE,)},
        "tower_influence": {True: (_POWLES,)},
    },
}

TURBULENCE = {"mann": (_MANN_TENSOR, _MANN_BOX), "kaimal": (_VEERS, _IEC)}


def references(case: Case) -> list[Reference]:
    """The publications behind a case, each once: turbine, wind, water, then aerodynamics."""
    return list(dict.fromkeys(_references(case)))


def _references(case: Case) -> Iterator[Reference]:
    yield from TURBINES.get(case.turbine, ())
    if case.inflow.turbulence is not None:
        yield from TURBULENCE.get(case.inflow.turbulence.kind, ())
    if case.inflow.gust is not None:
        yield _IEC
    if case.sea is not None:
        yield from references_of_water(case.sea, case.platform)
    unused = _unused(case.aerodynamics)
    for option, publications in AERODYNAMICS[case.aerodynamics.model].items():
        if option not in unused:
            yield from publications.get(getattr(case.aerodynamics, option), ())


def _unused(aerodynamics: BemOptions | VortexLatticeOptions) -> set[str]:
    """Options that other options switch off."""
    if aerodynamics.model == "vortex_lattice":
        return set()
    unused = set()
    if not aerodynamics.has_unsteady_airfoil:
        unused |= {"unsteady_airfoil", "indicial_response"}
    if not aerodynamics.has_dynamic_inflow:
        unused |= {"dynamic_inflow"}
    return unused
