"""Makes a Blender file of the test: blender -b -P make_scene.py -- SCENE OUT.blend

SCENE is `shapes`: meshes that move, glow and have textures; or `optics`: a mirror, glass, and lamps of all kinds.
"""
import math
import sys

import bpy
import mathutils

for thing in list(bpy.data.objects):
    bpy.data.objects.remove(thing)


def material(name, **inputs):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    for key, value in inputs.items():
        shader.inputs[key.replace("_", " ")].default_value = value
    return made


def textured(name):
    made = material(name)
    image = bpy.data.images.new("squares", 8, 8)
    image.pixels = [x for j in range(8) for i in range(8) for x in ((1, 0, 0, 1) if (i + j) % 2 else (0, 0, 1, 1))]
    image.pack()
    node = made.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    made.node_tree.links.new(node.outputs["Color"], made.node_tree.nodes["Principled BSDF"].inputs["Base Color"])
    return made


def cube(name, made, **place):
    bpy.ops.mesh.primitive_cube_add(**place)
    thing = bpy.context.object
    thing.name = name
    thing.data.materials.append(made)
    return thing


def lamp(name, kind, energy, location=(0, 0, 0), rotation=(0, 0, 0), **more):
    made = bpy.data.lights.new(name, kind)
    made.energy = energy
    for key, value in more.items():
        setattr(made, key, value)
    thing = bpy.data.objects.new(name, made)
    thing.location = location
    thing.rotation_euler = [math.radians(angle) for angle in rotation]
    bpy.context.collection.objects.link(thing)


def shapes():
    # A box of 2 x 1 x 0.5, turned about the vertical; moving.
    box = cube("box", material("brick", Base_Color=(0.6, 0.2, 0.1, 1)), size=1, location=(-1.5, 0, 0.25),
               rotation=(0, 0, math.radians(30)), scale=(2, 1, 0.5))
    box["beta"] = [0.0, 0.6, 0.0]
    # A smooth ball with a texture that is within the file.
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32, radius=0.7, location=(1.2, 0, 0.7))
    bpy.ops.object.shade_smooth()
    bpy.context.object.name = "ball"
    bpy.context.object.data.materials.append(textured("squares"))
    # A lamp that glows, of two materials.
    bulb = cube("bulb", material("glow", Emission=(1, 0.5, 0.25, 1), Emission_Strength=2.0), size=0.4, location=(0, 2, 1.5))
    bulb.data.materials.append(material("base", Base_Color=(0.1, 0.1, 0.1, 1)))
    bulb.data.polygons[0].material_index = 1
    lamp("lamp", "POINT", 1000.0, (2, -4, 5))
    lamp("sun", "SUN", 1.0, rotation=(40, 0, 30))


def optics():
    cube("floor", material("grey", Base_Color=(0.5, 0.5, 0.5, 1)), size=1, location=(0, 0, -0.5), scale=(12, 12, 1))
    cube("mirror", material("silver", Base_Color=(0.9, 0.8, 0.7, 1), Metallic=1.0, Roughness=0.0), size=1,
         location=(-1.4, 0.5, 0.8), rotation=(0, 0, math.radians(25)), scale=(1.5, 0.2, 1.6))
    cube("glass", material("crown", Base_Color=(0.7, 0.9, 0.8, 1), Transmission=1.0, Roughness=0.0, IOR=1.5), size=1,
         location=(1.3, 0, 0.5), rotation=(0, 0, math.radians(-15)))
    cube("brick", material("brick", Base_Color=(0.6, 0.2, 0.1, 1)), size=0.6, location=(0.2, 1.2, 0.3))
    lamp("area", "AREA", 100.0, (2, -4, 5), (20, 30, 0))
    lamp("spot", "SPOT", 400.0, (-3, -3, 4), (30, -30, 0), spot_size=math.radians(70), spot_blend=0.4)


scene_name, out = sys.argv[sys.argv.index("--") + 1:]
{"shapes": shapes, "optics": optics}[scene_name]()
camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
camera.location = (0, -7, 2)
camera.rotation_euler = (mathutils.Vector((0, 0, 0.5)) - camera.location).to_track_quat("-Z", "Y").to_euler()
camera.data.angle = math.radians(50)
bpy.context.collection.objects.link(camera)
scene = bpy.context.scene
scene.camera = camera
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 320, 200, 50
if scene.world is not None and scene.world.use_nodes:
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.0
bpy.ops.wm.save_as_mainfile(filepath=out)
