"""What the commands do: call the API and show what came back."""

from __future__ import annotations

import json
import shutil
import sys
from contextlib import AbstractContextManager, closing, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

from galerna import examples
from galerna.errors import GalernaError, InputError
from galerna.report import tables

if TYPE_CHECKING:
    import xarray

    from galerna.case import Case, LoadedCase
    from galerna.checkpoints import Checkpoint
    from galerna.coupling.tune import TuneSettings
    from galerna.inflow.field import WindField
    from galerna.inflow.options import InflowOptions
    from galerna.machine import Machine
    from galerna.saving import Saving

#: of a case's inflow, what a file with a turbulence box leaves out
NOT_IN_A_BOX = (
    "time_series",
    "time_series_file",
    "direction_deg",
    "upflow_deg",
    "veer_deg_per_m",
    "gust",
)

MOST_NOTICES = 5  #: that are printed after a run


def making_wind(case: Case) -> AbstractContextManager[None]:
    """Say that the wind is being made, where that takes a while."""
    from galerna.inflow.options import Generated
    from galerna.progress import working

    generated = isinstance(case.inflow.turbulence, Generated)
    return working("making the wind") if generated else nullcontext()


def _build(case: LoadedCase) -> Machine:
    """The machine of a case, with what is in doubt about it on stderr."""
    from galerna.machine import build_machine

    with making_wind(case.case):
        machine = build_machine(case)
    for doubt in machine.doubts():
        print(f"warning: {doubt}", file=sys.stderr)
    return machine


def run(
    case: str, output: Path | None, duration: float | None, overwrite: bool, saving: Saving
) -> None:
    """Simulate a case with a progress bar and print the statistics of its result."""
    from galerna.case import load
    from galerna.interrupting import interruptible
    from galerna.results.store import check_free

    loaded = load(case) if duration is None else load(case).lasting(duration)
    path = output or _default_output(case)
    check_free(path, overwrite)
    with interruptible():
        _simulate(_build(loaded), path, overwrite, saving)


def resume(
    result: Path, output: Path | None, duration: float | None, overwrite: bool, saving: Saving
) -> None:
    """Go on from a checkpoint, as ``run`` goes from the start."""
    from galerna import running
    from galerna.interrupting import interruptible
    from galerna.progress import working

    path = running.result_of(result)
    with interruptible():
        with working("building the machine again"):
            machine, checkpoint = running.resumed_machine(path, duration)
        print(f"goes on at {checkpoint.origin.time:g} s", file=sys.stderr)
        _simulate(machine, output or path, overwrite, saving, checkpoint)


def _simulate(
    machine: Machine,
    path: Path,
    overwrite: bool,
    saving: Saving,
    resumed: Checkpoint | None = None,
) -> None:
    from galerna import running
    from galerna.interrupting import AfterTheStep
    from galerna.progress import best

    beside = [best(sys.stderr.isatty()), AfterTheStep()]
    try:
        result = running.simulate(machine, path, overwrite, beside, saving, resumed)
    finally:
        _print_notices(machine)
    tables.print_statistics(result, path)


def _print_notices(machine: Machine) -> None:
    """What became known in a run, on stderr: the first few lines of it."""
    notices = machine.notices()
    for notice in notices[:MOST_NOTICES]:
        print(f"warning: {notice}", file=sys.stderr)
    if len(notices) > MOST_NOTICES:
        print(f"warning: ... and {len(notices) - MOST_NOTICES} more", file=sys.stderr)


def _default_output(case: str) -> Path:
    """``CASE.nc`` beside a case file, here for a built-in case."""
    path = Path(case)
    return path.with_suffix(".nc") if path.is_file() else Path(f"{path.name}.nc")


def check(case: str) -> None:
    """Build everything that a run needs, and say what it is."""
    from galerna.case import load
    from galerna.compiling import announced

    loaded = load(case)
    with announced(), closing(_build(loaded)) as machine:
        tables.print_pairs(machine.describe())
    print(f"{loaded.document.name}: ready to run")


def list_channels(case: str, pattern: str | None) -> None:
    """The channels of a case that a pattern names, all without one."""
    from galerna.case import load
    from galerna.channel_list import chosen

    tables.print_channels(*chosen(load(case), pattern))


def demo(folder: Path, duration: float | None) -> None:
    """Run the demonstration case into a folder of its own, and draw it."""
    from galerna import running
    from galerna.case import load
    from galerna.interrupting import AfterTheStep, interruptible
    from galerna.progress import best
    from galerna.report import plot_result

    loaded = load("demo") if duration is None else load("demo").lasting(duration)
    machine = _build(loaded)
    tables.print_pairs(machine.describe())
    path = folder / "demo.nc"
    beside = [best(sys.stderr.isatty()), AfterTheStep()]
    with interruptible():
        result = running.simulate(machine, path, True, beside)
    tables.print_statistics(result, path)
    _print_pictures(plot_result(result, folder, wind=machine.wind.field))


