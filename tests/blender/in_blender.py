"""Runs inside Blender: installs the add-on from its file and remeshes objects with it.

blender --background --factory-startup --python in_blender.py -- PROGRAM ADD_ON
"""

import math
import sys
import traceback

import bpy

PROGRAM, ADD_ON = sys.argv[sys.argv.index("--") + 1:]


def expect(condition, text):
    if not condition:
        raise AssertionError(text)


def new_object(make):
    bpy.ops.object.select_all(action="DESELECT")
    make()
    return bpy.context.active_object


def remesh(**settings):
    for name, value in settings.items():
        setattr(bpy.context.scene.strake_remesh, name, value)
    outcome = bpy.ops.object.strake_remesh()
    expect(outcome == {"FINISHED"}, f"the operator said {outcome}")
    return bpy.context.active_object


def test_count_and_place():
    """A torus, scaled unevenly, turned and moved: the result lies on it, in the same place."""
    torus = new_object(lambda: bpy.ops.mesh.primitive_torus_add(
        major_segments=96, minor_segments=48, location=(3, -2, 1), rotation=(0.3, 0.2, 0.1)))
    torus.scale = (2, 1, 1)
    bpy.ops.object.shade_smooth()
    bpy.context.view_layer.update()
    result = remesh(goal="VERTICES", vertices=800)
    expect(result is not torus and torus.hide_get(), "the original is kept, and hidden")
    expect(result.matrix_world == torus.matrix_world, "the result is placed as the original")
    expect(abs(len(result.data.vertices) - 800) <= 40, len(result.data.vertices))
    for vertex in result.data.vertices:
        x, y, z = vertex.co
        off = abs(math.hypot(math.hypot(x, y) - 1, z) - 0.25)
        expect(off < 0.03, f"a vertex is {off} off the torus")
    sides = [len(polygon.vertices) for polygon in result.data.polygons]
    expect(sides.count(4) > 0.85 * len(sides), "most faces are quads")
    expect(all(polygon.use_smooth for polygon in result.data.polygons), "shading stays smooth")


def test_colours_and_materials():
    """A grid, red and with the second material on one half."""
    grid = new_object(lambda: bpy.ops.mesh.primitive_grid_add(x_subdivisions=40, y_subdivisions=40))
    for name in ("one", "two"):
        grid.data.materials.append(bpy.data.materials.new(name))
    layer = grid.data.color_attributes.new(name="paint", type="FLOAT_COLOR", domain="CORNER")
    for loop in grid.data.loops:
        right = grid.data.vertices[loop.vertex_index].co.x > 0
        layer.data[loop.index].color = (1, 0, 0, 1) if right else (0, 0, 1, 1)
    grid.data.color_attributes.active_color = layer
    for polygon in grid.data.polygons:
        polygon.material_index = int(polygon.center.x > 0)
    result = remesh(goal="FACES", faces=200, keep_original=False)
    expect(result is grid, "the object itself has the result")
    expect([material.name for material in result.data.materials] == ["one", "two"], "materials")
    for polygon in result.data.polygons:
        expect(polygon.material_index == int(polygon.center.x > 0), "a face has the other material")
    # The border of the materials is kept: no face lies across it.
    for polygon in result.data.polygons:
        xs = [result.data.vertices[index].co.x for index in polygon.vertices]
        expect(min(xs) > -1e-5 or max(xs) < 1e-5, "a face lies across the border")
    paint = result.data.color_attributes["paint"]
    for vertex, item in zip(result.data.vertices, paint.data):
        if abs(vertex.co.x) > 0.1:
            expect(item.color[0] == (1 if vertex.co.x > 0 else 0), "a vertex has the wrong colour")


def test_modifiers_and_marked_edges():
    """What is remeshed is what is seen, and edges marked sharp stay edges."""
    grid = new_object(lambda: bpy.ops.mesh.primitive_grid_add(x_subdivisions=30, y_subdivisions=30))
    column = 2 * 19 / 30 - 1  # not where lines at even distances would run
    for edge in grid.data.edges:
        ends = [grid.data.vertices[index].co.x for index in edge.vertices]
        edge.use_edge_sharp = all(abs(x - column) < 1e-5 for x in ends)
    expect(sum(edge.use_edge_sharp for edge in grid.data.edges) == 30, "a column is marked")
    modifier = grid.modifiers.new("up", "DISPLACE")
    modifier.strength, modifier.mid_level = 0.5, 0.0
    result = remesh(goal="TOLERANCE", tolerance=0.5, keep_original=True)
    expect(not result.modifiers, "modifiers are applied")
    for polygon in result.data.polygons:
        xs = [result.data.vertices[index].co.x for index in polygon.vertices]
        expect(min(xs) > column - 1e-4 or max(xs) < column + 1e-4, "a face lies across the mark")
    heights = [vertex.co.z for vertex in result.data.vertices]
    expect(max(abs(height - 0.5) for height in heights) < 1e-4, "the displaced grid is remeshed")


def test_failures_are_told():
    empty = new_object(lambda: bpy.ops.object.add(type="MESH"))
    try:
        bpy.ops.object.strake_remesh()
        expect(False, "a mesh without faces is refused")
    except RuntimeError as error:
        expect("has no faces" in str(error), error)
    bpy.data.objects.remove(empty)
    new_object(bpy.ops.mesh.primitive_cube_add)
    preferences = bpy.context.preferences.addons["strake_remesh"].preferences
    preferences.program = "no-such-program"
    try:
        bpy.ops.object.strake_remesh()
        expect(False, "a missing program is told")
    except RuntimeError as error:
        expect("no-such-program" in str(error), error)
    preferences.program = PROGRAM
    # A message of the program itself.
    flat = new_object(lambda: bpy.ops.mesh.primitive_cube_add())
    flat.scale = (0, 0, 0)
    bpy.context.view_layer.update()
    try:
        bpy.ops.object.strake_remesh()
        expect(False, "a mesh without extent is refused")
    except RuntimeError as error:
        expect("lie in one point" in str(error), error)


def main():
    bpy.ops.preferences.addon_install(filepath=ADD_ON)
    bpy.ops.preferences.addon_enable(module="strake_remesh")
    bpy.context.preferences.addons["strake_remesh"].preferences.program = PROGRAM
    for test in (test_count_and_place, test_colours_and_materials, test_modifiers_and_marked_edges,
                 test_failures_are_told):
        test()
        print("passed:", test.__name__)
    bpy.ops.preferences.addon_disable(module="strake_remesh")
    expect(not hasattr(bpy.types.Scene, "strake_remesh"), "the add-on goes without traces")
    print("the add-on works")


try:
    main()
except Exception:
    traceback.print_exc()
    sys.exit(1)
