"""WAMIT files: written and read again, its conventions, and mixed-up units told with figures."""

from dataclasses import replace

import numpy as np
import pytest

from galerna.errors import InputError
from galerna.hydro.files import read_database
from galerna.hydro.wamit import _radiation, read_wamit, write_wamit
from galerna.turbine.platform import Platform
from galerna.units import DEG

from .test_database import DRAFT, VOLUME, column

PLATFORM = Platform(
    (0.0, 0.0, 0.0), 3e6, (0.0, 0.0, -40.0), (1e9, 1e9, 1e8),
    displaced_volume=VOLUME, water_depth=5000.0,
)  # fmt: skip


@pytest.fixture(scope="module")
def base():
    return replace(column(), water_depth=5000.0, center_of_buoyancy=np.array([0.0, 0.0, np.nan]))


@pytest.fixture
def stem(base, tmp_path):
    write_wamit(base, tmp_path / "spar")
    return tmp_path / "spar"


def read(path, **changes):
    return read_wamit(path, displaced_volume=VOLUME, water_depth=5000.0, **changes)


def rewrite(path, change):
    """Change a file's rows of words."""
    rows = [change(line.split()) for line in path.read_text().splitlines()]
    path.write_text("\n".join(" ".join(str(word) for word in row) for row in rows) + "\n")


@pytest.mark.parametrize("length", [1.0, 9.4])
def test_round_trip(base, tmp_path, length):
    write_wamit(base, tmp_path / "spar", length=length)
    again = read(tmp_path / "spar.1", length=length)
    for name in (
        "frequency", "added_mass", "damping", "added_mass_infinite", "added_mass_zero", "heading",
        "excitation", "hydrostatic_stiffness", "mean_drift",
    ):  # fmt: skip
        a, b = getattr(base, name), getattr(again, name)
        np.testing.assert_allclose(b, a, rtol=1e-8, atol=1e-9 * np.abs(a).max(), err_msg=name)
    np.testing.assert_allclose(again.center_of_buoyancy[:2], 0.0, atol=1e-12)
    assert np.isnan(again.center_of_buoyancy[2])


def test_lines_of_wamit_by_hand(tmp_path):
    """PER I J A B; the period -1 means zero frequency and 0 infinite: as in the manual."""
    (tmp_path / "spar.1").write_text(
        " -1.0 1 1 3100.0\n 0.0 1 1 3000.0\n 10.0 1 1 3050.0 12.0\n 20.0 1 5 3080.0D0 1.0\n"
    )
    frequency, added, damping, limits = _radiation(tmp_path / "spar.1", "period")
    np.testing.assert_allclose(frequency, [2 * np.pi / 20, 2 * np.pi / 10])
    assert (added[1, 0, 0], damping[1, 0, 0]) == (3050.0, 12.0)
    assert (added[0, 0, 4], damping[0, 0, 4]) == (3080.0, 1.0)
    assert (limits["zero"][0, 0], limits["infinite"][0, 0]) == (3100.0, 3000.0)


def test_the_wave_pushes_where_the_water_accelerates(stem):
    """exp(+i w t), waves towards x: the surge force leads the crest by a quarter of a period."""
    base = read(stem)
    ahead, back = (int(np.abs(base.heading - b).argmin()) for b in (0.0, np.pi))
    assert np.angle(base.excitation[0, ahead, 0]) / DEG == pytest.approx(90.0, abs=0.1)
    assert np.angle(base.excitation[0, back, 0]) / DEG == pytest.approx(-90.0, abs=0.1)
    assert np.angle(base.excitation[0, ahead, 2]) / DEG == pytest.approx(0.0, abs=0.1)
    assert base.excitation[0, ahead, 2].real > 0.9 * base.hydrostatic_stiffness[2, 2]


def test_platform_says_what_files_do_not(stem):
    base = read_database(
        stem.with_suffix(".1"), replace(PLATFORM, reference_point=(0.0, 0.0, 10.0))
    )
    arm = DRAFT / 2 + 10.0
    assert base.hydrostatic_stiffness[4, 4] == pytest.approx(-base.buoyancy * arm, rel=0.01)


def test_frequencies_in_the_first_column(stem, base):
    for suffix in (".1", ".3", ".8"):
        rewrite(stem.with_suffix(suffix), _frequencies)
    again = read(stem, first_column="rad/s")
    np.testing.assert_allclose(again.frequency, base.frequency, rtol=1e-8)
    np.testing.assert_allclose(again.damping[:, 0, 0], base.damping[:, 0, 0], rtol=1e-7)
    np.testing.assert_allclose(again.added_mass_infinite, base.added_mass_infinite, rtol=1e-7)
    with pytest.raises(InputError, match=r"first column as period.*\n.*first_column='rad/s'"):
        read(stem)
    with pytest.raises(InputError, match=r"first column as Hz.*\n.*first_column='rad/s'"):
        read(stem, first_column="Hz")


