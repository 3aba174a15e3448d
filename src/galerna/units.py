"""Unit factors for the user's boundary; inside, everything is SI and radians."""

from __future__ import annotations

from math import pi

DEG = pi / 180.0  #: radians in a degree
RPM = 2.0 * pi / 60.0  #: rad/s in a revolution per minute
STANDARD_GRAVITY = 9.80665  #: m/s2
AIR_DENSITY = 1.225  #: kg/m3, ISA at sea level
AIR_VISCOSITY = 1.464e-5  #: m2/s, kinematic, as in the OpenFAST NREL 5 MW decks
SEA_WATER = 1025.0  #: kg/m3
