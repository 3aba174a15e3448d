"""No load beyond the trailing edge: rings reach a quarter of a panel into the wake."""

from __future__ import annotations

import numpy as np
import pytest

from galerna.aero.vortex.loads import SurfaceLoads, lattice_loads
from galerna.aero.vortex.surface import Surface, segment_points
from galerna.aero.vortex.wings import trapezoidal_wing


def loads(panels: int, rings: str, circulation: float, wind: float, rate: float) -> SurfaceLoads:
    """Loads of a flat wing 4 m by 1 m, leading edge at x = 0, in a wind along its span."""
    corners = trapezoidal_wing(4.0, 1.0, panels, 2, spanwise_spacing="uniform")
    surface = Surface.at_rest(corners + np.array([0.25, 0.0, 0.0]), rings)
    velocity = np.zeros_like(segment_points([surface]))
    velocity[:, 1] = wind
    strength = [np.outer(np.full(panels, circulation), [1.0, 0.0])]  # one strip of rings alone
    return lattice_loads([surface], strength, velocity, 1.0, [np.full((panels, 2), rate)])[0]


@pytest.mark.parametrize("panels", [1, 4])
def test_pressure_of_a_growing_circulation_acts_on_the_plate_alone(panels: int) -> None:
    load = loads(panels, "quarter_chord", 0.0, 0.0, 3.0)
    share = np.ones(panels)
    share[0] = 0.5  # the jump of the potential begins in the middle of the first panel
    middles = (np.arange(panels) + 0.5) / panels
    assert load.force == pytest.approx([0.0, 0.0, 3.0 * 4.0 * share.mean()])
    arm = -load.moment()[1] / load.force[2]
    assert arm == pytest.approx((share * middles).sum() / share.sum())
    assert load.strip_force.sum(axis=0) == pytest.approx(load.force)
    assert loads(panels, "edges", 0.0, 0.0, 3.0).force[2] == pytest.approx(3.0 * 4.0)


@pytest.mark.parametrize("panels", [1, 4])
def test_wind_along_the_span_loads_chordwise_vortices_up_to_the_trailing_edge(panels: int) -> None:
    load = loads(panels, "quarter_chord", 2.0, 5.0, 0.0)
    front = 0.25 / panels
    # The strip's two sides carry opposite vortices in the same wind: a pure rolling moment.
    assert load.force == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)
    assert abs(load.moment()[0]) == pytest.approx(2.0 * 5.0 * (1.0 - front) * 2.0)
