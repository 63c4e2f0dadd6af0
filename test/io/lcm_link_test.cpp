// LcmLink: one clear line for every error of an address or a network, and no loss on a good one.
#include "io/lcm_link.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "pmg_msgs/command_t.hpp"
#include "pmg_msgs/robot_info_t.hpp"
#include "private_network.hpp"
#include "raw_datagrams.hpp"

namespace pmg::io {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string text_of(const std::exception_ptr& thrown) {
  if (thrown == nullptr) return "";
  try {
    std::rethrow_exception(thrown);
  } catch (const std::exception& error) {
    return error.what();
  }
}

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

TEST(LcmLink, AFullTableOfFilesIsNamedAndNoFirewall) {
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  const int next = ::dup(STDIN_FILENO);
  ASSERT_GE(next, 0);
  ::close(next);
  for (const unsigned left : {0u, 3u}) {
    rlimit few = before;
    few.rlim_cur = static_cast<rlim_t>(next) + left;
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &few), 0);
    std::exception_ptr refused;
    try {
      const LcmLink link("udpm://239.255.76.67:7667?ttl=0");
    } catch (...) {
      refused = std::current_exception();
    }
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before),
              0);  // UndefinedBehaviorSanitizer reads an exception's type by a pipe
    EXPECT_THAT(text_of(refused),
                AllOf(HasSubstr("Too many open files"), HasSubstr("ulimit -n"), Not(HasSubstr("firewall"))));
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

/// Sends through liblcm itself, as every stock LCM tool does.
class StockSender {
 public:
  StockSender() : lcm_(lcm_create(kDefaultLcmUrl)) {}
  ~StockSender() { lcm_destroy(lcm_); }
  StockSender(const StockSender&) = delete;
  StockSender& operator=(const StockSender&) = delete;
  void send(const std::string& channel, const std::vector<std::uint8_t>& bytes) {
    EXPECT_EQ(lcm_publish(lcm_, channel.c_str(), bytes.data(), static_cast<unsigned>(bytes.size())), 0);
  }

 private:
  lcm_t* lcm_;
};

TEST(LcmLink, MessagesOfStockLcmArriveWholeShortAndFragmented) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [] {
    LcmLink receiver(kDefaultLcmUrl);
    std::vector<std::uint8_t> heard;
    receiver.subscribe("ROBOT_INFO", [&](Bytes bytes) { heard.assign(bytes.begin(), bytes.end()); });
    StockSender sender;
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{1000}, std::size_t{65'499},
                                   std::size_t{65'500}, std::size_t{150'000}, LcmAssembler::kLargestMessage}) {
      std::vector<std::uint8_t> sent(size);
      for (std::size_t i = 0; i < size; ++i) sent[i] = static_cast<std::uint8_t>(i % 253);
      sender.send("OTHER", sent);
      sender.send("ROBOT_INFO", sent);
      heard = {1, 2, 3};
      EXPECT_EQ(receiver.receive(5000), 1) << size;
      EXPECT_EQ(heard, sent) << size;
    }
    EXPECT_EQ(receiver.receiver()->counts().malformed, 0);
  });
}

TEST(LcmLink, StockLcmHearsOurMessages) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [] {
    lcm_t* const stock = lcm_create(kDefaultLcmUrl);
    std::vector<std::uint8_t> heard;
    const auto take = [](const lcm_recv_buf_t* message, const char*, void* into) {
      const auto* data = static_cast<const std::uint8_t*>(message->data);
      static_cast<std::vector<std::uint8_t>*>(into)->assign(data, data + message->data_size);
    };
    lcm_subscribe(stock, "COMMAND", take, &heard);
    LcmLink sender(kDefaultLcmUrl);
    EXPECT_TRUE(sender.publish("COMMAND", command(0.25)));
    EXPECT_GT(lcm_handle_timeout(stock, 5000), 0);
    EXPECT_EQ(decode_message<pmg_msgs::command_t>(heard)->vx_m_s, 0.25);
    lcm_destroy(stock);
  });
}

