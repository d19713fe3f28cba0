"""Runs the code of docs/artifacts-in-matlab.md on real files, in Octave: artifacts_in_octave.py PROGRAMS.

Exit code 77 (skip), with CI set 1, where there is no Octave.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

GUIDE = pathlib.Path(__file__).parents[2] / "docs/artifacts-in-matlab.md"
# A torus bends by 1 / r around its tube everywhere, along its circle by cos / (R + r cos) at most: zero on top. Directions
# of least curvature run along the circle. Vertices of the result are near the torus, and quads are named by their corners.
CHECKS = """
assert(abs(median(k_max) * 0.4 - 1) < 0.1);
assert(abs(median(k_min)) < 1 / (1 - 0.4));
place = positions(:, wedge_vertex);
circle = [-place(2, :); place(1, :); zeros(1, size(place, 2))];
circle = circle ./ sqrt(sum(circle .^ 2));
assert(median(abs(sum(circle .* t_min))) > 0.99);
corner = @(i) positions(:, faces(i, :));
assert(all(sum((corner(1) - corner(2)) .^ 2) < 0.2 ^ 2));
off = abs(hypot(hypot(vertices(1, :), vertices(2, :)) - 1, vertices(3, :)) - 0.4);
assert(max(off) < 0.05);
assert(size(quads, 1) == 4 && size(quads, 2) > 0.8 * numel(sides));
across = vertices(:, quads(1, :)) - vertices(:, quads(3, :));
assert(median(sqrt(sum(across .^ 2))) < 0.5);
disp('checked');
"""


def main():
    if shutil.which("octave-cli") is None:
        print("skipped: install octave to run this test")
        return 1 if os.environ.get("CI") else 77
    programs = pathlib.Path(sys.argv[1]).resolve()
    text = GUIDE.read_text(encoding="utf-8")
    *blocks, shim = re.findall(r"```matlab\n(.*?)```", text, re.S)
    assert shim.startswith("function data = h5read"), shim
    with tempfile.TemporaryDirectory() as folder:
        for command in re.findall(r"^(strake .*)$", text, re.M):
            name, *words = command.split()
            subprocess.run([programs / name, *words], cwd=folder, check=True, capture_output=True)
        pathlib.Path(folder, "h5read.m").write_text(shim, encoding="utf-8")
        pathlib.Path(folder, "guide.m").write_text("\n".join([*blocks, CHECKS]), encoding="utf-8")
        done = subprocess.run(["octave-cli", "--no-init-file", "guide.m"], cwd=folder, text=True, check=False,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    print(done.stdout)
    return 0 if done.returncode == 0 and "checked" in done.stdout.splitlines() else 1


if __name__ == "__main__":
    sys.exit(main())
