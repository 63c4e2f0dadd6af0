"""Residual torques of motor.yaml, batched: src/model/residual_torque.cpp and src/actuator/residual_action.cpp in torch.

src/model/residual_torque.hpp explains quantities, axes and terms; test/data/training/actuators.json holds the results of the C++.
"""

import math
from typing import NamedTuple

import torch

from pmg_train.actuator_state import States

QUANTITIES = (
    "position_rad",
    "speed_rad_s",
    "error_rad",
    "drive_Nm",
    "integral_Nm_s",
    "bend_rad",
    "rest_s",
    "temperature_C",
    "time_s",
    "command_change_Nm",
)
MOST_TERMS = 2
_NO_AXIS = {"quantity": "position_rad", "from": 0.0, "to": 1.0, "knots": 1}
_NO_TERM = {"acts_as": "torque", "over": [], "values_Nm": [0.0]}


def _period(axis: dict) -> float:
    """A position repeats every turn."""
    return axis["to"] - axis["from"] if "to" in axis else 2 * math.pi


def _spacing(axis: dict) -> float:
    if axis.get("periodic"):
        return _period(axis) / axis["knots"]
    return (axis["to"] - axis["from"]) / (axis["knots"] - 1) if axis["knots"] > 1 else 1.0


class Given(NamedTuple):
    """What the residual torques give in a step, (worlds, joints): torque [Nm] and its slope in the motor's speed; what adds to dry friction
    [Nm] and its slope in |speed|; which joints have a residual torque."""

    torque: torch.Tensor
    slope: torch.Tensor
    friction: torch.Tensor
    friction_slope: torch.Tensor
    has: torch.Tensor


