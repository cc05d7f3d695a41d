"""Where the camera is at its exposure, how it moves and how it is turned (docs/physics.md section 9)."""
from dataclasses import dataclass

from mpmath import mp, mpf

from bodies import own_time, place_of, velocity
from minkowski import Frame, ONE, ZERO, along, apply, cross, dot, scaled, subtract, unit
from motion import Motion, uses_t


@dataclass
class Camera:
    """The camera event (own frame coordinates), the axes f, r, u and the projection."""
    frame: Frame
    event: list
    axes: tuple
    projection: str
    fov: mpf
    width: int
    height: int


def camera_of(scene, table):
    """The camera of a table at the exposure."""
    turned = lambda direction: direction
    if "aboard" in table:
        frame, event, turned = aboard(scene, table)
    elif "rocket" in table:
        frame, event = on_rocket(scene, table)
    elif uses_t(table.get("position")):
        frame, event = on_path(scene, table)
    else:
        frame, position = scene.rest_frame(table)
        event = [exposure(scene, table, frame, position)] + position
    if "look_at" in table:
        forward = subtract(scene.vector(table["look_at"]), scene.vector(table.get("position", [0, 0, 0])))
    else:
        forward = scene.vector(table.get("direction", [0, 0, 1]))
    axes = axes_looking(unit(turned(forward)), turned(scene.vector(table.get("up", [0, 1, 0]))))
    width, height = scene.document.get("film", {}).get("resolution", [64, 48])
    return Camera(frame, event, axes, table.get("projection", "perspective"), scene.number(table.get("fov", 60)),
                  width, height)


def axes_looking(forward, up):
    """(f, r, u): r = f x up normalised, u = r x f."""
    right = unit(cross(forward, up))
    return forward, right, cross(right, forward)


def exposure(scene, table, frame, position):
    """The camera's own time of the exposure, times c."""
    if "world_time" in table:
        world_time = scene.number(table["world_time"]) * scene.c
        at_own_zero = frame.event_to_world([ZERO] + position)[0]
        return (world_time - at_own_zero) / apply(frame.to_world, [ONE, ZERO, ZERO, ZERO])[0]
    return scene.number(table.get("time", "t")) * scene.c


def on_path(scene, table):
    """(frame, event) of a camera whose position is a formula of t."""
    base = scene.frames[table.get("frame", "world")]
    motion = Motion({"position": table["position"]}, scene, [ZERO] * 3)
    time = scene.number(table.get("time", "t")) * scene.c
    return base.moving_child(motion.celerity([ZERO] * 3, time), [time] + motion.place([ZERO] * 3, time)), [ZERO] * 4


def on_rocket(scene, table):
    """(frame, event) of a camera that accelerates."""
    base, position = scene.rest_frame(table)
    length = scene.c ** 2 / scene.number(table["rocket"]["acceleration"])
    thrust = unit(scene.vector(table["rocket"]["along"]))
    gained = scene.number(table.get("time", "t")) * scene.c / length
    place = along(position, thrust, length * (mp.cosh(gained) - 1))
    return base.moving_child(scaled(thrust, mp.sinh(gained)), [length * mp.sinh(gained)] + place), [ZERO] * 4


def aboard(scene, table):
    """(frame, event, map of directions) of a camera that rides with an object."""
    obj = next(o for o in scene.objects if o.name == table["aboard"])
    chain = (obj.body.whole,)
    point = scene.vector(table.get("position", [0, 0, 0]))
    wanted = scene.number(table.get("time", "t")) * scene.c
    time = wanted
    for _ in range(60):  # the clock runs slower than the frame's by a factor that changes little
        v = velocity(chain, point, time)
        step = (wanted - own_time(chain, point, time)) / mp.sqrt(1 - dot(v, v))
        time += step
        if abs(step) < mpf(10) ** -18:
            break
    v = velocity(chain, point, time)
    place = place_of(chain, point, time)
    frame = obj.frame.moving_child(scaled(v, 1 / mp.sqrt(1 - dot(v, v))), [time] + place)

    def turned(direction):
        """As the camera's own frame has the way between two near points of the body."""
        h = mpf(10) ** -20
        beside = scaled(subtract(place_of(chain, along(point, direction, h), time), place), 1 / h)
        return frame.vector_from(obj.frame, [ZERO] + beside)[1:]
    return frame, [ZERO] * 4, turned
