"""Makes the Blender file of the test: blender -b -P make_scene.py -- OUT.blend"""
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


# A box of 2 x 1 x 0.5, turned about the vertical; moving.
bpy.ops.mesh.primitive_cube_add(size=1, location=(-1.5, 0, 0.25), rotation=(0, 0, math.radians(30)), scale=(2, 1, 0.5))
box = bpy.context.object
box.name = "box"
box["beta"] = [0.0, 0.6, 0.0]
box.data.materials.append(material("brick", Base_Color=(0.6, 0.2, 0.1, 1)))
# A smooth ball with a texture that is within the file.
bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32, radius=0.7, location=(1.2, 0, 0.7))
bpy.ops.object.shade_smooth()
bpy.context.object.name = "ball"
bpy.context.object.data.materials.append(textured("squares"))
# A lamp that glows, of two materials.
bpy.ops.mesh.primitive_cube_add(size=0.4, location=(0, 2, 1.5))
bulb = bpy.context.object
bulb.name = "bulb"
bulb.data.materials.append(material("glow", Emission=(1, 0.5, 0.25, 1), Emission_Strength=2.0))
bulb.data.materials.append(material("base", Base_Color=(0.1, 0.1, 0.1, 1)))
bulb.data.polygons[0].material_index = 1

lamp = bpy.data.lights.new("lamp", "POINT")
lamp.energy = 1000.0
thing = bpy.data.objects.new("lamp", lamp)
thing.location = (2, -4, 5)
bpy.context.collection.objects.link(thing)
sun = bpy.data.lights.new("sun", "SUN")
sun.energy = 1.0
thing = bpy.data.objects.new("sun", sun)
thing.rotation_euler = (math.radians(40), 0, math.radians(30))
bpy.context.collection.objects.link(thing)

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
bpy.ops.wm.save_as_mainfile(filepath=sys.argv[sys.argv.index("--") + 1])
