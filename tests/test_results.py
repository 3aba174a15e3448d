"""Results on disk: whole, cut short, and in the formats of other tools."""

import os
import signal
import subprocess
import sys
import time
import tracemalloc

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from galerna.contract import Channel
from galerna.errors import ConvergenceError, InputError
from galerna.results import ResultFile, open_result, to_csv, to_outb
from galerna.results.dataset import log_of
from galerna.results.log import Layout

CHANNELS = (
    Channel("rotor_power", "W", "aerodynamic power", (), "RtAeroPwr", "kW", 1e-3),
    Channel("pitch", "rad", "pitch angle", ("blade",), "BldPitch{blade}", "deg", 180.0 / np.pi),
    Channel("normal_force", "N/m", "force", ("blade", "radius"), "B{blade}N{node}Fn", "N/m"),
    Channel("steady", "m", "does not change", (), "Steady", "m"),
)
LAYOUT = Layout(
    CHANNELS, {"blade": np.array([1.0, 2.0]), "radius": np.array([5.0, 30.0, 60.0])}, {"seed": 3}
)


def record(time):
    return {
        "rotor_power": 5e6 * np.sin(time),
        "pitch": np.array([0.1, 0.2]) * time,
        "normal_force": np.arange(6.0).reshape(2, 3) + time,
        "steady": 1.25e7,
    }


def write(path, times=(0.1, 0.2, 0.3), **options):
    result = ResultFile(path, LAYOUT, **options)
    for t in times:
        result.append(t, record(t))
    return result


def append_until_full(result):
    for t in 0.2 + 0.1 * np.arange(100):
        result.append(t, record(t))


def test_a_finished_result_holds_values_units_and_names(tmp_path):
    path = tmp_path / "new folder" / "case.nc"
    write(path).finish()
    result = open_result(path)
    np.testing.assert_array_equal(result["time"], [0.1, 0.2, 0.3])
    np.testing.assert_array_equal(result["rotor_power"], 5e6 * np.sin([0.1, 0.2, 0.3]))
    assert result["normal_force"].sel(blade=2, radius=60.0, time=0.2) == pytest.approx(5.2)
    assert result["pitch"].attrs["units"] == "rad"
    assert result["pitch"].attrs["openfast"] == "BldPitch{blade}"
    assert result["radius"].attrs["units"] == "m"
    assert result.attrs["status"] == "complete"
    assert result.attrs["seed"] == 3
    assert sorted(p.name for p in path.parent.iterdir()) == ["case.nc"]


def test_a_result_in_the_making_opens(tmp_path):
    write(tmp_path / "case.nc")
    result = open_result(tmp_path / "case.nc")
    assert result.attrs["status"] == "half-written"
    np.testing.assert_allclose(result["pitch"].values[-1], [0.03, 0.06], rtol=1e-6)
    assert open_result(tmp_path / "case.nc.log").sizes["time"] == 3


@settings(deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(cut=st.integers(0, 2000))
def test_a_log_cut_anywhere_keeps_its_complete_records(tmp_path, cut):
    path = tmp_path / "case.nc"
    write(path, times=np.arange(20.0), overwrite=True)
    whole = log_of(path).read_bytes()
    log_of(path).write_bytes(whole[:-cut] if cut else whole)
    row = 8 * LAYOUT.width
    remaining = len(whole) - cut - (len(whole) - 20 * row)
    if remaining < -1:  # the description itself is cut
        with pytest.raises(InputError):
            open_result(path)
    else:
        assert open_result(path).sizes["time"] == max(remaining, 0) // row


KILLED = """
import sys, numpy as np
sys.path.insert(0, {tests!r})
from pathlib import Path
from test_results import LAYOUT, ResultFile, record
result = ResultFile(Path({path!r}), LAYOUT)
t = 0
while True:
    t += 1
    result.append(float(t), record(float(t)))
    if t == 100:
        print("hundred", flush=True)
"""


def test_a_killed_run_leaves_its_records(tmp_path):
    path = str(tmp_path / "case.nc")
    code = KILLED.format(tests=os.path.dirname(__file__), path=path)
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE)
    assert process.stdout.readline() == b"hundred\n"
    time.sleep(0.01)
    process.send_signal(signal.SIGKILL)
    process.wait()
    process.stdout.close()
    result = open_result(path)
    n = result.sizes["time"]
    assert n >= 100
    np.testing.assert_array_equal(result["time"], np.arange(1.0, n + 1.0))
    np.testing.assert_array_equal(result["rotor_power"], 5e6 * np.sin(result["time"]))


def test_nothing_written_is_lost(tmp_path):
    path = tmp_path / "case.nc"
    write(path).finish()
    with pytest.raises(InputError, match=r"(?s)stands here already.*--overwrite"):
        write(path)
    again = write(path, times=[7.0], overwrite=True)
    assert open_result(path).sizes["time"] == 3, "the old result stays until the new is whole"
    again.finish()
    assert open_result(path).sizes["time"] == 1


