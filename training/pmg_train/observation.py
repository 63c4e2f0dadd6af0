"""The actor's observation, batched, in the layout that the controller's library tells (src/policy/observation_layout.cpp).

test/data/training/observations.json holds what this code gives; the controller's own assembler is tested against it.
"""

from typing import NamedTuple

import torch

from pmg_train.rotations import rotate_back


class Term(NamedTuple):
    name: str
    columns: slice | torch.Tensor  # of the quantity's values
    scale: float
    origin: torch.Tensor | None

    def of(self, values: dict[str, torch.Tensor]) -> torch.Tensor:
        chosen = values[self.name][:, self.columns]
        if self.origin is not None:
            chosen = chosen - self.origin
        return chosen if self.scale == 1 else self.scale * chosen


def _columns(elements: list[str], available: list[str], device) -> slice | torch.Tensor:
    index = [available.index(element) for element in elements]
    if index == list(range(index[0], index[0] + len(index))):
        return slice(index[0], index[0] + len(index))
    return torch.tensor(index, device=device)


class Observation:
    """description: the library's (ReferenceBatch.description). stand: (joints,) [rad], in the robot's order.

    Values are a dictionary of (worlds, n) tensors by the layout's names: gyro [rad/s], gravity_direction, command (u', or a
    baseline's command), user_command (the admissible one), phase (gain sin, gain cos, gain), q_ref, q [rad], dq_ref, dq [rad/s]
    of all joints, last_action of the policy's. ValueError where frames of different ages hold different terms.
    """

    def __init__(self, description: dict, stand: torch.Tensor, worlds: int):
        self.down = stand.new_tensor([[0.0, 0.0, -1.0]])
        joints = [joint["name"] for joint in description["joints"]]
        ages: dict[int, list[dict]] = {}
        for term in description["observation"]["terms"]:
            ages.setdefault(term["age_ticks"], []).append(term)
        of_layout = lambda term: self._term(term, joints, description, stand)
        self.current = [of_layout(term) for term in ages.pop(0)]
        self.ages = list(ages)
        frames = [[(term["name"], term["scale"], term["elements"]) for term in terms] for terms in ages.values()]
        if any(frame != frames[0] for frame in frames):
            raise ValueError(f"observation: frames of {self.ages} ticks hold different terms; expected the same")
        older = next(iter(ages.values()), [])
        self.older = [of_layout(term) for term in older]
        size = sum(term["size"] for term in older)
        self.history = stand.new_zeros(worlds, max(self.ages, default=0), size)  # newest first

    @staticmethod
    def _term(term: dict, joints: list[str], description: dict, stand: torch.Tensor) -> Term:
        name, elements = term["name"], term["elements"]
        available = description["action_joints"] if name == "last_action" else joints if set(elements) <= set(joints) else elements
        columns = _columns(elements, available, stand.device)
        return Term(name, columns, term["scale"], stand[columns] if description["quantities"][name]["from_stand"] else None)

    def gravity_direction(self, quat: torch.Tensor) -> torch.Tensor:
        """Unit vector down in the base's frame; quat (worlds, 4) w, x, y, z, of any length."""
        return rotate_back(quat / quat.norm(dim=1, keepdim=True), self.down.expand(len(quat), 3))

    def now(self, values: dict[str, torch.Tensor]) -> torch.Tensor:
        """The terms of this tick."""
        return torch.cat([term.of(values) for term in self.current], 1)

    def with_history(self, values: dict[str, torch.Tensor], fresh: torch.Tensor) -> torch.Tensor:
        """The whole vector; stores this tick. fresh (worlds,): the first frame, which also replaces the older ones."""
        if not self.ages:
            return self.now(values)
        frame = torch.cat([term.of(values) for term in self.older], 1)
        self.history.copy_(torch.where(fresh[:, None, None], frame[:, None], self.history))
        seen = torch.cat([self.now(values)] + [self.history[:, age - 1] for age in self.ages], 1)
        self.history.copy_(torch.cat([frame[:, None], self.history[:, :-1]], 1))
        return seen
