"""Runs that go on after a stop: the same bits, whatever stopped them, and clear words if not."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from textwrap import dedent

import numpy as np
import pytest

import galerna
from galerna import ConvergenceError, InputError, checkpoints
from galerna.case import load
from galerna.errors import GalernaError
from galerna.machine import build_machine
from galerna.results import open_result
from galerna.running import simulate
from galerna.saving import Saving
from galerna.simulation import Callback

TURBULENCE = {
    "kind": "mann",
    "turbulence_class": "B",
    "points_across": 8,
    "time_step_s": 0.4,
}
RIGID = {
    "galerna": 1,
    "turbine": "nrel5mw",
    "duration_s": 1.5,
    "time_step_s": 0.05,
    "inflow": {"wind_speed_m_s": 8.0, "turbulence": TURBULENCE},
    "operation": {"rotor_speed_rpm": 9.16, "pitch_deg": 0.0},
}
STEADY = {**RIGID, "inflow": {"wind_speed_m_s": 8.0}}
CONTROLLED = {
    **RIGID,
    "duration_s": 0.8,
    "time_step_s": 0.02,
    "inflow": {"wind_speed_m_s": 12.0, "turbulence": TURBULENCE},
    "structure": "flexible",
    "control": "baseline",
    "operation": {"operating_point": "steady"},
    "outputs": {"interval_s": 0.04},
}
PLANE = {"name": "side", "corner_m": [-50, 0, 10], "first_side_m": [100, 0, 0]}
LATTICE = {
    **RIGID,
    "duration_s": 1.8,
    "time_step_s": 0.15,
    "aerodynamics": {
        "model": "vortex_lattice",
        "spanwise_panels": 4,
        "chordwise_panels": 2,
        "wake_length_diameters": 1.0,
        "wake_step_deg": 10,
        "wake": "free",
    },
    "outputs": {"interval_s": 0.15},
}
KEEP = Saving(keep=True)


class Stop(Callback):
    """Raises an error after the step that reaches a time."""

    def __init__(self, time, error=KeyboardInterrupt):
        self.time, self.error = time, error

    def accepted(self, simulation):
        if simulation.time >= self.time - 1e-9:
            raise self.error


def stopped(case, path, time, error=KeyboardInterrupt, **options):
    """A run that an error stops."""
    with pytest.raises(error if isinstance(error, type) else type(error)) as caught:
        galerna.run(case, path, callbacks=[Stop(time, error)], **options)
    return caught.value


def assert_same(found, expected):
    """The same channels with the same bits."""
    assert set(found.data_vars) == set(expected.data_vars)
    for name in ("time", *expected.data_vars):
        np.testing.assert_array_equal(found[name], expected[name], err_msg=str(name))


@pytest.mark.parametrize(
    ("case", "at"), [(RIGID, 0.7), (CONTROLLED, 0.3), (LATTICE, 1.05)],
    ids=["rigid", "controlled", "lattice"],
)  # fmt: skip
def test_a_resumed_run_gives_the_bits_of_an_unbroken_one(tmp_path, case, at):
    straight = galerna.run(case)
    error = stopped(case, tmp_path / "a.nc", at)
    assert "galerna resume" in error.__notes__[-1]
    assert open_result(tmp_path / "a.nc").sizes["time"] < straight.sizes["time"]
    result = galerna.resume(tmp_path / "a.nc")
    assert result.attrs["status"] == "complete"
    assert result.attrs["resumed_at_s"] == f"{at:g}"
    assert_same(result, straight)
    assert_same(open_result(tmp_path / "a.nc"), straight)
    assert [p.name for p in tmp_path.iterdir()] == ["a.nc"]  # no checkpoint where all is done


@pytest.mark.parametrize(
    "outputs", [{"start_s": 1.0}, {"interval_s": 0.15}], ids=["before the first", "between two"]
)
def test_a_run_goes_on_from_between_its_records(tmp_path, outputs):
    case = {**STEADY, "outputs": outputs}
    stopped(case, tmp_path / "a.nc", 0.5)
    assert_same(galerna.resume(tmp_path / "a.nc"), galerna.run(case))


def test_a_run_may_be_stopped_and_resumed_again_and_again(tmp_path):
    stopped(RIGID, tmp_path / "a.nc", 0.5)
    with pytest.raises(KeyboardInterrupt):
        galerna.resume(tmp_path / "a.nc", callbacks=[Stop(1.0)])
    result = galerna.resume(tmp_path / "a.nc")
    assert result.attrs["resumed_at_s"] == "0.5, 1"
    assert_same(result, galerna.run(RIGID))


def test_the_result_may_go_elsewhere(tmp_path):
    stopped(RIGID, tmp_path / "a.nc", 0.5)
    result = galerna.resume(tmp_path / "a.nc", tmp_path / "b.nc")
    assert_same(result, galerna.run(RIGID))
    assert open_result(tmp_path / "a.nc").sizes["time"] == 5
    with pytest.raises(InputError, match=r"b\.nc: a result stands here already"):
        galerna.resume(tmp_path / "a.nc", tmp_path / "b.nc")


def test_a_finished_run_goes_on_with_a_checkpoint_that_was_kept(tmp_path):
    galerna.run(STEADY, tmp_path / "a.nc", duration=0.8, saving=KEEP)
    with pytest.raises(InputError, match=r"(?s)has come to 0\.8 s.*longer --duration"):
        galerna.resume(tmp_path / "a.nc")
    result = galerna.resume(tmp_path / "a.nc", duration=1.5)
    assert_same(result, galerna.run(STEADY))
    assert result.attrs["duration_s"] == 1.5


def test_flow_pictures_go_on_after_those_that_are_there(tmp_path):
    plane = {**PLANE, "second_side_m": [0, 0, 150], "points": [3, 2]}
    flow = {"interval_s": 0.3, "planes": [plane]}
    case = {**LATTICE, "aerodynamics": {**LATTICE["aerodynamics"], "flow_output": flow}}
    galerna.run(case, tmp_path / "straight.nc")
    stopped(case, tmp_path / "a.nc", 0.6)
    galerna.resume(tmp_path / "a.nc")
    for name in sorted(p.name for p in (tmp_path / "straight_flow").iterdir()):
        expected = (tmp_path / "straight_flow" / name).read_bytes()
        assert (tmp_path / "a_flow" / name).read_bytes() == expected


def test_where_a_run_was_stopped_resuming_it_is_the_first_advice(tmp_path):
    stopped(RIGID, tmp_path / "a.nc", 0.5)
    with pytest.raises(InputError, match=r"(?s)stands here already.*galerna resume .*--overwrite"):
        galerna.run(RIGID, tmp_path / "a.nc")


def test_what_cannot_be_resumed_is_not_offered(tmp_path):
    """A controller without a state; and a run that has recorded nothing."""
    own = """
        class Own:
            def __init__(self, turbine):
                pass

            def demands(self, measured):
                raise RuntimeError("no")
    """
    (tmp_path / "own.py").write_text(dedent(own))
    case = {**CONTROLLED, "control": {"model": "python", "object": f"{tmp_path}/own.py:Own"}}
    with pytest.raises(GalernaError) as caught:
        galerna.run(case, tmp_path / "a.nc")
    first, second = caught.value.__notes__
    assert first == "nothing was recorded yet"
    assert "cannot be resumed" in second


class TestStateAtAStop:
    """Where a step fails, the state before it is what is kept."""

    @pytest.mark.parametrize("case", [RIGID, CONTROLLED], ids=["rigid", "controlled"])
    def test_a_step_that_failed_is_done_again(self, tmp_path, case):
        machine = build_machine(load(case))
        rotor = machine.simulation.load_models["rotor"]
        loads, fails = rotor.loads, 10 * case["time_step_s"]

        def failing(at, motion):
            if at > fails:
                raise ConvergenceError("strip 3", "no balance", time=at)
            return loads(at, motion)

        rotor.loads = failing
        with pytest.raises(ConvergenceError, match=r"strip 3 at t = "):
            simulate(machine, tmp_path / "a.nc")
        kept = checkpoints.read(tmp_path / "a.nc")
        assert kept.origin.time == pytest.approx(fails)
        assert_same(galerna.resume(tmp_path / "a.nc"), galerna.run(case))

    def test_a_state_that_is_half_committed_is_not_kept(self):
        machine = build_machine(load(STEADY))
        machine.simulation.advance()
        machine.simulation.load_models["bodies"].end_step = lambda *_: 1 / 0
        with pytest.raises(ZeroDivisionError):
            machine.simulation.advance()
        assert machine.simulation.accepted_state() is None

    def test_a_record_that_is_not_on_disk_belongs_to_no_checkpoint(self, tmp_path, monkeypatch):
        """The disk is full: what is resumed writes the record again."""
        append, full = galerna.results.ResultFile.append, InputError("a.nc.log", "disk is full")

        def refusing(result, at, record):
            if at > 0.95:
                raise full
            append(result, at, record)

        with monkeypatch.context() as patched:
            patched.setattr("galerna.results.store.ResultFile.append", refusing)
            with pytest.raises(InputError, match="disk is full"):
                galerna.run(RIGID, tmp_path / "a.nc", saving=Saving(every=0.0))
        assert_same(galerna.resume(tmp_path / "a.nc"), galerna.run(RIGID))


GO_ON = """
import numpy as np
from pathlib import Path
from galerna.case import load
from galerna.machine import build_machine
from galerna.running import resumed_machine
machine, _ = resumed_machine(Path({result!r}))
straight = build_machine(load({case!r}))
for each in (machine, straight):
    each.simulation.run({end})
