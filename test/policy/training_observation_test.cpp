// The controller's observation agrees with training's torch code on the same states.
// training/tests/make_observations.py writes test/data/training/observations.json and says when.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "folders.hpp"
#include "policy/observation.hpp"

namespace pmg::policy {
namespace {

constexpr float kRounding = 1e-6F;  // training computes in float; the elements are of order one

using nlohmann::json;

json recorded() {
  return json::parse(std::ifstream(pmg::test::project_folder() + "/test/data/training/observations.json"));
}

Eigen::VectorXd vector(const json& numbers) {
  const auto values = numbers.get<std::vector<double>>();
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

model::RobotState recorded_state(const json& tick) {
  model::RobotState state;
  state.gyro_rad_s = vector(tick["gyro"]);
  const Eigen::VectorXd wxyz = vector(tick["quat_wxyz"]);
  state.orientation_WI = Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).normalized();
  state.q = vector(tick["q"]);
  state.dq = vector(tick["dq"]);
  return state;
}

Command command_of(const json& channels) {
  Command command;
  for (std::size_t c = 0; c < kChannels; ++c) command.u[c] = channels[c].get<double>();
  return command;
}

Reference reference_of(const json& tick) {
  Reference reference;
  reference.command = command_of(tick["user_command"]);
  reference.q = vector(tick["q_ref"]);
  reference.dq = vector(tick["dq_ref"]);
  reference.phase = tick["phi"].get<double>();
  reference.gain = tick["gain"].get<double>();
  return reference;
}

std::vector<std::string> layout_of(const ObservationLayout& layout) {
  std::vector<std::string> names;
  for (const ObservationTerm& term : layout.terms()) {
    for (const std::string& element : term.element) {
      names.push_back(term.quantity->name + ", " + std::to_string(term.age_ticks) + " ticks old: " + element);
    }
  }
  return names;
}

TEST(TrainingObservation, EqualsTheControllersElementByElement) {
  const model::RobotModel robot = model::load_robot(pmg::test::project_folder() + "/config/robots/z1");
  const json training = recorded();
  ASSERT_EQ(training["joints"].size(), robot.joint_index.names().size());
  for (int i = 0; i < robot.joint_index.size(); ++i) {
    const json& joint = training["joints"][static_cast<std::size_t>(i)];
    ASSERT_EQ(joint["name"], robot.joint_index.name(i));
    ASSERT_EQ(joint["stand_rad"], robot.q_stand()[i]) << joint["name"];
  }
  Observation observation(robot);
  ASSERT_EQ(training["observation"], json::parse(observation.layout().to_json()));
  ASSERT_EQ(training["quantities"], json::parse(quantities_json()));
  const std::vector<std::string> names = layout_of(observation.layout());
  ASSERT_GT(training["ticks"].size(), static_cast<std::size_t>(ObservationLayout::kOldest_ticks) + 1)
      << "too few for the oldest frame";
  for (std::size_t t = 0; t < training["ticks"].size(); ++t) {
    const json& tick = training["ticks"][t];
    const Eigen::VectorXf action = vector(tick["last_action"]).cast<float>();
    const Eigen::VectorXf& seen =
        observation.assemble(recorded_state(tick), reference_of(tick), command_of(tick["command"]), action);
    const auto expected = tick["observation"].get<std::vector<float>>();
    ASSERT_EQ(expected.size(), names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
      EXPECT_NEAR(seen[static_cast<Eigen::Index>(i)], expected[i], kRounding) << names[i] << ", tick " << t;
    }
  }
}

}  // namespace
}  // namespace pmg::policy
