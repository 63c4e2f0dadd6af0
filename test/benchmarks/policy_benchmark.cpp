// The whole act() of a trained policy, with its observation, against the same network written by hand in Eigen.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <vector>

#include "benchmarks/onnx_network.hpp"
#include "benchmarks/trained_policy.hpp"
#include "benchmarks/walking_states.hpp"
#include "generator_core/allocation_count.hpp"
#include "policy/observation.hpp"
#include "policy/onnx_policy.hpp"

namespace pmg::test {
namespace {

/// One matrix-vector product per layer, no allocation.
class EigenFloor {
 public:
  explicit EigenFloor(const std::filesystem::path& file) : network_(file), x_(network_.mean.size()) {
    for (const Eigen::VectorXf& bias : network_.bias) h_.emplace_back(Eigen::VectorXf::Zero(bias.size()));
  }
  const Eigen::VectorXf& action(const Eigen::VectorXf& observation) {
    const float limit = network_.input_limit;
    x_ = (observation - network_.mean).cwiseProduct(network_.scale).cwiseMax(-limit).cwiseMin(limit);
    for (std::size_t layer = 0; layer < h_.size(); ++layer) {
      Eigen::VectorXf& h = h_[layer];
      h.noalias() = network_.weight[layer] * (layer == 0 ? x_ : h_[layer - 1]);
      h += network_.bias[layer];
      if (layer + 1 < h_.size()) h = h.array().max(0.0F) + (h.array().min(0.0F).exp() - 1.0F);
    }
    h_.back() = h_.back().cwiseMax(-network_.action_limit).cwiseMin(network_.action_limit);
    return h_.back();
  }

 private:
  OnnxNetwork network_;
  Eigen::VectorXf x_;
  std::vector<Eigen::VectorXf> h_;
};

/// Sensor values for the walking states.
std::vector<model::RobotState> sensed(const WalkingStates& states) {
  std::vector<model::RobotState> sensed(WalkingStates::kCount);
  for (std::size_t k = 0; k < WalkingStates::kCount; ++k) {
    sensed[k].q = states.states[k].q;
    sensed[k].dq = states.states[k].dq;
    sensed[k].gyro_rad_s = 0.1 * states.states[k].dq.head<3>();
  }
  return sensed;
}

void BM_policy(benchmark::State& state) {
  const WalkingStates states;
  const std::vector<model::RobotState> seen = sensed(states);
  const auto policy = trained_policy(states.robot);
  JointVector q_des = states.robot.q_stand();
  std::size_t tick = 0;
  long before = allocation_count();
  long least = 1L << 30, most = 0;
  for (auto _ : state) {
    const Reference& reference = states.at(tick);
    const auto status = policy->act(seen[tick++ % WalkingStates::kCount], reference, reference.command, q_des);
    if (status != policy::Status::kOk) state.SkipWithError("the policy gave no action");
    const long now = allocation_count();
    least = std::min(least, now - before);
    most = std::max(most, now - before);
    before = now;
  }
  state.counters["allocations_per_call"] = static_cast<double>(most);
  state.counters["allocations_vary_by"] = static_cast<double>(most - least);
}

void BM_policy_floor(benchmark::State& state) {
  const WalkingStates states;
  EigenFloor floor(trained_policy_file());
  std::vector<Eigen::VectorXf> observation;
  for (std::size_t k = 0; k < WalkingStates::kCount; ++k) {
    observation.emplace_back(Eigen::VectorXf::Random(policy::ObservationLayout(states.robot).size()));
  }
  std::size_t tick = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(floor.action(observation[tick++ % WalkingStates::kCount]).data());
    benchmark::ClobberMemory();
  }
}

/// The floor must compute the same result.
void require_equal_results() {
  const WalkingStates states;
  const std::vector<model::RobotState> seen = sensed(states);
  const auto policy = trained_policy(states.robot);
  EigenFloor floor(trained_policy_file());
  policy::Observation observation(states.robot);
  const auto& joints = observation.layout().action_joints();
  Eigen::VectorXf action = Eigen::VectorXf::Zero(static_cast<Eigen::Index>(joints.size()));
  JointVector q_des = states.robot.q_stand();
  for (std::size_t k = 0; k < WalkingStates::kCount; ++k) {
    const Reference& reference = states.at(k);
    action = floor.action(observation.assemble(seen[k], reference, reference.command, action));
    policy->act(seen[k], reference, reference.command, q_des);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const int joint = states.robot.joint_index.at(joints[i]);
      const double by_policy = (q_des[joint] - reference.q[joint]) / policy->metadata().action_scale;
      const double difference = by_policy - static_cast<double>(action[static_cast<Eigen::Index>(i)]);
      if (std::abs(difference) < 1e-3) continue;  // single precision through four layers, fed back over the ticks
      std::fprintf(stderr, "state %zu, %s: the floor's action differs by %g\n", k, joints[i].c_str(), difference);
      std::exit(1);
    }
  }
}

BENCHMARK(BM_policy)->Repetitions(31)->ReportAggregatesOnly()->MinTime(0.02);
BENCHMARK(BM_policy_floor)->Repetitions(31)->ReportAggregatesOnly()->MinTime(0.02);

}  // namespace
}  // namespace pmg::test

int main(int argc, char** argv) {
  try {
    pmg::test::require_equal_results();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
