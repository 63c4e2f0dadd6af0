// A plant without physics, for tests of lockstep.
#pragma once

#include "sil/plant.hpp"

namespace pmg::test {

/// A plant whose truth is whatever a test wants.
class ScriptedPlant final : public sil::Plant {
 public:
  model::GroundTruth truth() const noexcept override { return value; }
  bool diverged() const noexcept override { return false; }
  void set_hoist(double lift_m, double engaged) noexcept override {
    lift = lift_m;
    hold = engaged;
  }
  model::GroundTruth value;
  double lift = 0.0, hold = 0.0;
};

}  // namespace pmg::test
