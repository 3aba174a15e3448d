"""Geometrically exact beam elements: section tables to element stiffness and node inertia.

An element answers the relative motion of its two end frames (``pairs``). Its compliance is
the integral of the sections' compliance, carried to the element's end, so tapered, twisted,
curved and coupled elements are exact under end loads, as Timoshenko's beam is. Its mass goes
to the nodes by the cubic Hermite rule for integrals, whose error is of fourth order along
the beam and of third at its ends; mass matrices stay at the nodes, so momentum and weight
are exact in any deformed shape and gravity has a potential.
Sources: Sonneville, Cardona and Bruls (2014); MacNeal, Comput. Struct. 8 (1978) 175, for
the residual bending flexibility that the compliance contains.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError
from galerna.turbine.model import SectionProperties

from .frames import adjoint, hat, log_se3, tangent

Curve = Callable[[Array], tuple[Array, Array]]
"""Fractions (k,) of a reference axis -> positions (k,3) m and section axes (k,3,3)."""

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(3)


@dataclass(frozen=True, eq=False)
class Beam:
    """A discretised beam of n elements.

    Nodes: ``span`` (n+1,), ``position`` (n+1,3) m, ``rotation`` (n+1,3,3), ``mass``
    (n+1,6,6). Elements: ``reference`` relative motion (n,6), ``stiffness`` and ``damping``
    (n,6,6) against it.
    """

    span: Array
    position: Array
    rotation: Array
    mass: Array
    reference: Array
    stiffness: Array
    damping: Array


def straight(root: Array, rotation: Array, length: float) -> Curve:
    """A straight axis from ``root`` (3,) along the z axis of ``rotation`` (3,3)."""

    def curve(span: Array) -> tuple[Array, Array]:
        position = np.asarray(root) + length * np.outer(span, rotation[:, 2])
        return position, np.tile(rotation, (len(span), 1, 1))

    return curve


def uniform(stiffness: Array, inertia: Array, damping: Array | None = None) -> SectionProperties:
    """Section properties that do not change along the span, (6,6) or their diagonals (6,)."""
    matrices = [np.diag(a) if np.ndim(a) == 1 else np.asarray(a) for a in (stiffness, inertia)]
    K, M = (np.tile(a, (2, 1, 1)) for a in matrices)
    loss = np.zeros(6) if damping is None else np.asarray(damping, dtype=float)
    return SectionProperties(np.array([0.0, 1.0]), K, M, np.zeros(2), loss)


def discretise(
    curve: Curve, length: float, sections: SectionProperties, span: Array, name: str = "beam"
) -> Beam:
    """Elements between the nodes at the fractions ``span`` (n+1,) of an axis of ``length`` m.

    Raises InputError if a section's stiffness is not symmetric and positive definite, its
    damping is negative, ``span`` does not grow, ``length`` is not the axis's or a node would
    have no inertia.
    """
    span = np.asarray(span, dtype=float)
    _check(sections, span, name)
    _check_length(curve, length, span, name)
    x, R = curve(span)
    n = len(span) - 1
    mass = np.zeros((n + 1, 6, 6))
    lever, spread = np.zeros((n + 1, 3)), np.zeros((n + 1, 3, 3))
    reference, stiffness = np.zeros((n, 6)), np.zeros((n, 6, 6))
    for e in range(n):
        ends = (x[e], R[e], x[e + 1], R[e + 1])
        points = _integration_points(span[e], span[e + 1], sections.span)
        s, ds = points[0], length * points[1]
        at, axes = curve(s)
        reference[e] = log_se3(R[e].T @ R[e + 1], R[e].T @ (x[e + 1] - x[e]))
        stiffness[e] = _stiffness(ends, at, axes, interpolate(sections, sections.stiffness, s), ds,
                                  reference[e])  # fmt: skip
        fraction = (s - span[e]) / (span[e + 1] - span[e])
        density = interpolate(sections, sections.inertia, s)
        for k, parts in enumerate(_end_masses(ends, at, axes, density, ds, fraction)):
            for total, part in zip((mass, lever, spread), parts, strict=True):
                total[e + k] += part
    for i in range(n + 1):
        _close(mass[i], hat(lever[i]), spread[i])
        if np.linalg.eigvalsh(mass[i]).min() <= 0.0:
            raise InputError(
                name, f"no rotary inertia at span {span[i]:.3g}",
                "give every section moments of inertia, small ones if need be",
            )  # fmt: skip
    beam = Beam(span, x, R, mass, reference, stiffness, np.zeros_like(stiffness))
    return damped(beam, sections.damping)


def damped(beam: Beam, damping: Array) -> Beam:
    """The beam with a damping (6,) s in proportion to its stiffness."""
    root = np.sqrt(damping)
    return replace(beam, damping=root[:, None] * beam.stiffness * root)


def _close(M: Array, lever: Array, spread: Array) -> None:
    """Give a node's mass matrix (6,6) the square of its levers, so that it stays positive.

    ``lever`` and ``spread`` (3,3) are the levers' part in the first moment and the product of
    levers and sections' mass centres. Where long elements twist so much that this is more
    than a body can have, the product of their means, a bound for all, takes its place.
    """
    M[3:, 3:] -= lever @ lever / M[0, 0]
    if np.linalg.eigvalsh(M)[0] <= 0.0:
        center = M[3:, :3] - lever
        M[3:, 3:] -= spread + (center @ lever + lever @ center) / M[0, 0]


def interpolate(sections: SectionProperties, table: Array, span: Array) -> Array:
    """Section matrices (k,6,6) at ``span`` (k,), linear between the stations."""
    right = np.clip(np.searchsorted(sections.span, span), 1, len(sections.span) - 1)
    low, high = sections.span[right - 1], sections.span[right]
    weight = np.clip((span - low) / (high - low), 0.0, 1.0)[:, None, None]
    return (1.0 - weight) * table[right - 1] + weight * table[right]


def _check(sections: SectionProperties, span: Array, name: str) -> None:
    if len(span) < 2 or not (np.diff(span) > 0.0).all():
        raise InputError(name, f"the nodes' fractions {span.tolist()} do not grow")
    if not (sections.damping >= 0.0).all():
        raise InputError(name, f"the damping {sections.damping.tolist()} s is not positive or zero")
    scale = 1.0 / np.sqrt(np.abs(np.einsum("nii->ni", sections.stiffness)).clip(1e-300))
    scaled = scale[:, :, None] * sections.stiffness * scale[:, None, :]
    for i, matrix in enumerate(scaled):
        lopsided = not np.abs(matrix - matrix.T).max() < 1e-3
        if lopsided or np.linalg.eigvalsh(0.5 * (matrix + matrix.T))[0] <= 0:
            raise InputError(
                name,
                f"the section stiffness at span {sections.span[i]:.4g} is not "
                f"{'symmetric' if lopsided else 'positive definite'}",
                "stiffness matrices are symmetric with positive eigenvalues",
            )


def _check_length(curve: Curve, length: float, span: Array, name: str) -> None:
    """Refuse a length more than 1 % off the curve's own."""
    points, _ = curve(np.linspace(span[0], span[-1], 201))
    found = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum() / (span[-1] - span[0]))
    if not abs(found - length) <= 0.01 * length:
        raise InputError(name, f"a length of {length:g} m is given, the axis has {found:.4g} m")


