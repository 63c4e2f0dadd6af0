"""Actor and critic with their input normalisation."""

import math

import torch
import torch.distributed as dist
from torch import nn


def mlp(inputs: int, hidden: list[int], outputs: int) -> nn.Sequential:
    layers: list[nn.Module] = []
    for width in hidden:
        layers += [nn.Linear(inputs, width), nn.ELU()]
        inputs = width
    return nn.Sequential(*layers, nn.Linear(inputs, outputs))


class Normalizer(nn.Module):
    """Running mean and variance; the output is clamped to +-8 standard deviations."""

    def __init__(self, size: int):
        super().__init__()
        self.register_buffer("mean", torch.zeros(size))
        self.register_buffer("variance", torch.ones(size))
        self.register_buffer("count", torch.zeros(()))

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        return ((x - self.mean) * torch.rsqrt(self.variance + 1e-4)).clamp(-8, 8)

    @torch.no_grad()
    def update(self, x: torch.Tensor) -> None:
        """With the samples of all processes, so that their networks stay equal."""
        moments = torch.stack([x.mean(0), (x**2).mean(0)])
        if dist.is_initialized():
            dist.all_reduce(moments)
            moments /= dist.get_world_size()
        mean, square = moments
        share = torch.clamp(1 / (self.count + 1), min=0.002)
        self.count += 1
        delta = mean - self.mean
        self.mean += share * delta
        self.variance += share * ((square - mean**2).clamp(min=0) - self.variance) + share * (1 - share) * delta**2


class ActorCritic(nn.Module):
    def __init__(self, observations: int, critic_observations: int, actions: int, hidden: list[int], std: float):
        super().__init__()
        self.actor, self.critic = mlp(observations, hidden, actions), mlp(critic_observations, hidden, 1)
        self.actor_norm, self.critic_norm = Normalizer(observations), Normalizer(critic_observations)
        self.log_std = nn.Parameter(torch.full((actions,), math.log(std)))
        with torch.no_grad():
            self.actor[-1].weight.mul_(0.01)
            self.actor[-1].bias.zero_()

    def mean(self, seen: torch.Tensor) -> torch.Tensor:
        return self.actor(self.actor_norm(seen))

    def value(self, seen: torch.Tensor) -> torch.Tensor:
        return self.critic(self.critic_norm(seen))[:, 0]

    def std(self) -> torch.Tensor:
        return self.log_std.clamp(-3.5, 0.3).exp()


def log_probability(action: torch.Tensor, mean: torch.Tensor, std: torch.Tensor) -> torch.Tensor:
    return (-0.5 * ((action - mean) / std) ** 2 - std.log() - 0.5 * math.log(2 * math.pi)).sum(1)
