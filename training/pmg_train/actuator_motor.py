"""Batched motors: from the drive's output to torque (src/actuator/motor_torque.cpp)."""

import torch

from pmg_train.actuator_drive import clamped
from pmg_train.actuator_state import DelayLine, States, has

CUT_SHARE = 0.1  # of the speed, over which an overspeed guard takes all torque away


def finite(limit: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
    """Where there is a limit, and a finite value everywhere, which keeps NaN out of unused results."""
    there = torch.isfinite(limit)
    return there, torch.where(there, limit, 1.0)


class MotorTorque:
    def __init__(self, p: dict, step_s: float, states: States):
        self.p, self.step_s = p, step_s
        self.line = DelayLine(states, "outputs", p["drive.torque_delay_s"], step_s)
        self.rate_limited, self.saturates = has(p, "drive.output_rate_limit_per_s"), has(p, "drive.saturation_per_Nm")
        self.sags = has(p, "drive.supply_sag_per_Nm")
        self.sags_slowly = p["drive.supply_sag_time_s"] > 0
        self.torque_speed, self.stall = finite(p["drive.stall_torque_Nm"])
        self.powered, self.power = finite(p["drive.most_power_W"])
        self.cut, self.cut_speed = finite(p["drive.cut_speed_rad_s"])
        self.fed, self.feed = finite(p["drive.supply_limit_Nm"])
        self.limited, self.limit = finite(p["drive.limit"])
        limits = {"supply": "supply_limit_Nm", "line": "stall_torque_Nm", "power": "most_power_W", "guard": "cut_speed_rad_s"}
        self.has_limit = {limit: has(p, f"drive.{key}") for limit, key in limits.items()}
        self.given, self.bus_lost = states.new("given_output"), states.new("bus_lost")
        self.given_before = states.new_flag("given_before")

    def reset(self, put, mask: torch.Tensor) -> None:
        self.given_before.logical_and_(~mask)
        for state in (self.given, self.bus_lost):
            put(state, torch.zeros_like(state))

    def step(self, output, speed_gain, standing, supply, dq, unit) -> tuple[torch.Tensor, torch.Tensor]:
        """The motor's torque [Nm] and its slope [Nm s/rad]. unit: torque per unit of output times supply."""
        p, back_emf = self.p, self.p["drive.back_emf_s_per_rad"]
        output, speed_gain = self._late(output, speed_gain, standing)
        full, duty = unit * supply, output / p["drive.limit"]
        if self.sags:  # a bridge takes duty times the motor's current from the bus
            sag, slow = p["drive.supply_sag_per_Nm"], torch.where(self.sags_slowly, p["drive.supply_sag_slow_share"], 0.0)
            unit = unit / (1 + (1 - slow) * sag * full * duty**2)
        scale = unit * supply * (1 - self.bus_lost) if self.sags else full
        torque, slope = scale * output - unit * back_emf * dq, -unit * back_emf - scale * speed_gain
        torque, slope = self._limited(torque, slope, duty, full, dq)
        if self.sags:
            lost = slow * sag * duty * torque
            self.bus_lost.add_(self.step_s / (p["drive.supply_sag_time_s"] + self.step_s) * (lost - self.bus_lost))
        return torque, slope

    def idle(self, dq, unit) -> tuple[torch.Tensor, torch.Tensor]:
        """The same of drives that are switched off."""
        for state in (self.given, self.line.past):
            state.zero_()
        self.given_before.fill_(True)
        brake = (self.p["drive.brake_when_disabled"] * unit * self.p["drive.back_emf_s_per_rad"]).expand_as(dq)
        return -brake * dq, -brake

    def _late(self, output, speed_gain, standing) -> tuple[torch.Tensor, torch.Tensor]:
        if not (self.line.used or self.rate_limited):
            return output, speed_gain
        for state in (self.given, self.line.past):
            state.copy_(torch.where(self.given_before, state, standing))
        self.given_before.fill_(True)
        wish = self.line.push(output)
        most = self.p["drive.output_rate_limit_per_s"] * self.step_s
        given = torch.where(torch.isfinite(most), self.given + clamped(wish - self.given, most), wish)
        self.given.copy_(given)
        return given, torch.where(given == wish, self.line.within_step * speed_gain, 0.0)

    def _limited(self, torque, slope, duty, full, dq) -> tuple[torch.Tensor, torch.Tensor]:
        p = self.p
        if self.saturates:
            kept = 1 / (1 + p["drive.saturation_per_Nm"] * torque.abs())
            torque, slope = torque * kept, slope * kept**2
        if not any(self.has_limit.values()):
            return torque, slope
        along = torch.where(torque >= 0, 1.0, -1.0).to(torque.dtype)
        speed = along * dq

        def cap(there, most, falls):
            nonlocal torque, slope
            there = there & (along * torque > most)
            torque, slope = torch.where(there, along * most, torque), torch.where(there, falls, slope)

        if self.has_limit["supply"]:
            feeds = self.fed & (along * duty > 0)
            cap(feeds, self.feed / torch.where(feeds, duty.abs(), 1.0), 0.0)
        if self.has_limit["line"]:
            no_load = p["drive.no_load_rad_s"]
            available = torch.minimum((self.stall * (1 - speed / no_load)).clamp(min=0), self.stall)
            on_slope = (available > 0) & (available < self.stall)
            cap(self.torque_speed, available, torch.where(on_slope, -self.stall / no_load, 0.0))
        if self.has_limit["power"]:
            turns = self.powered & (speed > 0)
            available = self.power / torch.where(turns, speed, 1.0)
            cap(turns, available, -available / torch.where(turns, speed, 1.0))
        if self.has_limit["guard"]:
            share = (1 - speed / self.cut_speed) / CUT_SHARE
            most = torch.where(self.limited, full * self.limit, along * torque)
            cap(self.cut & (share < 1), most * share.clamp(min=0), torch.where(share > 0, -most / (CUT_SHARE * self.cut_speed), 0.0))
        return torque, slope
