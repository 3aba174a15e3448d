"""Checkpoints: all that a run needs to go on to the same bits, in one file beside its result.

The file is NumPy's .npz without pickled objects: the state of every part by its name, the wind at
places and times of the run, and a text in JSON that says what the rest belongs to.
"""

from __future__ import annotations

import json
import os
import platform
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, is_dataclass
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np

from galerna import __version__
from galerna.case import LoadedCase, parse
from galerna.contract import Array
from galerna.errors import InputError
from galerna.machine import Machine
from galerna.results.dataset import checkpoint_of

FORMAT = 1
WIND_TIMES = 200  #: at which the wind is compared
START_AGAIN = "start again with galerna run"
STATE = "state/"


@dataclass(frozen=True)
class Origin:
    """What a checkpoint belongs to.

    ``duration`` s is that of the case, ``time`` s and ``records`` are how far the run had come,
    ``run`` names the run and stands in its result too. ``obstacle`` says why the run cannot be
    resumed, if so.
    """

    run: str
    case: str
    case_name: str
    folder: str
    duration: float
    time: float
    records: int
    turbine: str
    operation: str
    resumed: tuple[float, ...] = ()
    obstacle: str = ""
    format: int = FORMAT
    galerna: str = __version__

    @classmethod
    def of(cls, machine: Machine, run: str, records: int, resumed: tuple[float, ...]) -> Origin:
        """The origin of a machine's present state."""
        case, operation = machine.case, machine.operation
        duration = case.case.duration_s
        mean_speed = f"{operation.rotor_speed.mean(duration):.12g}"
        return cls(
            run=run,
            case=case.document.text,
            case_name=case.document.name,
            folder=str(case.folder),
            duration=duration,
            time=machine.simulation.time,
            records=records,
            turbine=digest(machine.turbine),
            operation=digest((operation, mean_speed)),
            resumed=resumed,
            obstacle=getattr(machine.simulation.commander, "resumable", ""),
        )


@dataclass(frozen=True, eq=False)
class Checkpoint:
    """A state of a run, what it belongs to, and the wind (times, places, 3) m/s it had."""

    result: Path
    origin: Origin
    environment: Mapping[str, str]
    wind: Array
    state: Mapping[str, np.ndarray]

    def case(self, duration: float | None = None) -> LoadedCase:
        """The case of the run, over its own duration or another, s.

        Raises InputError where that ends before the checkpoint.
        """
        origin = self.origin
        duration = origin.duration if duration is None else duration
        case = parse(origin.case, origin.case_name, origin.folder).lasting(duration)
        left = duration - origin.time
        if left < 0.5 * case.case.time_step_s:
            what = f"the run has come to {origin.time:g} s, its end is at {duration:g} s"
            hint = "a longer --duration lets it go on"
            raise InputError(str(self.result), what, hint)
        return case

    def give(self, machine: Machine) -> None:
        """Put a machine into the state of the checkpoint; InputError where it is another one."""
        origin = Origin.of(machine, "", 0, ())
        for what, mine, its in (
            ("turbine", self.origin.turbine, origin.turbine),
            ("operation", self.origin.operation, origin.operation),
        ):
            if mine != its:
                found = f"the {what} is not what it was when the run began"
                raise InputError(str(self.result), found, START_AGAIN)
        self._require_wind(machine)
        try:
            machine.simulation.restore(self.state)
        except (KeyError, ValueError, IndexError) as error:
            what = f"its state does not fit the machine ({error})"
            raise InputError(str(self.result), what, START_AGAIN) from error

    def _require_wind(self, machine: Machine) -> None:
        if np.array_equal(self.wind, wind_samples(machine, self.origin.duration)):
            return
        duration = machine.case.case.duration_s
        if duration != self.origin.duration:
            what = (
                f"the wind made for {duration:g} s is another from its start on than that "
                f"made for {self.origin.duration:g} s"
            )
            hint = (
                "run the case anew for the longer time, or give turbulence `points` and "
                "`spacing_m`, which make the same box for every duration"
            )
            raise InputError(str(self.result), what, hint)
        what = "the wind is not what it was when the run began; has a file changed?"
        raise InputError(str(self.result), what, START_AGAIN)

    def differences(self) -> tuple[str, ...]:
        """What is other than it was when the checkpoint was written, and may change last bits."""
        now = environment()
        return tuple(
            f"{name} {self.environment.get(name, '?')} is now {found}"
            for name, found in now.items()
            if self.environment.get(name) != found
        )


