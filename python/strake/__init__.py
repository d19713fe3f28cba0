"""Anisotropic quad-dominant remeshing along lines of curvature, on numpy arrays.

    import strake
    V, F = strake.remesh(vertices, faces, vertices_wanted=5000)

`remesh` runs the whole chain; `import_mesh`, `tensor`, `smooth`, `trace`, `mesh`, `fit`, `size`, `refine`,
`decimate` and `evaluate` are its stages. Options are keyword arguments with the names of the command line,
dashes written as underscores: `feature_angle=30`, `pure_quads=True`. Lengths are numbers in model
units, or text such as "0.1%", a share of the bounding-box diagonal. Two names differ, since results
have vertices and faces too: `vertices_wanted` and `faces_wanted`.

Every function takes `threads` (0: all processors; never changes a result) and `progress`, called as
progress(stage, phase, fraction) some times a second. Other Python threads go on meanwhile, and
Ctrl-C cancels. What goes wrong raises a subclass of `Error`.
"""

import operator as _operator
import warnings as _warnings

import numpy as _np

from . import _core
from ._core import (AlgorithmError, DensityField, EdgeList, Error, InputError, LineSet, Polygons,
                    PreconditionError, PrincipalField, QuadMesh, SizeField, TensorField,
                    ToleranceError, TriMesh, UsageError, __version__)

__all__ = [
    "AlgorithmError", "DensityField", "EdgeList", "Error", "Faces", "InputError", "LineSet",
    "Polygons", "PreconditionError", "PrincipalField", "QuadMesh", "Remeshed", "SizeField",
    "TensorField", "ToleranceError", "TriMesh", "UsageError", "decimate", "evaluate", "fit", "import_mesh",
    "line_points", "mesh", "polygons", "refine", "remesh", "size", "smooth", "tensor", "trace",
]

Error.__doc__ = "What goes wrong in strake; the message names a remedy."
UsageError.__doc__ = "An option is unknown, malformed or out of range, or an argument of a wrong kind."
InputError.__doc__ = "A mesh holds nothing usable, or an array is not as it should be."
PreconditionError.__doc__ = "Values are each sound but do not belong together."
AlgorithmError.__doc__ = "A result failed its own check, so it is not handed out."
ToleranceError.__doc__ = "A result is farther from its surface than was asked for."

_RENAMED = {"vertices_wanted": "vertices", "faces_wanted": "faces"}


class Faces:
    """Polygons: face f has the corners corners[offsets[f]:offsets[f + 1]], counter-clockwise.

    A sequence of arrays, one per face, of which a slice is a list; `quads` and `triangles` are plain arrays of those faces.
    """

    def __init__(self, offsets, corners):
        self.offsets = offsets
        self.corners = corners

    def __len__(self):
        return len(self.offsets) - 1

    def __getitem__(self, face):
        face = range(len(self))[face]
        if isinstance(face, range):
            return [self[one] for one in face]
        return self.corners[self.offsets[face]:self.offsets[face + 1]]

    def __repr__(self):
        sizes, counts = _np.unique(self.sizes, return_counts=True)
        kinds = ", ".join(f"{count} of {size} corners" for size, count in zip(sizes, counts))
        return f"<strake.Faces: {len(self)} faces ({kinds})>"

    @property
    def sizes(self):
        """[F] number of corners of each face."""
        return _np.diff(self.offsets)

    def of_size(self, size):
        """[N, size] all faces with so many corners."""
        first = self.offsets[:-1][self.sizes == size]
        return self.corners[first[:, None] + _np.arange(size)]

    @property
    def quads(self):
        """[Q, 4] the quads."""
        return self.of_size(4)

    @property
    def triangles(self):
        """[T, 3] the triangles."""
        return self.of_size(3)


def _faces(self):
    """The polygons as `Faces`."""
    return Faces(self.offsets, self.corners)


QuadMesh.faces = property(_faces)
Polygons.faces = property(_faces)


