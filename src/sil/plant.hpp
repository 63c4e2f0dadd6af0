// The part of a simulated world that lockstep needs besides its bus: the truth for metrics, and the gantry.
#pragma once

#include "sim/world.hpp"

namespace pmg::sil {

class Plant {
 public:
  virtual ~Plant() = default;
  virtual model::GroundTruth truth() const noexcept = 0;
  virtual bool diverged() const noexcept = 0;
  virtual void set_hoist(double lift_m, double engaged) noexcept = 0;  ///< as sim::World's
};

class WorldPlant final : public Plant {
 public:
  explicit WorldPlant(sim::World& world) : world_(world) {}
  model::GroundTruth truth() const noexcept override { return world_.truth(); }
  bool diverged() const noexcept override { return world_.diverged(); }
  void set_hoist(double lift_m, double engaged) noexcept override { world_.set_hoist(lift_m, engaged); }

 private:
  sim::World& world_;
};

}  // namespace pmg::sil
