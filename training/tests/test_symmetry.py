"""The mirror is a mirror: of the layout, of the network's answer and of the deployed generator's references."""

import os

import numpy as np
import pytest
import torch

from pmg_train.networks import ActorCritic
from pmg_train.ppo import Ppo
from pmg_train.references import ReferenceBatch
from pmg_train.symmetry import Mirror, action_mirror, joint_mirror, observation_mirror

LIBRARY, ROBOT = (os.environ.get(name) for name in ("PMG_BATCH_LIBRARY", "PMG_ROBOT"))
pytestmark = pytest.mark.skipif(not (LIBRARY and ROBOT), reason="PMG_BATCH_LIBRARY, PMG_ROBOT not set")


@pytest.fixture(scope="module")
def description() -> dict:
    return ReferenceBatch(LIBRARY, ROBOT, "pmg", 1, 1, 1).description


def mirrored_quaternion(q: np.ndarray) -> np.ndarray:
    """Of a rotation, in the sagittal plane: roll and yaw change sign."""
    return q * np.array([1, -1, 1, -1])


def test_mirroring_twice_is_identity(description):
    for mirror, size in (
        (observation_mirror(description), description["observation"]["size"]),
        (action_mirror(description), len(description["action_joints"])),
    ):
        x = torch.randn(3, size, generator=torch.Generator().manual_seed(1))
        assert not torch.equal(mirror(x), x)
        assert torch.equal(mirror(mirror(x)), x)


def command_mirrored(command: np.ndarray) -> np.ndarray:
    """vx, vy, omega, pitch, roll, height"""
    return command * np.array([1, -1, -1, 1, -1, 1], np.float32)


