// GroundAwareCommand::solve against one Gauss-Newton step of the same problem written by hand.
#include <benchmark/benchmark.h>

#include <Eigen/Cholesky>
#include <cstdio>
#include <cstdlib>

#include "benchmarks/walking_states.hpp"
#include "gco/ground_aware_command.hpp"
#include "generator_core/allocation_count.hpp"
#include "model/leg_kinematics.hpp"

namespace pmg::test {
namespace {

using Unknowns = Eigen::Matrix<double, 5, 1>;  // v', omega_z', h'

/// One step from the command to the minimum, because the problem is linear. The lowest corner replaces the smoothed
/// contact point.
class GaussNewtonFloor {
 public:
  explicit GaussNewtonFloor(const model::RobotModel& robot) : standing_height_m_(robot.standing_height_m) {}

  Unknowns step(const Reference& reference, const PerFoot<model::FootKinematics>& feet,
                const model::BaseAttitude::Result& base) const {
    const Command& u = reference.command;
    const Unknowns prior = {u[kVx], u[kVy], 0.0, u[kOmega], u[kHeight]};
    const Eigen::Vector3d omega(base.omega_HB_H.x(), base.omega_HB_H.y(), u[kOmega]);
    Eigen::Matrix<double, 9, 5> J = Eigen::Matrix<double, 9, 5>::Zero();
    Eigen::Matrix<double, 9, 1> r;
    double lowest = 0.0;
    for (const Foot side : {kLeft, kRight}) {
      const model::FootKinematics& foot = feet[side];
      Eigen::Vector3d lever = base.R_HB * foot.sole_B[0];
      for (std::size_t i = 1; i < 4; ++i) {
        const Eigen::Vector3d corner = base.R_HB * foot.sole_B[i];
        if (corner.z() < lever.z()) lever = corner;
      }
      lowest = std::min(lowest, lever.z());
      const double weight = std::sqrt(reference.contact_weight[side]);
      const int row = 4 * static_cast<int>(side);
      const Eigen::Vector3d arm_B = base.R_HB.transpose() * lever - foot.p_BF;
      const Eigen::Vector3d velocity =
          prior.head<3>() + omega.cross(lever) + base.R_HB * (foot.v_BF + foot.omega_BF.cross(arm_B));
      r.segment<3>(row) = weight * velocity;
      r[row + 3] = weight * (u[kOmega] + base.R_HB.row(2).dot(foot.omega_BF));
      J.block<3, 3>(row, 0).diagonal().setConstant(weight);
      J(row, 3) = -weight * lever.y();
      J(row + 1, 3) = weight * lever.x();
      J(row + 3, 3) = weight;
    }
    r[8] = standing_height_m_ + u[kHeight] + lowest;
    J(8, 4) = 1.0;
    Eigen::Matrix<double, 5, 5> H = J.transpose().lazyProduct(J);
    H.diagonal().array() += 1e-6;
    const Unknowns g = J.transpose().lazyProduct(r);
    return prior - H.ldlt().solve(g);
  }

 private:
  double standing_height_m_;
};

model::BaseAttitude::Result attitude_of(model::BaseAttitude& base_attitude, const Reference& reference) {
  const Command& u = reference.command;
  const Command& rate = reference.command_rate;
  return base_attitude.compute(reference.q, reference.dq, u[kPitch], u[kRoll], rate[kPitch], rate[kRoll]);
}

void count_allocations(benchmark::State& state, long before) {
  state.counters["allocations_per_call"] =
      benchmark::Counter(static_cast<double>(allocation_count() - before), benchmark::Counter::kAvgIterations);
}

void solve(benchmark::State& state, const gco::Options& options) {
  const WalkingStates states;
  gco::GroundAwareCommand gco(states.robot, options);
  std::size_t tick = 0;
  const long before = allocation_count();
  for (auto _ : state) {
    double first = gco.solve(states.at(tick++)).command.u[0];
    benchmark::DoNotOptimize(first);
  }
  count_allocations(state, before);
}

void BM_gco_solve(benchmark::State& state) { solve(state, {}); }
void BM_gco_solve_roll_pitch(benchmark::State& state) { solve(state, {.optimise_roll_pitch = true}); }

/// KDL's kinematics of both legs and of the waist, and the step.
void BM_gco_floor(benchmark::State& state) {
  const WalkingStates states;
  model::LegKinematics legs(states.robot);
  model::BaseAttitude base_attitude(states.robot);
  const GaussNewtonFloor floor(states.robot);
  std::size_t tick = 0;
  for (auto _ : state) {
    const Reference& reference = states.at(tick++);
    const auto base = attitude_of(base_attitude, reference);
    benchmark::DoNotOptimize(floor.step(reference, legs.compute(reference.q, reference.dq), base).data());
    benchmark::ClobberMemory();
  }
}

/// The step alone, on kinematics computed before.
void BM_gco_floor_without_kinematics(benchmark::State& state) {
  const WalkingStates states;
  model::LegKinematics legs(states.robot);
  model::BaseAttitude base_attitude(states.robot);
  const GaussNewtonFloor floor(states.robot);
  std::vector<PerFoot<model::FootKinematics>> feet;
  std::vector<model::BaseAttitude::Result> base;
  for (const Reference& reference : states.states) {
    feet.push_back(legs.compute(reference.q, reference.dq));
    base.push_back(attitude_of(base_attitude, reference));
  }
  std::size_t tick = 0;
  for (auto _ : state) {
    const std::size_t k = tick++ % WalkingStates::kCount;
    benchmark::DoNotOptimize(floor.step(states.states[k], feet[k], base[k]).data());
    benchmark::ClobberMemory();
  }
}

/// The floor must compute the same result. The smoothed contact point may differ by a fraction of a millimetre; at
/// joint speeds below 1 rad/s that is less than 1e-3 m/s, except where two corners are equally low.
void require_equal_results() {
  const WalkingStates states;
  model::LegKinematics legs(states.robot);
  model::BaseAttitude base_attitude(states.robot);
  const GaussNewtonFloor floor(states.robot);
  gco::GroundAwareCommand gco(states.robot);
  int close = 0;
  for (const Reference& reference : states.states) {
    const auto base = attitude_of(base_attitude, reference);
    const Unknowns x = floor.step(reference, legs.compute(reference.q, reference.dq), base);
    const gco::Result& result = gco.solve(reference);
    const Unknowns y = {result.command[kVx], result.command[kVy], result.vz_m_s, result.command[kOmega],
                        result.command[kHeight]};
    if ((x - y).cwiseAbs().maxCoeff() < 2e-3) ++close;
  }
  if (close >= static_cast<int>(WalkingStates::kCount * 3 / 4)) return;
  std::fprintf(stderr, "the floor agrees with the optimisation in only %d of %zu states\n", close,
               WalkingStates::kCount);
  std::exit(1);
}

// The median of many short repetitions: robust on a shared machine.
BENCHMARK(BM_gco_solve)->Repetitions(31)->ReportAggregatesOnly()->MinTime(0.02);
BENCHMARK(BM_gco_solve_roll_pitch)->Repetitions(31)->ReportAggregatesOnly()->MinTime(0.02);
BENCHMARK(BM_gco_floor)->Repetitions(31)->ReportAggregatesOnly()->MinTime(0.02);
BENCHMARK(BM_gco_floor_without_kinematics)->Repetitions(31)->ReportAggregatesOnly()->MinTime(0.02);

}  // namespace
}  // namespace pmg::test

int main(int argc, char** argv) {
  pmg::test::require_equal_results();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
