"""The Python module on numpy arrays. Run with build/python in PYTHONPATH."""

import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings

import numpy as np

import strake

BIN = pathlib.Path(os.environ["STRAKE_BIN"])
ROOT = pathlib.Path(__file__).parents[2]


def torus(columns=96, rows=48):
    """Vertices and triangles of a torus with radii 1 and 0.4."""
    u, v = np.meshgrid(2 * np.pi * np.arange(columns) / columns,
                       2 * np.pi * np.arange(rows) / rows, indexing="ij")
    r = 1 + 0.4 * np.cos(v)
    vertices = np.stack([r * np.cos(u), r * np.sin(u), 0.4 * np.sin(v)], axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(columns), np.arange(rows), indexing="ij")
    def at(i, j):
        return (i % columns * rows + j % rows).ravel()
    a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
    return vertices, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def distance(points):
    """Distance of points from that torus."""
    return np.abs(np.hypot(np.hypot(points[:, 0], points[:, 1]) - 1, points[:, 2]) - 0.4)


class Remesh(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.result = strake.remesh(*torus(), vertices_wanted=600)

    def test_gives_vertices_and_faces(self):
        vertices, faces = self.result
        self.assertLessEqual(abs(len(vertices) - 600), 30)
        self.assertLess(distance(vertices).max(), 0.02)
        # Each face from its offsets; a torus has V - E + F = 0, and two corners an edge.
        self.assertEqual(2 * (len(vertices) + len(faces)), len(faces.corners))
        self.assertEqual([list(face) for face in faces][3], list(faces[3]))
        self.assertEqual(len(faces[-1]), faces.sizes[-1])
        self.assertEqual([list(face) for face in faces[2:5]], [list(faces[f]) for f in (2, 3, 4)])
        self.assertEqual(faces.quads.shape, (np.count_nonzero(faces.sizes == 4), 4))
        self.assertGreater(len(faces.quads), 0.9 * len(faces))
        np.testing.assert_array_equal(faces.quads[0], next(f for f in faces if len(f) == 4))
        with self.assertRaises(IndexError):
            faces[len(faces)]

    def test_measures_and_explains(self):
        measures = self.result.reports["evaluate"]
        self.assertTrue(measures["topology.candidate.oriented_manifold"])
        self.assertIn("600 wanted", " ".join(self.result.messages))

    def test_result_lies_on_the_mesh_it_names(self):
        quads, mesh = self.result.quad_mesh, self.result.mesh
        self.assertEqual(quads.mesh_id, mesh.id)
        corners = mesh.positions[mesh.faces[quads.foot_face]]
        feet = np.einsum("vc,vcx->vx", quads.foot_barycentric, corners) + mesh.origin
        self.assertLess(np.linalg.norm(feet - quads.vertices, axis=1).max(), 0.05)

    def test_is_what_the_program_makes(self):
        vertices, faces = torus()
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "torus.obj"
            path.write_text("".join("v %r %r %r\n" % tuple(p) for p in vertices.tolist()) +
                            "".join("f %d %d %d\n" % tuple(f + 1) for f in faces))
            out = path.with_name("quads.obj")
            subprocess.run([BIN / "strake", "remesh", path, "-o", out, "--vertices", "600", "-q"],
                           check=True)
            written = np.array([line.split()[1:] for line in out.read_text().splitlines()
                                if line.startswith("v ")], dtype=float)
        np.testing.assert_array_equal(written, self.result.vertices)

    def test_any_number_of_threads_gives_the_same(self):
        one = strake.remesh(*torus(), vertices_wanted=600, threads=1)
        np.testing.assert_array_equal(one.vertices, self.result.vertices)
        np.testing.assert_array_equal(one.faces.corners, self.result.faces.corners)

    def test_arrays_outlive_their_owner_and_are_read_only(self):
        positions = strake.import_mesh(*torus(12, 8)).positions
        self.assertAlmostEqual(np.abs(positions).max(), 1.4)
        with self.assertRaises(ValueError):
            positions[0] = 0


class Stages(unittest.TestCase):
    def test_one_by_one(self):
        mesh = strake.import_mesh(*torus())
        self.assertEqual(mesh.faces.shape, (2 * 96 * 48, 3))
        tensor = strake.tensor(mesh, radius="2%")
        field = strake.smooth(mesh, tensor)
        # Of a torus one principal curvature is 1 / 0.4 everywhere.
        np.testing.assert_allclose(np.median(field.k_max), 2.5, rtol=0.05)
        np.testing.assert_allclose(np.linalg.norm(field.t_min, axis=1), 1)
        lines = strake.trace(mesh, field, vertices_wanted=600)
        points = strake.line_points(mesh, lines)
        self.assertEqual(len(points), lines.offsets[-1])
        self.assertLess(distance(points).max(), 0.01)
        quads = strake.mesh(mesh, lines)
        fitted = strake.fit(mesh, quads, field=field)
        self.assertLess(distance(fitted.vertices).mean(), 2 * distance(quads.vertices).mean() + 0.01)
        sizes = strake.size(mesh, field, lines, fitted)
        self.assertEqual(sizes.along.shape, mesh.wedge_vertex.shape)
        self.assertTrue((sizes.along > 0).all())
        refined = strake.refine(mesh, fitted, refine_vertices=len(fitted.vertices) + 100)
        self.assertGreater(len(refined.vertices), len(fitted.vertices))
        before, after = (strake.evaluate(mesh, each, field=field, samples=20000)
                         for each in (quads, fitted))
        self.assertLess(after["distance.to_reference.rms_share"],
                        before["distance.to_reference.rms_share"])

    def test_ways_to_give_faces(self):
        box = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
        quads = np.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2],
                          [1, 3, 7, 5]])
        meshes = [strake.import_mesh(box, faces, longest_edge="100%") for faces in (
            quads, quads.tolist(), (np.arange(7) * 4, quads.ravel()),
            strake.Faces(np.arange(7) * 4, quads.ravel()))]
        self.assertEqual(len({mesh.id for mesh in meshes}), 1)
        self.assertEqual(meshes[0].faces.shape, (12, 3))
        # All twelve edges of a box bend by 90 degrees; without them there are no feature edges.
        self.assertEqual(meshes[0].is_feature.sum(), 2 * 12)
        smooth = strake.import_mesh(box, quads, feature_angle=180)
        self.assertEqual(smooth.is_feature.sum(), 0)
        listed = strake.import_mesh(box, quads, feature_angle=180, feature_edges=[[0, 1]],
                                    longest_edge="100%")
        self.assertEqual(listed.is_feature.sum(), 2)

    def test_edges_run_along_guides(self):
        flat = np.array([[x, y, 0] for x in range(11) for y in range(11)], dtype=float)
        a = (np.arange(10)[:, None] * 11 + np.arange(10)).ravel()
        quads = np.stack([a, a + 11, a + 12, a + 1], axis=1)
        diagonal = np.array([[2, 2, 0], [8, 8, 0]], dtype=float)
        mesh = strake.import_mesh(flat, quads)
        tensor = strake.tensor(mesh)
        field = strake.smooth(mesh, tensor, guides=[diagonal], guide_reach=10.0)
        place = mesh.positions[mesh.wedge_vertex] + mesh.origin
        on_guide = (np.abs(place[:, 0] - place[:, 1]) < 0.1) & (np.abs(place[:, 0] - 5) < 2)
        turn = np.abs(field.cross[on_guide] @ [1, 1, 0]) / np.sqrt(2)
        # One of the four arms lies along the guide: its cosine is near 1 or 0.
        self.assertGreater(np.count_nonzero(on_guide), 2)
        self.assertTrue(((turn > 0.99) | (turn < 0.1)).all(), turn)

    def test_colours_and_labels_are_carried(self):
        vertices, faces = torus(48, 24)
        colours = np.stack([vertices[:, 0] > 0, vertices[:, 0] <= 0, vertices[:, 0] * 0], axis=1)
        labels = {"material": (vertices[faces[:, 0], 0] > 0).astype(int) + 3}
        result = strake.remesh(vertices, faces, colours=colours, labels=labels, measure=False)
        red = result.quad_mesh.colours[:, 0]
        right = result.vertices[:, 0] > 0.2  # an edge of the input, over which colours blend
        self.assertGreater(red[right].min(), 0.9)
        self.assertEqual(set(result.quad_mesh.labels["material"]), {3, 4})
        self.assertEqual(result.quad_mesh.label_names, {})
        # The mesh after import has them too, and so has what single stages make of it.
        mesh = strake.import_mesh(vertices, faces, colours=colours, labels=labels,
                                  longest_edge="100%")
        np.testing.assert_array_equal(mesh.colours[:, :3], colours[mesh.source_vertex])
        field = strake.smooth(mesh, strake.tensor(mesh))
        quads = strake.mesh(mesh, strake.trace(mesh, field, vertices_wanted=300))
        self.assertEqual(len(quads.colours), len(quads.vertices))

    def test_names_of_labels_and_texture_coordinates_are_carried(self):
        # A sheet whose texture coordinates are its first two coordinates; seams nowhere.
        x, y = np.meshgrid(np.linspace(0, 2, 41), np.linspace(0, 1, 21), indexing="ij")
        vertices = np.stack([x, y, 0.2 * np.sin(3 * x)], axis=-1).reshape(-1, 3)
        a = (np.arange(40)[:, None] * 21 + np.arange(20)).ravel()
        quads = np.stack([a, a + 21, a + 22, a + 1], axis=1)
        texture = vertices[quads][:, :, :2] / 2
        names = np.where(vertices[quads].mean(axis=1)[:, 0] < 1, "left", "right")
        result = strake.remesh(vertices, quads, texture=texture, labels={"usemtl": names},
                               vertices_wanted=300, measure=False).quad_mesh
        self.assertEqual(result.texture.shape, (len(result.corners), 2))
        # Linear in the position but for how far vertices lie off the sheet.
        np.testing.assert_allclose(result.texture, result.vertices[result.corners][:, :2] / 2, atol=0.01)
        self.assertEqual(result.label_names, {"usemtl": ["left", "right"]})
        middles = np.array([result.vertices[face].mean(axis=0) for face in result.faces])
        clear = np.abs(middles[:, 0] - 1) > 0.15
        np.testing.assert_array_equal(result.labels["usemtl"][clear], (middles[clear, 0] > 1))
        with self.assertRaisesRegex(strake.InputError, "every corner"):
            strake.polygons(vertices, quads, texture=texture[1:])
        with self.assertRaisesRegex(strake.InputError, "2 columns"):
            strake.polygons(vertices, quads, texture=np.zeros((quads.size, 3)))


