"""What the stages of batched actuators share: tensors that change from step to step, delays and periods."""

import torch

from pmg_train.actuator_parameters import NEUTRAL


def has(p: dict[str, torch.Tensor], *names: str) -> bool:
    """Whether any joint has one of these parameters. A stage without work takes no time; this can't depend on values that change later."""
    return any(bool((p[name] != NEUTRAL[name]).any()) for name in names)


class States:
    """Zeros of (worlds, joints), each of which keeps its memory, so that a CUDA graph can hold the steps."""

    def __init__(self, worlds: int, joints: int, device, dtype):
        self.shape, self.device, self.dtype = (worlds, joints), device, dtype
        self.by_name: dict[str, torch.Tensor] = {}

    def new(self, name: str, *before: int) -> torch.Tensor:
        """(*before, worlds, joints)."""
        self.by_name[name] = torch.zeros(*before, *self.shape, device=self.device, dtype=self.dtype)
        return self.by_name[name]

    def new_flag(self, name: str) -> torch.Tensor:
        """(worlds, 1) bool, false."""
        self.by_name[name] = torch.zeros(self.shape[0], 1, device=self.device, dtype=torch.bool)
        return self.by_name[name]


class DelayLine:
    """What went in a while ago, interpolated linearly between two steps; `before` as in States.new."""

    def __init__(self, states: States, name: str, delay_s: torch.Tensor, step_s: float, *before: int):
        steps = delay_s / step_s
        self.used = bool((steps > 0).any())
        ages = torch.arange(int(float(steps.max())) + 2 if self.used else 0, device=states.device, dtype=states.dtype)[:, None]
        whole = torch.trunc(steps)
        share = torch.where(ages == whole, 1 - (steps - whole), torch.where(ages == whole + 1, steps - whole, 0.0))
        self.shares = share.reshape(len(ages), *[1] * len(before), 1, states.shape[1])
        self.past = states.new(name, len(ages), *before)  # newest first
        self.within_step = (1 - steps).clamp(min=0)  # by how much what push() gives changes with what goes in

    def push(self, now: torch.Tensor) -> torch.Tensor:
        """(now) => what came in a delay ago."""
        if not self.used:
            return now
        self.past.copy_(torch.cat([now.expand_as(self.past[0])[None], self.past[:-1]]))
        return (self.shares * self.past).sum(0)

    def a_step_later(self, now: torch.Tensor) -> torch.Tensor:
        """What push(now) would give, without a push."""
        return (self.shares * torch.cat([now[None], self.past[:-1]])).sum(0) if self.used else now


class Period:
    """Something that happens once in so long; joints with a period of 0 have it in every step."""

    def __init__(self, states: States, name: str, period_s: torch.Tensor, step_s: float):
        self.period_s, self.step_s, self.used = period_s, step_s, bool((period_s > 0).any())
        self.every_step = period_s <= step_s
        self.since = states.new(name)

    def reset(self, put) -> None:
        put(self.since, (self.period_s - self.step_s).expand_as(self.since))

    def due(self) -> torch.Tensor:
        """Once a step: whether it is due in this one."""
        if not self.used:
            return self.every_step
        since = self.since + self.step_s
        due = since >= self.period_s - 1e-4 * self.step_s  # a tolerance for single precision
        self.since.copy_(torch.where(due, (since - self.period_s).clamp(max=self.step_s), since))
        return due | self.every_step
