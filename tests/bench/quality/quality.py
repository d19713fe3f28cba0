#!/usr/bin/env python3
"""Remeshes the closed test models at several sizes and measures the results beside those of others.

    quality.py [--models PATTERN...] [--most-faces N] [--jobs N] [--work FOLDER] [--docs]

Every model of the groups scan, cad and genus that is closed, oriented and manifold is remeshed to
1/10 and 1/4 of its vertices, models with figures of Instant Meshes in docs/peers.csv also to its
counts. The same model decimated to the same number of vertices, by OpenMesh's quadrics and by CGAL's
Lindstrom-Turk, is the yardstick. All are measured by the independent meter (scripts/judges.py).

Tables and pictures go to the work folder; --docs writes docs/quality-bench.md and .csv and
docs/images/bench. Runs are kept in the work folder, so a bench that was broken off goes on. Programs
are taken from $STRAKE_BIN (default: build/bin; strake, strake-render, strake-bench-decimate), models
from $STRAKE_MODELS. Everything anew takes about half an hour of processor time.
"""

import argparse
import concurrent.futures
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path += [str(ROOT / folder) for folder in ("scripts", "tests/bench", "tests/corpus")]

import cases  # noqa: E402
import documents  # noqa: E402
import judges  # noqa: E402
import pictures  # noqa: E402
import summary  # noqa: E402


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--models", nargs="+", default=[], metavar="PATTERN",
                        help="only models whose GROUP/FILE contains one of these")
    parser.add_argument("--most-faces", type=int, help="leave out models with more faces")
    parser.add_argument("--jobs", type=int, default=1,
                        help="cases at the same time, of one thread each (default: %(default)s)")
    parser.add_argument("--work", default=ROOT / "build" / "bench" / "quality",
                        help="folder of kept runs and tables (default: %(default)s)")
    parser.add_argument("--no-pictures", action="store_true", help="only measure")
    parser.add_argument("--docs", action="store_true", help="write the documents, too")
    return parser.parse_args()


def main():
    arguments = parse_arguments()
    work = pathlib.Path(arguments.work)
    bench = cases.Bench(work / "kept", judges.judge())
    chosen, left_out = cases.cases_of(bench, arguments.models, arguments.most_faces)
    if not chosen:
        documents.fail("no model of that name")
    rows = []
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for case, row in zip(chosen, pool.map(bench.row, chosen)):
            rows.append(row)
            print(f"{case.model:32s} {case.size:5s}",
                  *(f"{cell or '-':>7s}" for cell in summary.cells(row)), row["fault"], flush=True)
    goals, table = summary.goal_table(rows), summary.case_table(rows)
    measured_by = f"Measured by {bench.judge.name}.\n"
    if left_out:
        measured_by += "Left out: " + ", ".join(
            f"{model} ({why})" for model, why in left_out.items()) + ".\n"
    (work / "table.md").write_text(f"{measured_by}\n{goals}\n{table}", encoding="utf-8")
    (work / "table.csv").write_text(summary.csv_text(rows), encoding="utf-8")
    print(f"\n{goals}")
    folder = documents.ROOT / "docs" / "images" / "bench" if arguments.docs else work / "pictures"
    gallery = "" if arguments.no_pictures else pictures.draw(bench, chosen, folder)
    if arguments.docs:
        page = documents.ROOT / "docs" / "quality-bench.md"
        text = page.read_text(encoding="utf-8")
        for name, block in (("goals", f"{measured_by}\n{goals}"), ("cases", table),
                            ("pictures", gallery)):
            text = documents.with_generated(text, name, block, page.name)
        page.write_text(text, encoding="utf-8")
        page.with_suffix(".csv").write_text(summary.csv_text(rows), encoding="utf-8")
    return 1 if any(row["fault"] for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