def test_a_half_written_result_is_not_overwritten_unasked(tmp_path):
    write(tmp_path / "case.nc")
    with pytest.raises(InputError, match="half-written result of a stopped run"):
        write(tmp_path / "case.nc")


def test_a_place_that_cannot_be_written_is_said(tmp_path):
    log_of(tmp_path / "a.nc").mkdir()
    with pytest.raises(InputError, match=r"a\.nc\.log: cannot be written"):
        ResultFile(tmp_path / "a.nc", LAYOUT, overwrite=True)


def test_two_runs_do_not_write_one_result(tmp_path):
    pytest.importorskip("fcntl")
    first = write(tmp_path / "case.nc")
    with pytest.raises(InputError, match="another run is writing this result"):
        write(tmp_path / "case.nc", times=[7.0], overwrite=True)
    first.append(0.4, record(0.4))
    first.finish()
    np.testing.assert_array_equal(open_result(tmp_path / "case.nc")["time"], [0.1, 0.2, 0.3, 0.4])


@pytest.mark.parametrize("room", [100, 3300])
def test_a_full_disk_is_said_and_leaves_the_complete_records(tmp_path, room):
    resource = pytest.importorskip("resource")
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    result = write(tmp_path / "case.nc", times=[0.1])
    size = log_of(tmp_path / "case.nc").stat().st_size
    resource.setrlimit(resource.RLIMIT_FSIZE, (size + room, limits[1]))
    try:
        with pytest.raises(InputError, match=r"case\.nc\.log: cannot be written"):
            append_until_full(result)
        with pytest.raises(InputError, match=r"case\.nc: cannot be written"):
            result.finish()
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["case.nc.log"]
    left = open_result(tmp_path / "case.nc")
    assert left.sizes["time"] == 1 + room // (8 * LAYOUT.width)
    np.testing.assert_array_equal(left["rotor_power"], 5e6 * np.sin(left["time"]))


def test_a_channel_that_is_not_a_number_is_named(tmp_path):
    result = write(tmp_path / "case.nc")
    with pytest.raises(ConvergenceError, match=r"t = 0\.4 s: channel 'pitch' is not a number"):
        result.append(0.4, {**record(0.4), "pitch": np.array([0.0, np.nan])})
    assert open_result(tmp_path / "case.nc").sizes["time"] == 3


def test_something_else_is_not_opened(tmp_path):
    (tmp_path / "text.nc").write_text("hello")
    (tmp_path / "text.log").write_text("hello")
    for name in ("text.nc", "text.log", "none.nc"):
        with pytest.raises(InputError, match=name):
            open_result(tmp_path / name)


def test_outb_reads_back_in_openfast_io(tmp_path):
    reader = pytest.importorskip("openfast_io.FAST_output_reader")
    times = 0.05 * np.arange(1, 200)
    to_outb(write(tmp_path / "case.nc", times).finish(), tmp_path / "case.outb")
    data, info, _ = reader.load_binary_output(str(tmp_path / "case.outb"))
    names = info["attribute_names"]
    assert names[:4] == ["Time", "RtAeroPwr", "BldPitch1", "BldPitch2"]
    assert names[-1] == "Steady"
    assert "B2N3Fn" in names
    assert info["attribute_units"][:3] == ["s", "kW", "deg"]
    np.testing.assert_allclose(data[:, 0], times, rtol=1e-12)
    step = 1e4 / 65535
    np.testing.assert_allclose(data[:, 1], 5e3 * np.sin(times), atol=0.6 * step)
    np.testing.assert_allclose(data[:, 3], np.rad2deg(0.2 * times), rtol=1e-3)
    np.testing.assert_allclose(data[:, -1], 1.25e7)


def test_csv_has_a_column_for_every_place(tmp_path):
    to_csv(write(tmp_path / "case.nc").finish(), tmp_path / "case.csv")
    head, first, *_ = (tmp_path / "case.csv").read_text().splitlines()
    names = head.split(",")
    assert names[:2] == ["time [s]", "rotor_power [W]"]
    assert "normal_force_blade2_radius3 [N/m]" in names
    assert float(first.split(",")[names.index("pitch_blade2 [rad]")]) == pytest.approx(0.02)


def test_the_end_of_a_long_run_takes_little_more_memory_than_its_result(tmp_path, monkeypatch):
    """All rows at once would stand beside it with twice its size, in double precision."""
    wide = Layout(CHANNELS[2:3], {"blade": np.arange(3.0), "radius": np.arange(50.0)}, {})
    result = ResultFile(tmp_path / "long.nc", wide)
    loads = {"normal_force": np.arange(150.0).reshape(3, 50)}
    for step in range(20000):
        result.append(0.1 * step, loads)
    monkeypatch.setattr("galerna.results.log.BLOCK", 1 << 20)
    monkeypatch.setattr("galerna.results.store.write_netcdf", lambda dataset, path: None)
    tracemalloc.start()
    size = result.finish().nbytes
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < size + 4 * 2**20