TEST(LcmLink, HostileDatagramsAreCountedAndTheNextMessageArrives) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [] {
    LcmLink receiver(kDefaultLcmUrl), sender(kDefaultLcmUrl);
    int heard = 0;
    receiver.subscribe("COMMAND", [&](Bytes) { ++heard; });
    send_datagrams({""});
    send_datagrams({"LC"});
    send_datagrams({std::string("LC02\0\0\0\1COM", 11)});  // a name without end
    send_datagrams({std::string("LC03\0\0\0\1\0\0\0\x09\xFF\xFF\xFF\0\0\0\0\2C\0", 22)});
    sender.publish("COMMAND", command(0.1));
    while (receiver.receive(5000) == 0) {
    }
    EXPECT_EQ(heard, 1);
    EXPECT_EQ(receiver.receiver()->counts().malformed, 4);
  });
}

TEST(LcmLink, AFloodOfForeignDatagramsDoesNotKeepTheCaller) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [] {
    LcmLink receiver(kDefaultLcmUrl);
    receiver.subscribe("COMMAND", [](Bytes) {});
    for (int k = 0; k < 50; ++k) send_datagrams({"noise..."});
    EXPECT_EQ(receiver.receive(60'000, 10), 0) << "it returned although it might have waited for a minute";
    EXPECT_EQ(receiver.receiver()->counts().malformed, 10 * LcmLink::kDatagramsPerMessage);
  });
}

TEST(LcmLink, AFloodWhoseHandlersAreSlowDoesNotKeepTheCaller) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [] {
    using std::chrono::steady_clock;
    LcmLink sender(kDefaultLcmUrl), receiver(kDefaultLcmUrl);
    receiver.subscribe("COMMAND", [](Bytes) {
      const auto end = steady_clock::now() + std::chrono::milliseconds(2);
      while (steady_clock::now() < end) continue;
    });
    for (int k = 0; k < 100; ++k) sender.publish("COMMAND", command(0.1));
    int handled = receiver.receive(0);
    EXPECT_GE(handled, 1);
    EXPECT_LE(handled, LcmLink::kHandling_ms / 2) << "of 100 that wait";
    while (handled < 100) handled += receiver.receive(5000);
  });
}

TEST(LcmLink, WithTtl0OnlyThisComputersMessagesAreHeard) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [] {
    const SecondComputer other;
    if (!other.wired()) {
      GTEST_SKIP() << "NOT TESTED: the kernel makes no virtual wire (ip link add ... type veth)";
    }
    LcmLink here("udpm://239.255.76.67:7667?ttl=0"), everywhere("udpm://239.255.76.67:7667?ttl=1");
    int heard_here = 0, heard_everywhere = 0;
    here.subscribe("COMMAND", [&](Bytes) { ++heard_here; });
    everywhere.subscribe("COMMAND", [&](Bytes) { ++heard_everywhere; });
    other.inside([] {
      lcm_t* const stock = lcm_create("udpm://239.255.76.67:7667?ttl=1");
      for (int k = 0; k < 20; ++k) {
        lcm_publish(stock, "COMMAND", "x", 1);
        ::usleep(10'000);  // until the wire is up
      }
      lcm_destroy(stock);
    });
    here.receive(0);
    everywhere.receive(0);
    EXPECT_GT(heard_everywhere, 0);
    EXPECT_EQ(heard_here, 0);
    EXPECT_GT(here.receiver()->from_elsewhere(), 0);
    here.publish("COMMAND", command(0.1));
    here.receive(5000);
    EXPECT_EQ(heard_here, 1);
  });
}

TEST(LcmUrl, TellsWhetherMessagesLeaveThisComputer) {
  for (const char* here : {"udpm://239.255.76.67:7667", "udpm://239.255.76.67:7667?ttl=0", "memq://"}) {
    EXPECT_FALSE(leaves_this_computer(here)) << here;
  }
  for (const char* out : {"udpm://239.255.76.67:7667?ttl=1", "udpm://239.255.76.67:7667?recv_buf_size=9&ttl=32",
                          "tcpq://localhost:7700"}) {
    EXPECT_TRUE(leaves_this_computer(out)) << out;
  }
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
