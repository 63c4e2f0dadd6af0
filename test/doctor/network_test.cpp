#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/can/netlink.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "doctor/checks.hpp"
#include "drive_protocols/mit_drive.hpp"
#include "patient.hpp"
#include "said.hpp"
#include "seal/key_files.hpp"

namespace pmg::doctor {
namespace {

using test::kReserved;
using test::Patient;
using test::said;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kLocal = "udpm://239.255.76.67:7667?ttl=0";
constexpr const char* kNetwork = "udpm://239.255.76.67:7667?ttl=1";

TEST(DoctorOfACard, ItIsThereUpAndLinked) {
  Patient patient;
  const auto line = [&] { return said(check_card(patient, "eth1", kReserved, {}), "eth1 link"); };
  EXPECT_EQ(line(), "ok: up, with carrier");
  patient.files["sys/class/net/eth1/carrier"] = "0";
  EXPECT_THAT(line(), StartsWith("fail: has no carrier"));
  patient.files["sys/class/net/eth1/flags"] = "0x1002";
  EXPECT_THAT(line(), AllOf(StartsWith("fail: is down"), HasSubstr("ip link set eth1 up")));
  patient.files.erase("sys/class/net/eth1/flags");
  EXPECT_THAT(line(), AllOf(StartsWith("fail: no such interface"), HasSubstr("can0, eth1, lo")));
}

TEST(DoctorOfACard, ItHasNoAddress) {
  Patient patient;
  const auto line = [&] { return said(check_card(patient, "eth1", kReserved, {}), "eth1 address"); };
  EXPECT_THAT(line(), StartsWith("ok"));
  patient.has_addresses = {"fe80::1"};
  EXPECT_THAT(line(), StartsWith("warn: has fe80::1"));
  patient.has_addresses.push_back("192.168.1.7");
  EXPECT_THAT(line(), AllOf(StartsWith("fail: has fe80::1, 192.168.1.7; expected none"),
                            HasSubstr("ip address flush dev eth1")));
}

TEST(DoctorOfACard, ItHandsFramesOnAtOnce) {
  Patient patient;
  const auto line = [&] { return said(check_card(patient, "eth1", kReserved, {}), "eth1 coalescing"); };
  EXPECT_EQ(line(), "ok: frames wait up to 0 us for an interrupt");
  patient.coalesces->receive_us = 51;
  EXPECT_THAT(line(), StartsWith("warn: frames wait up to 51 us"));
  patient.coalesces->receive_us = 250;
  EXPECT_THAT(line(), AllOf(StartsWith("fail: frames wait up to 250 us"),
                            HasSubstr("ethtool -C eth1 adaptive-rx off rx-usecs 0")));
  patient.coalesces = Coalescing{.receive_us = 3, .adaptive = true};
  EXPECT_THAT(line(), StartsWith("warn: adaptive"));
  patient.coalesces.reset();
  EXPECT_EQ(line(), "ok: the driver has none, or doesn't tell");
}

TEST(DoctorOfACard, ItsInterruptsKeepAwayFromTheControlThread) {
  Patient patient;
  const auto line = [&] { return said(check_card(patient, "eth1", kReserved, {}), "eth1 interrupts"); };
  EXPECT_EQ(line(), "ok: on CPU 1");
  patient.files["proc/irq/39/effective_affinity_list"] = "0-1";
  EXPECT_THAT(line(), StartsWith("warn: on CPU 0, 1; expected one CPU"));
  patient.files["proc/irq/39/effective_affinity_list"] = "3";
  EXPECT_THAT(line(),
              AllOf(StartsWith("fail: on CPU 3, which the control thread has"), HasSubstr("for i in 39; do echo 2 >")));
  patient.folders["sys/class/net/eth1/device/msi_irqs"] = {"24"};
  EXPECT_EQ(line(), "ok: on CPU 0") << "its device tells its interrupts better than their names";
}

can::BusSetup fd_bus() {
  can::BusSetup bus;
  bus.name = "can0";
  bus.bitrate = 1'000'000;
  bus.data_bitrate = 5'000'000;
  for (int i = 0; i < 8; ++i)
    bus.motors.push_back({.joint = "j",
                          .index = i,
                          .node = i + 1,
                          .drive = drives::mit_drive({}),
                          .transmission = drives::Transmission({}),
                          .limits = {}});
  return bus;
}

TEST(DoctorOfACanBus, ItIsACanInterfaceThatIsUp) {
  Patient patient;
  const auto line = [&] { return said(check_can_bus(patient, fd_bus(), {}), "can0"); };
  EXPECT_EQ(line(), "ok: up");
  patient.files["sys/class/net/can0/flags"] = "0x40080";
  EXPECT_THAT(
      line(),
      AllOf(StartsWith("fail: is down"),
            HasSubstr(
                "ip link set can0 up txqueuelen 64 type can bitrate 1000000 dbitrate 5000000 fd on restart-ms 100")));
  patient.can->kind = "";
  patient.files["sys/class/net/can0/type"] = "1";
  EXPECT_THAT(line(), StartsWith("fail: isn't a CAN interface"));
  patient.can.reset();
  EXPECT_THAT(line(), StartsWith("fail: no such interface"));
  patient.can_error = EPERM;
  EXPECT_THAT(line(), StartsWith("warn: the kernel doesn't tell: Operation not permitted"));
}

TEST(DoctorOfACanBus, BothBitRatesAreRobotYamls) {
  Patient patient;
  const auto line = [&] { return said(check_can_bus(patient, fd_bus(), {}), "can0 bit rate"); };
  EXPECT_EQ(line(), "ok: 1000000 and 5000000 bit/s");
  patient.can->data.bitrate = 2'000'000;
  EXPECT_THAT(line(), StartsWith("fail: 2000000 bit/s in the data phase; robot.yaml says 5000000"));
  patient.can->arbitration.bitrate = 500'000;
  EXPECT_THAT(line(), StartsWith("fail: 500000 bit/s; robot.yaml says 1000000"));
  patient.can->kind = "slcan";
  EXPECT_THAT(line(), StartsWith("warn: an interface of the kind 'slcan' has none that could be read"));
}

TEST(DoctorOfACanBus, TheSamplePointIsRobotYamlsOrTheRecommendedOne) {
  Patient patient;
  can::BusSetup bus = fd_bus();
  const auto line = [&] { return said(check_can_bus(patient, bus, {}), "can0 sample point"); };
  EXPECT_EQ(line(), "ok: 75.0 %");
  patient.can->arbitration.sample_permille = 800;
  EXPECT_EQ(line(), "ok: 80.0 %") << "one quantum of twenty";
  patient.can->arbitration.sample_permille = 875;
  EXPECT_THAT(line(), StartsWith("warn: 87.5 %; expected 75.0 %, as CiA 301 recommends"));
  bus.sample_point = 0.875;
  EXPECT_EQ(line(), "ok: 87.5 %");
  patient.can->arbitration.sample_permille = 600;
  EXPECT_THAT(line(),
              AllOf(StartsWith("fail: 60.0 %; expected 87.5 %, as robot.yaml says"), HasSubstr("sample-point 0.875")));
  patient.can->arbitration.sample_permille = 875;
  bus.data_sample_point = 0.6;
  EXPECT_THAT(line(), StartsWith("fail: 75.0 % in the data phase; expected 60.0 %"));
  bus = fd_bus();
  patient.can->arbitration.sample_permille = 875;
  bus.bitrate = 500'000;
  EXPECT_EQ(line(), "ok: 87.5 %") << "CiA 301 up to 500 kbit/s";
  bus.bitrate = 800'000;
  EXPECT_THAT(line(), StartsWith("warn: 87.5 %; expected 80.0 %"));
}

TEST(DoctorOfACanBus, ItsStateIsNamed) {
  Patient patient;
  const auto line = [&] { return said(check_can_bus(patient, fd_bus(), {}), "can0 state"); };
  EXPECT_EQ(line(), "ok: error-active");
  patient.can->restart_ms = 0;
  EXPECT_THAT(line(),
              AllOf(StartsWith("warn: error-active; a bus that goes off stays off"), HasSubstr("restart-ms 100")));
  patient.can->state = CAN_STATE_ERROR_WARNING;
  EXPECT_THAT(line(), StartsWith("warn: error-warning"));
  patient.can->state = CAN_STATE_ERROR_PASSIVE;
  EXPECT_THAT(line(), AllOf(StartsWith("warn: error-passive"), HasSubstr("termination")));
  patient.can->state = CAN_STATE_BUS_OFF;
  EXPECT_THAT(line(), StartsWith("fail: bus-off"));
  patient.can->state = CAN_STATE_STOPPED;
  EXPECT_THAT(line(), StartsWith("fail: stopped"));
}

TEST(DoctorOfACanBus, ItsQueueHasRoomForACycle) {
  Patient patient;
  const auto line = [&] { return said(check_can_bus(patient, fd_bus(), {}), "can0 queue"); };
  EXPECT_EQ(line(), "ok: room for 64 frames");
  patient.files["sys/class/net/can0/tx_queue_len"] = "10";
  EXPECT_EQ(line(), "ok: room for 10 frames") << "eight motors, SYNC and heartbeat";
  patient.files["sys/class/net/can0/tx_queue_len"] = "9";
  EXPECT_THAT(line(), AllOf(StartsWith("fail: room for 9 frames; a cycle sends up to 10"), HasSubstr("txqueuelen 64")));
}

TEST(DoctorOfAnImu, ItsLineIsThereUsableAndPrompt) {
  Patient patient;
  const model::SerialImuModel imu = {.device = "/dev/serial/by-id/imu", .baud = 921600, .rate_Hz = 400};
  const auto line = [&](const char* check) { return said(check_serial_imu(patient, imu), check); };
  EXPECT_EQ(line("IMU line"), "ok: /dev/serial/by-id/imu (/dev/ttyUSB0)");
  EXPECT_EQ(line("IMU line latency"), "ok: 1 ms");
  patient.files["sys/bus/usb-serial/devices/ttyUSB0/latency_timer"] = "16";
  EXPECT_THAT(line("IMU line latency"), AllOf(StartsWith("warn: the adapter may hold bytes for 16 ms"),
                                              HasSubstr("echo 1 > /sys/bus/usb-serial/devices/ttyUSB0/latency_timer")));
  patient.usable = false;
  EXPECT_THAT(line("IMU line"), AllOf(StartsWith("fail: this user may not use"), HasSubstr("usermod -aG dialout")));
  patient.device = "";
  EXPECT_THAT(line("IMU line"),
              AllOf(StartsWith("fail: there is no /dev/serial/by-id/imu"), HasSubstr("ls /dev/serial/by-id")));
  patient.device = "/dev/ttyS1";
  patient.usable = true;
  EXPECT_EQ(line("IMU line latency"), "ok: no USB adapter");
}

TEST(DoctorOfTheNetwork, MessagesFindTheirWayAndNotTheOneOfEtherCat) {
  Patient patient;
  const auto line = [&](const char* url, std::vector<std::string> cards) {
    return said(check_multicast(patient, url, cards), "multicast route");
  };
  EXPECT_EQ(line(kLocal, {}), "ok: udpm://239.255.76.67:7667?ttl=0 over lo");
  EXPECT_THAT(line(kNetwork, {}),
              AllOf(StartsWith("fail: "), HasSubstr("is to reach other computers, and its route ends at lo")));
  EXPECT_THAT(line(kLocal, {"lo"}), StartsWith("fail: LCM's messages go to lo, which EtherCAT has"));
  patient.files["proc/net/route"] =
      "Iface\nlo\t000000E1\t00000000\t0001\t0\t0\t0\t000000F0\t0\t0\t0\neth0\t00000000\t010200C0\t0003\t0\t0\t0\t000000"
      "00\t0\t0\t0\n";
  EXPECT_THAT(line(kNetwork, {}), StartsWith("ok: ")) << "the default route alone fits";
  EXPECT_EQ(line("memq://", {}), "ok: memq:// needs none");
  patient.multicast = "no route";
  EXPECT_THAT(line(kLocal, {}), AllOf(StartsWith("fail: no route"), HasSubstr("ip route add 224.0.0.0/4 dev lo")));
}

TEST(DoctorOfTheNetwork, OnANetworkOperatorsNeedKeysThatNobodyElseReads) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("pmg_doctor_keys_" + std::to_string(getpid()));
  fs::remove_all(folder);
  const auto line = [&](const char* url, bool insecure = false) {
    return said(check_keys(folder.string(), url, insecure), "keys");
  };
  EXPECT_THAT(line(kNetwork), AllOf(StartsWith("fail: "), HasSubstr("nobody can drive"), HasSubstr("pmg_key new")));
  EXPECT_THAT(line(kNetwork, true), StartsWith("warn: none are asked for"));
  seal::make_operator_key(folder, "anna");
  EXPECT_EQ(line(kNetwork), "ok: 1 operator may drive");
  EXPECT_EQ(said(check_keys("", kLocal, false), "keys"), "ok: messages stay on this computer: none are needed");
  fs::permissions(folder / "operators" / "anna.key", fs::perms::others_read, fs::perm_options::add);
  EXPECT_THAT(line(kNetwork),
              AllOf(StartsWith("fail: "), HasSubstr("others may read or write it"), HasSubstr("chmod 600")));
  seal::revoke_operator_key(folder, "anna");
  EXPECT_THAT(line(kNetwork), StartsWith("fail: "));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace pmg::doctor
