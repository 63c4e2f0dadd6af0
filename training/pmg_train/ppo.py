"""Proximal policy optimisation on preallocated buffers.

Own code and not rsl_rl's: acting and rewards run inside CUDA graphs here, so nothing may allocate, rebind a tensor or
wait for the host between two ticks; the learning rate is a tensor on the device for the same reason.
"""

import torch
import torch.distributed as dist
from torch import nn

from pmg_train.networks import ActorCritic, log_probability
from pmg_train.symmetry import Mirror


class Rollout:
    def __init__(self, steps: int, worlds: int, observations: int, critic_observations: int, actions: int, device):
        zeros = lambda *shape: torch.zeros(*shape, device=device)
        self.seen, self.critic_seen = zeros(steps, worlds, observations), zeros(steps, worlds, critic_observations)
        self.action, self.mean = zeros(steps, worlds, actions), zeros(steps, worlds, actions)
        self.log_probability, self.reward = zeros(steps, worlds), zeros(steps, worlds)
        self.done, self.timeout = zeros(steps, worlds), zeros(steps, worlds)
        self.value = zeros(steps + 1, worlds)

    def advantages(self, gamma: float, lambda_: float) -> torch.Tensor:
        """Generalised advantage estimation. An episode that ends by time alone gets the value of its last state."""
        steps = self.reward.shape[0]
        out, running = torch.empty_like(self.reward), torch.zeros_like(self.reward[0])
        for t in reversed(range(steps)):
            goes_on = 1 - self.done[t]
            reward = self.reward[t] + gamma * self.timeout[t] * self.value[t]
            delta = reward + gamma * self.value[t + 1] * goes_on - self.value[t]
            running = delta + gamma * lambda_ * goes_on * running
            out[t] = running
        return out


class Ppo:
    """mirrors: of observations and of actions. symmetry: the weight of the mirror loss; 0 switches it off."""

    def __init__(self, network: ActorCritic, config: dict, device, mirrors: tuple[Mirror, Mirror], symmetry: float):
        self.network, self.config = network, config
        self.mirror_seen, self.mirror_action = mirrors
        self.symmetry = symmetry
        self.rate = torch.tensor(config["learning_rate"][1], device=device)
        cuda = self.rate.is_cuda
        self.optimizer = torch.optim.Adam(network.parameters(), lr=self.rate if cuda else float(self.rate), fused=cuda)
        self.world_size = dist.get_world_size() if dist.is_initialized() else 1

    def update(self, rollout: Rollout, entropy: float) -> dict[str, torch.Tensor]:
        c, net = self.config, self.network
        flat = lambda x: x.flatten(0, 1)
        advantage = rollout.advantages(c["gamma"], c["lambda"])
        returns = flat(advantage + rollout.value[:-1])
        advantage = flat(advantage)
        advantage = (advantage - advantage.mean()) / (advantage.std() + 1e-6)
        seen, critic_seen, action = flat(rollout.seen), flat(rollout.critic_seen), flat(rollout.action)
        old_log, old_mean, old_std = flat(rollout.log_probability), flat(rollout.mean), net.std().detach().clone()
        samples = action.shape[0]
        size = samples // c["minibatches"]
        sums = torch.zeros(4, device=action.device)
        for _ in range(c["epochs"]):
            order = torch.randperm(samples, device=action.device)
            for k in range(c["minibatches"]):
                i = order[k * size : (k + 1) * size]
                seen_i = seen[i]
                mean, std = net.mean(seen_i), net.std()
                with torch.no_grad():
                    kl = (torch.log(std / old_std) + (old_std**2 + (old_mean[i] - mean) ** 2) / (2 * std**2) - 0.5).sum(1).mean()
                    self._adapt(kl)
                ratio = torch.exp(log_probability(action[i], mean, std) - old_log[i])
                gain = advantage[i]
                clipped = ratio.clamp(1 - c["clip"], 1 + c["clip"])
                policy_loss = -torch.min(ratio * gain, clipped * gain).mean()
                value_loss = ((net.value(critic_seen[i]) - returns[i]) ** 2).mean()
                loss = policy_loss + value_loss - entropy * std.log().sum()
                asymmetry = torch.zeros_like(kl)
                if self.symmetry:
                    asymmetry = self._asymmetry(seen_i, mean)
                    loss = loss + self.symmetry * asymmetry
                self.optimizer.zero_grad(set_to_none=True)
                loss.backward()
                self._average_gradients()
                nn.utils.clip_grad_norm_(net.parameters(), c["gradient_norm"])
                self.optimizer.step()
                sums += torch.stack([kl, value_loss.detach(), policy_loss.detach(), asymmetry.detach()])
        kl, value_loss, policy_loss, asymmetry = sums / (c["epochs"] * c["minibatches"])
        with torch.no_grad():
            some = seen[::4]
            # With its mirror image: equal normalisation of both sides allows equal answers.
            net.actor_norm.update(torch.cat([some, self.mirror_seen(some)]) if self.symmetry else some)
            net.critic_norm.update(critic_seen[::4])
        return dict(kl=kl, value_loss=value_loss, policy_loss=policy_loss, asymmetry=asymmetry)

    def _asymmetry(self, seen: torch.Tensor, mean: torch.Tensor) -> torch.Tensor:
        """Mean over the samples of |mean(M s) - M mean(s)|^2, summed over the joints, in units of the action."""
        return ((self.network.mean(self.mirror_seen(seen)) - self.mirror_action(mean)) ** 2).sum(1).mean()

    def _adapt(self, kl: torch.Tensor) -> None:
        if self.world_size > 1:
            self._average(kl)
        low, high = self.config["learning_rate"]
        target = self.config["kl_target"]
        rate = torch.where(kl > 2 * target, self.rate / 1.5, torch.where(kl < target / 2, self.rate * 1.5, self.rate))
        self.rate.copy_(rate.clamp(low, high))
        if not self.rate.is_cuda:
            for group in self.optimizer.param_groups:
                group["lr"] = float(self.rate)

    def _average(self, values: torch.Tensor) -> None:
        """In place, over the processes. Gloo, which is the CPU's, knows no average in every version of torch."""
        dist.all_reduce(values)
        values.div_(self.world_size)

    def _average_gradients(self) -> None:
        if self.world_size == 1:
            return
        gradients = [p.grad for p in self.network.parameters() if p.grad is not None]
        together = torch.cat([g.flatten() for g in gradients])
        self._average(together)
        at = 0
        for g in gradients:
            g.copy_(together[at : at + g.numel()].view_as(g))
            at += g.numel()
