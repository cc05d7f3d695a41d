"""Brightness without colour: Lambert surfaces, white lights, the searchlight factors.

Covers what can be said exactly per RGB channel: materials with `color` or `checker`, white highlights, `emission`,
mirrors and glass, lights without colour, `doppler = false`. Anything else raises `Unsupported` and the colour is then left out.
"""
from mpmath import mp, mpf

from glass import is_glass
from minkowski import ONE, ZERO, along, apply, boost, dot, norm, scaled, subtract, unit
from motion import retarded
from tracer import SELF

COLOURED = ("temperature", "spectrum", "emission_spectrum", "lines", "texture")
HALF_STEP = 1 / (2 * 255 * mpf("12.92"))  # of an 8-bit screen at black


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
        self.faintest = HALF_STEP / self._brightest()

    def _brightest(self):
        """The brightest light that is known beforehand, at least 1: section 12."""
        shining = [(o.frame, self.scene.at_own_time(chain[-1].material.get("emission", 0), ZERO))
                   for o in self.scene.objects for chain in [o.body.whole.leaves()[0][:1]] if chain[-1].material]
        shining.append((self.scene.background_frame, max(self._numbers(self.scene.background.get("color", [0])))))
        brightest = ONE
        for frame, radiance in shining:
            gamma = frame.gamma_relative_to(self.scene.camera.frame)
            factor = self.searchlight.factor(gamma + mp.sqrt(max(ZERO, gamma * gamma - 1)), gamma)
            brightest = max(brightest, radiance * (factor if self.scene.effects.get("light_delay", True) else ONE))
        return brightest

    def _refusal(self):
        """Why the colours of this scene are not computed, or None."""
        scene = self.scene
        if scene.effects.get("doppler", True) and self._something_moves():
            return "doppler = true"
        if scene.effects.get("region"):
            return "effect regions"
        tables = [chain[-1].material or {} for o in scene.objects for chain in o.body.whole.leaves()]
        tables += [o.material for o in scene.objects] + [l.table for l in scene.lights]
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
        return self._seen(hit, self.scene.camera.frame, ray, light_delay, leg, 0, [ONE] * 3)

    def _seen(self, hit, frame, ray, light_delay, leg, passed, weight):
        """The same along a ray of `frame`, which began at matter of leg = (frame, celerity, gamma of the legs before);
        weight: the share of it that reaches the camera."""
        if hit is None:
            return self._background(ray, frame, light_delay, leg), ()
        factor, gamma = ONE, ONE
        if light_delay:
            gamma = leg[2] * gamma_between(hit.obj.frame, hit.celerity, leg[0], leg[1])
            factor = self.searchlight.factor(1 / hit.frequency(), gamma)
        own, reached = self._own_light(hit)
        rgb = scaled(own, factor)
        left = self.tracer.glasses.left(hit.glass, hit.s * norm(hit.ray[1:]))
        weight = [w * share for w, share in zip(weight, left)]
        for share, on, glass in self.tracer.passed_on(hit, light_delay):
            followed = passed < self.scene.bounces and (not is_glass(hit.obj) or
                                                        share[0] * max(weight) > self.faintest)
            reached += (followed,)
            if not followed:
                continue
            further = self.tracer.nearest(hit.obj.frame, hit.event, on, SELF, glass)
            seen, through = self._seen(further, hit.obj.frame, on, True, (hit.obj.frame, hit.celerity, gamma),
                                       passed + 1, [w * part for w, part in zip(weight, share)])
            rgb = [light + part * more for light, part, more in zip(rgb, share, seen)]
            reached += (further.signature() if further else None,) + through
        return [light * share for light, share in zip(rgb, left)], reached

    def _own_light(self, hit):
        """(radiance that the matter sends out by itself, which lights reach it)."""
        diffuse, highlight, reached = [ZERO] * 3, [ZERO] * 3, ()
        for light in self.scene.lights:
            if light.kind == "ambient":
                strength = self.scene.at_own_time(light.table.get("radiance", 1), hit.event[0])
                diffuse = [d + strength for d in diffuse]
                continue
            received, arriving = self._irradiance(light, hit)
            reached += (max(received) > 0,)
            lobe = self._phong(hit, arriving)
            diffuse = [d + e / mp.pi for d, e in zip(diffuse, received)]
            highlight = [h + e * lobe for h, e in zip(highlight, received)]
        number = lambda value: self.scene.at_own_time(value, hit.own_time)
        own = [max(ZERO, number(hit.material.get("emission", 0)))] * 3
        if "emission_color" in hit.material:
            own = [e * max(ZERO, number(c)) for e, c in zip(own, hit.material["emission_color"])]
        rgb = [rho * d + h + e for rho, d, h, e in zip(self._reflectance(hit), diffuse, highlight, own)]
        return rgb, reached

    def _reflectance(self, hit):
        """The diffuse one of red, green and blue."""
        if "checker" in hit.material:
            colour = hit.material["checker"]["colors"][hit.square()]
        else:
            grey = 0 if "mirror" in hit.material or "glass" in hit.material else 0.8
            colour = hit.material.get("color", [grey] * 3)
        return [min(ONE, max(ZERO, self.scene.at_own_time(c, hit.own_time))) for c in colour]

    def _phong(self, hit, arriving):
        """k (n + 2) / (2 pi) cos^n(alpha): alpha between the mirrored light and the viewer, rest frame."""
        number = lambda value: self.scene.at_own_time(value, hit.own_time)
        share = min(ONE, max(ZERO, number(hit.material.get("specular", 0))))
        if share == 0:
            return ZERO
        exponent = number(hit.material.get("shininess", 50))
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
        """(irradiance of each colour, four-vector of its travel) of a hit by one light, in the rest frame, shadows and
        glass in its way included."""
        compute = {"point": self._from_point, "spot": self._from_point, "distant": self._from_infinity}[light.kind]
        return compute(light, hit)

    def _from_point(self, light, hit):
        """E = F I cos(theta) / r_O^2, from the retarded event of the light (section 4)."""
        frame = hit.obj.frame
        at_light = light.frame.event_from(frame, hit.event)
        emission = self._emission(light, at_light)
        if emission is None:
            return [ZERO] * 3, [ONE, ONE, ZERO, ZERO]
        place, celerity, own_time = emission
        separation = subtract(at_light[1:], place)
        travel = [norm(separation)] + separation
        at_lamp = apply(boost(celerity), travel)
        r_light = at_lamp[0]
        in_frame = self.tracer.carry(frame, light.frame, travel)
        arriving = apply(boost(hit.celerity), in_frame)
        r_object = arriving[0]
        cosine = -dot(hit.normal, arriving[1:]) / r_object
        strength = self._intensity(light, own_time) * self._cone(light, unit(at_lamp[1:]))
        left = self._left(light, hit, in_frame, ONE) if cosine > 0 and strength > 0 else None
        if left is None:
            return [ZERO] * 3, arriving
        factor = self.searchlight.factor(r_object / r_light,
                                         gamma_between(frame, hit.celerity, light.frame, celerity))
        return scaled(left, factor * strength * cosine / r_object ** 2), arriving

    def _left(self, light, hit, travel, end):
        """The shares of a lamp's light that reach a hit; None of none."""
        if not light.table.get("shadows", True):
            return [ONE] * 3
        return self.tracer.light_left(hit.obj.frame, hit.event, scaled(travel, -ONE), end)

    def _cone(self, light, leaving):
        """The share that a spot lamp sends in a direction of its own frame (equation 12a)."""
        if light.kind != "spot":
            return ONE
        half = mp.radians(self.scene.number(light.table.get("angle", 60))) / 2
        edge = self.scene.number(light.table.get("edge", 0))
        off = mp.acos(min(ONE, max(-ONE, dot(leaving, light.direction))))
        if edge == 0:
            return ONE if off < half else ZERO
        s = min(ONE, max(ZERO, (half - off) / (edge * half)))
        return s * s * (3 - 2 * s)

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
        return max(ZERO, self.scene.at_own_time(light.table.get("intensity", 1), own_time))

    def _from_infinity(self, light, hit):
        """E = D^2 E_S cos(theta), the direction aberrated into the rest frame."""
        frame = hit.obj.frame
        in_frame = self.tracer.carry(frame, light.frame, [ONE] + light.direction)
        arriving = apply(boost(hit.celerity), in_frame)
        doppler = arriving[0]
        cosine = -dot(hit.normal, arriving[1:]) / doppler
        left = self._left(light, hit, in_frame, None) if cosine > 0 else None
        if left is None:
            return [ZERO] * 3, arriving
        factor = self.searchlight.plane_wave_factor(doppler, gamma_between(frame, hit.celerity, light.frame, [ZERO] * 3))
        front = light.frame.event_from(frame, hit.event)
        sent = front[0] - dot(light.direction, front[1:])
        strength = max(ZERO, self.scene.at_own_time(light.table.get("irradiance", 1), sent))
        return scaled(left, factor * strength * cosine), arriving
