"""Dynamic lines by MoorDyn v2 (Hall, github.com/FloatingArrayDesign/MoorDyn): lumped masses.

MoorDyn keeps the lines' state; the platform's motion over a step is straight from its last place
to the one that is tried. Every ``loads`` takes MoorDyn back to the accepted state and steps it
to there, so force and motion balance at the end of the step as for any other load; nothing
lags. The stiffness that goes with the force is that of catenaries, which only guides the search.
"""

from __future__ import annotations

import os
import sys
import tempfile
import weakref
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from galerna.contract import Array, Loads, Motion
from galerna.errors import InputError, SimulationError
from galerna.hydro.strips import Carrier
from galerna.turbine.platform import Mooring
from galerna.units import SEA_WATER, STANDARD_GRAVITY

from .catenary import RESTING
from .lines import tensions
from .model import Moored, channel_values, standing
from .moordyn_input import SEGMENTS, input_text
from .network import Found


def require_moordyn() -> ModuleType:
    """The package moordyn. Raises InputError where it is missing."""
    try:
        import moordyn
    except ImportError as missing:
        raise InputError(
            "platform.mooring",
            "dynamic lines need the package moordyn, which is not installed",
            "pip install 'galerna[moordyn]', or take mooring: quasi_static",
        ) from missing
    return moordyn


@contextmanager
def _quiet() -> Iterator[list[str]]:
    """Keep what a library writes to the terminal, and give it when the block ends."""
    said: list[str] = []
    sys.stdout.flush()
    sys.stderr.flush()
    kept = os.dup(1), os.dup(2)
    with tempfile.TemporaryFile() as file:
        os.dup2(file.fileno(), 1)
        os.dup2(file.fileno(), 2)
        try:
            yield said
        finally:
            for own, standard in zip(kept, (1, 2), strict=True):
                os.dup2(own, standard)
                os.close(own)
            file.seek(0)
            said.append(file.read().decode(errors="replace"))


class _System:
    """A MoorDyn system of a network: its lifetime and its calls."""

    def __init__(self, text: str, points: Array, velocity: Array, settle: bool) -> None:
        self._library = require_moordyn()
        folder = tempfile.TemporaryDirectory(prefix="galerna_moordyn_")
        file = Path(folder.name) / "lines.txt"
        file.write_text(text)
        self._handle: Any = None
        try:
            with _quiet() as said:
                self._handle = self._library.Create(str(file))
                start = self._library.Init if settle else self._library.Init_NoIC
                start(self._handle, points.ravel().tolist(), velocity.ravel().tolist())
        except RuntimeError as refused:
            raise InputError("mooring", f"MoorDyn refuses the lines: {_last(said)}") from refused
        self._end = weakref.finalize(self, _end, self._library, self._handle, folder)
        count = self._library.GetNumberLines(self._handle)
        self.lines = [self._library.GetLine(self._handle, 1 + i) for i in range(count)]

    def step(self, points: Array, velocity: Array, time: float, dt: float) -> Array:
        """Forces (k,3) N on the fairleads at ``time + dt`` s, moved with a constant velocity."""
        try:
            forces = self._library.Step(
                self._handle, points.ravel().tolist(), velocity.ravel().tolist(), time, dt
            )
        except RuntimeError as failed:
            raise SimulationError(
                "mooring", "MoorDyn cannot integrate the lines",
                "take a smaller time_step_s, or mooring: quasi_static", time,
            ) from failed  # fmt: skip
        return np.array(forces).reshape(-1, 3)

    def get(self) -> bytes:
        return bytes(self._library.Serialize(self._handle))

    def put(self, state: bytes) -> None:
        self._library.Deserialize(self._handle, state)

    def nodes(self, line: int) -> Array:
        """Places (s+1,3) m of a line's nodes, from the anchor's side."""
        count = self._library.GetLineNumberNodes(self.lines[line])
        return np.array([self._library.GetLineNodePos(self.lines[line], i) for i in range(count)])

    def segment_tensions(self, line: int) -> tuple[float, float]:
        """Tensions N of a line's first and last segment."""
        last = self._library.GetLineNumberNodes(self.lines[line]) - 1
        ends = (self._library.GetLineNodeTen(self.lines[line], i) for i in (0, last))
        first, second = (float(np.linalg.norm(tension)) for tension in ends)
        return first, second

    def close(self) -> None:
        self._end()


def _end(library: ModuleType, handle: Any, folder: tempfile.TemporaryDirectory[str]) -> None:
    library.Close(handle)
    folder.cleanup()


def _last(said: list[str]) -> str:
    """The last lines that a library said."""
    return "; ".join(line.strip() for line in "".join(said).splitlines()[-3:])


