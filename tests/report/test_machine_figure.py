"""The pictures and figures of a machine that moves."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray

from galerna.report import machine_figure, plot_result
from galerna.report.tables import statistics


def result() -> xarray.Dataset:
    """Ten records of a machine, its tower's moment among them."""
    time = np.linspace(0.0, 1.0, 10)
    wave = np.sin(6.0 * time)
    blades = {"long_name": "out-of-plane blade-root moment", "units": "N m"}
    return xarray.Dataset(
        {
            "rotor_speed": ("time", 1.2 + 0.01 * wave, {"units": "rad/s"}),
            "electrical_power": ("time", 5e6 + 1e5 * wave, {"units": "W"}),
            "blade_root_out_of_plane_moment": (
                ("time", "blade"), 1e7 + 1e6 * np.outer(wave, [1.0, 0.5, 0.2]), blades,
            ),
            "tower_base_fore_aft_moment": ("time", 5e7 + 1e6 * wave, {"units": "N m"}),
        },
        coords={"time": time, "blade": [1, 2, 3]},
        attrs={"case_name": "made up", "turbine": "none"},
    )  # fmt: skip


def test_the_machine_s_picture_has_a_panel_for_every_channel_it_finds() -> None:
    figure = machine_figure(result())
    titles = [ax.get_title(loc="left") for ax in figure.axes]
    assert len(titles) == 4
    assert titles[2] == "Out-of-plane blade-root moment [MN m]"
    assert len(figure.axes[2].lines) == 3


def test_a_moving_machine_gets_its_picture_beside_the_rotor_s(tmp_path: Path) -> None:
    names = [path.name for path in plot_result(result(), tmp_path)]
    assert names[:2] == ["machine.png", "rotor.png"]


def test_the_statistics_are_those_of_the_machine() -> None:
    made = statistics(result())
    assert made.row_count == 4
    meanings = list(made.columns[0].cells)
    assert "out-of-plane blade-root moment" in meanings
