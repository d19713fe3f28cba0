#!/usr/bin/env python3
"""Remeshes the collection of test models and judges every result with an independent meter.

    check_corpus.py SUITE --strake PROGRAM [--models FOLDER] [--meter PROGRAM] [--count N]
                    [--slower FACTOR] [--most-bytes N] [--most-vertices N] [--tolerance SHARE] [NAME...]

Suites:
  default  every manifold model of scan, cad, genus and open, with strake's defaults: the same
           topology, an oriented manifold, at most 5 sides, few concave faces
  tenth    the same with a tenth of the input's vertices wanted, which must be met within 10 %
  tolerance  clean models, also of polygons, with --tolerance, a share of the diagonal: the same
           topology, and no place farther off
  quality  quads and distance at five published settings
  dirty    every broken file: a sound result, or a refusal that says why; never a crash
  all      every file of the collection with strake's defaults, within 120 s and 2 GB; --table FILE
           puts the results between the marks of a document
  adversarial  the same for generated meshes: --count of them, from --first on

Prints a table; returns 0 where all is well, 1 where a model fails, 77 where models or meter are
missing (with environment CI that is a failure too).
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import textwrap
import time

import adversary
import models

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "scripts"))

import documents  # noqa: E402
import judges  # noqa: E402

CATEGORIES = ("scan", "cad", "genus", "open")
ALL_CLEAN = (*CATEGORIES, "poly", "large")
PARALLEL = 2

MOST_CONCAVE_PERCENT = 0.5
COUNT_TOLERANCE = 0.1
# Seconds of processor time for one model: several times what the slowest takes on an idle machine, as
# neighbours on the same cores can double it; and how much longer it may take by the clock.
TIME_LIMIT = {"default": 300, "tenth": 300, "quality": 300, "dirty": 60, "adversarial": 50,
              "tolerance": 120, "all": 120}
CLOCK_FACTOR = 5
# Seeds of generated meshes that took minutes, and vertices wanted of them; 0: no goal.
ENDLESS_ONCE = ((356, 0), (356, 300))
MEMORY_LIMIT = 2000  # MB of the largest process

# Model, wanted vertices. The RMS distance shall not be above that of Instant Meshes without crease mode.
QUALITY = [
    ("cad/rocker-arm.obj", 2500),
    ("cad/rocker-arm.obj", 5000),
    ("cad/fandisk.obj", 2500),
    ("scan/stanford-bunny.obj", 5000),
    ("scan/igea.ply", 5000),
]
PEER = "Instant Meshes"
LEAST_QUAD_PERCENT = 85
LEAST_QUAD_PERCENT_BY_AREA = 75

# Exit codes of strake that refuse an input: bad file, and nothing that can be used.
REFUSALS = (3, 4)
# What the limits send, as `timeout` passes it on.
KILLED = (128 + signal.SIGXCPU, 128 + signal.SIGKILL, -signal.SIGKILL)


class Case:
    """One run of strake, and what is wrong with its result."""

    def __init__(self, path, wanted=0, rms_limit=None, model=None, broken=False):
        self.path = path
        self.wanted = wanted
        self.rms_limit = rms_limit
        self.model = model
        self.broken = broken  # may be refused, and is no measure for a result
        self.exit = None
        self.seconds = 0.0
        self.processor_seconds = 0.0
        self.megabytes = 0.0
        self.measures = None
        self.message = ""
        self.faults = []

    @property
    def name(self):
        return self.path.name

    def row(self):
        cells = [f"{self.name:38s} {self.exit!s:>4} {self.seconds:6.1f} {self.wanted or '-':>6}"]
        if self.measures:
            c = self.measures["candidate"]
            rms = self.measures.get("distance", {}).get("rms")
            cells.append(f"{c['vertices']:6d} {c['quad_percent'] or 0:5.1f} "
                         f"{c['quad_percent_by_area'] or 0:5.1f} "
                         f"{'-' if rms is None else format(1e4 * rms, '.2f'):>6} "
                         f"{concave_percent(c):5.2f}")
        else:
            cells.append(f"{'-':>6} {'-':>5} {'-':>5} {'-':>6} {'-':>5}")
        cells.append("FAILED: " + "; ".join(self.faults) if self.faults else "ok")
        return " ".join(cells)


HEADER = (f"{'model':38s} {'exit':>4} {'sec':>6} {'wanted':>6} {'V':>6} {'quad%':>5} {'area%':>5} "
          f"{'rms':>6} {'conc%':>5} verdict      (rms in 1e-4 of the diagonal)")


def concave_percent(candidate):
    return 100 * candidate["concave_faces"] / max(1, candidate["faces"])


class Checker:
    def __init__(self, arguments, scratch):
        self.suite = arguments.suite
        self.time_limit = arguments.slower * TIME_LIMIT[arguments.suite]
        self.tolerance = arguments.tolerance if arguments.suite == "tolerance" else None
        self.strake = arguments.strake
        self.meter = arguments.meter
        self.scratch = scratch

    def check(self, case):
        output = self.scratch / f"{case.path.stem}-{case.path.suffix[1:]}-{case.wanted}.obj"
        self.remesh(case, output)
        if case.exit == 0 and not output.exists():
            case.faults.append("exit 0 without a result")
        elif case.exit == 0:
            self.measure(case, output)
            self.judge(case)
        elif case.broken and case.exit in REFUSALS:
            if not case.message:
                case.faults.append("refused without a message")
            if output.exists():
                case.faults.append("refused, but wrote a result")
        elif case.exit in KILLED:
            case.faults.append(f"longer than {self.time_limit} s of processor time")
        elif case.exit is not None:
            case.faults.append(f"exit {case.exit}: {case.message[-300:]}")
        return case

    def remesh(self, case, output):
        command = [self.strake, "remesh", case.path, "-o", output, "--quiet", "--no-evaluate",
                   "--threads", "1"]
        if case.wanted:
            command += ["--vertices", str(case.wanted)]
        if self.tolerance:
            command += ["--tolerance", f"{100 * self.tolerance}%"]
        limit = self.time_limit
        limited = ["timeout", "-s", "KILL", str(CLOCK_FACTOR * limit),
                   "sh", "-c", 'ulimit -t "$0" && exec "$@"', str(limit), *command]
        started = time.monotonic()
        with tempfile.TemporaryFile("w+", errors="replace") as messages:
            run = subprocess.Popen(limited, stdout=subprocess.DEVNULL, stderr=messages)
            _, status, usage = os.wait4(run.pid, 0)
            run.returncode = os.waitstatus_to_exitcode(status)
            messages.seek(0)
            case.message = " ".join(messages.read().split())
        case.exit = run.returncode
        case.seconds = time.monotonic() - started
        case.processor_seconds = usage.ru_utime + usage.ru_stime
        case.megabytes = usage.ru_maxrss / 1024
        if self.suite == "all" and case.megabytes > MEMORY_LIMIT:
            case.faults.append(f"{case.megabytes:.0f} MB")

    def measure(self, case, output):
        if case.broken:  # a broken reference is no measure
            arguments = [output, output, "--no-distance"]
        else:
            samples = "200000" if self.suite in ("quality", "tolerance") else "1000"
            arguments = [models.reference(case.path, self.scratch), output, "--samples", samples]
        run = subprocess.run([self.meter, *arguments, "--threads", "1"], capture_output=True,
                             text=True, check=False)
        if run.returncode != 0:
            case.faults.append("the meter cannot read the result: " + run.stderr.strip()[-200:])
            return
        case.measures = json.loads(run.stdout)

    def judge(self, case):
        if not case.measures:
            return
        result = case.measures["candidate"]
        for key in ("manifold", "consistently_oriented"):
            if not result[key]:
                case.faults.append("not " + key.replace("_", " "))
        for key in ("bad_faces_in_file", "repeated_index_faces", "unused_vertices"):
            if result[key]:
                case.faults.append(f"{result[key]} {key.replace('_', ' ')}")
        if result["face_sides"]["more"]:
            case.faults.append(f"{result['face_sides']['more']} faces with more than 5 sides")
        if not result["faces"]:
            case.faults.append("no faces")
        if case.broken:
            return
        self.judge_against_input(case, result)
        if self.suite == "quality":
            self.judge_quality(case, result)
        if self.tolerance and case.measures["distance"]["hausdorff"] > self.tolerance:
            case.faults.append(f"{case.measures['distance']['hausdorff']:.3g} of the diagonal away, "
                               f"not above {self.tolerance} is wanted")

    def judge_against_input(self, case, result):
        source = case.measures["reference"]
        for key in ("components", "boundary_loops", "genus"):
            if result[key] != source[key]:
                case.faults.append(f"{key.replace('_', ' ')} {result[key]} instead of {source[key]}")
        if case.model:  # the meter must have seen the surface that the table describes
            table = (case.model.components, case.model.loops, case.model.genus)
            seen = (source["components"], source["boundary_loops"], source["genus"])
            if table != seen:
                case.faults.append(f"the input has topology {seen}, MANIFEST.md says {table}")
        concave = concave_percent(result)
        if not self.tolerance and concave > MOST_CONCAVE_PERCENT:
            case.faults.append(f"{concave:.2f} % of the faces are concave")
        if case.wanted and abs(result["vertices"] - case.wanted) > COUNT_TOLERANCE * case.wanted:
            case.faults.append(f"{result['vertices']} vertices instead of {case.wanted}")

    @staticmethod
    def judge_quality(case, result):
        rms = case.measures["distance"]["rms"]
        if rms > case.rms_limit:
            case.faults.append(f"RMS distance {1e4 * rms:.2f}e-4, not above "
                               f"{1e4 * case.rms_limit:.2f}e-4 is wanted")
        for key, least in (("quad_percent", LEAST_QUAD_PERCENT),
                           ("quad_percent_by_area", LEAST_QUAD_PERCENT_BY_AREA)):
            if result[key] < least:
                case.faults.append(f"{key.replace('_', ' ')} {result[key]:.1f}, at least {least} "
                                   "is wanted")


def generated(arguments, scratch):
    seeds = range(arguments.first, arguments.first + arguments.count)
    cases = [(seed, 0) for seed in seeds]
    cases += [case for case in ENDLESS_ONCE if case not in cases]
    return [Case(adversary.write_mesh(seed, scratch), wanted, broken=True) for seed, wanted in cases]


def cases_of(suite, folder):
    if suite == "quality":
        return [Case(folder / name, wanted,
                     1e-4 * float(documents.peer_near(name, wanted, [PEER])["rms"]))
                for name, wanted in QUALITY]
    dirty = [Case(path, broken=True) for path in sorted((folder / "dirty").iterdir()) if path.is_file()]
    if suite == "dirty":
        return dirty
    if suite == "all":
        listed = {model.path: model for model in models.read_manifest(folder)}
        return dirty + [Case(path, model=listed.get(path)) for category in ALL_CLEAN
                        for path in sorted((folder / category).iterdir()) if path.is_file()]
    listed = models.read_manifest(folder)
    if suite == "tolerance":
        return [Case(model.path, model=model) for model in listed
                if model.category in (*CATEGORIES, "poly")]
    sound = [model for model in listed if model.category in CATEGORIES]
    return [Case(model.path, model.vertices // 10 if suite == "tenth" else 0, model=model)
            for model in sound]


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("suite", choices=TIME_LIMIT)
    parser.add_argument("names", nargs="*", help="only models whose file name contains one of these")
    judges.add_arguments(parser)
    parser.add_argument("--count", type=int, default=2000, help="generated meshes")
    parser.add_argument("--first", type=int, default=0, help="seed of the first of them")
    parser.add_argument("--table", type=pathlib.Path, help="document to put the results into")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for generated meshes that failed")
    parser.add_argument("--slower", type=int, default=1,
                        help="factor on time limits, for programs built with sanitizers")
    parser.add_argument("--most-bytes", type=int, help="only models of files up to that size")
    parser.add_argument("--most-vertices", type=int, help="only listed models of up to so many")
    parser.add_argument("--tolerance", type=float, default=0.003,
                        help="of the suite of that name, as a share of the diagonal")
    return parser.parse_args()


def main():
    arguments = parse_arguments()
    judges.check_arguments(arguments)
    with tempfile.TemporaryDirectory(prefix="strake-corpus-") as scratch:
        scratch = pathlib.Path(scratch)
        if arguments.suite == "adversarial":
            cases = generated(arguments, scratch)
        else:
            cases = cases_of(arguments.suite, arguments.models)
        if arguments.names:
            cases = [case for case in cases if any(name in case.name for name in arguments.names)]
        if arguments.most_bytes:
            cases = [case for case in cases if case.path.stat().st_size <= arguments.most_bytes]
        if arguments.most_vertices:
            cases = [case for case in cases if case.model and case.model.vertices <= arguments.most_vertices]
        if not cases:
            print("check_corpus: error: no model of that name", file=sys.stderr)
            return 2
        code = check_all(cases, Checker(arguments, scratch), arguments.keep)
        if arguments.table:
            text = arguments.table.read_text(encoding="utf-8")
            arguments.table.write_text(
                documents.with_generated(text, "models", table_of(cases), arguments.table),
                encoding="utf-8")
        return code


def reason_of(case):
    """Why a file was refused, as the program says."""
    reason = case.message.split("error: ", 1)[-1].replace(f"{case.path.parent}/", "")
    return textwrap.shorten(reason, 160, placeholder=" …")


def table_of(cases):
    """The results as rows of a Markdown table."""
    rows = ["| model | result | vertices | faces | quads % | processor s | peak MB | |",
            "|---|---|---|---|---|---|---|---|"]
    for case in sorted(cases, key=lambda case: (case.path.parent.name, case.name.lower())):
        name = f"{case.path.parent.name}/{case.name}"
        cells = [name, "sound" if case.exit == 0 else "refused", "", "", ""]
        if case.measures:
            result = case.measures["candidate"]
            cells[2:] = [str(result["vertices"]), str(result["faces"]),
                         f"{result['quad_percent'] or 0:.1f}"]
        remark = "" if case.exit == 0 else reason_of(case)
        if case.faults:
            cells[1], remark = "**fails**", "; ".join(case.faults)
        rows.append(f"| {' | '.join(cells)} | {case.processor_seconds:.1f} | "
                    f"{case.megabytes:.0f} | {remark} |")
    return "\n".join(rows) + "\n"


def check_all(cases, checker, keep):
    print(HEADER)
    started = time.monotonic()
    with concurrent.futures.ThreadPoolExecutor(PARALLEL) as pool:
        for case in pool.map(checker.check, cases):
            if case.faults or checker.suite != "adversarial":
                print(case.row(), flush=True)
            if case.faults and keep:
                shutil.copy(case.path, keep)
    failed = [case for case in cases if case.faults]
    refused = sum(case.exit in REFUSALS for case in cases)
    print(f"{checker.suite}: {len(cases)} cases, {refused} refused, {len(failed)} failed, "
          f"{time.monotonic() - started:.0f} s")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
