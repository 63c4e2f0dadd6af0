"""Runs an exported policy in plain MuJoCo on the CPU, on the exported model (dry friction is MuJoCo's own), with the controller's own
generator and observation, and reports errors against the user's command.
Longer than 300 lines: one program with its tables.

Example: python3 -m pmg_train.evaluate pmg.onnx --robot config/robots/z1 --mjcf z1.xml --library libpmg_batch.so \\
             --scenario config/scenarios/tour.yaml --seeds 3
Exit codes: 0 done, 1 the robot fell, 2 bad input.
"""

import argparse
import json
import sys
from dataclasses import dataclass, field
from pathlib import Path

import mujoco
import numpy as np
import onnxruntime

from pmg_train.checked_files import read_scenario
from pmg_train.references import ReferenceBatch
from pmg_train.robot import evaluation_model, joint_kind

TICK_S, AVERAGE_TICKS = 0.01, 100
SETTLE_S = 1.5  # after a change of the command; reported apart from errors over everything


@dataclass
class Policy:
    session: onnxruntime.InferenceSession
    meta: dict

    @staticmethod
    def load(path: Path) -> "Policy":
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = 1
        session = onnxruntime.InferenceSession(str(path), options, providers=["CPUExecutionProvider"])
        meta = json.loads(session.get_modelmeta().custom_metadata_map["pmg_policy"])
        policy = Policy(session, meta)
        for pair in meta["golden"]:
            error = np.abs(policy.act(np.array(pair["observation"], np.float32)) - pair["action"]).max()
            if not error < meta["golden_tolerance"]:
                raise ValueError(f"{path}: golden pair differs by {error}")
        return policy

    def act(self, seen: np.ndarray) -> np.ndarray:
        return self.session.run(None, {"observation": seen[None]})[0][0]


def steps_without_gantry(scenario: list[dict]) -> list[tuple[str, float, np.ndarray]]:
    """(text, seconds, command) of a scenario's steps, less those in which the gantry lifts the robot or sets it down."""
    steps, hoisted = [], False
    for step in scenario:
        if step["hoist_without_policy"] == hoisted:
            steps.append((step["text"], step["for_s"], np.array(step["command"])))
        hoisted = step["hoist_without_policy"]
    return steps


@dataclass
class Conditions:
    friction: float = 0.8
    torso_mass_kg: float = 0.0
    payload_kg: float = 0.0
    gain_factor: float = 1.0
    delay_steps: int = 1  # of 2 ms
    noise: float = 0.5  # share of training's noise

    @staticmethod
    def draw(random: np.random.Generator) -> "Conditions":
        return Conditions(
            random.uniform(0.5, 1.1), random.uniform(-2, 2), random.uniform(0, 0.8), random.uniform(0.93, 1.07), int(random.integers(0, 8)), 0.5
        )


class Simulation:
    def __init__(self, policy: Policy, description: dict, mjcf: Path, conditions: Conditions, seed: int):
        self.policy, self.c, self.random = policy, conditions, np.random.default_rng(seed)
        gains = {}
        for joint, kp, kd in zip(description["joints"], policy.meta["kp_Nm_per_rad"], policy.meta["kd_Nm_s_per_rad"], strict=True):
            if joint["policy"]:
                gains[joint_kind(joint["name"])] = (kp, kd)
        self.model = m = evaluation_model(mjcf, description, gains)
        m.geom_friction[:, 0] = conditions.friction
        m.body_mass[m.body(description["torso_link"]).id] += conditions.torso_mass_kg
        for side in ("left", "right"):
            m.body_mass[m.body(f"{side}_wrist_pitch_link").id] += conditions.payload_kg
        m.actuator_gainprm[:, 0] *= conditions.gain_factor
        m.actuator_biasprm[:, 1:3] *= conditions.gain_factor
        self.data = mujoco.MjData(m)
        mujoco.mj_resetDataKeyframe(m, self.data, m.key("stand").id)
        mujoco.mj_forward(m, self.data)
        self.steps = round(TICK_S / m.opt.timestep)
        self.lower = np.array([j["lower_rad"] for j in description["joints"]])
        self.upper = np.array([j["upper_rad"] for j in description["joints"]])
        self.stand_height = description["standing_height_m"]
        self.torso = m.body(description["torso_link"]).id
        self.soles = [m.geom(f"{link}_sole").id for link in description["foot_links"]]
        actions = len(policy.meta["action_joints"])
        self.last_action = np.zeros(actions, np.float32)
        self.first = True
        self.queue = [self.data.ctrl.copy()] * (conditions.delay_steps + 1)

    def tick(self, batch: ReferenceBatch, q_ref: np.ndarray) -> None:
        d = self.data
        noisy = lambda x, size: x + self.c.noise * size * self.random.uniform(-1, 1, np.shape(x))
        quat = d.qpos[3:7] + 0.0
        quat[1:] += self.c.noise * 0.015 * self.random.uniform(-1, 1, 3)
        quat /= np.linalg.norm(quat)
        seen = batch.observe(noisy(d.qvel[3:6], 0.2), quat, noisy(d.qpos[7:], 0.01), noisy(d.qvel[6:], 0.75), self.last_action, self.first)
        self.first = False
        self.last_action = self.policy.act(seen)
        target = q_ref.copy()
        actions = len(self.last_action)
        target[:actions] += self.policy.meta["action_scale"] * self.last_action
        target = np.clip(target, self.lower, self.upper)
        for _ in range(self.steps):
            self.queue = self.queue[1:] + [target]
            d.ctrl[:] = self.queue[0]
            mujoco.mj_step(self.model, d)

    def fallen(self) -> bool:
        up = 1 - 2 * (self.data.qpos[4] ** 2 + self.data.qpos[5] ** 2)
        return bool(self.data.qpos[2] < 0.57 * self.stand_height or up < 0.5 or self.data.warning.number.any())

    def sole_forces(self) -> np.ndarray:
        force, wrench = np.zeros(2), np.zeros(6)
        for i in range(self.data.ncon):
            for foot, sole in enumerate(self.soles):
                if sole in self.data.contact.geom[i]:
                    mujoco.mj_contactForce(self.model, self.data, i, wrench)
                    force[foot] += wrench[0]
        return force

    def state(self) -> np.ndarray:
        """vx, vy (world), yaw rate, torso pitch, torso roll, height deviation, yaw."""
        d = self.data
        w, x, y, z = d.qpos[3:7]
        yaw = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
        R = d.xmat[1].reshape(3, 3)
        yaw_rate = (R @ d.qvel[3:6])[2]
        T = d.xmat[self.torso].reshape(3, 3)
        pitch, roll = np.arcsin(np.clip(-T[2, 0], -1, 1)), np.arctan2(T[2, 1], T[2, 2])
        return np.array([d.qvel[0], d.qvel[1], yaw_rate, pitch, roll, d.qpos[2] - self.stand_height, yaw])


