"""Installs strake into an empty folder and uses what is there: check_package.py BUILD [CMAKE-ARGS...].

An outside project finds the package, links the library without HDF5 and remeshes arrays; every
installed header compiles; the installed programs run a pipeline from their new place.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).parent
ROOT = HERE.parents[1]


def run(*command, **settings):
    """Runs a command that must succeed. Returns what it said."""
    done = subprocess.run([str(word) for word in command], text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, **settings)
    if done.returncode != 0:
        sys.exit(f"failed: {' '.join(map(str, command))}\n{done.stdout}")
    return done.stdout


def documented_code(folder):
    """The C++ example of docs/library.md as a source file: its main under another name."""
    code = re.search(r"```cpp\n(.*?)```", (ROOT / "docs/library.md").read_text(), re.S)[1]
    assert "int main()" in code
    path = folder / "documented.cpp"
    path.write_text(code.replace("int main()", "int documented_example()"))
    return path


def check_headers(prefix, build, arguments):
    """All installed headers compile with what is installed."""
    headers = sorted((prefix / "include/strake").rglob("*.h"))
    assert len(headers) > 40, headers
    sources = build / "headers"
    sources.mkdir()
    (sources / "all.cpp").write_text("".join(
        f'#include "{header.relative_to(prefix / "include/strake")}"\n' for header in headers))
    (sources / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.25)\nproject(headers LANGUAGES CXX)\n"
        "find_package(strake CONFIG REQUIRED)\nadd_library(headers OBJECT all.cpp)\n"
        "target_link_libraries(headers PRIVATE strake::strake)\n"
        "target_compile_options(headers PRIVATE -fsyntax-only)\n")
    run("cmake", "-S", sources, "-B", sources / "build", *arguments)
    run("ninja", "-C", sources / "build", "-j1", "CMakeFiles/headers.dir/all.cpp.o")


def check_library(prefix, folder, arguments):
    build = folder / "outside"
    run("cmake", "-S", HERE, "-B", build, f"-DOUTSIDE_DOCUMENTED={documented_code(folder)}",
        *arguments)
    run("cmake", "--build", build, "-j1")
    for program in ("outside", "stages"):
        print(run(build / program, cwd=folder), end="")
        libraries = run("ldd", build / program)
        assert "hdf5" not in libraries, libraries


def check_programs(prefix, folder):
    environment = {"PATH": f"{prefix}/bin:/usr/bin:/bin"}
    for line in ("strake sample torus --faces 4000 -o torus.ply",
                 "strake remesh torus.ply -o quads.obj --vertices 300 -q",
                 "strake check quads.obj",
                 "strake-import torus.ply -o mesh.hdf -q", "strake check mesh.hdf"):
        run(*line.split(), cwd=folder, env=environment)
    # The engine calls the programs beside it: the standard pipeline, on one small model.
    pipeline = (ROOT / "pipeline.yaml").read_text()
    pipeline = re.sub(r"^models:.*?\n\n", "models:\n  torus: torus.ply\n\n", pipeline, count=1,
                      flags=re.S | re.M)
    (folder / "pipeline.yaml").write_text(pipeline)
    run("strake", "run", "-q", cwd=folder, env=environment)
    assert (folder / "out/torus-fine.obj").exists()


def main():
    build, *arguments = sys.argv[1:]
    with tempfile.TemporaryDirectory(prefix="strake-package-") as name:
        folder = pathlib.Path(name)
        prefix = folder / "prefix"
        run("cmake", "--install", build, "--prefix", prefix)
        arguments += ["-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_BUILD_TYPE=Release",
                      "-DCMAKE_DISABLE_FIND_PACKAGE_HDF5=ON"]
        check_library(prefix, folder, arguments)
        check_headers(prefix, folder, arguments)
        check_programs(prefix, folder)
    print("the installed package works")


if __name__ == "__main__":
    main()
