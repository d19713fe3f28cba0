"""Reads each artifact with VTK's own VTKHDF reader: vtk_check.py FOLDER_OF_PROGRAMS.

Exit code 77 (skip), with CI set 1, where this Python has no VTK.
"""

import os
import pathlib
import subprocess
import sys
import tempfile

try:
    import numpy
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOHDF import vtkHDFReader
except ImportError:
    print("skipped: install python3-vtk9 to run this test")
    sys.exit(1 if os.environ.get("CI") else 77)

TRIANGLE, POLY_LINE = 5, 4


def read(path):
    reader = vtkHDFReader()
    assert reader.CanReadFile(str(path)), f"{path.name}: VTK does not recognise it"
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def arrays(attributes):
    return {attributes.GetArrayName(i): attributes.GetArray(i)
            for i in range(attributes.GetNumberOfArrays())}


def require(condition, text):
    if not condition:
        sys.exit(f"vtk_check: {text}")


def check(grid, name, cells, point_arrays, cell_arrays):
    require(grid.GetNumberOfCells() == cells, f"{name}: {grid.GetNumberOfCells()} cells")
    points = arrays(grid.GetPointData())
    for array, components in point_arrays.items():
        require(array in points, f"{name}: no point data {array}")
        require(points[array].GetNumberOfComponents() == components, f"{name}: {array}")
        require(points[array].GetNumberOfTuples() == grid.GetNumberOfPoints(), f"{name}: {array}")
    found = arrays(grid.GetCellData())
    for array in cell_arrays:
        require(array in found, f"{name}: no cell data {array}")
        require(found[array].GetNumberOfTuples() == cells, f"{name}: {array}")


def count(programs, path, dataset):
    """Rows of a dataset, as `strake info` tells them."""
    text = subprocess.run([programs / "strake", "info", path], check=True, capture_output=True,
                          text=True).stdout
    for line in text.splitlines():
        words = line.split()
        if words and words[0] == dataset:
            return int(words[1])
    sys.exit(f"vtk_check: strake info names no {dataset}")


def check_points(grid, name, path, dataset, programs):
    require(grid.GetNumberOfPoints() == count(programs, path, dataset), f"{name}: points")


def check_tensors(programs, folder):
    """The components are where VTK expects those of a symmetric tensor: on a torus of tube radius
    0.4 its eigenvalue of largest size is 2.5, and its vector runs around the axis."""
    subprocess.run([programs / "strake", "sample", "torus", "-o", folder / "torus.ply", "--faces",
                    "6000"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([programs / "strake-import", folder / "torus.ply", "-o", folder / "torus.hdf",
                    "-q"], check=True)
    subprocess.run([programs / "strake-tensor", folder / "torus.hdf", "-o",
                    folder / "torus-tensor.hdf", "-q"], check=True)
    grid = read(folder / "torus-tensor.hdf")
    six = vtk_to_numpy(grid.GetPointData().GetArray("tensor"))
    xx, yy, zz, xy, yz, xz = six.T  # VTK's order
    full = numpy.stack([xx, xy, xz, xy, yy, yz, xz, yz, zz], axis=1).reshape(-1, 3, 3)
    values, vectors = numpy.linalg.eigh(full)
    largest = numpy.argmax(numpy.abs(values), axis=1)
    rows = numpy.arange(len(values))
    require(abs(numpy.median(values[rows, largest]) * 0.4 - 1) < 0.1, "tensor: eigenvalues")
    points = vtk_to_numpy(grid.GetPoints().GetData())
    around = numpy.stack([-points[:, 1], points[:, 0], 0 * points[:, 0]], axis=1)
    around /= numpy.linalg.norm(around, axis=1)[:, None]
    turn = numpy.abs(numpy.sum(vectors[rows, :, largest] * around, axis=1))
    require(numpy.median(turn) > 0.99, "tensor: directions")


def main():
    programs = pathlib.Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([programs / "strake", "sample", "part", "-o", folder / "part.ply", "--faces",
                        "9000"], check=True)
        subprocess.run([programs / "strake", "remesh", folder / "part.ply", "-o",
                        folder / "out.obj", "--keep", folder, "-q"], check=True)
        faces = count(programs, folder / "mesh.hdf", "/mesh/source_face")
        lines = count(programs, folder / "lines.hdf", "/lines/family")

        mesh = read(folder / "mesh.hdf")
        check(mesh, "mesh", faces, {"is_corner": 1, "source_vertex": 1}, ["source_face"])
        require(mesh.GetCellType(0) == TRIANGLE, "mesh: cells are no triangles")
        check(read(folder / "tensor.hdf"), "tensor", faces, {"tensor": 6, "normal": 3}, [])
        check(read(folder / "field.hdf"), "field", faces,
              {"normal": 3, "t_min": 3, "cross": 3, "k_min": 1, "k_max": 1, "wedge_confidence": 1},
              ["face_confidence"])
        line_set = read(folder / "lines.hdf")
        check(line_set, "lines", lines, {"chord_family": 1},
              ["family", "start_reason", "end_reason", "seed_point"])
        require(any(line_set.GetCellType(i) == POLY_LINE for i in range(lines)),
                "lines: no polylines")
        for name in ("quads", "fitted"):
            cells = count(programs, folder / f"{name}.hdf", "/quads/offsets") - 1
            check(read(folder / f"{name}.hdf"), name, cells,
                  {"source_face": 1, "source_barycentric": 3, "source_lines": 2}, [])
        result = read(folder / "quads.hdf")
        check_points(mesh, "mesh", folder / "mesh.hdf", "/mesh/positions", programs)
        check_points(result, "quads", folder / "quads.hdf", "/quads/positions", programs)

        subprocess.run([programs / "strake-size", *(folder / f"{name}.hdf" for name in
                        ("mesh", "field", "lines", "fitted")), "-o", folder / "size.hdf", "-q"],
                       check=True)
        check(read(folder / "size.hdf"), "size", faces, {"along": 1, "across": 1}, [])
        subprocess.run([programs / "strake-tensor-part", folder / "mesh.hdf", "-o",
                        folder / "tensor_part.hdf", "--parts", "2", "-q"], check=True)
        wedges = count(programs, folder / "tensor_part.hdf", "/tensor_part/wedge")
        check(read(folder / "tensor_part.hdf"), "tensor_part", wedges,
              {"wedge": 1, "tensor": 6, "normal": 3}, [])

        check_tensors(programs, folder)

        # The same surface in every artifact: equal boxes, up to the distance of the result.
        box = mesh.GetBounds()
        diagonal = sum((box[2 * i + 1] - box[2 * i]) ** 2 for i in range(3)) ** 0.5
        for other in (read(folder / "tensor.hdf"), line_set, result):
            for a, b in zip(box, other.GetBounds()):
                require(abs(a - b) < 0.05 * diagonal, "the boxes of the artifacts differ")
    print("VTK reads every artifact")


main()
