"""Describe a structure by frames, beams, joints and constraints; build the system of it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError, did_you_mean

from .beam import Beam
from .bodies import moved, weight_of
from .constraints import Constraint
from .joints import ALL, Joint, Path
from .pairs import Pairs
from .redundancy import check_constraints
from .system import Root, System

GROUND = "ground"


class Structure:
    """What the machine is made of, in the shape in which it is described.

    ``gravity`` (3,) m/s2 in global axes. Names are given once and found again in errors,
    results and ``System.names``.
    """

    def __init__(self, gravity: Sequence[float] = (0.0, 0.0, -9.80665)) -> None:
        self.gravity = np.array(gravity, dtype=float)
        self.frames: dict[str, int] = {}
        self._position: list[Array] = []
        self._rotation: list[Array] = []
        self._mass: list[Array] = []
        self._weight: list[Array] = []
        self._pairs: list[dict[str, object]] = []
        self._constraints: list[Constraint] = []
        self._drives: list[tuple[int, Path]] = []
        self._roots: dict[str, tuple[int, Array | None]] = {}  # None: all on the frame
        self.frame(GROUND, np.zeros(3))

    def frame(
        self, name: str, position: Array, rotation: Array | None = None, mass: Array | None = None
    ) -> str:
        """A frame at ``position`` (3,) m with axes ``rotation`` (3,3), and a mass matrix (6,6)."""
        if name in self.frames:
            raise InputError(name, "there is a frame of this name already", "choose another")
        R = np.eye(3) if rotation is None else rotation
        _check_place(name, position, R)
        self.frames[name] = len(self.frames)
        self._position.append(np.array(position, dtype=float))
        self._rotation.append(np.array(R, dtype=float))
        self._mass.append(np.zeros((6, 6)))
        self._weight.append(np.zeros(4))
        if mass is not None:
            self.add_mass(name, mass)
        return name

    def add_mass(self, frame: str, mass: Array, weighs: bool = True) -> None:
        """Add a mass matrix (6,6) in the frame's axes; added mass of water does not weigh."""
        i = self.index(frame)
        if np.shape(mass) != (6, 6) or not (np.isfinite(mass).all() and (np.diag(mass) >= 0).all()):
            raise InputError(
                frame, "its mass must be a matrix (6,6) of finite numbers, none negative "
                "on the diagonal", "rigid_body makes one",
            )  # fmt: skip
        self._mass[i] = self._mass[i] + mass
        if weighs:
            self._weight[i] = self._weight[i] + weight_of(mass)

    def beam(self, name: str, beam: Beam, root: str | None = None) -> list[str]:
        """Frames ``name[0]`` ... of a beam, chained by its elements.

        With ``root``, an existing frame carries the beam's first section rigidly, wherever
        that stands, and no joint is needed.
        """
        names: list[str] = []
        share = None
        for i in range(len(beam.span)):
            if i == 0 and root is not None:
                x, R = self.place(root, beam.position[0], beam.rotation[0])
                share = moved(beam.mass[0], R, x)
                self.add_mass(root, share)
                names.append(root)
                continue
            names.append(self.frame(f"{name}[{i}]", beam.position[i], beam.rotation[i],
                                    beam.mass[i]))  # fmt: skip
        self._roots[name] = self.index(names[0]), share
        for e in range(len(beam.reference)):
            first, second = names[e], names[e + 1]
            offset = self.place(first, beam.position[e], beam.rotation[e])
            self._add_pair(
                f"{name}:{e}", first, second, offset, (np.zeros(3), np.eye(3)),
                beam.reference[e], beam.stiffness[e], beam.damping[e], (),
                has_offset=e == 0 and root is not None,
            )  # fmt: skip
        return names

    def join(self, joint: Joint) -> None:
        """Add a joint or spring; raises InputError where its name is taken."""
        if any(pair["name"] == joint.name for pair in self._pairs):
            raise InputError(joint.name, "there is a joint of this name already", "choose another")
        _check_place(joint.name, joint.position, joint.axes)
        places = [
            self.place(frame, joint.position, joint.axes) for frame in (joint.first, joint.second)
        ]
        if joint.placement is not None:
            places[0] = self._drive(joint, places[0])
        self._add_pair(
            joint.name, joint.first, joint.second, places[0], places[1],
            np.zeros(6), joint.stiffness, joint.damping, joint.locked, has_offset=True,
            inertance=joint.inertance,
        )  # fmt: skip

    def constrain(self, constraint: Constraint) -> None:
        """Add a constraint of any other kind."""
        for frame in constraint.frames:
            self.index(frame)
        self._constraints.append(constraint)

    def position(self, name: str) -> Array:
        """Where a frame stands (3,) m."""
        return self._position[self.index(name)]

    def index(self, name: str) -> int:
        """The number of a frame; raises InputError with the nearest names."""
        if name not in self.frames:
            raise InputError(name, "no such frame", did_you_mean(name, self.frames))
        return self.frames[name]

    def build(self, check: bool = True) -> System:
        """The system; raises InputError where joints are redundant or a frame has no mass."""
        for name, mass in zip(self.frames, self._mass, strict=True):
            if name != GROUND and not np.linalg.eigvalsh(mass).min() > 0.0:
                raise InputError(name, "the frame has no mass or no inertia in some direction",
                                 "give it a mass matrix")  # fmt: skip
        nodes = [np.array([self.index(f) for f in c.frames]) for c in self._constraints]
        system = System(
            list(self.frames), [str(p["name"]) for p in self._pairs], self._gather(),
            np.array(self._mass), np.array(self._weight), self.gravity,
            np.array(self._position), np.array(self._rotation), self._drives,
            list(zip(self._constraints, nodes, strict=True)),
            {beam: self._root(*root) for beam, root in self._roots.items()},
        )  # fmt: skip
        system.constraint_sizes  # noqa: B018  refuses constraints of the wrong shape
        if check:
            check_constraints(system)
        return system

    def place(self, frame: str, position: Array, rotation: Array) -> tuple[Array, Array]:
        """A global position and rotation in the axes of a frame."""
        i = self.index(frame)
        R = self._rotation[i]
        return R.T @ (position - self._position[i]), R.T @ rotation

    def _root(self, node: int, share: Array | None) -> Root:
        if share is None:
            return Root(node, self._mass[node], self._weight[node])
        return Root(node, share, weight_of(share))

    def _drive(self, joint: Joint, place: tuple[Array, Array]) -> tuple[Array, Array]:
        """Make a joint's first side move in time."""
        placement = joint.placement
        assert placement is not None

        def driven(time: float) -> tuple[Array, Array]:
            x, R = placement(time)
            return place[0] + place[1] @ x, place[1] @ R

        self._drives.append((len(self._pairs), driven))
        return driven(0.0)

    def _add_pair(
        self, name: str, first: str, second: str, at_first: tuple[Array, Array],
        at_second: tuple[Array, Array], reference: Array, stiffness: Array, damping: Array,
        locked: tuple[int, ...], has_offset: bool, inertance: float = 0.0,
    ) -> None:  # fmt: skip
        self._pairs.append(
            {
                "name": name,
                "ends": (self.index(first), self.index(second)),
                "has_offset": has_offset,
                "offset_position": np.array([at_first[0], at_second[0]]),
                "offset_rotation": np.array([at_first[1], at_second[1]]),
                "reference": reference,
                "stiffness": stiffness,
                "damping": damping,
                "locked": [k in locked for k in ALL],
                "inertance": inertance,
            }
        )

    def _gather(self) -> Pairs:
        def column(key: str, *shape: int) -> Array:
            return np.array([p[key] for p in self._pairs], dtype=float).reshape((-1, *shape))

        damping = column("damping", 6, 6)
        return Pairs(
            ends=column("ends", 2).astype(np.int64),
            has_offset=column("has_offset") != 0.0,
            offset_rotation=column("offset_rotation", 2, 3, 3),
            offset_position=column("offset_position", 2, 3),
            reference=column("reference", 6),
            stiffness=column("stiffness", 6, 6),
            damping=damping,
            damped=np.abs(damping).max(axis=(1, 2), initial=0.0) > 0.0,
            preload=np.zeros((len(damping), 6)),
            locked=column("locked", 6) != 0.0,
            drive_twist=np.zeros((len(damping), 6)),
            inertance=column("inertance"),
        )


def _check_place(name: str, position: Array, rotation: Array) -> None:
    """Raise InputError for what is no point (3,) or no right-handed rotation (3,3)."""
    if np.shape(position) != (3,) or not np.isfinite(position).all():
        raise InputError(name, f"the position {np.asarray(position).tolist()} is not three numbers")
    R = np.asarray(rotation, dtype=float)
    proper = R.shape == (3, 3) and np.allclose(R.T @ R, np.eye(3), rtol=0.0, atol=1e-6)
    if not proper or np.linalg.det(R) < 0.0:
        raise InputError(
            name, f"{R.tolist()} is not a rotation", "three right-handed unit axes as columns"
        )
