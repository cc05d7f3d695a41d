"""Nearest hits over all rest frames, along past-directed null rays (docs/physics.md section 2)."""
from dataclasses import dataclass

from mpmath import mp, mpf

from bodies import body_point, own_time
from glass import Glasses, is_glass
from minkowski import ONE, ZERO, add, along, apply, boost, dot, scaled, subtract, unit
from shapes import texture_coordinates

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
    chain: tuple     # of parts, from the whole of the object to the one whose surface it is
    face: int
    celerity: list   # of the matter in the object's frame
    own_time: mpf    # of the matter, times c
    point: list      # in the coordinates of the last of the chain
    index: mpf       # of refraction, of what the ray came through
    glass: object    # which that was; None: nothing

    def signature(self):
        """What must not change for neighbouring rays to see the same smooth piece of surface."""
        return (self.obj.object_id, self.obj.copy, self.chain[-1].number, self.face, self.square())

    @property
    def material(self):
        """That of the innermost part that has one."""
        return next((part.material for part in reversed(self.chain) if part.material is not None), {})

    def frequency(self):
        """Of light that is seen along the ray, in the matter's frame, for one of 1 at the camera: 1/D."""
        return abs(self.ray[0]) / self.index

    def square(self):
        """Which of the two colours of a checker it is; None without one."""
        if "checker" not in self.material:
            return None
        size = mpf(self.material["checker"].get("size", 1))
        u, v = texture_coordinates(self.chain[-1].shape, self.point, self.face)
        return int(mp.floor(u / size) + mp.floor(v / size)) % 2


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
        self.glasses = Glasses(self)

    def carry(self, to, frm, vector):
        """Coordinates in frame `to` of a four-vector of frame `frm`."""
        key = (id(to), id(frm))
        if key not in self._matrices:
            columns = [to.vector_from(frm, [ONE if i == k else ZERO for i in range(4)]) for k in range(4)]
            self._matrices[key] = [list(row) for row in zip(*columns)]
        return apply(self._matrices[key], vector)

    def all_roots(self, frame, event, ray, end=None, wanted=lambda obj: True):
        """(s, object, root, event, ray) of every crossing of a line with every object that is wanted; where they are
        walked to, only those between 0 and `end`. A root is what Body.roots says."""
        world = frame.event_to_world(event)
        for other, objects in self.by_frame.values():
            objects = [obj for obj in objects if wanted(obj)]
            if not objects:
                continue
            start = other.event_from_world(world)
            direction = self.carry(other, frame, ray)
            for obj in objects:
                for root in obj.body.roots(start, direction, end):
                    if obj.visible is None or self._is_there(obj, root, start, direction):
                        yield root[0], obj, root, start, direction

    def _is_there(self, obj, root, start, direction):
        """Whether an object that comes and goes is there at a crossing."""
        event, chain = along(start, direction, root[0]), root[2]
        own = own_time(chain, body_point(chain, event), event[0]) if obj.body.in_motion else event[0]
        return self.scene.at_own_time(obj.visible, own) > 0

    def nearest(self, frame, event, ray, least=ZERO, glass=None):
        """The hit with the smallest s > `least` of a ray within a glass, or None. Of surfaces in one place, what is not
        glass counts."""
        found = [crossing for crossing in self.all_roots(frame, event, ray) if crossing[0] > least]
        if not found:
            return None
        first = min(crossing[0] for crossing in found)
        crossings = [c for c in found if c[0] < first + SELF]
        opaque = [c for c in crossings if not is_glass(c[1])]
        _, obj, root, start, direction = (opaque or crossings)[0]
        return self.hit_at(obj, root, start, direction, glass)

    def hit_at(self, obj, root, start, direction, glass=None):
        """All that is to be known of a crossing of an object of a line in its frame."""
        s, gradient, chain, face = root
        event = along(start, direction, s)
        if gradient is not None and dot(gradient, direction[1:]) > 0:
            gradient = scaled(gradient, -ONE)
        point, celerity, normal = obj.body.matter_at(event, chain, face, gradient)
        ray = apply(boost(celerity), direction)
        if gradient is None and dot(normal, ray[1:]) > 0:
            normal = scaled(normal, -ONE)
        clock = own_time(chain, point, event[0]) if obj.body.in_motion else event[0]
        return Hit(obj, s, event, ray, normal, chain, face, celerity, clock, point,
                   self.glasses.index(glass), glass)

    def passed_on(self, hit, light):
        """[(shares of red, green and blue, traced four-vector in the frame of the object, the glass it is in)] of what
        goes on from a mirror or from glass, in the frame of its matter (sections 11 and 12); what is refracted comes
        first. Where no light travelled along the ray that met it (not `light`), light does from there on."""
        looking, w = unit(hit.ray[1:]), hit.frequency() if light else ONE
        if is_glass(hit.obj):
            return [([share] * 3, ray, glass) for share, ray, glass in self.glasses.ways(hit, looking, w)]
        if "mirror" not in hit.material:
            return []
        share = hit.material["mirror"]
        share = self.scene.vector(share) if isinstance(share, list) else [self.scene.number(share)] * 3
        space = along(looking, hit.normal, -2 * dot(looking, hit.normal))
        ray = apply(boost(scaled(hit.celerity, -ONE)), [-hit.index * w] + scaled(space, w))
        return [(share, ray, hit.glass)]

    def seen_in_mirror(self, hit, light):
        """({values}, signature) of what is seen in a mirror or through glass, at the end of the way through them."""
        camera = self.scene.camera.frame
        distance, signature = hit.index * hit.s, ()
        for _ in range(self.scene.bounces):
            on = self.passed_on(hit, light)
            if not on:
                break
            frame, (_, ray, glass) = hit.obj.frame, on[0]
            light = True
            hit = self.nearest(frame, hit.event, ray, SELF, glass)
            if hit is None:
                sky = self.carry(self.scene.background_frame, frame, ray)
                return {"mirrorD": [1 / abs(sky[0])]}, signature + ((0, 0, 0),)
            distance += hit.s * abs(self.carry(camera, frame, ray)[0])
            signature += (hit.signature(),)
        world = hit.obj.frame.event_to_world(hit.event)
        return {"mirrorZ": [distance], "mirrorD": [1 / hit.frequency()],
                "mirrorT": [world[0] / self.scene.c]}, signature

    def light_left(self, frame, event, ray, end):
        """The shares of red, green and blue of a lamp's light that come along event + s ray, 0 < s < end (None: no
        end); None where something is in the way."""
        shades = lambda obj: obj.casts_shadow
        found = [crossing for crossing in self.all_roots(frame, event, ray, end, shades)
                 if crossing[0] > SELF and (end is None or crossing[0] < end - SELF)]
        if any(not is_glass(crossing[1]) for crossing in found):
            return None
        return self.glasses.leaves_of_lamp(frame, event, ray, found, end)

    def camera_ray(self, direction, light_delay):
        """(traced four-vector of a looking direction, camera frame, the glass that it is in)."""
        camera = self.scene.camera
        glass = self.glasses.around(camera.frame, camera.event)
        return [-self.glasses.index(glass) if light_delay else ZERO] + list(direction), glass

    def aovs(self, hit, light_delay):
        """The AOVs of a hit, in scene units (see the scene format contract, channels)."""
        world = hit.obj.frame.event_to_world(hit.event)
        return {
            "Z": [hit.s],
            "doppler": [1 / hit.frequency() if light_delay else ONE],
            "emissionTime": [world[0] / self.scene.c],
            "properTime": [hit.own_time / self.scene.c],
            "P": hit.event[1:],
            "N": hit.normal,
        }
