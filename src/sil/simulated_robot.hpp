// A simulated robot for the bus thread. Other threads reach it wait-free.
#pragma once

#include <array>
#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <optional>

#include "control/tick.hpp"
#include "hal/backend.hpp"
#include "io/mailbox.hpp"
#include "pmg/types.hpp"
#include "sil/crane.hpp"
#include "sil/hoist.hpp"
#include "sil/sil_hal.hpp"
#include "sim/world.hpp"

namespace pmg::sil {

/// Who works the gantry.
enum class HoistedBy {
  kScenario,  ///< support() says what it does
  kGantry,    ///< nobody: the robot began on it and stays there
  kCrane,     ///< somebody beside the robot: it begins on the hoist and is set down when it stands (HoistLine)
};

/// MuJoCo's generalised positions, for pictures.
struct PoseSample {
  static constexpr std::size_t kMaxPositions = 7 + kMaxJoints;  ///< a free base and the joints
  double time_s = 0.0;
  std::size_t count = 0;
  std::array<double, kMaxPositions> qpos{};
  std::optional<sim::Rope> rope{};  ///< while the gantry is engaged
};

/// Sensor noise of every simulated robot. Assumed: what consumer-grade IMUs and 14-bit encoders show; no data sheet of
/// this robot is published.
inline constexpr double kGyroNoise_rad_s = 0.01, kEncoderNoise_rad = 0.0004, kOrientationNoise_rad = 0.002;

sim::WorldOptions world_with_noise(std::uint64_t seed, bool gantry);

/// For controllers whose robot is simulated by the same host in real time: a host that others share stops both for tens
/// of milliseconds now and then, and the physics with them. Such a state is not stale before 0.2 s, nor are late ticks
/// a fault, and physics wait for a late controller (runtime/turns.hpp); everything else is as on a robot.
hal::BackendLimits limits_on_shared_host();
void expect_shared_host(control::TickOptions& options);  ///< takes these limits

class SimulatedRobot final : public hal::Hal {
 public:
  static constexpr std::size_t kTruths = 8192;  ///< sixteen seconds

  /// Keeps a reference to world, which belongs to the bus thread from now on and must hang already (WorldOptions)
  /// unless a scenario hoists. keep_truth: somebody will take it.
  SimulatedRobot(sim::World& world, HoistedBy hoisted, bool keep_truth);

  hal::BusStatus exchange(const model::JointCommand& command, model::RobotState& state) noexcept override;

  void support(Support by) noexcept { support_.store(by, std::memory_order_relaxed); }  ///< by the gantry; any thread
  hal::HoistLine* hoist_line() noexcept { return hoisted_ == HoistedBy::kCrane ? &hoist_line_ : nullptr; }
  /// The truth of this bus cycle or, when it was dropped, nothing; older ones are given up. One reader.
  const hal::TruthSample* take_truth(std::uint64_t bus_sample) noexcept;
  bool take(PoseSample& pose) noexcept { return poses_.take(pose); }  ///< one reader
  bool diverged() const noexcept { return diverged_.load(std::memory_order_acquire); }

 private:
  void move_gantry() noexcept;
  void work_crane() noexcept;
  bool carried() const noexcept;  // by the gantry
  void show() noexcept;

  sim::World& world_;
  sil::SilHal bus_;
  const HoistedBy hoisted_;
  const bool keep_truth_;
  const double weight_N_;
  Hoist hoist_;
  Crane crane_;
  hal::HoistLine hoist_line_;
  hal::TruthSample truth_;  // the bus thread's
  PoseSample pose_;
  std::int64_t cycles_ = 0;
  std::atomic<Support> support_{Support::kNone};
  std::atomic<bool> diverged_{false};
  boost::lockfree::spsc_queue<hal::TruthSample> truths_{kTruths};
  hal::TruthSample taken_;  // the reader's
  io::Mailbox<PoseSample> poses_;
};

}  // namespace pmg::sil
