"""Run a case to a result."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from galerna import __version__
from galerna.aero.vortex.options import VortexLatticeOptions
from galerna.case import Case, LoadedCase, load
from galerna.cite import references
from galerna.errors import GalernaError, InputError
from galerna.machine import Machine, build_machine
from galerna.results.log import Layout
from galerna.results.store import ResultFile, check_free
from galerna.simulation import Callback, Simulation

if TYPE_CHECKING:
    import xarray


def run(
    case: str | Path | Mapping[str, Any] | Case | LoadedCase,
    output: str | Path | None = None,
    *,
    duration: float | None = None,
    overwrite: bool = False,
    callbacks: Sequence[Callback] = (),
) -> xarray.Dataset:
    """Simulate a case (file, built-in name, dictionary or ``Case``) and return its result.

    With ``output`` the result is a NetCDF file too, whose records are on disk from the
    first on; a run that fails or is interrupted leaves what it had, and its ``status``
    says so. ``duration`` s replaces that of the case. Raises InputError, and
    ConvergenceError where a step fails.
    """
    loaded = case if isinstance(case, LoadedCase) else load(case)
    if duration is not None:
        loaded = loaded.lasting(duration)
    if output is None:
        _require_no_flow(loaded.case)
        with TemporaryDirectory(prefix="galerna-") as folder:
            return simulate(build_machine(loaded), Path(folder) / "result.nc", callbacks=callbacks)
    check_free(Path(output), overwrite)
    return simulate(build_machine(loaded), Path(output), overwrite, callbacks)


def simulate(
    machine: Machine, output: Path, overwrite: bool = False, callbacks: Sequence[Callback] = ()
) -> xarray.Dataset:
    """Run a machine that is built, into a result file."""
    settings = machine.case.case
    layout = Layout(machine.channels, machine.simulation.coordinates, _attributes(machine))
    writers = machine.flow_writers(output, overwrite)
    result = ResultFile(output, layout, overwrite)
    recorder = Recorder(result, settings.record_every, settings.outputs.start_s)
    try:
        machine.simulation.run(settings.duration_s, [recorder, *writers, *callbacks])
    except (GalernaError, KeyboardInterrupt) as error:
        reason = str(error).splitlines()[0] if str(error) else "interrupted"
        with suppress(InputError):  # a full disk: the log holds the records
            result.finish(f"stopped at {machine.simulation.time:.6g} s: {reason}")
        error.add_note(f"the records so far are in {output}")
        raise
    finally:
        machine.close()
    return result.finish(machine.simulation.stopped or "complete")


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

    def accepted(self, simulation: Simulation) -> None:
        if simulation.steps % self._every == 0 and simulation.time >= self._start:
            self._result.append(simulation.time, simulation.record())


def _attributes(machine: Machine) -> dict[str, str | float]:
    """Where a result comes from: enough to make it again."""
    case, settings = machine.case, machine.case.case
    return {
        "galerna_version": __version__,
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
    }
