"""How thick a vortex is: the radius of its core, and how it grows with age.

A laminar vortex diffuses as Lamb and Oseen found; turbulence in the core diffuses it faster, in
proportion to the circulation (Squire 1965):

    r_c^2 = r_0^2 + 4 alpha delta nu t,   delta = 1 + a_1 |G| / nu                         (1)

with alpha = 1.25643, the place of the largest swirl. Bhagwat and Leishman (2002, Generalized
viscous vortex model for application to free-vortex wake and aeroacoustic calculations) collect
measurements of rotors from models to full scale: a_1 is of the order of 1e-4.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError

LAMB_OSEEN = 1.25643  # solves 1 + 2 alpha = exp(alpha): the swirl is largest at r = r_c


@dataclass(frozen=True)
class VortexCore:
    """Radius of vortex cores by age, eq. (1).

    ``initial_radius`` m at the trailing edge, ``turbulence`` a_1 of Squire (0 is laminar),
    ``viscosity`` m2/s of the air. Raises ``InputError`` for a negative value.
    """

    initial_radius: float
    turbulence: float = 1e-4
    viscosity: float = 1.46e-5

    def __post_init__(self) -> None:
        for name in ("initial_radius", "turbulence", "viscosity"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value >= 0.0):
                raise InputError(
                    f"vortex core, {name}", f"{value} is not a number from 0 up", "give one"
                )

    def radius(self, age: Array | float, circulation: Array | float) -> Array:
        """Core radius m at an age s for a circulation m2/s; the two broadcast."""
        diffusion = self.viscosity + self.turbulence * np.abs(circulation)
        return np.sqrt(self.initial_radius**2 + 4.0 * LAMB_OSEEN * diffusion * np.asarray(age))
