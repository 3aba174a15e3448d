"""A line at rest in its own plane: elastic, heavy or buoyant, hanging or resting on the seabed.

With the horizontal tension H and the vertical one V at the upper end B, over a line of length L,
weight w a metre and stiffness EA whose lower end is A (Jonkman, NREL/TP-500-41958 (2007),
eqs. 2-35 to 2-38; the dissertation's 2.103 and 2.104 lack parentheses in print), hanging,

    x = H/w (asinh(V/H) - asinh((V - wL)/H)) + H L/EA
    z = (sqrt(H^2 + V^2) - sqrt(H^2 + (V - wL)^2))/w + (V L - w L^2/2)/EA

and with L_B = L - V/w of it on the seabed, of friction C_B,

    x = L_B + H/w asinh(V/H) + H L/EA + C_B w/(2EA) (u max(u, 0) - L_B^2),  u = L_B - H/(C_B w)
    z = (sqrt(H^2 + V^2) - H)/w + V^2/(2 EA w)

Both are the gradient of the line's complementary energy, which is convex: z rises with V at a
constant H, and along z(H, V) = z the distance x rises with H. So there is one solution, and two
nested searches between bounds always find it; Newton's method is tried first.
"""

from __future__ import annotations

from math import asinh, inf, sqrt, tanh

import numpy as np
from numba import njit

from galerna.contract import Array

NEWTON_STEPS, SEARCH_STEPS = 20, 200
ROUNDING = 1e-13  #: of the line's length, to which distances are met
SMALLEST = 1e-12  #: of the line's weight and stiffness: a horizontal tension that counts as none


@njit(cache=True, error_model="numpy")
def distances(
    H: float, V: float, L: float, EA: float, w: float, friction: float
) -> tuple[float, float, float, float, float]:
    """Distances x, z m at tensions H > 0, V N, and dx/dH, dx/dV = dz/dH, dz/dV.

    ``friction`` below 0: there is no seabed.
    """
    top = sqrt(H * H + V * V)
    grounded = L - V / w
    if friction < 0.0 or grounded <= 0.0:
        low = V - w * L
        bottom = sqrt(H * H + low * low)
        bend = asinh(V / H) - asinh(low / H)
        x = H / w * bend + H * L / EA
        z = (top - bottom) / w + L * (V - 0.5 * w * L) / EA
        x_H = (bend - V / top + low / bottom) / w + L / EA
        return x, z, x_H, (H / top - H / bottom) / w, (V / top - low / bottom) / w + L / EA
    bend = asinh(V / H)
    x = grounded + H / w * bend + H * L / EA
    x_H, x_V = (bend - V / top) / w + L / EA, (H / top - 1.0) / w
    if friction > 0.0:
        held = grounded - H / (friction * w)
        loose = max(held, 0.0)
        x += friction * w / (2.0 * EA) * (held * loose - grounded * grounded)
        x_H -= loose / EA
        x_V += friction * (grounded - loose) / EA
    z = (top - H) / w + V * V / (2.0 * EA * w)
    return x, z, x_H, x_V, V / (w * top) + V / (EA * w)


@njit(cache=True, error_model="numpy")
def _vertical(
    H: float, z: float, L: float, EA: float, w: float, friction: float
) -> tuple[float, float]:
    """V at which z is met at a horizontal tension, and the distance x there."""
    low, high = (0.0, w * L) if friction >= 0.0 else (-w * L, w * L)
    step = w * L + EA * abs(z) / L
    while distances(H, high, L, EA, w, friction)[1] < z:
        high += step
        step *= 2.0
    while friction < 0.0 and distances(H, low, L, EA, w, friction)[1] > z:
        low -= step
        step *= 2.0
    V = 0.5 * (low + high)
    for _ in range(SEARCH_STEPS):
        _, found, _, _, slope = distances(H, V, L, EA, w, friction)
        if found > z:
            high = V
        else:
            low = V
        ahead = V - (found - z) / slope
        before, V = V, ahead if low < ahead < high else 0.5 * (low + high)
        if abs(V - before) <= 1e-15 * (abs(V) + w * L) or high - low <= 1e-15 * (abs(V) + w * L):
            break
    return V, distances(H, V, L, EA, w, friction)[0]


@njit(cache=True, error_model="numpy")
def _searched(
    x: float, z: float, L: float, EA: float, w: float, friction: float, least: float
) -> tuple[float, float]:
    """H and V by nested searches: x rises with H along the curve of constant z."""
    low, high = least, w * L + EA * (sqrt(x * x + z * z) / L) * 1e-3
    while _vertical(high, z, L, EA, w, friction)[1] < x:
        low = high
        high *= 4.0
    if _vertical(low, z, L, EA, w, friction)[1] >= x:
        return low, _vertical(low, z, L, EA, w, friction)[0]
    for _ in range(SEARCH_STEPS):
        H = sqrt(low * high)
        if _vertical(H, z, L, EA, w, friction)[1] < x:
            low = H
        else:
            high = H
        if high - low <= 1e-15 * high:
            break
    H = sqrt(low * high)
    return H, _vertical(H, z, L, EA, w, friction)[0]


