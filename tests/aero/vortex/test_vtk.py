"""VTK files: what is written can be read, by their own reader where there is one."""

from base64 import b64decode
from xml.etree import ElementTree

import numpy as np
import pytest

from galerna.aero.vortex.vtk import Patch, Series, write_patches
from galerna.errors import InputError

TYPES = {"Float32": "<f4", "Int32": "<i4", "Int64": "<i8"}


def patch(rows, columns, shift=0.0):
    i, j = np.meshgrid(np.arange(rows + 1.0), np.arange(columns + 1.0), indexing="ij")
    points = np.stack([i, j + shift, i * j], axis=-1)
    strength = 1.5 * np.arange(rows * columns).reshape(rows, columns)
    velocity = {"velocity [m/s]": 2.0 * points}
    return Patch(points, velocity, {"circulation [m2/s]": strength, "blade": strength.astype(int)})


def arrays(path):
    """Every array of a file by name, decoded as the format says."""
    found = {}
    for element in ElementTree.parse(path).iter("DataArray"):
        data = b64decode(element.text)
        assert int.from_bytes(data[:8], "little") == len(data) - 8
        values = np.frombuffer(data[8:], TYPES[element.get("type")])
        found[element.get("Name")] = values.reshape(
            -1, int(element.get("NumberOfComponents", 1))
        ).squeeze()
    return found


def test_a_file_holds_the_panels_of_all_patches(tmp_path):
    first, second = patch(2, 3), patch(4, 1, shift=10.0)
    write_patches(tmp_path / "two.vtp", [first, second])
    read = arrays(tmp_path / "two.vtp")
    assert read["points"].shape == (12 + 10, 3)
    corners = read["points"][read["connectivity"]].reshape(-1, 4, 3)
    assert len(corners) == 6 + 4
    assert read["offsets"].tolist() == list(range(4, 44, 4))
    np.testing.assert_array_equal(corners[1], [[0, 1, 0], [1, 1, 1], [1, 2, 2], [0, 2, 0]])
    assert (corners[6:, :, 1] >= 10.0).all()  # the second patch keeps its own points
    np.testing.assert_array_equal(read["velocity [m/s]"], 2.0 * read["points"])
    assert read["circulation [m2/s]"].tolist() == [*(1.5 * np.arange(6)), *(1.5 * np.arange(4))]
    assert read["blade"].dtype == np.int32


def test_vtk_itself_reads_it(tmp_path):
    xml = pytest.importorskip("vtkmodules.vtkIOXML")
    write_patches(tmp_path / "one.vtp", [patch(2, 3)])
    reader = xml.vtkXMLPolyDataReader()
    reader.SetFileName(str(tmp_path / "one.vtp"))
    reader.Update()
    data = reader.GetOutput()
    assert (data.GetNumberOfPoints(), data.GetNumberOfCells()) == (12, 6)


def test_a_series_names_its_files_and_their_times(tmp_path):
    series = Series(tmp_path / "wake.pvd")
    for time in (0.5, 1.0):
        series.add(time, [patch(1, 1)])
    entries = list(ElementTree.parse(tmp_path / "wake.pvd").iter("DataSet"))
    assert [float(entry.get("timestep")) for entry in entries] == [0.5, 1.0]
    assert all((tmp_path / entry.get("file")).is_file() for entry in entries)
    assert len(series) == 2


def test_a_series_that_is_cut_short_stays_as_it_was(tmp_path, monkeypatch):
    series = Series(tmp_path / "wake.pvd")
    series.add(0.5, [patch(1, 1)])
    before = (tmp_path / "wake.pvd").read_bytes()

    def short(tree, path, **_):
        path.write_bytes(before[: len(before) // 2])
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(ElementTree.ElementTree, "write", short)
    with pytest.raises(InputError, match="No space left"):
        series.add(1.0, [patch(1, 1)])
    assert (tmp_path / "wake.pvd").read_bytes() == before
    assert not list(tmp_path.glob("*.unfinished"))


def test_a_file_that_cannot_be_written_is_an_input_error(tmp_path):
    with pytest.raises(InputError, match="cannot be written"):
        write_patches(tmp_path / "no_such_folder" / "a.vtp", [patch(1, 1)])
