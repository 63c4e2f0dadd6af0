// The doctor's way to the real computer, and the kernel's messages about CAN interfaces.
#include "doctor/linux_host.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/rtnetlink.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <random>

namespace pmg::doctor {
namespace {

namespace fs = std::filesystem;

using Bytes = std::vector<std::byte>;

template <typename T>
Bytes bytes_of(const T& value) {
  Bytes bytes(sizeof value);
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

Bytes joined(const std::vector<Bytes>& parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

Bytes attribute(unsigned type, const Bytes& payload) {
  const rtattr head{.rta_len = static_cast<unsigned short>(sizeof(rtattr) + payload.size()),
                    .rta_type = static_cast<unsigned short>(type)};
  Bytes all = joined({bytes_of(head), payload});
  all.resize((all.size() + 3) / 4 * 4);
  return all;
}

Bytes text(const std::string& word) {
  Bytes bytes(word.size() + 1);
  std::memcpy(bytes.data(), word.c_str(), bytes.size());
  return bytes;
}

/// What a kernel with a CAN FD controller answers to `ip link show can0`.
Bytes answer() {
  can_bittiming nominal{}, data{};
  nominal.bitrate = 1'000'000;
  nominal.sample_point = 750;
  data.bitrate = 5'000'000;
  data.sample_point = 600;
  const Bytes info = joined({attribute(IFLA_CAN_BITTIMING, bytes_of(nominal)),
                             attribute(IFLA_CAN_STATE, bytes_of(std::uint32_t{CAN_STATE_ERROR_PASSIVE})),
                             attribute(IFLA_CAN_RESTART_MS, bytes_of(std::uint32_t{100})),
                             attribute(IFLA_CAN_DATA_BITTIMING, bytes_of(data))});
  const Bytes link = joined({attribute(IFLA_INFO_KIND, text("can")), attribute(IFLA_INFO_DATA | NLA_F_NESTED, info)});
  Bytes all = joined({bytes_of(nlmsghdr{}), bytes_of(ifinfomsg{}), attribute(IFLA_IFNAME, text("can0")),
                      attribute(IFLA_LINKINFO, link)});
  nlmsghdr head{};
  head.nlmsg_type = RTM_NEWLINK;
  head.nlmsg_len = static_cast<std::uint32_t>(all.size());
  std::memcpy(all.data(), &head, sizeof head);
  return all;
}

TEST(CanLinkMessage, TellsBitRatesSamplePointsStateAndRestart) {
  const auto link = parse_can_link(answer());
  ASSERT_TRUE(link);
  EXPECT_EQ(link->kind, "can");
  EXPECT_EQ(link->arbitration.bitrate, 1'000'000u);
  EXPECT_EQ(link->arbitration.sample_permille, 750u);
  EXPECT_EQ(link->data.bitrate, 5'000'000u);
  EXPECT_EQ(link->data.sample_permille, 600u);
  EXPECT_EQ(link->state, std::uint32_t{CAN_STATE_ERROR_PASSIVE});
  EXPECT_EQ(link->restart_ms, 100u);
}

TEST(CanLinkMessage, EveryShortenedOneIsTakenOrRefusedWithoutReadingBeyond) {
  const Bytes whole = answer();
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const std::unique_ptr<std::byte[]> exact(new std::byte[length]);  // AddressSanitizer sees a byte beyond
    std::memcpy(exact.get(), whole.data(), length);
    EXPECT_FALSE(parse_can_link({exact.get(), length})) << length << ": its header tells a longer one";
  }
}

TEST(CanLinkMessage, AnyBytesAreTakenWithoutHarm) {
  std::mt19937 random(7);
  const Bytes whole = answer();
  for (int i = 0; i < 20'000; ++i) {
    Bytes spoilt = whole;
    for (int k = 0; k < 4; ++k) spoilt[random() % spoilt.size()] = static_cast<std::byte>(random());
    if (const auto link = parse_can_link(spoilt)) {
      EXPECT_LE(link->kind.size(), whole.size());
    }
  }
}

TEST(LinuxHost, ReadsFilesBelowItsRoot) {
  const fs::path root = fs::temp_directory_path() / ("pmg_linux_host_" + std::to_string(getpid()));
  fs::create_directories(root / "sys/kernel");
  std::ofstream(root / "sys/kernel/realtime") << "1\n";
  const LinuxHost host(root);
  EXPECT_EQ(host.text("sys/kernel/realtime"), "1");
  EXPECT_EQ(host.text("sys/kernel"), std::nullopt) << "a folder";
  EXPECT_EQ(host.text("sys/kernel/nothing"), std::nullopt);
  EXPECT_EQ(host.names("sys"), std::vector<std::string>{"kernel"});
  EXPECT_TRUE(host.names("proc").empty());
  fs::remove_all(root);
}

TEST(LinuxHost, AsksThisComputer) {
  const LinuxHost host;
  EXPECT_THAT(host.text("proc/version").value_or(""), testing::HasSubstr("Linux"));
  int error = 0;
  const auto loopback = host.can_link("lo", error);
  ASSERT_TRUE(loopback) << std::strerror(error);
  EXPECT_EQ(loopback->kind, "") << "no CAN";
  EXPECT_FALSE(host.can_link("none0", error));
  EXPECT_EQ(error, ENODEV);
  EXPECT_FALSE(host.coalescing("none0"));
  EXPECT_TRUE(host.addresses("none0").empty());
  const ClockReading before = host.clock(), after = host.clock();
  EXPECT_GE(after.monotonic_ns, before.monotonic_ns);
  EXPECT_EQ(host.multicast_problem("memq://"), "");
  EXPECT_THAT(host.multicast_problem("udp://"), testing::HasSubstr("expected udpm://"));
}

TEST(LinuxHost, TheDiskIsProbedWhereTheLogWillBeAndNothingRemains) {
  const fs::path folder = fs::temp_directory_path() / ("pmg_doctor_disk_" + std::to_string(getpid()));
  fs::create_directories(folder);
  const LinuxHost host;
  EXPECT_EQ(host.disk_space((folder / "not" / "yet").string()).folder, folder.string());
  const WriteSpeed speed = host.write_speed((folder / "not" / "yet").string());
  EXPECT_EQ(speed.problem, "");
  EXPECT_GT(speed.bytes_per_s, 0.0);
  EXPECT_TRUE(fs::is_empty(folder));
  EXPECT_NE(host.write_speed("/proc").problem, "") << "nobody can write there";
  fs::remove_all(folder);
}

}  // namespace
}  // namespace pmg::doctor
