"""Interpolation over frequency and heading: values are weights times those of the base."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from galerna.contract import Array
from galerna.errors import InputError
from galerna.units import DEG

TURN = 2.0 * np.pi
_WHERE = "hydrodynamic database"


def curve_weights(base: Array, asked: Array, failed: Array) -> tuple[Array, Array]:
    """Weights (q,n) of the base's frequencies (n,) at ``asked`` (q,), both rad/s.

    Cubic spline; below the first frequency a straight line to zero frequency, whose weight
    (q,) comes beside. Raises InputError outside 0 to the last frequency and where rows failed.
    """
    asked = np.asarray(asked, dtype=float)
    refuse_failed(failed, "interpolated")
    if asked.size and (asked.min() < 0.0 or asked.max() > base[-1] * (1.0 + 1e-12)):
        raise InputError(
            _WHERE,
            f"frequencies from {asked.min():.4g} to {asked.max():.4g} rad/s are asked for, it "
            f"holds 0 to {base[-1]:.4g} rad/s",
            "compute it up to higher frequencies (galerna hydro --last-frequency)",
        )
    spline = CubicSpline(base, np.eye(len(base))) if len(base) > 1 else np.ones_like
    low = np.minimum(asked / base[0], 1.0)
    weights = np.asarray(spline(np.clip(asked, base[0], base[-1]))).reshape(len(asked), -1)
    return weights * low[:, None], 1.0 - low


def refuse_failed(failed: Array, verb: str) -> None:
    if len(failed):
        listed = ", ".join(f"{w:.4g}" for w in failed[:8]) + (", ..." if len(failed) > 8 else "")
        raise InputError(
            _WHERE,
            f"cannot be {verb}: {len(failed)} frequencies were not solved ({listed} rad/s)",
            "compute it again with a finer mesh, or without these frequencies",
        )


def whole_circle(heading: Array) -> bool:
    """Whether headings (m,) rad leave no gap above 61 degrees around the circle."""
    around = np.sort(np.mod(heading, TURN))
    gaps = np.diff(np.append(around, around[0] + TURN))
    return bool(len(heading) > 1 and gaps.max() <= 61.0 * DEG)


def heading_weights(base: Array, asked: Array) -> Array:
    """Weights (q,m) of the base's headings (m,) at ``asked`` (q,), both rad.

    Periodic cubic spline where the base goes round; else a spline between its first and last
    heading, where angles that differ by whole turns are the same. Raises InputError outside.
    """
    if whole_circle(base):
        return _around(base, asked)
    turned = base[0] + np.mod(asked - base[0] + 1e-9, TURN) - 1e-9
    beyond = turned > base[-1] + 1e-9
    if beyond.any():
        missing = np.mod(asked[beyond][0] / DEG + 180.0, 360.0) - 180.0
        raise InputError(
            _WHERE,
            f"waves go towards {missing:.4g} deg, it holds headings from {base[0] / DEG:.4g} to "
            f"{base[-1] / DEG:.4g} deg",
            "compute it for headings that go round (galerna hydro), turn the sea, or say "
            "`heading: fixed` where only the platform's yaw asks for them",
        )
    if len(base) == 1:
        return np.ones((len(asked), 1))
    return np.asarray(CubicSpline(base, np.eye(len(base)))(turned))


def _around(base: Array, asked: Array) -> Array:
    """Weights of a periodic spline; a heading that comes twice, a turn apart, counts once."""
    around, first = np.unique(np.round(np.mod(base, TURN), 9) % round(TURN, 9), return_index=True)
    values = np.eye(len(base))[first]
    knots = np.append(around, around[0] + TURN)
    spline = CubicSpline(knots, np.append(values, values[:1], axis=0), bc_type="periodic")
    return np.asarray(spline(np.mod(asked - around[0], TURN) + around[0]))
