"""Draws how each robot differs, from randomization.yaml. Shapes: (worlds,), (worlds, 3), (worlds, joints) or (worlds, bodies)."""

from dataclasses import dataclass

import mujoco
import torch


@dataclass
class Robots:
    friction: torch.Tensor
    body_mass: torch.Tensor  # [kg], all bodies
    link_mass: torch.Tensor  # factor of mass and inertia for each body
    torso_com: torch.Tensor  # offset [m]
    armature: torch.Tensor  # factor a joint
    joint_friction: torch.Tensor  # factor a joint
    kp: torch.Tensor  # factor a joint
    kd: torch.Tensor  # factor a joint
    delay_s: torch.Tensor  # from the command to the torque
    encoder_offset: torch.Tensor  # [rad]
    privileged: torch.Tensor  # the critic's extra inputs, of about unit size


def draw(ranges: dict, model: mujoco.MjModel, torso: str, worlds: int, device: str) -> Robots:
    def uniform(bounds, *shape):
        low, high = (-bounds, bounds) if isinstance(bounds, (int, float)) else bounds
        return low + (high - low) * torch.rand(worlds, *shape, device=device)

    joints = model.nu
    link_mass = uniform(ranges["link_mass_factor"], model.nbody)
    mass = torch.tensor(model.body_mass, dtype=torch.float32, device=device) * link_mass
    torso_mass = uniform(ranges["torso_mass_kg"])
    mass[:, model.body(torso).id] += torso_mass
    carries = (torch.rand(worlds, device=device) < ranges["payload_share"]).float()
    payload = torch.stack([uniform(ranges["hand_payload_kg"]), uniform(ranges["hand_payload_kg"])], 1) * carries[:, None]
    for side, name in enumerate(("left", "right")):
        mass[:, model.body(f"{name}_wrist_pitch_link").id] += payload[:, side]
    friction, com = uniform(ranges["friction"]), uniform(ranges["torso_center_of_mass_m"], 3)
    delay = uniform(ranges["delay_s"])
    armature = uniform(ranges["armature_factor"], joints)
    privileged = torch.cat([friction[:, None], torso_mass[:, None] / 3, com * 30, delay[:, None] * 50, payload], 1)
    return Robots(
        friction,
        mass,
        link_mass,
        com,
        armature,
        uniform(ranges["joint_friction_factor"], joints),
        uniform(ranges["kp_factor"], joints),
        uniform(ranges["kd_factor"], joints),
        delay,
        uniform(ranges["encoder_offset_rad"], joints),
        privileged,
    )


def nominal(model: mujoco.MjModel, worlds: int, device: str) -> Robots:
    """Robots without any variation."""
    one = torch.ones(worlds, model.nu, device=device)
    mass = torch.tensor(model.body_mass, dtype=torch.float32, device=device).repeat(worlds, 1)
    return Robots(
        torch.full((worlds,), 0.8, device=device),
        mass,
        torch.ones_like(mass),
        torch.zeros(worlds, 3, device=device),
        one,
        one,
        one,
        one,
        torch.zeros(worlds, device=device),
        0 * one,
        torch.zeros(worlds, 0, device=device),
    )
