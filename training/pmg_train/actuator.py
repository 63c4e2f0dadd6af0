"""Drives and transmissions, batched: src/sim/actuator_model.cpp in torch, with the same steps and effects.

src/model/actuator_parameters.hpp explains each parameter; test/data/training/actuators.json holds the results of the C++.
"""

import math

import torch

# The neutral value of each parameter, by group and key of motor.yaml.
NEUTRAL = {
    "command.delay_s": 0.0,
    "command.rate_limit_rad_s": math.inf,
    "command.hold_s": 0.0,
    "drive.kp_scale": 1.0,
    "drive.kd_scale": 1.0,
    "drive.limit": math.inf,
    "drive.dead_band_rad": 0.0,
    "drive.torque_per_unit_Nm": 1.0,
    "drive.back_emf_s_per_rad": 0.0,
    "drive.supply_sag_per_Nm": 0.0,
    "drive.brake_when_disabled": 0.0,
    "drive.stall_torque_Nm": math.inf,
    "drive.no_load_rad_s": math.inf,
    "sensor.zero_offset_rad": 0.0,
    "sensor.hysteresis_rad": 0.0,
    "sensor.eccentricity_rad": 0.0,
    "sensor.eccentricity_phase_rad": 0.0,
    "sensor.quantum_rad": 0.0,
    "sensor.lag_s": 0.0,
    "sensor.velocity_lag_s": 0.0,
    "transmission.armature_kg_m2": 0.0,
    "transmission.stiffness_Nm_per_rad": math.inf,
    "transmission.damping_Nm_s_per_rad": 0.0,
    "transmission.backlash_rad": 0.0,
    "friction.viscous_Nm_s_per_rad": 0.0,
    "friction.coulomb_Nm": 0.0,
    "friction.stribeck_Nm": 0.0,
    "friction.stribeck_rad_s": 0.1,
    "friction.load_driving": 0.0,
    "friction.load_backdriving": 0.0,
    "friction.asymmetry": 0.0,
    "friction.presliding_rad": 1e-3,
    "thermal.friction_per_K": 0.0,
    "thermal.torque_per_K": 0.0,
    "thermal.friction_per_Nm2_s": 0.0,
    "thermal.cooling_s": math.inf,
    "ripple.amplitude_Nm": 0.0,
    "ripple.order": 1.0,
    "ripple.phase_rad": 0.0,
    "ripple.offset_Nm": 0.0,
}
REFERENCE_TEMPERATURE_C = 25.0  # the parameters of friction and torque hold at this temperature


