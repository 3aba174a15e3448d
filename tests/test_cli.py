"""The command line: exit codes, what is printed, and how fast it starts."""

import json
import os
import re
import shlex
import signal
import subprocess
import sys
import time

import pytest
from typer.testing import CliRunner

from galerna import checkpoints
from galerna.cli import app, main
from galerna.results import open_result

CASE = """\
galerna: 1
turbine: nrel5mw
duration_s: 2
time_step_s: 0.05
inflow: {wind_speed_m_s: 8.0}
operation: {rotor_speed_rpm: 9.16, pitch_deg: 0.0}
"""
COMMANDS = [command.name or command.callback.__name__ for command in app.registered_commands]


@pytest.fixture
def case(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "case.yaml"
    path.write_text(CASE)
    return path


def galerna(*arguments):
    """Exit code of a command."""
    with pytest.raises(SystemExit) as exit_:
        main([str(a) for a in arguments])
    return exit_.value.code


def test_importing_galerna_is_quick_and_silent():
    code = "import time; t = time.perf_counter(); import galerna; print(time.perf_counter() - t)"
    process = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert float(process.stdout) < 1.0
    assert process.stderr == ""


def test_help_is_quick_and_loads_nothing_heavy():
    code = (
        "import sys, galerna.cli as cli\n"
        "try: cli.main(['--help'])\n"
        "except SystemExit: pass\n"
        "heavy = {'numba', 'xarray', 'matplotlib', 'scipy', 'pydantic'} & set(sys.modules)\n"
        "assert not heavy, heavy"
    )
    begin = time.perf_counter()
    subprocess.run([sys.executable, "-c", code], capture_output=True, check=True)
    assert time.perf_counter() - begin < 2.0  # 0.3 s on an idle machine


@pytest.mark.parametrize("name", [c.replace("_", "-") for c in COMMANDS])
def test_help_of_every_command_has_an_example(name):
    result = CliRunner().invoke(app, [name, "--help"], env={"COLUMNS": "200"})
    assert result.exit_code == 0
    assert f"galerna {name}" in result.stdout.split("Example:")[1]


def examples_in_help():
    """The command lines that the help texts name, by command."""
    for command in app.registered_commands:
        for line in re.findall(r"galerna [^>]*?(?=   | >|$)", command.epilog.split("[/bold]")[1]):
            yield shlex.split(line)[1:]


RUNS = [arguments for arguments in examples_in_help() if arguments[0] == "run"]


def test_every_command_is_among_the_examples():
    assert {arguments[0] for arguments in examples_in_help()} == {
        name.replace("_", "-") for name in COMMANDS
    }


@pytest.mark.parametrize("arguments", RUNS, ids=" ".join)
def test_the_example_of_run_is_a_case_that_can_be_built(arguments, tmp_path, monkeypatch):
    """All checks before the building, which test_examples does with a coarser wind."""
    from galerna import commands

    reached = []

    def build(case):
        reached.append(case.case.duration_s)
        raise KeyboardInterrupt

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(commands, "_build", build)
    assert galerna(*arguments) == 130
    assert reached == [float(arguments[arguments.index("--duration") + 1])]


QUICK = [a for a in examples_in_help() if a[0] in ("examples", "turbine", "turbines", "cite")]


@pytest.mark.parametrize("arguments", QUICK, ids=" ".join)
def test_an_example_that_is_quick_runs(arguments, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert galerna(*arguments) == 0
    assert capsys.readouterr().out.strip()


def test_cases_of_the_examples_are_there():
    """What a case or turbine argument names is built in, or plainly the user's own file."""
    from galerna import examples, turbine_names

    for command, *rest in examples_in_help():
        if command in ("run", "wind", "cite", "check") and not rest[0].startswith("my_"):
            assert rest[0] in examples.case_names()
        if command in ("turbine", "power-curve"):
            assert rest[0] in turbine_names()


def test_a_duration_that_leaves_no_record_is_named_itself(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert galerna("run", "turbulent", "--duration", 60) == 2
    error = capsys.readouterr().err
    assert "--duration 60: outputs.start_s: 60 s leaves nothing" in error
    assert not list(tmp_path.iterdir())


def test_doubts_are_warnings_before_a_run(case, capsys):
    case.write_text(CASE.replace("9.16", "-9.16"))
    for command in ("check", "run"):
        assert galerna(command, case) == 0
        captured = capsys.readouterr()
        assert "warning: the rotor turns backwards, at -9.16 rpm" in captured.err
        assert "backwards" not in captured.out


def test_a_case_without_doubts_has_no_warnings(case, capsys):
    assert galerna("check", case) == 0
    assert capsys.readouterr().err == ""


def test_making_the_wind_is_said(case, capsys):
    case.write_text(TURBULENT)
    assert galerna("check", case) == 0
    assert capsys.readouterr().err == "making the wind ...\n"


@pytest.mark.parametrize("command", [("plot",), ("export", "r.csv")])
def test_a_case_in_place_of_a_result_is_told_apart(command, case, capsys):
    name, *rest = command
    assert galerna(name, case, *rest) == 2
    assert "this is a case: galerna run it first" in capsys.readouterr().err


def test_run_writes_beside_the_case_and_prints_a_table(case, capsys):
    assert galerna("run", case) == 0
    assert open_result(case.with_suffix(".nc")).sizes["time"] == 20
    printed = capsys.readouterr().out
    assert "aerodynamic power" in printed
    assert "case.nc" in printed


def test_run_does_not_replace_a_result_unasked(case, capsys):
    assert galerna("run", case, "--output", "r.nc", "--duration", "0.5") == 0
    assert galerna("run", case, "--output", "r.nc") == 2
    assert "--overwrite" in capsys.readouterr().err
    assert galerna("run", case, "--output", "r.nc", "--overwrite") == 0
    assert open_result("r.nc").sizes["time"] == 20


def test_bad_input_is_exit_code_2_and_no_traceback(case, capsys):
    case.write_text(CASE.replace("turbine:", "turbin:"))
    assert galerna("check", case) == 2
    captured = capsys.readouterr()
    assert "did you mean 'turbine'" in captured.err
    assert "Traceback" not in captured.err + captured.out


def test_a_bad_option_is_exit_code_2():
    assert galerna("run", "--no-such-option") == 2
    assert galerna("rnu") == 2


def test_no_convergence_is_exit_code_3(case, capsys, monkeypatch):
    from galerna.errors import ConvergenceError
    from galerna.simulation import Simulation

    def fail(self):
        raise ConvergenceError("rotor", "no balance", time=0.5)

    monkeypatch.setattr(Simulation, "advance", fail)
    assert galerna("run", case) == 3
    error = capsys.readouterr().err
    assert "rotor at t = 0.5 s: no balance" in error
    assert "nothing was recorded yet" in error


def test_a_path_that_cannot_be_written_is_exit_code_2(case, capsys):
    assert galerna("run", case, "--output", "/proc/no/r.nc") == 2
    assert "Traceback" not in capsys.readouterr().err


def test_check_says_what_would_run(case, capsys):
    assert galerna("check", case) == 0
    printed = capsys.readouterr().out
    assert "40 steps of 0.05 s" in printed
    assert "ready to run" in printed


def test_check_finds_what_only_the_built_machine_can_tell(case, capsys):
    case.write_text(CASE + "outputs: {channels: [rotor_trust]}\n")
    assert galerna("check", case) == 2
    assert "case.yaml:7: outputs.channels[0]" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("sent", "code", "word"),
    [(signal.SIGINT, 130, "interrupted"), (signal.SIGTERM, 143, "terminated")],
)
def test_interrupting_leaves_a_result(case, sent, code, word):
    """Ctrl-C and a batch system's SIGTERM: no traceback, a readable result."""
    arguments = ["run", str(case), "--duration", "100000"]
    program = f"from galerna.cli import main; main({arguments!r})"
    process = subprocess.Popen([sys.executable, "-c", program], stderr=subprocess.PIPE, text=True)
    log = case.with_suffix(".nc.log")
    limit = time.monotonic() + 60.0
    while not (log.exists() and log.stat().st_size > 50_000) and time.monotonic() < limit:
        time.sleep(0.05)
    process.send_signal(sent)
    _, error = process.communicate(timeout=60)
    assert process.returncode == code, error
    assert word in error
    assert "Traceback" not in error
    result = open_result(case.with_suffix(".nc"))
    assert result.sizes["time"] > 0
    assert result.attrs["status"].endswith(f"s: {word}")
    assert "galerna resume" in error
    kept = checkpoints.read(case.with_suffix(".nc")).origin
    assert kept.records == result.sizes["time"]
    assert kept.time == pytest.approx(float(result["time"][-1]), abs=0.11)


def test_a_kept_checkpoint_lets_a_run_go_on(case, capsys):
    assert galerna("run", case, "--duration", 1, "--keep-checkpoint") == 0
    assert galerna("resume", "case.nc") == 2
    assert "a longer --duration" in capsys.readouterr().err
    assert galerna("resume", "case.nc.checkpoint", "--duration", 2) == 0
    captured = capsys.readouterr()
    assert "goes on at 1 s" in captured.err
    assert "result: case.nc" in captured.out
    assert open_result("case.nc").sizes["time"] == 20


def test_what_has_no_checkpoint_is_not_resumed(case, capsys):
    assert galerna("resume", "case.nc") == 2
    assert "there is no checkpoint beside this result" in capsys.readouterr().err


def test_turbines_and_their_figures(capsys):
    assert galerna("turbines") == 0
    assert "nrel5mw_oc3" in capsys.readouterr().out
    assert galerna("turbine", "nrel5mw") == 0
    assert "NREL/TP-500-38060" in capsys.readouterr().out


def test_power_curve_as_table_picture_and_file(tmp_path, capsys):
    plot, csv = tmp_path / "c.png", tmp_path / "c.csv"
    assert galerna("power-curve", "nrel5mw", "--plot", plot, "--csv", csv, "--step", 7) == 0
    assert "C_P" in capsys.readouterr().out
    assert plot.stat().st_size > 10_000
    header, *rows = csv.read_text().splitlines()
    assert len(rows) == 4
    assert header.startswith("wind_speed [m/s],rotor_speed [rpm],pitch [deg],power [MW],")
    last = dict(zip(header.split(","), map(float, rows[-1].split(",")), strict=True))
    assert last["rotor_speed [rpm]"] == pytest.approx(12.1, rel=1e-3)
    assert 20.0 < last["pitch [deg]"] < 25.0  # 24 m/s: published 22.35 deg


TURBULENT = CASE.replace(
    "{wind_speed_m_s: 8.0}",
    "{wind_speed_m_s: 8.0, turbulence: {kind: mann, turbulence_intensity: 0.1,"
    " points_across: 8, time_step_s: 0.4}}",
)


def test_wind_is_described_written_and_drawn(case, capsys):
    case.write_text(TURBULENT)
    assert galerna("wind", case, "--bts", "w.bts", "--hawc2", "w", "--plot", "w.png") == 0
    assert "Mann box" in capsys.readouterr().out
    assert {"w.bts", "w_u.bin", "w_v.bin", "w_w.bin", "w.png"} <= set(os.listdir())


def test_the_written_wind_drives_the_same_rotor(case):
    """The TurbSim file of a case's wind gives the case's loads, to its 16-bit resolution."""
    case.write_text(TURBULENT)
    assert galerna("wind", case, "--bts", "w.bts") == 0
    assert galerna("run", case, "--output", "a.nc") == 0
    start = TURBULENT.index("inflow:")
    file = "inflow: {turbulence: {kind: file, path: w.bts}}\n" + CASE.splitlines()[-1]
    case.write_text(TURBULENT[:start] + file)
    assert galerna("run", case, "--output", "b.nc") == 0
    thrust = [open_result(name)["rotor_thrust"].values for name in ("a.nc", "b.nc")]
    assert abs(thrust[1] - thrust[0]).max() < 1e-3 * thrust[0].max()


def test_wind_that_a_file_cannot_hold_is_named(case, capsys):
    turned = "{direction_deg: 20, gust: {kind: EOG, start_s: 1}, wind_speed_m_s"
    case.write_text(TURBULENT.replace("{wind_speed_m_s", turned))
    assert galerna("wind", case, "--bts", "w.bts") == 0
    assert "not in the file: direction_deg, gust" in capsys.readouterr().err


def test_wind_without_turbulence_cannot_be_written(case, capsys):
    assert galerna("wind", case, "--bts", "w.bts") == 2
    assert "no turbulence to write" in capsys.readouterr().err


def test_plot_and_export_a_result(case, capsys):
    assert galerna("run", case) == 0
    result = case.with_suffix(".nc")
    assert galerna("plot", result, "-c", "rotor_thrust", "-c", "angle_of_attack") == 0
    folder = case.with_name("case_plots")
    assert {p.name for p in folder.iterdir()} == {"rotor.png", "spanwise.png"}
    assert galerna("plot", result, "-c", "rotor_trust") == 2
    assert "did you mean 'rotor_thrust'" in capsys.readouterr().err
    assert galerna("export", result, "r.outb") == 0
    assert galerna("export", result, "r.csv") == 0
    assert galerna("export", result, "r.xls") == 2


def test_cite_lists_what_the_case_uses(case, capsys):
    case.write_text(TURBULENT + "aerodynamics: {model: bem, dynamic_inflow: none}\n")
    assert galerna("cite", case) == 0
    printed = capsys.readouterr().out
    assert "10.1002/we.1636" in printed
    assert "Mann" in printed
    assert "Snel" not in printed
    assert galerna("cite", case, "--bibtex") == 0
    assert "@article{Ning2014," in capsys.readouterr().out


def test_validate_lists_its_cases_and_refuses_unknown_ones(capsys):
    assert galerna("validate", "--list") == 0
    assert "what it holds" in capsys.readouterr().out
    assert galerna("validate", "no_such_group") == 2


def test_the_printed_schema_is_json(capsys):
    assert galerna("schema") == 0
    assert json.loads(capsys.readouterr().out)["properties"]["turbine"]["type"] == "string"


def test_every_option_that_is_cited_exists():
    from galerna.aero.bem.options import BemOptions
    from galerna.aero.vortex.options import VortexLatticeOptions
    from galerna.cite import AERODYNAMICS, TURBINES
    from galerna.turbine import names

    assert set(TURBINES) == set(names())
    models = {"bem": BemOptions, "vortex_lattice": VortexLatticeOptions}
    assert set(AERODYNAMICS) == set(models)
    for model, options in AERODYNAMICS.items():
        for option, values in options.items():
            for value in values:
                models[model].model_validate({"model": model, option: value})