class Errors(unittest.TestCase):
    def raises(self, kind, part, work):
        with self.assertRaises(kind) as caught:
            work()
        self.assertIsInstance(caught.exception, strake.Error)
        self.assertIn(part, str(caught.exception))

    def test_have_the_message_of_the_program(self):
        vertices, faces = torus(12, 6)
        said = subprocess.run([BIN / "strake", "remesh", "a.obj", "-o", "b.obj", "--feature-angle",
                               "400"], capture_output=True, text=True).stderr
        with self.assertRaises(strake.UsageError) as caught:
            strake.remesh(vertices, faces, feature_angle=400)
        self.assertIn(str(caught.exception), said)

    def test_kinds(self):
        vertices, faces = torus(12, 6)
        self.raises(strake.UsageError, "feature-angel",
                    lambda: strake.remesh(vertices, faces, feature_angel=3))
        self.raises(strake.UsageError, "exclude each other",
                    lambda: strake.remesh(vertices, faces, tolerance="1%", vertices_wanted=9))
        self.raises(strake.InputError, "no usable face",
                    lambda: strake.remesh(vertices, np.zeros((0, 3), int)))
        self.raises(strake.InputError, "3 columns", lambda: strake.remesh(vertices[:, :2], faces))
        self.raises(strake.InputError, "offsets",
                    lambda: strake.remesh(vertices, (np.array([0, 9]), np.array([0, 1, 2]))))
        for wrong in (faces + 2**32, faces + 0.5, faces.astype(np.uint64) + np.uint64(2**63)):
            self.raises(strake.InputError, "faces are not all whole numbers",
                        lambda: strake.import_mesh(vertices, wrong))
        self.raises(strake.InputError, "feature_edges are not all whole numbers",
                    lambda: strake.import_mesh(vertices, faces, feature_edges=[[0, 2**32 + 1]]))
        strake.import_mesh(vertices, faces.astype(float))
        self.raises(strake.InputError, "no positive number",
                    lambda: strake.remesh(vertices, faces, density=0 * vertices[:, 0]))
        self.raises(strake.InputError, "density: there are no numbers",
                    lambda: strake.remesh(vertices, faces, density=[]))
        self.raises(strake.InputError, "texture: some coordinates",
                    lambda: strake.polygons(vertices, faces, texture=np.full((faces.size, 2), np.nan)))
        one, other = strake.import_mesh(vertices, faces), strake.import_mesh(2 * vertices, faces)
        self.raises(strake.PreconditionError, "another mesh",
                    lambda: strake.smooth(one, strake.tensor(other)))
        self.assertTrue(issubclass(strake.InputError, ValueError))

    def test_wrong_kinds_name_the_argument(self):
        vertices, faces = torus(24, 12)
        mesh = strake.import_mesh(vertices, faces)
        tensor = strake.tensor(mesh)
        field = strake.smooth(mesh, tensor)
        lines = strake.trace(mesh, field, vertices_wanted=100)
        quads = strake.mesh(mesh, lines)
        for part, work in (
                ("mesh is a TensorField; give a TriMesh", lambda: strake.smooth(tensor, mesh)),
                ("tensor is a NoneType", lambda: strake.smooth(mesh, None)),
                ("candidate is a LineSet", lambda: strake.evaluate(mesh, lines)),
                ("lines is a QuadMesh", lambda: strake.size(mesh, field, quads, lines)),
                ("quads is a LineSet", lambda: strake.size(mesh, field, lines, lines)),
                ("quads is a TriMesh", lambda: strake.refine(mesh, mesh)),
                ("field is a TensorField", lambda: strake.fit(mesh, quads, field=tensor)),
                ("field is a LineSet", lambda: strake.evaluate(mesh, quads, field=lines)),
                ("size is a float", lambda: strake.trace(mesh, field, size=0.1)),
                ("mesh is a ndarray", lambda: strake.tensor(vertices)),
                ("lines is a TriMesh", lambda: strake.line_points(mesh, mesh)),
                ("labels is a list", lambda: strake.polygons(vertices, faces, labels=[1])),
                ("a name of labels is a int",
                 lambda: strake.polygons(vertices, faces, labels={3: [0] * len(faces)})),
                ("labels 'm': some are no text",
                 lambda: strake.polygons(vertices, faces, labels={"m": np.array([b"\xff"] * len(faces))})),
                ("faces are neither", lambda: strake.polygons(vertices, 7)),
                ("faces: numbers", lambda: strake.polygons(vertices, faces.astype(str))),
                ("vertices: numbers", lambda: strake.polygons("none", faces)),
                ("vertices: no array", lambda: strake.polygons([[0, 0, 0], [1, 0]], faces)),
                ("guides are no list", lambda: strake.smooth(mesh, tensor, guides=3)),
                ("density: numbers", lambda: strake.trace(mesh, field, density="much")),
                ("threads: -5", lambda: strake.tensor(mesh, threads=-5)),
                ("threads is a float", lambda: strake.remesh(vertices, faces, threads=1.5)),
                ("progress is a int", lambda: strake.tensor(mesh, progress=1))):
            self.raises(strake.UsageError, part, work)

    def test_masked_elements_are_refused(self):
        vertices, faces = torus(24, 12)
        hidden = np.ma.array(vertices, mask=vertices > 1)
        self.raises(strake.InputError, "vertices: elements are masked",
                    lambda: strake.polygons(hidden, faces))
        self.raises(strake.InputError, "faces: elements are masked",
                    lambda: strake.polygons(vertices, np.ma.array(faces, mask=faces == 3)))
        names = np.ma.array(["a"] * len(faces), mask=[True] + [False] * (len(faces) - 1))
        self.raises(strake.InputError, "labels 'm': elements are masked",
                    lambda: strake.polygons(vertices, faces, labels={"m": names}))
        nothing_hidden = strake.polygons(np.ma.array(vertices), faces)
        np.testing.assert_array_equal(nothing_hidden.vertices, vertices)

    def test_colours_are_shares_or_bytes(self):
        vertices, faces = torus(24, 12)
        shades = np.arange(3 * len(vertices)).reshape(-1, 3) % 256
        given = strake.polygons(vertices, faces, colours=shades.astype(np.uint8)).colours
        np.testing.assert_array_equal(given[:, :3], shades / 255)
        np.testing.assert_array_equal(given[:, 3], 1)
        red = strake.polygons(vertices, faces, colours=[[1, 0, 0]] * len(vertices)).colours
        self.assertEqual(red[0].tolist(), [1, 0, 0, 1])
        for wrong, part in ((shades, "of uint8 alone"), (-shades, "of uint8 alone"),
                            (shades * 1.0, "beyond 0 and 1"), (shades / -255, "beyond 0 and 1"),
                            (shades * np.nan, "finite"), (shades + np.inf, "finite")):
            self.raises(strake.InputError, part,
                        lambda: strake.polygons(vertices, faces, colours=wrong))
        dark = strake.polygons(vertices, faces, colours=shades[:, [0, 0, 0]] > 99).colours
        self.assertEqual(dark.max(), 1)

    def test_unusable_faces_and_vertices_are_repaired_and_told(self):
        vertices, faces = torus(24, 12)
        bad = np.concatenate([faces, [[0, 1, 10**6], [0, -1, 2], [0, 0, 1]]])
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            mesh = strake.import_mesh(vertices, bad, longest_edge="100%")
        self.assertEqual(len(mesh.faces), len(faces))
        self.assertIn("faces dropped", str(told[0].message))
        vertices = vertices.copy()
        vertices[0] = np.nan
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self.assertTrue(np.isfinite(strake.import_mesh(vertices, faces).positions).all())


