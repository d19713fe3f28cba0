#!/usr/bin/env python3
"""Measures time and memory of strake, whole and stage by stage, beside yardsticks of OpenMesh.

    speed.py [MESH...] [--share X] [--threads N...] [--repeat N] [--work FOLDER] [--docs]

Without a mesh: rocker-arm and igea of the test models. Every mesh (closed or not) is remeshed to a
share of its vertices, from file to file, by `strake remesh` and by the programs of the stages one by
one; OpenMesh reads the same file, and decimates it by quadrics to the same number of vertices.
Seconds depend on the machine, the ratio to the decimation far less. Of several repetitions the one
with the least processor time counts.

Prints a table; writes table.md and table.json to the work folder, with --docs also docs/speed.md.
Needs strake, all strake-STAGE and strake-bench-decimate in $STRAKE_BIN (default: build/bin).
"""

import argparse
import dataclasses
import json
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path += [str(ROOT / "scripts"), str(ROOT / "tests" / "bench")]

import documents  # noqa: E402
import processes  # noqa: E402

DEFAULT = ("cad/rocker-arm.obj", "scan/igea.ply")
# Program, what it reads, what it writes, further options.
STAGES = [
    ("import", ["{input}"], "mesh.hdf", []),
    ("tensor", ["mesh.hdf"], "tensor.hdf", []),
    ("smooth", ["mesh.hdf", "tensor.hdf"], "field.hdf", []),
    ("trace", ["mesh.hdf", "field.hdf"], "lines.hdf", ["--vertices", "{wanted}"]),
    ("mesh", ["mesh.hdf", "lines.hdf"], "quads.hdf", []),
    ("fit", ["mesh.hdf", "quads.hdf"], "fitted.hdf", []),
    ("evaluate", ["mesh.hdf", "fitted.hdf"], "quality.json", ["--field", "field.hdf"]),
]
YARDSTICK = "OpenMesh, decimation"


@dataclasses.dataclass(frozen=True)
class Measure:
    """What one program took for one mesh."""

    mesh: str
    program: str
    threads: int
    run: processes.Run
    files_in_mb: float
    files_out_mb: float
    note: str = ""


class Bench:
    def __init__(self, folder, repeat):
        self.folder = folder
        self.repeat = repeat

    def measure(self, mesh, name, threads, command, inputs, output=None):
        """Runs a program on files; ends the bench where it fails."""
        runs = []
        for _ in range(self.repeat):
            if output:
                output.unlink(missing_ok=True)
            run = processes.run(command)
            if run.code != 0:
                documents.fail(f"{' '.join(map(str, command))} returned {run.code}:\n{run.output}")
            runs.append(run)
        best = min(runs, key=lambda run: run.cpu)
        return Measure(mesh.stem, name, threads, best, sum(map(megabytes, inputs)),
                       megabytes(output) if output else 0.0)

    def whole(self, mesh, wanted, threads):
        result = self.folder / "whole.obj"
        report = self.folder / "whole.json"
        found = self.measure(mesh, "strake remesh", threads,
                             [documents.program("strake"), "remesh", mesh, "-o", result,
                              "--vertices", wanted, "--no-evaluate", "--quiet", "--report", report,
                              "--threads", threads], [mesh], result)
        stages = json.loads(report.read_text(encoding="utf-8"))
        vertices = stages["mesh"]["result"]["mesh"]["vertices"]
        return dataclasses.replace(found, note=f"{vertices} vertices"), vertices

    def stages(self, mesh, wanted, threads):
        """The programs of the stages, each on the files of those before it."""
        for name, inputs, output, options in STAGES:
            places = {"input": str(mesh), "wanted": str(wanted)}
            files = [mesh if file == "{input}" else self.folder / file for file in inputs]
            more = [str(self.folder / word) if word.endswith(".hdf") else word.format(**places)
                    for word in options]
            report = self.folder / f"{name}.report"
            target = self.folder / output
            found = self.measure(mesh, f"strake-{name}", threads,
                                 [documents.program(f"strake-{name}"), *files, "-o", target, *more,
                                  "--report", report, "--quiet", "--threads", threads],
                                 files, target)
            if name == "trace":
                trace = json.loads(report.read_text(encoding="utf-8"))["result"]["trace"]
                queries = trace["proximity_queries"]
                found = dataclasses.replace(
                    found, note=f"{queries} proximity queries, "
                    f"{queries / max(found.run.cpu, 1e-3) / 1000:.0f} thousand per second")
            yield found

    def yardsticks(self, mesh, vertices):
        program, result = documents.program("strake-bench-decimate"), self.folder / "decimated.obj"
        yield self.measure(mesh, YARDSTICK, 1, [program, "quadrics", mesh, result, vertices], [mesh],
                           result)
        yield self.measure(mesh, "OpenMesh, reading", 1, [program, "read", mesh], [mesh])


