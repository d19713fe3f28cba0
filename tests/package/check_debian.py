"""Makes the Debian packages of a build, installs, uses and removes them: check_debian.py BUILD.

dpkg installs them into an empty folder, by a copy of the machine's list of packages: dependencies are those
that are really there, and the machine stays as it is. Programs, manual pages, completions and the Python module
work from that place, and nothing is left of them after removal.
"""

import os
import pathlib
import shutil
import sys
import tempfile

from check_package import run


def make_packages(build, folder):
    run("cpack", "-G", "DEB", "--config", build / "CPackConfig.cmake", "-B", folder / "made", cwd=folder)
    packages = {path.name.split("_")[0]: path for path in (folder / "made").glob("*.deb")}
    assert {"strake", "libstrake-dev"} <= set(packages), packages
    return packages


def field(package, name):
    return run("dpkg-deb", "-f", package, name).strip()


def check_control(packages):
    for package in packages.values():
        assert "example" not in field(package, "Maintainer"), field(package, "Maintainer")
    depends = field(packages["strake"], "Depends")
    for library in ("libc6", "libhdf5", "libtbb", "libembree3", "libyaml-cpp"):
        assert library in depends, f"strake does not depend on {library}: {depends}"
    assert "hdf5" not in field(packages["libstrake-dev"], "Depends")
    if "python3-strake" in packages:
        depends = field(packages["python3-strake"], "Depends")
        assert "python3-numpy" in depends and "libtbb" in depends, depends
        assert "hdf5" not in depends, depends


class Installation:
    """A folder with a list of packages of its own, to which dpkg installs as to a machine."""

    def __init__(self, folder):
        self.root, self.list = folder / "root", folder / "dpkg"
        self.root.mkdir()
        for name in ("info", "updates", "triggers"):
            (self.list / name).mkdir(parents=True)
        # All but packages of strake that the machine may have itself.
        installed = pathlib.Path("/var/lib/dpkg/status").read_text().split("\n\n")
        others = [block for block in installed if "strake" not in block.partition("\n")[0]]
        (self.list / "status").write_text("\n\n".join(others))

    def dpkg(self, *words):
        """Runs dpkg on this list and folder. Returns what it said."""
        return run("dpkg", f"--admindir={self.list}", f"--instdir={self.root}", f"--log={self.list}/log",
                   "--force-not-root", "--force-script-chrootless", *words,
                   env={"PATH": "/usr/sbin:/usr/bin:/sbin:/bin"})


def check_installed(installation, packages):
    """All files of the packages are there as packed, and belong to them."""
    for package in packages:
        assert "install ok installed" in installation.dpkg("--status", package), package
        assert installation.dpkg("--verify", package) == "", package
        files = [pathlib.Path(line) for line in installation.dpkg("--listfiles", package).splitlines()[1:]]
        assert files and all((installation.root / path.relative_to("/")).exists() for path in files)


def check_removal(installation, packages):
    installation.dpkg("--purge", *packages)
    left = [path for path in installation.root.rglob("*") if not path.is_dir()]
    assert not left, left


def check_programs(root, folder):
    programs = sorted(path.name for path in (root / "usr/bin").iterdir())
    assert {"strake", "strake-tensor", "strake-render"} <= set(programs), programs
    assert not any("bench" in program for program in programs), "a GPL yardstick is installed"
    for program in programs:
        share = root / "usr/share"
        for file in (f"man/man1/{program}.1", f"bash-completion/completions/{program}",
                     f"zsh/vendor-completions/_{program}",
                     f"fish/vendor_completions.d/{program}.fish"):
            assert (share / file).stat().st_size > 200, file
    environment = {"PATH": f"{root}/usr/bin:/usr/bin:/bin"}
    for line in ("strake --version", "strake sample torus --faces 3000 -o torus.ply",
                 "strake remesh torus.ply -o quads.ply --vertices 300 -q",
                 "strake check quads.ply", "strake-render quads.ply -o quads.png --size 64x48"):
        run(*line.split(), cwd=folder, env=environment)
    assert (folder / "quads.png").read_bytes().startswith(b"\x89PNG")


def check_python(root, folder):
    code = ("import strake, numpy; V, F = strake.remesh(numpy.array([[0., 0, 0], [1, 0, 0], "
            "[1, 1, 0], [0, 1, 0]]), [[0, 1, 2, 3]], faces_wanted=16); print(strake.__file__, len(F))")
    said = run("/usr/bin/python3", "-c", code, cwd=folder,
               env={"PYTHONPATH": f"{root}/usr/lib/python3/dist-packages", "PATH": os.environ["PATH"],
                    "PYTHONDONTWRITEBYTECODE": "1"})
    assert said.startswith(str(root)), said


def main():
    if shutil.which("dpkg-deb") is None:
        sys.exit("failed: this test needs dpkg")
    build = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory(prefix="strake-debian-") as name:
        folder = pathlib.Path(name)
        packages = make_packages(build, folder)
        check_control(packages)
        installation = Installation(folder)
        installation.dpkg("--install", *packages.values())
        check_installed(installation, packages)
        root = installation.root
        check_programs(root, folder)
        if "python3-strake" in packages:
            check_python(root, folder)
        assert (root / "usr/lib/cmake/strake/strakeConfig.cmake").exists()
        check_removal(installation, packages)
        sizes = ", ".join(f"{package} {path.stat().st_size / 1e6:.1f} MB"
                          for package, path in sorted(packages.items()))
        print(f"the Debian packages work: {sizes}")


if __name__ == "__main__":
    main()
