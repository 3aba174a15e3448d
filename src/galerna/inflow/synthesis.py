"""What the generators of turbulence boxes share: seed, checks, the way back from modes."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from galerna.errors import InputError, did_you_mean
from galerna.inflow.box import Block

Modes = NDArray[np.complex64]
#: Fourier modes over x in the memory of the box they make, (3,nx/2,2,ny,nz): the real and the
#: imaginary part of mode n at [:, n]. The mean, mode 0, is zero, and so is the highest, nx/2,
#: which has no place here.
HalfSpectrum = NDArray[np.float32]

#: Of what a standard deviation is meant: ``"theory"``, of the whole spectrum, so that a box
#: lacks what its length and spacing leave out; ``"box"``, of what a box of this length and
#: spacing has on average over the seeds; ``"sample"``, of this very box, on average over it.
Normalisation = Literal["theory", "box", "sample"]
NORMALISATIONS = ("theory", "box", "sample")

_MOST_POINTS = 1 << 30  #: a box of 12 GB
_POINTS_AT_ONCE = 32  #: of (y, z), brought from modes to space together


def random_generator(seed: int) -> np.random.Generator:
    """Generator for a seed of either sign; the same seed gives the same numbers."""
    entropy = [abs(int(seed)), int(seed < 0)]
    return np.random.Generator(np.random.Philox(np.random.SeedSequence(entropy)))


def require_positive(where: str, **figures: float) -> None:
    """Raise InputError unless every figure is finite and greater than zero."""
    for name, value in figures.items():
        if not (math.isfinite(value) and value > 0.0):
            label = name.replace("_", " ")
            raise InputError(where, f"{label} is {value:g}, expected a positive number")


def require_one(where: str, **arguments: object) -> None:
    """Raise InputError unless exactly one of the arguments is given."""
    given = [name for name, value in arguments.items() if value is not None]
    if len(given) != 1:
        found = " and ".join(given) if given else "none"
        raise InputError(where, f"expected one of {', '.join(arguments)}; found {found}")


def require_name(where: str, name: str, value: str, valid: tuple[str, ...]) -> None:
    """Raise InputError unless ``value`` is one of the valid ones."""
    if value not in valid:
        raise InputError(where, f"{name} is {value!r}", did_you_mean(str(value), valid))


def require_grid(
    where: str, shape: tuple[int, int, int], spacing: tuple[float, float, float]
) -> None:
    """Raise InputError unless a box of this shape can be made: nx even and at least 4."""
    if len(shape) != 3 or shape[0] < 4 or shape[0] % 2 or min(shape[1:]) < 2:
        raise InputError(
            where,
            f"shape is {tuple(shape)}, expected (nx, ny, nz) with nx even and at least 4, "
            "ny and nz at least 2",
        )
    if math.prod(shape) > _MOST_POINTS:
        raise InputError(
            where,
            f"{' x '.join(map(str, shape))} points are {math.prod(shape):,}, "
            f"expected at most {_MOST_POINTS:,}",
            "take fewer points, or a coarser spacing",
        )
    dx, dy, dz = spacing
    require_positive(where, dx=dx, dy=dy, dz=dz)


def unit_variance(normalise: str, theory: float, expected: float, sample: Block) -> float:
    """The variance that is scaled to the target, m2/s2: see ``Normalisation``."""
    if normalise == "sample":
        planes = (np.square(plane).mean(dtype=np.float64) for plane in sample)
        return math.fsum(planes) / len(sample)
    return theory if normalise == "theory" else expected


def no_modes(shape: tuple[int, int, int]) -> HalfSpectrum:
    """A half spectrum without energy, of a box with (nx, ny, nz) points."""
    nx, ny, nz = shape
    return np.zeros((3, nx // 2, 2, ny, nz), dtype=np.float32)


def to_space(spectrum: HalfSpectrum) -> Block:
    """Velocities (3,nx,ny,nz) of a half spectrum, which they replace in its memory.

    With E|X_n|^2 of the mode n, the variance is the sum of 2 E|X_n|^2 over n > 0.
    """
    _, half, _, ny, nz = spectrum.shape
    columns = spectrum.reshape(3, half, 2, ny * nz)
    for component in columns:
        for first in range(0, ny * nz, _POINTS_AT_ONCE):
            _column_to_space(component[..., first : first + _POINTS_AT_ONCE])
    return spectrum.reshape(3, 2 * half, ny, nz)


def _column_to_space(column: HalfSpectrum) -> None:
    """The same for some points (nx/2,2,n) of one component, in place."""
    half, _, count = column.shape
    modes = np.zeros((half + 1, count), dtype=np.complex64)
    modes.real[:-1], modes.imag[:-1] = column[:, 0], column[:, 1]
    velocity = fft.irfft(modes, axis=0, norm="forward")
    column[:] = velocity.reshape(column.shape)