class Remeshed:
    """What `remesh` gives; unpacks as `V, F = result`."""

    def __init__(self, quad_mesh, mesh, field, reports, messages):
        self.quad_mesh = quad_mesh  #: QuadMesh: the result, and where its vertices lie on `mesh`
        self.mesh = mesh            #: TriMesh: the input as repaired
        self.field = field          #: PrincipalField: directions that edges follow
        self.reports = reports      #: dict by stage of dicts: counts and measures
        self.messages = messages    #: list of text: warnings, and how near a count came

    @property
    def vertices(self):
        """[V, 3]"""
        return self.quad_mesh.vertices

    @property
    def faces(self):
        """The polygons as `Faces`."""
        return self.quad_mesh.faces

    def __iter__(self):
        return iter((self.vertices, self.faces))

    def __repr__(self):
        return f"<strake.Remeshed: {len(self.vertices)} vertices, {len(self.faces)} faces>"


def _kind(argument, value, *kinds):
    """The value of an argument, which has to be one of these classes."""
    if not isinstance(value, kinds):
        wanted = " or ".join(kind.__name__ for kind in kinds)
        raise UsageError(f"{argument} is a {type(value).__name__}; give a {wanted}")
    return value


def _kind_or_none(argument, value, *kinds):
    return None if value is None else _kind(argument, value, *kinds)


def _array(argument, values):
    """An argument as an array, all of whose elements count."""
    if _np.ma.is_masked(values):
        raise InputError(f"{argument}: elements are masked; fill them, or leave them out")
    try:
        return _np.asarray(values)
    except (TypeError, ValueError) as error:
        raise UsageError(f"{argument}: no array can be made of this: {error}") from None


def _numbers(argument, values):
    """An argument as an array of floating-point numbers."""
    array = _array(argument, values)
    if array.dtype.kind not in "biuf":
        raise UsageError(f"{argument}: numbers are needed, not {array.dtype}")
    return array.astype(float, copy=False)


def _running(threads, progress):
    """How to run, as the core takes it."""
    most = 4096
    try:
        threads = _operator.index(threads)
    except TypeError:
        raise UsageError(f"threads is a {type(threads).__name__}; give an int") from None
    if not 0 <= threads <= most:
        raise UsageError(f"threads: {threads} is out of range, expected between 0 and {most}")
    if progress is not None and not callable(progress):
        raise UsageError(f"progress is a {type(progress).__name__}; give a function")
    return threads, progress


def _settings(options):
    """Options as the text of the command line, by its names."""
    def text(value):
        if isinstance(value, (bool, _np.bool_)):
            return "true" if value else "false"
        return str(value)
    return {_RENAMED.get(name, name).replace("_", "-"): text(value)
            for name, value in options.items() if value is not None}


def _offsets_and_corners(faces):
    """Faces given as an array, as `Faces`, as (offsets, corners) or as a list of lists."""
    if isinstance(faces, Faces):
        return faces.offsets, faces.corners
    if isinstance(faces, tuple) and len(faces) == 2 and _np.ndim(faces[0]) == 1:
        return faces
    if isinstance(faces, _np.ndarray) and faces.ndim == 2:
        return _np.arange(len(faces) + 1) * faces.shape[1], faces.reshape(-1)
    try:
        sizes = [len(face) for face in faces]
        corners = [corner for face in faces for corner in face]
    except TypeError:
        raise UsageError("faces are neither an array of two dimensions, nor (offsets, corners), nor a "
                         "list of lists") from None
    return _np.cumsum([0] + sizes), corners


def _whole(numbers, what):
    """Whole numbers as indices."""
    numbers = _array(what, numbers)
    if numbers.dtype.kind not in "biuf":
        raise UsageError(f"{what}: numbers are needed, not {numbers.dtype}")
    with _np.errstate(invalid="ignore"):
        indices = numbers.astype(_np.int32)
    if (indices != numbers).any():
        raise InputError(f"{what} are not all whole numbers from -2^31 to 2^31 - 1")
    return indices


def _numbered(labels):
    """Labels of faces as numbers, and what the numbers stand for where texts were given."""
    numbers, names = {}, {}
    for kind, values in _kind("labels", labels, dict).items():
        values = _array(f"labels '{_kind('a name of labels', kind, str)}'", values)
        if values.dtype.kind in "OSU":
            try:
                texts = values.astype(str)
            except UnicodeDecodeError as error:
                raise UsageError(f"labels '{kind}': some are no text: {error}") from None
            known, values = _np.unique(texts, return_inverse=True)
            names[kind] = known.tolist()
        numbers[kind] = _whole(values, f"labels '{kind}'")
    return numbers, names


