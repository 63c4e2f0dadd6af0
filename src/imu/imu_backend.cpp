#include "imu/imu_backend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>

namespace pmg::imu {

namespace {

class BackendWithImu final : public hal::Backend {
 public:
  BackendWithImu(std::unique_ptr<hal::Backend> drives, const model::SerialImuModel& setup, Wait wait)
      : drives_(std::move(drives)), setup_(setup), wait_(std::move(wait)) {}

  hal::OptionValues configuration() const override {
    hal::OptionValues values = drives_->configuration();
    values["imu"] = fmt::format("Xsens MTi on {}, {} baud, {} Hz", setup_.device, setup_.baud, setup_.rate_Hz);
    return values;
  }
  hal::BackendLimits limits() const override { return drives_->limits(); }
  hal::BackendDescription description() const override { return drives_->description(); }

  /// The IMU first: it moves nothing.
  hal::Hal& connect(const std::function<bool()>& interrupted) override {
    imu_ = std::make_unique<SerialImu>(setup_, [this, &interrupted] {
      if (interrupted()) throw std::runtime_error(fmt::format("IMU on {}: interrupted", setup_.device));
      wait_();
    });
    hal_ = std::make_unique<HalWithImu>(drives_->connect(interrupted), *imu_);
    return *hal_;
  }

  std::string news() override {
    std::string news = drives_->news();
    if (!news.empty() || !hal_ || hal_->imu_silent() == told_silent_) return news;
    told_silent_ = !told_silent_;
    return fmt::format("the IMU on {} {} ({} damaged messages until now)", setup_.device,
                       told_silent_ ? "does not speak" : "speaks again", hal_->damaged());
  }

  hal::HoistLine* hoist() noexcept override { return drives_->hoist(); }
  hal::Window* window() noexcept override { return drives_->window(); }
  const hal::TruthSample* take_truth(std::uint64_t bus_sample) noexcept override {
    return drives_->take_truth(bus_sample);
  }

 private:
  std::unique_ptr<hal::Backend> drives_;
  model::SerialImuModel setup_;
  Wait wait_;
  std::unique_ptr<SerialImu> imu_;
  std::unique_ptr<HalWithImu> hal_;
  bool told_silent_ = false;
};

}  // namespace

hal::BusStatus HalWithImu::exchange(const model::JointCommand& command, model::RobotState& state) noexcept {
  imu_.begin_cycle();
  const hal::BusStatus drives = drives_.exchange(command, whole_);
  imu_.hear();
  const int age = imu_.age_cycles();
  const hal::BusStatus imu = age > SerialImu::kSilentCycles ? hal::BusStatus::kLost
                             : age > SerialImu::kLateCycles ? hal::BusStatus::kStale
                                                            : hal::BusStatus::kOk;
  silent_.store(imu == hal::BusStatus::kLost, std::memory_order_relaxed);
  damaged_.store(imu_.counts().checksum_errors, std::memory_order_relaxed);
  const hal::BusStatus status = std::max(drives, imu);  // in the order kOk, kStale, kLost
  if (status != hal::BusStatus::kOk) return status;
  state = whole_;
  state.orientation_WI = imu_.sample().orientation_WI;
  state.gyro_rad_s = imu_.sample().gyro_rad_s;
  state.acceleration_m_s2 = imu_.sample().acceleration_m_s2;
  return status;
}

std::unique_ptr<hal::Backend> with_imu(std::unique_ptr<hal::Backend> backend, const model::RobotModel& robot,
                                       Wait wait) {
  if (!robot.imu.serial || backend->description().set_on_simulator) return backend;
  return std::make_unique<BackendWithImu>(std::move(backend), *robot.imu.serial, std::move(wait));
}

Wait sleeping() {
  return [] { std::this_thread::sleep_for(std::chrono::milliseconds(1)); };
}

}  // namespace pmg::imu
