"""The collection of test models: its table, and references that the meter can read."""

import math
import pathlib
import re
import struct
from dataclasses import dataclass


@dataclass(frozen=True)
class Model:
    """One row of MANIFEST.md."""

    path: pathlib.Path
    category: str
    vertices: int  # that faces use
    loops: int  # of the boundary
    components: int
    genus: int


def read_manifest(folder):
    """The manifold models of the table, by category.

    Rows whose figures are no plain numbers (broken files) are left out: the folder lists those.
    """
    models = []
    for line in (folder / "MANIFEST.md").read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if len(cells) != 13 or cells[9] != "yes":
            continue
        name, category, remark = cells[0], cells[11], cells[12]
        loops = 0 if cells[6] == "closed" else int(cells[6].split()[0])
        unused = re.search(r"(\d+) unreferenced vertices", remark)
        models.append(Model(folder / category / name, category,
                            int(cells[4]) - (int(unused[1]) if unused else 0), loops,
                            int(cells[7]), int(cells[8]) if cells[8].isdigit() else -1))
    return models


def stl_triangles(data):
    """Corner coordinates of all facets, three points each, of a binary or ASCII STL."""
    count = struct.unpack_from("<I", data, 80)[0] if len(data) >= 84 else 0
    if len(data) == 84 + 50 * count:
        for i in range(count):
            c = struct.unpack_from("<9f", data, 84 + 50 * i + 12)
            yield c[0:3], c[3:6], c[6:9]
        return
    points = re.findall(rb"^\s*vertex\s+(\S+)\s+(\S+)\s+(\S+)", data, re.MULTILINE | re.IGNORECASE)
    corners = [tuple(map(float, point)) for point in points]
    yield from zip(corners[0::3], corners[1::3], corners[2::3])


def write_welded_obj(stl, obj):
    """Writes an STL as OBJ whose equal coordinates are one vertex."""
    index, faces = {}, []
    for triangle in stl_triangles(stl.read_bytes()):
        # Adding zero makes -0 equal to 0 as text too.
        keys = [tuple(x + 0.0 for x in corner) for corner in triangle]
        faces.append([index.setdefault(key, len(index) + 1) for key in keys])
    with open(obj, "w", encoding="ascii") as out:
        for x, y, z in index:
            out.write(f"v {x!r} {y!r} {z!r}\n")
        for a, b, c in faces:
            out.write(f"f {a} {b} {c}\n")


def write_cut_apart(source, obj):
    """Copies an OBJ, and cuts quads whose shorter diagonal is that of another quad along their longer.

    Two quads that share three corners would have a triangle in common, which is no surface: with the
    shorter diagonal in both, another program than strake measures against something else.
    \return whether there are any
    """
    points, taken, found, lines = [], set(), False, []
    for line in source.read_text(encoding="utf-8").splitlines():
        fields = line.split()
        if fields[:1] == ["v"]:
            points.append([float(x) for x in fields[1:4]])
        if fields[:1] == ["f"] and len(fields) == 5:
            corners = [int(field.split("/")[0]) for field in fields[1:]]
            quad = [c - 1 if c > 0 else len(points) + c for c in corners]
            lengths = [math.dist(points[quad[k]], points[quad[k + 2]]) for k in (0, 1)]
            first = 0 if lengths[0] <= lengths[1] else 1
            diagonal = frozenset((quad[first], quad[first + 2]))
            if diagonal in taken:
                found = True
                a, b, c, d = fields[2 - first:] + fields[1:2 - first]
                lines += [f"f {a} {b} {c}", f"f {a} {c} {d}"]
                continue
            taken.add(diagonal)
        lines.append(line)
    if found:
        obj.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return found


def reference(model_path, scratch):
    """A file the meter reads that holds the same surface."""
    if model_path.suffix.lower() == ".obj":
        obj = scratch / (model_path.stem + "-cut-apart.obj")
        return obj if obj.exists() or write_cut_apart(model_path, obj) else model_path
    if model_path.suffix.lower() != ".stl":
        return model_path
    obj = scratch / (model_path.stem + "-welded.obj")
    if not obj.exists():
        write_welded_obj(model_path, obj)
    return obj
