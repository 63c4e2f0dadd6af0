// What counts as a picture of a robot's camera, and how old it is said to be.
#include "live_page/heard_camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace pmg::live_page {
namespace {

class HeardCameraTest : public testing::Test {
 protected:
  HeardCameraTest() { camera_.follow("z1"); }

  static pmg_msgs::camera_t picture(std::int64_t sequence, const std::string& inside = "picture") {
    pmg_msgs::camera_t message{};
    message.robot = "z1";
    message.session = 1;
    message.sequence = sequence;
    const std::string jpeg = "\xff\xd8\xff" + inside + "\xff\xd9";
    message.jpeg.assign(jpeg.begin(), jpeg.end());
    return message;
  }
  void say(pmg_msgs::camera_t message) {
    message.size = static_cast<std::int32_t>(message.jpeg.size());
    link_.publish("CAMERA", message);
    link_.receive(0);
  }
  void pass(double seconds) { clock_.advance_to(clock_.now_ns() + std::llround(seconds * 1e9)); }
  bool is_taken(const pmg_msgs::camera_t& message) {
    say(message);
    return camera_.take().has_value();
  }

  io::SimulationClock clock_;
  io::LcmLink link_{"memq://"};
  HeardCamera camera_{link_, clock_};
};

TEST_F(HeardCameraTest, TheNewestPictureIsGivenOnceWhateverCameBefore) {
  EXPECT_FALSE(camera_.newest());
  for (int k = 1; k <= 100; ++k) say(picture(k, std::to_string(k)));
  EXPECT_EQ(camera_.newest()->number, 100);
  EXPECT_EQ(camera_.take(),
            "\xff\xd8\xff"
            "100\xff\xd9")
      << "none waits behind it";
  EXPECT_FALSE(camera_.take());
}

TEST_F(HeardCameraTest, APictureIsAsOldAsItLiesHereAndTravelledLongerThanTheFastest) {
  pmg_msgs::camera_t message = picture(1);
  message.stamp_ns = 5'000'000'000;
  say(message);
  EXPECT_DOUBLE_EQ(camera_.newest()->age_s, 0.0);
  pass(0.4);
  EXPECT_NEAR(camera_.newest()->age_s, 0.4, 1e-9);
  message = picture(2);
  message.stamp_ns = 5'100'000'000;
  say(message);
  EXPECT_NEAR(camera_.newest()->age_s, 0.3, 0.001) << "it should have come 0.3 s ago";
  pass(1.0);
  EXPECT_NEAR(camera_.newest()->age_s, 1.3, 0.001);
}

TEST_F(HeardCameraTest, AnOldOrRepeatedPictureDoesNotMakeItYoung) {
  say(picture(7));
  pass(0.4);
  EXPECT_TRUE(camera_.take());
  EXPECT_FALSE(is_taken(picture(7)));
  EXPECT_FALSE(is_taken(picture(6)));
  EXPECT_NEAR(camera_.newest()->age_s, 0.4, 1e-9);
  EXPECT_TRUE(is_taken(picture(8)));
}

TEST_F(HeardCameraTest, AnotherStartIsHeardOnceThePresentOneIsSilent) {
  pmg_msgs::camera_t other = picture(1);
  other.session = 2;
  EXPECT_TRUE(is_taken(picture(50)));
  EXPECT_FALSE(is_taken(other));
  pass(0.6);
  EXPECT_TRUE(is_taken(other));
}

TEST_F(HeardCameraTest, WhatIsTooLargeNoJpegOrAnotherRobotsIsNone) {
  const auto most = static_cast<std::size_t>(pmg_msgs::camera_t::MOST_BYTES) - 5;
  EXPECT_TRUE(is_taken(picture(1, std::string(most, 'x'))));
  EXPECT_FALSE(is_taken(picture(2, std::string(most + 1, 'x'))));
  for (const std::string& bytes : {std::string(), std::string("\xff\xd8\xff\xff\xd9"), std::string("<svg onload=x>"),
                                   std::string("\xff\xd8\xff cut short")}) {
    pmg_msgs::camera_t message = picture(2);
    message.jpeg.assign(bytes.begin(), bytes.end());
    EXPECT_FALSE(is_taken(message)) << bytes;
  }
  pmg_msgs::camera_t other = picture(2);
  other.robot = "z2";
  EXPECT_FALSE(is_taken(other));
  EXPECT_EQ(camera_.newest()->number, 1);
}

TEST_F(HeardCameraTest, OfAnotherRobotNothingIsShownUntilItsOwnPictureComes) {
  say(picture(1));
  camera_.follow("z2");
  EXPECT_FALSE(camera_.newest());
  EXPECT_FALSE(camera_.take());
  pmg_msgs::camera_t other = picture(1);
  other.robot = "z2";
  say(other);
  EXPECT_EQ(camera_.newest()->number, 2) << "so that a page asks for it";
}

}  // namespace
}  // namespace pmg::live_page