def list_examples(copy: Path | None) -> None:
    """Names of the built-in cases with what they are for; or copy everything to a folder."""
    from galerna.case import load

    if copy is not None:
        if copy.exists():
            raise InputError(str(copy), "exists already", "name a new folder")
        shutil.copytree(
            examples.folder(), copy, ignore=shutil.ignore_patterns("__pycache__", "*.nc")
        )
        print(f"cases and scripts are in {copy}")
        return
    rows = ((name, load(name).case.description) for name in examples.case_names())
    tables.print_rows("", ("case", "what it is"), rows, numbers_from=2)


def list_turbines() -> None:
    """Names and main figures of the built-in turbines."""
    from galerna import turbine as turbines

    built_in = [(name, turbines.load(name)) for name in turbines.names()]
    rows = [
        (
            name,
            t.name,
            f"{2.0 * t.rotor_radius:.0f}",
            f"{t.hub_height:.0f}",
            f"{t.control.rated_power / 1e6:g}",
            "floating" if t.platform else "fixed",
        )
        for name, t in built_in
    ]
    headings = ("name", "turbine", "diameter [m]", "hub height [m]", "rated [MW]", "stands")
    tables.print_rows("", headings, rows, numbers_from=2)


def hydro(turbine: str, output: Path | None, **settings: Any) -> None:
    """Compute a platform's coefficients into a file, and show them."""
    from galerna.hydro.computation import hydro_command
    from galerna.results.store import check_free

    path = output or Path(f"{Path(turbine).stem}.hydro.nc")
    check_free(path, overwrite=False)

    def progress(done: int, of: int) -> None:
        print(f"\r{done} of {of} frequencies", end="", file=sys.stderr, flush=True)

    _, path, rows = hydro_command(turbine, path, progress=progress, **settings)
    print(file=sys.stderr)
    shown = ((row.quantity, row.value, row.remark) for row in rows)
    tables.print_rows(str(path), ("quantity", "value", ""), shown, numbers_from=3)


def show_turbine(name: str) -> None:
    """A turbine's figures beside the published ones, with difference and source."""
    from galerna import turbine as turbines
    from galerna.compiling import announced
    from galerna.figures import frequencies, rated_point
    from galerna.turbine.summary import fitted_airfoils, summary

    turbine = turbines.load(name)
    solved: dict[str, float] = {}
    for solve in (rated_point, frequencies):
        try:
            with announced():
                solved |= solve(turbine)
        except GalernaError as error:
            print(f"not computed: {error}", file=sys.stderr)
    tables.print_figures(turbine.name, summary(turbine, solved))
    if fitted := fitted_airfoils(turbine):
        print(f"unsteady parameters fitted from the polar: {', '.join(fitted)}")
    for note in turbine.notes:
        print(f"note: {note}")


def tune(name: str, settings: TuneSettings, output: Path | None) -> None:
    """Gains of a turbine as a table, and as a file for its controller."""
    from galerna import turbine as turbines
    from galerna.compiling import announced
    from galerna.coupling.gains_file import write_gains
    from galerna.coupling.tune import tuned

    with announced():
        tuning = tuned(turbines.load(name), settings)
    tables.print_gains(tuning)
    if output is not None:
        write_gains(tuning, output)
        print(f"gains: {output}; a case reads them with control: {{gains: {output.name}}}")


def power_curve(
    name: str, plot: Path | None, csv: Path | None, step: float, flexible: bool = False
) -> None:
    """The steady operating curve as a table, a picture, a file."""
    import numpy as np

    from galerna import turbine as turbines
    from galerna.aero.bem import steady
    from galerna.compiling import announced
    from galerna.coupling.steady import steady_flexible
    from galerna.report import power_curve_figure
    from galerna.report.style import save

    turbine = turbines.load(name)
    control = turbine.control
    last = control.cut_out_wind_speed + 1e-9
    winds = np.arange(control.cut_in_wind_speed, last, step)
    with announced():
        if flexible:
            curve = steady_flexible(turbine, winds).drop_dims("radius")
        else:
            curve = steady.power_curve(turbine, winds)
    tables.print_curve(turbine.name, curve)
    if plot is not None:
        print(f"picture: {save(power_curve_figure(curve, turbine.name), plot)}")
    if csv is not None:
        _write_curve(curve, csv)
        print(f"table: {csv}")


