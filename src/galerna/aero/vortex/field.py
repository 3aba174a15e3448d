"""The velocity that vortex sheets induce, wherever it is asked for."""

from __future__ import annotations

from collections.abc import Sequence

from galerna.aero.vortex.biot_savart import direct_velocity
from galerna.aero.vortex.mirror import MirrorPlane
from galerna.aero.vortex.sheet import Sheet
from galerna.contract import Array


class InducedField:
    """Velocity induced by ``sheets``, for as long as neither their shape nor strength changes.

    With ``error`` None every segment is summed; with a number the sum may differ by that much,
    relative to the root mean square of the induced velocity, where this saves time. Answers
    to ``precision`` "single" are good to about 1e-5. A ``mirror`` adds the sheets' image.
    """

    def __init__(
        self,
        sheets: Sequence[Sheet],
        *,
        error: float | None = None,
        precision: str = "double",
        mirror: MirrorPlane | None = None,
    ) -> None:
        self.sheets, self.error, self.precision, self.mirror = sheets, error, precision, mirror

    def velocity(self, points: Array, precision: str | None = None) -> Array:
        """Velocity (...,3) m/s at points (...,3) m."""
        velocity = self._sum(points, precision or self.precision)
        if self.mirror is not None:
            image = self._sum(self.mirror.reflect_points(points), precision or self.precision)
            velocity += self.mirror.reflect_vectors(image)
        return velocity

    def vertex_velocities(
        self, which: Sequence[int] | None = None, precision: str | None = None
    ) -> list[Array]:
        """Velocity (r+1,c+1,3) m/s at the vertices of the sheets numbered ``which`` (all)."""
        numbers = range(len(self.sheets)) if which is None else which
        return [self.velocity(self.sheets[i].vertices, precision) for i in numbers]

    def _sum(self, points: Array, precision: str) -> Array:
        return direct_velocity(self.sheets, points)


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
