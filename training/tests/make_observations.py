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
COMPUTED = ("gravity_direction", "phase")  # from the tick's quaternion, phase and gain


def draw_tick(random: np.random.Generator, stand: list[float], description: dict) -> dict:
    """A quaternion, phi and gain, and values of all other quantities by their names."""
    rounded = lambda x: [round(float(v), 4) for v in x]
    quat = random.normal(size=4)
    tick = dict(quat_wxyz=rounded(quat / np.linalg.norm(quat)), phi=round(float(random.uniform()), 4), gain=round(float(random.uniform()), 4))
    for name, quantity in description["quantities"].items():
        if name in COMPUTED:
            continue
        if name == "last_action":
            values = random.normal(size=len(description["action_joints"]))
        elif quantity["mirror_sign"]:
            values = 0.3 * random.normal(size=len(quantity["mirror_sign"]))
        else:  # of all joints
            values = np.array(stand) + 0.3 * random.normal(size=len(stand)) if quantity["from_stand"] else 3 * random.normal(size=len(stand))
        tick[name] = rounded(values)
    return tick


def observations(ticks: list[dict], description: dict) -> list[list[float]]:
    """Training's own, tick after tick."""
    observation = Observation(description, torch.tensor([joint["stand_rad"] for joint in description["joints"]]), 1)
    row = lambda values: torch.tensor([values], dtype=torch.float32)
    out = []
    for i, tick in enumerate(ticks):
        quat = np.array(tick["quat_wxyz"]) / np.linalg.norm(tick["quat_wxyz"])
        angle, gain = 2 * math.pi * tick["phi"], tick["gain"]
        values = {name: row(tick[name]) for name in description["quantities"] if name not in COMPUTED}
        values["gravity_direction"] = observation.gravity_direction(row(quat.tolist()))
        values["phase"] = row([gain * math.sin(angle), gain * math.cos(angle), gain])
        out.append(observation.with_history(values, torch.tensor([i == 0]))[0].tolist())
    return out


def main(library: str, robot: str, out: Path) -> None:
    description = ReferenceBatch(library, robot).description
    joints = [{key: joint[key] for key in ("name", "stand_rad")} for joint in description["joints"]]
    random = np.random.default_rng(11)
    ticks = [draw_tick(random, [joint["stand_rad"] for joint in joints], description) for _ in range(TICKS)]
    for tick, seen in zip(ticks, observations(ticks, description), strict=True):
        tick["observation"] = [float(f"{x:.9g}") for x in seen]
    text = json.dumps(dict(joints=joints, ticks=ticks, **{key: description[key] for key in ("robot", "action_joints", "observation", "quantities")}))
    out.write_text(
        text.replace('"ticks": [{', '"ticks": [\n{').replace('}, {"quat', '},\n{"quat').replace(', "observation": {', ',\n"observation": {') + "\n"
    )


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2], Path(sys.argv[3]))
