"""Pictures say what they show, and show what is there."""

import numpy as np
import pytest
import xarray

from galerna.errors import InputError
from galerna.report import (
    RotorCircle,
    inflow_figure,
    performance_surface_figure,
    plot_result,
    power_curve_figure,
    rotor_figure,
    spanwise_figure,
    spectra_figure,
)
from galerna.report.spectra import power_spectrum
from galerna.report.tables import statistics

PNG = b"\x89PNG\r\n\x1a\n"
SPEED = 1.2  #: rad/s


def result(n=600, dt=0.1):
    """Thrust at 3P about 500 kN, three blades' moments at 1P, forces rising with the radius."""
    time = dt * np.arange(1, n + 1)
    blade, radius = np.arange(1.0, 4.0), np.linspace(2.0, 60.0, 7)
    phase = SPEED * time[:, None] + 2.0 * np.pi / 3.0 * blade
    force = (1000.0 + 100.0 * np.sin(phase))[:, :, None] * radius / 60.0

    def channel(dims, values, unit, text):
        return dims, values, {"units": unit, "long_name": text}

    over, blades = ("time",), ("time", "blade")
    return xarray.Dataset(
        {
            "rotor_speed": channel(over, np.full(n, SPEED), "rad/s", "rotor speed"),
            "rotor_thrust": channel(over, 5e5 + 2e4 * np.sin(3 * SPEED * time), "N", "thrust"),
            "aerodynamic_root_out_of_plane_moment": channel(
                blades, 5e6 + 1e6 * np.sin(phase), "N m", "root moment"
            ),
            "normal_force": channel((*blades, "radius"), force, "N/m", "normal force"),
        },
        {"time": time, "blade": blade, "radius": radius},
        {"turbine": "Test 5 MW", "case_name": "waves", "status": "complete"},
    )


class Shear:
    """Wind that rises with the height and over time."""

    def velocity(self, points, time):
        return np.column_stack([points[:, 2] / 10.0 + time, 0.0 * points[:, :2]])


def texts(figure):
    return " | ".join(
        [figure.get_suptitle()]
        + [ax.get_title(loc="left") for ax in figure.axes]
        + [ax.get_xlabel() for ax in figure.axes]
    )


def test_the_rotor_over_time_names_turbine_case_and_units():
    shown = texts(rotor_figure(result()))
    assert "Test 5 MW, waves" in shown
    assert "Thrust [kN]" in shown
    assert "Time [s]" in shown
    assert "rotor speed 11.46 rpm" in shown, "what does not change is told, not drawn"


def test_spanwise_range_holds_the_mean():
    figure = spanwise_figure(result())
    mean, zero = figure.axes[0].get_lines()
    assert zero.get_ydata() == [0.0, 0.0], "forces are shown from zero"
    np.testing.assert_allclose(mean.get_ydata()[-1], 1.0, rtol=1e-2)
    assert "Radius [m]" in texts(figure)


def test_the_spectrum_peaks_at_three_per_revolution_and_holds_the_variance():
    frequency, density, unit = power_spectrum(result(6000), "rotor_thrust")
    assert frequency[density.argmax()] == pytest.approx(3 * SPEED / (2 * np.pi), abs=frequency[0])
    assert density.sum() * frequency[0] == pytest.approx(20.0**2 / 2.0, rel=0.02)
    assert unit == "(kN)²/Hz"


def test_spectra_mark_the_rotation():
    marks = [text.get_text() for text in spectra_figure(result()).axes[0].texts]
    assert marks[:2] == ["1P", "3P"]


def test_blades_are_marked_at_twice_per_revolution_too():
    marks = [text.get_text() for text in spectra_figure(result()).axes[1].texts]
    assert marks == ["1P", "2P", "3P", "4P", "6P", "9P"]


@pytest.mark.parametrize("seconds", [30, 40, 60, 600])
def test_once_per_revolution_stands_clear_of_lower_frequencies(seconds):
    frequency, density, _ = power_spectrum(
        result(10 * seconds), "aerodynamic_root_out_of_plane_moment"
    )
    assert frequency[density.argmax()] == pytest.approx(SPEED / (2 * np.pi), rel=0.02)
    assert density[0] < 1e-3 * density.max()


def test_channels_that_do_not_vary_have_no_spectrum(tmp_path):
    still = result()
    still["wind_speed"] = 8.0 + 1e-12 * still["rotor_thrust"] / 5e5
    shown = texts(spectra_figure(still))
    assert "Wind" not in shown
    assert "Thrust" in shown
    with pytest.raises(InputError, match="wind_speed varies"):
        spectra_figure(still, ("wind_speed",))
    assert [path.name for path in plot_result(still, tmp_path, ["wind_speed"])] == ["rotor.png"]