def _colours(colours):
    """Colours as [V, 4] in [0, 1]."""
    numbers = _numbers("colours", colours)
    kind = _array("colours", colours).dtype
    if kind == _np.uint8:
        numbers = numbers / 255
    if not _np.isfinite(numbers).all():
        raise InputError("colours: some are no finite numbers")
    rounding = 1e-6
    if ((numbers < -rounding) | (numbers > 1 + rounding)).any():
        raise InputError("colours: numbers beyond 0 and 1; 0 to 255 are taken of uint8 alone")
    numbers = numbers.clip(0, 1)
    if numbers.ndim == 2 and numbers.shape[1] == 3:
        numbers = _np.hstack([numbers, _np.ones((len(numbers), 1))])
    return numbers


def polygons(vertices, faces, colours=None, texture=None, labels=None):
    """A polygon mesh from arrays.

    vertices: [V, 3]. faces: an array [F, 3] or [F, 4], `Faces`, (offsets, corners), or a list of
    lists, counter-clockwise. What comes along to the result, as far as it is given: colours, [V, 3] or
    [V, 4], floats in [0, 1] or integers up to 255; texture, [corners, 2] or [F, 3, 2], coordinates of every corner in the order
    of the faces, from those of vertices by uv[faces]; labels, dict of [F] integers or texts, such as
    the material of every face.
    """
    offsets, corners = (_whole(part, "faces") for part in _offsets_and_corners(faces))
    if colours is not None:
        colours = _colours(colours)
    if texture is not None:
        texture = _numbers("texture", texture)
        if not _np.isfinite(texture).all():
            raise InputError("texture: some coordinates are no finite numbers")
        if texture.ndim > 2:
            texture = texture.reshape(-1, texture.shape[-1])
    return _core.polygons(_numbers("vertices", vertices), offsets, corners, colours, texture, *_numbered(labels or {}))


def _edges(feature_edges):
    return None if feature_edges is None else _core.edge_list(_whole(feature_edges, "feature_edges"))


def _guides(guides):
    if guides is None:
        return None
    try:
        lines = list(guides)
    except TypeError:
        raise UsageError("guides are no list of arrays") from None
    return _core.guides([_numbers("guides", line) for line in lines])


def _density(density):
    if density is None:
        return None
    numbers = _numbers("density", density)
    if numbers.size == 0:
        raise InputError("density: there are no numbers; give one for every vertex, or None")
    return _core.density(numbers)


def remesh(vertices, faces, *, colours=None, texture=None, labels=None, feature_edges=None,
           guides=None, density=None, measure=True, threads=0, progress=None, **options):
    """Remeshes a surface with quads along its curvature. Gives a `Remeshed`: V, F = remesh(...).

    vertices, faces, colours, texture, labels: as for `polygons`. feature_edges: [N, 2] pairs of vertices
    whose edges are kept besides those that bend. guides: list of [N, 3] points of lines on or near
    the surface along which edges are to run. density: [V] positive, wanted vertices per area
    relative to what they would be without. measure: whether to measure the result
    (reports["evaluate"]).
    """
    soup = polygons(vertices, faces, colours, texture, labels)
    return Remeshed(*_core.remesh(soup, _edges(feature_edges), _guides(guides),
                                  _density(density),
                                  _settings(options), bool(measure), *_running(threads, progress)))


def _run(stage, inputs, options, threads, progress):
    """Runs a stage. Warnings of its report become Python's. Gives output and report."""
    given = {port: value for port, value in inputs.items() if value is not None}
    output, report, sentences = _core.run(stage, given, _settings(options),
                                          *_running(threads, progress))
    for sentence in sentences:
        _warnings.warn(f"{stage}: {sentence}", stacklevel=3)
    return output, report


def import_mesh(vertices, faces, *, colours=None, texture=None, labels=None, feature_edges=None,
                threads=0, progress=None, **options):
    """Turns polygons into a sound `TriMesh` with its feature graph; the start of all stages."""
    inputs = {"input": polygons(vertices, faces, colours, texture, labels),
              "feature-edges": _edges(feature_edges)}
    return _run("import", inputs, options, threads, progress)[0]


def tensor(mesh, *, threads=0, progress=None, **options):
    """Estimates the curvature tensor at every wedge of a TriMesh. Gives a `TensorField`."""
    return _run("tensor", {"mesh": _kind("mesh", mesh, TriMesh)}, options, threads, progress)[0]


