"""Controllers in Python: found by name, and blamed by name when they fail."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from math import inf
from pathlib import Path
from traceback import extract_tb
from types import ModuleType
from typing import Any

import numpy as np

from galerna.contract import Array, Channel
from galerna.control.interface import Controller, Demands, Measurements
from galerna.errors import ControllerError, GalernaError, InputError, did_you_mean
from galerna.turbine.model import Turbine

WAYS = "write 'module:name' or 'file.py:name'"


def python_controller(place: str, turbine: Turbine, folder: Path) -> Controller:
    """The controller at a place, 'module:name' or 'file.py:name' from a folder.

    A class or a function is called with the turbine, anything else is the controller itself.
    Raises InputError where there is none.
    """
    module_name, colon, name = place.rpartition(":")
    if not colon or not module_name or not name:
        raise InputError("object", f"{place!r} does not say what is where", WAYS)
    module = _module(module_name, folder)
    found = getattr(module, name, None)
    if found is None:
        public = [known for known in vars(module) if not known.startswith("_")]
        raise InputError("object", f"{module_name} has no {name!r}", did_you_mean(name, public))
    if callable(found) and not (hasattr(found, "demands") and not isinstance(found, type)):
        found = _made(place, found, turbine)
    if not callable(getattr(found, "demands", None)):
        what = f"{place}, a {type(found).__name__}, has no method demands(measured)"
        raise InputError("object", what, "it is asked before every step for galerna's Demands")
    return found  # type: ignore[no-any-return]


def _module(name: str, folder: Path) -> ModuleType:
    try:
        return _module_of_file(folder / name) if name.endswith(".py") else import_module(name)
    except InputError:
        raise
    except ModuleNotFoundError as error:
        if error.name is not None and name.split(".")[0] == error.name.split(".")[0]:
            hint = f"{WAYS}; a file is looked for in {folder}"
            raise InputError("object", f"there is no module {name!r}", hint) from error
        raise InputError("object", f"{name} cannot be imported: {error}") from error
    except Exception as error:
        raise InputError("object", f"{name} cannot be imported: {_told(error)}") from error


def _module_of_file(file: Path) -> ModuleType:
    if not file.is_file():
        raise InputError("object", f"there is no file {file}", WAYS)
    spec = spec_from_file_location(f"galerna_controller_{file.stem}", file)
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    sys.modules[spec.name] = module  # where dataclasses and pickles look for it
    spec.loader.exec_module(module)
    return module


def _made(place: str, make: Callable[[Turbine], Any], turbine: Turbine) -> Any:
    try:
        return make(turbine)
    except Exception as error:
        raise InputError(
            "object", f"{place} called with the turbine raised {_told(error)}"
        ) from error


@contextmanager
def blamed(controller: object, time: float | None = None) -> Iterator[None]:
    """ControllerError, which names a controller and the time, for what it raises inside."""
    try:
        yield
    except GalernaError:
        raise
    except Exception as error:
        where = controller_name(controller)
        raise ControllerError(where, f"raised {_told(error)}", time=time) from error


def ask(controller: Controller, measured: Measurements) -> Demands:
    """The demands of a controller; ControllerError, which names it and the time, where it fails."""
    with blamed(controller, measured.time):
        demands = controller.demands(measured)
    if not isinstance(demands, Demands):
        what = f"answered with a {type(demands).__name__}"
        hint = "return galerna.control.interface.Demands(pitch, generator_torque)"
        raise ControllerError(controller_name(controller), what, hint, measured.time)
    return demands


def sample_time_of(controller: object) -> float:
    """Its own time s between calls, 0 where it has none; InputError for what is no time."""
    own = getattr(controller, "sample_time", None) or 0.0
    if not isinstance(own, int | float | np.number) or not 0.0 <= own < inf:
        where = controller_name(controller)
        raise InputError(where, f"its sample_time is {own!r}", "give seconds, or none")
    return float(own)


def channels_of(controller: object) -> tuple[Channel, ...]:
    """The channels of a controller; InputError where they are none, or nothing records them."""
    with blamed(controller):
        found = tuple(getattr(controller, "channels", ()))
    where, hint = controller_name(controller), "see galerna.contract.Channel"
    for channel in found:
        if not isinstance(channel, Channel):
            raise InputError(where, f"its channels have a {type(channel).__name__}", hint)
    if found and not callable(getattr(controller, "record", None)):
        raise InputError(where, "has channels and no method record()")
    return found


def record_of(
    controller: object, channels: Sequence[Channel], time: float
) -> Mapping[str, float | Array]:
    """The values of a controller's own channels now; ControllerError where they are none."""
    if not channels:
        return {}
    with blamed(controller, time):
        values = controller.record()  # type: ignore[attr-defined]
        return {channel.name: values[channel.name] for channel in channels}


def state_of(controller: object, time: float) -> dict[str, np.ndarray]:
    """What a controller remembers, copied; ControllerError for what cannot be saved."""
    if not hasattr(controller, "state"):
        return {}
    with blamed(controller, time):
        found = {str(name): np.array(value) for name, value in controller.state().items()}
    for name, value in found.items():
        if value.dtype.hasobject:
            what = f"its state {name!r} cannot be saved"
            hint = "numbers and arrays of them can be"
            raise ControllerError(controller_name(controller), what, hint, time)
    return found


def controller_name(controller: object) -> str:
    """How messages name a controller."""
    return f"control, {type(controller).__name__}"


def _told(error: Exception) -> str:
    """What an exception says, and where it was raised."""
    frames = extract_tb(error.__traceback__)
    place = f" in {Path(frames[-1].filename).name}, line {frames[-1].lineno}" if frames else ""
    return f"{type(error).__name__}: {error}{place}"
