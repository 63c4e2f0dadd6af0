#include <gtest/gtest.h>

#include <array>
#include <fstream>

#include "robots.hpp"
#include "sim/world.hpp"
#include "temporary_folder.hpp"

namespace pmg {
namespace {

struct Loaded {
  explicit Loaded(const std::string& xml) {
    const test::TemporaryFolder folder;
    const std::filesystem::path path = folder.file("model.xml");
    std::ofstream(path) << xml;
    std::array<char, 500> error{};
    model = mj_loadXML(path.c_str(), nullptr, error.data(), static_cast<int>(error.size()));
    if (model == nullptr) throw std::runtime_error(error.data());
    data = mj_makeData(model);
  }
  Loaded(const Loaded&) = delete;
  Loaded& operator=(const Loaded&) = delete;
  ~Loaded() {
    mj_deleteData(data);
    mj_deleteModel(model);
  }
  mjModel* model = nullptr;
  mjData* data = nullptr;
};

TEST(Mjcf, SameRobotGivesTheSameBytes) {
  const auto again = model::load_robot(z1().directory);
  EXPECT_EQ(sim::mjcf(z1(), {}), sim::mjcf(again, {}));
}

TEST(Mjcf, LoadsFromItsTextWithTheRobotsJointsLimitsAndMass) {
  for (const model::RobotModel* robot : {&z1(), &biped()}) {
    const Loaded loaded(sim::mjcf(*robot, {}));
    ASSERT_EQ(loaded.model->nu, robot->joint_index.size());
    double mass_kg = 0.0;
    for (int b = 0; b < loaded.model->nbody; ++b) mass_kg += loaded.model->body_mass[b];
    EXPECT_NEAR(mass_kg, robot->total_mass_kg, 1e-9);  // rounding of a sum
    for (int j = 0; j < robot->joint_index.size(); ++j) {
      const model::Joint& joint = robot->joints[static_cast<std::size_t>(j)];
      const int id = mj_name2id(loaded.model, mjOBJ_JOINT, joint.name.c_str());
      ASSERT_GE(id, 0) << joint.name;
      EXPECT_EQ(loaded.model->jnt_range[2 * id], joint.lower_rad);
      EXPECT_EQ(loaded.model->jnt_range[2 * id + 1], joint.upper_rad);
      EXPECT_TRUE(loaded.model->jnt_limited[id]);
      EXPECT_EQ(loaded.model->actuator_trnid[2 * j], id) << "actuators are in joint order";
      EXPECT_EQ(loaded.model->actuator_forcerange[2 * j + 1], joint.effort_limit_Nm);
      EXPECT_EQ(loaded.model->dof_armature[loaded.model->jnt_dofadr[id]], joint.armature_kg_m2);
    }
  }
}

TEST(Mjcf, ANameMayHoldWhatXmlReserves) {
  model::RobotModel robot = model::load_robot(z1().directory);
  robot.name = R"(a<b> & "c" 'd')";
  const Loaded loaded(sim::mjcf(robot, {}));
  EXPECT_STREQ(loaded.model->names, robot.name.c_str());  // begins with the model's own
}

TEST(Mjcf, CoordinatesOfZ1AreInJointOrder) {
  const Loaded loaded(sim::mjcf(z1(), {}));
  for (int j = 0; j < z1().joint_index.size(); ++j)
    EXPECT_EQ(mj_name2id(loaded.model, mjOBJ_JOINT, z1().joint_index.name(j).c_str()), j + 1) << "after the free joint";
}

TEST(Mjcf, StandsByItselfOnItsOwnServosFromTheStandingKeyframe) {
  const Loaded loaded(sim::mjcf(z1(), {}));
  mj_resetDataKeyframe(loaded.model, loaded.data, 0);
  for (int i = 0; i < 1000; ++i) mj_step(loaded.model, loaded.data);
  EXPECT_NEAR(loaded.data->qpos[2], z1().standing_height_m, 0.03);
}

TEST(Mjcf, StandingPostureTouchesNothingButTheFloor) {
  for (const model::RobotModel* robot : {&z1(), &biped()}) {
    const Loaded loaded(sim::mjcf(*robot, {}));
    mj_resetDataKeyframe(loaded.model, loaded.data, 0);
    mj_forward(loaded.model, loaded.data);
    const int floor = mj_name2id(loaded.model, mjOBJ_GEOM, "floor");
    for (int c = 0; c < loaded.data->ncon; ++c) {
      const mjContact& contact = loaded.data->contact[c];
      EXPECT_TRUE(contact.geom1 == floor || contact.geom2 == floor)
          << robot->name << ": " << mj_id2name(loaded.model, mjOBJ_BODY, loaded.model->geom_bodyid[contact.geom1])
          << " touches " << mj_id2name(loaded.model, mjOBJ_BODY, loaded.model->geom_bodyid[contact.geom2]);
    }
  }
}

TEST(Mjcf, LegsThatCrossCollide) {
  const Loaded loaded(sim::mjcf(z1(), {}));
  mj_resetDataKeyframe(loaded.model, loaded.data, 0);
  for (const char* name : {"left_hip_roll", "right_hip_roll"}) {
    const int id = mj_name2id(loaded.model, mjOBJ_JOINT, name);
    const bool left = name[0] == 'l';
    loaded.data->qpos[loaded.model->jnt_qposadr[id]] = left ? -0.3 : 0.3;
  }
  loaded.data->qpos[2] += 0.5;  // clear of the floor
  mj_forward(loaded.model, loaded.data);
  EXPECT_GT(loaded.data->ncon, 0);
}

}  // namespace
}  // namespace pmg
