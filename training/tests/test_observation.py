"""Training sees what the controller sees: the batched observation equals the C++ assembler's, name by name."""

import os
from pathlib import Path

import numpy as np
import pytest
import torch
import warp as wp

from pmg_train.checked_files import read_randomization
from pmg_train.configuration import load_config
from pmg_train.environment import Environment
from pmg_train.reference_pool import ReferencePool
from pmg_train.references import ReferenceBatch

HERE = Path(__file__).resolve().parent.parent
LIBRARY, ROBOT, MJCF = (os.environ.get(name) for name in ("PMG_BATCH_LIBRARY", "PMG_ROBOT", "PMG_MJCF"))
pytestmark = pytest.mark.skipif(not (LIBRARY and ROBOT and MJCF), reason="PMG_BATCH_LIBRARY, PMG_ROBOT, PMG_MJCF not set")

COMMAND = np.array([0.5, 0.1, 0.3, 0.1, 0.05, -0.05], np.float32)
WORLDS, TICKS = 2, 400
TOLERANCE = 1e-6  # of values of order one in float32; velocities are scaled to that


@pytest.fixture(scope="module")
def setting():
    wp.config.quiet = True
    config, ranges = load_config(HERE / "config.yaml"), read_randomization(LIBRARY, HERE / "randomization.yaml")
    ranges["noise"] = dict.fromkeys(ranges["noise"], 0.0)
    ranges["encoder_offset_rad"] = 0.0
    ranges["upper_body"]["share"] = 0.0
    batch = ReferenceBatch(LIBRARY, ROBOT, "pmg", 1, 1, 1)
    pool = ReferencePool(batch, TICKS, "cpu")
    torch.manual_seed(1)
    env = Environment(MJCF, pool, batch.description, batch.fields, config, ranges, WORLDS, "cpu")
    return env, batch


def test_observation_is_the_controllers(setting):
    env, _ = setting
    batch = ReferenceBatch(LIBRARY, ROBOT, "pmg", 1, 1, 1)
    terms = batch.description["observation"]["terms"]
    assert env.observation.shape[1] == batch.description["observation"]["size"]
    random = np.random.default_rng(5)
    for tick in range(12):
        row = batch.run(1, COMMAND[None, None])[0, 0]
        q = (env.stand.numpy() + random.normal(size=31) * 0.3).astype(np.float32)
        dq = random.normal(size=31).astype(np.float32) * 3
        quat = random.normal(size=4).astype(np.float32)
        quat /= np.linalg.norm(quat)
        gyro, action = random.normal(size=3).astype(np.float32), random.normal(size=12).astype(np.float32)
        env.row[:] = torch.from_numpy(row)
        env.q_ref.copy_(env._reference(env.row, torch.zeros_like(env.sway), env.time_s))
        env.worlds.qpos[:, 3:7] = torch.from_numpy(quat)
        env.worlds.qpos[:, 7:] = torch.from_numpy(q)
        env.worlds.qvel[:, 3:6] = torch.from_numpy(gyro)
        env.worlds.qvel[:, 6:] = torch.from_numpy(dq)
        env.action[:] = torch.from_numpy(action)
        env.fresh.fill_(tick == 0)
        seen = env._observations()[0][0].numpy()
        expected = batch.observe(gyro, quat, q, dq, action, first=tick == 0)
        for term in terms:
            part = slice(term["offset"], term["offset"] + term["size"])
            np.testing.assert_allclose(
                seen[part], expected[part], atol=TOLERANCE, rtol=0, err_msg=f"{term['name']}, {term['age_ticks']} ticks old, tick {tick}"
            )


def test_a_robot_enters_the_stream_where_the_reference_is(setting):
    env, _ = setting
    env.reset_all()
    legs = env.worlds.qpos[:, 7:19] - env.q_ref[:, :12]
    assert legs.abs().max() < 0.2  # the disturbance of a start is 0.03 rad, one sigma
    expected = env.pool.rows[env.tick * env.pool.streams + env.stream]
    assert torch.equal(env.row, expected)
