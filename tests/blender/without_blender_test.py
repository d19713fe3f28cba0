"""What the add-on does with meshes of Blender 3 and 4, without Blender: without_blender_test.py ADD_ON."""

import importlib.util
import os
import pathlib
import sys
import tempfile
import types
import unittest
from unittest import mock

ADD_ON = sys.argv.pop(1)


def load_add_on():
    """The add-on beside modules that hold what it names while it is read."""
    bpy = types.ModuleType("bpy")
    kinds = ("PropertyGroup", "Operator", "Panel", "AddonPreferences")
    bpy.types = types.SimpleNamespace(**{kind: type(kind, (), {}) for kind in kinds})
    bpy.data = mock.MagicMock()
    bpy.props = types.ModuleType("bpy.props")
    for kind in ("Bool", "Enum", "Float", "Int", "String"):
        setattr(bpy.props, f"{kind}Property", mock.Mock())
    mathutils = types.ModuleType("mathutils")
    mathutils.Vector = tuple
    with mock.patch.dict(sys.modules, {"bpy": bpy, "bpy.props": bpy.props, "mathutils": mathutils}):
        spec = importlib.util.spec_from_file_location("strake_remesh", ADD_ON)
        add_on = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(add_on)
    return add_on


def edge(start, **marks):
    return types.SimpleNamespace(vertices=(start, start + 1), **{"use_edge_sharp": False, "use_seam": False, **marks})


class MarkedEdges(unittest.TestCase):
    def expect(self, mesh, wanted):
        with tempfile.TemporaryDirectory(prefix="strake-blender-") as folder:
            path = pathlib.Path(folder, "edges.txt")
            count = load_add_on().write_sharp_edges(mesh, path)
            self.assertEqual(path.read_text(encoding="ascii").split("\n")[:-1], wanted)
            self.assertEqual(count, len(wanted))

    def test_blender_3_has_creases_at_edges(self):
        edges = [edge(0, crease=0.0), edge(1, crease=1.0), edge(2, crease=0.0, use_seam=True)]
        self.expect(types.SimpleNamespace(edges=edges, attributes={}), ["1 2", "2 3"])

    def test_blender_4_has_creases_as_an_attribute(self):
        edges = [edge(0), edge(1), edge(2, use_edge_sharp=True)]
        layer = types.SimpleNamespace(data=[types.SimpleNamespace(value=value) for value in (0.0, 1.0, 0.2)])
        self.expect(types.SimpleNamespace(edges=edges, attributes={"crease_edge": layer}), ["1 2", "2 3"])

    def test_blender_4_without_creases_has_no_attribute(self):
        self.expect(types.SimpleNamespace(edges=[edge(0), edge(1, use_seam=True)], attributes={}), ["1 2"])


class Failures(unittest.TestCase):
    def test_nothing_is_left_behind(self):
        add_on = load_add_on()
        meshes = add_on.bpy.data.meshes
        context = mock.MagicMock()
        context.preferences.addons.get.return_value = None
        for program, polygons in (("no-such-program", [0]), (sys.executable, [])):
            meshes.reset_mock()
            meshes.new_from_object.return_value.polygons = polygons
            with mock.patch.dict(os.environ, STRAKE=program), self.assertRaises(add_on.Failure):
                add_on.Job(context, mock.MagicMock())
            self.assertEqual(meshes.remove.call_count, meshes.new_from_object.call_count)


unittest.main()
