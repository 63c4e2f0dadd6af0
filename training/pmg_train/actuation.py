"""(a tick's target) => the targets at the drives, as in src/sim: delay, and the length of a physics step."""

import math

import torch


def step_lead_s(step_s: float, deployed_step_s: float) -> float:
    """How much earlier a command acts in training's longer steps.

    A semi-implicit Euler step applies the force of its beginning to a velocity half a step later. So every change from step
    to step acts half a step early, here and in the controller's simulation: lead = (step - deployed step) / 2.
    """
    return (step_s - deployed_step_s) / 2


def target_shares(delay_s: torch.Tensor, tick_s: float, step_s: float, deployed_step_s: float) -> torch.Tensor:
    """(steps of a tick, ages, worlds, 1): the share of each physics step in which the target of that age [ticks] is at the drive.

    delay_s (worlds,) may have any value: the step in which it ends gets the weighted mean of both targets.
    """
    late = delay_s + step_lead_s(step_s, deployed_step_s)
    steps, ages = round(tick_s / step_s), 1 + math.ceil(float(late.max()) / tick_s - 1e-9)
    shares = torch.zeros(steps, ages, len(delay_s), 1, device=delay_s.device)
    for step in range(steps):
        for age in range(ages):
            begins, ends = late - age * tick_s, late - (age - 1) * tick_s
            overlap = ends.clamp(max=(step + 1) * step_s) - begins.clamp(min=step * step_s)
            shares[step, age, :, 0] = overlap.clamp(min=0) / step_s
    return shares


def step_inertia(kd: torch.Tensor, step_s: float, deployed_step_s: float) -> torch.Tensor:
    """Inertia [kg m^2] that a damping kd [Nm s/rad], taken at the end of a step, adds beyond that of the deployed step:
    kd * lead."""
    return kd * step_lead_s(step_s, deployed_step_s)
