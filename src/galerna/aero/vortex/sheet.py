"""A sheet of vortex rings: what induces velocity, whether it is bound or wake.

Rows of rings run downstream (leading edge to trailing edge, then on into the wake), columns
along the span. The normal points where row direction x column direction points, which is
the suction side where columns run from the root to the tip of a clockwise rotor blade.
Positive circulation gives lift along that normal: the upstream side of a ring runs along the
columns with +circulation, its downstream side with -circulation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from galerna.contract import Array


@dataclass(eq=False)
class Sheet:
    """Rings (r,c) between vertices (r+1,c+1,3) m, with circulation (r,c) m2/s.

    ``core_radius`` m stands on the vertices, (r+1,c+1) or anything that broadcasts to it;
    0 is the singular vortex.
    """

    vertices: Array
    circulation: Array
    core_radius: Array | float = 0.0

    @property
    def spanwise_strength(self) -> Array:
        """Net circulation (r+1,c) of the segments from vertex (i,j) to (i,j+1)."""
        return np.diff(self.circulation, axis=0, prepend=0.0, append=0.0)

    @property
    def streamwise_strength(self) -> Array:
        """Net circulation (r,c+1) of the segments from vertex (i,j) to (i+1,j)."""
        return -np.diff(self.circulation, axis=1, prepend=0.0, append=0.0)
