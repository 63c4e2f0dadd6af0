// LcmLink: one clear line for every error of an address or a network, and no loss on a good one.
#include "io/lcm_link.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "pmg_msgs/command_t.hpp"
#include "pmg_msgs/robot_info_t.hpp"
#include "private_network.hpp"

namespace pmg::io {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string error_of(const std::string& url) {
  try {
    const LcmLink link(url);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

pmg_msgs::command_t command(double vx_m_s) {
  pmg_msgs::command_t message{};
  message.robot = "z1";
  message.vx_m_s = vx_m_s;
  return message;
}

TEST(LcmUrl, GivenThenEnvironmentThenLoopbackOnly) {
  ::unsetenv("LCM_DEFAULT_URL");
  EXPECT_EQ(choose_lcm_url(""), "udpm://239.255.76.67:7667?ttl=0");
  ::setenv("LCM_DEFAULT_URL", "udpm://239.1.1.1:7000?ttl=1", 1);
  EXPECT_EQ(choose_lcm_url(""), "udpm://239.1.1.1:7000?ttl=1");
  EXPECT_EQ(choose_lcm_url("memq://"), "memq://");
  ::unsetenv("LCM_DEFAULT_URL");
}

TEST(LcmUrl, WhatIsWrongIsSaidInOneLine) {
  for (const auto& [url, complaint] : {
           std::pair{"", "expected udpm://GROUP:PORT"},
           std::pair{"239.255.76.67:7667", "expected udpm://GROUP:PORT"},
           std::pair{"http://239.255.76.67:7667", "expected udpm://GROUP:PORT"},
           std::pair{"file:///tmp/log.lcm", "expected udpm://GROUP:PORT"},
           std::pair{"udpm://239.255.76.67", "expected HOST:PORT"},
           std::pair{"udpm://:7667", "expected HOST:PORT"},
           std::pair{"udpm://239.255.76.67:0", "expected a port from 1 to 65535"},
           std::pair{"udpm://239.255.76.67:99999", "expected a port from 1 to 65535"},
           std::pair{"udpm://239.255.76.67:76x", "expected a port from 1 to 65535"},
           std::pair{"udpm://10.0.0.1:7667", "expected a multicast group"},
           std::pair{"udpm://robot:7667", "expected a multicast group"},
           std::pair{"udpm://239.255.76.67:7667?ttl=far", "expected ttl from 0"},
           std::pair{"udpm://239.255.76.67:7667?ttl=256", "expected ttl from 0"},
           std::pair{"udpm://239.255.76.67:7667?recv_buf_size=0", "expected recv_buf_size"},
           std::pair{"udpm://239.255.76.67:7667?speed=9", "unknown option \"speed=9\""},
           std::pair{"memq://here", "takes no address"},
           std::pair{"memq://?ttl=0", "only udpm:// takes options"},
           std::pair{"tcpq://localhost", "expected HOST:PORT"},
       }) {
    EXPECT_THROW(checked_lcm_url(url), std::invalid_argument) << url;
    EXPECT_THAT(error_of(url), AllOf(HasSubstr(complaint), HasSubstr(url), Not(HasSubstr("\n"))));
  }
}

TEST(LcmUrl, AsksTheKernelForALargeReceiveBufferUnlessTold) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [] {
    const std::string plain = "udpm://239.255.76.67:7667", buffer = "recv_buf_size=4194304";
    EXPECT_EQ(checked_lcm_url(plain), plain + "?" + buffer);
    EXPECT_EQ(checked_lcm_url(plain + "?"), plain + "?" + buffer);
    EXPECT_EQ(checked_lcm_url(plain + "?ttl=0"), plain + "?ttl=0&" + buffer);
    EXPECT_EQ(checked_lcm_url(plain + "?recv_buf_size=9"), plain + "?recv_buf_size=9");
  });
}

TEST(LcmLink, AnEmptyNetworkNamespaceIsExplainedWithTheCommandThatMendsIt) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kNone, [] {
    testing::internal::CaptureStderr();
    const std::string error = error_of(kDefaultLcmUrl);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "one message, not liblcm's twelve lines beside it";
    EXPECT_THAT(error, HasSubstr("no route for multicast"));
    EXPECT_THAT(error, HasSubstr("ip link set lo up; ip route add 224.0.0.0/4 dev lo"));
    EXPECT_THAT(error, Not(HasSubstr("\n")));
  });
}

