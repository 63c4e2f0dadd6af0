"""Batched drives: a command's way, the sensor, the control law. src/actuator has the same stages."""

import torch

from pmg_train.actuator_state import DelayLine, Period, States, has


def clamped(x: torch.Tensor, most: torch.Tensor) -> torch.Tensor:
    return torch.minimum(torch.maximum(x, -most), most)


class CommandPath:
    """Delay, update period, limits of speed and acceleration (src/actuator/command_path.cpp)."""

    def __init__(self, p: dict, step_s: float, states: States):
        self.p, self.step_s = p, step_s
        self.line = DelayLine(states, "told", p["command.delay_s"], step_s, 5)  # q_des, dq_des, kp, kd, feed forward
        self.update = Period(states, "updated_for", p["command.update_s"], step_s)
        acceleration = p["command.acceleration_limit_rad_s2"]
        self.profiled = torch.isfinite(acceleration)
        self.acceleration = torch.where(self.profiled, acceleration, 1.0)
        self.any_profiled = bool(self.profiled.any())
        self.limits = has(p, "command.rate_limit_rad_s", "command.acceleration_limit_rad_s2")
        self.told_before = states.new_flag("told_before")
        self.taken = states.new("taken", 5)
        self.command, self.command_speed = states.new("command"), states.new("command_speed")

    def reset(self, put, reading: torch.Tensor, mask: torch.Tensor) -> None:
        self.told_before.logical_and_(~mask)
        put(self.command, reading)
        put(self.command_speed, torch.zeros_like(reading))
        self.update.reset(put)

    def step(self, *now) -> torch.Tensor:
        """(q_des, dq_des, kp, kd, feed forward) now => the same at the drive, stacked."""
        told = torch.stack([x.expand_as(self.command) if isinstance(x, torch.Tensor) else torch.full_like(self.command, x) for x in now])
        if self.line.used:
            # Commands before the first step count as equal to it, but with the joint's reading as position.
            before = torch.cat([self.command[None], told[1:]])
            self.line.past.copy_(torch.where(self.told_before, self.line.past, before))
            self.told_before.fill_(True)
        told = self.line.push(told)
        if self.update.used:
            self.taken.copy_(torch.where(self.update.due(), told, self.taken))
            told = self.taken
        if not self.limits:
            self.command.copy_(told[0])
            return told
        self.command.copy_(self._limited(told[0]))
        return torch.cat([self.command[None], told[1:]])

    def _limited(self, q_des: torch.Tensor) -> torch.Tensor:
        p, h, away = self.p, self.step_s, q_des - self.command
        limited = self.command + clamped(away, p["command.rate_limit_rad_s"] * h)
        if not self.any_profiled:
            return limited
        brakes, arrives = torch.sqrt(2 * self.acceleration * away.abs()), away.abs() / h
        wanted = torch.copysign(torch.minimum(torch.minimum(p["command.rate_limit_rad_s"], brakes), arrives), away)
        self.command_speed.add_(clamped(wanted - self.command_speed, self.acceleration * h))
        return torch.where(self.profiled, self.command + h * self.command_speed, limited)