def megabytes(path):
    return path.stat().st_size / 1e6


def measures_of(bench, mesh, share, threads):
    """All measures of one mesh."""
    census = bench.folder / "census.hdf"
    report = bench.folder / "census.json"
    documents.output_of(documents.program("strake-import"), str(mesh), "-o", str(census), "--quiet",
                        "--report", str(report))
    found = json.loads(report.read_text(encoding="utf-8"))["result"]["census"]
    wanted = max(4, round(share * found["vertices"]))
    for count in threads:
        whole, vertices = bench.whole(mesh, wanted, count)
        yield whole
        yield from bench.stages(mesh, wanted, count)
    yield from bench.yardsticks(mesh, vertices)


HEADER = """\
| mesh | program | threads | wall s | processor s | ratio | peak MB | files in, MB | out, MB | |
|---|---|---|---|---|---|---|---|---|---|
"""


def table_of(measures):
    """The Markdown table; `ratio` is processor time over that of the decimation of the same mesh."""
    unit = {found.mesh: found.run.cpu for found in measures if found.program == YARDSTICK}
    return HEADER + "".join(
        f"| {found.mesh} | {found.program} | {found.threads} | {found.run.wall:.2f} "
        f"| {found.run.cpu:.2f} | {found.run.cpu / unit[found.mesh]:.2f} | {found.run.peak_mb:.0f} "
        f"| {found.files_in_mb:.1f} | {found.files_out_mb:.1f} | {found.note} |\n"
        for found in measures)


def json_of(measures):
    records = [dataclasses.asdict(found) for found in measures]
    for record in records:
        del record["run"]["output"], record["run"]["code"]
    return json.dumps(records, indent=1) + "\n"


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("meshes", nargs="*", type=pathlib.Path, metavar="MESH")
    parser.add_argument("--share", type=float, default=0.1,
                        help="vertices wanted, as a share of the input's (default: %(default)s)")
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--repeat", type=int, default=1)
    parser.add_argument("--work", type=pathlib.Path, default=ROOT / "build" / "bench" / "speed")
    parser.add_argument("--docs", action="store_true", help="write docs/speed.md, too")
    return parser.parse_args()


def main():
    arguments = parse_arguments()
    arguments.work.mkdir(parents=True, exist_ok=True)
    bench = Bench(arguments.work, arguments.repeat)
    measures = []
    for mesh in arguments.meshes or [pathlib.Path(documents.model(name)) for name in DEFAULT]:
        if not mesh.is_file():
            documents.fail(f"there is no mesh '{mesh}'")
        for found in measures_of(bench, mesh, arguments.share, arguments.threads):
            measures.append(found)
            print(f"{found.mesh:20s} {found.program:22s} {found.threads} {found.run.wall:8.2f} "
                  f"{found.run.cpu:8.2f} {found.run.peak_mb:7.0f} MB  {found.note}", flush=True)
    table = table_of(measures)
    (arguments.work / "table.md").write_text(table, encoding="utf-8")
    (arguments.work / "table.json").write_text(json_of(measures), encoding="utf-8")
    print(f"\n{table}", end="")
    if arguments.docs:
        page = documents.ROOT / "docs" / "speed.md"
        page.write_text(documents.with_generated(page.read_text(encoding="utf-8"), "speed", table,
                                                 page.name), encoding="utf-8")


if __name__ == "__main__":
    main()
