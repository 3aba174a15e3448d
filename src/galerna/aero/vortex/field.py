"""The velocity that vortex sheets induce, wherever it is asked for."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from galerna.aero.vortex.biot_savart import direct_velocity
from galerna.aero.vortex.mirror import MirrorPlane
from galerna.aero.vortex.sheet import Sheet
from galerna.aero.vortex.treecode import Treecode, choose_rule
from galerna.contract import Array

#: Cost of clusters of a panel, and of a point among them, in pairs of panel and point summed.
#: Single precision makes pairs cheaper than clusters.
_CLUSTERS = {"single": (1000.0, 10000.0)}
_IN_DOUBLE = (300.0, 2500.0)


class InducedField:
    """Velocity induced by ``sheets``, for as long as neither their shape nor strength changes.

    With ``error`` None every segment is summed; with a number from 1e-5 to 0.1 the sum may
    differ by that much of the root mean square of the induced velocity, where that saves
    time. Clusters are made once, when they are first wanted. Answers to ``precision`` "single"
    are good to about 1e-5. A ``mirror`` adds the sheets' image.
    """

    def __init__(
        self,
        sheets: Sequence[Sheet],
        *,
        error: float | None = None,
        precision: str = "double",
        mirror: MirrorPlane | None = None,
    ) -> None:
        if error is not None:
            choose_rule(error)  # raises InputError for errors that cannot be kept
        self.sheets, self.error, self.precision, self.mirror = sheets, error, precision, mirror

    def velocity(self, points: Array, precision: str | None = None) -> Array:
        """Velocity (...,3) m/s at points (...,3) m."""
        points = np.asarray(points, dtype=float)
        velocity = self._sum(points, precision or self.precision)
        if self.mirror is not None:
            image = self._sum(self.mirror.reflect_points(points), precision or self.precision)
            velocity += self.mirror.reflect_vectors(image)
        return velocity

    def vertex_velocities(
        self, which: Sequence[int] | None = None, precision: str | None = None
    ) -> list[Array]:
        """Velocity (r+1,c+1,3) m/s at the vertices of the sheets numbered ``which`` (all)."""
        numbers = list(range(len(self.sheets)) if which is None else which)
        vertices = [np.asarray(self.sheets[i].vertices, dtype=float) for i in numbers]
        if not numbers:
            return []
        everywhere = np.concatenate([x.reshape(-1, 3) for x in vertices])
        if not self._worth_clusters(len(everywhere), precision or self.precision):
            velocity = self.velocity(everywhere, precision)
            ends = np.cumsum([x.size // 3 for x in vertices])[:-1]
            parts = np.split(velocity, ends)
            return [u.reshape(x.shape) for u, x in zip(parts, vertices, strict=True)]
        answers = self._tree.vertex_velocities(numbers, precision or self.precision)
        if self.mirror is not None:
            for answer, x in zip(answers, vertices, strict=True):
                image = self._sum(self.mirror.reflect_points(x), precision or self.precision)
                answer += self.mirror.reflect_vectors(image)
        return answers

    @cached_property
    def _tree(self) -> Treecode:
        assert self.error is not None
        return Treecode(self.sheets, self.error)

    def _worth_clusters(self, points: int, precision: str) -> bool:
        if self.error is None:
            return False
        panels = sum(np.size(sheet.circulation) for sheet in self.sheets)
        per_panel, per_point = _CLUSTERS.get(precision, _IN_DOUBLE)
        return panels * points > per_panel * panels + per_point * points

    def _sum(self, points: Array, precision: str) -> Array:
        if self._worth_clusters(points.size // 3, precision):
            return self._tree.velocity(points, precision)
        return direct_velocity(self.sheets, points, precision)


def induced_velocity(
    sheets: Sequence[Sheet],
    points: Array,
    *,
    error: float | None = None,
    precision: str = "double",
    mirror: MirrorPlane | None = None,
) -> Array:
    """Velocity (...,3) m/s that sheets induce at points (...,3) m; see `InducedField`."""
    field = InducedField(sheets, error=error, precision=precision, mirror=mirror)
    return field.velocity(points)
