"""Commands reach training's drives when they reach the simulated ones, and joints then move alike."""

import json
import os
from pathlib import Path

import numpy as np
import pytest
import torch

from pmg_train.actuation import target_shares

HERE = Path(__file__).resolve().parent.parent
LIBRARY, ROBOT, MJCF = (os.environ.get(name) for name in ("PMG_BATCH_LIBRARY", "PMG_ROBOT", "PMG_MJCF"))
RECORD = HERE.parent / "test" / "data" / "training" / "rollout.json"
TICK_S, STEP_S, DEPLOYED_STEP_S = 0.01, 0.005, 0.002


@pytest.mark.parametrize("delay_s", [0.0, 0.002, 0.0085, 0.01, 0.02])
def test_a_delay_is_kept_to_the_microsecond(delay_s):
    shares = target_shares(torch.tensor([delay_s, 0.02]), TICK_S, STEP_S, DEPLOYED_STEP_S)[:, :, 0, 0]
    torch.testing.assert_close(shares.sum(1), torch.ones(2))
    # A step from 0 to 1, over the steps of the next ticks: the time that is missing is the delay, with half the steps' difference.
    missing_s = 0.0
    for tick in range(shares.shape[1]):
        arrived = shares[:, : tick + 1].sum(1)
        missing_s += float((STEP_S * (1 - arrived)).sum())
    assert missing_s == pytest.approx(delay_s + 0.0015, abs=1e-6)


def test_a_late_command_acts_in_the_order_it_was_given():
    shares = target_shares(torch.tensor([0.012]), TICK_S, STEP_S, DEPLOYED_STEP_S)[:, :, 0, 0]
    # 13.5 ms late: until 3.5 ms the target of two ticks ago, then that of one tick ago.
    torch.testing.assert_close(shares, torch.tensor([[0.0, 0.3, 0.7], [0.0, 1.0, 0.0]]), atol=1e-6, rtol=0)


def largest_errors(record: dict, expected: str, motors: dict | None) -> np.ndarray:
    """(joints,) [rad]: 0.2 s in the air, mujoco_warp under training's settings, against the record."""
    from pmg_train.configuration import load_config
    from pmg_train.physics import Worlds
    from pmg_train.randomization import nominal
    from pmg_train.references import ReferenceBatch
    from pmg_train.robot import training_model

    description = ReferenceBatch(LIBRARY, ROBOT).description
    assert [j["name"] for j in description["joints"]] == record["joints"]
    config = load_config(HERE / "config.yaml")
    assert (config["tick_s"], config["physics"]["deployed_timestep_s"]) == (TICK_S, DEPLOYED_STEP_S)
    model = training_model(MJCF, description, record["gains"], config["physics"])
    worlds = Worlds(model, 2, round(TICK_S / model.opt.timestep), description["foot_links"], config["physics"], "cpu", motors)
    robots = nominal(model, 2, "cpu")
    worlds.apply(robots, description["torso_link"])
    shares = target_shares(robots.delay_s, TICK_S, model.opt.timestep, DEPLOYED_STEP_S)
    stand = torch.tensor([j["stand_rad"] for j in description["joints"]])
    worlds.qpos[:] = torch.tensor([0, 0, description["standing_height_m"] + 1, 1, 0, 0, 0.0, *stand])
    if worlds.motors:
        worlds.motors.reset(worlds.qpos)
    targets = stand.repeat(shares.shape[1], 2, 1)
    error = np.zeros(len(stand))
    for q_des, q in zip(record["q_des_rad"], record[expected], strict=True):
        targets = torch.cat([torch.tensor(q_des, dtype=torch.float32).repeat(1, 2, 1), targets[:-1]])
        for now, share in zip(worlds.target, shares, strict=True):
            now.copy_((share * targets).sum(0))
        worlds.step()
        error = np.maximum(error, np.abs(worlds.qpos[0, 7:].numpy() - q))
    assert worlds.fullest()[1] == 0  # no contact
    return error


needs_robot = pytest.mark.skipif(not (LIBRARY and ROBOT and MJCF), reason="PMG_BATCH_LIBRARY, PMG_ROBOT, PMG_MJCF not set")


@needs_robot
def test_a_robot_in_the_air_moves_as_in_the_controllers_simulation():
    """All 31 joints against MuJoCo 2.2.2 under the controller's settings.

    1e-3 rad is what a policy wouldn't notice; the bound is tight enough that both corrections for the longer step are needed.
    """
    record = json.loads(RECORD.read_text())
    assert np.ptp(np.array(record["q_rad"]), axis=0).min() > 0.02  # every joint moves
    error = largest_errors(record, "q_rad", None)
    assert error.max() < 3e-4, f"{record['joints'][int(error.argmax())]}: {error.max():.5f} rad"


@needs_robot
def test_a_robot_with_imperfect_drives_moves_as_in_the_controllers_simulation():
    record = json.loads(RECORD.read_text())
    difference = np.abs(np.array(record["q_rad"]) - record["q_with_motors_rad"]).max(0)
    for joint in record["motors"]:
        assert difference[record["joints"].index(joint)] > 2.5e-3, joint  # the effects count
    error = largest_errors(record, "q_with_motors_rad", record["motors"])
    assert error.max() < 1e-3, f"{record['joints'][int(error.argmax())]}: {error.max():.5f} rad"
