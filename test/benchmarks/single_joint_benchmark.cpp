// One evaluation of a fit (a 3 s rollout of one joint with every common effect, and its error) against as many bare
// mj_step calls of the same joint, there with MuJoCo's own PD and friction only.
#include <benchmark/benchmark.h>

#include "calib/mujoco_joint.hpp"
#include "calib/synthetic_bench.hpp"
#include "generator_core/allocation_count.hpp"

namespace pmg::test {
namespace {

calib::JointModel model() {
  calib::JointModel model;
  model::ActuatorParameters& p = model.actuator;
  p.transmission.armature_kg_m2 = 0.02;
  p.command = {.delay_s = 0.0237, .rate_limit_rad_s = 5.0};
  p.friction.coulomb_Nm = 0.15;
  p.friction.viscous_Nm_s_per_rad = 0.02;
  p.friction.load_driving = 0.3;
  p.friction.load_backdriving = 0.1;
  return model;
}

const calib::SingleJoint& joint() {
  static const calib::SingleJoint kJoint = record(pd_bench(true), model(), 1).front();
  return kJoint;
}

void BM_single_joint(benchmark::State& state) {
  const calib::JointModel fitted = model();
  double error_rad = joint().error(fitted).mean_absolute_rad();
  const long before = allocation_count();
  for (auto _ : state) {
    error_rad += joint().error(fitted).mean_absolute_rad();
    benchmark::DoNotOptimize(error_rad);
  }
  state.counters["allocations_per_call"] =
      static_cast<double>(allocation_count() - before) / static_cast<double>(state.iterations());
  state.counters["steps_per_s"] = benchmark::Counter(
      static_cast<double>(joint().steps() * static_cast<std::size_t>(state.iterations())), benchmark::Counter::kIsRate);
}

void BM_single_joint_floor(benchmark::State& state) {
  model::ActuatorParameters rigid;
  rigid.transmission.armature_kg_m2 = 0.02;
  MujocoJoint mujoco(joint().run().load, rigid, joint().step_s());
  mjModel* bare = mujoco.mj_model();
  mjData* data = mujoco.mj_data();
  bare->actuator_biasprm[1] = -20.0;
  bare->actuator_biasprm[2] = -0.8;
  bare->dof_frictionloss[0] = 0.15;
  bare->dof_damping[0] = 0.02;
  mj_setConst(bare, data);
  mujoco.reset({}, 0.0);
  for (auto _ : state) {
    for (std::size_t k = 0; k < joint().steps(); ++k) {
      data->ctrl[0] = 20.0 * joint().input(k).q_rad;
      mj_step(bare, data);
    }
    benchmark::DoNotOptimize(data->qpos[0]);
  }
}

// The median of many short repetitions: robust on a shared machine.
BENCHMARK(BM_single_joint)->Repetitions(31)->ReportAggregatesOnly()->MinTime(0.02);
BENCHMARK(BM_single_joint_floor)->Repetitions(31)->ReportAggregatesOnly()->MinTime(0.02);

}  // namespace
}  // namespace pmg::test

BENCHMARK_MAIN();
