"""Drives and transmissions, batched: src/sim/actuator_model.cpp in torch, with the same steps and effects.

src/model/actuator_parameters.hpp explains each parameter; test/data/training/actuators.json holds the results of the C++.
"""

import torch

from pmg_train.actuator_drive import AngleSensor, CommandPath, ControlLaw
from pmg_train.actuator_gear import GearFriction, Shaft, Warmth
from pmg_train.actuator_motor import MotorTorque
from pmg_train.actuator_parameters import NEUTRAL, REFERENCE_TEMPERATURE_C
from pmg_train.actuator_state import States, has
from pmg_train.residual_torque import Given, ResidualTorque


class ActuatorModel:
    """(worlds, joints) actuators. No branch depends on values, and every state tensor keeps its memory, so a CUDA graph can hold step()."""

    def __init__(self, parameters: list[dict[str, float]], step_s: float, worlds: int, device="cpu", dtype=torch.float32):
        """parameters: for each joint a map of the values that aren't neutral; `residual_torque` is a map itself. ValueError for an
        unknown name."""
        unknown = sorted({name for joint in parameters for name in joint} - set(NEUTRAL) - {"residual_torque"})
        if unknown:
            raise ValueError(f"actuator parameters {unknown}; expected some of {', '.join(NEUTRAL)}")
        column = lambda name: torch.tensor([joint.get(name, NEUTRAL[name]) for joint in parameters], device=device, dtype=dtype)
        self.p = p = {name: column(name) for name in NEUTRAL}
        self.step_s = step_s
        self.states = states = States(worlds, len(parameters), device, dtype)
        self.command, self.sensor = CommandPath(p, step_s, states), AngleSensor(p, step_s, states)
        self.law, self.motor = ControlLaw(p, step_s, states), MotorTorque(p, step_s, states)
        self.friction, self.shaft = GearFriction(p, step_s, states, "motor"), Shaft(p, step_s, states)
        self.joint_friction, self.warmth = GearFriction(p, step_s, states, "joint"), Warmth(p, step_s, states)
        on_device = lambda values: torch.tensor(values, device=device, dtype=dtype)
        self.residual = ResidualTorque([joint.get("residual_torque") for joint in parameters], step_s, states, on_device)
        self.elastic = self.shaft.elastic
        self.on_joint = torch.where(self.elastic, p["transmission.friction_on_joint"], 0.0)
        self.turns = torch.where(self.elastic, p["sensor.on_motor"], 0.0)
        self.rubs_on_joint, self.sensor_turns = bool((self.on_joint > 0).any()), bool((self.turns > 0).any())
        self.by_load = has(p, "friction.load_driving", "friction.load_backdriving")
        self.ripples = has(p, "ripple.amplitude_Nm", "ripple.torque_share", "ripple.second_Nm", "ripple.offset_Nm", "ripple.spring_Nm_per_rad")
        self.other_load = has(p, "friction.load_by_motor", "friction.load_net")
        self.load = states.new("load")
        self.given_torque, self.given_slope, self.given_at = (states.new(f"given_{name}") for name in ("torque", "slope", "at"))

    def reset(self, q: torch.Tensor, where: torch.Tensor | None = None) -> None:
        """At rest at q [rad] (worlds, joints); where (worlds,) bool, or everywhere. Commands before the first step count as equal to the
        first one, with q as position."""
        mask = torch.ones_like(q[:, :1], dtype=torch.bool) if where is None else where[:, None]
        put = lambda state, value: state.copy_(torch.where(mask, value, state))
        self.shaft.reset(put, q)
        self.sensor.reset(put, q)
        self.command.reset(put, self.reading(q), mask)
        self.motor.reset(put, mask)
        for stage in (self.law, self.friction, self.joint_friction, self.warmth, self.residual):
            stage.reset(put)
        for state in (self.load, self.given_torque, self.given_slope, self.given_at):
            put(state, torch.zeros_like(q))

    def momentary(self) -> dict[str, torch.Tensor]:
        """The whole state, which changes from step to step."""
        return dict(self.states.by_name)

    def reading(self, q: torch.Tensor) -> torch.Tensor:
        """(joint angles q [rad]) => the angles that the drives report [rad]."""
        return self.sensor.reading(self._sensed(q))

    def _sensed(self, q: torch.Tensor) -> torch.Tensor:
        return q + self.turns * (self.shaft.rotor - q) if self.sensor_turns else q

    def step(
        self, q_des, kp, kd, q, dq, dq_des=0.0, feed_forward_Nm=0.0, supply=1.0, enabled=True, temperature_C=REFERENCE_TEMPERATURE_C, external_Nm=0.0
    ) -> tuple[torch.Tensor, torch.Tensor]:
        """Torque [Nm] and its slope in the joint's speed [Nm s/rad] during the step that begins at (q, dq). external_Nm: what else turns the
        joint; only friction.load_net asks for it."""
        p, h = self.p, self.step_s
        speed, angle = dq, q
        if self.shaft.used:
            speed, angle = torch.where(self.elastic, self.shaft.rotor_speed, dq), torch.where(self.elastic, self.shaft.rotor, q)
        if self.by_load:
            carried = self.given_torque + (self.given_slope - p["transmission.armature_kg_m2"] / h) * (dq - self.given_at)
            self.load.copy_(torch.where(self.elastic, self.load, carried))
        dry_factor, viscous_factor, torque_factor = self.warmth.factors(temperature_C)
        unit = p["drive.torque_per_unit_Nm"] * p["drive.torque_scale"] * torque_factor
        driven, driven_slope = self._drive((q_des, dq_des, kp, kd, feed_forward_Nm), q, speed, supply, enabled, unit)
        motor, motor_slope = driven, driven_slope
        self.friction.bend(speed)
        if self.residual.acts:
            turned = self._residual(kp, supply, enabled, temperature_C, angle, speed, driven)
            motor, motor_slope = motor + turned.torque, motor_slope + turned.slope
        if self.ripples:
            wave = torch.sin(p["ripple.order"] * angle + p["ripple.phase_rad"])
            motor = motor + p["ripple.second_Nm"] * torch.sin(2 * p["ripple.order"] * angle + p["ripple.second_phase_rad"])
            motor = motor - p["ripple.spring_Nm_per_rad"] * angle
            motor = motor + p["ripple.offset_Nm"] + (p["ripple.amplitude_Nm"] + p["ripple.torque_share"] * driven) * wave
            motor_slope = motor_slope + p["ripple.torque_share"] * driven_slope * wave
        load = self._friction_load(motor, external_Nm)
        rub, rub_slope = self.friction.step(speed, load, dry_factor, viscous_factor)
        if self.shaft.used:
            torque, slope, friction_W = self._behind_shaft(motor, motor_slope, rub, rub_slope, q, dq, load, dry_factor, viscous_factor)
        else:
            torque, slope, friction_W = motor + rub, motor_slope + rub_slope, -rub * speed
        self.warmth.passes(driven, friction_W)
        self.given_torque.copy_(torque)
        self.given_slope.copy_(slope)
        self.given_at.copy_(dq)
        return self.given_torque, self.given_slope

    def _behind_shaft(self, motor, motor_slope, rub, rub_slope, q, dq, load, dry_factor, viscous_factor) -> tuple[torch.Tensor, ...]:
        """Torque on the joint, its slope and friction's power. Friction's share on the joint's side acts behind the shaft."""
        speed = torch.where(self.elastic, self.shaft.rotor_speed, dq)
        rub, rub_slope = (1 - self.on_joint) * rub, (1 - self.on_joint) * rub_slope
        torque, slope, friction_W = motor + rub, motor_slope + rub_slope, -rub * speed
        wound, wound_slope = self.shaft.step(torque, slope, q, dq)
        torque, slope = torch.where(self.elastic, wound, torque), torch.where(self.elastic, wound_slope, slope)
        if self.rubs_on_joint:
            self.joint_friction.bend(dq)
            rub, rub_slope = self.joint_friction.step(dq, load, dry_factor, viscous_factor)
            torque, slope, friction_W = torque + self.on_joint * rub, slope + self.on_joint * rub_slope, friction_W - self.on_joint * rub * dq
        self.load.copy_(torch.where(self.elastic, wound, self.load))  # last: `load` may be this tensor
        return torque, slope, friction_W

    def _drive(self, command, q, speed, supply, enabled, unit) -> tuple[torch.Tensor, torch.Tensor]:
        told = self.command.step(*command)
        seen = self.sensor.step(self._sensed(q), speed)
        self.command_at_drive, self.error = told[0], told[0] - seen[0]
        if not enabled:
            return self.motor.idle(speed, unit)
        output, speed_gain = self.law.step(told, seen, supply, self.sensor.prompt_speed)
        torque, slope = self.motor.step(output, speed_gain, self.law.standing_output(), supply, speed, unit)
        return torque + self.p["drive.offset_Nm"], slope

    def _residual(self, kp, supply, enabled, temperature_C, angle, speed, driven) -> Given:
        p, limit = self.p, self.p["drive.limit"]
        stiffness = p["drive.torque_per_unit_Nm"] * supply * p["drive.kp_scale"] * kp
        integrates = (self.law.held.abs() < limit) & enabled
        given = self.residual.follow(
            angle, speed, self.command_at_drive, self.error, stiffness, driven, temperature_C, integrates, enabled, self.friction.sticks()
        )
        for friction in (self.friction, self.joint_friction):
            friction.more = given
        return given

    def _friction_load(self, motor: torch.Tensor, external_Nm) -> torch.Tensor:
        p, carried = self.p, self.load
        if not self.other_load:
            return carried
        return carried + p["friction.load_by_motor"] * (motor - carried) + p["friction.load_net"] * (0.5 * (motor - external_Nm) - carried)
