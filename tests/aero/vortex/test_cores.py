"""Growth of vortex cores."""

from __future__ import annotations

import numpy as np
import pytest

from galerna.aero.vortex.cores import LAMB_OSEEN, VortexCore
from galerna.errors import InputError


def test_the_swirl_of_lamb_and_oseen_is_largest_at_the_core_radius() -> None:
    assert np.exp(LAMB_OSEEN) == pytest.approx(1.0 + 2.0 * LAMB_OSEEN, rel=1e-5)


def test_a_core_starts_at_its_radius_and_its_square_grows_linearly() -> None:
    core = VortexCore(initial_radius=0.3)
    radius = core.radius(np.array([0.0, 10.0, 20.0]), 80.0)
    assert radius[0] == 0.3
    growth = np.diff(radius**2)
    assert growth[0] == pytest.approx(growth[1])
    assert growth[0] == pytest.approx(10.0 * 4.0 * LAMB_OSEEN * (1.46e-5 + 1e-4 * 80.0))


def test_a_laminar_core_forgets_the_circulation() -> None:
    core = VortexCore(0.0, turbulence=0.0)
    assert core.radius(5.0, 100.0) == core.radius(5.0, -1.0)


@pytest.mark.parametrize("value", [-1.0, float("nan")])
def test_a_core_of_no_size_is_refused(value: float) -> None:
    with pytest.raises(InputError, match="initial_radius"):
        VortexCore(value)
