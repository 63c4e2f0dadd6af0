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
    pool = ReferencePool(batch, 400, "cpu")
    ranges = read_randomization(LIBRARY, CONFIG.with_name("randomization.yaml"))
    return Environment(MJCF, pool, batch.description, batch.fields, load_config(CONFIG), ranges, 1, "cpu")


def terms_after(environment, seconds: float, height_m) -> dict[str, float]:
    """Rewards of a robot that stands upright with its base at the commanded height + height_m(t), after so many seconds."""
    from pmg_train import rewards

    environment.reset_all()
    environment.strictness.fill_(1.0)
    command = environment.get("command")[0, 3:6].clone()
    for k in range(round(seconds / environment.tick_s)):
        environment.worlds.qpos[0, 2] = environment.standing_height + command[2] + height_m(k * environment.tick_s)
        measured, _ = environment._measure()
    return {name: float(value[0]) for name, value in rewards.reward_terms(measured, environment.config["rewards"], 1.0).items()}


def test_a_sag_of_a_centimetre_costs_more_than_a_bob_of_two(environment):
    weights = environment.config["rewards"]
    sag = terms_after(environment, 4.0, lambda t: -0.010)
    bob = terms_after(environment, 4.0, lambda t: 0.020 * math.sin(2 * math.pi * STEP_HZ * t))
    assert sag["height_linear"] == pytest.approx(0.010 * weights["height_linear"], rel=0.01)
    assert bob["height_linear"] > 0.4 * sag["height_linear"]
    assert sag["height"] == pytest.approx(weights["height"]["weight"] * math.exp(-1e-4 / weights["height"]["s"]), rel=0.02)
    assert bob["height"] > 0.95 * weights["height"]["weight"]


def test_a_base_that_bobs_as_its_reference_loses_nothing_and_one_that_does_not_loses(environment):
    weight = environment.config["rewards"]["bob"]
    reference = float(environment.get("base_height")[0, 0]) - environment.standing_height
    command = float(environment.get("command")[0, 5])
    assert terms_after(environment, 0.01, lambda t: reference - command)["bob"] == pytest.approx(weight["weight"], rel=1e-4)
    low = terms_after(environment, 0.01, lambda t: reference - command - 0.02)["bob"]
    assert low == pytest.approx(weight["weight"] * math.exp(-4e-4 / weight["s"]), rel=1e-3)
