"""Training's batched actuators are the simulation's: every effect, alone and together, against the record of the C++."""

import json
from pathlib import Path

import pytest
import torch

from pmg_train.actuator import ActuatorModel

RECORD = json.loads((Path(__file__).resolve().parents[2] / "test" / "data" / "training" / "actuators.json").read_text())
CASES = list(RECORD["cases"])


def run(model: ActuatorModel, dtype) -> tuple[torch.Tensor, torch.Tensor]:
    """(steps, worlds, joints): torque and slope over the recorded inputs, the same for all."""
    shape = model.states.shape
    everywhere = lambda value: torch.full(shape, value, dtype=dtype)
    model.reset(everywhere(RECORD["steps"][0]["q_rad"]))
    torque, slope = [], []
    for s in RECORD["steps"]:
        t, k = model.step(
            everywhere(s["q_des_rad"]),
            everywhere(s["kp"]),
            everywhere(s["kd"]),
            everywhere(s["q_rad"]),
            everywhere(s["dq_rad_s"]),
            s["dq_des_rad_s"],
            s["feed_forward_Nm"],
            s["supply"],
            s["enabled"],
            s["temperature_C"],
            s["external_Nm"],
        )
        torque.append(t.clone())
        slope.append(k.clone())
    return torch.stack(torque), torch.stack(slope)


def test_all_joints_at_once_equal_the_simulations():
    """All cases in one batch: no joint may feel another's effect."""
    model = ActuatorModel([RECORD["cases"][c]["parameters"] for c in CASES], RECORD["step_s"], 2, dtype=torch.float64)
    torque, slope = run(model, torch.float64)
    for joint, case in enumerate(CASES):
        for found, name in ((torque, "torque_Nm"), (slope, "slope_Nm_s_per_rad")):
            expected = torch.tensor(RECORD["cases"][case][name], dtype=torch.float64)
            for world in range(2):
                # Rounding of the same arithmetic; 1e-5 is what is asked.
                assert (found[:, world, joint] - expected).abs().max() < 1e-9, f"{case}: {name}"


@pytest.mark.parametrize("case", CASES)
def test_a_joint_alone_equals_the_simulations(case):
    """Stages that no joint of a batch needs are left out; those of this joint aren't."""
    model = ActuatorModel([RECORD["cases"][case]["parameters"]], RECORD["step_s"], 1, dtype=torch.float64)
    for found, name in zip(run(model, torch.float64), ("torque_Nm", "slope_Nm_s_per_rad"), strict=True):
        assert (found[:, 0, 0] - torch.tensor(RECORD["cases"][case][name], dtype=torch.float64)).abs().max() < 1e-9, name


@pytest.mark.parametrize("case", CASES)
def test_single_precision_is_enough(case):
    """Where a number is rounded or a friction changes its sign a step earlier or later, single precision may differ for that step."""
    model = ActuatorModel([RECORD["cases"][case]["parameters"]], RECORD["step_s"], 1)
    error = (run(model, torch.float32)[0][:, 0, 0] - torch.tensor(RECORD["cases"][case]["torque_Nm"])).abs()
    assert error.median() < 1e-4  # of torques of 10 Nm


@pytest.mark.parametrize("case", ["much, elastic", "much, rigid", "residual of error, time and bend", "residual of integral, drive and rest"])
def test_a_reset_forgets_in_the_worlds_that_are_reset(case):
    parameters = RECORD["cases"][case]["parameters"]
    used, fresh = (ActuatorModel([parameters], RECORD["step_s"], 2, dtype=torch.float64) for _ in range(2))
    run(used, torch.float64)
    at = torch.full((2, 1), 0.1, dtype=torch.float64)
    used.reset(at, torch.tensor([True, False]))
    fresh.reset(at)
    for k in range(10):
        (torque, _), (expected, _) = (model.step(at + 0.01 * k, 60 + 0 * at, 2 + 0 * at, at, 0 * at) for model in (used, fresh))
        assert torch.equal(torque[0], expected[0])
        assert k > 0 or not torch.equal(torque[1], expected[1])


def test_a_late_sensors_reading_is_late_by_its_delay():
    for late_s in (0.007, 0.0005):
        model = ActuatorModel([{"sensor.delay_s": late_s}], 0.002, 1, dtype=torch.float64)
        at = lambda t_s: torch.full((1, 1), t_s, dtype=torch.float64)
        model.reset(at(0.0))
        for k in range(10):  # a joint at 1 rad/s: its angle is the time
            model.step(at(0.0), at(1.0), at(0.0), at(0.002 * k), at(1.0))
            assert abs(float(model.reading(at(0.002 * (k + 1)))) - max(0.0, 0.002 * (k + 1) - late_s)) < 1e-12