def write(path: Path, origin: Origin, wind: Array, state: Mapping[str, np.ndarray]) -> None:
    """Write a checkpoint, whole or not at all; InputError if the disk does not take it."""
    about = json.dumps({"origin": asdict(origin), "environment": environment()})
    arrays = {f"{STATE}{name}": value for name, value in state.items()}
    unfinished = _unfinished(path)
    try:
        with unfinished.open("wb") as file:
            np.savez(file, allow_pickle=False, about=np.array(about), wind=wind, **arrays)
            file.flush()
            os.fsync(file.fileno())
        os.replace(unfinished, path)
        _sync_folder(path.parent)
    except OSError as error:
        unfinished.unlink(missing_ok=True)
        raise InputError(str(path), f"cannot be written: {error.strerror or error}") from error


def remove(path: Path) -> None:
    """Leave no checkpoint, nor what a run that was killed has begun of one."""
    path.unlink(missing_ok=True)
    _unfinished(path).unlink(missing_ok=True)


def _unfinished(path: Path) -> Path:
    return path.with_name(path.name + ".unfinished")


def read(result: Path) -> Checkpoint:
    """The checkpoint beside a result.

    Raises InputError where there is none, or one that cannot be read or resumed.
    """
    path = checkpoint_of(result)
    if not path.is_file():
        what = "there is no checkpoint beside this result"
        hint = "runs that end keep theirs with --keep-checkpoint; " + START_AGAIN
        raise InputError(str(result), what, hint)
    try:
        with np.load(path, allow_pickle=False) as file:
            about = json.loads(str(file["about"]))
            wind = file["wind"]
            state = {n.removeprefix(STATE): file[n] for n in file.files if n.startswith(STATE)}
        entries = about["origin"]
        _require_version(path, entries)
        origin = Origin(**{**entries, "resumed": tuple(entries["resumed"])})
        checkpoint = Checkpoint(result, origin, about["environment"], wind, state)
    except (OSError, EOFError, BadZipFile, ValueError, KeyError, TypeError) as error:
        raise InputError(str(path), f"is not a checkpoint ({error})", START_AGAIN) from error
    if origin.obstacle:
        raise InputError(str(path), f"the run cannot be resumed: {origin.obstacle}", START_AGAIN)
    return checkpoint


def _require_version(path: Path, origin: Mapping[str, Any]) -> None:
    """InputError for what another version has written: it computes other bits."""
    found = origin.get("galerna"), origin.get("format")
    if found != (__version__, FORMAT):
        what = f"galerna {found[0]} has written this, and here is {__version__}"
        raise InputError(str(path), what, f"resume with that version, or {START_AGAIN}")


def wind_samples(machine: Machine, duration: float) -> Array:
    """The wind (times, places, 3) m/s at the hub and about it, during ``duration`` s.

    Afloat a last place has the wave elevation m at the platform in its first column.
    """
    turbine = machine.turbine
    reach = 0.7 * turbine.rotor_radius
    hub = np.array([0.0, 0.0, turbine.hub_height])
    around = [[0, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]
    places = hub + reach * np.array(around, dtype=float)
    times = np.linspace(0.0, duration, WIND_TIMES).tolist()
    wind = np.array([machine.wind.field.velocity(places, time) for time in times])
    if machine.afloat is None:
        return wind
    waves = np.zeros((len(times), 1, 3))
    waves[:, 0, 0] = [machine.afloat.probe.record(time)["wave_elevation"] for time in times]
    return np.concatenate([wind, waves], axis=1)


def environment() -> dict[str, str]:
    """What the last bits depend on beside galerna: versions, processor, threads."""
    import numba
    from llvmlite.binding import get_host_cpu_name

    versions = {name: version(name) for name in ("numpy", "scipy", "numba")}
    return {
        "python": platform.python_version(),
        **versions,
        "processor": get_host_cpu_name(),
        "threads": str(numba.get_num_threads()),
    }


def digest(value: object) -> str:
    """A number that tells data of any depth from other data, in hexadecimal digits."""
    found = sha256()
    _feed(found, value)
    return found.hexdigest()


def _feed(into: Any, value: object) -> None:
    into.update(type(value).__name__.encode())
    if isinstance(value, np.ndarray):
        into.update(repr(value.shape).encode())
        into.update(value.tobytes())
    elif is_dataclass(value):
        for entry in fields(value):
            _feed(into, getattr(value, entry.name))
    elif isinstance(value, Mapping):
        for key, inner in value.items():
            _feed(into, key)
            _feed(into, inner)
    elif isinstance(value, tuple | list):
        for inner in value:
            _feed(into, inner)
    else:
        into.update(repr(value).encode())


def _sync_folder(folder: Path) -> None:
    """Bring a new name to the disk, where the system can."""
    if not hasattr(os, "O_DIRECTORY"):  # Windows
        return
    handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
