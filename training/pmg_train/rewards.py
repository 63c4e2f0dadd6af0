"""The rewards: weights and widths from config.yaml, quantities measured by the environment."""

import torch


def reward_terms(m: dict[str, torch.Tensor], weights: dict, action_unit: float) -> dict[str, torch.Tensor]:
    """One tensor (worlds,) for each term, per second. m: the environment's measurements, see Environment.measure().

    The linear tracking errors have m["strictness"] of their weight: with the full weight from the start, falling early would pay."""
    terms = {}

    def exponential(name, squared_error):
        terms[name] = weights[name]["weight"] * torch.exp(-squared_error / weights[name]["s"])

    def linear(name, value):
        terms[name] = weights[name] * value

    def strict(name, value):
        terms[name] = m["strictness"] * weights[name] * value

    slow, fast, attitude, posture = m["slow_error"], m["fast_error"], m["attitude_error"], m["slow_posture_error"]
    exponential("velocity_slow", (slow[:, :2] ** 2).sum(1))
    exponential("velocity_fast", (fast[:, :2] ** 2).sum(1))
    exponential("yaw_rate", slow[:, 2] ** 2)
    exponential("height", posture[:, 2] ** 2)
    exponential("bob", m["bob_error"] ** 2)
    exponential("attitude", (attitude**2).sum(1))
    exponential("joint_position", (m["leg_weight"] * m["q_error"] ** 2).sum(1))
    exponential("joint_velocity", (m["leg_weight"] * m["dq_error"] ** 2).sum(1))
    # Steep where the exponential is flat. Bounded, so that a pushed robot may leave its reference.
    terms["joint_position_linear"] = m["strictness"] * (m["leg_linear_weight"] * m["q_error"].abs().clamp(max=0.3)).sum(1)
    terms["alive"] = torch.full_like(m["gain"], weights["alive"])
    strict("velocity_linear", slow[:, :2].abs().sum(1))
    strict("yaw_rate_linear", slow[:, 2].abs())
    strict("attitude_linear", posture[:, :2].abs().sum(1))
    strict("height_linear", posture[:, 2].abs())

    # A pushed robot may step while its command is to stand: the terms for standing still fade with the disturbance.
    standing = 1 - (m["gain"] > 0).float()
    calm = 1 - standing * (1 - torch.exp(-(slow[:, :2] ** 2).sum(1) / 0.02))
    linear("contact_mismatch", (m["touching"] != m["contact"]).float().mean(1) * calm)
    linear("slip", (m["touching"] * (m["sole_velocity"][..., :2] ** 2).sum(-1)).clamp(max=4).sum(1))
    linear("foot_tilt", m["sole_tilt"].sum(1))
    linear("vertical_velocity", m["vertical_velocity"] ** 2)
    linear("rocking", (m["gyro"][:, :2] ** 2).sum(1))
    linear("yaw_jitter", fast[:, 2] ** 2)
    torque, dq = m["leg_torque"], m["leg_dq"]
    linear("torque", (torque**2).sum(1))
    linear("power", (torque * dq).abs().sum(1))
    linear("acceleration", (m["leg_ddq"] ** 2).sum(1).clamp(max=1e7))
    a, a1, a2 = m["action"], m["action_1"], m["action_2"]
    linear("action_rate", action_unit * ((a - a1) ** 2).sum(1))
    linear("action_curvature", action_unit * ((a - 2 * a1 + a2) ** 2).sum(1))
    linear("action_size", (a**2).sum(1))
    linear("limits", m["beyond_limits"].sum(1))
    linear("saturation", (torque.abs() / m["leg_effort"] - 0.9).clamp(min=0).sum(1))
    linear("standing_motion", calm * standing * (dq**2).sum(1).clamp(max=20))
    return terms


def total(terms: dict[str, torch.Tensor], fallen: torch.Tensor, fall_weight: float, tick_s: float) -> torch.Tensor:
    """A tick's reward, scaled to order one. A bad tick costs at most as much as a fall."""
    per_tick = sum(terms.values()) * tick_s
    return 0.25 * (per_tick.clamp(min=-0.2) + fall_weight * fallen)
