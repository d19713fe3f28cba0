"""Runs the code of docs/artifacts-in-python.md on real files: artifacts_in_python.py PROGRAMS.

Exit code 77 (skip), with CI set 1, where this Python has no h5py.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

try:
    import h5py  # noqa: F401
    import numpy as np
except ImportError:
    print("skipped: install python3-h5py to run this test")
    sys.exit(1 if os.environ.get("CI") else 77)

GUIDE = pathlib.Path(__file__).parents[2] / "docs/artifacts-in-python.md"
MINOR, MAJOR = 0.4, 1.0  # radii of the sample


def from_torus(points):
    return np.abs(np.hypot(np.hypot(points[:, 0], points[:, 1]) - MAJOR, points[:, 2]) - MINOR)


def main():
    programs = pathlib.Path(sys.argv[1]).resolve()
    text = GUIDE.read_text()
    commands = re.findall(r"^(strake .*)$", text, re.M)
    assert len(commands) == 2, commands
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for command in commands:
            name, *words = command.split()
            subprocess.run([programs / name, *words], check=True, stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL)
        names = {}
        for code in re.findall(r"```python\n(.*?)```", text, re.S):
            exec(code, names)  # the blocks build on each other, as in the guide
        os.chdir("/")

    # A torus bends by 1 / r around its tube, everywhere; least along its circle.
    assert abs(np.median(names["curvature_max"]) * MINOR - 1) < 0.1
    along = names["direction_min"]
    place = names["positions"][names["wedge_vertex"]]
    circle = np.stack([-place[:, 1], place[:, 0], 0 * place[:, 0]], axis=1)
    circle /= np.linalg.norm(circle, axis=1)[:, None]
    agreement = np.abs(np.sum(along * circle, axis=1))
    assert np.median(agreement) > 0.99, np.median(agreement)
    frames = np.abs(np.sum(names["t_max"] * names["t_min"], axis=1))
    assert frames.max() < 1e-6
    assert all(from_torus(line).max() < 0.02 for line in names["lines"])
    assert len(names["quads"]) > 0.8 * len(names["sides"])
    assert np.linalg.norm(names["vertices"] - names["feet"], axis=1).max() < 0.05
    print("the code of the guide reads artifacts")


main()
