"""Trains one policy. Longer than 300 lines: one loop, recorded as CUDA graphs, whose parts share its tensors.

Example, one GPU:     python3 -m pmg_train.train --robot config/robots/z1 --mjcf z1.xml --library libpmg_batch.so \\
                          --out runs/pmg --minutes 20
Several GPUs:         torchrun --nproc-per-node 4 -m pmg_train.train ... (worlds are per GPU)
Go on where it ended: the same command with --resume.

Exit codes: 0 done, 2 bad input.
"""

import argparse
import csv
import json
import os
import signal
import sys
import time
from pathlib import Path

import torch
import torch.distributed as dist
import warp as wp
import yaml

from pmg_train.checked_files import read_motor_file, read_randomization
from pmg_train.configuration import load_config
from pmg_train.environment import Environment
from pmg_train.inputs import changed_inputs, input_hashes
from pmg_train.networks import ActorCritic, log_probability
from pmg_train.ppo import Ppo, Rollout
from pmg_train.reference_pool import ReferencePool
from pmg_train.references import ReferenceBatch
from pmg_train.symmetry import action_mirror, observation_mirror

HERE = Path(__file__).resolve().parent.parent


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robot", required=True, help="the robot's directory")
    parser.add_argument("--mjcf", required=True, help="written by pmg_sil --export-mjcf")
    parser.add_argument("--library", required=True, help="libpmg_batch.so")
    parser.add_argument("--variant", default="pmg", choices=["pmg", "without_gco", "single_gait"])
    parser.add_argument("--config", default=HERE / "config.yaml", type=Path)
    parser.add_argument("--randomization", default=HERE / "randomization.yaml", type=Path)
    parser.add_argument("--motor", type=Path, help="motor.yaml of the calibration tools: what actuators do beyond a plain servo")
    parser.add_argument("--out", required=True, type=Path)
    parser.add_argument("--minutes", type=float, default=20.0, help="wall time of learning, earlier parts of a resumed run counted")
    parser.add_argument("--iterations", type=int, default=10**9)
    parser.add_argument("--worlds", type=int, help="instead of the configuration's")
    parser.add_argument("--streams", type=int, help="instead of the configuration's")
    parser.add_argument("--ticks", type=int, help="instead of the configuration's")
    parser.add_argument("--device", default="cuda" if torch.cuda.is_available() else "cpu")
    parser.add_argument("--threads", type=int, default=0, help="for making references; 0: all cores")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--resume", action="store_true")
    parser.add_argument("--initial", type=Path, help="start with the networks of this last.pt")
    parser.add_argument("--checkpoint-s", type=float, default=60.0)
    parser.add_argument("--keep-every-s", type=float, default=240.0, help="checkpoints that are kept beside the last")
    return parser.parse_args()


