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


def layout_of(description: dict) -> list[str]:
    """ "q, 2 ticks old: left_knee" and so on, in the vector's order."""
    return [
        f"{term['name']}, {term['age_ticks']} ticks old: {element}" for term in description["observation"]["terms"] for element in term["elements"]
    ]


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


def observations(ticks: list[dict], stand: list[float], actions: int) -> list[list[float]]:
    """Training's own, tick after tick."""
    observation = Observation(torch.tensor(stand), actions, 1)
    row = lambda values: torch.tensor([values], dtype=torch.float32)
    out = []
    for i, tick in enumerate(ticks):
        quat = np.array(tick["quat_wxyz"]) / np.linalg.norm(tick["quat_wxyz"])
        sensed = (row(tick["gyro_rad_s"]), observation.gravity_direction(row(quat.tolist())), row(tick["q_rad"]), row(tick["dq_rad_s"]))
        angle, gain, action = 2 * math.pi * tick["phase"], tick["gain"], row(tick["last_action"])
        now = observation.now(
            *sensed,
            row(tick["command"]),
            row(tick["user_command"]),
            row([gain * math.sin(angle), gain * math.cos(angle), gain]),
            row(tick["q_ref_rad"]),
            row(tick["dq_ref_rad_s"]),
            action,
        )
        out.append(observation.with_history(now, *sensed, action, torch.tensor([i == 0]))[0].tolist())
    return out


def main(library: str, robot: str, out: Path) -> None:
    description = ReferenceBatch(library, robot).description
    stand, actions = [j["stand_rad"] for j in description["joints"]], len(description["action_joints"])
    random = np.random.default_rng(11)
    ticks = [draw_tick(random, stand, actions) for _ in range(TICKS)]
    for tick, seen in zip(ticks, observations(ticks, stand, actions), strict=True):
        tick["observation"] = [float(f"{x:.9g}") for x in seen]
    text = json.dumps(
        dict(
            robot=description["robot"],
            joints=[j["name"] for j in description["joints"]],
            stand_rad=stand,
            action_joints=description["action_joints"],
            layout=layout_of(description),
            ticks=ticks,
        )
    )
    out.write_text(text.replace('"ticks": [{', '"ticks": [\n{').replace("}, {", "},\n{").replace(', "layout"', ',\n"layout"') + "\n")


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2], Path(sys.argv[3]))