/// Listens on its own TCP port and sends these bytes to each client.
class FakeServer {
 public:
  explicit FakeServer(std::vector<std::uint8_t> greeting) : greeting_(std::move(greeting)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    sockaddr any{};
    std::memcpy(&any, &address, size);
    EXPECT_EQ(::bind(listener_, &any, size), 0);
    ::getsockname(listener_, &any, &size);
    std::memcpy(&address, &any, sizeof(address));
    port_ = ntohs(address.sin_port);
    ::listen(listener_, 8);
    thread_ = std::thread([this] {
      for (int client = -1; (client = ::accept(listener_, nullptr, nullptr)) >= 0;) {
        ::send(client, greeting_.data(), greeting_.size(), MSG_NOSIGNAL);
        clients_.push_back(client);
      }
    });
  }
  ~FakeServer() { end(); }
  FakeServer(const FakeServer&) = delete;
  FakeServer& operator=(const FakeServer&) = delete;

  std::string url() const { return "tcpq://localhost:" + std::to_string(port_); }
  void end() {
    if (!thread_.joinable()) return;
    ::shutdown(listener_, SHUT_RDWR);
    thread_.join();
    ::close(listener_);
    for (const int client : clients_) ::close(client);
  }

 private:
  std::vector<std::uint8_t> greeting_;
  std::vector<int> clients_;
  int listener_ = ::socket(AF_INET, SOCK_STREAM, 0);
  int port_ = 0;
  std::thread thread_;
};

TEST(LcmLink, ATcpqAddressWithoutItsServerIsRefusedInsteadOfEndingTheProcess) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [] {
    EXPECT_THAT(error_of("tcpq://127.0.0.1:7700"), HasSubstr("no LCM server answers"));
    const FakeServer silent({});
    EXPECT_THAT(error_of(silent.url()), HasSubstr("no LCM server answers"));
    const FakeServer other({'S', 'S', 'H', '-', '2', '.', '0', '-'});
    EXPECT_THAT(error_of(other.url()), HasSubstr("no LCM server answers"));
  });
}

TEST(LcmLink, ATcpqServerThatGoesAwayIsCountedAndEndsNothing) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [] {
    FakeServer server({0x28, 0x76, 0x17, 0xfa, 0, 0, 1, 0});
    LcmLink link(server.url());
    link.subscribe("COMMAND", [](Bytes) {});
    EXPECT_TRUE(link.publish("STATUS", command(0.1)));
    server.end();
    for (int k = 0; k < 3; ++k) EXPECT_EQ(link.receive(1), 0);
    EXPECT_GE(link.receive_errors(), 1);
    EXPECT_FALSE(link.publish("STATUS", command(0.1)));
    EXPECT_GE(link.publish_errors(), 1);
  });
}

TEST(LcmLink, AMessageArrivesOverMulticastOnLoopback) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [] {
    LcmLink sender(kDefaultLcmUrl), receiver(kDefaultLcmUrl);
    double heard = 0.0;
    receiver.subscribe("COMMAND", [&](Bytes bytes) { heard = decode_message<pmg_msgs::command_t>(bytes)->vx_m_s; });
    EXPECT_TRUE(sender.publish("COMMAND", command(0.25)));
    EXPECT_EQ(receiver.receive(5000), 1);
    EXPECT_EQ(heard, 0.25);
  });
}

TEST(LcmLink, ChannelsAreTakenByTheirWholeName) {
  LcmLink link("memq://");
  int heard = 0;
  link.subscribe("COMMAND", [&](Bytes) { ++heard; });
  link.publish("MOTOR_COMMAND", command(0.1));
  link.publish("COMMAND", command(0.1));
  link.receive(0);
  EXPECT_EQ(heard, 1);
}

