"""Blender add-on: remeshes the active object with quads along its curvature, by the program strake.

Install it in Edit > Preferences > Add-ons > Install, and say there where the program is if it is not
in the search path. The panel is in the side bar of the 3D view (N), tab Strake. docs/blender.md
"""

bl_info = {
    "name": "Strake remesher",
    "description": "Quads along the curvature of a surface",
    "author": "strake contributors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "View3D > Side bar > Strake",
    "category": "Mesh",
}

import json
import os
import shutil
import signal
import subprocess
import tempfile

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty
from mathutils import Vector

MATERIAL = "slot_"  # of labels: the number of the material's slot follows


class Failure(Exception):
    """Something a user should read."""


# What is handed over: OBJ with colours at vertices and a material per face, in world units.

def write_mesh(mesh, matrix, path):
    """Writes a mesh as OBJ. matrix: from its coordinates to those of the file."""
    colours = vertex_colours(mesh)
    with open(path, "w", encoding="ascii") as file:
        for vertex in mesh.vertices:
            numbers = list(matrix @ vertex.co)
            if colours:
                numbers += colours[vertex.index]
            file.write("v " + " ".join(f"{number:.9g}" for number in numbers) + "\n")
        slot = None
        for polygon in mesh.polygons:
            if polygon.material_index != slot:
                slot = polygon.material_index
                file.write(f"usemtl {MATERIAL}{slot}\n")
            file.write("f " + " ".join(str(index + 1) for index in polygon.vertices) + "\n")


def vertex_colours(mesh):
    """[V] red, green, blue of the active colour attribute, or None. Corners are averaged."""
    layer = mesh.color_attributes.active_color if mesh.color_attributes else None
    if layer is None:
        return None
    def clipped(colour):
        return [min(max(channel, 0.0), 1.0) for channel in colour[:3]]
    if layer.domain == "POINT":
        return [clipped(item.color) for item in layer.data]
    sums = [[0.0, 0.0, 0.0, 0] for _ in mesh.vertices]
    for loop in mesh.loops:
        total = sums[loop.vertex_index]
        for i, channel in enumerate(clipped(layer.data[loop.index].color)):
            total[i] += channel
        total[3] += 1
    return [[channel / max(total[3], 1) for channel in total[:3]] for total in sums]


def edge_creases(mesh):
    """[E] how sharp the creases of edges are, 0 to 1. From Blender 4 on an attribute, there where an edge has one."""
    layer = mesh.attributes.get("crease_edge")
    if layer is not None:
        return [item.value for item in layer.data]
    return [getattr(edge, "crease", 0.0) for edge in mesh.edges]


def write_sharp_edges(mesh, path):
    """Writes the edges marked sharp, seams and creases, one a line. Returns how many."""
    edges = [edge for edge, crease in zip(mesh.edges, edge_creases(mesh))
             if edge.use_edge_sharp or edge.use_seam or crease > 0.5]
    with open(path, "w", encoding="ascii") as file:
        file.writelines(f"{edge.vertices[0]} {edge.vertices[1]}\n" for edge in edges)
    return len(edges)


def read_mesh(path, matrix, name):
    """A new mesh of an OBJ file. matrix: from the file's coordinates to those of the mesh."""
    vertices, colours, faces, slots = [], [], [], []
    slot = 0
    with open(path, encoding="ascii") as file:
        for line in file:
            words = line.split()
            if not words:
                continue
            if words[0] == "v":
                numbers = [float(word) for word in words[1:]]
                vertices.append(matrix @ Vector(numbers[:3]))
                colours.append(numbers[3:6])
            elif words[0] == "usemtl" and words[1].startswith(MATERIAL):
                slot = int(words[1][len(MATERIAL):])
            elif words[0] == "f":
                faces.append([int(word.split("/")[0]) - 1 for word in words[1:]])
                slots.append(slot)
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    mesh.polygons.foreach_set("material_index", slots)
    mesh.update()
    return mesh, colours if colours and colours[0] else None


# The run.

def program_path(context):
    add_on = context.preferences.addons.get(__name__)
    wanted = add_on.preferences.program if add_on else os.environ.get("STRAKE", "strake")
    found = shutil.which(bpy.path.abspath(wanted) if wanted.startswith("//") else wanted)
    if found is None:
        raise Failure(f"the program '{wanted}' was not found; set it in the add-on's preferences")
    return found


