"""Batched gears: friction, shafts, warmth (src/actuator: gear_friction.hpp, shaft.cpp, warmth.cpp)."""

import torch

from pmg_train.actuator_drive import clamped
from pmg_train.actuator_parameters import REFERENCE_TEMPERATURE_C
from pmg_train.actuator_state import States, has


class GearFriction:
    """Friction on one side of a transmission."""

    def __init__(self, p: dict, step_s: float, states: States, side: str):
        self.p, self.step_s, self.bristle = p, step_s, states.new(f"{side}_bristle")
        self.stribeck, self.asymmetric = has(p, "friction.stribeck_Nm"), has(p, "friction.asymmetry")
        self.plain_viscous = not has(p, "friction.viscous_quadratic_Nm_s2_per_rad2", "friction.viscous_asymmetry")
        self.by_load = has(p, "friction.load_driving", "friction.load_backdriving")
        self.more = None  # pmg_train.residual_torque.Given of this step

    def reset(self, put) -> None:
        put(self.bristle, torch.zeros_like(self.bristle))

    def bend(self, dq) -> None:
        """Once a step, before step(): the bristle takes part in the motion of the step before."""
        self.bristle.copy_(clamped(self.bristle + self.step_s * dq, self.p["friction.presliding_rad"]))

    def sticks(self) -> torch.Tensor:
        """Whether dry friction holds: the bristle bends and does not slide."""
        return self.bristle.abs() < self.p["friction.presliding_rad"]

    def step(self, dq, load, dry_factor, viscous_factor) -> tuple[torch.Tensor, torch.Tensor]:
        """Torque [Nm] and its slope in the speed."""
        p, h, presliding = self.p, self.step_s, self.p["friction.presliding_rad"]
        bend = self.bristle + h * dq
        direction = torch.where(bend >= 0, 1.0, -1.0).to(bend.dtype)
        most = self._most_dry(dq, direction, load) * dry_factor
        sliding_slope = torch.zeros_like(dq)
        if self.more is not None:
            # A joint whose file has no residual torque keeps its friction to the bit.
            most = torch.where(self.more.has, (most + self.more.friction).clamp(min=0), most)
            sliding_slope = -self.more.friction_slope
        slides, stiffness = bend.abs() >= presliding, most / presliding
        dry, dry_slope = torch.where(slides, -direction * most, -stiffness * bend), torch.where(slides, sliding_slope, -stiffness * h)
        linear = p["friction.viscous_Nm_s_per_rad"] * viscous_factor
        if self.plain_viscous:
            return dry - linear * dq, dry_slope - linear
        square = p["friction.viscous_quadratic_Nm_s2_per_rad2"] * viscous_factor * dq.abs()
        scale = 1 + p["friction.viscous_asymmetry"] * torch.where(dq >= 0, 1.0, -1.0).to(dq.dtype)
        return dry - scale * (linear + square) * dq, dry_slope - scale * (linear + 2 * square)

    def _most_dry(self, dq, direction, load) -> torch.Tensor:
        p, most = self.p, self.p["friction.coulomb_Nm"]
        if self.stribeck:
            ratio = (dq / p["friction.stribeck_rad_s"]).abs()
            stribeck = p["friction.stribeck_Nm"] * torch.exp(-(ratio ** p["friction.stribeck_exponent"]))
            most = most + stribeck * (1 + p["friction.stribeck_asymmetry"] * direction)
        if self.by_load:
            share = torch.where(load * direction > 0, p["friction.load_driving"], p["friction.load_backdriving"])
            most = most + share * load.abs()
        return most * (1 + p["friction.asymmetry"] * direction) if self.asymmetric else most


