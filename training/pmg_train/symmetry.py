"""The mirrored robot: left and right change places. Maps of observations and actions, by the names of the layout.

A robot whose sides are alike should act on a mirrored situation with the mirrored action. PPO is told so with a loss
(Yu, Turk and Liu, Learning symmetric and low-energy locomotion, ACM TOG 2018): |mean(M s) - M mean(s)|^2.
"""

from dataclasses import dataclass

import torch

# Reflection in the sagittal plane: y turns round in vectors, x and z in axial vectors such as a rate of rotation; the gait
# is shifted by half a cycle.
SIGNS = {
    "gyro": {"x": -1, "y": 1, "z": -1},
    "gravity_direction": {"x": 1, "y": -1, "z": 1},
    "command": {"vx_m_s": 1, "vy_m_s": -1, "omega_rad_s": -1, "pitch_rad": 1, "roll_rad": -1, "height_m": 1},
    "user_command": {"vx_m_s": 1, "vy_m_s": -1, "omega_rad_s": -1, "pitch_rad": 1, "roll_rad": -1, "height_m": 1},
    "phase": {"gain_sin": -1, "gain_cos": -1, "gain": 1},
}
JOINT_TERMS = ("q_ref", "dq_ref", "q", "dq", "last_action")


@dataclass
class Mirror:
    """mirrored[..., i] = sign[i] * x[..., index[i]]"""

    index: torch.Tensor
    sign: torch.Tensor

    def __call__(self, x: torch.Tensor) -> torch.Tensor:
        return x.index_select(-1, self.index) * self.sign


def joint_mirror(description: dict, names: list[str], device="cpu") -> Mirror:
    """For values of these joints, in this order (angles from the standing posture, velocities, actions)."""
    joints = {j["name"]: j for j in description["joints"]}
    index = [names.index(joints[name]["mirror_joint"]) for name in names]
    return _mirror(index, [joints[name]["mirror_sign"] for name in names], device)


def observation_mirror(description: dict, device="cpu") -> Mirror:
    """ValueError when the layout has a term or an element whose mirror image isn't known."""
    index, sign = [], []
    for term in description["observation"]["terms"]:
        name, elements, offset = term["name"], term["elements"], term["offset"]
        if offset != len(index):
            raise ValueError(f"observation term {name} begins at {offset}; expected {len(index)}")
        if name in JOINT_TERMS:
            joints = joint_mirror(description, elements)
            index += [offset + i for i in joints.index.tolist()]
            sign += joints.sign.tolist()
        elif name in SIGNS and all(element in SIGNS[name] for element in elements):
            index += range(offset, offset + len(elements))
            sign += [SIGNS[name][element] for element in elements]
        else:
            raise ValueError(f"observation term {name} {elements}: no mirror image known")
    return _mirror(index, sign, device)


def action_mirror(description: dict, device="cpu") -> Mirror:
    return joint_mirror(description, description["action_joints"], device)


def _mirror(index: list[int], sign: list[float], device) -> Mirror:
    return Mirror(torch.tensor(index, device=device), torch.tensor(sign, dtype=torch.float32, device=device))
