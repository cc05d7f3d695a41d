"""Nearest hits over all rest frames, along past-directed null rays (docs/physics.md section 2)."""
from dataclasses import dataclass

from mpmath import mp, mpf

from minkowski import ONE, ZERO, add, along, apply, boost, dot, scaled, subtract, unit
from shapes import intersect

# Roots this near the start of a shadow ray are the lit surface itself. The start is known to 1e-40.
SELF = mpf(10) ** -25


@dataclass
class Hit:
    """A hit event in the frame of its object; ray and normal in that of its matter."""
    obj: object
    s: mpf
    event: list      # (time; space), the object's frame
    ray: list        # traced four-vector n, in the frame of the matter, its axes carried by the pure boost
    normal: list     # unit, there, facing the ray
    face: int
    celerity: list   # of the matter in the object's frame
    own_time: mpf    # of the matter, times c

    def signature(self):
        """What must not change for neighbouring rays to see the same smooth piece of surface."""
        return (self.obj.object_id, self.obj.copy, self.face)


def pixel_direction(camera, i, j):
    """The unit looking direction of pixel centre (i, j) in the camera frame; None outside a fisheye."""
    f, r, u = camera.axes
    w, h = mpf(camera.width), mpf(camera.height)
    px, py = i + mpf(1) / 2, j + mpf(1) / 2
    if camera.projection == "perspective":
        half = mp.tan(mp.radians(camera.fov) / 2)
        x, y = (2 * px / w - 1) * half, (1 - 2 * py / h) * half * h / w
        return unit(combined((f, r, u), (ONE, x, y)))
    if camera.projection == "fisheye":
        x, y = px - w / 2, h / 2 - py
        radius = mp.hypot(x, y)
        if radius > w / 2:
            return None
        if radius == 0:
            return f
        angle = radius / (w / 2) * mp.radians(camera.fov) / 2
        side = mp.sin(angle) / radius
        return combined((f, r, u), (mp.cos(angle), side * x, side * y))
    longitude = (px / w - mpf(1) / 2) * 2 * mp.pi
    up = mpf(1) / 2 - py / h
    if camera.projection == "equirectangular":
        latitude = up * mp.pi
    elif camera.projection == "mercator":
        latitude = mp.atan(mp.sinh(2 * mp.pi * up * h / w))  # the Gudermannian
    else:
        raise ValueError(f"unknown projection '{camera.projection}'")
    flat = mp.cos(latitude)
    return combined((f, r, u), (flat * mp.cos(longitude), flat * mp.sin(longitude), mp.sin(latitude)))


def combined(axes, weights):
    """The weighted sum of three vectors."""
    total = [ZERO] * 3
    for axis, weight in zip(axes, weights):
        total = add(total, scaled(axis, weight))
    return total