def cycle(batch: ReferenceBatch, command: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rows of a settled walk and their phases in [0, 1), sorted by phase."""
    batch.reset()
    rows = batch.run(1200, np.tile(command, (1200, 1, 1)))[800:, 0]
    sine, cosine, _ = rows[:, batch.fields["phase"]].T
    phase = np.arctan2(sine, cosine) / (2 * np.pi) % 1.0
    order = np.argsort(phase)
    return rows[order], phase[order]


def half_a_cycle_later(phase: np.ndarray, other_phase: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Two walks are sampled at different phases: linear interpolation over 0.01 of a cycle sets the tolerances."""
    three = np.concatenate([other_phase - 1, other_phase, other_phase + 1])
    return np.interp((phase + 0.5) % 1.0, three, np.tile(values, 3))


def mirrored_measurements(description: dict, gyro, quat, q, dq, action) -> tuple:
    """What the mirrored robot measures and did last."""
    joints, actions = joint_mirror(description, [j["name"] for j in description["joints"]]), action_mirror(description)
    stand = np.array([j["stand_rad"] for j in description["joints"]])
    through = lambda mirror, x: mirror(torch.from_numpy(x)).numpy()
    return gyro * [-1, 1, -1], mirrored_quaternion(quat), stand + through(joints, q - stand), through(joints, dq), through(actions, action)


@pytest.mark.parametrize("variant", ["pmg", "without_gco", "single_gait"])
def test_a_mirrored_command_gives_the_mirrored_references_half_a_cycle_later(description, variant):
    """The loss relies on this: the policy's inputs are mirror images."""
    batch = ReferenceBatch(LIBRARY, ROBOT, variant, 1, 1, 1)
    command = np.array([0.3, 0.1, 0.4, 0.05, 0.08, -0.04], np.float32)
    rows, phase = cycle(batch, command)
    others, other_phase = cycle(batch, command_mirrored(command))
    names = [j["name"] for j in description["joints"]]
    joints = joint_mirror(description, names)
    of = lambda name: list(description["quantities"][name]["mirror_sign"].values())
    signs = lambda name: Mirror(torch.arange(len(of(name))), torch.tensor(of(name)))
    for field, mirror, tolerance in (
        ("q_ref", joints, 0.01),
        ("dq_ref", joints, 0.2),
        ("phase", signs("phase"), 0.01),
        ("optimised", signs("command"), 0.02),
    ):
        expected = mirror(torch.from_numpy(np.ascontiguousarray(rows[:, batch.fields[field]]))).numpy()
        found = others[:, batch.fields[field]]
        for i in range(found.shape[1]):
            at = half_a_cycle_later(phase, other_phase, found[:, i])
            assert np.abs(at - expected[:, i]).mean() < tolerance, f"{field} {i}"


def test_the_controllers_observation_of_the_mirrored_robot_is_the_mirrored_observation(description):
    """Robot state, history and last action through the C++ assembler; its command and reference are those of rest."""
    random = np.random.default_rng(3)
    stand = np.array([j["stand_rad"] for j in description["joints"]])
    batches = [ReferenceBatch(LIBRARY, ROBOT, "pmg", 1, 1, 1) for _ in range(2)]
    command = np.array([0.0, 0.0, 0.0, 0.1, 0.05, -0.05], np.float32)
    through = lambda mirror, x: mirror(torch.from_numpy(x)).numpy()
    for tick in range(10):
        gyro, quat, action = random.normal(size=3), random.normal(size=4), random.normal(size=12).astype(np.float32)
        quat /= np.linalg.norm(quat)
        q, dq = stand + 0.3 * random.normal(size=31), 3 * random.normal(size=31)
        batches[0].run(1, command[None, None])
        batches[1].run(1, command_mirrored(command)[None, None])
        seen = batches[0].observe(gyro, quat, q, dq, action, first=tick == 0)
        seen_mirrored = batches[1].observe(*mirrored_measurements(description, gyro, quat, q, dq, action), first=tick == 0)
        # Reference joints are exactly symmetric, u' up to where the optimisation stops.
        np.testing.assert_allclose(seen_mirrored, through(observation_mirror(description), seen), atol=1e-4)


def test_a_mirrored_walk_is_observed_as_the_mirrored_observation_half_a_cycle_later(description):
    """Every element of the layout, at a robot that keeps still: what is left changes with the walk. A quantity with one value
    a foot, for instance, must change sides."""
    random = np.random.default_rng(5)
    stand = np.array([j["stand_rad"] for j in description["joints"]])
    gyro, quat, action = random.normal(size=3), random.normal(size=4), random.normal(size=12).astype(np.float32)
    quat /= np.linalg.norm(quat)
    measured = gyro, quat, stand + 0.3 * random.normal(size=31), 3 * random.normal(size=31), action

    def walk(command: np.ndarray, state: tuple) -> tuple[np.ndarray, np.ndarray]:
        batch = ReferenceBatch(LIBRARY, ROBOT, "pmg", 1, 1, 1)
        seen, phase = [], []
        for tick in range(1200):
            sine, cosine, _ = batch.run(1, command[None, None])[0, 0, batch.fields["phase"]]
            seen.append(batch.observe(*state, first=tick == 0))
            phase.append(np.arctan2(sine, cosine) / (2 * np.pi) % 1.0)
        order = np.argsort(phase[800:])
        return np.array(seen[800:])[order], np.array(phase[800:])[order]

    command = np.array([0.3, 0.1, 0.4, 0.05, 0.08, -0.04], np.float32)
    seen, phase = walk(command, measured)
    others, other_phase = walk(command_mirrored(command), mirrored_measurements(description, *measured))
    expected = observation_mirror(description)(torch.from_numpy(seen)).numpy()
    for i, name in enumerate(f"{term['name']} {element}" for term in description["observation"]["terms"] for element in term["elements"]):
        at = half_a_cycle_later(phase, other_phase, others[:, i])
        assert np.abs(at - expected[:, i]).mean() < 0.02, name  # as in the test of references above


def test_the_loss_makes_the_sides_act_alike(description):
    torch.manual_seed(2)
    mirrors = observation_mirror(description), action_mirror(description)
    size, actions = description["observation"]["size"], len(description["action_joints"])
    network = ActorCritic(size, 5, actions, [32], 0.5)
    with torch.no_grad():
        network.actor[-1].weight.mul_(100)
    config = dict(learning_rate=[1e-5, 1e-3])
    ppo = Ppo(network, config, "cpu", mirrors, 1.0)
    seen = torch.randn(256, size)
    before = ppo._asymmetry(seen, network.mean(seen)).item()
    for _ in range(50):
        loss = ppo._asymmetry(seen, network.mean(seen))
        ppo.optimizer.zero_grad()
        loss.backward()
        ppo.optimizer.step()
    assert loss.item() < 0.2 * before