@dataclass
class Record:
    user: list = field(default_factory=list)
    state: list = field(default_factory=list)
    joints: list = field(default_factory=list)
    reference: list = field(default_factory=list)
    force: list = field(default_factory=list)
    contact: list = field(default_factory=list)
    step: list = field(default_factory=list)
    qpos: list = field(default_factory=list)
    torque: list = field(default_factory=list)
    fell_at_s: float | None = None


def run(policy: Policy, batch: ReferenceBatch, mjcf: Path, scenario, conditions: Conditions, seed: int) -> Record:
    sim, record, fields = Simulation(policy, batch.description, mjcf, conditions, seed), Record(), batch.fields
    batch.reset()
    for index, (_, seconds, command) in enumerate(scenario):
        for _ in range(round(seconds / TICK_S)):
            row = batch.run(1, command[None, None].astype(np.float32))[0, 0]
            sim.tick(batch, row[fields["q_ref"]].astype(np.float64))
            record.user.append(command)
            record.state.append(sim.state())
            record.joints.append(sim.data.qpos[7:].copy())
            record.reference.append(row[fields["q_ref"]])
            record.force.append(sim.sole_forces())
            record.contact.append(row[fields["contact"]])
            record.step.append(index)
            record.qpos.append(sim.data.qpos.copy())
            record.torque.append(sim.data.actuator_force[:12].copy())
            if sim.fallen():
                record.fell_at_s = len(record.user) * TICK_S
                return record
    return record


def moving_average(x: np.ndarray) -> np.ndarray:
    """Over the last AVERAGE_TICKS, fewer at the start."""
    total = np.cumsum(np.vstack([np.zeros_like(x[:1]), x]), 0)
    last = np.arange(1, len(x) + 1)
    first = np.maximum(last - AVERAGE_TICKS, 0)
    return (total[last] - total[first]) / (last - first)[:, None]


def errors(record: Record) -> np.ndarray:
    """(ticks, 6): |error| of velocity norm, yaw rate, pitch, roll, height, each averaged over AVERAGE_TICKS, and the raw velocity error's norm."""
    user, state = np.array(record.user), np.array(record.state)
    heading = moving_average(np.stack([np.cos(state[:, 6]), np.sin(state[:, 6])], 1))
    heading /= np.linalg.norm(heading, axis=1, keepdims=True)
    vx = heading[:, 0] * state[:, 0] + heading[:, 1] * state[:, 1]
    vy = -heading[:, 1] * state[:, 0] + heading[:, 0] * state[:, 1]
    e = np.column_stack([vx, vy, state[:, 2:6]]) - user
    slow = moving_average(e)
    return np.stack([np.linalg.norm(slow[:, :2], axis=1), *np.abs(slow[:, 2:6]).T, np.linalg.norm(e[:, :2], axis=1)], 1)


