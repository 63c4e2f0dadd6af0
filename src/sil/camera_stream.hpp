// (where a simulated robot is) => what its head's camera shows, as pictures on the network.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "io/clock.hpp"
#include "io/lcm_link.hpp"
#include "pmg_msgs/camera_t.hpp"
#include "sil/simulated_robot.hpp"
#include "sim/jpeg.hpp"
#include "sim/mujoco_objects.hpp"
#include "sim/renderer.hpp"

namespace pmg::sil {

/// The camera itself. For the thread that makes it.
class CameraEye {
 public:
  static constexpr int kWidth = 320, kHeight = 240;

  /// Keeps a reference to model. Throws std::runtime_error without OSMesa.
  CameraEye(const mjModel* model, const std::string& torso_link);

  /// A JPEG of camera_t::MOST_BYTES at most.
  std::vector<std::uint8_t> look(const PoseSample& pose);

 private:
  const mjModel* model_;
  sim::DataPointer data_;
  sim::Renderer renderer_;
  sim::JpegEncoder encoder_;
};

/// What it shows as CAMERA on a network, once a period at most. Only what is new: a simulation that stands still has no
/// pictures.
class CameraSender {
 public:
  static constexpr std::int64_t kPeriod_ns = 100'000'000;

  /// Keeps references; nobody else takes the robot's poses. name: the controller's. clock stamps and paces.
  CameraSender(CameraEye& eye, SimulatedRobot& robot, const std::string& name, io::LcmLink& link,
               const io::Clock& clock);

  /// Looks if it is due. Throws what looking throws.
  void step();
  std::int64_t due_ns() const noexcept { return due_ns_; }  ///< the next look, by the clock

 private:
  CameraEye& eye_;
  SimulatedRobot& robot_;
  io::LcmLink& link_;
  const io::Clock& clock_;
  std::int64_t due_ns_;
  PoseSample pose_;
  pmg_msgs::camera_t picture_{};
};

/// A thread of its own, of a lower priority than any other of the program, in which a CameraSender looks.
class CameraStream {
 public:
  /// Keeps references; nobody else takes the robot's poses. name: the controller's. Throws std::runtime_error without
  /// OSMesa or network.
  CameraStream(const mjModel* model, const std::string& torso_link, SimulatedRobot& robot, std::string name,
               std::string lcm_url, const io::Clock& clock);

  /// Why there will be no more pictures, once; empty: nothing has happened.
  std::string take_failure();

 private:
  void work(const std::stop_token& stop, const mjModel* model, const std::string& torso_link);
  void send_until(const std::stop_token& stop, CameraSender& sender);

  SimulatedRobot& robot_;
  const std::string name_, lcm_url_;
  const io::Clock& clock_;
  std::promise<void> ready_;
  std::mutex mutex_;
  std::condition_variable_any stopped_;
  std::string failure_;
  std::jthread thread_;  // after what it uses
};

}  // namespace pmg::sil
