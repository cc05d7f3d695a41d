"""Brightness without colour: Lambert surfaces, white lights, the searchlight factors.

Covers what can be said exactly per RGB channel: materials with `color`, white highlights and white `emission`,
lights without colour, `doppler = false`. Anything else raises `Unsupported` and the colour is then left out.
"""
from mpmath import mp, mpf

from expression import evaluate_precisely
from minkowski import ONE, ZERO, along, apply, boost, dot, norm, scaled, subtract, unit
from motion import retarded
from tracer import SELF

COLOURED = ("temperature", "spectrum", "emission_color", "texture", "checker", "color_texture")


class Unsupported(ValueError):
    """The scene asks for colour that this reference does not compute."""


def gamma_between(frame, celerity, other, celerity_there):
    """Lorentz factor of two things that move in two frames."""
    def four(u):
        return [mp.sqrt(1 + dot(u, u))] + list(u)
    here = other.vector_from(frame, four(celerity))
    there = four(celerity_there)
    return here[0] * there[0] - dot(here[1:], there[1:])


class Searchlight:
    """The product F of the three switchable factors of docs/physics.md section 3."""

    def __init__(self, effects):
        mode = effects.get("searchlight", "exact")
        on = mode != "off"
        self.energy = effects.get("energy", on)
        self.rate = effects.get("rate", {"exact": "exact", "paper": "dilation", "off": "off"}[mode])
        self.solid_angle = effects.get("solid_angle", on)

    def plane_wave_factor(self, doppler, gamma):
        """What scales the irradiance of a plane wave: there is no solid angle to change."""
        energy = doppler if self.energy else ONE
        return energy * {"exact": doppler, "dilation": gamma, "off": ONE}[self.rate]

    def factor(self, doppler, gamma):
        """F for a Doppler factor and the Lorentz factor of the two frames' relative velocity."""
        return self.plane_wave_factor(doppler, gamma) * (doppler ** 2 if self.solid_angle else ONE)