def smooth(mesh, tensor, *, guides=None, threads=0, progress=None, **options):
    """Smooths curvature tensors and extracts principal frames. Gives a `PrincipalField`.

    guides: list of [N, 3] points of lines that edges are to follow.
    """
    inputs = {"mesh": _kind("mesh", mesh, TriMesh), "tensor": _kind("tensor", tensor, TensorField),
              "guides": _guides(guides)}
    return _run("smooth", inputs, options, threads, progress)[0]


def trace(mesh, field, *, size=None, density=None, threads=0, progress=None, **options):
    """Covers a TriMesh with lines of curvature, boundary and feature lines. Gives a `LineSet`.

    size: a SizeField to take instead of a tolerance. density: [vertices of the input], as for
    `remesh`.
    """
    inputs = {"mesh": _kind("mesh", mesh, TriMesh), "field": _kind("field", field, PrincipalField),
              "size": _kind_or_none("size", size, SizeField), "density": _density(density)}
    return _run("trace", inputs, options, threads, progress)[0]


def line_points(mesh, lines):
    """[P, 3] the points of lines, in coordinates of the input."""
    return _core.line_points(_kind("mesh", mesh, TriMesh), _kind("lines", lines, LineSet))


def mesh(mesh, lines, *, threads=0, progress=None, **options):
    """Builds the polygons between lines. Gives a `QuadMesh`."""
    inputs = {"mesh": _kind("mesh", mesh, TriMesh), "lines": _kind("lines", lines, LineSet)}
    return _run("mesh", inputs, options, threads, progress)[0]


def fit(mesh, quads, *, field=None, threads=0, progress=None, **options):
    """Moves vertices of a QuadMesh so that its faces lie nearer to the TriMesh."""
    inputs = {"mesh": _kind("mesh", mesh, TriMesh), "quads": _kind("quads", quads, QuadMesh),
              "field": _kind_or_none("field", field, PrincipalField)}
    return _run("fit", inputs, options, threads, progress)[0]


def size(mesh, field, lines, quads, *, density=None, threads=0, progress=None, **options):
    """Wanted distances of lines that even out the errors of a QuadMesh. Gives a `SizeField`."""
    inputs = {"mesh": _kind("mesh", mesh, TriMesh), "field": _kind("field", field, PrincipalField),
              "lines": _kind("lines", lines, LineSet), "fitted": _kind("quads", quads, QuadMesh),
              "density": _density(density)}
    return _run("size", inputs, options, threads, progress)[0]


def refine(mesh, quads, *, threads=0, progress=None, **options):
    """Divides cells of a QuadMesh that are too far from the TriMesh."""
    inputs = {"mesh": _kind("mesh", mesh, TriMesh), "fitted": _kind("quads", quads, QuadMesh)}
    return _run("refine", inputs, options, threads, progress)[0]


def decimate(mesh, *, threads=0, progress=None, **options):
    """Makes a QuadMesh of few vertices by decimating a TriMesh, where lines would be too coarse."""
    return _run("decimate", {"mesh": _kind("mesh", mesh, TriMesh)}, options, threads, progress)[0]


def evaluate(mesh, candidate, *, field=None, threads=0, progress=None, **options):
    """Measures a QuadMesh, or any `polygons`, against a TriMesh. Gives a dict by dotted key."""
    if isinstance(_kind("candidate", candidate, QuadMesh, Polygons), QuadMesh):
        candidate = _core.polygons_of(candidate)
    inputs = {"mesh": _kind("mesh", mesh, TriMesh), "candidate": candidate,
              "field": _kind_or_none("field", field, PrincipalField)}
    return _run("evaluate", inputs, options, threads, progress)[1]


def _describe(function, declared):
    """Adds the declared options to a docstring."""
    lines = []
    for option in declared:
        name = {old: new for new, old in _RENAMED.items()}.get(option["name"], option["name"])
        unit = f" ({option['unit']})" if option["unit"] else ""
        default = f" Default: {option['default']}." if option["default"] else ""
        lines.append(f"    {name.replace('-', '_')}{unit}: {option['help']}{default}")
    if lines:
        function.__doc__ = function.__doc__.rstrip() + "\n\n    Options:\n\n" + "\n".join(lines) + "\n"


_describe(remesh, _core.remesh_options())
_describe(import_mesh, _core.stage_options("import"))
for _function in (tensor, smooth, trace, mesh, fit, size, refine, decimate, evaluate):
    _describe(_function, _core.stage_options(_function.__name__))
