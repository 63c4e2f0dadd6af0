"""The actor's observation, batched: terms, order, scales and ages of src/policy/observation_layout.cpp.

test/data/training/observations.json holds what this code gives; the controller's own assembler is tested against it.
"""

import torch

from pmg_train.rotations import rotate_back

AGES = (2, 4, 6)  # ages of the older frames [ticks]
VELOCITY_SCALE = 0.1


class Observation:
    """stand: (joints,) in the robot's order, whose first `actions` are the policy's."""

    def __init__(self, stand: torch.Tensor, actions: int, worlds: int):
        self.stand, self.actions = stand, actions
        self.down = stand.new_tensor([[0.0, 0.0, -1.0]])
        self.history = stand.new_zeros(worlds, AGES[-1], 6 + 3 * actions)  # newest first

    def gravity_direction(self, quat: torch.Tensor) -> torch.Tensor:
        """Unit vector down in the base's frame; quat (worlds, 4) w, x, y, z, of any length."""
        return rotate_back(quat / quat.norm(dim=1, keepdim=True), self.down.expand(len(quat), 3))

    def now(self, gyro, gravity, q, dq, command, user_command, phase, q_ref, dq_ref, last_action) -> torch.Tensor:
        """The terms of this tick. command: u', or a baseline's command; user_command: the admissible one; phase: gain sin,
        gain cos, gain; q_ref, dq_ref, q, dq of all joints [rad], [rad/s]."""
        return torch.cat(
            [
                gyro,
                gravity,
                command,
                user_command,
                phase,
                q_ref - self.stand,
                VELOCITY_SCALE * dq_ref[:, : self.actions],
                q - self.stand,
                VELOCITY_SCALE * dq,
                last_action,
            ],
            1,
        )

    def with_history(self, now: torch.Tensor, gyro, gravity, q, dq, last_action, fresh: torch.Tensor) -> torch.Tensor:
        """The whole vector; stores this tick. fresh (worlds,): the first frame, which also replaces the older ones."""
        legs = self.actions
        frame = torch.cat([gyro, gravity, q[:, :legs] - self.stand[:legs], VELOCITY_SCALE * dq[:, :legs], last_action], 1)
        self.history.copy_(torch.where(fresh[:, None, None], frame[:, None], self.history))
        seen = torch.cat([now] + [self.history[:, age - 1] for age in AGES], 1)
        self.history.copy_(torch.cat([frame[:, None], self.history[:, :-1]], 1))
        return seen
