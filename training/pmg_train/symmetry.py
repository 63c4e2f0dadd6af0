"""The mirrored robot: left and right change places. Maps of observations and actions, by the names of the layout.

A robot whose sides are alike should act on a mirrored situation with the mirrored action. PPO is told so with a loss
(Yu, Turk and Liu, Learning symmetric and low-energy locomotion, ACM TOG 2018): |mean(M s) - M mean(s)|^2.
"""

from dataclasses import dataclass

import torch


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
    """ValueError when a term isn't where the ones before it end."""
    index, sign = [], []
    for term in description["observation"]["terms"]:
        name, elements, offset = term["name"], term["elements"], term["offset"]
        if offset != len(index):
            raise ValueError(f"observation term {name} begins at {offset}; expected {len(index)}")
        signs = description["quantities"][name]["mirror_sign"]  # none of joints
        if signs:
            index += range(offset, offset + len(elements))
            sign += [signs[element] for element in elements]
        else:
            joints = joint_mirror(description, elements)
            index += [offset + i for i in joints.index.tolist()]
            sign += joints.sign.tolist()
    return _mirror(index, sign, device)


def action_mirror(description: dict, device="cpu") -> Mirror:
    return joint_mirror(description, description["action_joints"], device)


def _mirror(index: list[int], sign: list[float], device) -> Mirror:
    return Mirror(torch.tensor(index, device=device), torch.tensor(sign, dtype=torch.float32, device=device))
