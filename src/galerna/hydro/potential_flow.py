"""Linear potential flow on a rigid platform, as a load model.

About the platform's reference point,

    F = F_b - C p - A_inf a - int K v + F_w + F_d - B_a v

with the buoyancy F_b and its stiffness C (or the buoyancy of the displaced hull instead), the
displacement p, velocity v and acceleration a of the reference point, wave excitation F_w,
drift F_d and additional linear damping B_a. F_w and F_d hold in axes that are turned about z by
the platform's mean yaw; A_inf, K and B_a in those that lean with it on average, too. There are
no products of velocities in A_inf: linear potential flow has none.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import cos, inf, nan, sin
from typing import Protocol

import numpy as np

from galerna.contract import Array, Loads, Motion, Stations
from galerna.hydro.database import HydroDatabase
from galerna.hydro.platform_options import PlatformOptions
from galerna.turbine.platform import Platform

from .drift import MeanDrift, SlowDrift
from .excitation import WaveExcitation
from .heading import MeanHeading, MeanLean, mean_axes
from .platform_sum import PARTS, add_up, channels_of, seen_from
from .radiation import (
    Convolution,
    Memory,
    NoMemory,
    RadiationStateSpace,
    StateSpaceMemory,
    fit_radiation,
)
from .waves.sea import Sea


class Buoyancy(Protocol):
    """Pressure of still water on a hull at a position (3,) m and a rotation (3,3).

    Its wrench (6,) N, N m about the frame's origin and its stiffness (6,6), both in global axes.
    """

    def loads(self, position: Array, rotation: Array) -> tuple[Array, Array]: ...


class PotentialFlow:
    """Buoyancy, added mass, radiation, waves, drift and linear damping of a rigid platform.

    ``sea`` None is still water. ``buoyancy`` stands in for the linear one where it is given;
    ``radiation`` is a fit made before. ``heading`` rad is the platform's where the options fix it.
    Raises InputError for a database that lacks what sea or options need.
    """

    stations: tuple[Stations, ...] = (Stations("platform"),)
    largest_step: float = inf

    def __init__(
        self,
        platform: Platform,
        database: HydroDatabase,
        sea: Sea | None = None,
        options: PlatformOptions | None = None,
        *,
        buoyancy: Buoyancy | None = None,
        radiation: RadiationStateSpace | None = None,
        heading: float = 0.0,
    ) -> None:
        options = options or PlatformOptions()
        reference = np.array(platform.reference_point, dtype=float)
        if np.abs(database.reference_point - reference).max() > 1e-9:
            database = database.moved(reference)
        self.buoyancy = buoyancy
        self.channels = channels_of()
        self.coordinates: Mapping[str, Array] = {}
        fixed = heading if options.heading == "fixed" else None
        self.heading = MeanHeading(options.heading_cut_off_hz, fixed)
        self.lean = MeanLean(options.lean_cut_off_hz, options.added_mass_axes == "upright")
        self.memory, added_mass, self.notes = _memory(database, options, radiation)
        #: the coefficients, with the added mass at infinite frequency that goes with the memory
        self.database = replace(database, added_mass_infinite=added_mass)
        self._excitation, self._drift = _wave_loads(database, sea, options)
        if self._excitation is not None:
            self.notes += self._excitation.notes
        damping = platform.additional_damping if options.additional_damping else np.zeros((6, 6))
        stiffness = database.hydrostatic_stiffness * (buoyancy is None)
        # of the loads in order: stiffness, additional damping, added mass, radiation's damping
        self._matrices = np.stack([stiffness, damping, added_mass, np.zeros((6, 6))])
        self._reference = reference
        self._given = np.zeros((4, 6))  # buoyancy at rest, radiation, excitation, drift
        if buoyancy is None:
            self._given[0] = _buoyancy(database)
        self._psi, self._dt = 0.0, 0.0
        self._tilt, self._axes = np.zeros(3), np.eye(3)
        self._waves_at = (nan, nan)
        self._trial = np.zeros((len(PARTS), 6))
        self._shown = np.zeros((len(PARTS), 6))

    def begin_step(self, time: float, dt: float, motion: Motion) -> None:
        """What the memory of the water makes of a step, in axes that it holds."""
        self._dt = dt
        self._take_axes(motion.rotation[0])
        self._given[1], self._matrices[3] = self.memory.begin(dt, self._velocity(motion))

    def _take_axes(self, rotation: Array) -> None:
        """Hold the mean axes of a step that begins with a rotation (3,3)."""
        self._psi, self._tilt = self.heading.over_step(rotation), self.lean.over_step(rotation)
        self._axes = mean_axes(self._psi, self._tilt)

    def _velocity(self, motion: Motion) -> Array:
        """Velocity (6,) of the platform in its mean axes."""
        return seen_from(self._axes, motion.velocity, motion.angular_velocity)

    def loads(self, time: float, motion: Motion) -> Loads:
        """Force and moment on the platform with their stiffness, damping and mass."""
        if self._dt == 0.0:  # before the first step
            self._take_axes(motion.rotation[0])
        if (time, self._psi) != self._waves_at:  # a step asks more than once
            self._take_waves(time)
        return self._sum(motion, self._psi, self._axes, self._given, self._trial)

    def _take_waves(self, time: float) -> None:
        """Excitation and drift at a time s."""
        if self._excitation is not None:
            self._given[2] = self._excitation.at(time, self._psi)
        if self._drift is not None:
            self._given[3] = self._drift.at(time, self._psi)
        self._waves_at = time, self._psi

    def _sum(self, motion: Motion, psi: float, axes: Array, given: Array, parts: Array) -> Loads:
        """All loads at a heading rad and in mean axes (3,3); fills ``parts`` (7,6)."""
        blocks = np.empty((3, 1, 6, 6))
        force, moment = np.empty((1, 3)), np.empty((1, 3))
        wrench = np.zeros(6)
        if self.buoyancy is not None:
            wrench, stiffness = self.buoyancy.loads(motion.position[0], motion.rotation[0])
        add_up(
            motion.position, motion.rotation, motion.velocity, motion.angular_velocity,
            motion.acceleration, motion.angular_acceleration, cos(psi), sin(psi), axes,
            self._reference, self._matrices, given, wrench, parts, force, moment, blocks,
        )  # fmt: skip
        if self.buoyancy is not None:
            blocks[0, 0] += stiffness
        return Loads(force, moment, blocks[0], blocks[1], blocks[2])

    def static_loads(self, motion: Motion) -> Loads:
        """Buoyancy and mean drift on a platform that rests there, its mean yaw settled."""
        psi = self.heading.settled(motion.rotation[0])
        rest = Motion.at_rest(1)
        rest.position, rest.rotation = motion.position, motion.rotation
        given = np.zeros((4, 6))
        given[0] = self._given[0]
        if self._drift is not None:
            given[3] = self._drift.mean(psi)
        return self._sum(rest, psi, self.axes_at(motion), given, np.empty((len(PARTS), 6)))

    def axes_at(self, motion: Motion) -> Array:
        """Axes (3,3) of added mass and radiation as a step or a linear motion begins there."""
        rotation = motion.rotation[0]
        return mean_axes(self.heading.settled(rotation), self.lean.over_step(rotation))

    def settle(self, motion: Motion) -> None:
        """Take the platform's place at rest, about which it is going to move."""
        self.lean.settle(motion.rotation[0])

    def end_step(self, time: float, motion: Motion) -> None:
        """Commit the memory, the mean yaw and lean; keep the loads for the record."""
        self.memory.commit(self._velocity(motion))
        self.heading.commit(self._dt, self._psi, motion.rotation[0])
        self.lean.commit(self._dt, self._tilt, motion.rotation[0])
        self._shown[:] = self._trial

    def record(self) -> Mapping[str, float | Array]:
        """The channels of the accepted step."""
        names = (channel.name for channel in self.channels)
        return dict(zip(names, self._shown.ravel().tolist(), strict=True))

    def state(self) -> dict[str, np.ndarray]:
        """Memory of the water, mean yaw and lean."""
        return self.memory.state() | self.heading.state() | self.lean.state()

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take ``state`` back."""
        self.memory.restore(state)
        self.heading.restore(state)
        self.lean.restore(state)


def _memory(
    database: HydroDatabase, options: PlatformOptions, radiation: RadiationStateSpace | None
) -> tuple[Memory, Array, tuple[str, ...]]:
    """The memory of the water, the added mass (6,6) that goes with it, and what is to be said."""
    if options.radiation == "state_space":
        fit = radiation or fit_radiation(database)
        return StateSpaceMemory(fit), fit.added_mass_infinite, fit.notes
    infinite = database.added_mass_infinite
    if options.radiation == "convolution":
        return Convolution.of(database, options.radiation_memory_s), infinite, ()
    return NoMemory(), infinite, ()


def _wave_loads(
    database: HydroDatabase, sea: Sea | None, options: PlatformOptions
) -> tuple[WaveExcitation | None, MeanDrift | SlowDrift | None]:
    """Excitation and drift of a sea that has waves."""
    if sea is None or sea.is_still:
        return None, None
    excitation = WaveExcitation(database, sea)
    if options.heading == "mean_yaw":
        excitation.prepare()
    if options.drift == "none":
        return excitation, None
    return excitation, (MeanDrift if options.drift == "mean" else SlowDrift)(database, sea)


def _buoyancy(database: HydroDatabase) -> Array:
    """Buoyancy (6,) N, N m of the platform where it was described."""
    x, y, _ = database.center_of_buoyancy - database.reference_point
    return database.buoyancy * np.array([0.0, 0.0, 1.0, y, -x, 0.0])
