"""Run a case to a result."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any
from uuid import uuid4

from galerna import __version__, checkpoints
from galerna.aero.vortex.options import VortexLatticeOptions
from galerna.case import Case, LoadedCase, load
from galerna.checkpoints import Checkpoint
from galerna.cite import references
from galerna.compiling import Report
from galerna.errors import ControllerError, GalernaError, InputError
from galerna.machine import Machine, build_machine
from galerna.results.earlier import EarlierRecords
from galerna.results.log import Layout
from galerna.results.store import ResultFile, check_free
from galerna.saving import Checkpointer, Saving
from galerna.simulation import Callback, Simulation

if TYPE_CHECKING:
    import xarray

log = logging.getLogger("galerna")


def run(
    case: str | Path | Mapping[str, Any] | Case | LoadedCase,
    output: str | Path | None = None,
    *,
    duration: float | None = None,
    overwrite: bool = False,
    callbacks: Sequence[Callback] = (),
    saving: Saving | None = None,
) -> xarray.Dataset:
    """Simulate a case (file, built-in name, dictionary or ``Case``) and return its result.

    With ``output`` the result is a NetCDF file too, whose records are on disk from the
    first on; a run that fails or is interrupted leaves what it had, and its ``status``
    says so, with a checkpoint from which ``resume`` goes on. ``duration`` s replaces that of
    the case. Raises InputError, and ConvergenceError where a step fails.
    """
    loaded = case if isinstance(case, LoadedCase) else load(case)
    if duration is not None:
        loaded = loaded.lasting(duration)
    if output is None:
        _require_no_flow(loaded.case)
        with TemporaryDirectory(prefix="galerna-") as folder:
            path = Path(folder) / "result.nc"
            return simulate(build_machine(loaded), path, callbacks=callbacks, saving=saving)
    check_free(Path(output), overwrite)
    return simulate(build_machine(loaded), Path(output), overwrite, callbacks, saving)


def resume(
    result: str | Path,
    output: str | Path | None = None,
    *,
    duration: float | None = None,
    overwrite: bool = False,
    callbacks: Sequence[Callback] = (),
    saving: Saving | None = None,
) -> xarray.Dataset:
    """Go on from the checkpoint beside a result, to the bits of a run that was never stopped.

    The result itself grows, or ``output`` gets all of it. ``duration`` s replaces that of the
    case: a run that kept its checkpoint can go on after its end. Raises InputError where there
    is no checkpoint or it does not fit, and as ``run`` does.
    """
    path = result_of(Path(result))
    machine, checkpoint = resumed_machine(path, duration)
    target = path if output is None else Path(output)
    return simulate(machine, target, overwrite, callbacks, saving, checkpoint)


def result_of(path: Path) -> Path:
    """The result that a log or a checkpoint stands beside; a result itself."""
    return path.with_suffix("") if path.suffix in (".log", ".checkpoint") else path


def resumed_machine(result: Path, duration: float | None = None) -> tuple[Machine, Checkpoint]:
    """The machine of a result in the state of its checkpoint, and that.

    ``duration`` s replaces that of the case. Raises InputError where there is no checkpoint, or
    the turbine, the wind or the version are no longer what they were.
    """
    checkpoint = checkpoints.read(result)
    EarlierRecords(result, checkpoint.origin.records).require_run(checkpoint.origin.run)
    for difference in checkpoint.differences():
        log.warning("the last bits may differ from those of an unbroken run: %s", difference)
    machine = build_machine(checkpoint.case(duration))
    try:
        checkpoint.give(machine)
    except GalernaError:
        machine.close()
        raise
    return machine, checkpoint


def simulate(
    machine: Machine,
    output: Path,
    overwrite: bool = False,
    callbacks: Sequence[Callback] = (),
    saving: Saving | None = None,
    resumed: Checkpoint | None = None,
) -> xarray.Dataset:
    """Run a machine that is built into a result file, and close it.

    ``saving`` says when checkpoints are written. A machine that was ``resumed`` continues the
    records of its result, or begins a new one with them.
    """
    try:
        return _Run(machine, output, overwrite, saving or Saving(), resumed).go(callbacks)
    finally:
        machine.close()


class _Run:
    """One run of a machine with all that it writes."""

    def __init__(
        self,
        machine: Machine,
        output: Path,
        overwrite: bool,
        saving: Saving,
        resumed: Checkpoint | None,
    ) -> None:
        settings = machine.case.case
        origin = resumed.origin if resumed else None
        run = origin.run if origin else uuid4().hex
        times = (*origin.resumed, origin.time) if origin else ()
        self.machine, self.saving = machine, saving
        attributes = _attributes(machine, run, times)
        layout = Layout(machine.channels, machine.simulation.coordinates, attributes)
        earlier = None
        if resumed is not None:
            earlier = EarlierRecords(resumed.result, resumed.origin.records)
        in_place = resumed is not None and resumed.result == output
        since = machine.simulation.time if in_place else None
        self.writers = machine.flow_writers(output, overwrite, since)
        self.result = ResultFile(output, layout, overwrite, earlier)
        self.recorder = Recorder(self.result, settings.record_every, settings.outputs.start_s)
        self.checkpoints = Checkpointer(machine, self.recorder, run, saving, times)
        if not in_place:
            self.checkpoints.remove()  # it belongs to the result that was here

    def go(self, callbacks: Sequence[Callback]) -> xarray.Dataset:
        """March to the end and give the result."""
        simulation = self.machine.simulation
        try:
            beside = [Report(), self.recorder, *self.writers, *callbacks, self.checkpoints]
            simulation.run(self.machine.case.case.duration_s, beside)
        except (GalernaError, KeyboardInterrupt) as error:
            self._stopped(error)
            raise
        if simulation.stopped or self.saving.keep:
            self.checkpoints.save()
        dataset = self.result.finish(simulation.stopped or "complete")
        if not (simulation.stopped or self.saving.keep):
            self.checkpoints.remove()
        return dataset

    def _stopped(self, error: BaseException) -> None:
        """Leave a readable result, a checkpoint, and a note on where they are."""
        reason = str(error).splitlines()[0] if str(error) else "interrupted"
        with suppress(ControllerError):  # it cannot say what it remembers: ``error`` tells
            self.checkpoints.save()
        with suppress(InputError):  # a full disk: the log holds the records
            self.result.finish(f"stopped at {self.machine.simulation.time:.6g} s: {reason}")
        for note in self._what_is_left():
            error.add_note(note)

    def _what_is_left(self) -> Iterator[str]:
        """What a stopped run leaves, a line each."""
        path, commander = self.result.path, self.machine.simulation.commander
        if not self.recorder.records:
            yield "nothing was recorded yet"
        else:
            yield f"the records so far are in {path}"
        if obstacle := getattr(commander, "resumable", ""):
            yield f"the run cannot be resumed: {obstacle}"
        elif self.recorder.steps and self.checkpoints.path.exists():
            yield f"galerna resume {path} goes on from its last checkpoint"


def _require_no_flow(case: Case) -> None:
    """InputError for a case that writes files beside its result, where no result is kept."""
    options = case.aerodynamics
    if isinstance(options, VortexLatticeOptions) and options.flow_output is not None:
        hint = "give the result a file, run(case, output), or leave flow_output out"
        raise InputError("aerodynamics.flow_output", "there is no folder for its files", hint)


class Recorder(Callback):
    """Writes every so many accepted steps to a result, from a time in s on."""

    def __init__(self, result: ResultFile, every: int, start: float) -> None:
        self._result, self._every, self._start = result, every, start
        self.path = result.path
        self.steps = 0  #: of the simulation that are in the result, or leave no record

    @property
    def records(self) -> int:
        """How many are written."""
        return self._result.records

    def start(self, simulation: Simulation, end: float) -> None:
        """All steps before this run are written."""
        self.steps = simulation.steps

    def accepted(self, simulation: Simulation) -> None:
        """Write the record that is due."""
        if simulation.steps % self._every == 0 and simulation.time >= self._start:
            self._result.append(simulation.time, simulation.record())
        self.steps = simulation.steps

    def sync(self) -> None:
        """Bring the records to the disk itself."""
        self._result.sync()


def _attributes(machine: Machine, run: str, resumed: Sequence[float]) -> dict[str, str | float]:
    """Where a result comes from: enough to make it again."""
    case, settings = machine.case, machine.case.case
    at = {"resumed_at_s": ", ".join(f"{time:.9g}" for time in resumed)} if resumed else {}
    return {
        "galerna_version": __version__,
        "run": run,
        "case_name": case.name,
        "case": case.document.text,
        "case_folder": str(case.folder),
        "duration_s": settings.duration_s,
        "turbine": machine.turbine.name,
        "hub_height_m": machine.turbine.hub_height,
        "rotor_radius_m": machine.turbine.rotor_radius,
        "seed": settings.seed,
        "references": "\n".join(reference.text for reference in references(settings)),
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        **at,
    }
