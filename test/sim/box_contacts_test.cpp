// Boxes that rest on boxes, as MuJoCo simulates them once a world has been built.
#include "sim/box_contacts.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>

#include "model/robot_model.hpp"
#include "robots.hpp"
#include "sim/mujoco_objects.hpp"
#include "sim/world.hpp"

namespace pmg::sim {
namespace {

constexpr double kRest_m = 0.62;  // of the box's middle on the table

/// A box of 1 kg on a table, both of them anywhere.
std::string box_on_table(int place) {
  const double yaw_rad = 0.3 * std::sin(12.9898 * place + 1.0);
  return fmt::format(R"(<mujoco>
  <option timestep="0.002" integrator="implicit"/>
  <default><geom condim="4" friction="0.4 0.005 0.0001"/></default>
  <worldbody>
    <body pos="{} {} 0.485"><geom type="box" size="0.2 0.25 0.015"/></body>
    <body name="box" pos="0 0 0.621" quat="{} 0 0 {}">
      <freejoint/>
      <inertial pos="0 0 0" mass="1" diaginertia="0.0144 0.0096 0.0144"/>
      <geom type="box" size="0.12 0.17 0.12"/>
    </body>
  </worldbody>
</mujoco>)",
                     0.05 + 0.05 * std::sin(7.1 * place), 0.05 * std::sin(3.3 * place + 0.2), std::cos(0.5 * yaw_rad),
                     std::sin(0.5 * yaw_rad));
}

ModelPointer compile(const std::string& xml) {
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "box.xml", static_cast<int>(xml.size()));
  // NOLINTNEXTLINE(bugprone-not-null-terminated-result): a file has its size
  std::memcpy(files->filedata[mj_findFileVFS(files.get(), "box.xml")], xml.data(), xml.size());
  std::array<char, 500> error{};
  ModelPointer model(mj_loadXML("box.xml", files.get(), error.data(), static_cast<int>(error.size())));
  mj_deleteVFS(files.get());
  EXPECT_TRUE(model) << error.data();
  return model;
}

/// MuJoCo alone throws the box up at places 4, 7, 19, 29 and 30.
TEST(BoxContacts, ABoxOnATableStaysThereWhereverItLies) {
  const model::RobotModel robot = z1();
  const World world(robot, {});  // whoever builds one gets rid of the phantoms
  double lowest_m = kRest_m, highest_m = 0.0;
  for (int place = 0; place < 32; ++place) {
    const ModelPointer model = compile(box_on_table(place));
    const DataPointer data(mj_makeData(model.get()));
    for (int step = 0; step < 1000; ++step) {
      mj_step(model.get(), data.get());
      if (step < 200) continue;
      lowest_m = std::min(lowest_m, data->qpos[2]);
      highest_m = std::max(highest_m, data->qpos[2]);
    }
  }
  EXPECT_NEAR(lowest_m, kRest_m, 0.001);
  EXPECT_NEAR(highest_m, kRest_m, 0.001);
}

/// A world whose left hand, hanging at the side, has a palm of 2 cm; a light box beside it, so far from the palm's
/// face.
class PalmAndBox {
 public:
  explicit PalmAndBox(double gap_m) : world_(z1(), options(gap_m)) {}
  bool touch() const { return world_.touches(kHand, "box"); }
  double friction() {
    const mjModel* model = world_.mj_model();
    for (int contact = 0; contact < data()->ncon; ++contact) {
      const int body = model->geom_bodyid[data()->contact[contact].geom1];
      if (body == mj_name2id(model, mjOBJ_BODY, kHand)) return data()->contact[contact].friction[0];
    }
    return 0.0;
  }

 private:
  static constexpr const char* kHand = "left_wrist_pitch_link";
  const mjData* data() { return world_.mj_data(); }
  static WorldOptions options(double gap_m) {
    const HandBox palm{.link = kHand,
                       .T_LH = Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, -0.074)),
                       .half_size_m = {0.03, 0.01, 0.03},
                       .friction = 0.7};
    WorldOptions options;
    const Eigen::Isometry3d T_WH = World(z1(), options).pose(kHand) * palm.T_LH;
    options.hand_boxes = {palm};
    options.props = {{.name = "box",
                      .half_size_m = {0.05, 0.05, 0.05},
                      .p_WP_m = T_WH * Eigen::Vector3d(0.0, 0.01 + gap_m + 0.05, 0.0),
                      .mass_kg = 0.1,
                      .friction = 0.9}};
    return options;
  }
  World world_;
};

TEST(BoxContacts, APalmTouchesAThingInPlaceOfTheHandsOwnShapeAndItsFrictionCounts) {
  PalmAndBox apart(0.015), together(-0.008);  // Z1's hand is a ball of 4 cm, which reaches 3 cm beyond the palm
  EXPECT_FALSE(apart.touch());
  ASSERT_TRUE(together.touch());
  EXPECT_EQ(together.friction(), 0.7);
}

}  // namespace
}  // namespace pmg::sim