class Shaft:
    """A rotor behind a shaft that winds, with free play. Unused for rigid joints, whose rotor goes with them."""

    def __init__(self, p: dict, step_s: float, states: States):
        self.p, self.step_s = p, step_s
        self.elastic = torch.isfinite(p["transmission.stiffness_Nm_per_rad"])
        self.used = bool(self.elastic.any())
        self.stiffness = torch.where(self.elastic, p["transmission.stiffness_Nm_per_rad"], 0.0)
        self.rotor, self.rotor_speed = states.new("rotor"), states.new("rotor_speed")
        self.belt = has(p, "transmission.hysteretic_share")
        self.wound, self.bend = states.new("wound"), states.new("belt_bend")

    def reset(self, put, q) -> None:
        put(self.rotor, q)
        for state in (self.rotor_speed, self.wound, self.bend):
            put(state, torch.zeros_like(q))

    def step(self, torque, slope, q, dq) -> tuple[torch.Tensor, torch.Tensor]:
        """(the motor's torque and slope, the joint's angle and speed) => torque on the joint and its slope. Moves the rotor."""
        p, h = self.p, self.step_s
        if self.belt:
            now = self._wound(self.rotor - q)
            self.bend.copy_(self._bend(now))
            self.wound.copy_(now)
        before, before_slope = self._torque(self.rotor_speed, q, dq)
        inertia = p["transmission.armature_kg_m2"] / h - slope + before_slope
        speed = self.rotor_speed + (torque - before) / torch.where(self.elastic, inertia, 1.0)
        after, after_slope = self._torque(speed, q, dq)
        self.rotor_speed.copy_(torch.where(self.elastic, speed, dq))
        self.rotor.copy_(torch.where(self.elastic, self.rotor + h * speed, q))
        return after, -after_slope

    def _wound(self, twist) -> torch.Tensor:
        """The twist beyond the play."""
        return twist - clamped(twist, 0.5 * self.p["transmission.backlash_rad"])

    def _bend(self, wound) -> torch.Tensor:
        """The bend of a belt that has wound evenly from where it was to here."""
        most = torch.copysign(self.p["transmission.hysteresis_rad"], wound - self.wound)
        return most + (self.bend - most) * torch.exp(-(wound - self.wound).abs() / self.p["transmission.hysteresis_rad"])

    def _torque(self, rotor_speed, q, dq) -> tuple[torch.Tensor, torch.Tensor]:
        """Torque on the joint and its slope in the relative speed."""
        p, damping = self.p, self.p["transmission.damping_Nm_s_per_rad"]
        relative = rotor_speed - dq
        wound = self._wound(self.rotor - q + self.step_s * relative)
        square = p["transmission.hardening_Nm_per_rad3"] * wound**2
        torque, slope = (self.stiffness + square) * wound + damping * relative, (self.stiffness + 3 * square) * self.step_s + damping
        grips = wound != 0
        if self.belt:
            bend, share = self._bend(wound), p["transmission.hysteretic_share"] * self.stiffness
            torque = torque + share * (bend - wound)
            slope = slope - share * bend / torch.copysign(p["transmission.hysteresis_rad"], wound - self.wound) * self.step_s
            grips = grips | ((self.bend != 0) & (p["transmission.backlash_rad"] == 0))
        return torch.where(grips, torque, 0.0), torch.where(grips, slope, 0.0)


class Warmth:
    """What temperature, heat and time make of friction and torque."""

    def __init__(self, p: dict, step_s: float, states: States):
        self.p, self.step_s = p, step_s
        self.used = has(p, *(name for name in p if name.startswith("thermal.")))
        self.heat, self.work, self.faded = states.new("heat"), states.new("friction_work"), states.new("faded")
        self.kept = torch.exp(-step_s / p["thermal.torque_fade_s"])

    def reset(self, put) -> None:
        for state in (self.heat, self.work, self.faded):
            put(state, torch.zeros_like(state))

    def factors(self, temperature_C) -> tuple:
        """Of dry friction, viscous friction and torque per unit."""
        if not self.used:
            return 1.0, 1.0, 1.0
        p, above = self.p, temperature_C - REFERENCE_TEMPERATURE_C
        dry = torch.exp(p["thermal.friction_per_K"] * above + p["thermal.friction_per_Nm2_s"] * self.heat + p["thermal.friction_per_J"] * self.work)
        torque = (1 + p["thermal.torque_per_K"] * above).clamp(min=0) / (1 + p["thermal.resistance_per_K"] * above).clamp(min=0.1)
        torque = torque * (1 + p["thermal.torque_per_Nm2_s"] * self.heat).clamp(min=0) * (1 - p["thermal.torque_fade_share"] * self.faded)
        return dry, dry * torch.exp(p["thermal.viscous_per_K"] * above), torque

    def passes(self, motor_Nm, friction_W) -> None:
        """A step, in which the motor gave that torque and friction dissipated that power."""
        if not self.used:
            return
        self.heat.add_(self.step_s * (motor_Nm**2 - self.heat / self.p["thermal.cooling_s"]))
        self.work.add_(self.step_s * friction_W)
        self.faded.copy_(1 - (1 - self.faded) * self.kept)
