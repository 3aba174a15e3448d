"""Fit of a passive state space to added mass and radiation damping.

K(i w) = B(w) + i w (A(w) - A_inf), entries over the root of the diagonals' largest values. The
free parameters are those of ``wave_rows``, so every step of the least squares is stable, passive,
symmetric, strictly proper and zero at w = 0. A_inf shifts a little with the fit: its error in
the panels grows with frequency in K, and it is known better from all of A(w) (Ogilvie, 5th
Symp. Naval Hydrodynamics, 1964).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares
from scipy.sparse.csgraph import connected_components

from galerna.contract import Array
from galerna.errors import ConvergenceError, InputError
from galerna.hydro.database import Complex, HydroDatabase

from .state_space import RadiationStateSpace, joined
from .wave_rows import Rows, parameters_of, realized, residuals, rise, slopes, transfer, unpacked

COUPLED = 2e-3  #: of the root of the diagonals' product: less is no coupling
FELT = 1e-6  #: of the largest force or moment: less is no radiation
TOLERANCE = 0.003  #: of the largest coefficient: one more section where a fit is worse
NOTED = 0.01  #: of the largest coefficient: a worse fit is told
LARGEST_ERROR = 0.3  #: above it no fit is of use
ALIKE = 0.5  #: of the tolerance, by which two sets of modes may differ that are one
MOST_SECTIONS = 8
FAR = 2.5  #: times the middle frequency: no section comes there
FALLS = 0.8  #: of the root mean square: more is no progress
PATIENCE = 2  #: sections more without progress
RATIOS = (0.05, 20.0)  #: least and largest damping ratio of a section
SEARCH, POLISH = 40, 200  #: evaluations of the Jacobian
SPREADS = ((0.5, 2.0, 0.5), (0.3, 3.0, 0.7), (0.5, 2.0, 0.3))
NEW_SECTIONS = (0.4, 1.0, 2.5)  #: frequencies over the middle one, of a section that comes new
NARROW = 0.1  #: damping ratio of one that comes where the fit is worst


def radiation_of(database: HydroDatabase) -> Complex:
    """K(i w) (n,6,6) in N s/m, N s, N m s of a database, symmetric."""
    rest = database.added_mass - database.added_mass_infinite
    K = database.damping + 1j * database.frequency[:, None, None] * rest
    return np.asarray(0.5 * (K + K.transpose(0, 2, 1)), dtype=complex)


def fit_radiation(
    database: HydroDatabase, *, tolerance: float = TOLERANCE, most_sections: int = MOST_SECTIONS
) -> RadiationStateSpace:
    """The passive state space of a database's radiation, each set of coupled modes for itself.

    Sections are added until the largest error is below ``tolerance`` of the largest
    coefficient, or more do not help; the notes tell what is left. Raises InputError for
    coefficients that are not finite, ConvergenceError where the fit misses them by far.
    """
    K, shift = radiation_of(database), np.zeros((6, 6))
    if not np.isfinite(K).all():
        raise InputError("radiation", "added mass or damping of the database is not finite")
    error, rms = np.zeros((6, 6)), np.zeros((6, 6))
    parts, known = [], list[tuple[_Block, Rows]]()
    for modes in coupled_modes(K):
        square = np.ix_(modes, modes)
        block = _Block.of(database.frequency, K[:, square[0], square[1]])
        rows = _same(block, known, ALIKE * tolerance)
        if rows is None:
            rows = _fit_block(block, tolerance, most_sections)
        known.append((block, rows))
        A, B = realized(rows)
        whole = np.zeros((len(A), 6))
        whole[:, modes] = B * block.scale
        parts.append((A, whole))
        distance, own = block.distance(rows)
        shift[square] = own * np.outer(block.scale, block.scale)
        error[square] = np.abs(distance).max(axis=0)
        rms[square] = np.sqrt((np.abs(distance) ** 2).mean(axis=0))
    notes = _notes(error, rms, max(tolerance, NOTED))
    infinite = 0.5 * (database.added_mass_infinite + database.added_mass_infinite.T) - shift
    return RadiationStateSpace(*joined(parts), infinite, error, rms, notes)


def coupled_modes(K: Complex) -> list[list[int]]:
    """Modes that radiate, in sets that do not couple with each other."""
    size = np.abs(K).max(axis=0)
    own = size.diagonal()
    largest = np.repeat([own[:3].max(), own[3:].max()], 3)
    felt = np.flatnonzero(own > FELT * largest)
    coupling = size[np.ix_(felt, felt)] > COUPLED * np.sqrt(np.outer(own[felt], own[felt]))
    count, label = connected_components(coupling, directed=False)
    return [felt[label == k].tolist() for k in range(count)]


@dataclass(frozen=True, eq=False)
class _Block:
    """Coupled modes: ``K`` (n,m,m) over ``scale`` on both sides, weighed by its ``largest``.

    ``middle`` rad/s is that of the damping. Above it errors of K count less, by ``care``
    (n,): there an error of the added mass is multiplied by the frequency, and nothing happens.
    """

    frequency: Array
    K: Complex
    scale: Array
    largest: Array
    middle: float
    care: Array

    @classmethod
    def of(cls, w: Array, K: Complex) -> _Block:
        scale = np.sqrt(np.abs(K).max(axis=0).diagonal())
        over = K / np.outer(scale, scale)
        largest = np.maximum(np.abs(over).max(axis=0), 0.02)
        power = np.maximum(over.real.trace(axis1=1, axis2=2), 1e-12)
        middle = float(np.trapezoid(power * w, w) / np.trapezoid(power, w))
        return cls(w, over, scale, largest, middle, np.minimum(1.0, middle / w))

    def distance(self, rows: Rows) -> tuple[Complex, Array]:
        """Fit minus data over the largest (n,m,m), and the rise (m,m) of A_inf taken out of it."""
        apart = transfer(*rows, self.frequency) - self.K
        mass = rise(self.frequency, apart)
        apart -= 1j * self.frequency[:, None, None] * mass
        return apart / self.largest, mass

    def waves(self) -> tuple[Array, Array]:
        """Powers (m,) and shapes (m,m) of the waves at most, largest first."""
        _, shapes = np.linalg.eigh(np.trapezoid(self.K.real, self.frequency, axis=0))
        return np.linalg.eigvalsh(self.K.real).max(axis=0)[::-1], shapes[:, ::-1]


def _same(block: _Block, known: list[tuple[_Block, Rows]], within: float) -> Rows | None:
    """Rows of another block that is this one but for signs, as a body of revolution has them."""
    for other, rows in known:
        if other.K.shape == block.K.shape:
            alike = (other.K[:, 0] * block.K[:, 0].conj()).real.sum(axis=0)
            sign = np.where(alike < 0.0, -1.0, 1.0)
            apart = (sign[:, None] * other.K * sign - block.K) / block.largest
            if np.abs(apart).max() < within:
                return Rows(rows.a, rows.b, rows.G * sign)
    return None


def _fit_block(block: _Block, tolerance: float, most: int) -> Rows:
    """The rows of the fewest sections that do; their number is the rank of the damping."""
    power, shapes = block.waves()
    middle = block.middle
    count = max(1, int((power > 0.5 * tolerance * power[0]).sum()))
    amplitude = np.sqrt(2.0 * np.maximum(power[:count], 0.0))[:, None] * shapes.T[:count]
    best = last = None
    least, failures = np.inf, 0
    for q in range(2, most + 1):
        spreads = SPREADS if q < 4 else ()
        starts = [_start(amplitude, middle, q, *spread) for spread in spreads]
        if last is not None:
            starts += _grown_starts(block, last)
        last = _least(block, starts)
        distance = block.care[:, None, None] * np.abs(block.distance(last)[0])
        rms = float(np.sqrt((distance**2).mean()))
        if best is None or rms < least * FALLS:
            best, least, failures = last, rms, 0
        else:
            failures += 1
        if distance.max() < tolerance:
            return last
        if failures == PATIENCE:
            break
    assert best is not None
    return best


def _grown_starts(block: _Block, rows: Rows) -> list[Rows]:
    """Rows with one more section each: broad ones, and a narrow one where they are worst."""
    distance = block.care * np.abs(block.distance(rows)[0]).max(axis=(1, 2))
    worst = float(block.frequency[distance.argmax()])
    broad = [_grown(rows, block.middle * ratio, 0.5) for ratio in NEW_SECTIONS]
    return [*broad, _grown(rows, worst, NARROW)]


def _least(block: _Block, starts: list[Rows]) -> Rows:
    """The best of least-squares fits from some starts, looked for shortly and then polished."""
    found = [_solve(block, start, SEARCH, 1e-3) for start in starts]
    return _solve(block, min(found, key=lambda each: each[1])[0], POLISH, 1e-5)[0]


def _solve(block: _Block, start: Rows, most: int, ends: float) -> tuple[Rows, float]:
    """Least squares in at most so many steps, or until the cost falls by less than ``ends``."""
    r, q = start.a.shape
    data = (r, q, block.frequency, block.K, 1.0 / block.largest, block.care)
    least, bound = _bounds(start, block)
    out = least_squares(
        residuals, np.clip(parameters_of(start), least + 1e-9, bound - 1e-9), slopes, args=data,
        bounds=(least, bound), x_scale="jac", max_nfev=most, ftol=ends, xtol=1e-7, gtol=1e-12,
    )  # fmt: skip
    return Rows(*unpacked(out.x, r, q, len(block.scale))), float(out.cost)


def _bounds(rows: Rows, block: _Block) -> tuple[Array, Array]:
    """Least and largest parameters: no section rings where there are no data to say so."""
    n, whole = rows.a.size, parameters_of(rows).size
    least, bound = np.full(whole, -np.inf), np.full(whole, np.inf)
    least[:n] = np.log(block.frequency[0])
    bound[:n] = np.log(min(block.frequency[-1], FAR * block.middle))
    least[n : 2 * n], bound[n : 2 * n] = np.log(RATIOS)
    return least, bound


def _start(
    amplitude: Array, middle: float, q: int, low: float, high: float, damping: float
) -> Rows:
    """Sections from ``low`` to ``high`` times the middle frequency, of a damping ratio."""
    r = len(amplitude)
    own = np.tile(np.geomspace(low, high, q) * middle, (r, 1))
    b = 2.0 * damping * own
    G = np.zeros((r, q, 2, amplitude.shape[1]))
    G[:, :, 0] = (b / q)[..., None] * amplitude[:, None]
    y = 0.1 * (-1.0) ** np.arange(q)[:, None] * amplitude[:, None]
    y[:, -1] = -y[:, :-1].sum(axis=1)
    G[:, :, 1] = (own**2)[..., None] * y - b[..., None] * G[:, :, 0]
    return Rows(own**2, b, G.reshape(r, 2 * q, -1))


def _grown(rows: Rows, frequency: float, damping: float) -> Rows:
    """Rows with one more section each, of a damping ratio, which as yet does little."""
    r, _, m = rows.G.shape
    own, b = np.full((r, 1), frequency), np.full((r, 1), 2.0 * damping * frequency)
    size = 0.02 * damping * np.abs(rows.G[:, ::2]).mean(axis=1, keepdims=True)
    new = size * np.ones((r, 2, m))
    new[:, 1] *= -b[0]
    a, b = np.hstack([rows.a, own**2]), np.hstack([rows.b, b])
    return Rows(a, b, np.concatenate([rows.G, new], axis=1))


def _notes(error: Array, rms: Array, tolerance: float) -> tuple[str, ...]:
    """What a fit leaves above its tolerance; ConvergenceError where that is far too much."""
    names = ("surge", "sway", "heave", "roll", "pitch", "yaw")
    worst = np.unravel_index(error.argmax(), error.shape)
    if error[worst] > LARGEST_ERROR and rms[worst] > 0.1 * LARGEST_ERROR:
        what = f"no passive fit comes nearer than {error[worst]:.0%} in {names[worst[0]]}"
        hint = "check added mass and damping of the database: do they belong together?"
        raise ConvergenceError("radiation", what, hint)
    return tuple(_excess(names, error, rms, tolerance))


def _excess(names: tuple[str, ...], error: Array, rms: Array, tolerance: float) -> Iterator[str]:
    for i, j in zip(*np.triu_indices(6), strict=True):
        if error[i, j] > tolerance:
            yield (
                f"radiation of {names[i]}-{names[j]}: the fit is off by at most "
                f"{error[i, j]:.1%} of the largest value (root mean square {rms[i, j]:.2%})"
            )
