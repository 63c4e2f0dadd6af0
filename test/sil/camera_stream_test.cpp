// A simulated robot's camera on the network: bounded in rate and size, and silent where nothing is new.
#include "sil/camera_stream.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <turbojpeg.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <vector>

#include "control/fixtures.hpp"
#include "io/lcm_link.hpp"
#include "pmg_msgs/camera_t.hpp"

namespace pmg::sil {
namespace {

class CameraStreamTest : public testing::Test {
 protected:
  void step_robot() { robot_.exchange(command_, state_); }
  static model::JointCommand limp() {
    model::JointCommand command;
    command.q = test::biped().q_stand();
    command.dq = command.kp = command.kd = command.tau_ff = JointVector::Zero(command.q.size());
    return command;
  }

  /// 320 * 240 RGB triples.
  static std::vector<std::uint8_t> pixels(const std::vector<std::uint8_t>& jpeg) {
    std::vector<std::uint8_t> rgb(std::size_t{3} * CameraEye::kWidth * CameraEye::kHeight);
    tjhandle reader = tjInitDecompress();
    EXPECT_EQ(tjDecompress2(reader, jpeg.data(), jpeg.size(), rgb.data(), CameraEye::kWidth, 0, CameraEye::kHeight,
                            TJPF_RGB, 0),
              0);
    tjDestroy(reader);
    return rgb;
  }
  /// Mean over all values.
  static double difference(const std::vector<std::uint8_t>& one, const std::vector<std::uint8_t>& other) {
    double sum = 0.0;
    for (std::size_t i = 0; i < one.size(); ++i) sum += std::abs(int{one[i]} - int{other[i]});
    return sum / static_cast<double>(one.size());
  }

  const model::JointCommand command_ = limp();
  model::RobotState state_;
  sim::World world_{test::biped(), world_with_noise(0, true)};
  SimulatedRobot robot_{world_, HoistedBy::kGantry, false};
};

TEST_F(CameraStreamTest, APictureIsAJpegOfTheRobotsPlaceWithinTheSizeOfAMessage) {
  CameraEye eye(world_.mj_model(), test::biped().torso_link);
  PoseSample pose;
  step_robot();
  ASSERT_TRUE(robot_.take(pose));
  const std::vector<std::uint8_t> jpeg = eye.look(pose);
  EXPECT_LE(jpeg.size(), static_cast<std::size_t>(pmg_msgs::camera_t::MOST_BYTES));
  const std::vector<std::uint8_t> here = pixels(jpeg);
  EXPECT_LT(difference(here, pixels(eye.look(pose))), 0.5) << "software OpenGL may round an edge differently";
  pose.qpos[0] += 0.7;
  EXPECT_GT(difference(here, pixels(eye.look(pose))), 3.0) << "the floor has tiles";
}

TEST_F(CameraStreamTest, ASecondHasTenPicturesHoweverOftenItIsAskedAndASimulationThatStandsStillHasNone) {
  io::SimulationClock clock;
  io::LcmLink link("memq://");
  std::vector<pmg_msgs::camera_t> heard;
  link.subscribe("CAMERA",
                 [&](io::Bytes bytes) { heard.push_back(io::decode_message<pmg_msgs::camera_t>(bytes).value()); });
  CameraEye eye(world_.mj_model(), test::biped().torso_link);
  CameraSender sender(eye, robot_, "biped", link, clock);
  const auto step = [&](std::int64_t duration_ns, bool moves) {
    for (std::int64_t passed_ns = 0; passed_ns < duration_ns; passed_ns += 10'000'000) {
      if (moves) step_robot();
      sender.step();
      link.receive(0);
      clock.advance_to(clock.now_ns() + 10'000'000);
    }
  };
  step(1'000'000'000, true);
  EXPECT_EQ(heard.size(), 10U);
  for (std::size_t k = 1; k < heard.size(); ++k) {
    EXPECT_EQ(heard[k].stamp_ns - heard[k - 1].stamp_ns, CameraSender::kPeriod_ns);
    EXPECT_EQ(heard[k].sequence, heard[k - 1].sequence + 1);
  }
  const std::size_t before = heard.size();
  step(500'000'000, false);
  EXPECT_EQ(heard.size(), before + 1) << "the last pose alone is new";
  EXPECT_EQ(sender.due_ns(), 1'500'000'000);
}

TEST_F(CameraStreamTest, ComesTenTimesASecondAtMostAndNotAtAllFromASimulationThatStandsStill) {
  using Clock = std::chrono::steady_clock;
  const std::string url = fmt::format("udpm://239.255.76.67:{}?ttl=0", 20000 + getpid() % 20000);
  const io::WallClock clock;
  io::LcmLink link(url);
  std::vector<pmg_msgs::camera_t> heard;
  link.subscribe("CAMERA", [&](io::Bytes bytes) {
    if (const auto picture = io::decode_message<pmg_msgs::camera_t>(bytes)) heard.push_back(*picture);
  });
  CameraStream stream(world_.mj_model(), test::biped().torso_link, robot_, "biped", url, clock);
  const auto begin = Clock::now();
  while (heard.size() < 5 && Clock::now() < begin + std::chrono::seconds(30)) {
    step_robot();  // as fast as it can
    link.receive(0);
  }
  ASSERT_GE(heard.size(), 5U);
  const std::chrono::nanoseconds lasted = Clock::now() - begin;
  EXPECT_LE(static_cast<std::int64_t>(heard.size()), lasted.count() / CameraSender::kPeriod_ns + 1);
  for (std::size_t k = 0; k < heard.size(); ++k) {
    EXPECT_EQ(heard[k].sequence, static_cast<std::int64_t>(k) + 1);
    EXPECT_EQ(heard[k].robot, "biped");
  }
  const std::size_t before = heard.size();
  const auto end = Clock::now() + 10 * std::chrono::nanoseconds(CameraSender::kPeriod_ns);
  while (Clock::now() < end) link.receive(10);
  EXPECT_LE(heard.size(), before + 2) << "what it had begun, and the newest pose";
  EXPECT_EQ(stream.take_failure(), "");
}

}  // namespace
}  // namespace pmg::sil
