"""Runs docs/paraview/show_run.py in ParaView: check_guide.py STRAKE, the program.

pvpython is that of $STRAKE_PVPYTHON, else of the PATH, under xvfb-run. Exit code 77 (skip): it is not there, as in
continuous integration: Debian cannot install it beside the VTK that other tests take. ParaView has to open every file of a run with the counts that strake gives, and draw the pictures of docs/paraview.md.
"""

import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

GUIDE = pathlib.Path(__file__).parents[2] / "docs/paraview/show_run.py"


def pvpython():
    if os.environ.get("STRAKE_PVPYTHON"):
        return [os.environ["STRAKE_PVPYTHON"]]
    if not shutil.which("pvpython") or not shutil.which("xvfb-run"):
        print("skipped: there is no pvpython with xvfb-run; scripts/check_paraview makes one")
        sys.exit(77)
    return ["xvfb-run", "-a", "-s", "-screen 0 1024x768x24", "pvpython"]


def run(*words, folder):
    done = subprocess.run(words, cwd=folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=280)
    if done.returncode != 0:
        sys.exit(f"failed: {' '.join(words)}\n{done.stdout}")
    return done.stdout


def rows_of(picture):
    """How many different rows of pixels a PNG has, few where nothing is drawn; its width and height."""
    data = picture.read_bytes()
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        packed += data[at + 8:at + 8 + length] if kind == b"IDAT" else b""
        at += 12 + length
    width, height = struct.unpack(">II", data[16:24])
    raw = zlib.decompress(packed)
    return len({raw[row * len(raw) // height:(row + 1) * len(raw) // height] for row in range(height)}), width, height


def main():
    strake = sys.argv[1]
    command = pvpython()
    with tempfile.TemporaryDirectory(prefix="strake-paraview-") as name:
        folder = pathlib.Path(name)
        run(strake, "sample", "part", "--faces", "6000", "-o", "part.ply", folder=folder)
        run(strake, "remesh", "part.ply", "-o", "quads.obj", "--vertices", "1500", "--keep", "work", "-q", folder=folder)
        shutil.copy(GUIDE, folder)
        said = run(*command, "show_run.py", "work", "pictures", folder=folder)
        opened = dict(re.findall(r"^(\w+)\.hdf: (\d+) cells", said, re.MULTILINE))
        assert {"mesh", "tensor", "field", "lines"} < set(opened), said
        faces = re.search(r"/mesh/source_face +(\d+) x 1", run(strake, "info", "work/mesh.hdf", folder=folder))[1]
        assert opened["mesh"] == opened["field"] == opened["tensor"] == faces, (opened, faces)
        for step in ("curvature", "directions", "tensors", "lines", "result"):
            rows, width, height = rows_of(folder / "pictures" / f"{step}.png")
            assert (width, height) == (640, 450) and rows > height / 2, f"{step}.png is empty"
        assert "RenderView" in (folder / "pictures/run.pvsm").read_text()
    print(f"ParaView opens {', '.join(sorted(opened))} and draws them")


if __name__ == "__main__":
    main()