class _Axis:
    """One axis of a term, for all joints."""

    def __init__(self, axes: list[dict], column):
        self.quantity = [axis["quantity"] for axis in axes]
        self.low, self.spacing = column([axis["from"] for axis in axes]), column([_spacing(axis) for axis in axes])
        self.high = column([axis.get("to", 0.0) for axis in axes])
        self.period = column([_period(axis) for axis in axes])
        self.knots = column([axis["knots"] for axis in axes])
        self.lag = column([axis.get("lag_s", 0.0) for axis in axes])
        self.periodic = column([bool(axis.get("periodic")) for axis in axes]) > 0
        self.fixed = (self.knots == 1) & ~self.periodic  # no influence
        # By quantity, 1 for the joints that have it.
        self.picks = torch.stack([column([float(name == quantity) for name in self.quantity]) for quantity in QUANTITIES])

    def cell(self, x: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """The knot below x, counted from 0 with -1 before the axis, and the share of the way to the next."""
        x = torch.where(self.periodic, self.low + torch.remainder(x - self.low, self.period), x)
        place = torch.minimum(((x - self.low) / self.spacing).clamp(min=-1), self.knots)
        lower = torch.minimum(torch.floor(place), self.knots - 1)
        return torch.where(self.fixed, 0.0, lower).long(), torch.where(self.fixed, 0.0, place - lower)


class _Term:
    """One term of each joint."""

    def __init__(self, terms: list[dict], column):
        pad = lambda over: (over + [_NO_AXIS, _NO_AXIS])[:2]
        self.axes = [_Axis([pad(term["over"])[a] for term in terms], column) for a in range(2)]
        self.friction = column([float(term["acts_as"] == "friction") for term in terms]) > 0
        self.columns = max(pad(term["over"])[1]["knots"] for term in terms) + 2
        rows = max(pad(term["over"])[0]["knots"] for term in terms) + 2
        # A frame of zeros about the values: what is beyond the axes. A periodic axis continues with its first knot.
        grid = torch.zeros(len(terms), rows, self.columns, dtype=self.axes[0].low.dtype)
        for joint, term in enumerate(terms):
            first, second = pad(term["over"])
            values = torch.tensor(term["values_Nm"], dtype=grid.dtype).reshape(first["knots"], second["knots"])
            grid[joint, 1 : first["knots"] + 1, 1 : second["knots"] + 1] = values
            if first.get("periodic"):
                grid[joint, first["knots"] + 1] = grid[joint, 1]
            if second.get("periodic"):
                grid[joint, :, second["knots"] + 1] = grid[joint, :, 1]
        self.grid = grid.reshape(len(terms), -1).to(self.axes[0].low.device)

    def at(self, first: torch.Tensor, second: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """(worlds, joints): the value and its slope along the first axis."""
        (row, share), (column, across) = self.axes[0].cell(first), self.axes[1].cell(second)
        grid = self.grid.expand(*row.shape, -1)
        value = lambda r, c: grid.gather(2, ((r + 1) * self.columns + c + 1)[..., None])[..., 0]
        along = lambda r: (1 - across) * value(r, column) + across * value(r, column + 1)
        lower = along(row)
        upper = torch.where(self.axes[0].knots > 1, along(row + 1), lower)
        beyond = ((share == 0) & (row == -1)) | (share == 1)
        return lower + share * (upper - lower), torch.where(beyond, 0.0, (upper - lower) / self.axes[0].spacing)


class ResidualTorque:
    """(worlds, joints) residual torques at work. State tensors keep their memory."""

    def __init__(self, joints: list[dict | None], step_s: float, states: States, column):
        """joints: of each joint the map of motor.yaml's residual_torque, or None. ValueError for an unknown quantity."""
        self.step_s = step_s
        of = lambda joint, t: (joint or {}).get("terms", [])[t : t + 1]
        terms = [[(of(joint, t) or [_NO_TERM])[0] for joint in joints] for t in range(MOST_TERMS)]
        named = {axis["quantity"] for row in terms for term in row for axis in term["over"]}
        if named - set(QUANTITIES):
            raise ValueError(f"residual_torque over {sorted(named - set(QUANTITIES))}; expected some of {', '.join(QUANTITIES)}")
        self.acts = any(joint for joint in joints)
        self.terms = [_Term(row, column) for row in terms] if self.acts else []
        self.has = column([float(bool(joint)) for joint in joints]) > 0
        self.integral, self.rest, self.time = (states.new(f"residual_{name}") for name in ("integral", "rest", "time"))
        self.bends = [states.new(f"residual_bend{t}") for t in range(MOST_TERMS)]
        self.lagged = [[states.new(f"residual_lagged{t}{a}") for a in range(2)] for t in range(MOST_TERMS)]
        self.followed = states.new_flag("residual_followed")

    def reset(self, put) -> None:
        for state in (self.integral, self.rest, self.time, *self.bends, *(state for pair in self.lagged for state in pair), self.followed):
            put(state, torch.zeros_like(state))

    def follow(self, position, speed, command, error, stiffness, drive, temperature, integrates, enabled, sticks) -> Given:
        """Once a step, as ResidualAction::follow. Temperature: a number."""
        h = self.step_s
        self.integral.copy_((self.integral if enabled else 0 * self.integral) + torch.where(integrates, h * stiffness * error, 0.0))
        self.rest.copy_(torch.where(sticks, self.rest + h, 0.0))
        zero = torch.zeros_like(speed)
        torque, slope, friction, friction_slope = zero, zero, zero, zero
        quantities = [position, speed.abs(), error, drive, self.integral, zero, self.rest, zero + temperature, self.time, zero]
        bend_at, speed_at, position_at = (QUANTITIES.index(q) for q in ("bend_rad", "speed_rad_s", "position_rad"))
        for term, bend, lagged in zip(self.terms, self.bends, self.lagged, strict=True):
            places = []
            for axis, before in zip(term.axes, lagged, strict=True):
                moved = torch.minimum(torch.maximum(bend + h * speed, axis.low), axis.high)
                bend.copy_(torch.where(axis.picks[bend_at] > 0, moved, bend))
                quantities[bend_at] = bend
                before.copy_(torch.where(self.followed, before, command))
                before.add_(h / (axis.lag + h) * (command - before))
                quantities[-1] = stiffness * (command - before)
                places.append(sum(pick * quantity for pick, quantity in zip(axis.picks, quantities, strict=True)))
            value, along = term.at(*places)
            picks = term.axes[0].picks
            turns = picks[bend_at] + picks[position_at]
            torque = torque + torch.where(term.friction, 0.0, value)
            slope = slope + torch.where(term.friction, 0.0, h * turns * along.clamp(max=0))
            friction = friction + torch.where(term.friction, value, 0.0)
            friction_slope = friction_slope + torch.where(term.friction, picks[speed_at] * along.clamp(min=0), 0.0)
        self.time.add_(h)
        self.followed.fill_(True)
        return Given(torque, slope, friction, friction_slope, self.has)