def joint_table(record: Record, ticks: np.ndarray, names: list[str]) -> dict[str, dict]:
    """How the leg joints follow their references [rad]; correlation is NaN where the reference rests."""
    out = {}
    for i, name in enumerate(names):
        q, wanted = (np.array(x)[ticks, i] for x in (record.joints, record.reference))
        moves = np.ptp(wanted) > 0.02
        out[name] = dict(
            rms=float(np.sqrt(((q - wanted) ** 2).mean())),
            bias=float((q - wanted).mean()),
            range=float(np.ptp(q)),
            reference_range=float(np.ptp(wanted)),
            correlation=float(np.corrcoef(q, wanted)[0, 1]) if moves else float("nan"),
        )
    return out


def table(record: Record, scenario, names: list[str]) -> list[dict]:
    e, step = errors(record), np.array(record.step)
    state, force, contact = np.array(record.state), np.array(record.force), np.array(record.contact)
    rows = []
    for index, (text, _, command) in enumerate(scenario):
        ticks = np.flatnonzero(step == index)
        settled = ticks[round(SETTLE_S / TICK_S) :]
        if len(settled) == 0:
            continue
        touching = force[settled] > 5
        rows.append(
            dict(
                text=text,
                command=command.tolist(),
                lin_vel=e[settled, 0].mean(),
                yaw_vel=e[settled, 1].mean(),
                pitch=e[settled, 2].mean(),
                roll=e[settled, 3].mean(),
                height=e[settled, 4].mean(),
                mean_height=state[settled, 5].mean(),
                mean_yaw_rate=state[settled, 2].mean(),
                duty=touching.mean(0).tolist(),
                contact_match=float((touching == (contact[settled] > 0.5)).mean()),
                joint_rms=float(np.sqrt(((np.array(record.joints)[settled, :12] - np.array(record.reference)[settled, :12]) ** 2).mean())),
                joints=joint_table(record, settled, names),
            )
        )
    return rows


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("policy", type=Path)
    parser.add_argument("--robot", type=Path, required=True)
    parser.add_argument("--mjcf", type=Path, required=True)
    parser.add_argument("--library", type=Path, required=True)
    parser.add_argument("--scenario", type=Path, required=True)
    parser.add_argument("--seeds", type=int, default=1, help="seed 0 is the nominal robot")
    parser.add_argument("--json", type=Path, help="write all figures there")
    parser.add_argument("--motion", type=Path, help="write qpos of seed 0 there (.npy)")
    a = parser.parse_args()
    try:
        policy, scenario = Policy.load(a.policy), steps_without_gantry(read_scenario(a.library, a.scenario))
        batch = ReferenceBatch(a.library, a.robot, policy.meta["variant"], 1, 0, 1)
    except (OSError, KeyError, ValueError, RuntimeError) as error:
        print(f"evaluate: {error}", file=sys.stderr)
        return 2
    runs, falls = [], 0
    for seed in range(a.seeds):
        conditions = Conditions() if seed == 0 else Conditions.draw(np.random.default_rng(seed))
        record = run(policy, batch, a.mjcf, scenario, conditions, seed)
        mean = errors(record).mean(0)
        falls += record.fell_at_s is not None
        result = dict(
            seed=seed,
            fell_at_s=record.fell_at_s,
            duration_s=len(record.user) * TICK_S,
            lin_vel=mean[0],
            yaw_vel=mean[1],
            pitch=mean[2],
            roll=mean[3],
            height=mean[4],
            lin_vel_raw=mean[5],
            torque_rms=float(np.sqrt((np.array(record.torque) ** 2).mean())),
            steps=table(record, scenario, policy.meta["action_joints"]),
        )
        runs.append(result)
        print(
            f"seed {seed}: "
            + (f"fell at {record.fell_at_s:.1f} s in '{scenario[record.step[-1]][0]}'" if record.fell_at_s else "no fall")
            + f"; lin {mean[0]:.3f} m/s yaw {mean[1]:.3f} rad/s pitch {mean[2]:.3f} roll {mean[3]:.3f} rad height {mean[4]:.4f} m "
            f"(raw velocity {mean[5]:.3f}), torque rms {result['torque_rms']:.1f} Nm",
            flush=True,
        )
        if seed == 0:
            for row in result["steps"]:
                print(
                    f"  {row['text'][:28]:28s} lin {row['lin_vel']:.3f} yaw {row['yaw_vel']:.3f} pitch {row['pitch']:.3f} roll {row['roll']:.3f} "
                    f"h {row['height']:.4f} | mean h {row['mean_height']:+.3f} duty {row['duty'][0]:.2f} {row['duty'][1]:.2f} "
                    f"contact match {row['contact_match']:.2f} joint rms {row['joint_rms']:.3f} ankles "
                    + " ".join(f"{j['rms']:.3f} (r {j['correlation']:.2f})" for n, j in row["joints"].items() if "ankle_pitch" in n)
                )
            if a.motion:
                np.save(a.motion, np.array(record.qpos))
    if a.json:
        a.json.write_text(json.dumps(dict(policy=str(a.policy.name), training=policy.meta["training"], runs=runs), indent=1))
    return 1 if falls else 0


if __name__ == "__main__":
    sys.exit(main())
