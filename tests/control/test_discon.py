"""Bladed-style libraries: what they are told, what they do wrong, and how they are brought back."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

import galerna
from galerna import examples, load_case
from galerna import turbine as turbines
from galerna.control.discon import DisconController
from galerna.control.discon_records import MEASURED
from galerna.control.interface import Demands, Measurements
from galerna.control.options import DisconOptions
from galerna.errors import ControllerError, InputError
from galerna.simulation import Callback, Simulation
from galerna.units import RPM

NREL = turbines.load("nrel5mw")
SOURCE = Path(__file__).with_name("discon_stub.c")
COMPILER = shutil.which("gcc") or shutil.which("cc")
STEP = 0.1
needs_compiler = pytest.mark.skipif(COMPILER is None, reason="no C compiler")


def compiled(folder: Path, *flags: str) -> Path:
    assert COMPILER is not None
    library = folder / "stub.so"
    command = [COMPILER, "-shared", "-fPIC", "-w", *flags, str(SOURCE), "-o", str(library)]
    subprocess.run(command, check=True)
    return library


@pytest.fixture(scope="module")
def stub(tmp_path_factory) -> Path:
    if COMPILER is None:
        pytest.skip("no C compiler")
    return compiled(tmp_path_factory.mktemp("stub"))


@pytest.fixture
def make(stub, tmp_path):
    """Makes controllers whose library does what a word says from a time in s on."""
    made = []

    def controller(word: str = "pass", when: float = 0.0, **options) -> DisconController:
        (tmp_path / "word.in").write_text(f"{word} {when}\n")
        chosen = {"library": str(stub), "input_file": "word.in", "timeout_s": 5.0, **options}
        made.append(DisconController(DisconOptions(**chosen), NREL, tmp_path, STEP))
        return made[-1]

    yield controller
    for controller in made:
        controller.close()


def measured(step: int = 0, speed: float = 120.0) -> Measurements:
    return Measurements(
        step * STEP, speed / 97.0, speed, 40e3, 5e6, np.array([0.1, 0.2, 0.3]), 1.0, yaw_error=0.25
    )


def called(controller: DisconController, steps: int) -> list[Demands]:
    return [controller.demands(measured(i, 120.0 + i)) for i in range(steps)]


def calls(folder: Path) -> list[int]:
    return [int(line) for line in (folder / "calls").read_text().split()]


def gone(pid: int, within: float = 5.0) -> bool:
    """Whether a process ends within a time in s."""
    end = time.monotonic() + within
    while runs(pid):
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True


def runs(pid: int) -> bool:
    """Whether a process is there, and not only its number, which waits to be asked for."""
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    status = Path(f"/proc/{pid}/stat")
    return not (status.exists() and status.read_text().rpartition(")")[2].split()[0] == "Z")


def test_measurements_go_in_and_demands_come_out(make):
    demands = called(make(), 2)[1]
    assert demands.pitch == pytest.approx([0.11, 0.22, 0.33])
    assert demands.generator_torque == pytest.approx(120.0 + 121.0)
    assert demands.yaw_rate == pytest.approx(0.25)  # the library sees wind minus nacelle
    assert demands.brake == 0.0


def test_collective_pitch_is_the_common_demand(make):
    controller = make(pitch_control="collective")
    first, second = called(controller, 2)
    assert first.pitch == pytest.approx(np.full(3, 0.1))  # the stub repeats the last demand
    assert second.pitch == pytest.approx(first.pitch)


def test_the_library_is_called_first_and_last(make, tmp_path):
    controller = make()
    called(controller, 3)
    controller.close()
    assert calls(tmp_path) == [0, 1, 1, -1]


def test_a_library_that_was_never_called_is_not_closed_with_a_call(make, tmp_path):
    make().close()
    assert not (tmp_path / "calls").exists()


def test_brake_and_generator_switch(make):
    assert called(make("brake"), 1)[0].brake == pytest.approx(97.0 * 100.0)
    assert called(make("full", brake_torque_kN_m=28.0), 1)[0].brake == 28e3
    assert called(make("off"), 1)[0].generator_torque == 0.0


def test_what_is_asked_for_in_vain_is_told(make):
    controller = make("full")
    assert called(controller, 2)[0].brake == 0.0
    assert len(controller.notices) == 1
    assert "brake_torque_kN_m" in controller.notices[0]


def test_a_warning_is_told_once(make):
    controller = make("warn")
    called(controller, 3)
    assert [note.split(": ")[1] for note in controller.notices] == ["the wind is odd"]


@pytest.mark.parametrize(
    ("word", "says"),
    [
        ("fail", "the wind is impossible"),
        ("crash", "Segmentation fault"),
        ("exit", r"exit code 3(.|\n)*parameter 7 is missing"),
        ("nan", "record 47 of its answer is nan"),
    ],
)
def test_faults_say_what_and_when(make, word, says):
    controller = make(word, when=0.25)
    called(controller, 3)
    with pytest.raises(ControllerError, match=says) as caught:
        controller.demands(measured(3))
    assert caught.value.time == pytest.approx(0.3)
    assert "stub.so" in caught.value.where


def test_a_library_that_hangs_is_ended(make):
    controller = make("hang", when=0.1, timeout_s=0.4)
    called(controller, 1)
    began = time.monotonic()
    with pytest.raises(ControllerError, match=r"did not return within 0.4 s"):
        controller.demands(measured(1))
    assert time.monotonic() - began < 2.0
    assert gone(controller._process.pid)


def test_a_slow_library_has_its_time(make):
    assert len(called(make("slow", timeout_s=1.0), 2)) == 2


def test_what_a_library_prints_is_kept_where_it_is_wanted(make, tmp_path, capfd):
    controller = make("chatter", output_folder="kept")
    called(controller, 2)
    controller.close()
    assert "time 0.1" in (tmp_path / "kept" / "library.log").read_text()
    assert capfd.readouterr() == ("", "")


def test_a_library_is_brought_back_by_what_it_was_told(make):
    controller, other = make(), make()
    called(controller, 40)
    other.restore(controller.state())
    for i in range(40, 45):
        one, two = controller.demands(measured(i)), other.demands(measured(i))
        assert one.generator_torque == two.generator_torque
        assert np.array_equal(one.pitch, two.pitch)


def test_a_library_goes_back_in_time(make):
    controller = make()
    called(controller, 3)
    saved = controller.state()
    later = controller.demands(measured(3)).generator_torque
    controller.demands(measured(4))
    controller.restore(saved)
    assert controller.demands(measured(3)).generator_torque == later


def test_taking_back_the_present_state_costs_no_call(make, tmp_path):
    controller = make()
    called(controller, 3)
    controller.restore(controller.state())
    assert calls(tmp_path) == [0, 1, 1]


def test_a_library_with_other_answers_cannot_be_resumed(make):
    controller = make("random")
    called(controller, 3)
    with pytest.raises(InputError, match="it cannot be resumed"):
        make("random").restore(controller.state())


def test_a_call_that_was_interrupted_is_made_good(make, monkeypatch):
    controller, other = make(), make()
    called(controller, 3)
    process = controller._process

    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(process, "_await", interrupted)
    with pytest.raises(KeyboardInterrupt):
        controller.demands(measured(3))
    assert not gone(process.pid, within=0.1)
    again = controller.demands(measured(3)).generator_torque
    called(other, 3)
    assert again == other.demands(measured(3)).generator_torque


def test_a_closed_controller_begins_again_where_it_was(make):
    controller = make()
    before = called(controller, 3)[-1].generator_torque
    controller.close()
    assert controller.demands(measured(3, 7.0)).generator_torque == before + 7.0


@pytest.mark.skipif(sys.platform == "win32", reason="needs SIGKILL")
@pytest.mark.parametrize("word", ["pass", "hang"])
def test_no_process_is_left_when_the_simulation_is_killed(stub, tmp_path, word):
    (tmp_path / "word.in").write_text(f"{word} 0.05\n")
    (tmp_path / "temporary").mkdir()
    script = f"""
