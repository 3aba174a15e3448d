"""One elastic line at rest in still water: forces at its ends and how they change with the ends.

A vertical plane; the line runs from A to B, ``distance`` x apart, at heights a and b above the
seabed. H and V are the components of its tension towards B and up; V grows by the weight w per
metre of unstretched length. Equations are those of docs/theory/mooring.md. Both kinds of line
are found from one unknown with one root in a known interval, by Newton's method kept inside it:
without a warm start, to rounding, so that a force depends on nothing but where the ends are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from galerna.contract import Array

FAST = {"reassoc", "contract", "arcp", "nsz", "afn"}
CLOSEST = 1e-9  #: of the length: nearer ends count as so far apart, the force along their offset
STEPS = 100  #: of an iteration; Newton takes 3 to 8
QUADRATIC = 1e-8  #: relative step after which one more changes only the rounding

#: what ``solve`` fills: components at A and B, and the length that rests
HORIZONTAL_A, VERTICAL_A, HORIZONTAL_B, VERTICAL_B, RESTING = range(5)


@dataclass(frozen=True, eq=False)
class Catenary:
    """A line at rest. Tension towards B: components N at A and B; ``resting`` m on the seabed.

    ``stiffness`` (4,3) N/m: the four components over x, a and b.
    """

    horizontal_a: float
    vertical_a: float
    horizontal_b: float
    vertical_b: float
    resting: float
    stiffness: Array

    @property
    def tension_a(self) -> float:
        """Tension N at A."""
        return float(np.hypot(self.horizontal_a, self.vertical_a))

    @property
    def tension_b(self) -> float:
        """Tension N at B."""
        return float(np.hypot(self.horizontal_b, self.vertical_b))


def catenary(
    distance: float,
    rise: float,
    length: float,
    weight: float,
    stiffness: float,
    *,
    friction: float = 0.0,
    height: float | None = 0.0,
) -> Catenary:
    """A line whose end B is ``distance`` m away from A and ``rise`` m above it.

    ``length`` m is unstretched, ``weight`` N/m in water (a buoyant line's is negative),
    ``stiffness`` EA N. ``height`` m is that of A above the seabed, None without one;
    ``friction`` acts where the line rests as far as A.
    """
    forces, slopes = np.zeros(5), np.zeros((4, 3))
    rests = height is not None
    low = 0.0 if height is None else height
    solve(distance, low, low + rise, length, weight, stiffness, friction, rests, forces, slopes)
    low_H, low_V, high_H, high_V, resting = forces.tolist()
    return Catenary(low_H, low_V, high_H, high_V, resting, slopes)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def solve(
    x: float, a: float, b: float, length: float, weight: float, stiffness: float,
    friction: float, rests: bool, forces: Array, slopes: Array,
) -> None:  # fmt: skip
    """Fill ``forces`` (5,) and ``slopes`` (4,3), N/m over x, a and b; see the class Catenary.

    ``rests`` says that there is a seabed. A buoyant line is a heavy one upside down, and
    rests nowhere. Ends below the seabed count as on it where the line rests.
    """
    x = max(x, CLOSEST * length)
    if weight < 0.0:
        _hang(x, a - b, length, -weight, stiffness, forces, slopes)
        _turn_over(forces, slopes)
    elif not rests or not _lie(
        x, max(a, 0.0), max(b, 0.0), length, weight, stiffness, friction, forces, slopes
    ):
        _hang(x, b - a, length, weight, stiffness, forces, slopes)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _turn_over(forces: Array, slopes: Array) -> None:
    """From a line upside down to the line: V changes its sign, and so do the heights."""
    forces[VERTICAL_A], forces[VERTICAL_B] = -forces[VERTICAL_A], -forces[VERTICAL_B]
    for i in range(4):
        vertical = i in (VERTICAL_A, VERTICAL_B)
        for j in range(3):
            if vertical != (j > 0):
                slopes[i, j] = -slopes[i, j]


# -- a line that hangs --------------------------------------------------------------------


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _start(X: float, Z: float, e: float) -> float:
    """A first s: of a line that sags, of one that is stretched, or of one between the two."""
    between = np.cbrt(6.0 * e)
    chord = np.sqrt(X * X + Z * Z)
    if chord >= 1.0:
        return min(e / max(chord - 1.0, 1e-300), between)
    sag = np.sqrt((1.0 - Z) * (1.0 + Z)) / X
    if sag < 2.0:
        return max(np.sqrt(6.0 * (sag - 1.0)), between)
    return sag * np.log(2.0 * sag)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _hanging(X: float, Z: float, e: float) -> tuple[float, float, float, float]:
    """s = sinh(lambda), lambda, tanh(m) and sech(m) of eq. (5), by eq. (6).

    ``X`` and ``Z`` are distance and rise over the length, ``e`` = w L / (2 EA). The left side
    of eq. (6) rises with s from below 0 to above it within the bounds.
    """
    low = e / np.sqrt(X * X + Z * Z)
    high = 4.0 / X * (1.0 / X + e)
    s = min(max(_start(X, Z, e), low), high)
    for _ in range(STEPS):
        c, lag = np.sqrt(1.0 + s * s), np.arcsinh(s)
        p, q = Z * s / (s + e * c), X * s / (lag + e)
        norm = p * p + q * q
        misfit = 0.5 * np.log(norm)
        slope = (p * p * e / (c * (s + e * c)) + q * q * (1.0 - s / (c * (lag + e)))) / norm
        if misfit > 0.0:
            high = s
        else:
            low = s
        step = -misfit / slope
        new = s * np.exp(min(max(step, -5.0), 5.0))
        if abs(step) < QUADRATIC:
            s = new
            break
        s = new if low < new < high else np.sqrt(low * high)
    lag = np.arcsinh(s)
    return s, lag, Z * s / (s + e * np.sqrt(1.0 + s * s)), X * s / (lag + e)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _hang(
    x: float, z: float, length: float, weight: float, stiffness: float, forces: Array, slopes: Array
) -> None:
    """A heavy line that touches nothing: eqs. (5) to (8)."""
    half = 0.5 * weight * length
    e = half / stiffness
    s, lag, p, q = _hanging(x / length, z / length, e)
    c = np.sqrt(1.0 + s * s)
    forces[HORIZONTAL_A] = forces[HORIZONTAL_B] = 0.5 * weight * x / (lag + e)
    forces[VERTICAL_A], forces[VERTICAL_B] = half * (p * c / s - 1.0), half * (p * c / s + 1.0)
    forces[RESTING] = 0.0
    both = 2.0 * q / (1.0 + q * q * s * s)
    xx, zz = 2.0 * (lag + e) - both * q * s * c, both * q * s * c + 2.0 * e
    xz = -both * p * s
    scale = weight / (xx * zz - xz * xz)
    for end in (HORIZONTAL_A, HORIZONTAL_B):
        slopes[end, 0], slopes[end, 1], slopes[end, 2] = scale * zz, scale * xz, -scale * xz
        slopes[end + 1, 0], slopes[end + 1, 1] = -scale * xz, -scale * xx
        slopes[end + 1, 2] = scale * xx


# -- a line that rests on the seabed -------------------------------------------------------


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _lifted(H: float, h: float, weight: float, stiffness: float) -> tuple[float, float, float]:
    """Tension S and V at the height h of a line that leaves the seabed with H, and dV/dH; (9)."""
    if h <= 0.0:
        return H, 0.0, 0.0
    over = 2.0 * stiffness * weight * h
    rise = over / (np.sqrt((stiffness + H) ** 2 + over) + stiffness + H)
    S = H + rise
    V = np.sqrt(rise * (S + H))
    return S, V, stiffness * V / ((stiffness + S) * (S + H))


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _reach(H: float, S: float, V: float, VH: float) -> tuple[float, float]:
    """w times what a lifted part gains over its length in reach, but for stretch; d/dH of it."""
    if V <= 0.0:
        return 0.0, 0.0
    lag = np.arcsinh(V / H)
    return H * lag - V, lag - V / S - VH * (S - H) / S


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _dragged(H: float, ground: float, drag: float) -> tuple[float, float, float]:
    """EA times the stretch that friction takes from a resting part, and d/dH, d/dground of it.

    ``drag`` N/m is the friction; the part beyond H / drag has no tension.
    """
    if drag <= 0.0 or ground <= 0.0:
        return 0.0, 0.0, 0.0
    loose = max(ground - H / drag, 0.0)
    return 0.5 * drag * (ground - loose) * (ground + loose), loose, drag * (ground - loose)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _first_pull(x: float, a: float, b: float, length: float, weight: float) -> float:
    """A first H: of an inextensible line, from how far it is drawn from slack to straight."""
    h = max(a + b, 1e-9 * length)
    drawn = min(max((x - length + h) / h, 1e-9), 0.98)
    return weight * h * 2.0 / 9.0 * (1.0 / (1.0 - drawn) ** 2 - 1.0)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _pull(
    x: float, a: float, b: float, length: float, weight: float, stiffness: float, drag: float
) -> float:
    """H of a line that rests somewhere, eq. (10); -1 where it has no length left to rest."""
    _, slack_a, _ = _lifted(0.0, a, weight, stiffness)
    _, slack_b, _ = _lifted(0.0, b, weight, stiffness)
    spare = length - (slack_a + slack_b) / weight
    if spare <= 0.0:
        return -1.0
    if x <= spare:
        return 0.0
    low, high = 0.0, stiffness * x / length + drag * length
    H = min(_first_pull(x, a, b, length, weight), high)
    for _ in range(STEPS):
        Sa, Va, VaH = _lifted(H, a, weight, stiffness)
        Sb, Vb, VbH = _lifted(H, b, weight, stiffness)
        ground = length - (Va + Vb) / weight
        (gain_a, slope_a), (gain_b, slope_b) = _reach(H, Sa, Va, VaH), _reach(H, Sb, Vb, VbH)
        held, by_H, by_ground = _dragged(H, ground, drag)
        misfit = length - x + (gain_a + gain_b) / weight + (H * length - held) / stiffness
        if misfit < 0.0:
            if ground <= 0.0:
                return -1.0
            low = H
        else:
            high = H
        slope = (slope_a + slope_b) / weight + (length - by_H) / stiffness
        slope += by_ground * (VaH + VbH) / (weight * stiffness)
        new = H - misfit / slope
        if abs(new - H) <= QUADRATIC * H:
            H = new
            break
        H = new if low < new < high else (0.5 * (low + high) if low > 0.0 else 0.1 * H)
    return H


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _lie(
    x: float, a: float, b: float, length: float, weight: float, stiffness: float, friction: float,
    forces: Array, slopes: Array,
) -> bool:  # fmt: skip
    """A heavy line that rests somewhere between its ends; False where it does not."""
    drag = friction * weight if a == 0.0 else 0.0
    H = _pull(x, a, b, length, weight, stiffness, drag)
    if H < 0.0:
        return False
    Sa, Va, VaH = _lifted(H, a, weight, stiffness)
    Sb, Vb, VbH = _lifted(H, b, weight, stiffness)
    ground = length - (Va + Vb) / weight
    if ground < 0.0:
        return False
    forces[HORIZONTAL_A], forces[HORIZONTAL_B] = max(H - drag * ground, 0.0), H
    forces[VERTICAL_A], forces[VERTICAL_B], forces[RESTING] = -Va, Vb, ground
    by_a, by_b = _raised(Sa, Va, weight, stiffness), _raised(Sb, Vb, weight, stiffness)
    _, by_H, by_ground = _dragged(H, ground, drag)
    take = by_ground / (weight * stiffness)
    pull = np.zeros(3)
    if H > 0.0:
        slope = (_reach(H, Sa, Va, VaH)[1] + _reach(H, Sb, Vb, VbH)[1]) / weight
        slope += (length - by_H) / stiffness + take * (VaH + VbH)
        pull[0], pull[1], pull[2] = 1.0, VaH - take * by_a, VbH - take * by_b
        pull /= slope
    for j in range(3):
        down = VaH * pull[j] + (by_a if j == 1 else 0.0)
        up = VbH * pull[j] + (by_b if j == 2 else 0.0)
        slopes[VERTICAL_A, j], slopes[VERTICAL_B, j] = -down, up
        slopes[HORIZONTAL_B, j] = pull[j]
        slopes[HORIZONTAL_A, j] = 0.0
        if forces[HORIZONTAL_A] > 0.0:
            slopes[HORIZONTAL_A, j] = pull[j] + drag * (down + up) / weight
    return True


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _raised(S: float, V: float, weight: float, stiffness: float) -> float:
    """dV/dh of a lifted part at a given H; none of an end that rests."""
    return S * stiffness * weight / ((stiffness + S) * V) if V > 0.0 else 0.0
