"""Glass: which one a place is in, what its surfaces do to light, and what it leaves of a lamp's (docs/physics.md
section 12). Where a ray is is never remembered: every place is asked for the bodies around it."""
from mpmath import mp, mpf

from minkowski import ONE, ZERO, along, dot, norm, scaled, subtract, unit

# Where a side of a surface begins: far above the 1e-40 of its points, far below all that is seen.
ASIDE = mpf(10) ** -20


def is_glass(obj):
    """Whether an object is of glass; else it is opaque."""
    return "glass" in obj.material


def reflectance(c, beyond, index, index_beyond):
    """Fresnel's share of unpolarised light, by the cosines on both sides."""
    across = (index * c - index_beyond * beyond) / (index * c + index_beyond * beyond)
    within = (index_beyond * c - index * beyond) / (index_beyond * c + index * beyond)
    return (across ** 2 + within ** 2) / 2


def parted(d, normal, index, index_beyond):
    """(share reflected, direction of what is refracted or None) of light that looks along d, against the normal."""
    ratio, c = index / index_beyond, -dot(d, normal)
    square = 1 - ratio ** 2 * (1 - c * c)
    if square <= 0:
        return ONE, None
    beyond = mp.sqrt(square)
    return reflectance(c, beyond, index, index_beyond), along(scaled(d, ratio), normal, ratio * c - beyond)


class Glasses:
    """All glass of a scene."""

    def __init__(self, tracer):
        self.tracer, self.scene = tracer, tracer.scene
        self.all = [obj for obj in self.scene.objects if is_glass(obj)]

    def around(self, frame, event):
        """The innermost glass at an event of a frame: the smallest one. None where there is none."""
        if not self.all:
            return None
        world = frame.event_to_world(event)
        found = [obj for obj in self.all if obj.body.encloses(obj.frame.event_from_world(world))]
        return min(found, key=lambda obj: obj.body.whole.reach(), default=None)

    def index(self, glass):
        """Of refraction; 1 of none."""
        return ONE if glass is None else self.scene.number(glass.material["glass"]["index"])

    def left(self, glass, length):
        """The shares of red, green and blue that a way in it leaves."""
        if glass is None:
            return [ONE] * 3
        tint = glass.material["glass"].get("tint", 1)
        tint = self.scene.vector(tint) if isinstance(tint, list) else [self.scene.number(tint)] * 3
        return [share ** length if share != 1 else ONE for share in tint]

    def ways(self, hit, looking, w):
        """[(share, four-vector, glass that it is in)] of both parts of the light at a surface of glass, the refracted
        one first; `looking`: the ray's unit direction there; w: its frequency."""
        here, beyond = (self.around(hit.obj.frame, [hit.event[0]] + along(hit.event[1:], hit.normal, side * ASIDE))
                        for side in (1, -1))
        n, n_beyond = self.index(here), self.index(beyond)
        share, refracted = parted(looking, hit.normal, n, n_beyond)
        back = along(looking, hit.normal, -2 * dot(looking, hit.normal))
        found = [] if refracted is None else [(1 - share, [-n_beyond * w] + scaled(refracted, w), beyond)]
        return found + [(share, [-n * w] + scaled(back, w), here)]

    def leaves_of_lamp(self, frame, event, ray, crossings, end):
        """The shares of red, green and blue that glass leaves on event + s ray, 0 < s < end, which it crosses so."""
        crossings = sorted(crossings, key=lambda crossing: crossing[0])
        places = [ZERO] + [crossing[0] for crossing in crossings]
        places.append(end if end is not None else places[-1] + 1)
        media = [self.around(frame, along(event, ray, (a + b) / 2)) for a, b in zip(places, places[1:])]
        rgb = [ONE] * 3
        for glass, a, b in zip(media, places, places[1:]):
            if glass is not None:
                way = self.tracer.carry(glass.frame, frame, scaled(ray, b - a))
                rgb = [x * share for x, share in zip(rgb, self.left(glass, norm(way[1:])))]
        for (_, obj, root, start, direction), before, after in zip(crossings, media, media[1:]):
            hit = self.tracer.hit_at(obj, root, start, direction)
            low, high = sorted((self.index(before), self.index(after)))
            c = abs(dot(hit.normal, unit(direction[1:])))
            beyond = mp.sqrt(1 - (low / high) ** 2 * (1 - c * c))
            rgb = scaled(rgb, 1 - reflectance(c, beyond, low, high))
        return rgb