def test_runaway_roots_are_left_out_of_inductions_and_kept_in_forces():
    data = result()
    ramp = xarray.zeros_like(data["normal_force"]) + data["radius"] / 100.0
    data["axial_induction"] = ramp.where(data["radius"] > 9.0, 50.0).assign_attrs(units="1")
    data["normal_force"] = data["normal_force"].where(data["radius"] > 9.0, -9e4)
    data["normal_force"].attrs["units"] = "N/m"
    force, induction = spanwise_figure(data).axes[:2]
    assert force.get_ylim()[0] < -90.0
    assert induction.get_ylim()[1] < 1.0
    assert "without root and tip" in induction.get_title(loc="left")


def test_the_inflow_shows_the_rotor_and_both_slices():
    figure = inflow_figure(Shear(), RotorCircle(90.0, 63.0), 10.0, name="shear")
    shown = texts(figure)
    assert "Inflow: shear" in shown
    assert "t = 5 s" in shown
    assert figure.axes[0].patches[0].radius == 63.0
    left, right = figure.axes[0].get_xlim()
    assert left > right, "looking downwind, y points to the left"


def test_both_slices_of_a_uniform_wind_have_one_colour():
    class Uniform:
        def velocity(self, points, time):
            return np.tile([8.0 + 1e-12 * time, 0.0, 0.0], (len(points), 1))

    figure = inflow_figure(Uniform(), RotorCircle(90.0, 63.0), 10.0)
    for ax in figure.axes[:2]:
        assert ax.collections[0].get_clim() == pytest.approx((7.5, 8.5))


def test_curves_and_surfaces_draw(tmp_path):
    wind = np.linspace(4.0, 25.0, 8)

    def over_wind(values, unit, text):
        return "wind_speed", values, {"units": unit, "long_name": text}

    curve = xarray.Dataset(
        {
            "power": over_wind(1e6 * wind, "W", "aerodynamic power"),
            "electrical_power": over_wind(0.9e6 * wind, "W", "electrical power"),
            "thrust": over_wind(1e5 * wind, "N", "thrust"),
            "rotor_speed": over_wind(0.1 * wind, "rad/s", "rotor speed"),
            "pitch": over_wind(0.01 * wind, "rad", "pitch"),
        },
        {"wind_speed": wind},
    )
    assert "Power [MW]" in texts(power_curve_figure(curve, "x"))
    ratio, pitch = np.linspace(2.0, 12.0, 11), np.linspace(-0.1, 0.4, 6)
    power = 0.48 - 0.01 * (ratio[:, None] - 8.0) ** 2 - 5.0 * (pitch - pitch[1]) ** 2
    over = ("tip_speed_ratio", "pitch")
    surface = xarray.Dataset(
        {
            "power_coefficient": (over, power, {"long_name": "power coefficient"}),
            "thrust_coefficient": (over, power + 0.2, {"long_name": "thrust coefficient"}),
        },
        {"tip_speed_ratio": ratio, "pitch": ("pitch", pitch, {"units": "rad"})},
    )
    figure = performance_surface_figure(surface, "x")
    assert "largest 0.480 at 8.00" in texts(figure)
    assert figure.axes[0].texts, "contours carry their values"
    figure.savefig(tmp_path / "surface.png")


def test_a_result_becomes_files(tmp_path):
    paths = plot_result(result(), tmp_path / "plots")
    assert [path.name for path in paths] == ["rotor.png", "spanwise.png", "spectra.png"]
    assert all(path.read_bytes().startswith(PNG) for path in paths)


def test_chosen_channels_alone_are_drawn(tmp_path):
    paths = plot_result(result(), tmp_path, ["normal_force"])
    assert [path.name for path in paths] == ["spanwise.png"]


def test_an_unknown_channel_is_answered_with_the_nearest(tmp_path):
    with pytest.raises(InputError, match="did you mean 'rotor_thrust'"):
        plot_result(result(), tmp_path, ["rotor_trust"])


def test_a_result_without_records_is_refused(tmp_path):
    with pytest.raises(InputError, match="holds 0 records"):
        plot_result(result().isel(time=slice(0, 0)), tmp_path)


def test_statistics_are_over_time_and_all_blades():
    table = statistics(result(6000))
    columns = [list(column.cells) for column in table.columns]
    row = columns[0].index("root moment")
    mean, std = (float(columns[i][row]) for i in (2, 3))
    assert mean == pytest.approx(5.0, rel=1e-2)
    assert std == pytest.approx(1.0 / np.sqrt(2.0), rel=1e-2)