class ActuatorModel:
    """(worlds, joints) actuators. No branch depends on values, and every state tensor keeps its memory, so a CUDA graph can hold step()."""

    def __init__(self, parameters: list[dict[str, float]], step_s: float, worlds: int, device="cpu", dtype=torch.float32):
        """parameters: for each joint a map of the values that aren't neutral. ValueError for an unknown name."""
        unknown = sorted({name for joint in parameters for name in joint} - set(NEUTRAL))
        if unknown:
            raise ValueError(f"actuator parameters {unknown}; expected some of {', '.join(NEUTRAL)}")
        column = lambda name: torch.tensor([joint.get(name, NEUTRAL[name]) for joint in parameters], device=device, dtype=dtype)
        self.p = p = {name: column(name) for name in NEUTRAL}
        self.step_s = step_s
        self.elastic = torch.isfinite(p["transmission.stiffness_Nm_per_rad"])
        self.lagging, self.velocity_lagging = p["sensor.lag_s"] > 0, p["sensor.velocity_lag_s"] > 0
        self.torque_speed = torch.isfinite(p["drive.stall_torque_Nm"])
        # Joints without the effect get a finite value, which keeps NaN out of unused results.
        self.stall = torch.where(self.torque_speed, p["drive.stall_torque_Nm"], 1.0)
        self.stiffness = torch.where(self.elastic, p["transmission.stiffness_Nm_per_rad"], 0.0)
        steps = p["command.delay_s"] / step_s
        ages = torch.arange(int(float(steps.max())) + 2, device=device, dtype=dtype)[:, None]
        whole = torch.trunc(steps)
        share = steps - whole
        self.ages = torch.where(ages == whole, 1 - share, torch.where(ages == whole + 1, share, 0.0))[:, None, None]
        state = lambda: torch.zeros(worlds, len(parameters), device=device, dtype=dtype)
        # The drive's commands, newest first: q_des, dq_des, kp, kd, feed forward.
        self.past = torch.stack([torch.stack([state() for _ in range(5)]) for _ in range(len(ages))])
        self.told_before = torch.zeros(worlds, 1, device=device, dtype=torch.bool)
        self.command, self.held_for, self.held_output = (state() for _ in range(3))
        self.lagged, self.sensed_before, self.lagged_speed = (state() for _ in range(3))
        self.sensor_at, self.heat, self.driven = (state() for _ in range(3))
        self.bristle, self.load, self.rotor, self.rotor_speed = (state() for _ in range(4))
        self.given_torque, self.given_slope, self.given_at = (state() for _ in range(3))

    def reset(self, q: torch.Tensor, where: torch.Tensor | None = None) -> None:
        """At rest at q [rad] (worlds, joints); where (worlds,) bool, or everywhere. Commands before the first step count as equal to the
        first one, with q as position."""
        mask = torch.ones_like(q[:, :1], dtype=torch.bool) if where is None else where[:, None]
        put = lambda state, value: state.copy_(torch.where(mask, value, state))
        put(self.sensor_at, q)
        reading = self.reading(q)
        self.told_before.logical_and_(~mask)
        for state in (self.command, self.lagged, self.sensed_before):
            put(state, reading)
        put(self.held_for, (self.p["command.hold_s"] - self.step_s).expand_as(q))
        put(self.rotor, q)
        for state in (
            self.held_output,
            self.lagged_speed,
            self.bristle,
            self.load,
            self.rotor_speed,
            self.given_torque,
            self.given_slope,
            self.given_at,
            self.heat,
            self.driven,
        ):
            put(state, torch.zeros_like(q))

    def momentary(self) -> dict[str, torch.Tensor]:
        """The whole state, which changes from step to step."""
        names = (
            "past",
            "told_before",
            "command",
            "held_for",
            "held_output",
            "lagged",
            "sensed_before",
            "lagged_speed",
            "sensor_at",
            "heat",
            "driven",
            "bristle",
            "load",
            "rotor",
            "rotor_speed",
            "given_torque",
            "given_slope",
            "given_at",
        )
        return {name: getattr(self, name) for name in names}

    def reading(self, q: torch.Tensor) -> torch.Tensor:
        """(joint angles q [rad]) => the angles that the drives report [rad]."""
        p, seen, quantum = self.p, self._followed(q), self.p["sensor.quantum_rad"]
        reading = seen + p["sensor.zero_offset_rad"] + p["sensor.eccentricity_rad"] * torch.sin(seen + p["sensor.eccentricity_phase_rad"])
        some = torch.where(quantum > 0, quantum, 1.0)
        return torch.where(quantum > 0, some * torch.sign(reading) * torch.floor((reading / some).abs() + 0.5), reading)

    def _followed(self, q: torch.Tensor) -> torch.Tensor:
        """The angle of the sensor's side of its play [rad]. It stays until the joint moves it."""
        half = 0.5 * self.p["sensor.hysteresis_rad"]
        return torch.maximum(torch.minimum(self.sensor_at, q + half), q - half)

    def step(
        self, q_des, kp, kd, q, dq, dq_des=0.0, feed_forward_Nm=0.0, supply=1.0, enabled=True, temperature_C=REFERENCE_TEMPERATURE_C
    ) -> tuple[torch.Tensor, torch.Tensor]:
        """Torque [Nm] and its slope in the joint's speed [Nm s/rad] during the step that begins at (q, dq)."""
        p, h = self.p, self.step_s
        motor_speed, motor_angle = torch.where(self.elastic, self.rotor_speed, dq), torch.where(self.elastic, self.rotor, q)
        most = p["friction.presliding_rad"]
        self.bristle.copy_(torch.minimum(torch.maximum(self.bristle + h * motor_speed, -most), most))
        carried = self.given_torque + (self.given_slope - p["transmission.armature_kg_m2"] / h) * (dq - self.given_at)
        self.load.copy_(torch.where(self.elastic, self.load, carried))
        friction_factor, torque_factor = self._warm(temperature_C)
        unit = p["drive.torque_per_unit_Nm"] * torque_factor
        torque, slope = self._drive(q_des, kp, kd, q, motor_speed, dq_des, feed_forward_Nm, supply, enabled, unit)
        self.driven.copy_(torque)
        dry, dry_slope = self._dry_friction(motor_speed, friction_factor)
        viscous = p["friction.viscous_Nm_s_per_rad"] * friction_factor
        torque = torque + dry - viscous * motor_speed + p["ripple.offset_Nm"]
        torque = torque + p["ripple.amplitude_Nm"] * torch.sin(p["ripple.order"] * motor_angle + p["ripple.phase_rad"])
        slope = slope + dry_slope - viscous
        elastic_torque, elastic_slope = self._elastic(torque, slope, q, dq)
        self.given_torque.copy_(torch.where(self.elastic, elastic_torque, torque))
        self.given_slope.copy_(torch.where(self.elastic, elastic_slope, slope))
        self.given_at.copy_(dq)
        return self.given_torque, self.given_slope

    def _warm(self, temperature_C) -> tuple[torch.Tensor, torch.Tensor]:
        """The factors of friction and of torque per unit at this temperature and heat."""
        p, above = self.p, temperature_C - REFERENCE_TEMPERATURE_C
        self.heat.add_(self.step_s * (self.driven**2 - self.heat / p["thermal.cooling_s"]))
        return (
            torch.exp(p["thermal.friction_per_K"] * above + p["thermal.friction_per_Nm2_s"] * self.heat),
            (1 + p["thermal.torque_per_K"] * above).clamp(min=0),
        )

    def _told(self, *now) -> torch.Tensor:
        """The delayed command, interpolated linearly between two steps."""
        told = torch.stack([x.expand_as(self.command) if isinstance(x, torch.Tensor) else torch.full_like(self.command, x) for x in now])
        before = torch.cat([self.command[None], told[1:]])
        self.past.copy_(torch.where(self.told_before, self.past, before))
        self.told_before.fill_(True)
        self.past.copy_(torch.cat([told[None], self.past[:-1]]))
        return (self.ages * self.past).sum(0)

    def _limited(self, q_des: torch.Tensor) -> torch.Tensor:
        most = self.p["command.rate_limit_rad_s"] * self.step_s
        return self.command + torch.minimum(torch.maximum(q_des - self.command, -most), most)

    def _sensed(self, q: torch.Tensor) -> torch.Tensor:
        self.sensor_at.copy_(self._followed(q))
        reading, lag = self.reading(q), self.p["sensor.lag_s"]
        self.lagged.add_(self.step_s / (lag + self.step_s) * (reading - self.lagged))
        return torch.where(self.lagging, self.lagged, reading)

    def _sensed_speed(self, dq: torch.Tensor) -> torch.Tensor:
        self.lagged_speed.add_(self.step_s / (self.p["sensor.velocity_lag_s"] + self.step_s) * (dq - self.lagged_speed))
        return torch.where(self.velocity_lagging, self.lagged_speed, dq)

    def _drive(self, q_des, kp, kd, q, dq, dq_des, feed_forward_Nm, supply, enabled, unit) -> tuple[torch.Tensor, torch.Tensor]:
        p = self.p
        q_des, dq_des, kp, kd, feed_forward_Nm = self._told(q_des, dq_des, kp, kd, feed_forward_Nm)
        self.command.copy_(self._limited(q_des))
        sensed = self._sensed(q)
        dq_sensed = self._sensed_speed(torch.where(self.lagging, (sensed - self.sensed_before) / self.step_s, dq))
        self.sensed_before.copy_(sensed)
        if enabled:
            # Newton metres under every law: the drive divides by its torque constant at the reference temperature and by its supply.
            forward = feed_forward_Nm / (p["drive.torque_per_unit_Nm"] * supply)
            wish = p["drive.kp_scale"] * kp * self._error(sensed) + p["drive.kd_scale"] * kd * (dq_des - dq_sensed) + forward
            return self._powered(wish, kd, supply, dq, unit)
        brake = (p["drive.brake_when_disabled"] * unit * p["drive.back_emf_s_per_rad"]).expand_as(dq)
        return -brake * dq, -brake

    def _error(self, sensed: torch.Tensor) -> torch.Tensor:
        error = self.command - sensed
        return torch.where(error.abs() < self.p["drive.dead_band_rad"], 0.0, error)

    def _powered(self, wish, kd, supply, dq, unit) -> tuple[torch.Tensor, torch.Tensor]:
        """(the drive's output) => the motor's torque [Nm] and its slope [Nm s/rad]."""
        p, h = self.p, self.step_s
        back_emf, hold = p["drive.back_emf_s_per_rad"], p["command.hold_s"]
        held_for = self.held_for + h
        due = held_for >= hold - 1e-4 * h  # a tolerance for single precision
        self.held_for.copy_(torch.where(due, (held_for - hold).clamp(max=h), held_for))
        within = torch.minimum(torch.maximum(wish, -p["drive.limit"]), p["drive.limit"])
        self.held_output.copy_(torch.where(due, within, self.held_output))
        follows_speed = due & ~self.lagging & ~self.velocity_lagging & (within == wish) & (hold <= h)
        # A bridge takes duty times the motor's current from the bus.
        unit = unit / (1 + p["drive.supply_sag_per_Nm"] * unit * supply * (self.held_output / p["drive.limit"]) ** 2)
        scale = unit * supply
        torque = scale * self.held_output - unit * back_emf * dq
        slope = -unit * back_emf - torch.where(follows_speed, scale * p["drive.kd_scale"] * kd, 0.0)
        return self._within_torque_speed_line(torque, slope, dq)

    def _within_torque_speed_line(self, torque, slope, dq) -> tuple[torch.Tensor, torch.Tensor]:
        no_load = self.p["drive.no_load_rad_s"]
        along = torch.where(torque >= 0, 1.0, -1.0).to(torque.dtype)
        line = self.stall * (1 - along * dq / no_load)
        available = torch.minimum(line.clamp(min=0), self.stall)
        too_much = self.torque_speed & (along * torque > available)
        on_slope = (available > 0) & (available < self.stall)
        return (torch.where(too_much, along * available, torque), torch.where(too_much, torch.where(on_slope, -self.stall / no_load, 0.0), slope))

    def _dry_friction(self, dq: torch.Tensor, factor: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        p = self.p
        bend = self.bristle + self.step_s * dq
        direction = torch.where(bend >= 0, 1.0, -1.0).to(bend.dtype)
        most = p["friction.coulomb_Nm"] + p["friction.stribeck_Nm"] * torch.exp(-((dq / p["friction.stribeck_rad_s"]) ** 2))
        share = torch.where(self.load * direction > 0, p["friction.load_driving"], p["friction.load_backdriving"])
        most = (most + share * self.load.abs()) * factor * (1 + p["friction.asymmetry"] * direction)
        slides = bend.abs() >= p["friction.presliding_rad"]
        stiffness = most / p["friction.presliding_rad"]
        return torch.where(slides, -direction * most, -stiffness * bend), torch.where(slides, 0.0, -stiffness * self.step_s)

    def _elastic(self, torque, slope, q, dq) -> tuple[torch.Tensor, torch.Tensor]:
        """Torque on a joint from a rotor behind a spring with play, and its slope. Moves the rotor. Unused for rigid joints."""
        p, h = self.p, self.step_s
        before, before_slope = self._shaft(self.rotor, self.rotor_speed, q, dq)
        inertia = p["transmission.armature_kg_m2"] / h - slope + before_slope
        speed = self.rotor_speed + (torque - before) / torch.where(self.elastic, inertia, 1.0)
        after, after_slope = self._shaft(self.rotor, speed, q, dq)
        self.rotor_speed.copy_(torch.where(self.elastic, speed, dq))
        self.rotor.copy_(torch.where(self.elastic, self.rotor + h * speed, q))
        self.load.copy_(torch.where(self.elastic, after, self.load))
        return after, -after_slope

    def _shaft(self, rotor, rotor_speed, q, dq) -> tuple[torch.Tensor, torch.Tensor]:
        """Torque on the joint and its slope in the relative speed."""
        half_play, damping = 0.5 * self.p["transmission.backlash_rad"], self.p["transmission.damping_Nm_s_per_rad"]
        relative = rotor_speed - dq
        twist = rotor - q + self.step_s * relative
        wound = twist - torch.minimum(torch.maximum(twist, -half_play), half_play)
        grips = wound != 0
        return (torch.where(grips, self.stiffness * wound + damping * relative, 0.0), torch.where(grips, self.stiffness * self.step_s + damping, 0.0))
