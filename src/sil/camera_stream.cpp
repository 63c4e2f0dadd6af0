#include "sil/camera_stream.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "pmg_msgs/camera_t.hpp"
#include "sim/head_camera.hpp"

namespace pmg::sil {

namespace {

/// Of this thread and of those that it makes: OSMesa draws in some.
void lower_priority() {
  constexpr int kNice = 10;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);  // what it fails by, it does without
}

}  // namespace

CameraEye::CameraEye(const mjModel* model, const std::string& torso_link)
    : model_(model),
      data_(mj_makeData(model)),
      renderer_(model, {.width = kWidth,
                        .height = kHeight,
                        .mounted = sim::mounted(sim::HeadCamera(), torso_link, kWidth, kHeight)}) {}

std::vector<std::uint8_t> CameraEye::look(const PoseSample& pose) {
  std::copy_n(pose.qpos.begin(), std::min(pose.count, static_cast<std::size_t>(model_->nq)), data_->qpos);
  data_->time = pose.time_s;
  mj_kinematics(model_, data_.get());
  mj_comPos(model_, data_.get());
  mj_camlight(model_, data_.get());
  return encoder_.encode(renderer_.render(data_.get(), "", pose.rope), kWidth, kHeight, pmg_msgs::camera_t::MOST_BYTES);
}

CameraStream::CameraStream(const mjModel* model, const std::string& torso_link, SimulatedRobot& robot, std::string name,
                           std::string lcm_url, const io::Clock& clock)
    : robot_(robot), name_(std::move(name)), lcm_url_(std::move(lcm_url)), clock_(clock) {
  std::future<void> ready = ready_.get_future();
  thread_ = std::jthread([this, model, torso_link](const std::stop_token& stop) { work(stop, model, torso_link); });
  ready.get();
}

void CameraStream::work(const std::stop_token& stop, const mjModel* model, const std::string& torso_link) {
  lower_priority();
  bool begun = false;
  try {
    CameraEye eye(model, torso_link);
    io::LcmLink link(lcm_url_);
    ready_.set_value();
    begun = true;
    publish_until(stop, eye, link);
  } catch (const std::exception& error) {
    if (!begun) return ready_.set_exception(std::current_exception());
    const std::lock_guard lock(mutex_);
    failure_ = std::string("the head's camera shows nothing more: ") + error.what();
  }
}

void CameraStream::publish_until(const std::stop_token& stop, CameraEye& eye, io::LcmLink& link) {
  pmg_msgs::camera_t picture{};
  picture.robot = name_;
  picture.session = std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
  PoseSample pose;
  while (!stop.stop_requested()) {
    const auto next = std::chrono::steady_clock::now() + std::chrono::nanoseconds(kPeriod_ns);
    if (robot_.take(pose)) {
      picture.stamp_ns = clock_.now_ns();  // a pose is 10 ms old at most, unless the simulation stands still
      picture.jpeg = eye.look(pose);
      picture.size = static_cast<std::int32_t>(picture.jpeg.size());
      ++picture.sequence;
      link.publish("CAMERA", picture);
    }
    std::unique_lock lock(mutex_);
    stopped_.wait_until(lock, stop, next, [] { return false; });
  }
}

std::string CameraStream::take_failure() {
  const std::lock_guard lock(mutex_);
  return std::exchange(failure_, {});
}

}  // namespace pmg::sil
