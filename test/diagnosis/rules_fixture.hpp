// A bench in files, for tests of the rules by which a diagnosis decides.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "calib/synthetic_bench.hpp"
#include "diagnosis/diagnose.hpp"

namespace pmg::diagnosis {

namespace fs = std::filesystem;

inline model::ActuatorParameters healthy_actuator() {
  model::ActuatorParameters joint;
  joint.transmission.armature_kg_m2 = 0.01;
  joint.friction.viscous_Nm_s_per_rad = 0.1;
  joint.friction.coulomb_Nm = 0.05;
  return joint;
}

class Rules : public testing::Test {
 protected:
  bench::Bench written(const std::vector<calib::SingleJoint>& joints) const {
    test::write_bench(folder_, joints);
    return bench::read_bench(folder_);
  }
  static DiagnoseOptions given_healthy() {
    DiagnoseOptions options;
    options.model = healthy_actuator();
    return options;
  }
  void TearDown() override { fs::remove_all(folder_); }

  const fs::path folder_ = fs::temp_directory_path() / ("pmg_rules_" + std::to_string(getpid()));
  const bench::Bench bench_ = test::pd_bench(true);
};

}  // namespace pmg::diagnosis
