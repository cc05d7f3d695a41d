"""Writes a Blender file as a scene of Backlight's, with its meshes and textures in a folder beside it.

  blender -b FILE.blend -P scripts/blender/export_backlight.py -- OUT.toml

Meshes (with modifiers and instances), the camera, lamps, the world's colour and materials: base colour, image
texture, emission, mirror (metallic, roughness below 0.1) and glass. An object with the custom property `beta`, three
numbers in Blender's axes, moves with that velocity in units of c, and is at its place at time 0. Blender's z is up,
Backlight's y: (x, y, z) becomes (x, z, -y). What has no counterpart is told on stderr. For Blender 3.4.
"""
import json
import math
import os
import shutil
import sys

import bpy

COUNTERPARTS = {"POINT": "point", "SUN": "distant", "SPOT": "spot", "AREA": "point"}


def warn(text):
    print("export_backlight: " + text, file=sys.stderr)


def upright(v):
    """From Blender's axes to a scene's."""
    return (v[0], v[2], -v[1])


def number(x):
    text = "%.9g" % x
    return "0" if text == "-0" else text


def numbers(values):
    return "[" + ", ".join(number(x) for x in values) + "]"


def quoted(text):
    return json.dumps(text, ensure_ascii=False)


def safe(name):
    return "".join(c if c.isalnum() or c in "-_" else "_" for c in name)


