#include "web/admission.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "web/allowance.hpp"

namespace pmg::web {
namespace {

const std::array<std::string, 3> kNames = {"localhost", "Robot.local", "::1"};

TEST(Admission, AHostIsOursByItsNameWhateverThePort) {
  for (const char* host : {"localhost", "LOCALHOST:8443", "robot.local:1", "[::1]:8443", "[::1]"})
    EXPECT_TRUE(is_ours(host, kNames)) << host;
  for (const char* host :
       {"", ":8443", "evil.com", "localhost.evil.com", "localhost:", "localhost:84x3", "localhost:123456",
        "localhost@evil.com", "[::1", "[]", "::1", " localhost", "localhost:8443:1"})
    EXPECT_FALSE(is_ours(host, kNames)) << host;
}

TEST(Admission, AnOriginIsOurOwnIfItIsTheHostsByHttps) {
  EXPECT_TRUE(is_own_origin("https://Robot.local:8443", "robot.local:8443"));
  for (const char* origin : {"", "null", "http://robot.local:8443", "https://robot.local", "https://evil.com",
                             "https://robot.local:8443.evil.com", "https://robot.local:8443/"})
    EXPECT_FALSE(is_own_origin(origin, "robot.local:8443")) << origin;
}

TEST(Admission, ATokenIsTheSubprotocolBesideOurs) {
  EXPECT_EQ(asked_protocols("pmg, pmg.token.abc").token, "abc");
  EXPECT_EQ(asked_protocols("\tpmg.token.abc ,pmg").token, "abc");
  EXPECT_TRUE(asked_protocols("x,pmg").ours);
  EXPECT_FALSE(asked_protocols("x,pmg").token);
  for (const char* header : {"", ",", ",,,", "pmg.token", "PMG", "pmgx"}) EXPECT_FALSE(asked_protocols(header).ours);
  EXPECT_EQ(asked_protocols("pmg,pmg.token.").token, "") << "an empty token is a wrong one, and not none";
}

TEST(AllowanceTest, SoManyASecondWithRoomForABunch) {
  Allowance allowance(10.0, 5.0);
  int taken = 0;
  for (int k = 0; k < 1000; ++k) taken += allowance.take(1'000'000'000 + k * 1'000'000) ? 1 : 0;
  EXPECT_GE(taken, 14);
  EXPECT_LE(taken, 15);
}

}  // namespace
}  // namespace pmg::web