class Training:
    def __init__(self, a: argparse.Namespace):
        self.a, self.started = a, time.time()
        self.rank = int(os.environ.get("RANK", 0))
        self.device = a.device
        if self.device == "cuda":
            self.device = f"cuda:{os.environ.get('LOCAL_RANK', 0)}"
        self.cuda = self.device.startswith("cuda")
        self.config, self.ranges = load_config(a.config), read_randomization(a.library, a.randomization)
        self.inputs = input_hashes(a)
        c, ppo = self.config, self.config["ppo"]
        for key, value in (("streams", a.streams), ("ticks", a.ticks)):
            c["references"][key] = value or c["references"][key]
        ppo["worlds"] = a.worlds or ppo["worlds"]
        self._start_device()
        torch.manual_seed(a.seed + 7919 * self.rank)

        batch = ReferenceBatch(a.library, a.robot, a.variant, c["references"]["streams"], (a.seed + 7919 * self.rank) * 1_000_003, a.threads)
        self.description = batch.description
        pool = ReferencePool(batch, c["references"]["ticks"], self.device)
        self.log(f"references ready: {pool.streams} streams of {pool.ticks} ticks")
        self.motors = read_motor_file(a.library, a.robot, a.motor) if a.motor else {}
        self.env = Environment(a.mjcf, pool, batch.description, batch.fields, c, self.ranges, ppo["worlds"], self.device, self.motors)
        seen = self.env.observation.shape[1]
        if seen != batch.description["observation"]["size"]:
            raise ValueError(f"observation has {seen} numbers; the controller's has {batch.description['observation']['size']}")
        self.network = ActorCritic(seen, self.env.critic_observation.shape[1], self.env.actions, ppo["hidden"], ppo["initial_std"]).to(self.device)
        if dist.is_initialized():
            for tensor in self.network.state_dict().values():
                dist.broadcast(tensor, 0)
        self.mean_actor = {k: v.clone() for k, v in self._actor().items()}
        mirrors = observation_mirror(batch.description, self.device), action_mirror(batch.description, self.device)
        self.ppo = Ppo(self.network, ppo, self.device, mirrors, c["symmetry"]["weight"])
        self.rollout = Rollout(ppo["steps"], ppo["worlds"], seen, self.env.critic_observation.shape[1], self.env.actions, self.device)
        n, actions = ppo["worlds"], self.env.actions
        self.sample, self.sample_mean = torch.zeros(n, actions, device=self.device), torch.zeros(n, actions, device=self.device)
        self.sample_log, self.sample_value = torch.zeros(n, device=self.device), torch.zeros(n, device=self.device)
        self.sums: torch.Tensor | None = None
        self.iteration, self.steps, self.learned_s, self.curve = 0, 0, 0.0, []
        self.stop, self.board = False, None
        a.out.mkdir(parents=True, exist_ok=True)
        self._record()
        self.bare_steps_per_s = self._time_bare_steps()
        with torch.no_grad():
            self.env.reset_all()
            self.env.look()
        if a.resume:
            self._load()
        elif a.initial:
            self._start_from(a.initial)
        if self.rank == 0:
            (a.out / "training.yaml").write_text(
                yaml.safe_dump(
                    dict(
                        variant=a.variant,
                        seed=a.seed,
                        processes=self.ppo.world_size,
                        inputs=self.inputs,
                        config=self.config,
                        randomization=self.ranges,
                        motors=self.motors,
                    ),
                    sort_keys=False,
                )
            )
            self.board = _tensorboard(a.out)

    def log(self, text: str) -> None:
        if self.rank == 0:
            print(f"[{time.time() - self.started:7.1f}] {text}", flush=True)

    def _start_device(self) -> None:
        torch.backends.cuda.matmul.allow_tf32 = True
        torch.set_float32_matmul_precision("high")
        if self.cuda:
            torch.cuda.set_device(self.device)
            self.torch_stream = torch.cuda.Stream()
            torch.cuda.set_stream(self.torch_stream)
        if "WORLD_SIZE" in os.environ and int(os.environ["WORLD_SIZE"]) > 1:
            dist.init_process_group("nccl" if self.cuda else "gloo")
        wp.config.quiet = True
        wp.init()
        if self.cuda:
            wp.set_stream(wp.stream_from_torch(self.torch_stream), self.device)

    # ------------------------------------------------------------------------------------------------------- one tick

    def _act(self) -> None:
        with torch.no_grad():
            mean, std = self.network.mean(self.env.observation), self.network.std()
            action = mean + std * torch.randn_like(mean)
            self.sample.copy_(action)
            self.sample_mean.copy_(mean)
            self.sample_log.copy_(log_probability(action, mean, std))
            self.sample_value.copy_(self.network.value(self.env.critic_observation))
            self.env.act(self.sample)

    def _observe(self) -> None:
        with torch.no_grad():
            env = self.env
            env.observe()
            values = [t.mean() for t in env.terms.values()] + [t.mean() for t in env.errors.values()]
            values += [env.fallen.float().mean(), env.timeout.mean(), env.reward.mean()]
            together = torch.nan_to_num(torch.stack(values))
            if self.sums is None:
                self.sums = torch.zeros_like(together)
            self.sums += together

    def _names(self) -> list[str]:
        return [f"reward/{k}" for k in self.env.terms] + [f"error/{k}" for k in self.env.errors] + ["falls", "timeouts", "reward"]

    def _record(self) -> None:
        """Compiles everything. On a GPU the two torch halves of a tick become CUDA graphs, like the physics."""
        self.env.worlds.capture()
        self.act, self.observe = self._act, self._observe
        for _ in range(3 if self.cuda else 1):
            self._act()
            self.env.worlds.step()
            self._observe()
        if self.cuda:
            torch.cuda.synchronize()
            graphs = []
            for part in (self._act, self._observe):
                graph = torch.cuda.CUDAGraph()
                with torch.cuda.graph(graph, stream=self.torch_stream):
                    part()
                graphs.append(graph)
            torch.cuda.synchronize()
            wp.set_stream(wp.get_stream(self.device), self.device)
            self.act, self.observe = graphs[0].replay, graphs[1].replay
        self.sums.zero_()
        self.log("compiled")

    def _time_bare_steps(self, calls: int = 40) -> float:
        """World ticks per second of the physics alone, in this run."""
        step = self.env.worlds.step
        step()
        if self.cuda:
            torch.cuda.synchronize()
        start = time.time()
        for _ in range(calls):
            step()
        if self.cuda:
            torch.cuda.synchronize()
        return calls * self.env.n / (time.time() - start)

    # ------------------------------------------------------------------------------------------------------- learning

    def run(self) -> None:
        a, ppo, env, r = self.a, self.config["ppo"], self.env, self.rollout
        last_saved = last_kept = time.time()
        while not self._any_rank(self.stop or self.learned_s >= 60 * a.minutes or self.iteration >= a.iterations):
            start = time.time()
            kicks = self.ranges["kicks"]
            ramp = min(1.0, self.iteration / kicks["ramp_iterations"])
            env.kick_share.fill_(kicks["from_share"] + (1 - kicks["from_share"]) * ramp)
            env.strictness.fill_(self._strictness())
            for t in range(ppo["steps"]):
                r.seen[t].copy_(env.observation)
                r.critic_seen[t].copy_(env.critic_observation)
                self.act()
                env.worlds.step()
                self.observe()
                for target, value in (
                    (r.action, self.sample),
                    (r.mean, self.sample_mean),
                    (r.log_probability, self.sample_log),
                    (r.value, self.sample_value),
                    (r.reward, env.reward),
                    (r.done, env.done),
                    (r.timeout, env.timeout),
                ):
                    target[t].copy_(value)
            with torch.no_grad():
                r.value[-1].copy_(self.network.value(env.critic_observation))
            done = min(1.0, self.iteration / ppo["entropy_iterations"])
            first, last = ppo["entropy"]
            info = self.ppo.update(r, first + (last - first) * done)
            self.iteration += 1
            self._average()
            self.steps += ppo["steps"] * ppo["worlds"] * self.ppo.world_size
            if self.cuda and self.iteration % 10 == 0:
                torch.cuda.synchronize()
            self.learned_s += time.time() - start
            if self.iteration in (1, 2, 5, 10) or self.iteration % 25 == 0 or not self.cuda:
                self._report(info)
            if self._any_rank(time.time() - last_saved > a.checkpoint_s):
                last_saved = time.time()
                self.save()
                if self.rank == 0 and time.time() - last_kept > a.keep_every_s:
                    last_kept = time.time()
                    self.save_actor(a.out / f"actor_{self.iteration}.pt")
        self.save()
        self.log(f"done: {self.iteration} iterations, {self.steps / 1e6:.0f} M steps, {self.learned_s / 60:.1f} min")

    def _strictness(self) -> float:
        """Share of the linear errors' weight in this iteration."""
        ramp = self.config["strictness"]
        first, last = ramp["iterations"]
        done = min(1.0, max(0.0, (self.iteration - first) / max(1.0, last - first)))
        return ramp["from_share"] + (1 - ramp["from_share"]) * done

    def _actor(self) -> dict[str, torch.Tensor]:
        return {k: v for k, v in self.network.state_dict().items() if k.startswith("actor")}

    def _average(self) -> None:
        """Exponential mean of the actor over about `mean_iterations`; of all iterations so far while they are fewer."""
        share = 1.0 / min(self.iteration, self.config["ppo"]["mean_iterations"])
        now = self._actor()
        for name, mean in self.mean_actor.items():
            mean.lerp_(now[name], share)

    def _any_rank(self, true_here: bool) -> bool:
        """All ranks end and save together."""
        if not dist.is_initialized():
            return true_here
        flag = torch.tensor(float(true_here), device=self.device)
        dist.all_reduce(flag, op=dist.ReduceOp.MAX)
        return bool(flag)

    def _report(self, info: dict) -> None:
        since = self.iteration - (self.curve[-1]["iteration"] if self.curve else 0)
        values = (self.sums / (self.config["ppo"]["steps"] * max(1, since))).tolist()
        self.sums.zero_()
        row = dict(
            iteration=self.iteration,
            minutes=self.learned_s / 60,
            steps=self.steps,
            steps_per_s=self.steps / max(1e-9, self.learned_s),
            learning_rate=float(self.ppo.rate),
            std=float(self.network.std().detach().mean()),
            kl=float(info["kl"]),
            value_loss=float(info["value_loss"]),
            asymmetry=float(info["asymmetry"]),
        )
        row |= dict(zip(self._names(), values, strict=True))
        row["falls_per_minute"] = row.pop("falls") * 60 / self.env.tick_s
        self.curve.append(row)
        constraints, contacts = self.env.worlds.fullest() if self.iteration % 100 == 0 or len(self.curve) == 1 else (0, 0)
        e = lambda name: row[f"error/{name}"]
        self.log(
            f"{self.iteration} {row['minutes']:.2f} min {self.steps / 1e6:.0f}M {row['steps_per_s'] / 1e3:.0f}k/s "
            f"reward {row['reward']:.4f} falls/min {row['falls_per_minute']:.2f} v {e('velocity'):.3f} yaw {e('yaw_rate'):.3f} "
            f"pitch {e('pitch'):.3f} roll {e('roll'):.3f} h {e('height'):.4f} q {e('joint'):.3f} ankle {e('ankle_pitch'):.3f} "
            f"contact {e('contact'):.3f} tau {e('torque'):.1f} a {e('action'):.2f} std {row['std']:.2f} kl {row['kl']:.4f} "
            f"lr {row['learning_rate']:.1e} vl {row['value_loss']:.3f} sides {row['asymmetry']:.3f} broken {e('broken'):.1e}"
            + (f" rows {constraints} contacts {contacts}" if constraints else "")
        )
        if self.rank == 0:
            with open(self.a.out / "curve.csv", "w", newline="") as file:
                writer = csv.DictWriter(file, fieldnames=list(self.curve[-1]))
                writer.writeheader()
                writer.writerows(self.curve)
        if self.board:
            for name, value in row.items():
                self.board.add_scalar(name, value, self.iteration)
            self.board.flush()

    # ---------------------------------------------------------------------------------------------------- checkpoints

    def _meta(self) -> dict:
        return dict(
            description=self.description,
            config=self.config,
            randomization=self.ranges,
            variant=self.a.variant,
            seed=self.a.seed,
            processes=self.ppo.world_size,
            inputs=self.inputs,
            iteration=self.iteration,
            steps=self.steps,
            learned_s=self.learned_s,
        )

    def save_actor(self, path: Path) -> None:
        """`actor` is the policy: the mean. `last_actor` is what it was a mean of last."""
        cpu = lambda actor: {k: v.cpu() for k, v in actor.items()}
        _write(dict(actor=cpu(self.mean_actor), last_actor=cpu(self._actor()), **self._meta()), path)

    def save(self) -> None:
        """last.pt: networks, optimiser and curve. worlds.pt: the state of each process, for an exact continuation. actor.pt: the policy
        so far, so that a host that goes away takes a minute of training with it, not all of it."""
        if self.rank == 0:
            self.save_actor(self.a.out / "actor.pt")
            _write(
                dict(
                    network=self.network.state_dict(),
                    mean_actor=self.mean_actor,
                    optimizer=self.ppo.optimizer.state_dict(),
                    rate=self.ppo.rate,
                    curve=self.curve,
                    **self._meta(),
                ),
                self.a.out / "last.pt",
            )
        _write(
            dict(
                processes=self.ppo.world_size,
                iteration=self.iteration,
                worlds=self.env.state(),
                random=torch.get_rng_state(),
                random_device=torch.cuda.get_rng_state(self.device) if self.cuda else None,
            ),
            self._worlds_file(),
        )

    def _worlds_file(self) -> Path:
        return self.a.out / ("worlds.pt" if self.rank == 0 else f"worlds_{self.rank}.pt")

    def _load(self) -> None:
        """Continues exactly where the run ended. Without a fitting worlds.pt (as for another number of worlds) it starts new episodes."""
        path = self.a.out / "last.pt"
        state = torch.load(path, map_location=self.device, weights_only=False)
        if state["variant"] != self.a.variant:
            raise ValueError(f"{path} is a {state['variant']} policy")
        if changed := changed_inputs(state["inputs"], self.inputs):
            raise ValueError(f"{path} was made from another {', '.join(changed)}; start a new run, with --initial if it shall go on from this one")
        self.network.load_state_dict(state["network"])
        self.mean_actor = state["mean_actor"]
        self.ppo.optimizer.load_state_dict(state["optimizer"])
        self.ppo.rate.copy_(state["rate"])
        if self.cuda:
            for group in self.ppo.optimizer.param_groups:
                group["lr"] = self.ppo.rate
        self.iteration, self.steps, self.learned_s = state["iteration"], state["steps"], state["learned_s"]
        self.curve = state["curve"]
        worlds = self._worlds_file()
        momentary = torch.load(worlds, map_location="cpu", weights_only=False) if worlds.exists() else None
        exact = (
            momentary is not None
            and momentary["iteration"] == self.iteration
            and momentary.get("processes", 1) == self.ppo.world_size
            and self.env.restore(momentary["worlds"])
        )
        if exact:
            torch.set_rng_state(momentary["random"])
            if self.cuda:
                torch.cuda.set_rng_state(momentary["random_device"], self.device)
        self.log(f"goes on from iteration {self.iteration}" + ("" if exact else ", with new worlds"))

    def _start_from(self, path: Path) -> None:
        """Starts with another run's networks and exploration; steps and curve begin at zero."""
        state = torch.load(path, map_location=self.device, weights_only=False)
        self.network.load_state_dict(state["network"])
        self.mean_actor = {k: v.clone() for k, v in self._actor().items()}
        low, high = self.config["ppo"]["learning_rate"]
        self.ppo.rate.fill_((low * high) ** 0.5)