found = machine.simulation.record()
for name, values in straight.simulation.record().items():
    np.testing.assert_array_equal(found[name], values, name)
print("same bits")
"""

LIMITED = """
import resource, signal, sys
import galerna
from galerna.saving import Saving
galerna.run({steady!r}, {short!r}, duration=0.1)  # whatever else is written, such as kernels
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, ({limit}, {limit}))
try:
    galerna.run({steady!r}, {path!r}, saving=Saving(every=0.0))
except galerna.InputError as error:
    print(error, *error.__notes__, sep="|")
"""


def in_another_process(code):
    """What a program prints."""
    command = [sys.executable, "-c", f"import galerna; {code}"]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


@pytest.fixture(scope="module")
def kernels():
    """Kernels on disk: a process that compiles them may differ in last bits from one that loads."""
    for case in (RIGID, STEADY):
        in_another_process(f"galerna.run({case!r}, duration=0.1)")


def test_a_full_disk_leaves_what_it_took_and_says_so(tmp_path, kernels):
    path = tmp_path / "a.nc"
    in_another_process(f"galerna.run({STEADY!r}, {str(tmp_path / 'whole.nc')!r})")
    whole = open_result(tmp_path / "whole.nc")
    stopped(STEADY, tmp_path / "size.nc", 1.0)
    width = (tmp_path / "size.nc.checkpoint").stat().st_size
    code = LIMITED.format(
        steady=STEADY, short=str(tmp_path / "short.nc"), path=str(path), limit=width + 40_000
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert "cannot be written" in done.stdout, done.stderr
    assert f"the records so far are in {path}" in done.stdout
    left = open_result(path)
    assert 0 < left.sizes["time"] < whole.sizes["time"]
    assert_same(left.isel(time=slice(0, 3)), whole.isel(time=slice(0, 3)))
    in_another_process(f"galerna.resume({str(path)!r})")
    assert_same(open_result(path), whole)


class TestKilled:
    """kill -9: at most one interval is lost."""

    @pytest.fixture
    def case(self, tmp_path):
        (tmp_path / "c.yaml").write_text(json.dumps({**RIGID, "duration_s": 1000.0}))
        return tmp_path / "c.yaml"

    def test_what_is_left_opens_and_goes_on(self, tmp_path, case, kernels):
        command = [sys.executable, "-m", "galerna.cli", "run", str(case), "--checkpoint-every"]
        result, checkpoint = tmp_path / "c.nc", tmp_path / "c.nc.checkpoint"
        process = subprocess.Popen([*command, "0.1"], stderr=subprocess.DEVNULL)
        self._wait_for(checkpoint, process)
        first = checkpoint.stat().st_mtime_ns
        while checkpoint.stat().st_mtime_ns == first:  # another is on its way
            time.sleep(0.01)
        process.send_signal(signal.SIGKILL)
        process.wait()
        left = open_result(result)
        assert left.attrs["status"] == "half-written"
        kept = checkpoints.read(result)
        assert 0 < kept.origin.records <= left.sizes["time"]
        end = kept.origin.time + 1.0  # the whole 1000 s would take too long
        code = GO_ON.format(result=str(result), case=str(case), end=end)
        assert in_another_process(f"exec({code!r})") == "same bits\n"

    @staticmethod
    def _wait_for(path, process):
        for _ in range(3000):
            if path.exists():
                return
            assert process.poll() is None, "the run has ended early"
            time.sleep(0.05)
        process.kill()
        raise AssertionError(f"no {path} came")


class TestRefusals:
    """What cannot be resumed says why."""

    def test_no_checkpoint(self, tmp_path):
        galerna.run(STEADY, tmp_path / "a.nc")
        with pytest.raises(InputError, match=r"(?s)no checkpoint.*--keep-checkpoint"):
            galerna.resume(tmp_path / "a.nc")

    def test_another_version(self, tmp_path, monkeypatch):
        with monkeypatch.context() as older:
            older.setattr(checkpoints, "__version__", "0.0.9")
            older.setattr(
                checkpoints.Origin, "of", self._of_version(checkpoints.Origin.of, "0.0.9")
            )
            stopped(STEADY, tmp_path / "a.nc", 0.5)
        with pytest.raises(InputError, match=r"galerna 0\.0\.9 has written this"):
            galerna.resume(tmp_path / "a.nc")

    @staticmethod
    def _of_version(of, version):
        return lambda *given: replace(of(*given), galerna=version)

    def test_a_damaged_checkpoint(self, tmp_path):
        stopped(STEADY, tmp_path / "a.nc", 0.5)
        path = tmp_path / "a.nc.checkpoint"
        path.write_bytes(path.read_bytes()[:-500])
        with pytest.raises(InputError, match="is not a checkpoint"):
            galerna.resume(tmp_path / "a.nc")

    def test_the_checkpoint_of_another_run(self, tmp_path):
        for name in ("a.nc", "b.nc"):
            stopped(STEADY, tmp_path / name, 0.5)
        os.replace(tmp_path / "a.nc.checkpoint", tmp_path / "b.nc.checkpoint")
        with pytest.raises(InputError, match="come from different runs"):
            galerna.resume(tmp_path / "b.nc")

    def test_turbulence_made_for_another_duration(self, tmp_path):
        stopped(RIGID, tmp_path / "a.nc", 0.5)
        with pytest.raises(InputError, match=r"(?s)made for 3000 s is another.*points"):
            galerna.resume(tmp_path / "a.nc", duration=3000.0)

    def test_a_wind_file_that_has_changed(self, tmp_path):
        wind = tmp_path / "gust.wnd"
        rows = "{t} {speed} 0 0 0 0 0 0\n"
        wind.write_text("".join(rows.format(t=t, speed=8 + t) for t in (0, 2)))
        inflow = {"time_series_file": {"path": str(wind)}}
        stopped({**STEADY, "inflow": inflow}, tmp_path / "a.nc", 0.5)
        galerna.resume(tmp_path / "a.nc", tmp_path / "b.nc")
        wind.write_text("".join(rows.format(t=t, speed=8 + 1.01 * t) for t in (0, 2)))
        with pytest.raises(InputError, match=r"the wind is not what it was"):
            galerna.resume(tmp_path / "a.nc")

    def test_a_controller_that_forgets(self, tmp_path):
        machine = build_machine(load(STEADY))
        machine.simulation.commander = Forgetful()
        with pytest.raises(KeyboardInterrupt):
            simulate(machine, tmp_path / "a.nc", callbacks=[Stop(0.5)])
        with pytest.raises(InputError, match="cannot be resumed: it forgets"):
            galerna.resume(tmp_path / "a.nc")


class Forgetful:
    resumable = "it forgets"

    def command(self, time, dt): ...


def test_a_new_run_takes_an_old_checkpoint_away(tmp_path):
    stopped(STEADY, tmp_path / "a.nc", 0.5)
    (tmp_path / "a.nc.checkpoint.unfinished").touch()  # as a run that is killed leaves it
    galerna.run(STEADY, tmp_path / "a.nc", overwrite=True)
    assert [p.name for p in tmp_path.iterdir()] == ["a.nc"]


def test_checkpoints_take_little_of_the_time(tmp_path, monkeypatch):
    """A slow disk: at most one part in fifty."""
    began, spent = time.perf_counter(), []
    write = checkpoints.write

    def slow(*given):
        start = time.perf_counter()
        write(*given)
        time.sleep(0.02)
        spent.append(time.perf_counter() - start)

    monkeypatch.setattr("galerna.saving.write", slow)
    galerna.run({**STEADY, "duration_s": 60.0}, tmp_path / "a.nc", saving=Saving(every=0.0))
    elapsed = time.perf_counter() - began
    assert spent
    assert sum(spent[:-1]) < 0.02 * elapsed