def _integration_points(start: float, end: float, stations: Array) -> tuple[Array, Array]:
    """Gauss points and weights between two nodes, piecewise between the stations inside."""
    inside = stations[(stations > start + 1e-12) & (stations < end - 1e-12)]
    edges = np.concatenate([[start], inside, [end]])
    middle, half = 0.5 * (edges[1:] + edges[:-1]), 0.5 * np.diff(edges)
    points = middle[:, None] + half[:, None] * _POINTS
    return points.ravel(), (half[:, None] * _WEIGHTS).ravel()


Ends = tuple[Array, Array, Array, Array]


def _stiffness(
    ends: Ends, at: Array, axes: Array, section: Array, ds: Array, reference: Array
) -> Array:
    """Stiffness (6,6) against the relative motion: inverse of the carried compliance."""
    _, _, x, R = ends
    compliance = np.zeros((6, 6))
    for i in range(len(ds)):
        carry = adjoint(R.T @ axes[i], R.T @ (at[i] - x))
        compliance += ds[i] * carry @ np.linalg.solve(section[i], carry.T)
    T = tangent(reference)
    K = T.T @ np.linalg.inv(compliance) @ T
    return 0.5 * (K + K.T)


def _end_masses(
    ends: Ends, at: Array, axes: Array, density: Array, ds: Array, fraction: Array
) -> list[tuple[Array, Array, Array]]:
    """Mass matrix (6,6) of an element at its two ends, and the levers' part in its moments.

    The first moment (3,) of the levers and their product (3,3) with the mass centres.

    A section's mass is shared by Hermite's cubics: the value's go to the end as they are,
    the slope's as a lever along the chord; what the axis bends off the chord adds to it.
    """
    xa, _, xb, _ = ends
    chord = xb - xa
    f = fraction
    out = []
    for k, (value, slope) in enumerate(
        [(1 - 3 * f**2 + 2 * f**3, f * (1 - f) ** 2), (3 * f**2 - 2 * f**3, -(f**2) * (1 - f))]
    ):
        R = ends[2 * k + 1]
        off = at - (xa + f[:, None] * chord)
        M, first, spread = np.zeros((6, 6)), np.zeros(3), np.zeros((3, 3))
        for i in range(len(ds)):
            turn = np.zeros((6, 6))
            turn[:3, :3] = turn[3:, 3:] = R.T @ axes[i]
            local = turn @ density[i] @ turn.T
            lever = R.T @ (slope[i] * chord + value[i] * off[i])
            E = np.zeros((6, 6))
            E[:3, 3:] = -hat(lever)
            shift = local @ E + E.T @ local
            M += ds[i] * (value[i] * local + shift)
            spread += ds[i] * shift[3:, 3:]
            first += ds[i] * local[0, 0] * lever
        out.append((M, first, spread))
    return out


def nodal_loads(beam: Beam, load: Callable[[Array], Array], length: float) -> Array:
    """Global forces and moments (n+1,6) at the nodes that stand for a load per length (k,6).

    ``load`` gives N/m and N m/m in global axes at fractions (k,) of the axis.
    """
    out = np.zeros((len(beam.span), 6))
    for e in range(len(beam.reference)):
        s, weight = _integration_points(beam.span[e], beam.span[e + 1], np.zeros(0))
        f = (s - beam.span[e]) / (beam.span[e + 1] - beam.span[e])
        q = load(s) * (length * weight)[:, None]
        chord = beam.position[e + 1] - beam.position[e]
        for k, value, slope in (
            (0, 1 - 3 * f**2 + 2 * f**3, f * (1 - f) ** 2),
            (1, 3 * f**2 - 2 * f**3, -(f**2) * (1 - f)),
        ):
            out[e + k] += value @ q
            out[e + k, 3:] += np.cross(chord, slope @ q[:, :3])
    return out