import sys; sys.path.insert(0, {str(Path(__file__).parent)!r})
import tempfile; tempfile.tempdir = {str(tmp_path / "temporary")!r}
import test_discon as t
from pathlib import Path
options = t.DisconOptions(library={str(stub)!r}, input_file="word.in")
controller = t.DisconController(options, t.NREL, Path({str(tmp_path)!r}), t.STEP)
controller.demands(t.measured(0))
print(controller._process.pid, flush=True)
controller.demands(t.measured(1))
import time; time.sleep(60)
"""
    parent = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
    assert parent.stdout is not None
    child = int(parent.stdout.readline())
    time.sleep(0.2)
    parent.send_signal(signal.SIGKILL)
    parent.wait()
    parent.stdout.close()
    assert gone(child)
    assert calls(tmp_path) == ([0, 1, -1] if word == "pass" else [0, 1])
    assert not list((tmp_path / "temporary").iterdir())


def controller_with(folder: Path, **options) -> DisconController:
    return DisconController(DisconOptions(**options), NREL, folder, STEP)


def test_the_guide_has_every_record():
    page = (Path(__file__).parents[2] / "docs" / "discon.md").read_text(encoding="utf-8")
    for record in MEASURED:
        assert f"| {record.number} | {record.what} | {record.unit} |" in page
    assert len({record.number for record in MEASURED}) == len(MEASURED)


def test_files_that_are_not_there(tmp_path, stub):
    with pytest.raises(InputError, match=r"there is no file .*nothing.so"):
        controller_with(tmp_path, library="nothing.so")
    with pytest.raises(InputError, match=r"there is no file .*nothing.in"):
        controller_with(tmp_path, library=str(stub), input_file="nothing.in")


def test_a_file_that_is_no_library(tmp_path):
    (tmp_path / "text.so").write_text("this is not a library\n" * 10)
    with pytest.raises(InputError, match="not a shared library"):
        controller_with(tmp_path, library="text.so")


@pytest.mark.skipif(sys.platform != "linux", reason="an ELF header")
def test_a_library_for_another_processor(tmp_path, stub):
    damaged = bytearray(stub.read_bytes())
    damaged[4] = 1  # the class of 32-bit files
    (tmp_path / "narrow.so").write_bytes(damaged)
    with pytest.raises(InputError, match="another kind of processor"):
        controller_with(tmp_path, library="narrow.so")


@needs_compiler
def test_a_library_without_the_procedure(tmp_path):
    library = compiled(tmp_path, "-DDISCON=SOMETHING")
    with pytest.raises(InputError, match="it has no procedure DISCON"):
        controller_with(tmp_path, library=str(library))


@needs_compiler
@pytest.mark.skipif(sys.platform != "linux", reason="the loader's words")
def test_a_library_that_needs_another(tmp_path):
    (tmp_path / "empty.c").write_text("void needed(void) {}\n")
    needed = tmp_path / "libneeded.so"
    subprocess.run([COMPILER, "-shared", "-fPIC", tmp_path / "empty.c", "-o", needed], check=True)
    library = compiled(tmp_path, "-Wl,--no-as-needed", f"-L{tmp_path}", "-lneeded")
    needed.unlink()
    with pytest.raises(InputError, match=r"libneeded.so(.|\n)*another library that is missing"):
        controller_with(tmp_path, library=str(library))


def case_with(library: Path, folder: Path, **control) -> dict:
    return {
        "galerna": 1, "turbine": "nrel5mw", "duration_s": 0.4, "time_step_s": 0.1,
        "inflow": {"wind_speed_m_s": 18.0}, "structure": "rigid",
        "operation": {"rotor_speed_rpm": 12.1, "pitch_deg": 14.8},
        "control": {
            "model": "discon", "library": str(library), "input_file": str(folder / "word.in"),
            **control,
        },
    }  # fmt: skip


def test_a_fault_ends_a_run_with_readable_results(stub, tmp_path):
    (tmp_path / "word.in").write_text("crash 0.25\n")
    with pytest.raises(ControllerError, match="crashed"):
        galerna.run(case_with(stub, tmp_path), tmp_path / "result.nc")
    result = galerna.open_result(tmp_path / "result.nc")
    assert "crashed" in result.attrs["status"]
    assert len(result["time"]) == 3


def test_a_run_closes_its_library(stub, tmp_path):
    (tmp_path / "word.in").write_text("pass\n")
    galerna.run(case_with(stub, tmp_path))
    assert calls(tmp_path) == [0, 1, 1, 1, -1]


class Stop(Callback):
    """What Ctrl-C does at a time in s."""

    def __init__(self, time: float) -> None:
        self.time = time

    def accepted(self, simulation: Simulation) -> None:
        if simulation.time >= self.time - 1e-9:
            raise KeyboardInterrupt


def test_an_interrupted_run_resumes_to_the_same_bits(stub, tmp_path):
    (tmp_path / "word.in").write_text("pass\n")
    case = case_with(stub, tmp_path)
    straight = galerna.run(case)
    with pytest.raises(KeyboardInterrupt):
        galerna.run(case, tmp_path / "result.nc", callbacks=[Stop(0.2)])
    assert calls(tmp_path)[-3:] == [0, 1, -1]
    resumed = galerna.resume(tmp_path / "result.nc")
    assert calls(tmp_path)[-5:] == [0, 1, 1, 1, -1]
    for name in straight.data_vars:
        np.testing.assert_array_equal(resumed[name], straight[name], err_msg=str(name))


def test_a_library_that_was_changed_cannot_be_resumed(stub, tmp_path):
    (tmp_path / "word.in").write_text("pass\n")
    with pytest.raises(KeyboardInterrupt):
        galerna.run(case_with(stub, tmp_path), tmp_path / "result.nc", callbacks=[Stop(0.2)])
    (tmp_path / "word.in").write_text("off\n")
    with pytest.raises(InputError, match="it cannot be resumed"):
        galerna.resume(tmp_path / "result.nc")


def test_the_sample_time_is_a_whole_number_of_steps(stub, tmp_path):
    (tmp_path / "word.in").write_text("pass\n")
    with pytest.raises(InputError, match="not a whole number of time steps"):
        galerna.run(case_with(stub, tmp_path, sample_time_s=0.25))


def test_rosco_that_is_not_installed(tmp_path, monkeypatch):
    monkeypatch.setattr("galerna.control.discon.find_spec", lambda name: None)
    with pytest.raises(InputError, match="pip install --no-deps rosco"):
        controller_with(tmp_path)


def test_rosco_needs_an_input_file(tmp_path, monkeypatch, stub):
    monkeypatch.setattr("galerna.control.discon.rosco_library", lambda: stub)
    with pytest.raises(InputError, match="ROSCO needs one"):
        controller_with(tmp_path)


needs_rosco = pytest.mark.skipif(find_spec("rosco") is None, reason="ROSCO is not installed")


@needs_rosco
def test_rosco_answers_a_steady_state_with_rated_torque():
    folder = examples.folder()
    controller = controller_with(folder, input_file="rosco_nrel5mw/DISCON.IN")
    rated = Measurements(0.0, 1.2671, 122.91, 43094.0, 5e6, np.full(3, 0.26), 0.0, wind_speed=18.0)
    demands = [controller.demands(replace(rated, time=STEP * i)) for i in range(20)]
    controller.close()
    assert demands[-1].generator_torque == pytest.approx(43094.0, rel=2e-3)
    assert demands[-1].pitch == pytest.approx(np.full(3, 0.26), abs=2e-3)


@needs_rosco
def test_rosco_resumes_to_the_same_bits():
    folder = examples.folder()
    one, two = (controller_with(folder, input_file="rosco_nrel5mw/DISCON.IN") for _ in range(2))
    called(one, 200)
    two.restore(one.state())
    first, second = one.demands(measured(200)), two.demands(measured(200))
    assert first.generator_torque == second.generator_torque
    assert np.array_equal(first.pitch, second.pitch)


@needs_rosco
def test_rosco_holds_the_nrel_5mw_at_its_published_point():
    """NREL/TP-500-38060, Table 7-1: 14.92 deg at 18 m/s for 12.1 rpm; OpenFAST with ROSCO 14.79."""
    case = load_case("rosco")
    values = {**case.document.values, "structure": "rigid", "duration_s": 25.0}
    values["control"]["input_file"] = str(case.folder / values["control"]["input_file"])
    values["operation"] = {"rotor_speed_rpm": 12.1, "pitch_deg": 14.8}
    end = galerna.run(values).isel(time=slice(-20, None)).mean("time")
    assert float(end["rotor_speed"]) / RPM == pytest.approx(12.1, rel=2e-3)
    assert np.degrees(float(end["pitch"].mean())) == pytest.approx(14.79, abs=0.15)
    assert float(end["electrical_power"]) == pytest.approx(5e6, rel=5e-3)
