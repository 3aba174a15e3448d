"""The publications behind the water of a case."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from galerna.hydro.platform_options import PlatformOptions
from galerna.publication import Reference

if TYPE_CHECKING:
    from galerna.hydro.sea_options import SeaOptions

_CUMMINS = Reference(
    "Cummins1962",
    "W. E. Cummins",
    1962,
    "The impulse response function and ship motions",
    "Schiffstechnik 9, 101-109",
)
_CAPYTAINE = Reference(
    "AncellinDias2019",
    "M. Ancellin, F. Dias",
    2019,
    "Capytaine: a Python-based linear potential flow solver",
    "Journal of Open Source Software 4(36), 1341",
    "10.21105/joss.01341",
)
_JONSWAP = Reference(
    "Hasselmann1973",
    "K. Hasselmann, et al.",
    1973,
    "Measurements of wind-wave growth and swell decay during the Joint North Sea Wave Project",
    "Ergänzungsheft zur Deutschen Hydrographischen Zeitschrift A8(12)",
)
_PIERSON_MOSKOWITZ = Reference(
    "PiersonMoskowitz1964",
    "W. J. Pierson, L. Moskowitz",
    1964,
    "A proposed spectral form for fully developed wind seas",
    "Journal of Geophysical Research 69(24), 5181-5190",
    "10.1029/JZ069i024p05181",
)
_MORISON = Reference(
    "Morison1950",
    "J. R. Morison, M. P. O'Brien, J. W. Johnson, S. A. Schaaf",
    1950,
    "The force exerted by surface waves on piles",
    "Journal of Petroleum Technology 2(5), 149-154",
    "10.2118/950149-G",
)
_JONKMAN = Reference(
    "Jonkman2007",
    "J. M. Jonkman",
    2007,
    "Dynamics modeling and loads analysis of an offshore floating wind turbine",
    "NREL/TP-500-41958",
    "10.2172/921803",
    "techreport",
)
_MOORDYN = Reference(
    "HallGoupee2015",
    "M. Hall, A. Goupee",
    2015,
    "Validation of a lumped-mass mooring line model with DeepCwind semisubmersible model test data",
    "Ocean Engineering 104, 590-603",
    "10.1016/j.oceaneng.2015.05.035",
)
_NEWMAN = Reference(
    "Newman1974",
    "J. N. Newman",
    1974,
    "Second-order, slowly-varying forces on vessels in irregular waves",
    "Symposium on the Dynamics of Marine Vehicles and Structures in Waves, 182-186",
    kind="techreport",
)

WAVES = {"jonswap": (_JONSWAP,), "pierson_moskowitz": (_PIERSON_MOSKOWITZ,)}
MOORING = {"quasi_static": (_JONKMAN,), "dynamic": (_MOORDYN,)}


def references_of_water(sea: SeaOptions, platform: PlatformOptions | None) -> Iterator[Reference]:
    """Those behind a sea, and a platform in it."""
    options = platform or PlatformOptions()
    yield _CUMMINS
    if options.hydrodynamics_file is None:
        yield _CAPYTAINE
    yield from WAVES.get(sea.waves.kind, ())
    if sea.drag:
        yield _MORISON
    yield from MOORING.get(options.mooring, ())
    if options.drift == "slow":
        yield _NEWMAN
