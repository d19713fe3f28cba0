"""Pictures of the bench: input and result side by side."""

import csv
import pathlib

import documents

VIEWS = pathlib.Path(__file__).with_name("views.csv")
SIZE = "340x280"


def draw(bench, chosen, folder):
    """Draws the cases of views.csv that were chosen; returns the table that shows them."""
    folder.mkdir(parents=True, exist_ok=True)
    with open(VIEWS, encoding="utf-8", newline="") as file:
        views = {(view["model"], view["size"]): view for view in csv.DictReader(file)}
    lines = ["| input | result |", "|---|---|"]
    for case in chosen:
        view = views.get((case.model, case.size))
        if view is None:
            continue
        run, mesh = bench.remesh(case)
        if run["code"] != 0:
            continue
        stem = pathlib.Path(case.model).stem
        cells = []
        for name, file in (("input", bench.reference(case.model)), ("result", mesh)):
            picture = folder / f"{stem}-{name}.png"
            documents.output_of(documents.program("strake-render"), str(file), "-o", str(picture),
                                "--size", SIZE, "--azimuth", view["azimuth"], "--elevation",
                                view["elevation"], "--up", view["up"], "--edges",
                                "--edge-width", "0.8")
            cells.append(f"![{stem}, {name}](images/bench/{picture.name})")
        lines.append(f"| {cells[0]} | {cells[1]} |")
        lines.append(f"| {stem}: {case.input['vertices']} vertices | {case.wanted} wanted |")
    return "\n".join(lines) + "\n"