def _write(state: dict, path: Path) -> None:
    """Never leaves half a file under the name."""
    torch.save(state, path.with_suffix(".part"))
    path.with_suffix(".part").replace(path)


def _tensorboard(out: Path):
    """A writer where TensorBoard is installed; curve.csv holds the same figures."""
    try:
        from torch.utils.tensorboard import SummaryWriter
    except ImportError:
        return None
    return SummaryWriter(out / "tensorboard")


def main() -> int:
    a = arguments()
    try:
        training = Training(a)
    except (OSError, RuntimeError, ValueError, KeyError) as error:
        if os.environ.get("PMG_TRACEBACK"):
            raise
        print(f"train: {error}", file=sys.stderr)
        return 2

    def interrupted(*_):
        training.stop = True

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, interrupted)
    bare = training.bare_steps_per_s
    training.log(f"bare stepping {bare / 1e3:.0f}k world ticks a second")
    training.run()
    if training.board:
        training.board.close()
    if training.rank != 0:
        return 0
    speed = training.curve[-1]["steps_per_s"] if training.curve else 0.0
    summary = dict(
        variant=a.variant,
        iterations=training.iteration,
        steps=training.steps,
        minutes=training.learned_s / 60,
        steps_per_s=speed,
        bare_steps_per_s=bare,
        share_of_bare=speed / bare,
    )
    (a.out / "summary.json").write_text(json.dumps(summary, indent=1))
    training.log(f"{speed / 1e3:.0f}k/s with learning, {speed / bare:.2f} of bare stepping")
    return 0


if __name__ == "__main__":
    sys.exit(main())
