// A bench's joint as a MuJoCo 2.2.2 model, driven as the SIL drives a robot's.
#pragma once

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "calib/single_joint.hpp"
#include "sim/actuator_joint.hpp"

namespace pmg::test {

class MujocoJoint {
 public:
  MujocoJoint(const bench::JointLoad& load, const model::ActuatorParameters& parameters, double step_s)
      : actuator_(parameters, step_s), model_(compile(text(load, step_s))), data_(mj_makeData(model_.get())) {
    sim::hand_over(model_.get(), 0, actuator_);
    mj_setConst(model_.get(), data_.get());
  }

  /// At rest there while it is told that.
  void reset(const sim::ActuatorInput& input, double q_rad) {
    mj_resetData(model_.get(), data_.get());
    data_->qpos[0] = q_rad;
    mj_step1(model_.get(), data_.get());
    actuator_.reset_at_rest(input, q_rad, data_->qfrc_bias[0]);
  }

  /// As World::step: MuJoCo's step in halves, the drive between them.
  void step(sim::ActuatorInput input) {
    input.external_Nm = -data_->qfrc_bias[0];
    sim::apply(model_.get(), data_.get(), 0, actuator_.step(input, data_->qpos[0], data_->qvel[0]), data_->qvel[0]);
    mj_step2(model_.get(), data_.get());
    mj_step1(model_.get(), data_.get());
  }

  double q_rad() const { return data_->qpos[0]; }
  double reading_rad() const { return actuator_.reading_rad(q_rad()); }
  mjModel* mj_model() { return model_.get(); }
  mjData* mj_data() { return data_.get(); }

 private:
  static std::string text(const bench::JointLoad& load, double step_s) {
    // A mass at half the lever that would need all the inertia, so that its own inertia is positive.
    constexpr double kGravity_m_s2 = 9.81;
    const double lever_m = load.gravity_Nm > 0.0 ? 0.5 * kGravity_m_s2 * load.inertia_kg_m2 / load.gravity_Nm : 0.1;
    const double mass_kg = load.gravity_Nm > 0.0 ? load.gravity_Nm / (kGravity_m_s2 * lever_m) : 1.0;
    const double own_kg_m2 =
        load.gravity_Nm > 0.0 ? load.inertia_kg_m2 - mass_kg * lever_m * lever_m : load.inertia_kg_m2;
    return fmt::format(R"(<mujoco><compiler angle="radian" balanceinertia="false" boundmass="0"/>
      <option timestep="{}" integrator="implicit" gravity="0 0 -{}"/>
      <worldbody><body><joint name="joint" type="hinge" axis="0 1 0"/>
        <inertial pos="{} 0 {}" mass="{}" diaginertia="{} {} {}"/></body></worldbody>
      <actuator><general name="joint" joint="joint" gaintype="fixed" biastype="affine"/></actuator></mujoco>)",
                       step_s, kGravity_m_s2, load.gravity_Nm > 0.0 ? lever_m * std::sin(load.hangs_at_rad) : 0.0,
                       load.gravity_Nm > 0.0 ? -lever_m * std::cos(load.hangs_at_rad) : 0.0, mass_kg, own_kg_m2,
                       own_kg_m2, own_kg_m2);
  }

  struct FreeModel {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
  };
  struct FreeData {
    void operator()(mjData* data) const { mj_deleteData(data); }
  };
  static std::unique_ptr<mjModel, FreeModel> compile(const std::string& xml) {
    const auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    mj_makeEmptyFileVFS(files.get(), "joint.xml", static_cast<int>(xml.size()));
    std::memcpy(files->filedata[mj_findFileVFS(files.get(), "joint.xml")], xml.data(), xml.size());
    std::array<char, 1000> error{};
    std::unique_ptr<mjModel, FreeModel> model(
        mj_loadXML("joint.xml", files.get(), error.data(), static_cast<int>(error.size())));
    mj_deleteVFS(files.get());
    if (!model) throw std::runtime_error(error.data());
    return model;
  }

  sim::ActuatorModel actuator_;
  std::unique_ptr<mjModel, FreeModel> model_;
  std::unique_ptr<mjData, FreeData> data_;
};

}  // namespace pmg::test