@njit(cache=True, error_model="numpy")
def _newton(
    x: float, z: float, L: float, EA: float, w: float, friction: float, least: float
) -> tuple[float, float, bool]:
    """H and V by Newton's method from Jonkman's start, and whether it got there."""
    if x <= 0.0:
        return 0.0, 0.0, False
    spread = (L * L - z * z) / (x * x) - 1.0
    sag = 0.2 if spread <= 0.0 else sqrt(3.0 * spread)
    H, V = max(abs(0.5 * w * x / sag), least), 0.5 * w * (z / tanh(sag) + L)
    size, last = ROUNDING * (L + x + abs(z)), inf
    for _ in range(NEWTON_STEPS):
        found_x, found_z, x_H, x_V, z_V = distances(H, V, L, EA, w, friction)
        off_x, off_z = found_x - x, found_z - z
        error = abs(off_x) + abs(off_z)
        if error <= size or (error <= 1e2 * size and error >= last):
            return H, V, True
        last = error
        det = x_H * z_V - x_V * x_V
        if not det > 0.0:
            return H, V, False
        change = (off_x * z_V - off_z * x_V) / det
        V -= (off_z * x_H - off_x * x_V) / det
        H = H - change if change < 0.9 * H else 0.1 * H
        if friction >= 0.0 and V < 0.0:
            return H, V, False
    return H, V, False


@njit(cache=True, error_model="numpy")
def hang(x: float, z: float, L: float, EA: float, w: float, friction: float, out: Array) -> None:
    """Fill ``out`` (8,): H, V at the end B; H, V at A; length on the seabed; dH/dx, dH/dz, dV/dz.

    B stands x >= 0 and z m from A; ``friction`` is that of the seabed on which A lies, below 0
    where there is none. V and H are what pulls B towards A. w > 0; see ``solve`` for all lines.
    """
    least = SMALLEST * min(w * L, EA)
    if friction >= 0.0:
        # with a horizontal tension of nothing the line hangs down from B and lies in a heap
        V = w * z if inf == EA else EA * (sqrt(1.0 + 2.0 * w * z / EA) - 1.0)
        if w * L >= V and x <= L - V / w:
            out[:] = 0.0
            out[1], out[4] = V, L - V / w
            out[7] = w / (1.0 + V / EA)
            return
    H, V, found = _newton(x, z, L, EA, w, friction, least)
    if not found:
        H, V = _searched(x, z, L, EA, w, friction, least)
    _, _, x_H, x_V, z_V = distances(H, V, L, EA, w, friction)
    grounded = max(L - V / w, 0.0) if friction >= 0.0 else 0.0
    out[0], out[1], out[4] = H, V, grounded
    out[2] = max(H - friction * w * grounded, 0.0) if grounded > 0.0 else H
    out[3] = 0.0 if grounded > 0.0 else V - w * L
    if grounded > 0.0 and V <= 0.0:  # all of it on the seabed
        out[5], out[6], out[7] = 1.0 / x_H, 0.0, 0.0
        return
    det = x_H * z_V - x_V * x_V
    out[5], out[6], out[7] = z_V / det, -x_V / det, x_H / det


@njit(cache=True, error_model="numpy")
def solve(x: float, z: float, L: float, EA: float, w: float, friction: float, out: Array) -> None:
    """As ``hang`` for lines of any weight: buoyant ones hang upwards, weightless ones are straight.

    A line without weight that is longer than its distance is slack.
    """
    if w > 0.0:
        hang(x, z, L, EA, w, friction, out)
    elif w < 0.0:
        hang(x, -z, L, EA, -w, -1.0, out)
        out[1], out[3], out[6] = -out[1], -out[3], -out[6]
    else:
        out[:] = 0.0
        reach = sqrt(x * x + z * z)
        if reach <= L:
            return
        pull, cx, cz = EA * (reach / L - 1.0), x / reach, z / reach
        out[0] = out[2] = pull * cx
        out[1] = out[3] = pull * cz
        along, across = EA / L, pull / reach
        out[5] = along * cx * cx + across * cz * cz
        out[6] = (along - across) * cx * cz
        out[7] = along * cz * cz + across * cx * cx


def catenary(
    x: float, z: float, length: float, stiffness: float, weight: float, friction: float = -1.0
) -> dict[str, float]:
    """Tensions N of one line at its ends, and how they change with the distances x >= 0, z m.

    ``length`` m unstretched, ``stiffness`` EA N, ``weight`` N/m; ``friction`` of the seabed on
    which the lower end lies, below 0 where the line hangs free.
    """
    out = np.zeros(8)
    solve(x, z, length, stiffness, weight, friction, out)
    names = ("H", "V", "anchor_H", "anchor_V", "grounded", "H_x", "H_z", "V_z")
    return dict(zip(names, out.tolist(), strict=True))
