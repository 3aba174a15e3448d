"""The pictures and figures of a machine that moves."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import xarray

from galerna.report import machine_figure, plot_result, spectra_figure
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


def parked(records: int = 120) -> xarray.Dataset:
    """A parked machine with a rigid tower, its rotor swinging behind the brake."""
    time = np.linspace(0.1, 12.0, records)
    wave = np.sin(6.0 * time)
    metres = {"units": "m", "long_name": "tower-top displacement"}
    return xarray.Dataset(
        {
            "rotor_speed": ("time", -2e-4 + 1e-3 * wave, {"units": "rad/s"}),
            "electrical_power": ("time", np.full(records, -0.0), {"units": "W"}),
            "tower_top_fore_aft_displacement": ("time", 1e-16 * wave, metres),
            "tower_base_fore_aft_moment": ("time", 1.209e7 + 10.0 * wave, {"units": "N m"}),
        },
        coords={"time": time},
        attrs={"case_name": "made up", "turbine": "none"},
    )


def test_a_parked_rotor_has_no_marks_outside_the_axes(tmp_path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        plot_result(parked(), tmp_path)
    assert not spectra_figure(parked()).axes[0].texts


def test_no_power_has_no_sign() -> None:
    title = machine_figure(parked()).get_suptitle()
    assert title.endswith("power 0 MW")
    assert "-0" not in [cell for column in statistics(parked()).columns for cell in column.cells]


def test_the_rounding_of_a_rigid_part_is_no_result() -> None:
    titles = [ax.get_title(loc="left") for ax in machine_figure(parked()).axes]
    assert not [title for title in titles if "isplacement" in title]
    assert "tower-top displacement" not in list(statistics(parked()).columns[0].cells)
    moving = parked()
    moving["tower_top_fore_aft_displacement"] *= 1e8  # 10 nm
    moving["tower_top_fore_aft_displacement"].attrs = {"units": "m", "long_name": "tower top"}
    assert "tower top" in list(statistics(moving).columns[0].cells)


def test_axes_tell_whole_figures() -> None:
    figure = machine_figure(parked())
    figure.draw_without_rendering()
    assert [ax.yaxis.get_offset_text().get_text() for ax in figure.axes[1:]] == [""]
    labels = [text.get_text() for text in figure.axes[1].get_yticklabels()]
    assert any(label.startswith("12.0899") for label in labels)
