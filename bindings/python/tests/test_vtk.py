"""Files for ParaView, read back by its own reader (`vtk` from PyPI)."""

import json
import math
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import moorline
import numpy as np
import pytest

vtk = pytest.importorskip("vtk")
from vtk.util.numpy_support import vtk_to_numpy

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"


def listed(path):
    """Times and files of a .pvd."""
    return [(float(of.get("timestep")), path.parent / of.get("file")) for of in ET.parse(path).getroot().iter("DataSet")]


def read(path):
    reader = vtk.vtkXMLPolyDataReader()
    complaints = []
    reader.AddObserver("ErrorEvent", lambda *_: complaints.append(path))
    reader.SetFileName(str(path))
    reader.Update()
    assert not complaints and reader.GetErrorCode() == 0
    return reader.GetOutput()


def at_points(data, name):
    return vtk_to_numpy(data.GetPointData().GetArray(name))


def test_lines_are_those_of_the_run_to_the_bit(tmp_path):
    """Source: the nodes of the same run."""
    results = moorline.run(EXAMPLES / "two-lines.json", {"run.duration": 3.0}, vtk=tmp_path)
    snapshots = listed(tmp_path / "lines.pvd")
    assert [time for time, _ in snapshots] == results.snapshot_time.tolist()
    assert not (tmp_path / "bodies.pvd").exists()
    data = read(snapshots[-1][1])
    lines = list(results.lines.values())
    assert data.GetNumberOfLines() == 2
    assert np.array_equal(vtk_to_numpy(data.GetPoints().GetData()), np.concatenate([line.node_position[-1] for line in lines]))
    assert np.array_equal(at_points(data, "tension"), np.concatenate([line.node_tension[-1] for line in lines]))
    assert np.array_equal(at_points(data, "s"), np.concatenate([line.s for line in lines]))
    assert vtk_to_numpy(data.GetCellData().GetArray("line")).tolist() == [0, 1]
    assert [data.GetCell(line).GetNumberOfPoints() for line in range(2)] == [len(line.s) for line in lines]


def test_the_command_writes_the_same_files(tmp_path):
    changes = {"run.duration": 1.0}
    moorline.run(EXAMPLES / "calm-buoy.json", changes, vtk=tmp_path / "python")
    command = [sys.executable, "-m", "moorline", "run", str(EXAMPLES / "calm-buoy.json"), "-q", "--set", "run.duration=1.0"]
    subprocess.run([*command, "--vtk", "-o", str(tmp_path / "command")], check=True)
    files = sorted(path.name for path in (tmp_path / "python").iterdir())
    assert files == sorted(path.name for path in (tmp_path / "command/vtk").iterdir())
    assert "bodies_0001.vtp" in files
    for name in files:
        assert (tmp_path / "python" / name).read_bytes() == (tmp_path / "command/vtk" / name).read_bytes(), name
    subprocess.run([*command, "-o", str(tmp_path / "without")], check=True)
    assert not (tmp_path / "without/vtk").exists()


def test_curvature_is_that_of_the_catenary(tmp_path):
    """Source: an inextensible line of weight w and horizontal tension H has the curvature w/H cos²(a), a its angle from the level (Irvine 1981);
    1 % with nodes 3 m apart, where the curvature falls to a fifth within 40 m."""
    path, mesh = EXAMPLES / "slack-catenary.json", {"lines[0].sections[0].elements": 60}
    moorline.run(path, {"run.duration": 0.0, **mesh}, vtk=tmp_path)
    line = moorline.statics(path, mesh).lines["garland"]
    weight = 135.35 * 9.80665 - 1025.0 * 9.80665 * math.pi / 4 * 0.076**2
    level = np.hypot(line.node_tangent[:, 0], line.node_tangent[:, 1])
    expected = weight / np.hypot(line.force[0], line.force[1]) * level**2
    found = at_points(read(listed(tmp_path / "lines.pvd")[0][1]), "curvature")
    assert expected.max() > 5 * expected.min()
    assert found[1:-1] == pytest.approx(expected[1:-1], rel=0.01)


def test_bodies_are_closed_surfaces_with_their_volume_where_the_run_has_them(tmp_path):
    """Source: prisms of 24 sides with the diameters and lengths of the scene; the poses of the run."""
    scene = json.loads((EXAMPLES / "calm-buoy.json").read_text())
    results = moorline.run(EXAMPLES / "calm-buoy.json", {"run.duration": 2.0}, vtk=tmp_path)
    data = read(listed(tmp_path / "bodies.pvd")[-1][1])
    cylinders = [(of, cylinder) for of in scene["bodies"] for cylinder in of.get("cylinders", [])]
    names = [of["name"] for of in scene["bodies"]]
    (body, cylinder), *others = cylinders
    assert not others, "the example has one cylinder"
    triangles, mass, features = vtk.vtkTriangleFilter(), vtk.vtkMassProperties(), vtk.vtkFeatureEdges()
    triangles.SetInputData(data)
    triangles.PassLinesOff()
    triangles.PassVertsOff()
    mass.SetInputConnection(triangles.GetOutputPort())
    radius, length = cylinder["diameter"] / 2, np.linalg.norm(np.subtract(cylinder["to"], cylinder["from"]))
    assert mass.GetVolume() == pytest.approx(12 * math.sin(math.tau / 24) * radius**2 * length, rel=1e-6)
    features.SetInputConnection(triangles.GetOutputPort())
    features.FeatureEdgesOff()
    features.Update()
    assert features.GetOutput().GetNumberOfCells() == 0, "the surface has holes"

    # The normals point outwards: flux of the place out of the surface is three times the volume.
    places = vtk_to_numpy(data.GetPoints().GetData())
    flux = 0.0
    triangles.Update()
    surface = triangles.GetOutput()
    for number in range(surface.GetNumberOfCells()):
        a, b, c = (places[surface.GetCell(number).GetPointId(corner)] for corner in range(3))
        flux += a @ np.cross(b, c) / 6
    assert flux == pytest.approx(mass.GetVolume(), rel=1e-6)

    number = names.index(body["name"])
    owners = vtk_to_numpy(data.GetCellData().GetArray("body")).tolist()
    assert owners.count(number) >= 26 and set(owners) >= set(range(len(names)))
    for index, name in enumerate(names):
        vertex = data.GetCell(index).GetPointId(0)
        assert np.array_equal(places[vertex], results.bodies[name].position[-1])
        assert np.array_equal(at_points(data, "force")[vertex], results.bodies[name].force[-1])
        assert np.array_equal(at_points(data, "moment")[vertex], results.bodies[name].moment[-1])
    assert np.count_nonzero(np.linalg.norm(at_points(data, "force"), axis=1)) <= len(names)


def test_a_place_that_cannot_be_written_is_named(tmp_path):
    (tmp_path / "taken").write_text("")
    with pytest.raises(moorline.InputError, match="taken"):
        moorline.run(None, {"run.duration": 1.0}, vtk=tmp_path / "taken")


def test_a_run_that_fails_leaves_what_came_before(tmp_path):
    broken = {"motion": {"kind": "sinusoidal", "period": 40.0, "sine": [-1500.0, 0.0, 0.0], "ramp": 0.0}, "run.duration": 30.0}
    with pytest.raises(moorline.ConvergenceError) as caught:
        moorline.run(None, broken, vtk=tmp_path)
    snapshots = listed(tmp_path / "lines.pvd")
    assert snapshots[-1][0] == caught.value.results.time[-1] and read(snapshots[-1][1]).GetNumberOfLines() == 1
