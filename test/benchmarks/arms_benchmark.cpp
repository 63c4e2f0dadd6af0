// arms::Arms against KDL's Newton-Raphson with joint limits on the same chains and the same smoothed targets: the 99th
// percentile of CPU time over ticks, both arms together.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_nr_jl.hpp>
#include <kdl/chainiksolvervel_pinv.hpp>
#include <memory>
#include <random>
#include <vector>

#include "arms/arms.hpp"
#include "generator_core/allocation_count.hpp"
#include "model/robots.hpp"

namespace pmg::test {
namespace {

constexpr double kTick_s = 0.01;
constexpr int kTargets = 12, kTicksEach = 100;

double cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Palm poses of random postures within the arms' ranges, seeded: a new pair each second.
std::vector<PerFoot<arms::PalmPose>> targets(const arms::ArmSetup& setup) {
  std::mt19937 random(1);
  PerFoot<arms::ArmChain> chains{arms::ArmChain(setup.palm[kLeft], {}), arms::ArmChain(setup.palm[kRight], {})};
  std::vector<PerFoot<arms::PalmPose>> all(kTargets);
  for (PerFoot<arms::PalmPose>& pair : all) {
    for (const Foot side : {kLeft, kRight}) {
      arms::ArmVector q(chains[side].size());
      for (Eigen::Index i = 0; i < q.size(); ++i) {
        const model::Joint& joint =
            z1().joints[static_cast<std::size_t>(chains[side].joints()[static_cast<std::size_t>(i)])];
        q[i] = std::uniform_real_distribution<double>(joint.lower_rad, joint.upper_rad)(random);
      }
      chains[side].compute(q);
      pair[side] = chains[side].palm();
    }
  }
  return all;
}

double p99(std::vector<double>& times_s) {
  const auto at = times_s.begin() + static_cast<std::ptrdiff_t>(times_s.size() * 99 / 100);
  std::nth_element(times_s.begin(), at, times_s.end());
  return *at;
}

/// Runs step(pair of targets) for every tick; the 99th percentile of its CPU time [s].
template <typename Step>
double measure(const std::vector<PerFoot<arms::PalmPose>>& all, std::vector<double>& times_s, Step step) {
  times_s.clear();
  for (const PerFoot<arms::PalmPose>& pair : all) {
    for (int tick = 0; tick < kTicksEach; ++tick) {
      const double begin_s = cpu_s();
      step(pair);
      times_s.push_back(cpu_s() - begin_s);
    }
  }
  return p99(times_s);
}

void BM_arms_p99(benchmark::State& state) {
  const arms::ArmSetup setup = *arms::read_arm_setup(z1());
  const auto all = targets(setup);
  std::vector<double> times_s;
  times_s.reserve(kTargets * kTicksEach);
  long allocated = 0;
  for (auto _ : state) {
    arms::Arms arms(z1(), setup, kTick_s);
    JointVector q, dq = JointVector::Zero(z1().joint_index.size());
    const JointVector stand = z1().q_stand();
    const long before = allocation_count();
    state.SetIterationTime(measure(all, times_s, [&](const PerFoot<arms::PalmPose>& pair) {
      q = stand;
      for (const Foot side : {kLeft, kRight}) arms.aim(side, pair[side]);
      arms.step(q, dq);
      benchmark::DoNotOptimize(q.data());
    }));
    allocated += allocation_count() - before;
  }
  state.counters["allocations_per_call"] =
      static_cast<double>(allocated) / static_cast<double>(state.iterations() * kTargets * kTicksEach);
}

/// One arm by KDL, from its last solution to the smoothed target; a solve that fails leaves it where it is.
class NewtonRaphson {
 public:
  NewtonRaphson(const arms::PalmSetup& palm) : chain_(palm.chain) {
    const Eigen::Vector3d p = palm.T_LP.translation();
    chain_.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::Fixed), KDL::Frame(KDL::Vector(p.x(), p.y(), p.z()))));
    const unsigned n = chain_.getNrOfJoints();
    lower_.resize(n), upper_.resize(n), q_.resize(n), found_.resize(n);
    for (unsigned i = 0; i < n; ++i) {
      const model::Joint& joint = z1().joints[static_cast<std::size_t>(palm.joints[i])];
      lower_(i) = joint.lower_rad, upper_(i) = joint.upper_rad, q_(i) = joint.stand_rad;
    }
    forward_ = std::make_unique<KDL::ChainFkSolverPos_recursive>(chain_);
    velocity_ = std::make_unique<KDL::ChainIkSolverVel_pinv>(chain_);
    solver_ = std::make_unique<KDL::ChainIkSolverPos_NR_JL>(chain_, lower_, upper_, *forward_, *velocity_);
    KDL::Frame at;
    forward_->JntToCart(q_, at);
    arms::PalmPose pose;
    pose.p_m = {at.p.x(), at.p.y(), at.p.z()};
    at.M.GetQuaternion(pose.R.x(), pose.R.y(), pose.R.z(), pose.R.w());
    filter_.start(pose);
  }
  void step(const arms::PalmPose& target) {
    const arms::PalmPose& pose = filter_.step(target);
    const KDL::Frame goal(KDL::Rotation::Quaternion(pose.R.x(), pose.R.y(), pose.R.z(), pose.R.w()),
                          KDL::Vector(pose.p_m.x(), pose.p_m.y(), pose.p_m.z()));
    if (solver_->CartToJnt(q_, goal, found_) >= 0) q_ = found_;
  }

 private:
  KDL::Chain chain_;
  KDL::JntArray lower_, upper_, q_, found_;
  std::unique_ptr<KDL::ChainFkSolverPos_recursive> forward_;
  std::unique_ptr<KDL::ChainIkSolverVel_pinv> velocity_;
  std::unique_ptr<KDL::ChainIkSolverPos_NR_JL> solver_;
  arms::PoseFilter filter_{arms::PoseFilterOptions{}, kTick_s};
};

void BM_newton_raphson_p99(benchmark::State& state) {
  const arms::ArmSetup setup = *arms::read_arm_setup(z1());
  const auto all = targets(setup);
  std::vector<double> times_s;
  times_s.reserve(kTargets * kTicksEach);
  for (auto _ : state) {
    NewtonRaphson left(setup.palm[kLeft]), right(setup.palm[kRight]);
    state.SetIterationTime(measure(all, times_s, [&](const PerFoot<arms::PalmPose>& pair) {
      left.step(pair[kLeft]);
      right.step(pair[kRight]);
    }));
  }
}

BENCHMARK(BM_arms_p99)->UseManualTime()->Iterations(1)->Repetitions(3)->ReportAggregatesOnly();
BENCHMARK(BM_newton_raphson_p99)->UseManualTime()->Iterations(1)->Repetitions(3)->ReportAggregatesOnly();

}  // namespace
}  // namespace pmg::test

BENCHMARK_MAIN();