class Shader:
    """Radiance of hits, carried to the camera."""

    def __init__(self, tracer):
        self.tracer, self.scene = tracer, tracer.scene
        self.searchlight = Searchlight(self.scene.effects)
        self.refusal = self._refusal()

    def _refusal(self):
        """Why the colours of this scene are not computed, or None."""
        scene = self.scene
        if scene.effects.get("doppler", True) and self._something_moves():
            return "doppler = true"
        if scene.effects.get("region"):
            return "effect regions"
        tables = [o.material for o in scene.objects] + [l.table for l in scene.lights]
        for table in tables + [scene.background]:
            if any(key in table for key in COLOURED):
                return "colour other than RGB reflectance"
        if any("color" in light.table for light in scene.lights) or "stars" in scene.background:
            return "coloured lights or stars"
        return None

    def _something_moves(self):
        """Whether any two frames in use move against each other."""
        used = [o.frame for o in self.scene.objects] + [l.frame for l in self.scene.lights]
        return any(f.gamma_relative_to(self.scene.camera.frame) > 1 for f in used)

    def film(self, hit, ray, light_delay):
        """(RGB film value of a traced camera ray, which lights reach the hit)."""
        if self.refusal:
            raise Unsupported(self.refusal)
        leg = (self.scene.camera.frame, [ZERO] * 3, ONE)
        return self._seen(hit, self.scene.camera.frame, ray, light_delay, leg, 0)

    def _seen(self, hit, frame, ray, light_delay, leg, passed):
        """The same along a ray of `frame`, which began at matter of leg = (frame, celerity, gamma of the legs before)."""
        if hit is None:
            return self._background(ray, frame, light_delay, leg), ()
        diffuse, highlight, reached = ZERO, ZERO, []
        for light in self.scene.lights:
            if light.kind == "ambient":
                diffuse += self.scene.number(light.table["radiance"])
                continue
            received, arriving = self._irradiance(light, hit)
            reached.append(received > 0)
            diffuse += received / mp.pi
            highlight += received * self._phong(hit, arriving)
        own = self.scene.number(hit.obj.material.get("emission", 0))
        colour = self._numbers(hit.obj.material.get("color", [0 if "mirror" in hit.obj.material else 1] * 3))
        factor, gamma = ONE, ONE
        if light_delay:
            gamma = leg[2] * gamma_between(hit.obj.frame, hit.celerity, leg[0], leg[1])
            factor = self.searchlight.factor(1 / abs(hit.ray[0]), gamma)
        rgb = [factor * (rho * diffuse + highlight + own) for rho in colour]
        if "mirror" in hit.obj.material and passed < self.scene.bounces:
            share = hit.obj.material["mirror"]
            share = self._numbers(share) if isinstance(share, list) else [self.scene.number(share)] * 3
            on = self.tracer.mirrored(hit, light_delay)
            further = self.tracer.nearest(hit.obj.frame, hit.event, on, SELF)
            seen, through = self._seen(further, hit.obj.frame, on, True, (hit.obj.frame, hit.celerity, gamma),
                                       passed + 1)
            rgb = [own_light + part * light for own_light, part, light in zip(rgb, share, seen)]
            reached += through
        return rgb, tuple(reached)

    def _phong(self, hit, arriving):
        """k (n + 2) / (2 pi) cos^n(alpha): alpha between the mirrored light and the viewer, rest frame."""
        share = self.scene.number(hit.obj.material.get("specular", 0))
        if share == 0:
            return ZERO
        exponent = self.scene.number(hit.obj.material.get("shininess", 50))
        incoming = unit(arriving[1:])
        mirrored = along(incoming, hit.normal, -2 * dot(incoming, hit.normal))
        cosine = -dot(mirrored, unit(hit.ray[1:]))
        return share * (exponent + 2) / (2 * mp.pi) * cosine ** exponent if cosine > 0 else ZERO

    def _numbers(self, values):
        """RGB of a table as mpf."""
        return self.scene.vector(values)

    def _background(self, ray, frame, light_delay, leg):
        """The background's colour at infinity, carried from its frame to the camera."""
        colour = self._numbers(self.scene.background.get("color", [0, 0, 0]))
        sky = self.scene.background_frame
        factor = ONE
        if light_delay:
            doppler = 1 / abs(self.tracer.carry(sky, frame, ray)[0])
            gamma = leg[2] * gamma_between(sky, [ZERO] * 3, leg[0], leg[1])
            factor = self.searchlight.factor(doppler, gamma)
        return scaled(colour, factor)

    def _irradiance(self, light, hit):
        """(irradiance, four-vector of its travel) of a hit by one light, in the rest frame, shadows included."""
        compute = {"point": self._from_point, "distant": self._from_infinity}[light.kind]
        return compute(light, hit)

    def _from_point(self, light, hit):
        """E = F I cos(theta) / r_O^2, from the retarded event of the light (section 4)."""
        frame = hit.obj.frame
        at_light = light.frame.event_from(frame, hit.event)
        emission = self._emission(light, at_light)
        if emission is None:
            return ZERO, [ONE, ONE, ZERO, ZERO]
        place, celerity, own_time = emission
        separation = subtract(at_light[1:], place)
        travel = [norm(separation)] + separation
        r_light = apply(boost(celerity), travel)[0]
        in_frame = self.tracer.carry(frame, light.frame, travel)
        arriving = apply(boost(hit.celerity), in_frame)
        r_object = arriving[0]
        cosine = -dot(hit.normal, arriving[1:]) / r_object
        if cosine <= 0 or self.tracer.blocked(frame, hit.event, scaled(in_frame, -ONE), ONE):
            return ZERO, arriving
        factor = self.searchlight.factor(r_object / r_light,
                                         gamma_between(frame, hit.celerity, light.frame, celerity))
        return factor * self._intensity(light, own_time / self.scene.c) * cosine / r_object ** 2, arriving

    @staticmethod
    def _emission(light, event):
        """(place, celerity, own time) of a light when what it sends arrives at an event, in its frame; or None."""
        if light.motion is None:
            return light.position, [ZERO] * 3, event[0] - norm(subtract(event[1:], light.position))
        left = retarded(light.motion, event)
        if left is None:
            return None
        time, place = left
        lamp = [ZERO] * 3
        return place, light.motion.celerity(lamp, time), light.motion.own_time(lamp, time)

    def _intensity(self, light, own_time):
        """Radiant intensity at the light's own time (scene units)."""
        value = light.table.get("intensity", 1)
        if not isinstance(value, str):
            return mpf(value)
        return evaluate_precisely(value, {k: mpf(v) for k, v in self.scene.variables.items()} | {"t": own_time})

    def _from_infinity(self, light, hit):
        """E = D^2 E_S cos(theta), the direction aberrated into the rest frame."""
        frame = hit.obj.frame
        in_frame = self.tracer.carry(frame, light.frame, [ONE] + light.direction)
        arriving = apply(boost(hit.celerity), in_frame)
        doppler = arriving[0]
        cosine = -dot(hit.normal, arriving[1:]) / doppler
        if cosine <= 0 or self.tracer.blocked(frame, hit.event, scaled(in_frame, -ONE), None):
            return ZERO, arriving
        factor = self.searchlight.plane_wave_factor(doppler, gamma_between(frame, hit.celerity, light.frame, [ZERO] * 3))
        return factor * self.scene.number(light.table["irradiance"]) * cosine, arriving
