"""The flow about a rotor as VTK files beside the result: blades and wakes, velocity in planes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from galerna.aero.vortex.options import FlowOutput
from galerna.aero.vortex.planes import Plane
from galerna.aero.vortex.vtk import Patch, Series
from galerna.errors import InputError
from galerna.simulation import Callback, Simulation

if TYPE_CHECKING:
    from galerna.aero.vortex.model import VortexLattice


def flow_folder(result: Path) -> Path:
    """The folder beside a result that its pictures of the flow go to."""
    return result.with_name(f"{result.stem}_flow")


class FlowWriter(Callback):
    """Writes the flow of a vortex lattice into a folder, every so many accepted steps.

    One series ``wake.pvd`` and one for each plane; ``options`` say which and when. A run that
    goes on ``since`` a time s continues the series that stand there. Raises InputError where a
    series stands in the folder and is not to be replaced.
    """

    def __init__(
        self,
        model: VortexLattice,
        options: FlowOutput,
        folder: Path,
        overwrite: bool = False,
        since: float | None = None,
    ) -> None:
        self._model, self._options, self._folder = model, options, folder
        planes = {plane.name: Plane.of(plane) for plane in options.planes}
        names = [*(["wake"] if options.wake else []), *planes]
        self._old = _earlier(folder, names) if since is None else []
        if self._old and not overwrite:
            hint = "name another result with --output, or replace it with --overwrite"
            raise InputError(str(self._old[0]), "pictures of a flow stand here already", hint)
        self._series = {name: Series(folder / f"{name}.pvd", since) for name in names}
        self._planes = planes

    def start(self, simulation: Simulation, end: float) -> None:
        """Make room, now that no other run writes here; know the steps between two pictures."""
        _remove(self._old)
        self._folder.mkdir(parents=True, exist_ok=True)
        self._every = max(round(self._options.interval_s / simulation.time_step), 1)

    def accepted(self, simulation: Simulation) -> None:
        """Write where a picture is due."""
        due = simulation.steps % self._every == 0 and simulation.time >= self._options.start_s
        if not due:
            return
        if self._options.wake:
            self._series["wake"].add(simulation.time, wake_patches(self._model))
        for name, plane in self._planes.items():
            self._series[name].add(simulation.time, [plane.patch(self._model.velocity)])


def wake_patches(model: VortexLattice) -> list[Patch]:
    """The wakes of all blades, then their bound vortices, with what stands on their panels."""
    sheets, blades = model.sheets(), len(model.blades)
    return [
        Patch(
            sheet.vertices,
            on_panels={
                "circulation [m2/s]": sheet.circulation,
                "blade": np.full(sheet.circulation.shape, i % blades + 1),
                "wake": np.full(sheet.circulation.shape, i < blades),
            },
        )
        for i, sheet in enumerate(sheets)
    ]


def _earlier(folder: Path, names: list[str]) -> list[Path]:
    """The series of an earlier run."""
    return [path for name in names for path in folder.glob(f"{name}.pvd")]


def _remove(series: list[Path]) -> None:
    for index in series:
        for path in index.parent.glob(f"{index.stem}_[0-9]*.vtp"):
            path.unlink()
        index.unlink()
