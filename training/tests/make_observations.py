"""Writes test/data/training/observations.json: robot states, references and commands, and what training's torch code makes the
actor see of them, element by element with its name. To be made again when robot.yaml's joints or the observation layout change.

Example: cmake --build build/release --target pmg_batch
         PYTHONPATH=training python3 training/tests/make_observations.py build/release/lib/libpmg_batch.so config/robots/z1 \\
             test/data/training/observations.json
"""

import json
import math
import sys
from pathlib import Path

import numpy as np
import torch

from pmg_train.observation import Observation
from pmg_train.references import ReferenceBatch

TICKS = 9  # two more than the oldest frame needs
CHANNELS = 6


def draw_tick(random: np.random.Generator, stand: list[float], actions: int) -> dict:
    joints, rounded = len(stand), lambda x: [round(float(v), 4) for v in x]
    quat = random.normal(size=4)
    return dict(
        gyro_rad_s=rounded(random.normal(size=3)),
        quat_wxyz=rounded(quat / np.linalg.norm(quat)),
        q_rad=rounded(np.array(stand) + 0.3 * random.normal(size=joints)),
        dq_rad_s=rounded(3 * random.normal(size=joints)),
        q_ref_rad=rounded(np.array(stand) + 0.2 * random.normal(size=joints)),
        dq_ref_rad_s=rounded(2 * random.normal(size=joints)),
        phase=round(float(random.uniform()), 4),
        gain=round(float(random.uniform()), 4),
        command=rounded(0.3 * random.normal(size=CHANNELS)),
        user_command=rounded(0.3 * random.normal(size=CHANNELS)),
        last_action=rounded(random.normal(size=actions)),
    )


def observations(ticks: list[dict], description: dict) -> list[list[float]]:
    """Training's own, tick after tick."""
    observation = Observation(description, torch.tensor([joint["stand_rad"] for joint in description["joints"]]), 1)
    row = lambda values: torch.tensor([values], dtype=torch.float32)
    out = []
    for i, tick in enumerate(ticks):
        quat = np.array(tick["quat_wxyz"]) / np.linalg.norm(tick["quat_wxyz"])
        angle, gain = 2 * math.pi * tick["phase"], tick["gain"]
        values = dict(
            gyro=row(tick["gyro_rad_s"]),
            gravity_direction=observation.gravity_direction(row(quat.tolist())),
            command=row(tick["command"]),
            user_command=row(tick["user_command"]),
            phase=row([gain * math.sin(angle), gain * math.cos(angle), gain]),
            q_ref=row(tick["q_ref_rad"]),
            dq_ref=row(tick["dq_ref_rad_s"]),
            q=row(tick["q_rad"]),
            dq=row(tick["dq_rad_s"]),
            last_action=row(tick["last_action"]),
        )
        out.append(observation.with_history(values, torch.tensor([i == 0]))[0].tolist())
    return out


def main(library: str, robot: str, out: Path) -> None:
    description = ReferenceBatch(library, robot).description
    joints = [{key: joint[key] for key in ("name", "stand_rad")} for joint in description["joints"]]
    random = np.random.default_rng(11)
    ticks = [draw_tick(random, [joint["stand_rad"] for joint in joints], len(description["action_joints"])) for _ in range(TICKS)]
    for tick, seen in zip(ticks, observations(ticks, description), strict=True):
        tick["observation"] = [float(f"{x:.9g}") for x in seen]
    text = json.dumps(
        dict(
            robot=description["robot"], joints=joints, action_joints=description["action_joints"], observation=description["observation"], ticks=ticks
        )
    )
    out.write_text(
        text.replace('"ticks": [{', '"ticks": [\n{').replace('}, {"gyro', '},\n{"gyro').replace(', "observation": {', ',\n"observation": {') + "\n"
    )


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2], Path(sys.argv[3]))