class Running(unittest.TestCase):
    def test_other_threads_go_on(self):
        steps = []
        stop = threading.Event()
        def count():
            while not stop.is_set():
                steps.append(time.monotonic())
                time.sleep(0.005)
        thread = threading.Thread(target=count, daemon=True)
        thread.start()
        begin = time.monotonic()
        strake.tensor(strake.import_mesh(*torus(400, 200)), radius="3%")
        end = time.monotonic()
        stop.set()
        thread.join()
        # With the lock held all the time there would be none between the ends.
        self.assertGreater(sum(begin + 0.05 < step < end - 0.05 for step in steps), 10)

    def test_progress_is_told_and_its_errors_cancel(self):
        told = []
        strake.tensor(strake.import_mesh(*torus(400, 200)), radius="3%",
                      progress=lambda *state: told.append(state))
        self.assertTrue(all(stage == "tensor" and 0 <= share <= 1 for stage, _, share in told))
        self.assertGreater(len(told), 0)
        def refuse(*_):
            raise RuntimeError("enough")
        with self.assertRaisesRegex(RuntimeError, "enough"):
            strake.remesh(*torus(400, 200), vertices_wanted=20000, progress=refuse)

    def test_interrupt_cancels(self):
        begin = time.monotonic()
        timer = threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            strake.remesh(*torus(1200, 600), vertices_wanted=50000)
        self.assertLess(time.monotonic() - begin, 30)
        strake.import_mesh(*torus(12, 6))  # and the module still works

    def ends_beside_threads(self, last_words):
        """What a script prints that ends while threads of its are in strake."""
        code = """if True:
            import atexit, os, sys, threading, time
            def small(): print(strake.import_mesh(*torus(12, 6)).positions.size > 0)
            atexit.register(small)
            import strake
            from module_test import torus
            class Late:  # keeps the end going for a while
                def __del__(self, sleep=time.sleep): sleep(0.3)
            late = Late()
            told = threading.Event()
            def work():
                strake.remesh(*torus(400, 200), threads=1, progress=lambda *_: told.set())
            for _ in range(2):
                threading.Thread(target=work, daemon=True).start()
            told.wait()
            """ + last_words
        paths = os.pathsep.join([str(pathlib.Path(__file__).parent), os.environ["PYTHONPATH"]])
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True,
                              timeout=60, env=os.environ | {"PYTHONPATH": paths})
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout

    def test_the_interpreter_ends_while_threads_are_in_strake(self):
        # What ends later may still use it, in the thread that ends the interpreter.
        self.assertEqual(self.ends_beside_threads("pass"), "True\n")

    def test_a_fork_does_not_wait_for_threads_that_it_has_not(self):
        code = "if os.fork() == 0: atexit.unregister(small); sys.exit(0)"
        self.assertEqual(self.ends_beside_threads(code), "True\n")


class Documents(unittest.TestCase):
    def test_options_are_in_docstrings(self):
        for name in ("vertices_wanted", "feature_angle", "pure_quads", "tolerance"):
            self.assertRegex(strake.remesh.__doc__, rf"\n    {name}\b")
        self.assertIn("radius (length):", strake.tensor.__doc__)
        for name in strake.__all__:
            self.assertTrue(getattr(strake, name).__doc__, name)

    def test_code_of_the_guide_runs(self):
        text = (ROOT / "docs/python.md").read_text()
        code = "\n".join(re.findall(r"```python\n(.*?)```", text, re.S))
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, "-c", code], cwd=folder, check=True,
                           stdout=subprocess.DEVNULL)


if __name__ == "__main__":
    unittest.main()
