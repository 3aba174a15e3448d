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


Solution = tuple[Array, Array, Array]


class LinearSolver(Protocol):
    """Solves for the node variations (n,6), pair multipliers (m,6) and row multipliers (k,).

    ``factorise`` keeps the matrix for any number of right-hand sides: the ``residual`` (n,6) of
    the nodes, the ``motion`` (m,6) of the pairs and the ``values`` (k,) of the rows.
    """

    def factorise(
        self, nodes: Array, answer: PairAnswer, scale: float, rows: Rows | None
    ) -> None: ...
    def solve(self, residual: Array, motion: Array, values: Array) -> Solution: ...


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
def _factorise_block(D: Array, pivot: Integers, size: int) -> bool:
    """D <- its triangular factors, with row exchanges ``pivot``; False if D is singular."""
    for k in range(size):
        p = k
        for i in range(k + 1, size):
            if abs(D[i, k]) > abs(D[p, k]):
                p = i
        if not abs(D[p, k]) > 1e-300:
            return False
        pivot[k] = p
        if p != k:
            for j in range(size):
                D[k, j], D[p, j] = D[p, j], D[k, j]
        inverse = 1.0 / D[k, k]
        for i in range(k + 1, size):
            D[i, k] *= inverse
            factor = D[i, k]
            if factor != 0.0:
                for j in range(k + 1, size):
                    D[i, j] -= factor * D[k, j]
        D[k, k] = inverse
    return True


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _substitute_block(D: Array, pivot: Integers, size: int, B: Array) -> None:
    """B <- D^-1 B with the factors of D, for the columns of B."""
    columns = B.shape[1]
    for k in range(size):
        p = pivot[k]
        if p != k:
            for j in range(columns):
                B[k, j], B[p, j] = B[p, j], B[k, j]
    for k in range(size):
        for i in range(k + 1, size):
            factor = D[i, k]
            if factor != 0.0:
                for j in range(columns):
                    B[i, j] -= factor * B[k, j]
    for k in range(size - 1, -1, -1):
        for i in range(k + 1, size):
            factor = D[k, i]
            if factor != 0.0:
                for j in range(columns):
                    B[k, j] -= factor * B[i, j]
        for j in range(columns):
            B[k, j] *= D[k, k]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _scatter(
    ends: Integers, outer: Integers, slot: Integers, scale: float, direction: Array,
    tangent: Array, D: Array, U: Array, L: Array,
) -> None:  # fmt: skip
    """Add the pairs to the diagonal blocks D, the outer rows U and the inner rows L of the tree."""
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


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _factorise_tree(
    order: Integers, parent: Integers, size: Integers, D: Array, U: Array, L: Array,
    pivot: Integers,
) -> int:  # fmt: skip
    """Eliminate the leaves first; returns the node at which the matrix is singular, or -1."""
    for i in order:
        s, p = size[i], parent[i]
        if not _factorise_block(D[i], pivot[i], s):
            return i
        _substitute_block(D[i], pivot[i], s, U[i])
        if p != 0:
            for a in range(6):
                for k in range(s):
                    factor = L[i, a, k]
                    if factor != 0.0:
                        for b in range(6):
                            D[p, a, b] -= factor * U[i, k, b]
    return -1


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _substitute_tree(
    order: Integers, parent: Integers, size: Integers, D: Array, U: Array, L: Array,
    pivot: Integers, b: Array,
) -> None:  # fmt: skip
    """b (n,widest,1) <- the solution: inwards from the leaves, then outwards."""
    for i in order:
        s, p = size[i], parent[i]
        _substitute_block(D[i], pivot[i], s, b[i])
        if p != 0:
            for a in range(6):
                for k in range(s):
                    b[p, a, 0] -= L[i, a, k] * b[i, k, 0]
    for i in order[::-1]:
        p = parent[i]
        if p != 0:
            for k in range(size[i]):
                for a in range(6):
                    b[i, k, 0] -= U[i, k, a] * b[p, a, 0]


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
        owner = np.broadcast_to(self.outer[:, None], self.slot.shape)
        self.rows = owner[self.locked], self.slot[self.locked]
        self.D, self.U = np.zeros((n, widest, widest)), np.zeros((n, widest, 6))
        self.L, self.b = np.zeros((n, 6, widest)), np.zeros((n, widest, 1))
        self.pivot = np.zeros((n, widest), dtype=np.int64)
        self.scale = 1.0

    def factorise(self, nodes: Array, answer: PairAnswer, scale: float, rows: Rows | None) -> None:
        D, U, L, self.scale = self.D, self.U, self.L, scale
        D[:], U[:], L[:] = 0.0, 0.0, 0.0
        D[:, :6, :6] = nodes
        _scatter(self.ends, self.outer, self.slot, scale, answer.direction, answer.tangent, D, U, L)
        failed = _factorise_tree(self.order, self.parent, self.size, D, U, L, self.pivot)
        if failed >= 0:
            raise singular(self.names[failed])

    def solve(self, residual: Array, motion: Array, values: Array) -> Solution:
        b = self.b
        b[:, :6, 0] = -residual
        b[:, 6:] = 0.0
        b[(*self.rows, 0)] = -self.scale * motion[self.locked]
        _substitute_tree(
            self.order, self.parent, self.size, self.D, self.U, self.L, self.pivot, b
        )  # fmt: skip
        variation = b[:, :6, 0].copy()
        variation[0] = 0.0
        multiplier = np.zeros(self.slot.shape)
        multiplier[self.locked] = self.scale * b[(*self.rows, 0)]
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

    def factorise(self, nodes: Array, answer: PairAnswer, scale: float, rows: Rows | None) -> None:
        self.scale = scale
        try:
            self.factors = splu(self.matrix(nodes, answer, scale, rows))
        except RuntimeError:
            raise singular("structure") from None

    def solve(self, residual: Array, motion: Array, values: Array) -> Solution:
        scale = self.scale
        right = [residual[1:].ravel(), scale * motion[self.locked], scale * values]
        solution = self.factors.solve(-np.concatenate(right))
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
