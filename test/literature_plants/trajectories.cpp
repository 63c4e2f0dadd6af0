#include <algorithm>
#include <cmath>
#include <numbers>

#include "rig.hpp"

namespace pmg::literature {

namespace {

constexpr double kQuiet_s = 0.3;  // at first the joint hangs

std::size_t samples(double duration_s, double rate_hz) {
  return std::max<std::size_t>(1, static_cast<std::size_t>(duration_s * rate_hz));
}

void steps(Draw& draw, double rate_hz, double reach_rad, std::size_t until, std::vector<double>& q) {
  while (q.size() < until) {
    q.insert(q.end(), samples(draw.uniform(0.25, 0.9), rate_hz), draw.uniform(-reach_rad, reach_rad));
  }
  q.resize(until);
}

/// Flash and Hogan (1985): 10 s^3 - 15 s^4 + 6 s^5 between rests.
void moves(Draw& draw, double rate_hz, double reach_rad, std::size_t until, std::vector<double>& q) {
  while (q.size() < until) {
    const double from = q.back(), to = draw.uniform(-reach_rad, reach_rad);
    const std::size_t count = samples(draw.uniform(0.3, 0.8) * (0.4 + std::abs(to - from)), rate_hz);
    for (std::size_t k = 1; k <= count; ++k) {
      const double s = static_cast<double>(k) / static_cast<double>(count);
      q.push_back(from + (to - from) * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s));
    }
    q.insert(q.end(), samples(draw.uniform(0.05, 0.5), rate_hz), to);
  }
  q.resize(until);
}

/// Four sines of one fundamental with Schroeder's phases (1970), faded in.
void sines(Draw& draw, double rate_hz, double reach_rad, std::size_t until, std::vector<double>& q) {
  const double base_hz = draw.uniform(0.25, 0.5), start = static_cast<double>(q.size()) / rate_hz;
  constexpr double kOrders[] = {1.0, 2.0, 4.0, 7.0};
  while (q.size() < until) {
    const double t_s = static_cast<double>(q.size()) / rate_hz - start;
    double sum = 0.0;
    for (const double order : kOrders) {
      sum += std::sin(2.0 * std::numbers::pi * base_hz * order * t_s - std::numbers::pi * order * (order - 1.0) / 8.0) /
             order;
    }
    q.push_back(std::min(1.0, 2.0 * t_s) * 0.6 * reach_rad * sum);
  }
}

/// A sweep whose amplitude falls as its frequency rises.
void sweep(Draw& draw, double rate_hz, double reach_rad, std::size_t until, std::vector<double>& q) {
  const double start = static_cast<double>(q.size()) / rate_hz, low_hz = draw.uniform(0.2, 0.4),
               high_hz = draw.uniform(2.0, 4.0);
  const double whole_s = static_cast<double>(until) / rate_hz - start;
  while (q.size() < until) {
    const double t_s = static_cast<double>(q.size()) / rate_hz - start, ratio = high_hz / low_hz;
    const double turn = low_hz * whole_s / std::log(ratio) * (std::pow(ratio, t_s / whole_s) - 1.0);
    q.push_back(reach_rad * std::pow(ratio, -0.6 * t_s / whole_s) * std::sin(2.0 * std::numbers::pi * turn));
  }
}

/// Back and forth at one pace over ways of different length.
void strokes(Draw& draw, double rate_hz, double pace_rad_s, double reach_rad, std::size_t until,
             std::vector<double>& q) {
  double side = draw.sign();
  while (q.size() < until) {
    const double from = q.back(), to = side * draw.uniform(0.15, 1.0) * reach_rad;
    const std::size_t count = samples(std::abs(to - from) / pace_rad_s, rate_hz);
    for (std::size_t k = 1; k <= count; ++k) {
      q.push_back(from + (to - from) * static_cast<double>(k) / static_cast<double>(count));
    }
    if (draw.chance(0.3)) q.insert(q.end(), samples(0.2, rate_hz), to);
    side = -side;
  }
  q.resize(until);
}

/// Three passes of a mean over 0.08 s: for commands whose second derivative somebody uses.
void smooth_out(double rate_hz, std::vector<double>& q) {
  const auto half = static_cast<std::ptrdiff_t>(0.04 * rate_hz);
  for (int pass = 0; pass < 3; ++pass) {
    std::vector<double> sums(q.size() + 1, 0.0);
    for (std::size_t k = 0; k < q.size(); ++k) sums[k + 1] = sums[k] + q[k];
    for (std::size_t k = 0; k < q.size(); ++k) {
      const auto at = static_cast<std::ptrdiff_t>(k), last = static_cast<std::ptrdiff_t>(q.size());
      const auto low = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, at - half));
      const auto high = static_cast<std::size_t>(std::min(last, at + half + 1));
      q[k] = (sums[high] - sums[low]) / static_cast<double>(high - low);
    }
  }
}

std::vector<double> derivative(const std::vector<double>& q, double rate_hz) {
  std::vector<double> slope(q.size(), 0.0);
  for (std::size_t k = 1; k + 1 < q.size(); ++k) slope[k] = 0.5 * rate_hz * (q[k + 1] - q[k - 1]);
  return slope;
}

}  // namespace

void differentiate(Trajectory& trajectory, double rate_hz) {
  trajectory.dq_rad_s = derivative(trajectory.q_rad, rate_hz);
  trajectory.ddq_rad_s2 = derivative(trajectory.dq_rad_s, rate_hz);
}

Trajectory draw_trajectory(Draw& draw, std::size_t kind, double rate_hz, bool smooth) {
  const double reach_rad = draw.uniform(0.7, 1.2);
  const std::size_t until = samples(draw.uniform(4.0, 6.0), rate_hz);
  Trajectory t;
  t.q_rad.assign(samples(kQuiet_s, rate_hz), 0.0);
  constexpr const char* kNames[kTrajectoryKinds] = {"steps", "moves", "sines", "sweep", "strokes", "creep"};
  t.name = kNames[kind];
  switch (kind) {
    case 0:
      steps(draw, rate_hz, reach_rad, until * 6 / 10, t.q_rad);
      moves(draw, rate_hz, reach_rad, until, t.q_rad);
      break;
    case 1:
      moves(draw, rate_hz, reach_rad, until, t.q_rad);
      break;
    case 2:
      sines(draw, rate_hz, reach_rad, until, t.q_rad);
      break;
    case 3:
      sweep(draw, rate_hz, reach_rad, until, t.q_rad);
      break;
    case 4:
      strokes(draw, rate_hz, draw.uniform(0.8, 1.8), reach_rad, until, t.q_rad);
      break;
    default:
      strokes(draw, rate_hz, draw.uniform(0.2, 0.5), 0.6 * reach_rad, until, t.q_rad);
      break;
  }
  if (kind <= 1 && draw.chance(0.4)) t.released_s = draw.uniform(0.6, 1.2);
  if (smooth) smooth_out(rate_hz, t.q_rad);
  differentiate(t, rate_hz);
  return t;
}

}  // namespace pmg::literature