class DynamicLines(Moored):
    """Lines with inertia, drag and damping in still water, by MoorDyn (extra ``moordyn``).

    ``segments`` per line. Before the first step, and for the platform's equilibrium, the lines
    are catenaries. Waves and current do not reach them. See ``Moored``.
    """

    def __init__(
        self,
        mooring: Mooring,
        carrier: Carrier,
        depth: float,
        density: float = SEA_WATER,
        gravity: float = STANDARD_GRAVITY,
        *,
        segments: int = SEGMENTS,
    ) -> None:
        require_moordyn()
        super().__init__(mooring, carrier, depth, density, gravity)
        self._text = input_text(self.network, density, gravity, segments)
        self._system: _System | None = None
        self._accepted = b""
        self._from, self._time, self._dt = self._start[self.network.vessel], 0.0, 0.0
        self._total, self._shown = np.zeros(6), np.zeros(6)
        self._lines = self._lines_at_rest(standing(self.fairleads))

    def _lines_at_rest(self, motion: Motion) -> tuple[Array, Array, Array]:
        """Tensions N at the platform and at the other ends, lengths m on the seabed."""
        lines = self._found(motion).lines
        anchor, fairlead = tensions(lines)
        return fairlead, anchor, lines[:, RESTING].copy()

    def static_loads(self, motion: Motion) -> Loads:
        """The loads of the lines at rest."""
        return self.fairleads.loads(motion, self._found(motion))

    def begin_step(self, time: float, dt: float, motion: Motion) -> None:
        """Note where the step begins; the first one lets MoorDyn's lines settle there."""
        self._from = self.fairleads.points(motion, self._start)[self.network.vessel]
        self._time, self._dt = time, dt
        if self._system is None:
            velocity = self.fairleads.velocity(motion)
            self._system = _System(self._text, self._from, velocity, settle=True)
            self._accepted = self._system.get()

    def loads(self, time: float, motion: Motion) -> Loads:
        """Force and moment of MoorDyn's lines, with the stiffness of catenaries."""
        found = self._found(motion)
        if self._system is not None and self._dt > 0.0:
            found = self._stepped(found)
        loads = self.fairleads.loads(motion, found)
        self._total = np.concatenate([loads.force[0], loads.moment[0]])
        return loads

    def _stepped(self, found: Found) -> Found:
        """MoorDyn's forces where the fairleads are tried, in place of the catenaries'."""
        assert self._system is not None
        self._system.put(self._accepted)
        velocity = (found.points[self.network.vessel] - self._from) / self._dt
        force = found.force.copy()
        force[self.network.vessel] = self._system.step(self._from, velocity, self._time, self._dt)
        return Found(found.points, found.lines, force, found.stiffness)

    def end_step(self, time: float, motion: Motion) -> None:
        """MoorDyn stands where the last ``loads`` left it: keep that."""
        self._shown = self._total
        if self._system is not None:
            self._accepted = self._system.get()
            self._lines = self._lines_of(self._system)

    def _lines_of(self, system: _System) -> tuple[Array, Array, Array]:
        lines = [self._line_of(system, i) for i in range(len(self.network.ends))]
        fairlead, anchor, resting = np.array(lines).reshape(-1, 3).T
        return fairlead, anchor, resting

    def _line_of(self, system: _System, line: int) -> tuple[float, float, float]:
        """Tensions N at the platform's and the other end, length m on the seabed, of a line.

        An end bears the tension of its segment and half of that segment's weight, but for
        segments that rest: those whose ends are both within a diameter of the seabed.
        """
        nodes, (first, last) = system.nodes(line), system.segment_tensions(line)
        near = self.network.mooring.lines[line].line_type.diameter - self.network.depth
        down = (nodes[1:, 2] <= near) & (nodes[:-1, 2] <= near)
        segment, weight, _, _ = self.network.figures[line] / len(down)
        half = 0.5 * segment * weight * len(down)
        ends = (
            np.linalg.norm(tension * along / np.linalg.norm(along) + (0.0, 0.0, share))
            for tension, along, share in (
                (last, nodes[-1] - nodes[-2], 0.0 if down[-1] else half),
                (first, nodes[1] - nodes[0], 0.0 if down[0] else -half),
            )
        )
        fairlead, anchor = (float(end) for end in ends)
        return fairlead, anchor, float(down.sum() * segment)

    def record(self) -> Mapping[str, float | Array]:
        """The channels of the accepted step."""
        return channel_values(*self._lines, self._shown)

    def state(self) -> dict[str, np.ndarray]:
        """MoorDyn's own state, byte by byte; empty before the first step."""
        return {"moordyn": np.frombuffer(self._accepted, dtype=np.uint8).copy()}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take MoorDyn back to what ``state`` gave."""
        self._accepted = np.asarray(state["moordyn"], dtype=np.uint8).tobytes()
        if not self._accepted:  # before the first step, which lets the lines settle
            self.close()
            return
        if self._system is None:
            still = np.zeros_like(self._from)
            self._system = _System(self._text, self._from, still, settle=False)
        self._system.put(self._accepted)

    def close(self) -> None:
        """End MoorDyn and remove its files."""
        if self._system is not None:
            self._system.close()
            self._system = None
