"""The goals, and the tables of the quality bench."""

import csv
import io
import statistics
from dataclasses import dataclass

COLUMNS = [
    "model", "size", "input_vertices", "input_crossing_pairs", "wanted", "vertices", "faces",
    "quads", "quads_by_area", "rms", "max", "aligned", "valence_4", "t_joints", "crossing_pairs",
    "concave", "open_faces", "quadrics_rms", "quadrics_max", "lindstrom-turk_rms",
    "lindstrom-turk_max", "rms_to_quadrics", "max_to_quadrics", "rms_to_lindstrom-turk",
    "max_to_lindstrom-turk", "peer_vertices", "rms_to_peer", "max_to_peer", "seconds", "fault",
]
WORST = 4


@dataclass(frozen=True)
class Goal:
    """A limit on a figure: of its median, or of every case, over the cases of some groups."""

    title: str
    figure: str
    limit: float
    least: bool = False  # the figure shall be at least the limit, not at most
    median: bool = False
    groups: tuple = ()  # empty: all
    digits: int = 2

    def values(self, rows):
        return [(row[self.figure], row) for row in rows if row.get(self.figure) is not None
                and (not self.groups or row["model"].split("/")[0] in self.groups)]

    def holds(self, value):
        return value >= self.limit if self.least else value <= self.limit


SCANS, PARTS = ("scan", "genus"), ("cad",)
GOALS = [
    Goal("RMS / Instant Meshes, median", "rms_to_peer", 0.5, median=True),
    Goal("RMS / Instant Meshes, every case", "rms_to_peer", 0.8),
    Goal("max / Instant Meshes, median", "max_to_peer", 0.5, median=True),
    Goal("RMS / quadric decimation, median", "rms_to_quadrics", 1.5, median=True),
    Goal("the same, scans", "rms_to_quadrics", 1.5, median=True, groups=SCANS),
    Goal("the same, parts", "rms_to_quadrics", 1.5, median=True, groups=PARTS),
    Goal("quads, % of faces, scans", "quads", 95, True, groups=SCANS, digits=1),
    Goal("quads, % of area, scans", "quads_by_area", 95, True, groups=SCANS, digits=1),
    Goal("quads, % of faces, parts", "quads", 92, True, groups=PARTS, digits=1),
    Goal("quads, % of area, parts", "quads_by_area", 92, True, groups=PARTS, digits=1),
    Goal("inner vertices of valence 4, %", "valence_4", 90, True, digits=1),
    Goal("T-joints, % of vertices", "t_joints", 3, digits=1),
    Goal("pairs of crossing faces", "crossing_pairs", 0, digits=0),
    Goal("faces with all angles above 10°, %", "open_faces", 99.5, True, digits=2),
    Goal("edges within 10°, %, scans", "aligned", 80, True, groups=SCANS, digits=0),
    Goal("edges within 10°, %, parts", "aligned", 90, True, groups=PARTS, digits=0),
]


def number(value, digits):
    if value is None:
        return ""
    return ">999" if value > 999 and digits else f"{value:.{digits}f}"


def goal_table(rows):
    lines = ["| goal | limit | median | met | worst |", "|---|---|---|---|---|"]
    for goal in GOALS:
        values = sorted(goal.values(rows), key=lambda pair: (pair[0] if goal.least else -pair[0],
                                                             pair[1]["model"], pair[1]["wanted"]))
        if not values:
            continue
        middle = statistics.median(value for value, _ in values)
        good = sum(goal.holds(value) for value, _ in values)
        met = ("yes" if goal.holds(middle) else "no") if goal.median else \
            f"{good} of {len(values)} cases"
        worst = "; ".join(f"{row['model'].split('/')[1]} {row['wanted']}: "
                          f"{number(value, goal.digits)}" for value, row in values[:WORST])
        sign = "≥" if goal.least else "≤"
        lines.append(f"| {goal.title} | {sign} {goal.limit:g} | {number(middle, goal.digits)} "
                     f"| {met} | {worst} |")
    return "\n".join(lines) + "\n"


# Heading, column, factor, digits.
SHOWN = [
    ("V", "vertices", 1, 0), ("quads %", "quads", 1, 1), ("by area", "quads_by_area", 1, 1),
    ("RMS 1e-4", "rms", 1e4, 2), ("max 1e-3", "max", 1e3, 2),
    ("RMS / quadrics", "rms_to_quadrics", 1, 2), ("/ L-T", "rms_to_lindstrom-turk", 1, 2),
    ("/ IM", "rms_to_peer", 1, 2), ("max / IM", "max_to_peer", 1, 2), ("<10° %", "aligned", 1, 0),
    ("val. 4 %", "valence_4", 1, 1), ("T %", "t_joints", 1, 1),
    ("crossing", "crossing_pairs", 1, 0), (">10° %", "open_faces", 1, 2),
    ("s", "seconds", 1, 1),
]


def cells(row):
    return [number(None if row.get(name) is None else factor * row[name], digits)
            for _, name, factor, digits in SHOWN]


def case_table(rows):
    headings = ["model", "size", *(heading for heading, *_ in SHOWN)]
    lines = ["| " + " | ".join(headings) + " |", "|---" * len(headings) + "|"]
    for row in rows:
        lines.append(f"| {row['model']} | {row['size']} | {' | '.join(cells(row))} |")
    for group in dict.fromkeys(row["model"].split("/")[0] for row in rows):
        for size in dict.fromkeys(row["size"] for row in rows):
            chosen = [row for row in rows
                      if row["model"].startswith(group + "/") and row["size"] == size]
            lines += [f"| **median of {group}** | {size} | {' | '.join(cells(medians(chosen)))} |"
                      ] if chosen else []
    faults = [f"- {row['model']}, {row['wanted']} vertices: {row['fault']}"
              for row in rows if row["fault"]]
    return "\n".join(lines) + "\n" + ("\nFaults:\n\n" + "\n".join(faults) + "\n" if faults else "")


def medians(rows):
    found = {}
    for _, name, *_ in SHOWN:
        values = [row[name] for row in rows if row.get(name) is not None]
        found[name] = statistics.median(values) if values else None
    return found


def csv_text(rows):
    text = io.StringIO()
    writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
    writer.writeheader()
    for row in rows:
        writer.writerow({name: format(row[name], ".6g") if isinstance(row.get(name), float)
                         else row.get(name) for name in COLUMNS})
    return text.getvalue()