class Exporter:
    def __init__(self, out):
        self.out = out
        self.folder = os.path.splitext(out)[0] + ".files"
        self.lines = []
        self.materials = {}  # Blender's, or None: the name in the scene
        self.material_lines = []
        self.meshes = {}  # what a file was made of: its path
        self.images = {}
        os.makedirs(self.folder, exist_ok=True)

    def add(self, line=""):
        self.lines.append(line)

    def file(self, name, ending):
        """A path of the folder that is not taken: in the file system, and relative to the scene."""
        path, count = os.path.join(self.folder, safe(name) + ending), 1
        while path in self.meshes.values() or path in self.images.values():
            count += 1
            path = os.path.join(self.folder, "%s_%d%s" % (safe(name), count, ending))
        return path

    def relative(self, path):
        return quoted(os.path.relpath(path, os.path.dirname(os.path.abspath(self.out))))

    def run(self):
        scene = bpy.context.scene
        graph = bpy.context.evaluated_depsgraph_get()
        self.add("# Written by scripts/blender/export_backlight.py from %s." % (os.path.basename(bpy.data.filepath) or "a file without a name"))
        self.add("c = %s" % number(scene.get("c", 1.0)))
        self.film(scene)
        self.camera(scene)
        self.world(scene)
        for instance in graph.object_instances:
            thing = instance.object
            if not instance.show_self:
                continue
            if thing.type == "LIGHT":
                self.light(thing, instance.matrix_world)
            elif thing.type in {"MESH", "CURVE", "SURFACE", "META", "FONT"}:
                self.mesh(thing, instance.matrix_world, graph)
        self.lines += self.material_lines
        with open(self.out, "w", encoding="utf-8") as file:
            file.write("\n".join(self.lines) + "\n")

    def film(self, scene):
        share = scene.render.resolution_percentage / 100.0
        self.add("\n[film]")
        self.add("resolution = [%d, %d]" % (scene.render.resolution_x * share, scene.render.resolution_y * share))
        self.add("samples = 16")

    def camera(self, scene):
        camera = scene.camera
        if camera is None:
            sys.exit("export_backlight: the file has no active camera")
        matrix = camera.matrix_world
        self.add("\n[camera]")
        self.add("position = " + numbers(upright(matrix.translation)))
        self.add("direction = " + numbers(upright(-matrix.col[2].to_3d())))
        self.add("up = " + numbers(upright(matrix.col[1].to_3d())))
        self.velocity(camera)
        if camera.data.type == "PANO":
            self.add('projection = "equirectangular"')
            return
        if camera.data.type == "ORTHO":
            warn("the camera is orthographic; the scene's is a perspective one")
        frame = camera.data.view_frame(scene=scene)
        half = max(abs(corner.x / corner.z) for corner in frame)
        self.add("fov = " + number(math.degrees(2.0 * math.atan(half))))

    def velocity(self, thing):
        beta = thing.get("beta")
        if beta is None:
            return False
        try:
            beta = tuple(float(x) for x in beta)
        except TypeError:
            beta = ()
        if len(beta) != 3 or not sum(x * x for x in beta) < 1.0:
            sys.exit("export_backlight: 'beta' of %r has to be three numbers, together less than 1" % thing.name)
        self.add("beta = " + numbers(upright(beta)))
        return True

    def world(self, scene):
        world = scene.world
        if world is None:
            return
        color, strength = tuple(world.color), 1.0
        if world.use_nodes:
            node = next((n for n in world.node_tree.nodes if n.type == "BACKGROUND"), None)
            if node is None:
                return
            color, strength = tuple(node.inputs["Color"].default_value)[:3], node.inputs["Strength"].default_value
            if node.inputs["Color"].is_linked:
                warn("the world's texture is not exported, only its colour")
        if not max(color) * strength > 0.0:
            return
        self.add("\n[background]\ncolor = " + numbers(strength * x for x in color))
        self.add('\n[[light]]  # of the world, without shadows\ntype = "ambient"')
        self.add("color = %s\nradiance = %s" % (numbers(color), number(strength)))

    def light(self, thing, matrix):
        lamp = thing.data
        kind = COUNTERPARTS[lamp.type]
        self.add("\n[[light]]\nname = %s\ntype = %s" % (quoted(thing.name), quoted(kind)))
        if lamp.type != "SUN":
            self.add("position = " + numbers(upright(matrix.translation)))
            self.velocity(thing)
        if lamp.type in {"SUN", "SPOT"}:
            self.add("direction = " + numbers(upright(-matrix.col[2].to_3d())))
        self.add("color = " + numbers(lamp.color))
        if lamp.type == "SUN":
            self.add("irradiance = " + number(lamp.energy))
        elif lamp.type == "AREA":
            warn("the area lamp %r becomes a point" % thing.name)
            self.add("intensity = " + number(lamp.energy / math.pi))
        else:  # a lamp of P watts has P/4π towards any side
            self.add("intensity = " + number(lamp.energy / (4.0 * math.pi)))
        if lamp.type == "SPOT":
            self.add("angle = %s\nedge = %s" % (number(math.degrees(lamp.spot_size)), number(lamp.spot_blend)))

    def mesh(self, thing, matrix, graph):
        evaluated = thing.evaluated_get(graph)
        mesh = evaluated.to_mesh()
        if mesh is None:
            return
        mesh.calc_loop_triangles()
        mesh.calc_normals_split()
        used = sorted({triangle.material_index for triangle in mesh.loop_triangles})
        for index in used:
            material = thing.material_slots[index].material if index < len(thing.material_slots) else None
            name = thing.name if len(used) == 1 else "%s %d" % (thing.name, index)
            path, smooth = self.obj(thing, mesh, matrix, index, name)
            self.add("\n[[object]]\nname = %s\nshape = \"mesh\"\nfile = %s" % (quoted(name), self.relative(path)))
            if not smooth:
                self.add("smooth = false")
            self.add("position = " + numbers(upright(matrix.translation)))
            self.velocity(thing)
            self.add("material = " + quoted(self.material(material)))
        evaluated.to_mesh_clear()

    def obj(self, thing, mesh, matrix, index, name):
        """The triangles of one material as an OBJ file, turned and scaled as they are in the world, about the place
        of their object. Copies that are turned alike share one."""
        turn = matrix.to_3x3()
        key = (thing.data.name, thing.name if thing.modifiers else "", index, tuple(tuple(row) for row in turn))
        triangles = [t for t in mesh.loop_triangles if t.material_index == index]
        smooth = any(mesh.polygons[t.polygon_index].use_smooth for t in triangles)
        if key in self.meshes:
            return self.meshes[key], smooth
        path = self.file(name, ".obj")
        self.meshes[key] = path
        covector = turn.inverted_safe().transposed()
        layer = mesh.uv_layers.active
        places, normals, textures = {}, {}, {}
        lines, faces = [], []

        def number_of(known, values, what):
            text = what + " " + " ".join(number(x) for x in values)
            if text not in known:
                known[text] = len(known) + 1
                lines.append(text)
            return known[text]

        for triangle in triangles:
            corners = []
            for loop in triangle.loops:
                place = turn @ mesh.vertices[mesh.loops[loop].vertex_index].co
                corner = str(number_of(places, upright(place), "v")) + "/"
                if layer is not None:
                    corner += str(number_of(textures, layer.data[loop].uv, "vt"))
                if smooth:
                    normal = (covector @ mesh.loops[loop].normal).normalized()
                    corner += "/" + str(number_of(normals, upright(normal), "vn"))
                corners.append(corner.rstrip("/"))
            if turn.determinant() < 0.0:
                corners.reverse()
            faces.append("f " + " ".join(corners))
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(lines + faces) + "\n")
        return path, smooth

    def material(self, material):
        if material in self.materials:
            return self.materials[material]
        name = "grey" if material is None else safe(material.name)
        while name in self.materials.values() or name == "file":
            name += "_"
        self.materials[material] = name
        self.material_lines.append("\n[material.%s]" % quoted(name))
        if material is None:
            self.material_lines.append("color = [0.8, 0.8, 0.8]")
        else:
            self.material_lines += self.keys_of(material)
        return name

    def keys_of(self, material):
        if not material.use_nodes:
            return ["color = " + numbers(self.reflectance(material.diffuse_color))]
        output = next((n for n in material.node_tree.nodes if n.type == "OUTPUT_MATERIAL" and n.is_active_output), None)
        link = output.inputs["Surface"].links[0] if output is not None and output.inputs["Surface"].is_linked else None
        shader = link.from_node if link is not None else None

        def value(key, otherwise=0.0):
            return shader.inputs[key].default_value if key in shader.inputs else otherwise

        def color(key):
            return self.reflectance(value(key, (0.8, 0.8, 0.8, 1.0)))

        kind = shader.type if shader is not None else ""
        if kind == "BSDF_PRINCIPLED":
            if value("Metallic") > 0.5 and value("Roughness") < 0.1:
                return ["color = [0, 0, 0]", "mirror = " + numbers(color("Base Color"))]
            if value("Transmission") > 0.5:
                return ["color = [0, 0, 0]", "glass = { index = %s, tint = %s }" % (number(value("IOR", 1.45)), numbers(color("Base Color")))]
            keys = self.base(shader, "Base Color", color("Base Color"))
            return keys + self.emission(value("Emission", (0, 0, 0, 1)), value("Emission Strength", 1.0))
        if kind == "EMISSION":
            return ["color = [0, 0, 0]"] + self.emission(value("Color"), value("Strength"))
        if kind == "BSDF_DIFFUSE":
            return self.base(shader, "Color", color("Color"))
        if kind == "BSDF_GLOSSY" and value("Roughness") < 0.1:
            return ["color = [0, 0, 0]", "mirror = " + numbers(color("Color"))]
        if kind == "BSDF_GLASS":
            return ["color = [0, 0, 0]", "glass = { index = %s, tint = %s }" % (number(value("IOR")), numbers(color("Color")))]
        warn("the material %r is none that can be exported: its viewport colour is taken" % material.name)
        return ["color = " + numbers(self.reflectance(material.diffuse_color))]

    @staticmethod
    def reflectance(color):
        return [min(1.0, max(0.0, x)) for x in tuple(color)[:3]]

    @staticmethod
    def emission(color, strength):
        color = tuple(color)[:3]
        if not max(color) * strength > 0.0:
            return []
        return ["emission = " + number(strength), "emission_color = " + numbers(color)]

    def base(self, shader, key, color):
        if shader.inputs[key].is_linked:
            node = shader.inputs[key].links[0].from_node
            if node.type == "TEX_IMAGE" and node.image is not None:
                return ["texture = " + self.relative(self.image(node.image))]
            warn("what is linked to the colour of %r is no image, and is not exported" % shader.id_data.name)
        return ["color = " + numbers(color)]

    def image(self, image):
        if image in self.images:
            return self.images[image]
        source = bpy.path.abspath(image.filepath)
        if image.source == "FILE" and not image.packed_file and os.path.isfile(source):
            path = self.file(os.path.splitext(os.path.basename(source))[0], os.path.splitext(source)[1])
            shutil.copyfile(source, path)
        else:
            path = self.file(image.name, ".png")
            image.file_format = "PNG"
            image.save(filepath=path)
        self.images[image] = path
        return path


def main():
    arguments = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    if len(arguments) != 1 or not arguments[0].endswith(".toml"):
        sys.exit("usage: blender -b FILE.blend -P export_backlight.py -- OUT.toml")
    Exporter(arguments[0]).run()


main()
