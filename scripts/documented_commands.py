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
    "scripts/check_clang": ("scripts/test", "scripts/check_clang build-clang"),
    "scripts/check_clang --unity": ("scripts/test", "-DCMAKE_UNITY_BUILD=ON"),
    "scripts/check_cppcheck": ("scripts/test", "scripts/check_cppcheck"),
    "ctest --preset release -R Trace": ("scripts/test", 'ctest --preset "$preset"'),
    "ctest --preset release -L slurm": ("scripts/test", 'ctest --preset "$preset"'),
    "ctest -L browser": ("scripts/test", 'ctest --preset "$preset"'),
    "ctest -L paraview": ("tests/CMakeLists.txt", "paraview/check_guide.py"),
    "pvpython docs/paraview/show_run.py work pictures": ("tests/paraview/check_guide.py", "docs/paraview/show_run.py"),
    "ctest -L blender": ("scripts/test", 'ctest --preset "$preset"'),
    "cmake --install build": ("tests/package/check_package.py", 'run("cmake", "--install", build'),
    "cmake --install build --prefix PREFIX": ("tests/package/check_package.py", 'run("cmake", "--install", build'),
    "cmake --build build --target strake strake-render strake-bench-decimate": ("scripts/test", "benches=(strake-bench-decimate"),
    "cmake --build build --target strake-bench-decimate": ("scripts/test", "benches=(strake-bench-decimate"),
    "cmake --build build --target strake-bench-kernels": ("scripts/test", "strake-bench-kernels"),
    "scripts/mutate": ("scripts/test", "scripts/mutate 1 "),
    "scripts/sanitize": ("scripts/test", "scripts/sanitize --few"),
    "scripts/fuzz 60": ("tests/fuzz/CMakeLists.txt", "scripts/fuzz --built"),
    "cpack -G DEB": ("tests/package/check_debian.py", 'run("cpack", "-G", "DEB"'),
}

# Code blocks of programming languages, and the tests that run them.
CODE = {
    "docs/library.md cpp": ("tests/package/check_package.py", "docs/library.md"),
    "docs/python.md python": ("tests/python/module_test.py", "docs/python.md"),
    "docs/artifacts-in-matlab.md matlab": ("tests/artifacts/artifacts_in_octave.py", "docs/artifacts-in-matlab.md"),
    "docs/artifacts-in-python.md python": ("tests/artifacts/artifacts_in_python.py", "docs/artifacts-in-python.md"),
}

# Run on small models of our own making under names of the collection, in a copy of the tree: they measure for minutes to
# hours else, and rewrite documents. A command, and how it is called then; once, where several are called the same.
_MEASURE = "STRAKE_MODELS=models STRAKE_METER=meshmeter STRAKE_BIN=build/bin scripts/measure_docs"
_SPEED = "STRAKE_MODELS=models tests/bench/speed/speed.py"
_QUALITY = "STRAKE_MODELS=models STRAKE_METER=meshmeter tests/bench/quality/quality.py --docs"
ON_SMALL_MODELS = {
    "scripts/measure_docs": _MEASURE,
    _MEASURE: _MEASURE,
    "scripts/render_docs": "scripts/render_docs",
    "tests/bench/quality/quality.py --docs": _QUALITY,
    _QUALITY: _QUALITY,
    "tests/bench/speed/speed.py --docs": f"{_SPEED} models/scan/igea.ply --docs",
    f"{_SPEED} [MESH...] --docs": f"{_SPEED} models/scan/igea.ply --docs",
    "tests/corpus/check_corpus.py all --strake build/bin/strake --table docs/models.md":
        "tests/corpus/check_corpus.py all --strake build/bin/strake --table docs/models.md",
    "scripts/compare_builds build/bin build-clang/bin MESH...": "scripts/compare_builds build/bin build-clang/bin models/scan/igea.ply",
}

# Run by a person: why no test does.
BY_HAND = {
    "scripts/check_paraview": "fetches 2 GB; before each release",
}

# Commands that serve until their input ends, for the others of their page, and what those are told.
BACKGROUND = {"tests/slurm/private_slurm.py slurm-trial 3": {"SLURM_CONF": "{folder}/slurm-trial/slurm.conf"}}
