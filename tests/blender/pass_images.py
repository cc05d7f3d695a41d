"""Passes an image through Blender's compositor: each layer that Blender finds in it into a file of its own.

  blender -b -P pass_images.py -- IMAGE.exr FOLDER/      prints the layers' names after "LAYERS"
"""
import sys

import bpy

file, folder = sys.argv[sys.argv.index("--") + 1:]
image = bpy.data.images.load(file)
scene = bpy.context.scene
scene.use_nodes = True
tree = scene.node_tree
tree.nodes.clear()
source = tree.nodes.new("CompositorNodeImage")
source.image = image
files = tree.nodes.new("CompositorNodeOutputFile")
files.base_path = folder
files.format.file_format, files.format.color_depth, files.format.color_mode = "OPEN_EXR", "32", "RGBA"
files.file_slots.clear()
layers = [output for output in source.outputs if output.enabled]
for layer in layers:
    files.file_slots.new(layer.name)
    tree.links.new(layer, files.inputs[layer.name])
tree.links.new(layers[0], tree.nodes.new("CompositorNodeComposite").inputs[0])
render = scene.render
render.resolution_x, render.resolution_y, render.resolution_percentage = 60, 44, 100
render.use_multiview = image.is_multiview
bpy.ops.render.render()
print("LAYERS", *(layer.name for layer in layers))
