"""A sea of one direction from an elevation that was measured or made elsewhere."""

from __future__ import annotations

import csv
from math import inf, pi
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicHermiteSpline

from galerna.contract import Array
from galerna.errors import InputError
from galerna.hydro.waves.series import Complex

_EVEN = 1e-3  #: of a step, by which steps may differ
_BRIDGE = 30.0  #: s from the end of a series back to its start, so that its waves are periodic


def read_elevation(path: Path) -> tuple[Array, Array]:
    """Times (p,) s and elevations (p,) m from the first two columns of a CSV file.

    Lines before the first pair of numbers are headings. Raises InputError for a file that
    cannot be read or holds something else below them.
    """
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(str(path), f"cannot be read: {error}") from None
    rows: list[tuple[float, float]] = []
    for number, line in enumerate(lines, start=1):
        pair = _pair(line)
        if pair is not None:
            rows.append(pair)
        elif rows and line.strip():
            what = f"expected time s and elevation m, found {line.strip()[:40]!r}"
            raise InputError(f"{path}, line {number}", what)
    if not rows:
        raise InputError(str(path), "holds no line with time s and elevation m")
    time, elevation = np.array(rows).T
    return time, elevation


def _pair(line: str) -> tuple[float, float] | None:
    separator = next((c for c in ",;\t" if c in line), " ")
    cells = [cell for cell in next(csv.reader([line.strip()], delimiter=separator), []) if cell]
    try:
        return float(cells[0]), float(cells[1])
    except (ValueError, IndexError):
        return None


def from_elevation(
    time: ArrayLike,
    elevation: ArrayLike,
    *,
    duration: float = 0.0,
    lowest: float = 0.0,
    highest: float = inf,
    where: str = "sea.waves",
) -> tuple[Array, Complex, float, float]:
    """Frequency (n,) rad/s, amplitude (n,) m, period s and the mean m that is left out.

    The waves give the elevations (p,) m at even times (p,) s exactly, but for the mean and for
    what is outside ``lowest`` to ``highest`` rad/s; behind the end a curve of 30 s leads back
    to the start. Raises InputError for uneven times, and where they do not cover a run from 0
    to ``duration`` s.
    """
    t, eta = np.asarray(time, dtype=float), np.asarray(elevation, dtype=float)
    step = _even_step(t, eta, where)
    if t[0] > 0.0 or t[-1] < duration:
        given = f"the elevation is given from {t[0]:g} to {t[-1]:g} s"
        what = f"{given}, the run is from 0 to {duration:g} s"
        raise InputError(where, what, "shorten the run or give more of it")
    mean = float(eta.mean())
    closed = _closed(eta - mean, step)
    period = step * len(closed)
    amplitude = 2.0 * np.fft.rfft(closed, norm="forward")
    frequency: Array = 2.0 * pi / period * np.arange(len(amplitude), dtype=float)
    if len(closed) % 2 == 0:
        amplitude[-1] *= 0.5
    inside = (frequency >= lowest) & (frequency <= highest)
    inside[0] = False
    shifted: Complex = amplitude * np.exp(-1j * frequency * t[0])
    return frequency[inside], shifted[inside], period, mean


def _even_step(t: Array, eta: Array, where: str) -> float:
    """The step s of even times; raises InputError for anything else."""
    if len(t) != len(eta) or len(t) < 4:
        what = f"{len(t)} times and {len(eta)} elevations; expected as many of both, 4 at least"
        raise InputError(where, what)
    if not (np.isfinite(t).all() and np.isfinite(eta).all()):
        raise InputError(where, "a time or an elevation is not a number")
    step = float(t[-1] - t[0]) / (len(t) - 1)
    worst = float(np.abs(np.diff(t) - step).max())
    if step <= 0.0 or worst > _EVEN * step:
        what = (
            f"times must rise in even steps; they differ by up to {worst:.3g} s from {step:.6g} s"
        )
        raise InputError(where, what, "sample the elevation evenly")
    return step


def _closed(eta: Array, step: float) -> Array:
    """A series without a mean and the way from its end to its start, which has none either."""
    steps = max(round(_BRIDGE / step), 4)
    end_slope, start_slope = (eta[-1] - eta[-2]) / step, (eta[1] - eta[0]) / step
    way = CubicHermiteSpline([0.0, steps * step], [eta[-1], eta[0]], [end_slope, start_slope])
    s = np.arange(1, steps) / steps
    back, bump = way(steps * step * s), (s * (1.0 - s)) ** 2
    return np.concatenate([eta, back - bump * (back.sum() / bump.sum())])