def _write_curve(curve: xarray.Dataset, file: Path) -> None:
    """A steady operating curve as .csv in the units of the printed table, named in the header."""
    import pandas

    from galerna.report.style import shown

    columns = {}
    for name in ("wind_speed", *curve.data_vars):
        values, unit = shown(curve[name])
        columns[f"{name} [{unit}]" if unit != "1" else str(name)] = values
    pandas.DataFrame(columns).to_csv(file, index=False)


def wind(case: str, bts: Path | None, hawc2: Path | None, plot: Path | None) -> None:
    """The wind of a case in words, as files, as a picture."""
    from galerna.case import load
    from galerna.machine import build_wind, load_turbine
    from galerna.report import RotorCircle, inflow_figure
    from galerna.report.style import save

    loaded = load(case)
    turbine = load_turbine(loaded)
    with making_wind(loaded.case):
        built = build_wind(loaded, turbine)
    tables.print_pairs(("inflow", line) for line in built.description)
    if bts is not None or hawc2 is not None:
        _write_box(built.field, bts, hawc2)
        _name_left_out(loaded.case.inflow)
    if plot is not None:
        rotor = RotorCircle(turbine.hub_height, turbine.rotor_radius)
        figure = inflow_figure(built.field, rotor, loaded.case.duration_s, name=loaded.name)
        print(f"picture: {save(figure, plot)}")


def _write_box(field: WindField, bts: Path | None, hawc2: Path | None) -> None:
    from galerna.inflow.bts import write_bts
    from galerna.inflow.hawc2 import write_hawc2

    box = field.box
    if box is None:
        raise InputError("inflow", "has no turbulence to write", "add inflow.turbulence")
    if bts is not None:
        write_bts(bts, box, None if box.holds_mean else field.profile)
        print(f"TurbSim file: {bts}")
    if hawc2 is not None:
        print("HAWC2 files: " + ", ".join(str(path) for path in write_hawc2(hawc2, box)))


def _name_left_out(inflow: InflowOptions) -> None:
    """Say what of the wind stands in the case alone: a box holds no change over time or turn."""
    left_out = [name for name in NOT_IN_A_BOX if getattr(inflow, name)]
    if left_out:
        print(f"not in the file: {', '.join(left_out)}", file=sys.stderr)


def validate(names: list[str], list_only: bool, json_file: Path | None, page: Path | None) -> int:
    """Run validation cases and print their checks; 1 if one fails."""
    from galerna import validating

    chosen = validating.chosen(names)
    if list_only:
        rows = ((c.group, c.name, f"{c.seconds:g} s", c.title) for c in chosen)
        tables.print_rows("", ("group", "case", "cost", "what it holds"), rows, numbers_from=4)
        return 0
    from galerna.compiling import announced

    with announced():
        return validating.judge(chosen, json_file, page)


def plot(result: Path, channels: list[str], output: Path | None) -> None:
    """Draw a result into a folder; the inflow is made again from the case in it."""
    from galerna.machine import wind_of_result
    from galerna.report import plot_result

    dataset = _open(result)
    if dataset.attrs["status"] != "complete":
        print(f"{result}: {dataset.attrs['status']}", file=sys.stderr)
    folder = output or result.with_name(f"{result.stem}_plots")
    wind = None
    if not channels:
        try:
            wind = wind_of_result(dataset)
        except InputError as error:
            print(f"no picture of the inflow: {error}", file=sys.stderr)
    _print_pictures(plot_result(dataset, folder, channels, wind))


def _print_pictures(paths: list[Path]) -> None:
    print("pictures: " + ", ".join(str(path) for path in paths))


def export(result: Path, file: Path) -> None:
    """Write a result as .outb or .csv, by the name's ending."""
    from galerna.results import to_csv, to_outb

    writers = {".outb": to_outb, ".csv": to_csv}
    if file.suffix not in writers:
        raise InputError(str(file), f"ends with {file.suffix!r}, expected .outb or .csv")
    writers[file.suffix](_open(result), file)
    print(f"written: {file}")


def _open(result: Path) -> xarray.Dataset:
    """A result; InputError, which says so, where it is a case."""
    from galerna.results import open_result

    if result.suffix.lower() in (".yaml", ".yml"):
        raise InputError(str(result), "this is a case: galerna run it first")
    return open_result(result)


def cite(case: str, bibtex: bool) -> None:
    """The publications behind a case, as lines or as BibTeX."""
    from galerna.case import load
    from galerna.cite import references

    for reference in references(load(case).case):
        print(reference.bibtex if bibtex else f"- {reference.text}")


def schema() -> None:
    """The JSON schema of case files."""
    from galerna.schema import case_schema

    print(json.dumps(case_schema(), indent=2))
