"""Surfaces as VTK files (.vtp) and their series over time (.pvd): what ParaView and its like read.

The XML formats of VTK, with the arrays inline in base64, each behind its length in bytes as
UInt64 (VTK user's guide, "VTK File Formats"). No library is needed to write so little.
"""

from __future__ import annotations

import os
from base64 import b64encode
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from galerna.contract import Array
from galerna.errors import InputError

TYPES = {"f4": "Float32", "f8": "Float64", "i4": "Int32", "i8": "Int64"}


@dataclass(frozen=True, eq=False)
class Patch:
    """A surface of panels (r,c) between points (r+1,c+1,3) m.

    ``on_points`` holds values (r+1,c+1) or (r+1,c+1,3) by name, ``on_panels`` values (r,c); the
    patches of one file share the names. Names carry their unit.
    """

    points: Array
    on_points: Mapping[str, NDArray[Any]] = field(default_factory=dict)
    on_panels: Mapping[str, NDArray[Any]] = field(default_factory=dict)

    @property
    def quads(self) -> NDArray[np.int64]:
        """Numbers (r*c,4) of the points around each panel."""
        rows, columns = self.points.shape[:2]
        number = np.arange(rows * columns).reshape(rows, columns)
        around = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
        return np.stack([corner.ravel() for corner in around], axis=1)


def write_patches(path: Path, patches: Sequence[Patch]) -> None:
    """Write patches into one .vtp file, in single precision; InputError if the disk refuses."""
    points = np.concatenate([p.points.reshape(-1, 3) for p in patches])
    firsts = np.cumsum([0, *(p.points.shape[0] * p.points.shape[1] for p in patches[:-1])])
    quads = np.concatenate([p.quads + first for p, first in zip(patches, firsts, strict=True)])
    file = _file("PolyData")
    sizes = {"NumberOfPoints": str(len(points)), "NumberOfPolys": str(len(quads))}
    piece = ElementTree.SubElement(ElementTree.SubElement(file, "PolyData"), "Piece", sizes)
    _add_arrays(piece, "PointData", _joined([p.on_points for p in patches]))
    _add_arrays(piece, "CellData", _joined([p.on_panels for p in patches]))
    _add_arrays(piece, "Points", [("points", points.astype("<f4"))])
    ends = 4 * np.arange(1, len(quads) + 1, dtype="<i8")
    _add_arrays(piece, "Polys", [("connectivity", quads.ravel().astype("<i8")), ("offsets", ends)])
    _write(file, path)


class Series:
    """A .pvd file that says at what time each file of a series holds.

    With ``since`` s it goes on after the files that stand there up to that time.
    """

    def __init__(self, path: Path, since: float | None = None) -> None:
        self.path = path
        self._file = _file("Collection")
        self._collection = ElementTree.SubElement(self._file, "Collection")
        if since is not None and path.exists():
            entries = ElementTree.parse(path).iter("DataSet")
            last = since + 1e-8 * abs(since)  # the times are written with nine digits
            self._collection.extend(e for e in entries if float(e.get("timestep", 0.0)) <= last)

    def __len__(self) -> int:
        return len(self._collection)

    def add(self, time: float, patches: Sequence[Patch]) -> Path:
        """Write the patches of ``time`` s beside the .pvd file and into it; their file."""
        name = f"{self.path.stem}_{len(self):06d}.vtp"
        write_patches(self.path.with_name(name), patches)
        attributes = {"timestep": f"{time:.9g}", "file": name}
        ElementTree.SubElement(self._collection, "DataSet", attributes)
        _write(self._file, self.path)
        return self.path.with_name(name)


def _file(kind: str) -> ElementTree.Element:
    attributes = {"type": kind, "version": "1.0", "byte_order": "LittleEndian"}
    return ElementTree.Element("VTKFile", {**attributes, "header_type": "UInt64"})


def _joined(each: Sequence[Mapping[str, NDArray[Any]]]) -> Iterator[tuple[str, NDArray[Any]]]:
    """The values of all patches one after the other, by name."""
    for name in each[0]:
        parts = [values[name] for values in each]
        values = np.concatenate([p.reshape(-1, *p.shape[2:]) for p in parts])
        yield name, values.astype("<i4" if values.dtype.kind in "iub" else "<f4")


def _add_arrays(
    piece: ElementTree.Element, section: str, arrays: Iterator[tuple[str, Any]] | Sequence[Any]
) -> None:
    parent = ElementTree.SubElement(piece, section)
    for name, values in arrays:
        attributes = {"type": TYPES[values.dtype.str[1:]], "Name": name, "format": "binary"}
        if values.ndim == 2:
            attributes["NumberOfComponents"] = str(values.shape[1])
        data = values.tobytes()
        text = b64encode(len(data).to_bytes(8, "little") + data).decode("ascii")
        ElementTree.SubElement(parent, "DataArray", attributes).text = text


def _write(file: ElementTree.Element, path: Path) -> None:
    """Write a file, whole or not at all: a run that is killed leaves series that can be read."""
    unfinished = path.with_name(path.name + ".unfinished")
    try:
        ElementTree.ElementTree(file).write(unfinished, encoding="utf-8", xml_declaration=True)
        os.replace(unfinished, path)
    except OSError as error:
        unfinished.unlink(missing_ok=True)
        raise InputError(str(path), f"cannot be written: {error.strerror}") from error
