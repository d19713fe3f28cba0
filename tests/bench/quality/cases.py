"""The cases of the quality bench, and the runs behind each of them, kept from one time to the next.

Every run is kept under a digest of the programs, files and words that it was made from, so a bench
that was broken off goes on, and only what a changed program makes is made again.
"""

import collections
import hashlib
import json
import os
import pathlib
import threading
from dataclasses import dataclass

import documents
import models
import processes

GROUPS = ("scan", "cad", "genus")
# Sizes wanted of every model, as shares of its vertices.
SHARES = {"1/10": 0.1, "1/4": 0.25}
# The peer that the figures at its own counts are compared with: its more accurate mode, else the other.
PEER_MODES = ("Instant Meshes crease", "Instant Meshes")
YARDSTICKS = ("quadrics", "lindstrom-turk")
MOST_SECONDS = 1200


@dataclass(frozen=True)
class Case:
    """One model at one size."""

    model: str  # group/file
    size: str  # of SHARES, or "peer"
    wanted: int  # vertices
    input: dict  # its census
    peer: dict  # its row of docs/peers.csv, or None

    @property
    def group(self):
        return self.model.split("/")[0]


def digest_of(path):
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


class Bench:
    def __init__(self, folder, judge):
        self.folder = pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.judge = judge
        self.strake = documents.program("strake")
        self.decimate = documents.program("strake-bench-decimate")
        self.digests = {}
        self.locks = collections.defaultdict(threading.Lock)  # one a key: cases may share runs

    def reference(self, model):
        """A file with the surface of a model whose vertices are joined."""
        return models.reference(pathlib.Path(documents.model(model)), self.folder)

    def _digest(self, path):
        if path not in self.digests:
            self.digests[path] = digest_of(path)
        return self.digests[path]

    def _kept(self, step, programs, files, words, make):
        """What `make(mesh path)` returned when it was last called for the same step, or now."""
        parts = [step, *(self._digest(path) for path in (*programs, *files)), *map(str, words)]
        key = hashlib.sha256("\n".join(parts).encode()).hexdigest()[:24]
        record, mesh = self.folder / f"{key}.json", self.folder / f"{key}.obj"
        with self.locks[key]:
            if not record.exists():
                found = make(mesh)
                draft = record.with_suffix(".draft")
                draft.write_text(json.dumps(found), encoding="utf-8")
                os.replace(draft, record)
        return json.loads(record.read_text(encoding="utf-8")), mesh

    def census(self, model):
        reference = self.reference(model)
        return self._kept("census", self.judge.programs(), [reference], [],
                          lambda _: self.judge.census(reference))[0]

    def measure(self, model, mesh):
        """The judge's figures of a mesh beside the model it was made from."""
        reference = self.reference(model)
        return self._kept("measure", self.judge.programs(), [reference, mesh], [],
                          lambda _: self.judge.measure(reference, mesh))[0]

    def remesh(self, case):
        """What a run of `strake remesh` took and said, and its result."""
        source = documents.model(case.model)

        def make(mesh):
            report = mesh.with_suffix(".report")
            run = processes.run([self.strake, "remesh", source, "-o", mesh, "--vertices",
                                 case.wanted, "--report", report, "--threads", "1", "--quiet"],
                                MOST_SECONDS)
            found = {"code": run.code, "said": run.output[-500:], "seconds": run.cpu}
            if run.code == 0:
                stages = json.loads(report.read_text(encoding="utf-8"))
                found["t_joints"] = stages["evaluate"]["result"]["valence"]["t_joints"]
                report.unlink()
            return found

        return self._kept("remesh", [self.strake], [source], [case.wanted], make)

    def decimated(self, model, method, vertices):
        """A model decimated by a yardstick; None where that fails or misses the count."""
        reference = self.reference(model)

        def make(mesh):
            run = processes.run([self.decimate, method, reference, mesh, vertices], MOST_SECONDS)
            return {"code": run.code, "said": run.output[-500:]}

        found, mesh = self._kept("decimate", [self.decimate], [reference], [method, vertices], make)
        if found["code"] != 0:
            return None
        figures = self.measure(model, mesh)
        return figures if abs(figures["vertices"] - vertices) <= 0.02 * vertices else None

    def row(self, case):
        """The figures of one case, by name; `fault` says what went wrong."""
        row = {"model": case.model, "size": case.size, "input_vertices": case.input["vertices"],
               "input_crossing_pairs": case.input["crossing_pairs"], "wanted": case.wanted}
        run, mesh = self.remesh(case)
        row["seconds"] = run["seconds"]
        if run["code"] != 0:
            return row | {"fault": f"exit {run['code']}: {' '.join(run['said'].split())[-200:]}"}
        found = self.measure(case.model, mesh)
        row |= {name: found[name] for name in
                ("vertices", "faces", "quads", "quads_by_area", "rms", "max", "aligned",
                 "valence_4", "concave", "crossing_pairs")}
        row["t_joints"] = 100 * run["t_joints"] / found["vertices"]
        if found["sharp_faces"] is not None:
            row["open_faces"] = 100 - 100 * found["sharp_faces"] / found["faces"]
        faults = [f"{key} {found[key]} instead of {case.input[key]}"
                  for key in ("components", "genus", "closed") if found[key] != case.input[key]]
        if not found["sound"]:
            faults.append("not an oriented manifold")
        row["fault"] = "; ".join(faults)
        for method in YARDSTICKS:
            other = self.decimated(case.model, method, found["vertices"])
            for name in ("rms", "max"):
                row[f"{method}_{name}"] = other and other[name]
                row[f"{name}_to_{method}"] = other and ratio(found[name], other[name])
        if case.peer:
            row["peer_vertices"] = int(case.peer["vertices"])
            row["rms_to_peer"] = ratio(found["rms"], 1e-4 * float(case.peer["rms"]))
            row["max_to_peer"] = ratio(found["max"], 1e-3 * float(case.peer["max"]))
        return row


def ratio(a, b):
    return a / b if b > 0 else None


def peer_rows(model):
    """The figures of the peer for a model, one row for every count, of its more accurate mode."""
    return [documents.peer_near(model, int(row["vertices"]), PEER_MODES)
            for row in documents.peer_figures()
            if row["model"] == model and row["program"] == PEER_MODES[-1]]


def cases_of(bench, patterns, most_faces):
    """All cases, and the models that are left out with the reason.

    Models of the three groups take part where the judge finds them closed, oriented and manifold;
    models that the peer was measured on, at its counts, whatever they are.
    """
    folder = documents.models_folder()
    names = [f"{path.parent.name}/{path.name}" for group in GROUPS
             for path in sorted((folder / group).iterdir())]
    of_peers = {row["model"] for row in documents.peer_figures()}
    names += sorted(name for name in of_peers - set(names) if (folder / name).is_file())
    cases, left_out = [], {}
    for name in names:
        if patterns and not any(pattern in name for pattern in patterns):
            continue
        census = bench.census(name)
        peers = peer_rows(name)
        if most_faces and census["faces"] > most_faces:
            left_out[name] = f"{census['faces']} faces"
            continue
        if name.split("/")[0] in GROUPS and census["closed"] and census["sound"]:
            cases += [Case(name, size, round(share * census["vertices"]), census, None)
                      for size, share in SHARES.items()]
        elif not peers:
            left_out[name] = "not closed" if census["sound"] else "not an oriented manifold"
        cases += [Case(name, "peer", int(peer["vertices"]), census, peer) for peer in peers]
    return cases, left_out
