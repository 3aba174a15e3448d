"""From a spectrum to the waves of a sea."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import pi
from typing import Literal

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError
from galerna.hydro.waves.series import Complex
from galerna.hydro.waves.spreading import directions

Amplitudes = Literal["random_phase", "white_noise"]
Density = Callable[[Array], Array]

_OF_WAVES = 0x5EA  #: sets the sea's random numbers apart from the wind's of the same seed
LOWEST, HIGHEST = 0.5, 6.0  #: of the peak's frequency: 2e-9 of the variance below, 0.1 % above
SHORTEST = 1200.0  #: s, of a run for which a sea is made
LONGEST_STEP = 2.0 * pi / 600.0  #: rad/s between two waves: also short runs resolve the peak


@dataclass(frozen=True)
class Band:
    """Frequencies rad/s that a sea holds: multiples of 2 pi / ``period`` from lowest to highest."""

    lowest: float
    highest: float
    period: float

    def frequencies(self) -> Array:
        """Frequencies (n,) rad/s. Raises InputError where there is none."""
        step = 2.0 * pi / self.period
        order = np.arange(max(np.ceil(self.lowest / step), 1.0), self.highest / step)
        if not len(order):
            figures = f"{self.lowest:.4g} and {self.highest:.4g} rad/s"
            raise InputError(
                "sea.waves", f"no frequency stands between {figures}", "widen the band"
            )
        return step * order


def repeat_after(duration: float, peak_period: float) -> float:
    """Period s of a sea that does not repeat in a run of ``duration`` s, nor near its end.

    Runs of up to ``SHORTEST`` s meet the beginning of the same sea.
    """
    return max(max(duration, SHORTEST) + 10.0 * peak_period, 2.0 * pi / LONGEST_STEP)


def random_generator(seed: int) -> np.random.Generator:
    """Generator for a seed of either sign; the same seed gives the same numbers."""
    entropy = [_OF_WAVES, abs(int(seed)), int(seed < 0)]
    return np.random.Generator(np.random.Philox(np.random.SeedSequence(entropy)))


def random_amplitudes(variance: Array, kind: Amplitudes, generator: np.random.Generator) -> Complex:
    """Amplitudes (n,) m of waves that have a ``variance`` (n,) m2 each.

    ``random_phase``: sqrt(2 variance) with a random phase, so that every sea has the
    spectrum's own variance. ``white_noise``: both parts are normal with that variance, so that
    the sea is Gaussian and spectrum and variance are met on average over the seeds alone.
    """
    if kind == "random_phase":
        phase = generator.uniform(0.0, 2.0 * pi, len(variance))
        return np.asarray(np.sqrt(2.0 * variance) * np.exp(1j * phase))
    real, imaginary = generator.standard_normal((2, len(variance)))
    return np.asarray(np.sqrt(variance) * (real + 1j * imaginary))


def irregular(
    density: Density,
    band: Band,
    *,
    amplitudes: Amplitudes = "random_phase",
    direction: float = 0.0,
    spreading_exponent: float | None = None,
    seed: int = 0,
) -> tuple[Array, Array, Complex]:
    """Frequency (n,) rad/s, direction (n,) rad and amplitude (n,) m of one sea of a spectrum.

    ``density`` gives m2 s/rad of rad/s; ``direction`` rad is the mean one;
    ``spreading_exponent`` is s of cos^2s of half the angle, None for long crests. The same
    seed gives the same phases whatever the spreading.
    """
    generator = random_generator(seed)
    frequency = band.frequencies()
    variance = density(frequency) * 2.0 * pi / band.period
    amplitude = random_amplitudes(variance, amplitudes, generator)
    course = np.full(len(frequency), direction)
    if spreading_exponent is not None:
        course = directions(len(frequency), direction, spreading_exponent, generator)
    return frequency, course, amplitude
