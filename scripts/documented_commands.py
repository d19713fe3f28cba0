"""Commands of documents that scripts/run_examples does not run itself, and why."""

# Run by another script or test: the file, and the words in it that do so.
ELSEWHERE = {
    "scripts/test": (".ci/run", "exec scripts/test"),
    "scripts/setup": ("scripts/test", "scripts/setup"),
    "scripts/setup --all": ("scripts/test", "scripts/setup --browser"),
    "scripts/build_viewer": ("scripts/test", "scripts/build_viewer"),
    "scripts/remesh": ("scripts/test", "scripts/remesh\n"),
    "scripts/remesh scan.ply -o quads.obj": ("scripts/test", "scripts/remesh out/part.ply -o out/quads.obj"),
    "scripts/run_examples": ("tests/CMakeLists.txt", "scripts/run_examples"),
    "cmake --preset release && cmake --build build": ("scripts/test", 'cmake --preset "$preset"'),
    "cmake --build build": ("scripts/test", 'cmake --build --preset "$preset"'),
    "scripts/check_cppcheck": ("scripts/test", "scripts/check_cppcheck"),
    "ctest --preset release -R Trace": ("scripts/test", 'ctest --preset "$preset"'),
    "ctest --preset release -L slurm": ("scripts/test", 'ctest --preset "$preset"'),
    "ctest -L browser": ("scripts/test", 'ctest --preset "$preset"'),
    "ctest -L paraview": ("tests/CMakeLists.txt", "paraview/check_guide.py"),
    "pvpython docs/paraview/show_run.py work pictures": ("tests/paraview/check_guide.py", "docs/paraview/show_run.py"),
    "ctest -L blender": ("scripts/test", 'ctest --preset "$preset"'),
    "cmake --install build": ("tests/package/check_package.py", 'run("cmake", "--install", build'),
    "cmake --install build --prefix PREFIX": ("tests/package/check_package.py", 'run("cmake", "--install", build'),
    "cpack -G DEB": ("tests/package/check_debian.py", 'run("cpack", "-G", "DEB"'),
}

# Code blocks of programming languages, and the tests that run them.
CODE = {
    "docs/library.md cpp": ("tests/package/check_package.py", "docs/library.md"),
    "docs/python.md python": ("tests/python/module_test.py", "docs/python.md"),
    "docs/artifacts-in-python.md python": ("tests/artifacts/artifacts_in_python.py", "docs/artifacts-in-python.md"),
}

# Run by a person: why no test does.
_FIGURES = "measures for minutes to hours, needs the test models and the meter, and rewrites a document"
BY_HAND = {
    "scripts/measure_docs": _FIGURES,
    "STRAKE_MODELS=models STRAKE_METER=meshmeter STRAKE_BIN=build/bin scripts/measure_docs": _FIGURES,
    "scripts/render_docs": _FIGURES,
    "tests/bench/quality/quality.py --docs": _FIGURES,
    "STRAKE_MODELS=models STRAKE_METER=meshmeter tests/bench/quality/quality.py --docs": _FIGURES,
    "tests/bench/speed/speed.py --docs": _FIGURES,
    "tests/corpus/check_corpus.py all --strake build/bin/strake --table docs/models.md": _FIGURES,
    "STRAKE_MODELS=models tests/bench/speed/speed.py [MESH...] --docs": _FIGURES,
    "cmake --build build --target strake strake-render strake-bench-decimate": "for the benches above",
    "cmake --build build --target strake-bench-decimate": "for the benches above",
    "scripts/compare_builds build/bin build-clang/bin MESH...": "takes another build of everything, with clang",
    "scripts/mutate": "builds a part of everything anew for each fault, for half an hour",
    "paraview --state=pictures/run.pvsm": "opens a window",
    "tests/paraview/make_root paraview-root": "fetches 2 GB; before each release",
    "STRAKE_PVPYTHON=$PWD/paraview-root/pvpython ctest --preset release -L paraview": "takes the above",
    "scripts/fuzz 60": "builds everything anew with clang and looks for faults as long as it is let",
}

# Commands that serve until their input ends, for the others of their page, and what those are told.
BACKGROUND = {"tests/slurm/private_slurm.py slurm-trial 3": {"SLURM_CONF": "{folder}/slurm-trial/slurm.conf"}}
