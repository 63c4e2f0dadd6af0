"""Actuators of motor.yaml in training's physics: neutral actuators change nothing; others act on their joints, also with the worlds' own factors."""

import math
import os
from pathlib import Path

import pytest
import torch

from pmg_train.configuration import load_config
from pmg_train.physics import Worlds
from pmg_train.randomization import nominal
from pmg_train.references import ReferenceBatch
from pmg_train.robot import training_model

HERE = Path(__file__).resolve().parent.parent
LIBRARY, ROBOT, MJCF = (os.environ.get(name) for name in ("PMG_BATCH_LIBRARY", "PMG_ROBOT", "PMG_MJCF"))
needs_robot = pytest.mark.skipif(not (LIBRARY and ROBOT and MJCF), reason="PMG_BATCH_LIBRARY, PMG_ROBOT, PMG_MJCF not set")


def in_the_air(motors: dict | None, ticks: int = 12) -> torch.Tensor:
    """(ticks, 2, joints): joints of two worlds that follow sines, the second with half the friction and 0.8 of the gains."""
    description, config = ReferenceBatch(LIBRARY, ROBOT).description, load_config(HERE / "config.yaml")
    model = training_model(MJCF, description, config["gains"], config["physics"])
    worlds = Worlds(model, 2, 2, description["foot_links"], config["physics"], "cpu", motors)
    robots = nominal(model, 2, "cpu")
    for factor, value in ((robots.kp, 0.8), (robots.kd, 0.8), (robots.joint_friction, 0.5)):
        factor[1] = value
    worlds.apply(robots, description["torso_link"])
    stand = torch.tensor([j["stand_rad"] for j in description["joints"]])
    worlds.qpos[:] = torch.tensor([0, 0, description["standing_height_m"] + 1, 1, 0, 0, 0.0, *stand])
    if worlds.motors:
        worlds.motors.reset(worlds.qpos)
    out = []
    for tick in range(ticks):
        for target in worlds.target:
            target.copy_(stand + 0.1 * (1 - math.cos(0.15 * (tick + 1))))
        worlds.step()
        out.append(worlds.qpos[:, 7:].clone())
    return torch.stack(out)


@needs_robot
def test_neutral_actuators_move_the_robot_as_plain_servos_do():
    names = [j["name"] for j in ReferenceBatch(LIBRARY, ROBOT).description["joints"]]
    plain, neutral = in_the_air(None), in_the_air({name: {} for name in names})
    assert (plain[:, 0] - plain[:, 1]).abs().max() > 1e-3  # the factors count
    assert (plain - neutral).abs().max() < 1e-5  # the same in single precision


@needs_robot
def test_an_effect_acts_on_its_joint():
    plain, slow = in_the_air(None), in_the_air({"left_knee": {"command.rate_limit_rad_s": 0.05}})
    names = [j["name"] for j in ReferenceBatch(LIBRARY, ROBOT).description["joints"]]
    moved = (plain - slow)[-1, 0].abs()
    assert moved.argmax() == names.index("left_knee") and moved.max() > 0.02
