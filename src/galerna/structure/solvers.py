"""The linear system of one Newton iteration: block elimination along a tree, or sparse LU.

The unknowns are the variations of the nodes (6 each) and the multipliers of the locked
components. Where the pairs form a tree, each multiplier is eliminated with the node on the
outer side of its joint and the cost is linear in the number of nodes; with closed loops or
constraints of other kinds a sparse factorisation takes over.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numba import njit
from scipy.sparse import coo_matrix, csc_matrix
from scipy.sparse.linalg import splu

from galerna.contract import Array
from galerna.errors import ConvergenceError

from .blocks import FAST
from .pairs import Integers, PairAnswer, Pairs


@dataclass(eq=False, slots=True)
class Rows:
    """Constraints beside the pairs', k of them on n nodes.

    ``residual`` (k,); ``jacobian`` and force ``direction`` sparse (k,6n); ``tangent`` sparse
    (6n,6n) is how the constraint forces turn with the nodes.
    """

    residual: Array
    jacobian: coo_matrix
    direction: coo_matrix
    tangent: coo_matrix


class LinearSolver(Protocol):
    """Solves for the node variations (n,6), pair multipliers (m,6) and row multipliers (k,)."""

    def solve(
        self, nodes: Array, answer: PairAnswer, residual: Array, scale: float, rows: Rows | None
    ) -> tuple[Array, Array, Array]: ...


def choose_solver(pairs: Pairs, n: int, more_rows: bool, names: list[str]) -> LinearSolver:
    """The tree solver where the pairs allow it."""
    tree = None if more_rows else spanning_tree(pairs, n)
    return SparseSolver(pairs, n) if tree is None else TreeSolver(pairs, tree, names)


def spanning_tree(pairs: Pairs, n: int) -> tuple[Integers, Integers] | None:
    """Parent of each node and the order from the leaves inwards; None if there is a loop.

    A node that holds the multipliers of two joints counts as a loop: its block alone
    could not be eliminated.
    """
    edges = {(min(a, b), max(a, b)) for a, b in pairs.ends.tolist() if a != b}
    neighbours: list[list[int]] = [[] for _ in range(n)]
    for a, b in sorted(edges):
        neighbours[a].append(b)
        neighbours[b].append(a)
    parent = np.full(n, -1)
    order: list[int] = []
    tree_edges = 0
    for root in range(n):
        if parent[root] >= 0:
            continue
        parent[root] = 0
        queue = deque([root])
        while queue:
            node = queue.popleft()
            order.append(node)
            for other in neighbours[node]:
                if other != root and parent[other] < 0:
                    parent[other] = node
                    tree_edges += 1
                    queue.append(other)
    owners = _outer_ends(pairs, parent)[pairs.locked.any(axis=1)]
    if tree_edges != len(edges) or len(set(owners.tolist())) < len(owners):
        return None
    return parent, np.array(order[:0:-1], dtype=np.int64)


def _outer_ends(pairs: Pairs, parent: Integers) -> Integers:
    """The end (m,) of each pair that the elimination reaches first."""
    first, second = pairs.ends[:, 0], pairs.ends[:, 1]
    first_is_outer = (first != 0) & ((parent[first] == second) | (second == 0))
    return np.where(first_is_outer, first, second)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _eliminate(D: Array, U: Array, size: int, columns: int) -> bool:
    """U <- D^-1 U by Gauss elimination with row exchanges; False if D is singular."""
    for k in range(size):
        pivot = k
        for i in range(k + 1, size):
            if abs(D[i, k]) > abs(D[pivot, k]):
                pivot = i
        if not abs(D[pivot, k]) > 1e-300:
            return False
        if pivot != k:
            for j in range(k, size):
                D[k, j], D[pivot, j] = D[pivot, j], D[k, j]
            for j in range(columns):
                U[k, j], U[pivot, j] = U[pivot, j], U[k, j]
        inverse = 1.0 / D[k, k]
        for i in range(k + 1, size):
            factor = D[i, k] * inverse
            if factor != 0.0:
                for j in range(k + 1, size):
                    D[i, j] -= factor * D[k, j]
                for j in range(columns):
                    U[i, j] -= factor * U[k, j]
    for k in range(size - 1, -1, -1):
        inverse = 1.0 / D[k, k]
        for j in range(columns):
            for i in range(k + 1, size):
                U[k, j] -= D[k, i] * U[i, j]
            U[k, j] *= inverse
    return True


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _scatter(
    ends: Integers,
    outer: Integers,
    slot: Integers,
    scale: float,
    direction: Array,
    tangent: Array,
    motion: Array,
    D: Array,
    U: Array,
    L: Array,
) -> None:
    """Add the pairs to the diagonal blocks D, the outer rows U and the inner rows L of the tree.

    U holds six columns for the parent and a seventh for the right-hand side.
    """
    for e in range(len(ends)):
        inner = ends[e, 0] + ends[e, 1] - outer[e]
        o = 0 if outer[e] == ends[e, 0] else 6
        p = 6 - o
        i, j = outer[e], inner
        for a in range(6):
            for b in range(6):
                D[i, a, b] += tangent[e, o + a, o + b]
                D[j, a, b] += tangent[e, p + a, p + b]
                U[i, a, b] += tangent[e, o + a, p + b]
                L[i, a, b] += tangent[e, p + a, o + b]
        for k in range(6):
            row = slot[e, k]
            if row >= 0:
                for a in range(6):
                    D[i, row, a] = D[i, a, row] = scale * direction[e, k, o + a]
                    U[i, row, a] = L[i, a, row] = scale * direction[e, k, p + a]
                U[i, row, 6] = -scale * motion[e, k]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _solve_tree(
    order: Integers, parent: Integers, size: Integers, D: Array, U: Array, L: Array
) -> int:
    """Eliminate the leaves first, then substitute outwards; the solution is U[:, :, 6].

    Returns the node at which the matrix is singular, or -1.
    """
    for i in order:
        s, p = size[i], parent[i]
        if not _eliminate(D[i], U[i], s, 7):
            return i
        if p != 0:
            for a in range(6):
                for k in range(s):
                    factor = L[i, a, k]
                    for b in range(6):
                        D[p, a, b] -= factor * U[i, k, b]
                    U[p, a, 6] -= factor * U[i, k, 6]
    for i in order[::-1]:
        p = parent[i]
        if p != 0:
            for k in range(size[i]):
                for b in range(6):
                    U[i, k, 6] -= U[i, k, b] * U[p, b, 6]
    return -1


class TreeSolver:
    """Block elimination from the leaves of a tree of frames to the ground."""

    def __init__(self, pairs: Pairs, tree: tuple[Integers, Integers], names: list[str]) -> None:
        self.parent, self.order = tree
        self.names = names
        self.ends = pairs.ends
        self.outer = _outer_ends(pairs, self.parent)
        self.slot = np.where(pairs.locked, 5 + np.cumsum(pairs.locked, axis=1), -1)
        n = len(self.parent)
        self.size = np.full(n, 6)
        for e in np.flatnonzero(pairs.locked.any(axis=1)):
            self.size[self.outer[e]] += pairs.locked[e].sum()
        widest = int(self.size.max())
        self.locked = pairs.locked
        self.D = np.zeros((n, widest, widest))
        self.U = np.zeros((n, widest, 7))
        self.L = np.zeros((n, 6, widest))

    def solve(
        self, nodes: Array, answer: PairAnswer, residual: Array, scale: float, rows: Rows | None
    ) -> tuple[Array, Array, Array]:
        D, U, L = self.D, self.U, self.L
        D[:], U[:], L[:] = 0.0, 0.0, 0.0
        D[:, :6, :6] = nodes
        U[:, :6, 6] = -residual
        _scatter(
            self.ends, self.outer, self.slot, scale, answer.direction, answer.tangent,
            answer.motion, D, U, L,
        )  # fmt: skip
        failed = _solve_tree(self.order, self.parent, self.size, D, U, L)
        if failed >= 0:
            raise singular(self.names[failed])
        variation = U[:, :6, 6].copy()
        variation[0] = 0.0
        multiplier = np.zeros(self.slot.shape)
        multiplier[self.locked] = scale * U[self.outer[:, None], self.slot, 6][self.locked]
        return variation, multiplier, np.zeros(0)


def singular(where: str) -> ConvergenceError:
    """The error of a matrix that cannot be inverted."""
    return ConvergenceError(
        where,
        "the structure is free to move here without inertia or stiffness, "
        "or two constraints hold the same motion",
        "add a mass, a support or a spring, or take one of the joints away",
    )


class SparseSolver:
    """Sparse LU of everything; for closed loops and constraints of other kinds."""

    def __init__(self, pairs: Pairs, n: int) -> None:
        self.n = n
        self.locked = pairs.locked
        node = np.arange(6 * n).reshape(n, 6)
        pair = node[pairs.ends].reshape(-1, 12)
        self.multiplier = np.full(pairs.locked.shape, -1)
        self.multiplier[pairs.locked] = 6 * n + np.arange(pairs.locked.sum())
        self.node_index = _outer_index(node, node)
        self.pair_index = _outer_index(pair, pair)
        owner = np.repeat(pair, pairs.locked.sum(axis=1), axis=0)
        line = np.repeat(self.multiplier[pairs.locked][:, None], 12, axis=1)
        self.row_index = (line.ravel(), owner.ravel())

    def matrix(
        self, nodes: Array, answer: PairAnswer, scale: float, rows: Rows | None
    ) -> csc_matrix:
        """The whole matrix, ground included, which stands still."""
        held = answer.direction[self.locked].ravel() * scale
        line, column = self.row_index
        k = 6 * self.n + int(self.locked.sum())
        data = [nodes.ravel(), answer.tangent.ravel(), held, held]
        row = [self.node_index[0], self.pair_index[0], line, column]
        col = [self.node_index[1], self.pair_index[1], column, line]
        extra = 0
        if rows is not None:
            extra = len(rows.residual)
            J, F, S = rows.jacobian, rows.direction, rows.tangent
            data += [scale * J.data, scale * F.data, S.data]
            row += [k + J.row, F.col, S.row]
            col += [J.col, k + F.row, S.col]
        size = k + extra
        values, i, j = np.concatenate(data), np.concatenate(row), np.concatenate(col)
        keep = (i >= 6) & (j >= 6)
        return csc_matrix((values[keep], (i[keep] - 6, j[keep] - 6)), shape=(size - 6, size - 6))

    def solve(
        self, nodes: Array, answer: PairAnswer, residual: Array, scale: float, rows: Rows | None
    ) -> tuple[Array, Array, Array]:
        extra = np.zeros(0) if rows is None else rows.residual
        right = -np.concatenate(
            [residual[1:].ravel(), scale * answer.motion[self.locked], scale * extra]
        )
        try:
            solution = splu(self.matrix(nodes, answer, scale, rows)).solve(right)
        except RuntimeError:
            raise singular("structure") from None
        if not np.isfinite(solution).all():
            raise singular("structure")
        n, held = 6 * (self.n - 1), int(self.locked.sum())
        multiplier = np.zeros(self.locked.shape)
        multiplier[self.locked] = scale * solution[n : n + held]
        variation = np.concatenate([np.zeros(6), solution[:n]]).reshape(-1, 6)
        return variation, multiplier, scale * solution[n + held :]


def _outer_index(rows: Integers, columns: Integers) -> tuple[Integers, Integers]:
    """Row and column numbers of dense blocks with these (b,r) and (b,c) lines."""
    shape = (len(rows), rows.shape[1], columns.shape[1])
    i = np.broadcast_to(rows[:, :, None], shape)
    j = np.broadcast_to(columns[:, None, :], shape)
    return i.ravel(), j.ravel()
