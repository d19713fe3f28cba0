"""Programs that measure a result against its input, and their figures under one set of names.

Figures, None where the judge does not know them:
  vertices, faces, components, genus, closed, sound   of the result; sound: an oriented manifold
  quads, quads_by_area       % of the faces and of their area
  rms, max                   distance, both ways, as a share of the diagonal of the input
  normals                    mean angle between the normals, degrees
  aligned                    % of edge length within 10 degrees of clear principal directions
  valence_4                  % of the inner vertices
  concave                    faces
  sharp_faces                faces whose smallest angle is below 10 degrees
  crossing_pairs, crossing_faces   of faces that pass through each other
"""

import json
import os
import pathlib
import sys
import tempfile

import documents


class Meter:
    """The independent meter, which shares no code with strake."""

    name = "the independent meter"

    def __init__(self, path):
        self.path = str(path.resolve())  # a name alone would be looked for on the PATH

    def census(self, mesh):
        """Counts and topology of a mesh, and the faces that pass through each other."""
        return self._figures(mesh, mesh, "--no-distance", "--self-intersections")

    def measure(self, reference, candidate):
        return self._figures(reference, candidate, "--alignment", "--self-intersections")

    def programs(self):
        return [self.path]

    def _figures(self, reference, candidate, *options):
        found = json.loads(documents.output_of(self.path, str(reference), str(candidate),
                                               "--threads", "1", *options))
        mesh, crossing = found["candidate"], found["self_intersections"]
        distance = found.get("distance", {})
        edges = found.get("alignment", {}).get("all_edges", {})
        return {
            "vertices": mesh["vertices"],
            "faces": mesh["faces"],
            "components": mesh["components"],
            "genus": mesh["genus"],
            "closed": mesh["closed"],
            "sound": mesh["manifold"] and mesh["consistently_oriented"],
            "quads": mesh["quad_percent"],
            "quads_by_area": mesh["quad_percent_by_area"],
            "rms": distance.get("rms"),
            "max": distance.get("hausdorff"),
            "normals": distance.get("normal_deg_mean"),
            "aligned": percent(edges.get("share_under_10_deg")),
            "valence_4": mesh["interior_valence_percent"]["of_4"],
            "concave": mesh["concave_faces"],
            "sharp_faces": mesh["angles_deg"]["faces_under_10"],
            "crossing_pairs": crossing["face_pairs"],
            "crossing_faces": crossing["faces_involved"],
        }


class Evaluate:
    """The project's own stage evaluate, where the meter is missing. Without a field of curvature it
    judges no alignment."""

    name = "strake-evaluate (without the independent meter)"

    def __init__(self):
        self.importer = documents.program("strake-import")
        self.evaluator = documents.program("strake-evaluate")

    def census(self, mesh):
        return self.measure(mesh, mesh)

    def measure(self, reference, candidate):
        with tempfile.TemporaryDirectory() as folder:
            mesh, report = f"{folder}/mesh.hdf", f"{folder}/report.json"
            documents.output_of(self.importer, str(reference), "-o", mesh, "--quiet")
            documents.output_of(self.evaluator, mesh, str(candidate), "-o", report, "--quiet",
                                "--threads", "1")
            found = json.loads(pathlib.Path(report).read_text(encoding="utf-8"))["result"]
        topology = found["topology"]["candidate"]
        return {
            "vertices": topology["vertices"],
            "faces": topology["faces"],
            "components": topology["components"],
            "genus": topology.get("genus"),
            "closed": topology["boundary_loops"] == 0,
            "sound": topology["oriented_manifold"],
            "quads": percent(found["faces"]["quad_share"]),
            "quads_by_area": percent(found["faces"]["quad_area_share"]),
            "rms": found["distance"]["rms_share"],
            "max": found["distance"]["max_share"],
            "normals": found["normals"]["mean_deg"],
            "aligned": None,
            "valence_4": percent(found["valence"]["share_4"]),
            "concave": found["faces"]["concave"],
            "sharp_faces": None,
            "crossing_pairs": found["shape"]["self_intersecting_pairs"],
            "crossing_faces": None,
        }

    def programs(self):
        return [self.importer, self.evaluator]


def percent(share):
    return None if share is None else 100 * share


def meter_path():
    """Where the independent meter is: $STRAKE_METER, else the one that scripts/build_meter builds."""
    default = documents.ROOT / "build" / "meter" / "meshmeter"
    return pathlib.Path(os.environ.get("STRAKE_METER") or default)


def meter():
    """The independent meter, or None."""
    return Meter(meter_path()) if meter_path().exists() else None


def add_arguments(parser):
    """The program to test, the test models and the meter, as arguments of a test."""
    parser.add_argument("--strake", required=True, help="the program to test")
    parser.add_argument("--models", type=pathlib.Path, default=documents.models_folder(),
                        help="default: $STRAKE_MODELS, else ../shared/models beside the source tree")
    parser.add_argument("--meter", type=pathlib.Path, default=meter_path(),
                        help="default: $STRAKE_METER, else what scripts/build_meter builds")


def check_arguments(arguments):
    """Ends a test whose models or meter are missing: a failure where CI is set, skipped (77) else."""
    missing = None
    if not (arguments.models / "MANIFEST.md").exists():
        missing = "there are no test models: set STRAKE_MODELS to their folder"
    elif not arguments.meter.exists():
        missing = "there is no meter: run scripts/build_meter, or set STRAKE_METER to it"
    if missing:
        print(f"{pathlib.Path(sys.argv[0]).stem}: {missing}", file=sys.stderr)
        sys.exit(1 if os.environ.get("CI") else 77)


def judge():
    """The independent meter where it is there, else the stage evaluate."""
    return meter() or Evaluate()
