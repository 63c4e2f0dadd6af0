"""The training environment: many Z1s in mujoco_warp that follow the deployed generator's references at 100 Hz.

One tick is act() -> worlds.step() -> observe(): each part has static shapes and no host synchronisation, so that
act() and observe() can be recorded as CUDA graphs. Longer than 300 lines: the parts share the state of all worlds.
"""

import math

import torch

from pmg_train import randomization, rewards
from pmg_train.actuation import target_shares
from pmg_train.observation import Observation
from pmg_train.physics import Worlds
from pmg_train.reference_pool import ReferencePool
from pmg_train.robot import joint_kind, training_model
from pmg_train.rotations import roll_pitch_yaw, rotate, rotate_back


class Environment:
    def __init__(
        self,
        mjcf: str,
        pool: ReferencePool,
        description: dict,
        fields: dict[str, slice],
        config: dict,
        ranges: dict,
        worlds: int,
        device: str,
        motors: dict[str, dict[str, float]] | None = None,
    ):
        self.config, self.ranges, self.pool, self.n = config, ranges, pool, worlds
        self.tick_s = config["tick_s"]
        model = training_model(mjcf, description, config["gains"], config["physics"])
        substeps = round(self.tick_s / model.opt.timestep)
        torso, feet = description["torso_link"], description["foot_links"]
        self.robots = randomization.draw(ranges, model, torso, worlds, device)
        self.worlds = Worlds(model, worlds, substeps, feet, config["physics"], device, motors)
        self.shares = target_shares(self.robots.delay_s, self.tick_s, model.opt.timestep, config["physics"]["deployed_timestep_s"])
        self.worlds.apply(self.robots, torso)
        self.device = self.worlds.torch_device
        self._constants(model, description, torso, feet)
        self.fields = fields
        self._state(description)

    # ------------------------------------------------------------------------------------------------ construction

    def _tensor(self, values) -> torch.Tensor:
        return torch.tensor(values, dtype=torch.float32, device=self.device)

    def _constants(self, model, description, torso, feet) -> None:
        joints = description["joints"]
        self.stand = self._tensor([j["stand_rad"] for j in joints])
        self.lower = self._tensor([j["lower_rad"] for j in joints])
        self.upper = self._tensor([j["upper_rad"] for j in joints])
        legs = [i for i, j in enumerate(joints) if j["policy"]]
        if legs != list(range(len(legs))):
            raise ValueError("the policy joints must come first in the joint order")
        self.actions = len(legs)
        self.leg_effort = self._tensor([joints[i]["effort_limit_Nm"] for i in legs])
        self.leg_kinds = [joint_kind(joints[i]["name"]) for i in legs]
        self.leg_weight = self._of_kinds(self.config["joint_weight"], 1.0)
        self.leg_linear_weight = self._of_kinds(self.config["rewards"]["joint_position_linear"], 0.0)
        self.torso, self.feet = model.body(torso).id, [model.body(f).id for f in feet]
        self.foot_slice = slice(self.feet[0], self.feet[1] + 1, self.feet[1] - self.feet[0])
        self.sole_center = self._tensor(model.geom(f"{feet[0]}_sole").pos)
        self.standing_height = description["standing_height_m"]
        self.command_lower = self._tensor([c["lower"] for c in description["command"]])
        self.command_upper = self._tensor([c["upper"] for c in description["command"]])
        self.up = self._tensor([[0, 0, 1.0]])
        amplitude = self.ranges["upper_body"]["amplitude_rad"]
        for key in amplitude:
            if not any(joint_kind(j["name"]).startswith(key) for j in joints if not j["policy"]):
                raise ValueError(f"upper_body: amplitude_rad of {key}: no such joint above the legs")
        self.upper_amplitude = self._tensor([0.0 if j["policy"] else _amplitude(j["name"], amplitude) for j in joints])
        kicks = self.ranges["kicks"]
        self.kick = self._tensor([kicks["linear_m_s"]] * 2 + [kicks["vertical_m_s"]] + [kicks["angular_rad_s"]] * 3)
        self.action_scale = self.config["action_scale"]
        self.action_unit = (self.action_scale / 0.25) ** 2  # the penalties on actions are set in radians

    def _of_kinds(self, values: dict[str, float], otherwise: float) -> torch.Tensor:
        """One number for each leg joint from a table by kind. ValueError for a kind that the legs don't have."""
        unknown = set(values) - set(self.leg_kinds)
        if unknown:
            raise ValueError(f"joint kinds {sorted(unknown)}; expected some of {sorted(set(self.leg_kinds))}")
        return self._tensor([values.get(kind, otherwise) for kind in self.leg_kinds])

    def _state(self, description: dict) -> None:
        n, joints, actions = self.n, len(self.stand), self.actions
        zeros = lambda *shape: torch.zeros(*shape, device=self.device)
        self.stream = torch.zeros(n, dtype=torch.int64, device=self.device)
        self.tick = torch.zeros(n, dtype=torch.int64, device=self.device)
        self.row = zeros(n, self.pool.rows.shape[1])
        self.time_s, self.kick_in_s, self.kick_share = zeros(n), zeros(n), torch.ones((), device=self.device)
        self.strictness = torch.ones((), device=self.device)  # of the linear errors, see rewards.py
        self.episode_length_s = zeros(n)
        self.action, self.action_1, self.action_2 = zeros(n, actions), zeros(n, actions), zeros(n, actions)
        self.targets = zeros(self.shares.shape[1], n, joints)  # newest first
        self.q_ref = zeros(n, joints)
        self.sway = zeros(n, 4, joints)  # offset, amplitude, frequency, phase
        self.fresh = torch.ones(n, dtype=torch.bool, device=self.device)
        self.layout = Observation(description, self.stand, n)
        self.history = self.layout.history
        # Slow averages of the base's velocity, of the admissible command and of the user's command.
        self.velocity, self.asked, self.wanted = zeros(n, 3), zeros(n, 3), zeros(n, 3)
        self.posture_error = zeros(n, 3)  # slow average: pitch, roll [rad] and height [m] minus the admissible command
        self.previous_dq, self.previous_sole = zeros(n, actions), zeros(n, 2, 3)
        self.reward, self.done, self.timeout = zeros(n), zeros(n), zeros(n)
        self.terms: dict[str, torch.Tensor] = {}
        self.errors: dict[str, torch.Tensor] = {}
        self.observation = self.critic_observation = None
        self.reset_all()
        self.observation, self.critic_observation = self._observations()

    def get(self, name: str) -> torch.Tensor:
        return self.row[:, self.fields[name]]

    def _user(self) -> torch.Tensor:
        """The user's command, clamped to the robot's ranges; training sometimes commands a little more."""
        return torch.minimum(torch.maximum(self.get("user"), self.command_lower), self.command_upper)

    # ------------------------------------------------------------------------------------------------------- resets

    def _draw_start(self) -> dict[str, torch.Tensor]:
        """Puts every world at a random place of the references, with the robot near that reference."""
        n, device, f = self.n, self.device, self.fields
        stream = torch.randint(0, self.pool.streams, (n,), device=device)
        tick = torch.randint(0, max(1, self.pool.ticks - 300), (n,), device=device)
        row = self.pool.read(stream, tick)
        joints = len(self.stand)
        upper = self.ranges["upper_body"]
        r = torch.rand(n, 4, joints, device=device)
        some = (torch.rand(n, 2, 1, device=device) < upper["share"]) * (torch.rand(n, 2, joints, device=device) < 0.6)
        low, high = upper["frequency_Hz"]
        sway = torch.stack(
            [
                (2 * r[:, 0] - 1) * self.upper_amplitude * some[:, 0] * 0.8,
                r[:, 1] * self.upper_amplitude * some[:, 1],
                low + (high - low) * r[:, 2],
                2 * math.pi * r[:, 3],
            ],
            1,
        )
        q_ref = self._reference(row, sway, torch.zeros(n, device=device))
        q = q_ref + 0.03 * torch.randn(n, joints, device=device)
        quat = row[:, f["base_quat_H"]]
        height = row[:, f["base_height"]] + 0.004
        velocity = row[:, f["base_velocity_H"]]
        omega = rotate_back(quat, row[:, f["base_omega_H"]])
        qpos = torch.cat([torch.zeros(n, 2, device=device), height, quat, q], 1)
        qvel = torch.cat([velocity, omega, row[:, f["dq_ref"]]], 1)
        qvel = qvel + 0.05 * torch.randn_like(qvel)
        return dict(stream=stream, tick=tick, row=row, sway=sway, q_ref=q_ref, qpos=qpos, qvel=qvel)

    def _reference(self, row: torch.Tensor, sway: torch.Tensor, time_s: torch.Tensor) -> torch.Tensor:
        """q_ref plus the motion of the upper body, as from an operator's arms."""
        offset, amplitude, frequency, phase = sway.unbind(1)
        moved = offset + amplitude * torch.sin(2 * math.pi * frequency * time_s[:, None] + phase)
        return (row[:, self.fields["q_ref"]] + moved).clamp(self.lower, self.upper)

    def _reset(self, where: torch.Tensor) -> None:
        start, one = self._draw_start(), where[:, None]
        put = lambda target, value, mask: target.copy_(torch.where(mask, value, target))
        w = self.worlds
        put(w.qpos, start["qpos"], one)
        put(w.qvel, start["qvel"], one)
        w.warmstart.copy_(torch.where(one, torch.zeros_like(w.warmstart), w.warmstart))
        put(self.stream, start["stream"], where)
        put(self.tick, start["tick"], where)
        put(self.row, start["row"], one)
        put(self.sway, start["sway"], one[:, None])
        put(self.q_ref, start["q_ref"], one)
        self.targets.copy_(torch.where(one[None], start["q_ref"][None], self.targets))
        if w.motors:
            w.motors.reset(w.qpos, where)
        asked = self.get("command")[:, :3]
        put(self.velocity, asked, one)
        put(self.asked, asked, one)
        put(self.wanted, self._user()[:, :3], one)
        keep = (~where).float()
        self.time_s.mul_(keep)
        for zeroed in (self.action, self.action_1, self.action_2, self.previous_dq, self.posture_error):
            zeroed.mul_(keep[:, None])
        self.fresh.copy_(where)

    def reset_all(self) -> None:
        self._reset(torch.ones(self.n, dtype=torch.bool, device=self.device))
        # Staggered starts, so that the episodes end at different times.
        self.time_s.uniform_(0, 0.75 * self.config["episode_s"])
        low, high = self.ranges["kicks"]["every_s"]
        self.kick_in_s.uniform_(low, high)

    MOMENTARY = (
        "stream",
        "tick",
        "row",
        "time_s",
        "kick_in_s",
        "action",
        "action_1",
        "action_2",
        "targets",
        "q_ref",
        "sway",
        "fresh",
        "history",
        "velocity",
        "asked",
        "wanted",
        "posture_error",
        "previous_dq",
        "previous_sole",
        "observation",
        "critic_observation",
    )
    MOMENTARY_PHYSICS = ("qpos", "qvel", "warmstart")

    def _momentary(self) -> dict[str, torch.Tensor]:
        return (
            {name: getattr(self, name) for name in self.MOMENTARY}
            | {name: getattr(self.worlds, name) for name in self.MOMENTARY_PHYSICS}
            | (self.worlds.motors.momentary() if self.worlds.motors else {})
        )

    def state(self) -> dict[str, torch.Tensor]:
        """The whole state, which changes from tick to tick. References and robots follow from the seed."""
        return {name: value.clone() for name, value in self._momentary().items()}

    def restore(self, state: dict[str, torch.Tensor]) -> bool:
        """False, without any change, if the state has another number of worlds or is of an earlier version."""
        mine = self._momentary()
        if set(mine) != set(state) or any(mine[name].shape != value.shape for name, value in state.items()):
            return False
        for name, value in state.items():
            mine[name].copy_(value)
        return True

    # --------------------------------------------------------------------------------------------------------- tick

    def act(self, action: torch.Tensor) -> None:
        """Targets of the next tick: q_ref + scale * action on the legs, after this robot's delay."""
        self.action_2.copy_(self.action_1)
        self.action_1.copy_(self.action)
        self.action.copy_(action.clamp(-4, 4))
        target = self.q_ref.clone()
        target[:, : self.actions] += self.action_scale * self.action
        # The drive controls its encoder's reading, as in the controller's simulation.
        target = torch.maximum(torch.minimum(target, self.upper), self.lower) - self.robots.encoder_offset
        self.targets.copy_(torch.cat([target[None], self.targets[:-1]], 0))
        for now, share in zip(self.worlds.target, self.shares, strict=True):
            now.copy_((share * self.targets).sum(0))
        self.kick_in_s -= self.tick_s
        due = self.kick_in_s < 0
        push = (2 * torch.rand(self.n, 6, device=self.device) - 1) * self.kick * self.kick_share
        self.worlds.qvel[:, :6] += push * due[:, None]
        low, high = self.ranges["kicks"]["every_s"]
        again = low + (high - low) * torch.rand(self.n, device=self.device)
        self.kick_in_s.copy_(torch.where(due, again, self.kick_in_s))

    def observe(self) -> None:
        """Rewards the tick, restarts fallen robots, goes to the next reference and computes the observations."""
        m, fallen = self._measure()
        weights = self.config["rewards"]
        self.terms = rewards.reward_terms(m, weights, self.action_unit)
        self.reward.copy_(rewards.total(self.terms, fallen.float(), weights["fall"], self.tick_s))
        self.time_s += self.tick_s
        timeout = ((self.time_s > self.config["episode_s"]) | (self.tick >= self.pool.ticks - 2)) & ~fallen
        done = fallen | timeout
        self.done.copy_(done.float())
        self.timeout.copy_(timeout.float())
        self.fallen = fallen
        self.tick += 1
        self.row.copy_(self.pool.read(self.stream, self.tick.clamp(max=self.pool.ticks - 1)))
        self.q_ref.copy_(self._reference(self.row, self.sway, self.time_s))
        self._reset(done)
        self.look()

    def look(self) -> None:
        seen, critic = self._observations()
        self.observation.copy_(seen)
        self.critic_observation.copy_(critic)

    def _measure(self) -> tuple[dict[str, torch.Tensor], torch.Tensor]:
        w, legs = self.worlds, self.actions
        broken = ~(torch.isfinite(w.qpos).all(1) & torch.isfinite(w.qvel).all(1)) | (w.qvel.abs() > 200).any(1)
        qpos = torch.where(broken[:, None], torch.zeros_like(w.qpos), w.qpos)
        qpos[:, 3] += broken
        qvel = torch.where(broken[:, None], torch.zeros_like(w.qvel), w.qvel)
        quat = qpos[:, 3:7] / qpos[:, 3:7].norm(dim=1, keepdim=True)
        _, _, yaw = roll_pitch_yaw(quat)
        cos, sin = torch.cos(yaw), torch.sin(yaw)
        vx = cos * qvel[:, 0] + sin * qvel[:, 1]
        vy = -sin * qvel[:, 0] + cos * qvel[:, 1]
        yaw_rate = rotate(quat, qvel[:, 3:6])[:, 2]
        now = torch.stack([vx, vy, yaw_rate], 1)
        share = self.tick_s / self.config["average_s"]
        user, command, optimised = self._user(), self.get("command"), self.get("optimised")
        self.velocity += share * (now - self.velocity)
        self.asked += share * (command[:, :3] - self.asked)
        self.wanted += share * (user[:, :3] - self.wanted)
        torso_roll, torso_pitch, _ = roll_pitch_yaw(torch.nan_to_num(w.xquat[:, self.torso]))
        attitude, height = torch.stack([torso_pitch, torso_roll], 1), qpos[:, 2] - self.standing_height
        posture_error = torch.cat([attitude, height[:, None]], 1) - command[:, 3:6]
        self.posture_error += share * (posture_error - self.posture_error)
        q, dq = qpos[:, 7:], qvel[:, 6:]
        sole_quat = torch.nan_to_num(w.xquat[:, self.foot_slice])
        sole = torch.nan_to_num(w.xpos[:, self.foot_slice]) + rotate(sole_quat, self.sole_center.expand(self.n, 2, 3))
        sole_velocity = (sole - self.previous_sole) / self.tick_s
        sole_velocity = sole_velocity * (self.time_s > 1.5 * self.tick_s)[:, None, None] * ~broken[:, None, None]
        self.previous_sole.copy_(sole)
        leg_q, leg_dq = q[:, :legs], dq[:, :legs]
        m = dict(
            slow_error=self.velocity - self.asked,
            fast_error=now - optimised[:, :3],
            attitude_error=posture_error[:, :2],
            slow_posture_error=self.posture_error,
            bob_error=qpos[:, 2] - self.get("base_height")[:, 0],
            q_error=leg_q - self.q_ref[:, :legs],
            dq_error=leg_dq - self.get("dq_ref")[:, :legs],
            strictness=self.strictness,
            leg_weight=self.leg_weight,
            leg_linear_weight=self.leg_linear_weight,
            gain=self.row[:, self.fields["phase"]][:, 2],
            touching=(torch.nan_to_num(w.sole_force) > 5.0).float(),
            contact=self.get("contact"),
            sole_velocity=sole_velocity,
            sole_tilt=2 * (sole_quat[..., 1] ** 2 + sole_quat[..., 2] ** 2),
            vertical_velocity=qvel[:, 2] - self.get("base_velocity_H")[:, 2],
            gyro=qvel[:, 3:6],
            leg_torque=torch.nan_to_num(w.torque[:, :legs]),
            leg_effort=self.leg_effort,
            leg_dq=leg_dq,
            leg_ddq=(leg_dq - self.previous_dq) / self.tick_s,
            action=self.action,
            action_1=self.action_1,
            action_2=self.action_2,
            beyond_limits=(leg_q - self.upper[:legs] + 0.03).clamp(min=0) + (self.lower[:legs] + 0.03 - leg_q).clamp(min=0),
        )
        self.previous_dq.copy_(leg_dq)
        upright = rotate_back(quat, self.up.expand(self.n, 3))[:, 2]
        fall = self.config["fall"]
        fallen = (qpos[:, 2] < fall["height_share"] * self.standing_height) | (upright < fall["upright"]) | broken
        self.errors = self._errors(m, user, attitude, height) | dict(broken=broken.float())
        return m, fallen

    def _errors(self, m: dict, user: torch.Tensor, attitude: torch.Tensor, height: torch.Tensor) -> dict[str, torch.Tensor]:
        """Errors for the curves. Velocities, attitude and height are against the user's command; rewards use the admissible one."""
        slow, q_error = self.velocity - self.wanted, m["q_error"].abs()
        errors = dict(
            velocity=slow[:, :2].norm(dim=1),
            yaw_rate=slow[:, 2].abs(),
            pitch=(attitude[:, 0] - user[:, 3]).abs(),
            roll=(attitude[:, 1] - user[:, 4]).abs(),
            height=(height - user[:, 5]).abs(),
            velocity_admissible=m["slow_error"][:, :2].norm(dim=1),
            yaw_rate_admissible=m["slow_error"][:, 2].abs(),
            joint=q_error.mean(1),
        )
        for kind in dict.fromkeys(self.leg_kinds):
            errors[kind] = torch.stack([q_error[:, i] for i, k in enumerate(self.leg_kinds) if k == kind]).mean(0)
        return errors | dict(
            contact=(m["touching"] != m["contact"]).float().mean(1), torque=m["leg_torque"].abs().mean(1), action=self.action.abs().mean(1)
        )

    # -------------------------------------------------------------------------------------------------- observation

    def _observations(self) -> tuple[torch.Tensor, torch.Tensor]:
        w, noise = self.worlds, self.ranges["noise"]
        gyro, gravity, q, dq = w.qvel[:, 3:6], self.layout.gravity_direction(w.qpos[:, 3:7]), w.qpos[:, 7:], w.qvel[:, 6:]
        shown = w.motors.reading(q) if w.motors else q
        noisy = lambda x, size: x + size * (2 * torch.rand_like(x) - 1)
        sensed = dict(
            gyro=noisy(gyro, noise["gyro_rad_s"]),
            gravity_direction=noisy(gravity, noise["gravity_direction"]),
            q=noisy(shown + self.robots.encoder_offset, noise["q_rad"]),
            dq=noisy(dq, noise["dq_rad_s"]),
        )
        given = dict(
            command=self.get("optimised"),
            user_command=self.get("command"),
            phase=self.get("phase"),
            q_ref=self.q_ref,
            dq_ref=self.get("dq_ref"),
            last_action=self.action,
        )
        seen = self.layout.with_history(given | sensed, self.fresh)
        critic = torch.cat([self.layout.now(given | dict(gyro=gyro, gravity_direction=gravity, q=q, dq=dq)), self._privileged()], 1)
        return torch.nan_to_num(seen).clamp(-50, 50), torch.nan_to_num(critic).clamp(-50, 50)

    def _privileged(self) -> torch.Tensor:
        w = self.worlds
        quat = w.qpos[:, 3:7] / w.qpos[:, 3:7].norm(dim=1, keepdim=True)
        velocity = rotate_back(quat, w.qvel[:, :3])
        feet = w.xpos[:, self.foot_slice]
        relative = rotate_back(quat[:, None].expand(-1, 2, -1), feet - w.qpos[:, None, :3])
        torso_roll, torso_pitch, _ = roll_pitch_yaw(w.xquat[:, self.torso])
        return torch.cat(
            [
                velocity,
                w.qpos[:, 2:3],
                w.sole_force / 300,
                (w.sole_force > 5).float(),
                self.get("contact"),
                feet[..., 2],
                relative.flatten(1),
                self.velocity,
                self.asked,
                self.posture_error,
                self.get("command"),
                w.qpos[:, 2:3] - self.get("base_height"),
                torso_pitch[:, None],
                torso_roll[:, None],
                self.robots.privileged,
                self.action_1,
                w.torque[:, : self.actions] / self.leg_effort,
            ],
            1,
        )


def _amplitude(name: str, amplitude: dict) -> float:
    kind = joint_kind(name)
    return next((float(value) for key, value in amplitude.items() if kind.startswith(key)), 0.0)