class AngleSensor:
    """Play, eccentricity, delay, quantum, lags, refresh period (src/actuator/angle_sensor.cpp)."""

    def __init__(self, p: dict, step_s: float, states: States):
        self.p = p
        self.lagging, self.velocity_lagging = p["sensor.lag_s"] > 0, p["sensor.velocity_lag_s"] > 0
        self.lags, self.velocity_lags = has(p, "sensor.lag_s"), has(p, "sensor.velocity_lag_s")
        self.plays, self.quantises = has(p, "sensor.hysteresis_rad"), has(p, "sensor.quantum_rad")
        self.eccentric, self.elliptic = has(p, "sensor.eccentricity_rad"), has(p, "sensor.ellipticity_rad")
        self.refresh = Period(states, "refreshed_for", p["sensor.hold_s"], step_s)
        self.lag_share = step_s / (p["sensor.lag_s"] / p["sensor.lag_stages"] + step_s)
        self.velocity_lag_share = step_s / (p["sensor.velocity_lag_s"] + step_s)
        self.line = DelayLine(states, "shown", p["sensor.delay_s"], step_s, 2)
        prompt = self.line.within_step * self.lag_share ** p["sensor.lag_stages"] * self.velocity_lag_share
        self.prompt_speed = torch.where(self.refresh.every_step, p["sensor.angle_scale"] * prompt, 0.0)
        self.held = states.new("seen", 2)
        self.followed_at = states.new("sensor_at")
        self.stages = [p["sensor.lag_stages"] > stage for stage in range(int(float(p["sensor.lag_stages"].max())))]
        self.lagged, self.lagged_speed = states.new("lagged", len(self.stages), 2), states.new("lagged_speed")

    def reset(self, put, angle: torch.Tensor) -> None:
        put(self.followed_at, angle)
        shown = self._shown(angle)
        if self.line.used:
            put(self.line.past, torch.stack([shown, torch.zeros_like(shown)]))
        put(self.lagged, torch.stack([self._quantised(shown), torch.zeros_like(shown)]).expand_as(self.lagged))
        put(self.lagged_speed, torch.zeros_like(shown))
        self.refresh.reset(put)

    def reading(self, angle: torch.Tensor) -> torch.Tensor:
        """(the sensor's angle at the end of the step [rad]) => what the drive reports [rad]."""
        shown = self._shown(self._followed(angle))
        return self._quantised(self.line.a_step_later(torch.stack([shown, shown]))[0] if self.line.used else shown)

    def step(self, angle: torch.Tensor, speed: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """(angle and speed at the beginning of the step) => (what the drive works with)."""
        p = self.p
        self.followed_at.copy_(self._followed(angle))
        shown, speed = self._shown(self.followed_at), p["sensor.angle_scale"] * speed
        if self.line.used:
            shown, speed = self.line.push(torch.stack([shown, speed]))
        seen = self._quantised(shown)
        if self.lags:
            late = torch.stack([seen, speed])
            for lagged, used in zip(self.lagged, self.stages, strict=True):
                lagged.add_(self.lag_share * (late - lagged))
                late = torch.where(self.lagging & used, lagged, late)
            seen, speed = late
        if self.velocity_lags:
            self.lagged_speed.add_(self.velocity_lag_share * (speed - self.lagged_speed))
            speed = torch.where(self.velocity_lagging, self.lagged_speed, speed)
        if self.refresh.used:
            self.held.copy_(torch.where(self.refresh.due(), torch.stack([seen, speed]), self.held))
            seen, speed = self.held
        return seen, speed

    def _followed(self, angle: torch.Tensor) -> torch.Tensor:
        """The angle of the sensor's side of its play [rad]. It stays until the joint moves it."""
        if not self.plays:
            return angle
        half = 0.5 * self.p["sensor.hysteresis_rad"]
        return torch.maximum(torch.minimum(self.followed_at, angle + half), angle - half)

    def _shown(self, followed: torch.Tensor) -> torch.Tensor:
        p, shown = self.p, self.p["sensor.angle_scale"] * followed + self.p["sensor.zero_offset_rad"]
        if self.eccentric:
            turn = p["sensor.eccentricity_order"] * followed + p["sensor.eccentricity_phase_rad"]
            shown = shown + p["sensor.eccentricity_rad"] * torch.sin(turn)
        if self.elliptic:
            shown = shown + p["sensor.ellipticity_rad"] * torch.sin(2 * followed + p["sensor.ellipticity_phase_rad"])
        return shown

    def _quantised(self, shown: torch.Tensor) -> torch.Tensor:
        if not self.quantises:
            return shown
        quantum = self.p["sensor.quantum_rad"]
        some = torch.where(quantum > 0, quantum, 1.0)
        return torch.where(quantum > 0, some * torch.sign(shown) * torch.floor((shown / some).abs() + 0.5), shown)


class ControlLaw:
    """(command, what the sensor shows) => (the drive's output) (src/actuator/control_law.hpp)."""

    def __init__(self, p: dict, step_s: float, states: States):
        self.p = p
        self.dead_band, self.output_dead_band = has(p, "drive.dead_band_rad"), has(p, "drive.output_dead_band")
        self.hold = Period(states, "held_for", p["command.hold_s"], step_s)
        self.held, self.of_position, self.asleep = states.new("held_output"), states.new("of_position"), states.new("asleep")

    def reset(self, put) -> None:
        self.hold.reset(put)
        for state in (self.held, self.of_position, self.asleep):
            put(state, torch.zeros_like(state))

    def step(self, told, seen, supply, prompt_speed) -> tuple[torch.Tensor, torch.Tensor]:
        """The output, and by how much [output per rad/s] a change of speed within the step lowers it."""
        p, every_step, due = self.p, self.hold.every_step, self.hold.due()
        q_des, dq_des, kp, kd, feed_forward_Nm = told
        kd = p["drive.kd_scale"] * kd
        # Newton metres under every law: the drive divides by its torque constant at the reference temperature and by its supply.
        forward = feed_forward_Nm / (p["drive.torque_per_unit_Nm"] * supply)
        of_position = p["drive.kp_scale"] * kp * self._beyond_dead_band(q_des - seen[0], due)
        wish = of_position + kd * (dq_des - seen[1]) + forward
        follows = every_step
        if self.output_dead_band:
            band = p["drive.output_dead_band"]
            wish = wish - clamped(wish, band)
            follows = follows & ((wish != 0) | (band == 0))
        within = clamped(wish, p["drive.limit"])
        self.held.copy_(torch.where(due, within, self.held) if self.hold.used else within)
        self.of_position.copy_(torch.where(due, of_position, self.of_position) if self.hold.used else of_position)
        return self.held, torch.where(follows & (within == wish), prompt_speed * kd, 0.0)

    def standing_output(self) -> torch.Tensor:
        """What the output would be without its position error."""
        return clamped(self.held - self.of_position, self.p["drive.limit"])

    def _beyond_dead_band(self, error: torch.Tensor, due: torch.Tensor) -> torch.Tensor:
        if not self.dead_band:
            return error
        band = self.p["drive.dead_band_rad"]
        wakes = error.abs() >= band + self.p["drive.dead_band_wake_rad"]
        asleep = torch.where(error.abs() < band, 1.0, torch.where(wakes, 0.0, self.asleep))
        self.asleep.copy_(torch.where(due, asleep, self.asleep))
        return torch.where(asleep > 0, 0.0, error - self.p["drive.dead_band_subtracts"] * clamped(error, band))
