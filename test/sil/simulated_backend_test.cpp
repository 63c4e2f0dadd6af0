// The backend `sil` as a controller gets it: from the factory, by its options.
#include "sil/simulated_backend.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "control/control_setup.hpp"
#include "control/fixtures.hpp"
#include "files/config_error.hpp"
#include "sil/simulated_robot.hpp"

namespace pmg::sil {
namespace {

class SimulatedBackendTest : public testing::Test {
 protected:
  SimulatedBackendTest() { register_backend(factory_); }

  std::unique_ptr<hal::Backend> make(const hal::OptionValues& options, const std::string& benched_joint = "") const {
    const hal::BackendKind& kind = factory_.kind("sil");
    hal::BackendSetup setup{.robot = test::biped(),
                            .clock = clock_,
                            .name = "biped",
                            .lcm_url = "memq://",
                            .benched_joint = benched_joint,
                            .keeps_truth = true,
                            .options = {}};
    for (const hal::BackendOption& option : kind.options) setup.options[option.name] = option.value;
    for (const auto& [name, value] : options) setup.options.at(name) = value;
    return kind.make(setup);
  }
  static model::JointCommand limp() {
    model::JointCommand command;
    command.q = test::biped().q_stand();
    command.dq = command.kp = command.kd = command.tau_ff = JointVector::Zero(command.q.size());
    return command;
  }

  hal::BackendFactory factory_;
  io::SimulationClock clock_;
};

TEST_F(SimulatedBackendTest, GivesDrivesAHoistAndTheTruthOfTheirSample) {
  const std::unique_ptr<hal::Backend> backend = make({});
  hal::Hal& drives = backend->connect({});
  model::RobotState state;
  ASSERT_EQ(drives.exchange(limp(), state), hal::BusStatus::kOk);
  EXPECT_EQ(state.q.size(), test::biped().joint_index.size());
  ASSERT_NE(backend->hoist(), nullptr);
  EXPECT_EQ(backend->hoist()->state(), hal::CraneState::kHolding);
  const hal::TruthSample* truth = backend->take_truth(state.bus_sample);
  ASSERT_NE(truth, nullptr);
  EXPECT_TRUE(truth->hoisted);
  EXPECT_EQ(backend->window(), nullptr) << "no viewer was asked for";
}

TEST_F(SimulatedBackendTest, AllowsWhatASharedHostNeeds) {
  control::TickOptions taken = control::tick_options(test::biped()), expected = taken;
  control::take_limits(make({})->limits(), taken);
  expect_shared_host(expected);
  EXPECT_EQ(taken.supervisor.fault_limits.stale_state_s, 0.2);
  EXPECT_EQ(taken.supervisor.fault_limits.overrun_ticks, expected.supervisor.fault_limits.overrun_ticks);
}

TEST_F(SimulatedBackendTest, NoHoistOnAGantryNorOnABench) {
  for (const std::unique_ptr<hal::Backend>& backend :
       {make({{"gantry", true}}), make({}, test::biped().joints.front().name)}) {
    backend->connect({});
    EXPECT_EQ(backend->hoist(), nullptr);
    EXPECT_TRUE(std::get<bool>(backend->configuration().at("gantry"))) << "the configuration in force";
  }
}

TEST_F(SimulatedBackendTest, ACameraBesideAWindowIsRefused) {
  EXPECT_THROW(make({{"camera", true}, {"viewer", true}}), std::invalid_argument);
}

TEST_F(SimulatedBackendTest, AWrongMotorFileIsRefusedBeforeAnythingIsOpened) {
  EXPECT_THROW(make({{"motor", std::string("test/data/none.yaml")}}), files::ConfigError);
}

}  // namespace
}  // namespace pmg::sil
