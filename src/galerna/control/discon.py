"""A controller in a Bladed-style library, for instance ROSCO's, in a process of its own."""

from __future__ import annotations

import sys
import weakref
from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from zlib import crc32

import numpy as np

from galerna.control.discon_process import Answer, LibraryProcess, LibrarySetup
from galerna.control.discon_records import ASKED, FIRST_CALL, LATER_CALL, Swap
from galerna.control.interface import Demands, Measurements
from galerna.control.options import DisconOptions
from galerna.errors import ControllerError, InputError
from galerna.turbine.model import Turbine

ROSCO = "rosco"
INSTALL_ROSCO = "pip install --no-deps rosco is enough: the library needs nothing else of it"
SUFFIXES = {"win32": ".dll", "darwin": ".dylib"}


class DisconController:
    """A library that is called every ``sample_time`` s; see ``interface.Controller``.

    The memory of a library cannot be saved, so what it was told is: a controller that is
    restored tells it all to a fresh one, and holds its answers against those of before. ``close``
    calls for the last time and ends the process; so does the end of the program. Raises
    InputError where the library or its input file cannot be used.
    """

    def __init__(
        self, options: DisconOptions, turbine: Turbine, folder: Path, sample_time: float
    ) -> None:
        self.sample_time = sample_time
        individual, brake = options.pitch_control == "individual", 1e3 * options.brake_torque_kN_m
        self._swap = Swap(turbine, sample_time, individual, brake)
        self._setup = _setup(options, folder, self._swap)
        self._where = f"control, library {self._setup.library.name}"
        self._warnings: list[str] = []
        self._pitch: float
        self._begin()

    @property
    def notices(self) -> list[str]:
        """The library's warnings, and what it asks for in vain, once each."""
        return [f"{self._where}: {text}" for text in (*self._warnings, *self._swap.notices)]

    def demands(self, measured: Measurements) -> Demands:
        """What the library demands for what is measured.

        Raises ControllerError where it stops the simulation, crashes, hangs or demands what is
        not a number.
        """
        if not self._in_step():
            self.restore(self.state())
        first = not self._told
        before = float(measured.pitch[0]) if first else self._pitch
        row = self._swap.row(measured, FIRST_CALL if first else LATER_CALL, before)
        answer = self._call(row, measured.time)
        demands = self._swap.demands(answer.values, self._where, measured.time)
        self._pitch = float(demands.pitch[0])
        return demands

    def state(self) -> dict[str, np.ndarray]:
        """What the library was told, a row a call, and a sum over what it answered."""
        rows = np.frombuffer(self._told, dtype="<f4").reshape(-1, len(self._swap.told))
        return {
            "told": rows.copy(),
            "answered": np.array(self._answered),
            "pitch": np.array(self._pitch),
        }

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Bring a fresh library to ``state``; nothing to do for one that is there.

        Raises InputError where the library does not answer as it did before.
        """
        told = np.ascontiguousarray(state["told"], dtype="<f4")
        if told.shape[1] != len(self._swap.told):
            what = f"{told.shape[1]} values a call were saved, {len(self._swap.told)} are told"
            raise InputError(self._where, what, "the run began with another version: start again")
        if told.tobytes() == self._told and self._in_step():
            return
        self.close()
        self._begin()
        for row in told:
            self._call(row.tobytes(), float(row[2]))
        if self._answered != int(state["answered"]):
            raise InputError(
                self._where,
                "told the same as before, the library answers differently: it cannot be resumed",
                "has it, or a file that it reads, changed? Start the run again",
            )
        self._pitch = float(state["pitch"])

    def close(self) -> None:
        """Call the library for the last time and end its process; again does nothing."""
        self._end()

    def _in_step(self) -> bool:
        """Whether the library is there, and ahead by no call that was interrupted."""
        return self._end.alive and not self._process.answer_due

    def _begin(self) -> None:
        """A fresh library that was told nothing."""
        self._told, self._answered, self._pitch = bytearray(), 0, 0.0
        self._process: LibraryProcess = LibraryProcess(self._setup)
        self._end = weakref.finalize(self, self._process.close)

    def _call(self, row: bytes, time: float) -> Answer:
        answer = self._process.call(row, time)
        if answer.failure < 0:
            what = answer.message or f"it stops the simulation (aviFAIL {answer.failure})"
            raise ControllerError(self._where, what, self._words(), time)
        if answer.failure > 0 and answer.message and answer.message not in self._warnings:
            self._warnings.append(answer.message)
        self._told += row
        self._answered = crc32(answer.packed, self._answered)
        return answer

    def _words(self) -> str:
        words = self._process.last_words()
        return f"it printed: {words}" if words else ""


def _setup(options: DisconOptions, folder: Path, swap: Swap) -> LibrarySetup:
    """Files and records of a library, its paths relative to the case's folder."""
    library = rosco_library() if options.library == ROSCO else folder / options.library
    if not library.is_file():
        raise InputError("library", f"there is no file {library}", "'rosco' finds that of ROSCO")
    working, name = folder, ""
    if options.input_file is not None:
        given = (folder / options.input_file).resolve()
        if not given.is_file():
            raise InputError("input_file", f"there is no file {given}")
        working, name = given.parent, given.name
    elif options.library == ROSCO:
        raise InputError("input_file", "ROSCO needs one", "its examples have a DISCON.IN")
    output = options.output_folder
    return LibrarySetup(
        library=library.resolve(),
        folder=working.resolve(),
        input_file=name,
        told=swap.told,
        asked=ASKED,
        initial=swap.initial,
        constant=swap.constant,
        output_folder=None if output is None else folder / output,
        timeout=options.timeout_s,
    )


def rosco_library() -> Path:
    """The library in the installed package ``rosco``, which is not imported.

    Raises InputError where it is not installed.
    """
    package = find_spec(ROSCO)
    if package is None or not package.submodule_search_locations:
        raise InputError("library", "the package rosco is not installed", INSTALL_ROSCO)
    folder = Path(package.submodule_search_locations[0]) / "lib"
    library = folder / f"libdiscon{SUFFIXES.get(sys.platform, '.so')}"
    if not library.is_file():
        raise InputError("library", f"the package rosco has no {library}", INSTALL_ROSCO)
    return library
