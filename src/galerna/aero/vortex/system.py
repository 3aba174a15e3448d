"""The bound circulation: no flow passes through the surfaces (docs/theory/vortex.md, eq. 3)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from galerna.aero.vortex.influence import normal_influence
from galerna.aero.vortex.mirror import MirrorPlane
from galerna.aero.vortex.surface import Surface, collocation_normals, collocation_points
from galerna.aero.vortex.symmetry import RotationalSymmetry
from galerna.contract import Array
from galerna.errors import ConvergenceError

RIGID = 1e-9  #: departure from a rigid motion, over the size of all surfaces, that still is one
TOLERANCE = 1e-9  #: of the residual over the right side
REFINEMENTS = 4  #: after so many a new factorisation costs less
GAIN = 0.3  #: of a refinement that is worth going on: residual after it over that before


@dataclass(frozen=True, eq=False)
class Rings:
    """The influence (N,N) of the rings of surfaces as they stood, corners (V,3) of all of them."""

    corners: Array
    influence: Array


@dataclass(frozen=True, eq=False)
class Factor:
    """The factorised matrix of rings and, if any, the ``strips`` (N,n) of a wake behind them."""

    rings: Rings
    strips: Array | None
    lu: tuple[Array, Array]


class BoundSystem:
    """The influence matrix of the bound rings and what was learnt from factorising it.

    ``place`` the surfaces, then ``solve`` as often as needed. While they keep their shape, as a
    rigid rotor does that turns, their influence is used again. Circulations are refined
    iteratively with an earlier factorisation, which is replaced when it no longer serves. A
    replacement is on trial until ``accept``; ``reject`` returns to the accepted one.

    With a ``symmetry`` the surfaces given are one sector of the whole; a ``mirror`` adds
    the image of all.
    """

    def __init__(
        self, symmetry: RotationalSymmetry | None = None, mirror: MirrorPlane | None = None
    ) -> None:
        self.symmetry, self.mirror = symmetry, mirror
        self._accepted: Factor | None = None
        self._factor: Factor | None = None
        self._rings: Rings | None = None
        self._surfaces: list[Surface] = []
        self._guess: Array | None = None
        self.refinements = 0  #: in the last ``solve``; 0 where a factorisation was exact
        self.factorisations = 0  #: so far

    def place(self, surfaces: Sequence[Surface]) -> None:
        """Take the surfaces where they are now."""
        self._surfaces = list(surfaces)
        if self._factor is not None and self._moved_rigidly(self._factor.rings.corners):
            self._rings = self._factor.rings
        else:
            self._rings = Rings(self._corners(), self.influence())

    def guess(self, circulation: Array) -> None:
        """Begin the search for circulations from these (N,) m2/s."""
        self._guess = circulation

    def influence(self) -> Array:
        """Normal velocity (N,N) 1/m at each collocation point by each ring of circulation 1."""
        points = collocation_points(self._surfaces)
        normals = collocation_normals(self._surfaces)
        influence = np.zeros((len(points), len(points)))
        first = 0
        for surface in self._surfaces:
            last = first + surface.shape[0] * surface.shape[1]
            own = influence[:, first:last]
            for vertices in self._images(surface.lattice.vertices):
                own += normal_influence(vertices, points, normals)
                if self.mirror is not None:
                    image = self.mirror.reflect_points(points), self.mirror.reflect_vectors(normals)
                    own += normal_influence(vertices, *image)
            first = last
        return influence

    def solve(self, normal_velocity: Array, strips: Array | None = None) -> Array:
        """Circulations (N,) or (N,k) m2/s that induce the normal velocity (N,) or (N,k) m/s.

        ``strips`` (N,n) 1/m are the normal velocity by each strip of a wake that carries the
        trailing circulation, for a circulation of 1. Raises ConvergenceError for a velocity
        that is not finite.
        """
        if not np.isfinite(normal_velocity).all():
            raise ConvergenceError("vortex lattice", self._place_of_fault(normal_velocity))
        found = None if self._factor is None else self._refined(normal_velocity, strips)
        if found is None:
            found = lu_solve(self._factorise(strips).lu, normal_velocity, check_finite=False)
            self.refinements = 0
        return found

    def _refined(self, right: Array, strips: Array | None) -> Array | None:
        """Circulations by iterative refinement; None where the factorisation does not serve."""
        assert self._factor is not None
        assert self._rings is not None, "place the surfaces first"
        trailing, limit = self.trailing_rings, TOLERANCE * float(np.linalg.norm(right))
        found = self._guess if right.ndim == 1 and self._guess is not None else np.zeros_like(right)
        before = np.inf
        for self.refinements in range(REFINEMENTS + 1):
            lacking = right - self._rings.influence @ found
            if strips is not None:
                lacking -= strips @ found[trailing]
            size = float(np.linalg.norm(lacking))
            if size <= limit:
                return found
            if not size <= GAIN * before:
                return None
            before = size
            found = found + lu_solve(self._factor.lu, lacking, check_finite=False)
        return None

    @property
    def trailing_rings(self) -> Array:
        """Numbers (n,) of the rings at the trailing edges of all surfaces."""
        numbers, first = [], 0
        for surface in self._surfaces:
            m, n = surface.shape
            numbers.append(first + (m - 1) * n + np.arange(n))
            first += m * n
        return np.concatenate(numbers)

    def accept(self) -> None:
        """Keep the present factorisation; part of accepting a step."""
        self._accepted = self._factor

    def reject(self) -> None:
        """Return to the factorisation last accepted; part of beginning a step anew."""
        self._factor = self._accepted

    def state(self) -> dict[str, np.ndarray]:
        """The corners, and the strips if any, that the accepted factorisation is of."""
        factor = self._accepted
        if factor is None:
            return {}
        strips = {} if factor.strips is None else {"strips": factor.strips.copy()}
        return {"corners": factor.rings.corners.copy(), **strips}

    def restore(self, state: Mapping[str, np.ndarray], surfaces: Sequence[Surface]) -> None:
        """Take a state back, to the same bits; ``surfaces`` give the numbers of panels."""
        self._factor = None
        if "corners" in state:
            ends = np.cumsum([s.lattice.corners.size // 3 for s in surfaces])[:-1]
            parts = np.split(np.asarray(state["corners"], dtype=float), ends)
            self.place(
                [
                    Surface.at_rest(c.reshape(s.lattice.corners.shape), s.lattice.rings)
                    for c, s in zip(parts, surfaces, strict=True)
                ]
            )
            self._factorise(state.get("strips"))
        self._accepted = self._factor

    def _images(self, vertices: Array) -> list[Array]:
        return [vertices] if self.symmetry is None else self.symmetry.images(vertices)

    def _corners(self) -> Array:
        return np.concatenate([s.lattice.corners.reshape(-1, 3) for s in self._surfaces])

    def _factorise(self, strips: Array | None) -> Factor:
        assert self._rings is not None, "place the surfaces first"
        matrix = self._rings.influence.copy()
        if strips is not None:
            matrix[:, self.trailing_rings] += strips
        lu = lu_factor(matrix, overwrite_a=True, check_finite=False)
        self._factor = Factor(self._rings, strips, lu)
        self.factorisations += 1
        return self._factor

    def _moved_rigidly(self, reference: Array) -> bool:
        """Whether the surfaces are the reference moved as a whole (Kabsch 1976)."""
        corners = self._corners()
        if corners.shape != reference.shape:
            return False
        middle, reference_middle = corners.mean(axis=0), reference.mean(axis=0)
        arm, reference_arm = corners - middle, reference - reference_middle
        left, _, right = np.linalg.svd(reference_arm.T @ arm)
        handed = np.array([1.0, 1.0, np.sign(np.linalg.det(left @ right))])
        turn = (left * handed) @ right
        size = np.linalg.norm(reference_arm, axis=1).max()
        if np.abs(arm - reference_arm @ turn).max() > RIGID * size:
            return False
        return self.mirror is None or self._keeps_height(turn, middle - reference_middle, size)

    def _keeps_height(self, turn: Array, shift: Array, size: float) -> bool:
        """Whether a rigid motion leaves the surfaces as they stood to the mirror plane."""
        assert self.mirror is not None
        normal = self.mirror.normal
        tilt = np.abs(normal @ turn - normal).max()
        return bool(tilt <= RIGID and abs(shift @ normal) <= RIGID * size)

    def _place_of_fault(self, normal_velocity: Array) -> str:
        bad = np.flatnonzero(~np.isfinite(normal_velocity.reshape(len(normal_velocity), -1)).all(1))
        number = int(bad[0])
        for index, surface in enumerate(self._surfaces):
            m, n = surface.shape
            if number < m * n:
                row, column = divmod(number, n)
                return (
                    f"the air's velocity at surface {index + 1}, row {row + 1}, "
                    f"column {column + 1} is not a number"
                )
            number -= m * n
        return "the air's velocity is not a number"
