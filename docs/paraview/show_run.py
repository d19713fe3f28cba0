"""Shows a run of strake in ParaView: pvpython show_run.py FOLDER PICTURES

FOLDER is what `strake remesh --keep FOLDER` leaves. Each step of docs/paraview.md becomes a picture in PICTURES, and
all of them together a state that ParaView opens, PICTURES/run.pvsm. Says of each file what it holds.
"""

import pathlib
import sys

from paraview import simple as pv

SIZE = [640, 450]
# Of lines, by the cell array `family`: minimum, maximum, boundary, feature.
FAMILIES = {0: [0.17, 0.44, 0.88], 1: [0.85, 0.21, 0.24], 2: [0.06, 0.62, 0.46], 3: [0.54, 0.31, 0.82]}


def opened(path):
    """The data of an artifact; ParaView chooses its reader by the file's ending."""
    source = pv.OpenDataFile(str(path))
    if source is None:
        sys.exit(f"show_run: ParaView does not open {path}")
    source.UpdatePipeline()
    facts = source.GetDataInformation()
    arrays = sorted(array.GetName() for array in [*source.PointData, *source.CellData])
    print(f"{path.name}: {facts.GetNumberOfCells()} cells, {facts.GetNumberOfPoints()} points, {' '.join(arrays)}")
    return source


def diagonal(source):
    low_x, high_x, low_y, high_y, low_z, high_z = source.GetDataInformation().GetBounds()
    return ((high_x - low_x) ** 2 + (high_y - low_y) ** 2 + (high_z - low_z) ** 2) ** 0.5


def plain(source, view):
    shown = pv.Show(source, view)
    shown.ColorArrayName = [None, ""]
    shown.DiffuseColor = [0.85, 0.86, 0.88]
    return shown


def curvature(folder, view):
    """field.hdf by k_max, the ends of the scale where sharp bends do not outshine the rest."""
    field = opened(folder / "field.hdf")
    shown = pv.Show(field, view)
    pv.ColorBy(shown, ("POINTS", "k_max"))
    end = 20 / diagonal(field)
    colours = pv.GetColorTransferFunction("k_max")
    colours.ApplyPreset("Cool to Warm", True)
    colours.RescaleTransferFunction(-end, end)
    shown.SetScalarBarVisibility(view, True)
    bar = pv.GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle, bar.TitleColor, bar.LabelColor = "k_max", "", [0, 0, 0], [0, 0, 0]
    bar.WindowLocation = "Lower Left Corner"


def directions(folder, view):
    """field.hdf with a short line along t_min at some of its points."""
    field = opened(folder / "field.hdf")
    plain(field, view)
    glyphs = pv.Glyph(Input=field, GlyphType="Line", OrientationArray=["POINTS", "t_min"], ScaleArray=["POINTS", "No scale array"],
                      ScaleFactor=0.015 * diagonal(field), GlyphMode="Uniform Spatial Distribution (Bounds Based)",
                      MaximumNumberOfSamplePoints=5000)
    shown = pv.Show(glyphs, view)
    shown.ColorArrayName = [None, ""]
    shown.AmbientColor = shown.DiffuseColor = FAMILIES[0]
    shown.LineWidth = 2


def tensors(folder, view):
    """tensor.hdf with the curvature tensor as an ellipsoid at some of its points."""
    tensor = opened(folder / "tensor.hdf")
    plain(tensor, view)
    some = pv.MaskPoints(Input=tensor, OnRatio=15, GenerateVertices=1, SingleVertexPerCell=1)
    glyphs = pv.TensorGlyph(Input=some, GlyphType="Sphere", Tensors=["POINTS", "tensor"])
    glyphs.ExtractEigenvalues = 1
    glyphs.ColorGlyphs = 0
    glyphs.ScaleFactor = 0.003 * diagonal(tensor) ** 2
    glyphs.LimitScalingByEigenvalues = 1
    glyphs.MaxScaleFactor = 0.03 * diagonal(tensor)
    shown = pv.Show(glyphs, view)
    shown.ColorArrayName = [None, ""]
    shown.DiffuseColor = [0.88, 0.63, 0.0]


def lines(folder, view):
    """mesh.hdf with lines.hdf as tubes, a colour per family."""
    plain(opened(folder / "mesh.hdf"), view)
    line_set = opened(folder / "lines.hdf")
    for family, colour in FAMILIES.items():
        some = pv.Threshold(Input=line_set, Scalars=["CELLS", "family"], LowerThreshold=family, UpperThreshold=family,
                            ThresholdMethod="Between")
        some.UpdatePipeline()
        if some.GetDataInformation().GetNumberOfCells() == 0:
            continue
        surface = pv.ExtractSurface(Input=some)
        shown = pv.Show(pv.Tube(Input=surface, Radius=0.0015 * diagonal(line_set)), view)
        shown.ColorArrayName = [None, ""]
        shown.DiffuseColor = colour


def result(folder, view):
    """The last result, with its edges."""
    last = next(path for path in (folder / name for name in ("refined.hdf", "fitted.hdf", "quads.hdf")) if path.exists())
    shown = plain(opened(last), view)
    shown.Representation = "Surface With Edges"
    shown.EdgeColor = [0.15, 0.16, 0.2]


def main():
    if len(sys.argv) != 3:
        sys.exit("usage: pvpython show_run.py FOLDER PICTURES")
    folder, pictures = map(pathlib.Path, sys.argv[1:])
    pictures.mkdir(parents=True, exist_ok=True)
    for step in (curvature, directions, tensors, lines, result):
        view = pv.CreateRenderView(ViewSize=SIZE, UseColorPaletteForBackground=0, Background=[1, 1, 1])
        view.OrientationAxesVisibility = 0
        step(folder, view)
        camera = view.GetActiveCamera()
        camera.SetPosition(1, -1.6, 1.1)
        camera.SetFocalPoint(0, 0, 0)
        camera.SetViewUp(0, 0, 1)
        view.ResetCamera()
        camera.Zoom(1.15)
        pv.SaveScreenshot(str(pictures / f"{step.__name__}.png"), view, ImageResolution=SIZE)
    pv.SaveState(str(pictures / "run.pvsm"))


main()
