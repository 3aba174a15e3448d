"""The wake's velocity at the blades, all of it but the first panels.

Rows that stay away from every surface are summed at a few stations of the chords, see `chordwise`.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

import numpy as np

from galerna.aero.vortex.chordwise import AlongChords, ChordPoints, MakeField
from galerna.aero.vortex.cores import VortexCore
from galerna.aero.vortex.sheet import Sheet
from galerna.aero.vortex.surface import Surface
from galerna.aero.vortex.wake import Wake
from galerna.contract import Array


class FarWake:
    """The field of all panels of a wake but the first, at the control points of surfaces.

    ``make_field`` sums sheets in a precision, as in `InducedField`. Without ``smooth``
    nothing is interpolated.
    """

    def __init__(
        self, wake: Wake, core: VortexCore | None, make_field: MakeField, smooth: bool = True
    ) -> None:
        self._wake, self._core, self._make_field = wake, core, make_field
        self._smooth = smooth

    def velocity(self, surfaces: Sequence[Surface]) -> Array:
        """Velocity (P,3) m/s at the ``control_points`` of the surfaces."""
        targets = [ChordPoints(s, collocated=True) for s in surfaces]
        sheets = self._sheets(targets)
        sums = AlongChords(targets, sheets, self._make_field, self._smooth)
        found = sums.velocity(targets, sheets, near="mixed")
        counts = [s.shape[0] * s.shape[1] for s in surfaces]
        collocation = [u[:count] for u, count in zip(found, counts, strict=True)]
        segments = [u[count:] for u, count in zip(found, counts, strict=True)]
        return np.concatenate([*collocation, *segments])

    def _sheets(self, targets: Sequence[ChordPoints]) -> list[Sheet]:
        """Panels 1, 2, ...; if interpolated, in runs of those near a surface and of others."""
        if not self._smooth:
            return self._wake.sheets(self._core, rows=slice(1, None))
        near = np.any([t.near_rows(x[1:]) for t in targets for x in self._wake.vertices], axis=0)
        sheets: list[Sheet] = []
        for _, run in groupby(range(len(near)), key=lambda k: bool(near[k])):
            rows = list(run)
            sheets += self._wake.sheets(self._core, rows=slice(rows[0] + 1, rows[-1] + 2))
        return sheets