class Tracer:
    """Rays of one scene, from the camera or from a lit surface."""

    def __init__(self, scene):
        self.scene = scene
        self.by_frame = {}
        for obj in scene.objects:
            self.by_frame.setdefault(id(obj.frame), (obj.frame, []))[1].append(obj)
        self._matrices = {}

    def carry(self, to, frm, vector):
        """Coordinates in frame `to` of a four-vector of frame `frm`."""
        key = (id(to), id(frm))
        if key not in self._matrices:
            columns = [to.vector_from(frm, [ONE if i == k else ZERO for i in range(4)]) for k in range(4)]
            self._matrices[key] = [list(row) for row in zip(*columns)]
        return apply(self._matrices[key], vector)

    def all_roots(self, frame, event, ray, end=None):
        """(s, object, gradient, face, event, ray) of every crossing of a line with every object; of those in motion
        only between 0 and `end`, without a gradient."""
        world = frame.event_to_world(event)
        for other, objects in self.by_frame.values():
            start = other.event_from_world(world)
            direction = self.carry(other, frame, ray)
            for obj in objects:
                if obj.body:
                    for s, face in obj.body.roots(start, direction, end):
                        yield s, obj, None, face, start, direction
                    continue
                local_start = apply(obj.to_local, subtract(start[1:], obj.position))
                local_direction = apply(obj.to_local, direction[1:])
                for s, gradient, face in intersect(obj.shape, local_start, local_direction):
                    yield s, obj, gradient, face, start, direction

    def nearest(self, frame, event, ray, least=ZERO):
        """The hit with the smallest s > `least`, or None."""
        best = min(((root[0], k, root) for k, root in enumerate(self.all_roots(frame, event, ray))
                    if root[0] > least), default=None)
        if best is None:
            return None
        s, obj, gradient, face, start, direction = best[2]
        if obj.body:
            return self._hit_in_motion(s, obj, face, start, direction)
        normal = unit(apply([list(row) for row in zip(*obj.to_local)], gradient))
        if dot(normal, direction[1:]) > 0:
            normal = scaled(normal, -ONE)
        event = along(start, direction, s)
        return Hit(obj, s, event, direction, normal, face, [ZERO] * 3, event[0])

    def _hit_in_motion(self, s, obj, face, start, direction):
        """The hit of matter that moves in its frame."""
        event = along(start, direction, s)
        point, celerity, normal = obj.body.matter_at(event)
        ray = apply(boost(celerity), direction)
        if dot(normal, ray[1:]) > 0:
            normal = scaled(normal, -ONE)
        return Hit(obj, s, event, ray, normal, face, celerity, obj.body.motion.own_time(point, event[0]))

    def mirrored(self, hit, light):
        """The traced four-vector that a mirror passes on, in the frame of its object: reflected in that of its matter.
        Where no light travelled along the ray that met it (not `light`), light does from there on."""
        space = along(hit.ray[1:], hit.normal, -2 * dot(hit.ray[1:], hit.normal))
        ray = [hit.ray[0]] + space if light else [-ONE] + unit(space)
        return apply(boost(scaled(hit.celerity, -ONE)), ray)

    def seen_in_mirror(self, hit, light):
        """({values}, signature) of what is seen in a mirror, at the end of the way through all of them."""
        camera = self.scene.camera.frame
        distance, signature = hit.s, ()
        for _ in range(self.scene.bounces):
            frame, event, ray = hit.obj.frame, hit.event, self.mirrored(hit, light)
            light = True
            hit = self.nearest(frame, event, ray, SELF)
            if hit is None:
                sky = self.carry(self.scene.background_frame, frame, ray)
                return {"mirrorD": [1 / abs(sky[0])]}, signature + ((0, 0, 0),)
            distance += hit.s * abs(self.carry(camera, frame, ray)[0])
            signature += (hit.signature(),)
            if "mirror" not in hit.obj.material:
                break
        world = hit.obj.frame.event_to_world(hit.event)
        return {"mirrorZ": [distance], "mirrorD": [1 / abs(hit.ray[0])],
                "mirrorT": [world[0] / self.scene.c]}, signature

    def blocked(self, frame, event, ray, end):
        """Whether anything lies on event + s ray for 0 < s < end (None: no end)."""
        for s, *_ in self.all_roots(frame, event, ray, end):
            if s > SELF and (end is None or s < end - SELF):
                return True
        return False

    def camera_ray(self, direction, light_delay):
        """The traced four-vector of a looking direction, camera frame."""
        return [-ONE if light_delay else ZERO] + list(direction)

    def aovs(self, hit, light_delay):
        """The AOVs of a hit, in scene units (see the scene format contract, channels)."""
        world = hit.obj.frame.event_to_world(hit.event)
        return {
            "Z": [hit.s],
            "doppler": [1 / abs(hit.ray[0]) if light_delay else ONE],
            "emissionTime": [world[0] / self.scene.c],
            "properTime": [hit.own_time / self.scene.c],
            "P": hit.event[1:],
            "N": hit.normal,
        }
