"""Write a state to a file and take it up again, to the same bits."""

from __future__ import annotations

from pathlib import Path
from zipfile import BadZipFile

import numpy as np

from galerna.errors import InputError

from .system import ARRAYS, State, System


def save(state: State, path: Path) -> None:
    """Write everything the next step depends on to a file in NumPy's .npz format."""
    arrays = {name: getattr(state, name) for name in ARRAYS}
    with Path(path).open("wb") as file:
        np.savez(file, allow_pickle=False, time=np.array(state.time), **arrays)


def load(system: System, path: Path) -> State:
    """The state in a file; raises InputError if it does not belong to this system."""
    expected = system.initial_state()
    try:
        with np.load(path) as file:
            found = {name: file[name] for name in ("time", *ARRAYS)}
    except (OSError, EOFError, BadZipFile, TypeError, ValueError, KeyError) as error:
        raise InputError(str(path), f"not a checkpoint of a structure: {error}") from error
    for name in ARRAYS:
        shape = getattr(expected, name).shape
        if found[name].shape != shape:
            raise InputError(
                str(path),
                f"{name} has the shape {found[name].shape}, the structure's frames need {shape}",
                "restart with the case that wrote the checkpoint",
            )
    return State(float(found["time"]), *(found[name] for name in ARRAYS))