def _frequencies(row):
    period = float(row[0])
    value = {-1.0: 0.0, 0.0: -1.0}.get(period) if period <= 0.0 else 2 * np.pi / period
    return [repr(value), *row[1:]]


def test_periods_read_as_frequencies(stem):
    with pytest.raises(InputError, match=r"first column as rad/s.*\n.*first_column='period'"):
        read(stem, first_column="rad/s")


def _times(place, factor):
    def change(row):
        return [repr(float(w) * factor) if i == place else w for i, w in enumerate(row)]

    return change


def test_dimensional_stiffness(stem):
    rewrite(stem.with_suffix(".hst"), _times(2, 1025.0 * 9.80665))
    with pytest.raises(
        InputError, match=r"waterplane of 5\.05\de\+05 m2.*50\.27 m2\n.*dimensional"
    ):
        read(stem)


def test_dimensional_added_mass(stem):
    rewrite(stem.with_suffix(".1"), _times(3, 1025.0))
    with pytest.raises(InputError, match=r"of the displaced mass 3\.091e\+06 kg"):
        read(stem)


def test_the_wrong_unit_length(base, tmp_path):
    write_wamit(base, tmp_path / "spar", length=10.0)
    with pytest.raises(InputError, match="ULEN"):
        read(tmp_path / "spar")


def test_dimensional_excitation(stem):
    for place in (3, 5, 6):
        rewrite(stem.with_suffix(".3"), _times(place, 1e4))
    with pytest.raises(InputError, match=r"heave over C33 \+ .*, is 1\.00\de\+04 times"):
        read(stem)


def test_phases_in_radians(stem):
    rewrite(stem.with_suffix(".3"), _times(4, DEG))
    with pytest.raises(InputError, match="phases are in radians"):
        read(stem)


def test_headings_in_radians(stem):
    rewrite(stem.with_suffix(".3"), _times(1, DEG))
    with pytest.raises(InputError, match=r"from -3\.142 to 3\.142 are radians"):
        read(stem)


def test_the_other_time_factor(base, tmp_path):
    write_wamit(replace(base, excitation=base.excitation.conj()), tmp_path / "spar")
    with pytest.raises(InputError, match=r"other sign\n.*exp\(-i w t\)"):
        read(tmp_path / "spar")


def test_what_is_missing_is_named(stem):
    lines = stem.with_suffix(".3").read_text().splitlines()
    stem.with_suffix(".3").write_text("\n".join(lines[:-6]))
    with pytest.raises(InputError, match="lacks 1 of 780 pairs"):
        read(stem)
    stem.with_suffix(".3").write_text("\n".join(lines[: 6 * 13 * 59]))
    with pytest.raises(InputError, match=r"holds 59 frequencies.*\.1 holds 60"):
        read(stem)
    stem.with_suffix(".3").unlink()
    with pytest.raises(InputError, match=r"spar\.3: is not there"):
        read(stem)


@pytest.mark.parametrize("change", ["fewer", "others"])
def test_drift_of_other_headings_than_the_excitation(stem, change):
    path = stem.with_suffix(".8")
    rows = [line.split() for line in path.read_text().splitlines()]
    if change == "fewer":
        rows = [row for row in rows if float(row[1]) != 0.0]
    else:
        rows = [[row[0], *(str(float(b) + 10.0) for b in row[1:3]), *row[3:]] for row in rows]
    path.write_text("\n".join(" ".join(row) for row in rows) + "\n")
    with pytest.raises(InputError, match=r"\.8: lacks \d+ of \d+ pairs of a frequency and a head"):
        read(stem)


def test_no_infinite_frequency(stem):
    lines = stem.with_suffix(".1").read_text().splitlines()
    stem.with_suffix(".1").write_text("\n".join(x for x in lines if float(x.split()[0]) != 0.0))
    with pytest.raises(InputError, match="lacks the added mass at infinite frequency"):
        read(stem)


def test_words_among_the_numbers(stem):
    text = stem.with_suffix(".hst").read_text()
    stem.with_suffix(".hst").write_text("I J C(I,J)\n" + text)
    read(stem)
    stem.with_suffix(".hst").write_text(text + "end\n")
    with pytest.raises(InputError, match=r"\.hst, line 37"):
        read(stem)
