"""The bound circulation: no flow passes through the surfaces (docs/theory/vortex.md, eq. 3)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import lu_factor, lu_solve
from scipy.sparse.linalg import LinearOperator, gmres

from galerna.aero.vortex.influence import normal_influence
from galerna.aero.vortex.mirror import MirrorPlane
from galerna.aero.vortex.surface import Surface, collocation_normals, collocation_points
from galerna.aero.vortex.symmetry import RotationalSymmetry
from galerna.contract import Array
from galerna.errors import ConvergenceError

RIGID = 1e-9  #: departure from a rigid motion, over the size of all surfaces, that still is one
GMRES_TOLERANCE = 1e-12  #: of the residual over the right side
GMRES_ITERATIONS = 12  #: after so many a new factorisation costs less


@dataclass(frozen=True, eq=False)
class Factor:
    """The factorised matrix of surfaces as they stood, corners (V,3) of all of them."""

    corners: Array
    lu: tuple[Array, Array]


class BoundSystem:
    """The influence matrix of the bound rings and what was learnt from factorising it.

    ``place`` the surfaces, then ``solve`` as often as needed. While they keep their shape, as a
    rigid rotor does that turns, the factorisation is used again; when they deform, it
    preconditions GMRES and is replaced when that takes too many iterations. A replacement is
    on trial until ``accept``; ``reject`` returns to the accepted one.

    With a ``symmetry`` the surfaces given are one sector of the whole; a ``mirror`` adds
    the image of all.
    """

    def __init__(
        self, symmetry: RotationalSymmetry | None = None, mirror: MirrorPlane | None = None
    ) -> None:
        self.symmetry, self.mirror = symmetry, mirror
        self._accepted: Factor | None = None
        self._factor: Factor | None = None
        self._matrix: Array | None = None
        self._surfaces: list[Surface] = []
        self._guess: Array | None = None
        self._kept_inverse: tuple[Factor | None, Array, Callable[[Array], Array]] | None = None
        self.iterations = 0  #: of GMRES in the last ``solve``; 0 when none were needed
        self.factorisations = 0  #: so far

    def place(self, surfaces: Sequence[Surface], often: bool = False) -> None:
        """Take the surfaces where they are now; factorise if ``solve`` is to be called often."""
        self._surfaces = list(surfaces)
        self._matrix = None
        if self._factor is None:
            self._factorise(self.influence())
        elif not self._moved_rigidly(self._factor.corners):
            self._matrix = self.influence()
            if often:
                self._factorise(self._matrix)

    def guess(self, circulation: Array) -> None:
        """Begin the search for circulations of deformed surfaces with these (N,) m2/s."""
        self._guess = circulation

    def influence(self) -> Array:
        """Normal velocity (N,N) 1/m at each collocation point by each ring of circulation 1."""
        points = collocation_points(self._surfaces)
        normals = collocation_normals(self._surfaces)
        columns = []
        for surface in self._surfaces:
            column = np.zeros((len(points), surface.shape[0] * surface.shape[1]))
            for vertices in self._images(surface.lattice.vertices):
                column += normal_influence(vertices, points, normals)
                if self.mirror is not None:
                    reflected = self.mirror.reflect_vectors(normals)
                    column += normal_influence(
                        vertices, self.mirror.reflect_points(points), reflected
                    )
            columns.append(column)
        return np.hstack(columns)

    def solve(self, normal_velocity: Array) -> Array:
        """Circulations (N,) or (N,k) m2/s that induce the normal velocity (N,) or (N,k) m/s.

        Raises ConvergenceError for a velocity that is not finite.
        """
        return self._solved(normal_velocity, None)

    def solve_with_strips(self, normal_velocity: Array, strips: Array) -> Array:
        """Circulations (N,) or (N,k) of a flow whose wake strips carry the trailing circulation.

        ``strips`` (N,n) 1/m is the normal velocity by each strip of circulation 1. The
        n trailing circulations are found first, from the Schur complement of the bound rings,
        whose factorisation thus serves any wake.
        """
        return self._solved(normal_velocity, strips)

    def _solved(self, normal_velocity: Array, strips: Array | None) -> Array:
        if not np.isfinite(normal_velocity).all():
            raise ConvergenceError("vortex lattice", self._place_of_fault(normal_velocity))
        self.iterations = 0
        inverse = self._factored_inverse(strips)
        if self._matrix is None:
            return inverse(normal_velocity)
        columns = normal_velocity.reshape(len(normal_velocity), -1).T
        guess = self._guess if normal_velocity.ndim == 1 else None
        solved = []
        for column in columns:
            solution = self._solve_deformed(column, inverse, strips, guess)
            if solution is None:
                self._factorise(self._matrix)
                return self._factored_inverse(strips)(normal_velocity)
            solved.append(solution)
        return np.stack(solved, axis=1).reshape(normal_velocity.shape)

    def _factored_inverse(self, strips: Array | None) -> Callable[[Array], Array]:
        """The inverse of the factorised rings, or of those rings with the strips behind them."""
        lu = self._lu
        if strips is None:
            return lambda right: lu_solve(lu, right, check_finite=False)
        kept = self._kept_inverse
        if kept is not None and kept[0] is self._factor and kept[1] is strips:
            return kept[2]
        trailing = self.trailing_rings
        response = lu_solve(lu, strips, check_finite=False)
        schur = lu_factor(np.eye(len(trailing)) + response[trailing])

        def inverse(right: Array) -> Array:
            alone = lu_solve(lu, right, check_finite=False)
            return alone - response @ lu_solve(schur, alone[trailing])

        self._kept_inverse = self._factor, strips, inverse
        return inverse

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
        """The corners that the accepted factorisation is of."""
        return {} if self._accepted is None else {"corners": self._accepted.corners.copy()}

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
        self._accepted = self._factor

    @property
    def _lu(self) -> tuple[Array, Array]:
        assert self._factor is not None, "place the surfaces first"
        return self._factor.lu

    def _images(self, vertices: Array) -> list[Array]:
        return [vertices] if self.symmetry is None else self.symmetry.images(vertices)

    def _corners(self) -> Array:
        return np.concatenate([s.lattice.corners.reshape(-1, 3) for s in self._surfaces])

    def _factorise(self, matrix: Array) -> None:
        self._factor = Factor(self._corners(), lu_factor(matrix, check_finite=False))
        self._matrix = None
        self.factorisations += 1

    def _solve_deformed(
        self,
        right: Array,
        inverse: Callable[[Array], Array],
        strips: Array | None,
        guess: Array | None,
    ) -> Array | None:
        """GMRES for one right side (N,) from a guess, preconditioned; None if it takes long."""
        matrix, count = self._matrix, 0
        assert matrix is not None
        trailing = self.trailing_rings

        def product(x: Array) -> Array:
            return matrix @ x if strips is None else matrix @ x + strips @ x[trailing]

        def counted(_residual: float) -> None:
            nonlocal count
            count += 1

        first = inverse(right)
        if guess is not None:
            first = guess + inverse(right - product(guess))
        solution, unfinished = gmres(
            LinearOperator(matrix.shape, product, dtype=float), right, first,
            rtol=GMRES_TOLERANCE, restart=GMRES_ITERATIONS, maxiter=1,
            M=LinearOperator(matrix.shape, inverse, dtype=float),
            callback=counted, callback_type="pr_norm",
        )  # fmt: skip
        self.iterations = max(self.iterations, count)
        return None if unfinished else solution

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
