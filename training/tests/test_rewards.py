"""Rewards ask for what the evaluation measures: posture on average over a gait, and the reference's own bob at each instant."""

import math
import os
from pathlib import Path

import pytest
import torch

LIBRARY, ROBOT, MJCF = (os.environ.get(name) for name in ("PMG_BATCH_LIBRARY", "PMG_ROBOT", "PMG_MJCF"))
pytestmark = pytest.mark.skipif(not (LIBRARY and ROBOT and MJCF), reason="PMG_BATCH_LIBRARY, PMG_ROBOT, PMG_MJCF not set")
CONFIG = Path(__file__).resolve().parent.parent / "config.yaml"
STEP_HZ = 1.9  # of a walking base's bob: two a gait period


@pytest.fixture(scope="module")
def environment():
    from pmg_train.checked_files import read_randomization
    from pmg_train.configuration import load_config
    from pmg_train.environment import Environment
    from pmg_train.reference_pool import ReferencePool
    from pmg_train.references import ReferenceBatch

    torch.manual_seed(1)
    batch = ReferenceBatch(LIBRARY, ROBOT, "pmg", 1, 1, 1)
    pool = ReferencePool(batch, 2000, "cpu")
    ranges = read_randomization(LIBRARY, CONFIG.with_name("randomization.yaml"))
    return Environment(MJCF, pool, batch.description, batch.fields, load_config(CONFIG), ranges, 1, "cpu")


def terms_after(environment, seconds: float, height_m, roll_rad=lambda t: 0.0, row=None) -> dict[str, float]:
    """Rewards after so many seconds in which the base was at the commanded height + height_m(t), and the torso at the commanded roll
    + roll_rad(t) and at the commanded pitch. row: of the references, a random one if not given."""
    from pmg_train import rewards

    environment.reset_all()
    if row is not None:
        environment.row[0] = row
    environment.strictness.fill_(1.0)
    pitch, roll, height = environment.get("command")[0, 3:6].tolist()
    for k in range(round(seconds / environment.tick_s)):
        t = k * environment.tick_s
        environment.worlds.qpos[0, 2] = environment.standing_height + height + height_m(t)
        x, y = 0.5 * (roll + roll_rad(t)), 0.5 * pitch
        environment.worlds.xquat[0, environment.torso] = torch.tensor(  # turned about y, then about its x
            [math.cos(x) * math.cos(y), math.sin(x) * math.cos(y), math.cos(x) * math.sin(y), -math.sin(x) * math.sin(y)]
        )
        measured, _ = environment._measure()
    return {name: float(value[0]) for name, value in rewards.reward_terms(measured, environment.config["rewards"], 1.0).items()}


def test_a_sag_of_a_centimetre_costs_more_than_a_bob_of_two(environment):
    weights = environment.config["rewards"]
    sag = terms_after(environment, 3.0, lambda t: -0.010)
    forgotten = terms_after(environment, 0.01, lambda t: 0.0)  # a robot that starts anew owes nothing
    assert forgotten["height"] == pytest.approx(weights["height"]["weight"], rel=1e-6)
    bob = terms_after(environment, 3.0, lambda t: 0.020 * math.sin(2 * math.pi * STEP_HZ * t))
    assert sag["height_linear"] == pytest.approx(0.010 * weights["height_linear"], rel=0.01)
    assert bob["height_linear"] > 0.4 * sag["height_linear"]
    assert sag["height"] == pytest.approx(weights["height"]["weight"] * math.exp(-1e-4 / weights["height"]["s"]), rel=0.02)
    assert bob["height"] > 0.95 * weights["height"]["weight"]


def test_a_base_that_bobs_as_its_reference_loses_nothing_and_one_that_does_not_loses(environment):
    rows, weight = environment.pool.rows, environment.config["rewards"]["bob"]
    above_m = rows[:, environment.fields["base_height"]][:, 0] - environment.standing_height - rows[:, environment.fields["command"]][:, 5]
    swaying = int(above_m.abs().argmax())
    reference_m = float(above_m[swaying])
    assert abs(reference_m) > 0.005  # somewhere in 20 s the reference walks
    follows = terms_after(environment, 0.01, lambda t: reference_m, row=rows[swaying])
    assert follows["bob"] == pytest.approx(weight["weight"], rel=1e-4)
    low = terms_after(environment, 0.01, lambda t: reference_m - 0.02, row=rows[swaying])
    assert low["bob"] == pytest.approx(weight["weight"] * math.exp(-4e-4 / weight["s"]), rel=1e-3)


def test_a_torso_that_leans_costs_more_than_one_that_sways_twice_as_far(environment):
    weight = environment.config["rewards"]["attitude_linear"]
    leans = terms_after(environment, 3.0, lambda t: 0.0, lambda t: 0.02)["attitude_linear"]
    sways = terms_after(environment, 3.0, lambda t: 0.0, lambda t: 0.04 * math.sin(2 * math.pi * STEP_HZ * t))["attitude_linear"]
    assert leans == pytest.approx(0.02 * weight, rel=0.01)
    assert sways > 0.4 * leans