TEST(LcmLink, AFloodDoesNotKeepTheCaller) {
  LcmLink link("memq://");
  link.subscribe("COMMAND", [](Bytes) {});
  for (int i = 0; i < 150; ++i) link.publish("COMMAND", command(0.1));
  EXPECT_EQ(link.receive(0, 100), 100);
  EXPECT_EQ(link.receive(0, 100), 50);
}

TEST(LcmLink, AnExceptionOfAHandlerEndsAtTheLink) {
  LcmLink link("memq://");
  link.subscribe("COMMAND", [](Bytes) { throw std::runtime_error("handler"); });
  link.publish("COMMAND", command(0.1));
  EXPECT_EQ(link.receive(0), 1);
  EXPECT_EQ(link.receive_errors(), 1);
}

TEST(LcmLink, AMessageTooLongForTheNetworkIsCountedNotThrown) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [] {
    LcmLink link(kDefaultLcmUrl);
    EXPECT_FALSE(link.publish(std::string(100, 'X'), command(0.1))) << "LCM's channel names have 63 characters";
    EXPECT_EQ(link.publish_errors(), 1);
  });
}

TEST(DecodeMessage, TakesWhatWasEncodedAndNothingElse) {
  const pmg_msgs::command_t sent = command(0.5);
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(sent.getEncodedSize()));
  sent.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  EXPECT_EQ(decode_message<pmg_msgs::command_t>(bytes)->vx_m_s, 0.5);
  EXPECT_FALSE(decode_message<pmg_msgs::robot_info_t>(bytes)) << "another type";
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(decode_message<pmg_msgs::command_t>(Bytes(bytes).first(size))) << size << " bytes";
  }
  std::vector<std::uint8_t> longer = bytes;
  longer.push_back(0);
  EXPECT_FALSE(decode_message<pmg_msgs::command_t>(longer)) << "trailing bytes";
  // the robot's length, after hash and version: lcm-gen's own code passes these values to std::string
  for (const std::array<std::uint8_t, 4>& length :
       {std::array<std::uint8_t, 4>{0, 0, 0, 0}, {0xff, 0xff, 0xff, 0xff}, {0x80, 0, 0, 0}, {0x7f, 0xff, 0xff, 0xff}}) {
    std::vector<std::uint8_t> broken = bytes;
    std::copy(length.begin(), length.end(), broken.begin() + 12);
    EXPECT_FALSE(decode_message<pmg_msgs::command_t>(broken));
  }
}

template <typename Message>
void decode_with_flipped_bytes(const Message& sent) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(sent.getEncodedSize()));
  sent.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  std::mt19937 random(7);
  std::uniform_int_distribution<std::size_t> position(8, bytes.size() - 1);  // the type's hash stays intact
  std::uniform_int_distribution<std::size_t> pick(0, 5);
  for (int i = 0; i < 50'000; ++i) {
    std::vector<std::uint8_t> broken = bytes;
    for (int flips = 0; flips < 3; ++flips) {
      broken[position(random)] = std::array<std::uint8_t, 6>{0, 1, 0x7f, 0x80, 0xff, 0x3a}[pick(random)];
    }
    decode_message<Message>(broken);
  }
}

TEST(DecodeMessage, SurvivesFlippedBytes) {
  decode_with_flipped_bytes(command(0.5));
  pmg_msgs::robot_info_t info{};
  info.bundle_count = 2;
  info.bundle_file = info.bundle_sha256 = {"a", "b"};
  info.joint_count = 3;
  info.joint_names = {"x", "y", "z"};
  info.lower_rad = info.upper_rad = info.stand_rad = {0.1, 0.2, 0.3};
  decode_with_flipped_bytes(info);
}

TEST(DecodeMessage, CountsThatNoMessageHoldsAllocateNothing) {
  pmg_msgs::robot_info_t info{};
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(info.getEncodedSize()));
  info.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  // joint_count, before the last two numbers: lcm-gen's own code would first allocate 2^31 names
  const std::size_t joint_count = bytes.size() - 20;
  bytes[joint_count] = 0x7f;
  EXPECT_FALSE(decode_message<pmg_msgs::robot_info_t>(bytes));
}

}  // namespace
}  // namespace pmg::io