def option_words(settings, material_count):
    """The command line that the panel describes."""
    words = ["--feature-angle", f"{settings.feature_angle:g}"]
    if settings.goal == "VERTICES":
        words += ["--vertices", str(settings.vertices)]
    elif settings.goal == "FACES":
        words += ["--faces", str(settings.faces)]
    else:
        words += ["--tolerance", f"{settings.tolerance:g}%"]
    if settings.pure_quads:
        words.append("--pure-quads")
    if settings.keep_material_borders and material_count > 1:
        words += ["--attribute-features", "labels"]
    return words + ["--radius", f"{settings.radius:g}%", "--seed", str(settings.seed), "--no-evaluate"]


class Job:
    """One run of the program on one object."""

    def __init__(self, context, target):
        program = program_path(context)  # before there is anything to remove
        self.target = target
        self.settings = context.scene.strake_remesh
        self.folder = tempfile.TemporaryDirectory(prefix="strake-")
        self.output = os.path.join(self.folder.name, "out.obj")
        self.fraction = 0.0
        self.label = ""
        self.error = ""
        evaluated = target.evaluated_get(context.evaluated_depsgraph_get())
        self.source = bpy.data.meshes.new_from_object(
            evaluated, preserve_all_data_layers=True, depsgraph=context.evaluated_depsgraph_get())
        if not self.source.polygons:
            self.folder.cleanup()
            bpy.data.meshes.remove(self.source)
            raise Failure(f"'{target.name}' has no faces")
        words = [program, "remesh", os.path.join(self.folder.name, "in.obj"), "-o",
                 self.output, "--log-json", *option_words(self.settings, len(self.source.materials))]
        write_mesh(self.source, target.matrix_world, words[2])
        edges = os.path.join(self.folder.name, "edges.txt")
        if self.settings.keep_sharp_edges and write_sharp_edges(self.source, edges):
            words += ["--feature-edges", edges]
        self.log = open(os.path.join(self.folder.name, "log"), "w+", encoding="utf-8")
        self.process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=self.log)
        self.read_from = 0

    def listen(self):
        """Reads what the program has said since. Returns whether it has ended."""
        ended = self.process.poll() is not None
        self.log.seek(self.read_from)
        for line in self.log:
            if not line.endswith("\n") and not ended:
                break
            self.read_from += len(line.encode())
            try:
                event = json.loads(line)
            except ValueError:
                self.error += line  # of a crash
                continue
            if event["event"] == "progress":
                self.label = f"{event['label']}: {event['phase']}"
                self.fraction = event["fraction"]
            elif event["event"] == "error":
                self.error += event["message"]
            else:
                print("strake:", event["text"])
        return ended

    def cancel(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
            self.process.wait()
        self.close()

    def close(self):
        self.log.close()
        self.folder.cleanup()
        bpy.data.meshes.remove(self.source)

    def finish(self, context):
        """Puts the result into the scene. Returns the object that has it."""
        if self.process.returncode != 0:
            raise Failure(self.error.strip() or "strake failed")
        mesh, colours = read_mesh(self.output, self.target.matrix_world.inverted_safe(),
                                  self.target.data.name + ".quads")
        for material in self.source.materials:
            mesh.materials.append(material)
        if colours:
            name = self.source.color_attributes.active_color.name
            layer = mesh.color_attributes.new(name=name, type="FLOAT_COLOR", domain="POINT")
            for item, colour in zip(layer.data, colours):
                item.color = (*colour, 1.0)
        smooth = sum(polygon.use_smooth for polygon in self.source.polygons) * 2
        mesh.polygons.foreach_set("use_smooth",
                                  [smooth > len(self.source.polygons)] * len(mesh.polygons))
        return self.place(context, mesh)

    def place(self, context, mesh):
        if not self.settings.keep_original:
            self.target.modifiers.clear()  # the result has them in it
            self.target.data = mesh
            return self.target
        result = self.target.copy()
        result.name = self.target.name + ".quads"
        result.data = mesh
        result.modifiers.clear()
        for collection in self.target.users_collection:
            collection.objects.link(result)
        self.target.select_set(False)
        self.target.hide_set(True)
        result.select_set(True)
        context.view_layer.objects.active = result
        return result


class StrakeSettings(bpy.types.PropertyGroup):
    goal: EnumProperty(
        name="Goal", default="VERTICES",
        items=[("VERTICES", "Vertices", "A wanted number of vertices"),
               ("FACES", "Faces", "A wanted number of faces"),
               ("TOLERANCE", "Tolerance", "A largest distance from the surface")])
    vertices: IntProperty(name="Vertices", default=5000, min=8, max=10_000_000)
    faces: IntProperty(name="Faces", default=5000, min=8, max=10_000_000)
    tolerance: FloatProperty(name="Tolerance", default=0.2, min=0.001, max=10, precision=3,
                             description="Percent of the diagonal of the object's box")
    feature_angle: FloatProperty(name="Feature angle", default=40, min=0, max=180,
                                 description="Edges bent by more degrees are kept; 180 keeps none")
    radius: FloatProperty(name="Radius", default=1, min=0.01, max=50, precision=2,
                          description="Over which curvature is averaged, in percent of the "
                                      "diagonal; more for noisy scans")
    pure_quads: BoolProperty(name="Only quads", default=False)
    keep_sharp_edges: BoolProperty(name="Keep marked edges", default=True,
                                   description="Edges marked sharp or as seams, and creases, "
                                               "become edges of the result")
    keep_material_borders: BoolProperty(name="Keep material borders", default=True)
    keep_original: BoolProperty(name="Keep original", default=True,
                                description="Make a new object and hide this one")
    seed: IntProperty(name="Seed", default=1, min=0, description="Another start of the lines")


class OBJECT_OT_strake_remesh(bpy.types.Operator):
    """Remesh the active object with quads along its curvature"""

    bl_idname = "object.strake_remesh"
    bl_label = "Remesh"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        target = context.active_object
        return target is not None and target.type == "MESH" and context.mode == "OBJECT"

    def start(self, context):
        """The job, or None where it could not begin."""
        try:
            return Job(context, context.active_object)
        except Failure as failure:
            self.report({"ERROR"}, str(failure))
            return None

    def end(self, context, job):
        try:
            result = job.finish(context)
        except Failure as failure:
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        finally:
            job.close()
        self.report({"INFO"}, f"{len(result.data.vertices)} vertices, "
                              f"{len(result.data.polygons)} faces")
        return {"FINISHED"}

    def execute(self, context):
        job = self.start(context)
        if job is None:
            return {"CANCELLED"}
        job.process.wait()
        job.listen()
        return self.end(context, job)

    def invoke(self, context, _event):
        self.job = self.start(context)
        if self.job is None:
            return {"CANCELLED"}
        manager = context.window_manager
        self.timer = manager.event_timer_add(0.1, window=context.window)
        manager.progress_begin(0, 100)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            self.stop(context)
            self.job.cancel()
            self.report({"INFO"}, "interrupted")
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        ended = self.job.listen()
        context.window_manager.progress_update(int(100 * self.job.fraction))
        context.workspace.status_text_set(f"strake {self.job.label}   (Esc stops)")
        if not ended:
            return {"RUNNING_MODAL"}
        self.stop(context)
        return self.end(context, self.job)

    def stop(self, context):
        context.window_manager.event_timer_remove(self.timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)


class VIEW3D_PT_strake_remesh(bpy.types.Panel):
    bl_label = "Strake"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Strake"

    def draw(self, context):
        settings = context.scene.strake_remesh
        layout = self.layout
        layout.use_property_split = True
        layout.prop(settings, "goal")
        layout.prop(settings, settings.goal.lower())
        for name in ("feature_angle", "radius", "pure_quads", "keep_sharp_edges",
                     "keep_material_borders", "keep_original", "seed"):
            layout.prop(settings, name)
        layout.operator(OBJECT_OT_strake_remesh.bl_idname, icon="MOD_REMESH")


class StrakePreferences(bpy.types.AddonPreferences):
    bl_idname = __name__

    program: StringProperty(name="Program", subtype="FILE_PATH",
                            default=os.environ.get("STRAKE", "strake"),
                            description="The program strake, or its name in the search path")

    def draw(self, _context):
        self.layout.prop(self, "program")


CLASSES = (StrakeSettings, OBJECT_OT_strake_remesh, VIEW3D_PT_strake_remesh, StrakePreferences)


def register():
    for each in CLASSES:
        bpy.utils.register_class(each)
    bpy.types.Scene.strake_remesh = bpy.props.PointerProperty(type=StrakeSettings)


def unregister():
    del bpy.types.Scene.strake_remesh
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)


if __name__ == "__main__":
    register()
